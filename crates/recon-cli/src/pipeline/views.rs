//! Bodies in space as they are seen along three axes.

use glam::{DVec2, DVec3};
use recon::shape_bounds::planar;
use recon_io::{FigureCurve, FigurePanel};

/// From where, and the axes that run to the right and upward.
pub(crate) const VIEWS: [(&str, [usize; 2]); 3] =
    [("Seen from the front", [0, 2]), ("Seen from the side", [1, 2]), ("Seen from above", [0, 1])];

/// Most dots of a kind in a view.
const DOTS: usize = 1500;

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

/// Convex bodies by the outlines of their corners, and points as dots, in three views.
pub(crate) fn three_views(bodies: &[(&str, &[DVec3])], dots: &[(&str, &[DVec3])]) -> Vec<FigurePanel> {
    let one = |(title, axes): (&str, [usize; 2])| {
        let outline = |(name, corners): &(&str, &[DVec3])| {
            let around = silhouette(corners.iter().map(|v| seen(*v, axes)));
            let points = around.iter().chain(around.first()).copied().collect();
            FigureCurve { name: (*name).to_owned(), points, ..FigureCurve::default() }
        };
        let dotted = |(name, points): &(&str, &[DVec3])| {
            let step = points.len().div_ceil(DOTS).max(1);
            let points = points.iter().step_by(step).map(|v| seen(*v, axes)).collect();
            FigureCurve { name: (*name).to_owned(), points, dots: true, ..FigureCurve::default() }
        };
        let curves = bodies.iter().map(outline).chain(dots.iter().map(dotted));
        FigurePanel {
            title: title.to_owned(),
            axes: axes.map(|axis| format!("{} in m", ["x", "y", "z"][axis])),
            equal: true,
            curves: curves.filter(|curve| !curve.points.is_empty()).collect(),
            ..FigurePanel::default()
        }
    };
    VIEWS.into_iter().map(one).collect()
}
