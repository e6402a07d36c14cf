//! What certainly contains the body: half-planes, inflated.

use super::NoiseError;
use super::windows::Window;
use crate::noise::quantile;
use exact_hull::planar::Ring;
use exact_hull::planar::{HalfPlane, Intersection, Region};
use glam::DVec2;

/// Regions that are assumed to hold the body, each so many times as large as the one before, until one proves itself.
const GROWTH: f64 = 1.5;
const TRIES: usize = 24;
/// Rounds of computing how far errors of normals can act from the bound itself.
const ROUNDS: usize = 3;

/// Quantiles for all windows together.
struct Quantiles {
    /// One-sided, of a standard normal.
    normal: f64,
    /// Of the length of two standard normals.
    length: f64,
}

/// Half-planes that all contain the body, except with probability `alpha`.
pub(super) fn certain_half_planes(lists: &[Vec<Window>], alpha: f64) -> Result<Vec<HalfPlane>, NoiseError> {
    let windows: Vec<Window> = lists.iter().flatten().copied().collect();
    let each = alpha / (4 * windows.len().max(1)) as f64;
    let quantiles = Quantiles { normal: quantile::normal(each), length: quantile::length2(each) };
    let (mut half_planes, mut region) = prove_region(&windows, &quantiles)?;
    for _ in 0..ROUNDS {
        let ring = Ring::new(region.shape().vertices());
        half_planes = windows
            .iter()
            .map(|w| {
                let plane = HalfPlane { point: w.point, normal: w.normal, margin: w.offset / w.shrink };
                w.inflated(&quantiles, ring.reach_beyond(w.normal.get(), |p| plane.excess(p), w.point))
            })
            .collect();
        match Intersection::of(&half_planes) {
            Ok(Intersection::Bounded(next)) => region = next,
            _ => break,
        }
    }
    Ok(half_planes)
}

/// A region that certainly holds the body, with the half-planes that make it.
///
/// The half-planes are inflated for the case that the body lies in a disc. If their intersection is strictly inside of that
/// disc, the part of the body in the disc does not reach its rim; a body in one piece is then all in it.
fn prove_region(windows: &[Window], quantiles: &Quantiles) -> Result<(Vec<HalfPlane>, Region), NoiseError> {
    let centre = windows.iter().map(|w| w.point).sum::<DVec2>() / windows.len().max(1) as f64;
    let mut radius = 1.5 * windows.iter().map(|w| w.point.distance(centre)).fold(0.0, f64::max);
    for _ in 0..TRIES {
        let half_planes: Vec<HalfPlane> =
            windows.iter().map(|w| w.inflated(quantiles, radius + w.point.distance(centre))).collect();
        match Intersection::of(&half_planes) {
            Ok(Intersection::Bounded(region)) => {
                if region.shape().vertices().iter().all(|v| v.distance(centre) < radius) {
                    return Ok((half_planes, region));
                }
            }
            Ok(Intersection::Unbounded(_)) => break,
            Err(error) => return Err(NoiseError::Bounds(error.into())),
        }
        radius *= GROWTH;
    }
    Err(NoiseError::NoUpperBound { reach: radius })
}

impl Window {
    /// The half-plane with its margin, when no point that it may cut off is further than `reach` from the mean point.
    fn inflated(&self, quantiles: &Quantiles, reach: f64) -> HalfPlane {
        let Quantiles { normal, length } = *quantiles;
        let independent = normal * self.offset_sd + length * self.normal_sd * reach;
        // A normal of unit length is also shortened along the true one, by half the square of its angle.
        let second_order = 0.5 * (length * self.single_normal_sd).powi(2) * reach;
        // A pose that is turned by `d` about the body's origin turns the line with it: at `y` that is `d (t . y)` along the normal, with the
        // line's direction `t`, and `d^2 |y| / 2` beyond first order. `t . y` is that of the contact, and the reach from there.
        // Quantiles are of two standard normals where the rotation is one: on the safe side.
        let turned = length * (self.pose_turning + self.pose_rotation * reach)
            + 0.5 * (length * self.most_rotation).powi(2) * (self.point.length() + reach);
        let pose = normal * self.pose_translation + turned;
        let margin = (self.offset + independent + second_order + pose) / self.shrink;
        HalfPlane { point: self.point, normal: self.normal, margin }
    }
}
