//! Where short texts at points go, so that they lie neither over each other nor over points.

use super::drawing::{Drawing, Place};

/// Mean width of a character and height of a line of a note, in units of the drawing.
const CHARACTER: f64 = 5.6;
const LINE: f64 = 11.0;
/// Half of what a marker takes.
const MARKER: f64 = 5.0;
/// The plotting library writes a text with its middle at a place, and its foot so far above it.
const LIFTED: f64 = 6.0;

/// A text at a place of the axes.
#[derive(Debug)]
pub(super) struct Placed {
    pub(super) at: Place,
    pub(super) text: String,
}

/// Left, low, right and high end, in units of the drawing.
type Extent = [f64; 4];

/// Half of what a line takes, and how far apart places on it are looked at.
const STROKE: f64 = 1.5;
const ALONG: f64 = 4.0;

/// The notes and the labels of goals of a drawing of so many units whose axes reach so far: above its point, below it, to the right or to the left of it, near
/// or a line further off, wherever it lies over nothing; a note without such a place is left out, as the table has it.
pub(super) fn placed(drawing: &Drawing, axes: [(f64, f64); 2], size: [f64; 2]) -> Vec<Placed> {
    let unit = [0, 1].map(|i| size[i] / (axes[i].1 - axes[i].0));
    let on_page = |at: Place| [(at.0 - axes[0].0) * unit[0], (at.1 - axes[1].0) * unit[1]];
    let points = drawing.curves.iter().flat_map(|curve| curve.points.iter().map(|(at, _)| *at));
    let stars = drawing.stars.iter().map(|star| star.at);
    let mut taken: Vec<Extent> = points
        .chain(stars)
        .map(on_page)
        .map(|[x, y]| [x - MARKER, y - MARKER, x + MARKER, y + MARKER])
        .collect();
    taken.extend(drawing.curves.iter().filter(|curve| curve.style.line_width > 0.0).flat_map(|curve| {
        curve
            .points
            .windows(2)
            .flat_map(|ends| on_line([on_page(ends[0].0), on_page(ends[1].0)]))
            .collect::<Vec<_>>()
    }));
    let goals = drawing.stars.iter().map(|star| (star.at, &star.label));
    let mut all = Vec::new();
    for (at, text) in goals.chain(drawing.notes.iter().map(|note| (note.at, &note.text))) {
        let [x, y] = on_page(at);
        let half = 0.5 * CHARACTER * text.chars().count() as f64;
        let aside = half + 2.0 * MARKER;
        let above = MARKER + 2.0;
        let low = -0.5 * LINE;
        // Middle and foot of the text from the point.
        let around = [
            (0.0, above),
            (0.0, -above - LINE),
            (aside, low),
            (-aside, low),
            (aside, above),
            (-aside, above),
            (aside, -above - LINE),
            (-aside, -above - LINE),
            (0.0, above + LINE),
            (0.0, -above - 2.0 * LINE),
            (aside, above + LINE),
            (-aside, above + LINE),
            (aside, -above - 2.0 * LINE),
            (-aside, -above - 2.0 * LINE),
        ];
        let free = around.into_iter().find_map(|(dx, dy)| {
            let own = [x + dx - half, y + dy, x + dx + half, y + dy + LINE];
            let inside = own[0] >= 0.0 && own[1] >= 0.0 && own[2] <= size[0] && own[3] <= size[1];
            (inside && !taken.iter().any(|other| overlap(&own, other))).then_some((dx, dy, own))
        });
        let Some((dx, dy, own)) = free else { continue };
        taken.push(own);
        let place = (at.0 + dx / unit[0], at.1 + (dy - LIFTED) / unit[1]);
        all.push(Placed { at: place, text: text.clone() });
    }
    all
}

/// What a straight line takes.
fn on_line([from, to]: [[f64; 2]; 2]) -> Vec<Extent> {
    let way = [to[0] - from[0], to[1] - from[1]];
    let steps = (way[0].hypot(way[1]) / ALONG).ceil().max(1.0);
    let at = |k: f64, i: usize| from[i] + way[i] * k / steps;
    let extent = |k: f64| [at(k, 0) - STROKE, at(k, 1) - STROKE, at(k, 0) + STROKE, at(k, 1) + STROKE];
    (0..=steps as u32).map(|k| extent(f64::from(k))).collect()
}

fn overlap(a: &Extent, b: &Extent) -> bool {
    a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;
    use crate::diagram::drawing::Note;

    fn drawing(places: &[Place]) -> Drawing {
        let axis = Axis::linear("x", "m");
        let mut drawing = Drawing::new("", "", &axis, &axis);
        drawing.notes = places.iter().map(|at| Note { at: *at, text: "1e-10".to_owned() }).collect();
        drawing
    }

    #[test]
    fn notes_at_one_point_go_to_all_sides_and_more_are_left_out() {
        let axes = [(0.0, 100.0), (0.0, 100.0)];
        let all = placed(&drawing(&[(50.0, 50.0); 20]), axes, [400.0, 400.0]);
        assert!((6..20).contains(&all.len()), "{all:?}");
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                let far =
                    (a.at.0 - b.at.0).abs() * 4.0 >= 30.0 || (a.at.1 - b.at.1).abs() * 4.0 >= LINE - 1e-9;
                assert!(far, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn a_note_lies_over_no_line() {
        let mut of = drawing(&[(50.0, 50.0)]);
        let style = crate::diagram::style::Style::of_methods(["m"])[0];
        let ends = [(50.0, 50.0), (50.0, 100.0)].map(|at| (at, String::new()));
        of.curves.push(crate::diagram::drawing::Curve { points: ends.to_vec(), style, dashed: false });
        let all = placed(&of, [(0.0, 100.0), (0.0, 100.0)], [400.0, 400.0]);
        // The line goes up from the point, so that the note is below it.
        assert!(all.len() == 1 && all[0].at.1 < 50.0, "{all:?}");
    }

    #[test]
    fn a_note_stays_inside_of_the_frame() {
        let all = placed(&drawing(&[(100.0, 100.0)]), [(0.0, 100.0), (0.0, 100.0)], [400.0, 400.0]);
        // Below and to the left is the only room at this corner.
        assert!(all.is_empty() || all[0].at.0 < 100.0 && all[0].at.1 < 100.0);
    }
}
