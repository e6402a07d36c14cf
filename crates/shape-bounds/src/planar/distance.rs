//! Distance from points to a convex polygon.

use glam::DVec2;

/// The point of the segment from `a` to `b` that is nearest to `query`.
pub(super) fn on_segment(a: DVec2, b: DVec2, query: DVec2) -> DVec2 {
    let along = b - a;
    let t = (query - a).dot(along);
    let length = along.length_squared();
    if t <= 0.0 || length == 0.0 {
        a
    } else if t >= length {
        b
    } else {
        a + along * (t / length)
    }
}

/// The nearest point of the convex polygon `corners` (counter-clockwise; one and two corners are a point and a segment) to
/// each of `queries`, which lie outside and go around it counter-clockwise.
///
/// Outside of a convex polygon every place belongs to one edge or corner, in order around it, so the nearest feature only
/// moves on with the queries: time proportional to the number of both.
pub(super) fn nearest_around(corners: &[DVec2], queries: &[DVec2]) -> Vec<DVec2> {
    let count = corners.len();
    let at = |k: usize| corners[k % count];
    let on_edge = |k: usize, q: DVec2| on_segment(at(k), at(k + 1), q);
    let Some(first) = queries.first() else { return Vec::new() };
    let distance = |k: usize| on_edge(k, *first).distance_squared(*first);
    let mut edge = (0..count).min_by(|i, j| distance(*i).total_cmp(&distance(*j))).unwrap_or(0);
    queries
        .iter()
        .map(|q| {
            for _ in 0..count {
                // Behind this edge; or beyond its end, and not short of the next one's beginning.
                let end = at(edge + 1);
                let behind = (end - at(edge)).perp_dot(*q - end) > 0.0;
                let beyond = (*q - end).dot(end - at(edge)) >= 0.0;
                let reaches = (*q - end).dot(at(edge + 2) - end) > 0.0;
                if !(behind || beyond && reaches) {
                    break;
                }
                edge += 1;
            }
            on_edge(edge, *q)
        })
        .collect()
}
