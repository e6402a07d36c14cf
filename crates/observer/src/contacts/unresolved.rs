//! Whether forces change faster than they are sampled: what the rule of order 6 misses of impulses is then no noise, and lasts.

use super::record::Record;
use crate::predicted::is_even;
use glam::DVec3;

/// Samples that the rules of order 2, 4 and 6 take for the interval in their middle.
const STENCIL: usize = 6;
/// Weights of what the rules of order 2 and 4, and of 4 and 6, differ by, over the spacing.
const FOURTH: [f64; STENCIL] = [0.0, -1.0 / 24.0, 1.0 / 24.0, 1.0 / 24.0, -1.0 / 24.0, 0.0];
const SIXTH: [f64; STENCIL] =
    [11.0 / 1440.0, -33.0 / 1440.0, 22.0 / 1440.0, 22.0 / 1440.0, -33.0 / 1440.0, 11.0 / 1440.0];
/// Intervals that tell what is missed of all, at most.
const TELL: usize = 20_000;
/// Deviations of a mean square that are taken for chance.
const CHANCE: f64 = 4.0;

impl Record {
    /// Square of the deviations that what is missed of all impulses moves an estimate by at most, if all of it counts in one direction.
    ///
    /// Rules of rising order differ by falling amounts where samples are dense enough, and what the last one misses is to its difference from the one
    /// before as that is to the difference before it. Medians: a force that jumps now and then is noise, and counted as that.
    pub(super) fn unresolved(&self) -> f64 {
        let count = self.intervals.len() as f64;
        let noise =
            self.intervals.iter().map(|interval| interval.noise.sampled[0]).sum::<f64>() / count.max(1.0);
        if !self.by_samples || noise.is_nan() || noise <= 0.0 {
            return 0.0;
        }
        let last = self.times.len().saturating_sub(STENCIL - 1);
        let impulses = |from: usize| {
            let h = self.intervals[from].h;
            std::array::from_fn(|i| self.wrenches[from + i].force * h)
        };
        // Of long logs some tell as much as all.
        let some = (0..last).step_by(last.div_ceil(TELL).max(1));
        let stencils: Vec<_> = some.filter(|&from| self.is_even(from)).map(impulses).collect();
        count * missed(&stencils, noise) / noise
    }

    /// Whether spacings are equal and contacts the same from a sample on.
    fn is_even(&self, from: usize) -> bool {
        let palms = |k: usize| self.contacts[k].iter().map(|contact| contact.palm);
        (from..from + STENCIL).all(|k| palms(k).eq(palms(from))) && is_even(&self.times[from..from + STENCIL])
    }
}

/// Square of what the rule of order 6 misses of an impulse; of forces times the spacing at the samples around each, which in sum over their axes have such
/// a variance.
fn missed(stencils: &[[DVec3; STENCIL]], noise: f64) -> f64 {
    let beyond = |weights: &[f64; STENCIL]| {
        let sum =
            |of: &[DVec3; STENCIL]| of.iter().zip(weights).map(|(f, weight)| *f * *weight).sum::<DVec3>();
        let mut squares: Vec<f64> = stencils.iter().map(|of| sum(of).length_squared()).collect();
        let (count, middle) = (squares.len().max(1), squares.len() / 2);
        let median =
            if squares.is_empty() { 0.0 } else { *squares.select_nth_unstable_by(middle, f64::total_cmp).1 };
        let by_noise = noise * weights.iter().map(|weight| weight * weight).sum::<f64>();
        (median - by_noise * (1.0 + CHANCE / (count as f64).sqrt())).max(0.0)
    };
    let [fourth, sixth] = [&FOURTH, &SIXTH].map(beyond);
    if sixth < fourth { sixth * (sixth / fourth) } else { sixth }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    /// A force that shakes by `angle` from sample to sample, with noise of a deviation.
    fn stencils(angle: f64, deviation: f64) -> Vec<[DVec3; STENCIL]> {
        let mut normal = Normal::seeded(1);
        let forces: Vec<DVec3> =
            (0..400).map(|k| DVec3::Z * ((angle * f64::from(k)).sin() + deviation * normal.draw())).collect();
        forces.windows(STENCIL).map(|all| std::array::from_fn(|i| all[i])).collect()
    }

    /// Of a sine the rule of order 6 misses 191 / 60480 of the sixth power of the angle, of the same phase as the impulse.
    #[test]
    fn what_is_missed_of_a_sine_is_told() {
        for angle in [0.3_f64, 0.6, 0.9] {
            // Weights of the rule about the middle of the interval, against the integral of the cosine there.
            let rule = [802.0_f64, -93.0, 11.0].iter().zip([0.5_f64, 1.5, 2.5]);
            let rule: f64 = rule.map(|(w, at)| 2.0 * w / 1440.0 * (at * angle).cos()).sum();
            let exact = (0.5 * angle).sin() / (0.5 * angle);
            let truth = 0.5 * (rule - exact).powi(2);
            let told = missed(&stencils(angle, 0.0), 0.0);
            assert!((0.4..1.6).contains(&(told / truth).sqrt()), "{angle}: {}", (told / truth).sqrt());
        }
    }

    #[test]
    fn noise_alone_misses_nothing() {
        assert_eq!(missed(&stencils(0.0, 1e-3), 1e-6), 0.0);
        assert_eq!(missed(&stencils(0.1, 1e-3), 1e-6), 0.0);
        assert!(missed(&stencils(1.6, 1e-3), 1e-6) > 1e-4);
    }
}
