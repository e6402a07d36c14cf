//! How probable a run of contacts is on a smooth piece of the surface, at a corner, on an edge, on a face.
//!
//! In a tangent direction, with lengths in sizes of the body, contacts and normals of one place lie on a line through the plane of both:
//! contact over normal is the radius of curvature, the tangent of an angle from 0 (sharp) to a quarter turn (flat). A smooth
//! surface has any angle beforehand, in two principal directions that are turned by any angle, and pays for each that the contacts
//! tell by the share of the range that is left (Laplace). A corner is sharp in both, a face flat in both, an edge one of each. Contacts
//! depart from the line by noise in both coordinates (errors in variables); where along it they are is free.
//!
//! A coordinate that is free is charged with its squares about its mean as one that stays is, up to where it surely moves: so what
//! noise does to a coordinate counts alike for all kinds. Where nothing moves all four explain it alike, and the run stays open.
//! Beforehand a coordinate that is free stays while the other one moves with odds of what noise lets tell to how far the other moves.

use super::found::FeatureKind;
use super::moments::Moments;
use contact_kinematics::Direction;
use glam::{DMat2, DMat3, DVec2, DVec3};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Odds beforehand that a path is bent rather than straight, at least; and of a contact that moves in one way at all.
const STRAIGHT: f64 = 2.0;
/// Deviations of chi-squared beyond which a coordinate moves: one in a thousand does by chance.
const MOVES: f64 = 3.1;
/// Turns of the principal directions that are tried before the best is refined, of a quarter turn.
const TURNS: usize = 12;
/// Cosine and sine of twice the angle between them.
const TWICE_SPACING: DVec2 = DVec2::new(0.965_925_826_289_068_3, 0.258_819_045_102_520_74);
/// Steps of the refinement, at most: to a thousandth of the spacing; and what of the evidence is not worth another one.
const REFINED: usize = 10;
const ENOUGH: f64 = 0.01;
/// Step of the second difference in the turn, rad: chi-squared is a trigonometric function of it of low order.
const DIFFERENCE: f64 = 0.01;

/// Logarithms of the evidence for each kind, in the order of [`FeatureKind::ALL`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Evidence(pub(super) [f64; 4]);

impl Evidence {
    /// Evidence of all kinds together, each as probable beforehand.
    pub(super) fn total(&self) -> f64 {
        let most = self.0.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        most + self.0.iter().map(|e| (e - most).exp()).sum::<f64>().ln() - 4.0_f64.ln()
    }

    /// The kind that is more probable than all others together, and the logarithm of its odds.
    pub(super) fn best(&self) -> (FeatureKind, f64) {
        let best = (0..4).fold(0, |best, k| if self.0[k] > self.0[best] { k } else { best });
        let others = (0..4).filter(|k| *k != best).map(|k| (self.0[k] - self.0[best]).exp()).sum::<f64>();
        (FeatureKind::ALL[best], -others.max(f64::MIN_POSITIVE).ln())
    }
}

/// Scatters of whitened contacts and normals in two tangent directions.
struct Scatter {
    count: f64,
    /// The directions, body axes: those in which most and least moves, so that nothing depends on the axes of the body.
    axes: [DVec3; 2],
    points: DMat2,
    normals: DMat2,
    both: DMat2,
    /// Deviation of a contact (in sizes) over that of a normal (rad).
    ratio: f64,
}

/// The evidence of a run with these moments.
pub(super) fn evidence(of: &Moments) -> Evidence {
    let Some(s) = Scatter::of(of) else { return Evidence([0.0; 4]) };
    let corner = -0.5 * trace(s.points) + s.free(eigenvalues(s.normals));
    let face = -0.5 * trace(s.normals) + s.free(eigenvalues(s.points));
    Evidence([s.smooth(), corner, s.edge(), face])
}

/// Direction of an edge that a run with these moments is on, body axes.
pub(super) fn edge_direction(of: &Moments) -> Option<DVec3> {
    let s = Scatter::of(of)?;
    let along = s.across_edge().perp();
    Some(s.axes[0] * along.x + s.axes[1] * along.y)
}

impl Scatter {
    /// None where normals cancel.
    fn of(of: &Moments) -> Option<Self> {
        let (a, b) = Direction::new(of.normal).ok()?.tangent_basis();
        let any = Self::along(of, [a, b]);
        let least = smallest_direction(any.points + any.normals);
        let along = a * least.x + b * least.y;
        Some(Self::along(of, [along, of.normal.normalize().cross(along)]))
    }

