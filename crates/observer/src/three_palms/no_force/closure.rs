//! Where two contact curves have the same normal, they must be at the same point.

use super::problem::{Guess, TouchProblem};
use super::series::TouchSeries;
use super::shape::FreeEllipsoid;
use contact_kinematics::{Direction, SupportFunction};
use glam::DVec3;

/// Angle between normals below which the curvature carries one contact to the other with an error of second order, rad.
const NEAR: f64 = 0.03;
/// Time that must lie between two visits of one palm, as a share of the whole.
const APART: f64 = 0.1;

/// Agreement of contacts that the body made with nearly the same normal, at other times or on other palms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closure {
    /// Pairs of contacts compared.
    pub pairs: usize,
    /// Root mean square of their distance, m, after the shape's curvature has carried one to the other.
    pub distance_rms: f64,
    /// What noise of single samples leaves of it, m.
    pub noise_explains: f64,
}

/// Compares the measured contacts, taken into the body by the motion found.
pub(super) fn closure(
    series: &TouchSeries,
    problem: &TouchProblem<'_>,
    guess: &Guess,
    noise: f64,
) -> Option<Closure> {
    let motion = problem.motion(guess, problem.nodes.t.len())?;
    let shape = FreeEllipsoid::new(&guess.shape);
    let stride = (series.t.len() - 1) / (problem.nodes.t.len() - 1).max(1);
    let mut visits: Vec<(usize, f64, DVec3, DVec3)> = Vec::new();
    for (k, now) in motion.iter().enumerate() {
        for i in 0..3 {
            let (palm, s) = (&now.palms[i], series.contacts[k * stride][i]);
            let back = now.R_WO.inverse();
            let point = back * (palm.frame.contact_from_sensor(s) - now.touch.p_WCm);
            visits.push((i, now.t, back * -palm.frame.n, point));
        }
    }
    let long = APART * series.duration();
    let (mut pairs, mut square) = (0, 0.0);
    for (k, a) in visits.iter().enumerate() {
        for b in &visits[k + 1..] {
            if (a.0 == b.0 && (a.1 - b.1).abs() < long) || a.2.distance_squared(b.2) > NEAR * NEAR {
                continue;
            }
            let middle = Direction::new(a.2 + b.2).ok()?;
            let carried = b.3 + shape.jet(middle).hessian * (a.2 - b.2);
            pairs += 1;
            square += carried.distance_squared(a.3);
        }
    }
    // Two coordinates of each of the two contacts are noisy.
    (pairs > 0).then(|| Closure {
        pairs,
        distance_rms: (square / pairs as f64).sqrt(),
        noise_explains: 2.0 * noise,
    })
}
