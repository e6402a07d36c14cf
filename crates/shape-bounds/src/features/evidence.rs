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
/// Turns of the principal directions that are tried before the best is refined.
const TURNS: u32 = 12;
/// Steps of the refinement: to a thousandth of the spacing.
const REFINED: u32 = 10;
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

    fn smooth(&self) -> f64 {
        let spacing = FRAC_PI_2 / f64::from(TURNS);
        let better = |most: (f64, f64), turn: f64| {
            let value = self.smooth_along(turn);
            if value > most.1 { (turn, value) } else { most }
        };
        let start = (0.0, self.smooth_along(0.0));
        let mut best = (1..TURNS).map(|k| f64::from(k) * spacing).fold(start, better);
        let mut step = 0.5 * spacing;
        for _ in 0..REFINED {
            best = [best.0 - step, best.0 + step].into_iter().fold(best, better);
            step *= 0.5;
        }
        let misfit = |turn: f64| self.lines(turn).map(|line| line.misfit).into_iter().sum::<f64>();
        let bend = misfit(best.0 + DIFFERENCE) + misfit(best.0 - DIFFERENCE) - 2.0 * misfit(best.0);
        best.1 + left_of_range(0.5 * bend / (DIFFERENCE * DIFFERENCE)).ln()
    }

    /// Logarithm of the evidence for a smooth surface whose principal directions are turned so far.
    fn smooth_along(&self, turn: f64) -> f64 {
        let lines = self.lines(turn);
        let of_one = |line: &Line| left_of_range(line.told).ln() - 0.5 * line.misfit;
        lines.iter().map(of_one).sum::<f64>() + self.free(lines.map(|line| line.along))
    }

    fn lines(&self, turn: f64) -> [Line; 2] {
        let e = DVec2::from_angle(turn);
        [self.line(e), self.line(e.perp())]
    }

    /// The line that fits contacts over normals along a tangent direction, of those that rise.
    fn line(&self, e: DVec2) -> Line {
        let along = |m: DMat2| along_direction(m, e);
        let (a, b, c) = (along(self.points), along(self.normals), along(self.both));
        let (half, mean) = (0.5 * (a - b), 0.5 * (a + b));
        let length = half.hypot(c.max(0.0));
        // Of the angle between the line's normal and the axis of the normals, in whitened coordinates.
        let angle = 0.5 * c.max(0.0).atan2(half);
        let true_angle = (angle.sin() / self.ratio).atan2(angle.cos());
        let (sin, cos) = true_angle.sin_cos();
        let rate = self.ratio / (cos * cos + self.ratio * self.ratio * sin * sin);
        Line { misfit: mean - length, along: mean + length, told: 2.0 * length * rate * rate }
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
    let half = 0.5 * (m.x_axis.x - m.y_axis.y);
    // The largest one is at half of this angle.
    DVec2::from_angle(0.5 * m.x_axis.y.atan2(half)).perp()
}
