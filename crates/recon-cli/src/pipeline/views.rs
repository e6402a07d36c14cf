//! Bodies in space as they are seen along three axes.

use super::bounds::BoundsResult;
use glam::{DVec2, DVec3};
use recon::shape_bounds::exact_hull::planar;
use recon_io::{FigureCurve, FigureFrame, FigurePanel};
use std::f64::consts::TAU;

/// From where, and the axes that run to the right and upward.
pub(crate) const VIEWS: [(&str, [usize; 2]); 3] =
    [("Seen from the front", [0, 2]), ("Seen from the side", [1, 2]), ("Seen from above", [0, 1])];

/// Most dots of a kind in a view, and in one of many that are shown in turn.
const DOTS: usize = 1500;
const DOTS_IN_TURN: usize = 250;
/// Views all around, and the height of the eye, rad.
const TURNS: usize = 24;
const FROM_ABOVE: f64 = 0.5;
/// Corners that are nearer to each other than this share of the body's reach are seen as one: an arc is off by 1e-5 of it.
const SEEN: f64 = 0.01;
/// Length of the arrow as a share of the body's radius, and its head as a share of the arrow.
const ARROW: f64 = 0.35;
const HEAD: f64 = 0.3;
/// Half of the width of a cross as a share of the body's radius.
const CROSS: f64 = 0.05;

/// A point as it is seen.
pub(crate) fn seen(point: DVec3, axes: [usize; 2]) -> [f64; 2] {
    axes.map(|axis| point[axis])
}

/// The outline of points as they are seen.
pub(crate) fn silhouette(points: impl Iterator<Item = [f64; 2]>) -> Vec<[f64; 2]> {
    let points: Vec<DVec2> = points.map(DVec2::from_array).collect();
    match planar::Hull::of(&points) {
        Ok(planar::Hull::Polygon(hull)) => hull.shape().vertices().iter().map(DVec2::to_array).collect(),
        _ => Vec::new(),
    }
}

/// Bounds, the contacts that they rest on, the centre of mass, from which all are seen, and where the bounds are farthest apart.
pub(crate) fn bounds_views(made: &BoundsResult, contacts: &[DVec3]) -> Vec<FigurePanel> {
    let upper = made.drawn.upper.as_ref().map_or(&[][..], |upper| &upper.mesh.vertices);
    let next = made.drawn.largest_gap.map(|gap| gap.outer);
    let dots = [("contacts", contacts), ("centre", &[DVec3::ZERO][..])];
    views(&[("lower", &made.drawn.lower.mesh.vertices), ("upper", upper)], &dots, next)
}

/// Convex bodies by the outlines of their corners, points as dots, and an arrow at where to touch next: along the axes, and from all around.
pub(crate) fn views(
    bodies: &[(&str, &[DVec3])],
    dots: &[(&str, &[DVec3])],
    next: Option<DVec3>,
) -> Vec<FigurePanel> {
    let one = |(title, axes): (&str, [usize; 2])| FigurePanel {
        title: title.to_owned(),
        axes: axes.map(|axis| format!("{} in m", ["x", "y", "z"][axis])),
        equal: true,
        curves: curves(bodies, dots, next, DOTS, |p| Some(seen(p, axes))),
        ..FigurePanel::default()
    };
    VIEWS.into_iter().map(one).chain([turning(bodies, dots, next)]).collect()
}

/// The bodies seen obliquely from above, from one direction after the other; of the dots those in front.
fn turning(bodies: &[(&str, &[DVec3])], dots: &[(&str, &[DVec3])], next: Option<DVec3>) -> FigurePanel {
    let all = || bodies.iter().flat_map(|(_, corners)| *corners);
    let centre = all().sum::<DVec3>() / (all().count().max(1) as f64);
    let (sin, cos) = FROM_ABOVE.sin_cos();
    let from = |turn: f64| {
        let (right, ahead) = (DVec2::from_angle(turn), DVec2::from_angle(turn).perp());
        let place = move |p: DVec3| {
            let d = p - centre;
            let away = ahead.dot(d.truncate());
            [right.dot(d.truncate()), cos * d.z + sin * away]
        };
        let front = move |p: DVec3| sin * (p - centre).z - cos * ahead.dot((p - centre).truncate()) >= 0.0;
        // A point alone is within the body, and is seen from everywhere.
        let (alone, many): (Vec<_>, Vec<_>) = dots.iter().copied().partition(|(_, points)| points.len() == 1);
        let mut found = curves(bodies, &alone, next, 1, move |p| Some(place(p)));
        let at = found.iter().take_while(|curve| curve.filled).count();
        let dots = curves(&[], &many, None, DOTS_IN_TURN, move |p| front(p).then(|| place(p)));
        found.splice(at..at, dots);
        found
    };
    let step = TAU / TURNS as f64;
    let label = |k: usize| format!("from {:.0}°", (step * k as f64).to_degrees());
    let frames = (1..TURNS).map(|k| FigureFrame { label: label(k), curves: from(step * k as f64) });
    let frames: Vec<FigureFrame> = frames.collect();
    let room = frames.iter().flat_map(|frame| &frame.curves).flat_map(|curve| curve.points.clone()).collect();
    FigurePanel {
        title: "From all around".to_owned(),
        axes: ["m".to_owned(), "m".to_owned()],
        equal: true,
        curves: from(0.0),
        frames,
        room,
        ..FigurePanel::default()
    }
}

