//! What a log shows of what may be left out of its model: tests of what is left, each of chance once in a thousand.

use super::Evidence;
use glam::DVec3;
use object_dynamics::{ContactLog, SensedAxes};
use observer::contacts::ContactNoiseLevel;

/// A standard normal number goes beyond this, to one side, once in a thousand.
const ONCE_IN_A_THOUSAND: f64 = 3.09;
/// Stretches of a log whose means are looked at: what changes slowly shows in them far below the noise of one reading.
const STRETCHES: usize = 12;
/// Largest part across the plane of a normal, or of a palm's angular velocity in natural rates, that is rounding.
const ROUNDING: f64 = 1e-9;

/// A sum of squares of readings in their deviations, over all and over means of stretches.
#[derive(Default)]
struct Squares {
    all: [f64; 2],
    means: [f64; 2],
}

/// Beyond which a sum of so many squared standard normal numbers goes once in a thousand (Wilson and Hilferty).
fn limit(count: f64) -> f64 {
    let ninth = 2.0 / (9.0 * count);
    count * (1.0 - ninth + ONCE_IN_A_THOUSAND * ninth.sqrt()).powi(3)
}

impl Squares {
    /// Of one series of readings (each with its deviation), which lost so many degrees of freedom to what was fitted.
    fn add(&mut self, series: &[(f64, f64)], fitted: f64) {
        let square = |&(value, deviation): &(f64, f64)| (value / deviation).powi(2);
        self.all[0] += series.iter().map(square).sum::<f64>();
        self.all[1] += series.len() as f64 - fitted;
        let stretches = series.chunks(series.len().div_ceil(STRETCHES).max(1));
        for part in stretches {
            let weights: f64 = part.iter().map(|(_, deviation)| deviation.powi(-2)).sum();
            let sum: f64 = part.iter().map(|(value, deviation)| value / (deviation * deviation)).sum();
            self.means[0] += sum * sum / weights;
            self.means[1] += 1.0;
        }
        self.means[1] -= fitted;
    }

    /// The worse one of both tests, over its limit.
    fn judged(&self) -> Option<Evidence> {
        let ratio = |[sum, count]: [f64; 2]| (count >= 1.0).then(|| sum / limit(count));
        let value = ratio(self.all)?.max(ratio(self.means)?);
        Some(Evidence::Test { value, limit: 1.0 })
    }
}

impl Evidence {
    /// Whether it is a test that what is left is chance.
    #[must_use]
    pub fn is_passed_test(&self) -> bool {
        matches!(self, Self::Test { value, limit } if value <= limit)
    }
}

/// Whether all motion is in the plane of the world's x and z axes, to within noise: contacts on one line of sight, forces with no part across, palms
/// that neither turn nor move out of it. Of sums of squares over their limits the largest.
#[must_use]
pub fn is_planar(log: &ContactLog, noise: &ContactNoiseLevel) -> Evidence {
    if noise.contact <= 0.0 || log.palms().iter().any(|palm| palm.force_axes().is_none()) {
        return Evidence::Impossible;
    }
    let count = log.times().len();
    let touches = || log.palms().iter().flat_map(move |palm| (0..count).filter_map(|k| palm.touch(k)));
    let total = touches().count() as f64;
    let mean = touches().map(|touch| touch.p_WC.y).sum::<f64>() / total;
    let mut squares = Squares::default();
    for (i, palm) in log.palms().iter().enumerate() {
        let (mut contacts, mut forces) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for k in 0..count {
            let moving = palm.motion(k);
            let across = moving.w_WP.reject_from_normalized(DVec3::Y).length();
            let duration = log.duration();
            if across * duration > ROUNDING || (moving.v_WP.y * duration).abs() > ROUNDING {
                return Evidence::Test { value: f64::MAX, limit: 1.0 };
            }
            let (Some(touch), Some(force)) = (palm.touch(k), palm.force(k)) else { continue };
            contacts.push((touch.p_WC.y - mean, noise.contact));
            let deviation = noise.force_fixed.hypot(noise.force_share * force.vector.length());
            // A force along a normal that is known points out of the plane by as much as that does: nothing hides it but the noise of the others.
            if force.axes == SensedAxes::Three || touch.n.get().y.abs() > ROUNDING {
                forces.push((force.vector.y, deviation.max(f64::MIN_POSITIVE)));
            }
        }
        squares.add(&contacts, if i == 0 { 1.0 } else { 0.0 });
        squares.add(&forces, 0.0);
    }
    squares.judged().unwrap_or(Evidence::Impossible)
}

/// Whether the forces of all palms that measure three axes are along their normals, to within noise.
#[must_use]
pub fn is_frictionless(log: &ContactLog, noise: &ContactNoiseLevel) -> Evidence {
    let mut squares = Squares::default();
    for palm in log.palms().iter().filter(|palm| palm.force_axes() == Some(SensedAxes::Three)) {
        let mut parts: [Vec<(f64, f64)>; 2] = Default::default();
        for k in 0..log.times().len() {
            let (Some(touch), Some(force)) = (palm.touch(k), palm.force(k)) else { continue };
            let n = touch.n.get();
            let deviation = noise.force_fixed.hypot(noise.force_share * force.vector.length());
            // Tangents that turn with the palm, so that what is steady stays so.
            let x = palm.motion(k).pose.R_WP * DVec3::X;
            let first = x.reject_from_normalized(n).normalize_or(n.any_orthonormal_vector());
            for (part, tangent) in parts.iter_mut().zip([first, n.cross(first)]) {
                part.push((force.vector.dot(tangent), deviation.max(f64::MIN_POSITIVE)));
            }
        }
        parts.iter().for_each(|part| squares.add(part, 0.0));
    }
    squares.judged().unwrap_or(Evidence::Impossible)
}

/// How far forces are from balance, as a share of the weight of a body of `mass` (kg): root mean square, beside what noise makes of it.
#[must_use]
pub fn out_of_balance(log: &ContactLog, noise: &ContactNoiseLevel, mass: f64, gravity: f64) -> Evidence {
    let (mut squares, mut chance, mut count) = (0.0, 0.0, 0.0_f64);
    for k in 0..log.times().len() {
        let forces: Vec<DVec3> =
            log.palms().iter().filter_map(|palm| palm.force(k)).map(|of| of.vector).collect();
        let sum: DVec3 = forces.iter().sum();
        squares += (sum / mass - gravity * DVec3::Z).length_squared();
        let deviation = |f: &DVec3| noise.force_fixed.hypot(noise.force_share * f.length());
        chance += forces.iter().map(|f| 3.0 * deviation(f).powi(2)).sum::<f64>() / (mass * mass);
        count += 1.0;
    }
    let [value, own] = [squares, chance].map(|sum| (sum / count.max(1.0)).sqrt() / gravity);
    Evidence::Test { value, limit: own * (limit(3.0 * count.max(1.0)) / (3.0 * count.max(1.0))).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_those_of_tables() {
        // Chi-squared at 0.999 of 3, 10 and 100 degrees of freedom; the approximation is 1.8 %, 0.4 % and 0.02 % above.
        for (count, table) in [(3.0, 16.27), (10.0, 29.59), (100.0, 149.45)] {
            assert!((limit(count) / table - 1.0).abs() < 0.02, "{count}: {}", limit(count));
        }
    }
}