    fn along(of: &Moments, axes: [DVec3; 2]) -> Self {
        let [a, b] = axes;
        let in_tangent = |m: DMat3| {
            let (ma, mb) = (m * a, m * b);
            DMat2::from_cols(DVec2::new(a.dot(ma), b.dot(ma)), DVec2::new(a.dot(mb), b.dot(mb)))
        };
        let (point, normal) = (of.point_variance.sqrt(), of.normal_variance.sqrt());
        Self {
            count: of.count,
            axes,
            points: in_tangent(of.points) * (1.0 / of.point_variance),
            normals: in_tangent(of.normals) * (1.0 / of.normal_variance),
            both: in_tangent(of.both) * (1.0 / (point * normal)),
            ratio: point / normal,
        }
    }

    /// Logarithm of the evidence of two free coordinates with these squares.
    fn free(&self, squares: [f64; 2]) -> f64 {
        let expected = (self.count - 1.0).max(1.0);
        let limit = expected + MOVES * (2.0 * expected).sqrt();
        let charge: f64 = squares.into_iter().map(|square| -0.5 * square.min(limit)).sum();
        let moves = |square: &f64| *square > limit;
        let straight = match squares {
            [a, b] if moves(&a) && moves(&b) => 1.0,
            // Where nothing moves all kinds are alike.
            [a, b] => STRAIGHT.max((a.max(b) / expected).sqrt()),
        };
        charge - straight.ln()
    }

    /// The direction across the edge that explains most: sharp across, flat along.
    fn across_edge(&self) -> DVec2 {
        smallest_direction(self.points - self.normals)
    }

    fn edge(&self) -> f64 {
        let across = self.across_edge();
        let along = across.perp();
        let misfit = along_direction(self.points, across) + along_direction(self.normals, along);
        let [low, high] = eigenvalues(self.points - self.normals);
        // Of half a turn.
        let direction = (0.5 * left_of_range(high - low)).min(1.0).ln();
        let squares = [along_direction(self.normals, across), along_direction(self.points, along)];
        -0.5 * misfit + direction + self.free(squares)
    }

    /// The principal directions are turned by an angle of which only the double counts: it is gone through by its cosine and sine alone.
    fn smooth(&self) -> f64 {
        let forms = self.forms();
        let at = |twice: DVec2| (twice, self.smooth_along(&forms, twice));
        let better = |most: (DVec2, f64), other: (DVec2, f64)| if other.1 > most.1 { other } else { most };
        let mut best = at(DVec2::X);
        let mut twice = DVec2::X;
        for _ in 1..TURNS {
            twice = twice.rotate(TWICE_SPACING);
            best = better(best, at(twice));
        }
        let mut step = half_angle(TWICE_SPACING);
        for _ in 0..REFINED {
            let beside = [best.0.rotate(conjugate(step)), best.0.rotate(step)].map(at);
            let flat = beside.iter().all(|(_, value)| (value - best.1).abs() < ENOUGH);
            best = beside.into_iter().fold(best, better);
            if flat {
                break;
            }
            step = half_angle(step);
        }
        let misfit = |twice: DVec2| self.lines(&forms, twice).iter().map(|line| line.misfit).sum::<f64>();
        let step = DVec2::from_angle(2.0 * DIFFERENCE);
        let beside = misfit(best.0.rotate(step)) + misfit(best.0.rotate(conjugate(step)));
        let bend = beside - 2.0 * misfit(best.0);
        best.1 + left_of_range(0.5 * bend / (DIFFERENCE * DIFFERENCE)).ln()
    }

    fn forms(&self) -> [Form; 3] {
        [self.points, self.normals, self.both].map(Form::of)
    }

    /// Logarithm of the evidence for a smooth surface whose principal directions are turned by half the angle of `twice`.
    fn smooth_along(&self, forms: &[Form; 3], twice: DVec2) -> f64 {
        let [a, b] = self.lines(forms, twice);
        let left = left_of_range(a.told) * left_of_range(b.told);
        left.ln() - 0.5 * (a.misfit + b.misfit) + self.free([a.along, b.along])
    }

    /// The lines along two directions at right angles.
    fn lines(&self, forms: &[Form; 3], twice: DVec2) -> [Line; 2] {
        [self.line(forms, twice), self.line(forms, -twice)]
    }

