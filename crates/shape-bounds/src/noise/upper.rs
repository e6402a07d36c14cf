//! What certainly contains the body: half-spaces, inflated.

use super::model::NoiseError;
use super::quantile;
use super::windows::Window;
use contact_kinematics::in_parts;
use exact_hull::HalfSpace;
use exact_hull::{Intersection, Polyhedron};
use glam::DVec3;

/// Regions that are assumed to hold the body, each so many times as large as the one before, until one proves itself.
const GROWTH: f64 = 1.5;
const TRIES: usize = 24;
/// Rounds of computing how far errors of normals can act from the bound itself; the third gains less than a hundredth.
const ROUNDS: usize = 3;
/// Quantiles for a window, so that margins hold for all together.
#[derive(Clone, Copy)]
struct Quantiles {
    /// One-sided, of a standard normal.
    normal: f64,
    /// Of the length of three standard normals.
    length: f64,
    /// Deviations that the poses are off by at most.
    poses: f64,
}

/// Half-spaces that all contain the body, except with a probability of both parts of `alpha` together.
///
/// For a contact measured as `x^`, `n^` where the truth is `x`, `n`, every point `y` of the body has
/// `n^.(y - x^) <= (n^ - n).(y - x) - n^.(x^ - x)`: an error of the offset, and one of the normal that acts over the
/// distance from the contact to `y`. Only those `y` matter that the unmoved half-space would cut off.
///
/// `poses` is the number of deviations that the poses are off by at most: an error of the pose moves every `y` along `n^` by as
/// much as a point of the body that stands there.
///
/// Means over `faces` have the second part of the odds.
pub(super) fn certain_half_spaces(
    lists: &[Vec<Window>],
    faces: &[Window],
    alpha: [f64; 2],
    poses: f64,
) -> Result<Vec<HalfSpace>, NoiseError> {
    let of = |each: f64| Quantiles { normal: quantile::normal(each), length: quantile::length3(each), poses };
    let count: usize = lists.iter().map(Vec::len).sum();
    let [all, few] = [(alpha[0], count), (alpha[1], faces.len())]
        .map(|(alpha, count)| of(alpha / (2 * count.max(1)) as f64));
    let chosen = faces.iter().map(|face| (*face, few));
    let windows: Vec<(Window, Quantiles)> =
        lists.iter().flatten().map(|window| (*window, all)).chain(chosen).collect();

    let centre = windows.iter().map(|(w, _)| w.point).sum::<DVec3>() / windows.len().max(1) as f64;
    let size = windows.iter().map(|(w, _)| w.point.distance(centre)).fold(0.0, f64::max);
    let (mut half_spaces, mut region) = prove_region(&windows, centre, size)?;
    for _ in 0..ROUNDS {
        half_spaces = in_parts(&windows, |windows| {
            let mut caps = region.caps();
            let one = |(w, quantiles): &(Window, Quantiles)| {
                let plane = HalfSpace { point: w.point, normal: w.normal, margin: w.offset / w.shrink };
                w.inflated(quantiles, caps.reach(&plane, w.point))
            };
            windows.iter().map(one).collect()
        });
        match Intersection::of(&half_spaces) {
            Ok(Intersection::Bounded(next)) => region = next,
            _ => break,
        }
    }
    Ok(half_spaces)
}

/// A region that certainly holds the body, with the half-spaces that make it.
///
/// The half-spaces are inflated for the case that the body lies in a ball. If their intersection is strictly inside of
/// that ball, the part of the body in the ball does not reach the ball's surface; a body in one piece is then all in it.
fn prove_region(
    windows: &[(Window, Quantiles)],
    centre: DVec3,
    size: f64,
) -> Result<(Vec<HalfSpace>, Polyhedron), NoiseError> {
    let mut radius = 1.5 * size;
    for _ in 0..TRIES {
        let half_spaces: Vec<HalfSpace> = windows
            .iter()
            .map(|(w, quantiles)| w.inflated(quantiles, radius + w.point.distance(centre)))
            .collect();
        match Intersection::of(&half_spaces) {
            Ok(Intersection::Bounded(region)) => {
                if region.vertices().iter().all(|v| v.distance(centre) < radius) {
                    return Ok((half_spaces, region));
                }
            }
            Ok(Intersection::Unbounded(_)) => break,
            Err(error) => return Err(NoiseError::Bounds(error.into())),
        }
        radius *= GROWTH;
    }
    Err(NoiseError::NoUpperBound)
}

impl Window {
    /// The half-space with its margin, when no point that it may cut off is further than `reach` from the mean point.
    fn inflated(&self, quantiles: &Quantiles, reach: f64) -> HalfSpace {
        let Quantiles { normal, length, poses } = *quantiles;
        let independent = normal * self.offset_sd + length * self.normal_sd * reach;
        // A normal of unit length is also shortened along the true one, by half the square of its angle.
        let second_order = 0.5 * (length * self.single_normal_sd).powi(2) * reach;
        let pose =
            poses * self.pose_of_plane.deviation(self.point, reach) + self.pose_second_order(poses, reach);
        let margin = (self.offset + independent + second_order + pose) / self.shrink;
        HalfSpace { point: self.point, normal: self.normal, margin }
    }
}
