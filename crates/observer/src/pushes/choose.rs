//! Which outline: polygons of three corners and more, and smooth ones, weighed by their evidence (MacKay, 1992): what they meet
//! of the touches, and how much of what was known of a shape beforehand they had to give up for it. A corner that one wrong touch asks for is told by that touch
//! alone, and costs as much as any other.

use super::fit::{Fitted, compared, fit, settled};
use super::shape::{HIGHEST, MOST_CORNERS, Shape, one_less, thinned};
use super::touches::Touch;
use glam::DVec2;

/// Log odds, in units of `e`, up to which the outline of fewer unknowns is kept: twenty to one.
const ODDS: f64 = 3.0;
/// How far a corner may lie beyond an edge that is taken away, in sizes of the object.
const FARTHEST: f64 = 2.0;

/// An outline that was tried.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineCandidate {
    /// What it is, such as `3 corners`.
    pub name: String,
    /// Unknowns.
    pub unknowns: usize,
    /// By how much its negative log evidence exceeds the least one, in units of `e`: 5 are odds of 150 to one against it.
    pub against: f64,
}

/// Touched places in the order in which they lie about their middle.
fn around(touches: &[[Touch; 2]]) -> Vec<DVec2> {
    let mut all: Vec<DVec2> = touches.iter().flatten().map(|t| t.centre).collect();
    let middle = all.iter().sum::<DVec2>() / all.len() as f64;
    all.sort_by(|a, b| (*a - middle).to_angle().total_cmp(&(*b - middle).to_angle()));
    all
}

/// Centre of the area within the touched places, and their distance from it in the mean of squares, m.
pub(super) fn extent(touches: &[[Touch; 2]]) -> (DVec2, f64) {
    let all = around(touches);
    let first = all[0];
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for pair in all.windows(2) {
        let (a, b) = (pair[0] - first, pair[1] - first);
        area += a.perp_dot(b);
        moment += (a + b) * a.perp_dot(b);
    }
    let mean = all.iter().sum::<DVec2>() / all.len() as f64;
    let centre = if area > 0.0 { first + moment / (3.0 * area) } else { mean };
    let squares: f64 = all.iter().map(|p| p.distance_squared(centre)).sum();
    (centre, (squares / all.len() as f64).sqrt())
}

/// The outline of fewest unknowns that the touches do not speak against, and all that were tried, the best evidence first.
pub(super) fn choose(touches: &[[Touch; 2]], radius: f64) -> Option<(Fitted, Vec<OutlineCandidate>)> {
    let (middle, size) = extent(touches);
    let smooth = smooth(touches, radius, size, middle);
    let by = |f: &Fitted| 0.5 * f.misfit;
    let best = smooth.iter().min_by(|a, b| by(a).total_cmp(&by(b)));
    let mut starts = vec![around(touches)];
    starts.extend(best.map(|best| best.line.corners().to_vec()));
    let mut all = polygons(touches, radius, size, &starts);
    all.extend(smooth);
    all.sort_by(|a, b| by(a).total_cmp(&by(b)));
    let least = by(all.first()?);
    let candidates = all.iter().map(|f| OutlineCandidate {
        name: f.point.shape.name(),
        unknowns: f.point.shape.unknowns(),
        against: by(f) - least,
    });
    let candidates = candidates.collect();
    let first = all.first()?.clone();
    if matches!(first.point.shape, Shape::Smooth { .. }) {
        // A harmonic less is no simpler object, and what is left out stands in no deviation.
        return Some((first, candidates));
    }
    // One push may be no touch: a corner that is there for it alone is not there.
    let good = all.into_iter().filter(|f| f.against(&first) <= ODDS);
    good.min_by_key(|f| f.point.shape.unknowns()).map(|best| (best, candidates))
}

/// No more unknowns than pushes.
fn allowed(unknowns: usize, touches: &[[Touch; 2]]) -> bool {
    unknowns <= touches.len()
}

/// From a circle on, each with one harmonic more.
fn smooth(touches: &[[Touch; 2]], radius: f64, size: f64, centre: DVec2) -> Vec<Fitted> {
    let mut coefficients = vec![(size - radius).max(0.1 * size)];
    let mut all: Vec<Fitted> = Vec::new();
    for _ in 1..=HIGHEST {
        coefficients.extend([0.0; 2]);
        if !allowed(coefficients.len(), touches) {
            break;
        }
        let start = Shape::Smooth { centre, coefficients: coefficients.clone() };
        let Some(made) = fit(touches, radius, size, start) else { continue };
        if let Shape::Smooth { coefficients: found, .. } = &made.point.shape {
            coefficients.clone_from(found);
        }
        all.push(made);
    }
    all
}

/// From closed lines of many corners on, each with one corner less.
fn polygons(touches: &[[Touch; 2]], radius: f64, size: f64, lines: &[Vec<DVec2>]) -> Vec<Fitted> {
    let least = |a: &Fitted, b: &Fitted| a.misfit.total_cmp(&b.misfit);
    let of = |corners: usize| {
        let thin = |line: &Vec<DVec2>| fit(touches, radius, size, Shape::Polygon(thinned(line, corners)));
        lines.iter().filter_map(thin).min_by(least)
    };
    // From as many corners on as the touches leave some of themselves free of.
    let mut next = (3..=MOST_CORNERS).rev().filter(|n| allowed(2 * n, touches)).find_map(of);
    let mut all: Vec<Fitted> = Vec::new();
    while let Some(now) = next {
        let Shape::Polygon(corners) = &now.point.shape else { break };
        let starts = if corners.len() > 3 { one_less(corners, FARTHEST * size) } else { Vec::new() };
        let fits =
            starts.into_iter().filter_map(|s| compared(&now, touches, radius, size, Shape::Polygon(s)));
        let mut fits: Vec<Fitted> = fits.collect();
        fits.sort_by(least);
        // One that ends in no outline as it goes on stands for itself.
        let rough = fits.first().cloned();
        next = fits.into_iter().find_map(|fit| settled(fit, touches, radius, size)).or(rough);
        all.push(now);
    }
    all
}