/// Outlines of bodies, dots and the arrow, as a projection places them; dots that it does not show are left out.
fn curves(
    bodies: &[(&str, &[DVec3])],
    dots: &[(&str, &[DVec3])],
    next: Option<DVec3>,
    most_dots: usize,
    place: impl Fn(DVec3) -> Option<[f64; 2]>,
) -> Vec<FigureCurve> {
    let outline = |(name, corners): &(&str, &[DVec3])| {
        let around = coarse(&silhouette(corners.iter().filter_map(|p| place(*p))));
        let points = around.iter().chain(around.first()).copied().collect();
        FigureCurve { name: (*name).to_owned(), points, filled: true, ..FigureCurve::default() }
    };
    let dotted = |(name, points): &(&str, &[DVec3])| {
        let step = points.len().div_ceil(most_dots).max(1);
        let points = points.iter().step_by(step).filter_map(|p| place(*p)).collect();
        FigureCurve { name: (*name).to_owned(), points, dots: true, ..FigureCurve::default() }
    };
    let mut found: Vec<FigureCurve> = bodies.iter().map(outline).collect();
    let outlines: Vec<DVec2> =
        found.iter().flat_map(|curve| &curve.points).map(|p| DVec2::from_array(*p)).collect();
    found.extend(dots.iter().map(|named| match named {
        (name, [alone]) => cross(name, place(*alone), &outlines),
        _ => dotted(named),
    }));
    found.retain(|curve| !curve.points.is_empty());
    if let Some(at) = next.and_then(&place) {
        found.push(touch_next(DVec2::from_array(at), &outlines));
    }
    found
}

/// A point alone, which a dot among many would hide.
fn cross(name: &str, at: Option<[f64; 2]>, around: &[DVec2]) -> FigureCurve {
    let arm = CROSS * reach(around).1;
    let points =
        at.map_or(Vec::new(), |[x, y]| vec![[x - arm, y], [x + arm, y], [x, y], [x, y + arm], [x, y - arm]]);
    FigureCurve { name: name.to_owned(), points, ..FigureCurve::default() }
}

/// The middle of some points, and how far the farthest is from it.
fn reach(points: &[DVec2]) -> (DVec2, f64) {
    let middle = points.iter().sum::<DVec2>() / points.len().max(1) as f64;
    (middle, points.iter().map(|p| p.distance(middle)).fold(0.0, f64::max))
}

/// An outline without corners that are nearer to the one before than can be seen.
fn coarse(outline: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let reach = outline.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
    let mut kept: Vec<[f64; 2]> = Vec::new();
    for p in outline {
        if kept.last().is_none_or(|last| (p[0] - last[0]).hypot(p[1] - last[1]) > SEEN * reach) {
            kept.push(*p);
        }
    }
    kept
}

/// An arrow from outside of what these points surround that ends where to touch next.
pub(crate) fn touch_next(at: DVec2, around: &[DVec2]) -> FigureCurve {
    let (middle, size) = reach(around);
    let shaft = ARROW * size * (at - middle).normalize_or(DVec2::Y);
    let side = |turn: f64| at + HEAD * DVec2::from_angle(turn).rotate(shaft);
    let points = [at + shaft, at, side(0.5), at, side(-0.5)].map(|p| p.to_array()).to_vec();
    FigureCurve { name: "touch next".to_owned(), points, ..FigureCurve::default() }
}