    /// The line that fits contacts over normals along a tangent direction, of those that rise.
    fn line(&self, forms: &[Form; 3], twice: DVec2) -> Line {
        let [points, normals, both] = forms.each_ref().map(|form| form.along(twice));
        let (half, mean) = (0.5 * (points - normals), 0.5 * (points + normals));
        let across = both.max(0.0);
        let length = DVec2::new(half, across).length();
        // Squares of cosine and sine of the angle between the line's normal and the axis of the normals, in whitened coordinates, twice each;
        // the angle by which the true one moves is that times the rate.
        let tilt = if length > 0.0 { half / length } else { 1.0 };
        let rate = 0.5 * (self.ratio * (1.0 + tilt) + (1.0 - tilt) / self.ratio);
        Line { misfit: mean - length, along: mean + length, told: 2.0 * length * rate * rate }
    }
}

/// A quadratic form along a tangent direction, by cosine and sine of twice its angle.
#[derive(Clone, Copy)]
struct Form {
    mean: f64,
    wave: DVec2,
}

impl Form {
    fn of(m: DMat2) -> Self {
        let (half, off) = (0.5 * (m.x_axis.x - m.y_axis.y), 0.5 * (m.x_axis.y + m.y_axis.x));
        Self { mean: 0.5 * trace(m), wave: DVec2::new(half, off) }
    }

    fn along(&self, twice: DVec2) -> f64 {
        self.mean + self.wave.dot(twice)
    }
}

#[derive(Clone, Copy)]
struct Line {
    /// Squares across it.
    misfit: f64,
    /// Squares along it.
    along: f64,
    /// Information on its angle, 1/rad^2.
    told: f64,
}

/// The share of a quarter turn that is left of an angle with this information.
fn left_of_range(told: f64) -> f64 {
    if told > 0.0 { ((TAU / told).sqrt() / FRAC_PI_2).min(1.0) } else { 1.0 }
}

/// The unit vector of the opposite angle.
fn conjugate(e: DVec2) -> DVec2 {
    DVec2::new(e.x, -e.y)
}

/// The unit vector at half of an angle of at most half a turn either way.
fn half_angle(e: DVec2) -> DVec2 {
    let larger = (0.5 * (1.0 + e.x.abs())).sqrt();
    let smaller = 0.5 * e.y / larger;
    if e.x < 0.0 { DVec2::new(smaller.abs(), larger.copysign(e.y)) } else { DVec2::new(larger, smaller) }
}

fn trace(m: DMat2) -> f64 {
    m.x_axis.x + m.y_axis.y
}

fn along_direction(m: DMat2, e: DVec2) -> f64 {
    e.dot(m * e)
}

fn eigenvalues(m: DMat2) -> [f64; 2] {
    let (half, mean) = (0.5 * (m.x_axis.x - m.y_axis.y), 0.5 * trace(m));
    let length = half.hypot(m.x_axis.y);
    [mean - length, mean + length]
}

/// Eigenvector of the smallest eigenvalue of a symmetric matrix.
fn smallest_direction(m: DMat2) -> DVec2 {
    let twice = DVec2::new(0.5 * (m.x_axis.x - m.y_axis.y), m.x_axis.y);
    // The largest one is at half of this angle.
    half_angle(twice.normalize_or(DVec2::X)).perp()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Against the angles themselves: of the line, and of its normal before lengths were whitened.
        #[test]
        fn lines_are_those_of_their_angles(
            [p, q, r, s] in prop::array::uniform4(-10.0..10.0_f64),
            rise in 0.0..1.0_f64,
            ratio in 1e-3..1e3_f64,
            turn in 0.0..FRAC_PI_2,
        ) {
            let matrix = |a: f64, b: f64| DMat2::from_cols(DVec2::new(a * a, a * b), DVec2::new(a * b, b * b));
            let (points, normals) = (matrix(p, q) + DMat2::IDENTITY, matrix(r, s) + DMat2::IDENTITY);
            let both = (points + normals) * (0.4 * rise);
            let scatter = Scatter { count: 9.0, axes: [DVec3::X, DVec3::Y], points, normals, both, ratio };
            let line = scatter.line(&scatter.forms(), DVec2::from_angle(2.0 * turn));

            let e = DVec2::from_angle(turn);
            let [a, b, c] = [points, normals, both].map(|m| along_direction(m, e));
            let angle = 0.5 * c.max(0.0).atan2(0.5 * (a - b));
            let length = (0.5 * (a - b)).hypot(c.max(0.0));
            let true_angle = (angle.sin() / ratio).atan2(angle.cos());
            let rate = ratio / (true_angle.cos().powi(2) + (ratio * true_angle.sin()).powi(2));
            let told = 2.0 * length * rate * rate;
            prop_assert!((line.misfit - (0.5 * (a + b) - length)).abs() < 1e-12 * (a + b));
            prop_assert!((line.told - told).abs() < 1e-9 * told, "{} {told}", line.told);
        }
    }
}
