//! What the ratios before say of the next one.
//!
//! Bins of the ratio are three hundredths of it wide, and narrow only next to the cone, where sticking ends. Forces that are known better than a bin is wide
//! say where in it the ratio is, and so where the next one will be. Were that left out, frictions next to whose cones a ratio happens to be would foretell it
//! the better for their narrow bins, at each sample once more, and a friction that was known from sliding would be given up for them.

use super::contact::Force;
use super::density::Ratio;
use super::normal::log_density;
use super::steps::{CHANGED, PACES, walked_ratio};

/// Share of readings that nothing foretells.
const FRESH: f64 = 0.05;
/// Deviations beyond which a ratio has jumped, and is known by the last reading alone.
const JUMPED: f64 = 5.0;
/// Logarithm beside the largest below which a density adds nothing.
const OF_NO_ACCOUNT: f64 = -60.0;
/// Variances of a reading that the spread of a bin is at least, so that what is in it matters.
const WIDE: f64 = 1.0;

/// A ratio that walks at some pace.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Level {
    /// How probable the pace is.
    share: f64,
    mean: f64,
    variance: f64,
}

/// The next ratio by those before.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Foretold {
    /// None before one was read.
    paces: Option<[Level; PACES]>,
}

impl Foretold {
    /// Puts into a force that presses what was foretold of it `dt` seconds before, and goes on with it.
    pub(super) fn tell(&mut self, dt: f64, force: &mut Force) {
        for (pace, level) in self.paces.iter_mut().flatten().enumerate() {
            level.variance += walked_ratio(pace, dt).powi(2);
        }
        if let Force::Presses { ratio, foretold, .. } = force {
            *foretold = *self;
            self.take(ratio);
        }
    }

    fn take(&mut self, ratio: &Ratio) {
        let noise = ratio.deviation.powi(2);
        let (size, fresh) =
            (ratio.size, Level { share: 1.0 / PACES as f64, mean: ratio.size, variance: noise });
        let Some(paces) = &mut self.paces else {
            self.paces = Some([fresh; PACES]);
            return;
        };
        let is_far = |level: &Level| (size - level.mean).powi(2) > JUMPED.powi(2) * (level.variance + noise);
        if paces.iter().all(is_far) {
            *paces = [fresh; PACES];
            return;
        }
        let mut sum = 0.0;
        for level in paces.iter_mut() {
            let told = log_density(size - level.mean, level.variance + noise).exp();
            level.share = (level.share + CHANGED * (1.0 / PACES as f64 - level.share)) * told;
            sum += level.share;
            let gain = level.variance / (level.variance + noise);
            level.mean += gain * (size - level.mean);
            level.variance *= 1.0 - gain;
        }
        paces.iter_mut().for_each(|level| level.share /= sum);
    }

    /// Log-density of the size of a ratio that is truly in a bin of these edges, of this variance if it may be anywhere in it.
    pub(super) fn log_in(&self, ratio: &Ratio, [lower, upper]: [f64; 2], spread: f64) -> f64 {
        let noise = ratio.deviation.powi(2);
        let off = ratio.size - 0.5 * (lower + upper);
        let anywhere = log_density(off, noise + spread);
        let Some(paces) = self.paces.as_ref().filter(|_| spread > WIDE * noise) else { return anywhere };
        // Logarithms beside that of anywhere in the bin.
        let near = paces.map(|level| {
            // Of what leads out of the bin the nearest is in it.
            let mean = level.mean.clamp(lower, upper);
            let variance = noise + level.variance.min(spread);
            let wider = (noise + spread) / variance;
            (0.5 * (off * off / (noise + spread) - (ratio.size - mean).powi(2) / variance), wider)
        });
        let top = near.iter().fold(0.0_f64, |top, (log, _)| top.max(*log));
        if near.iter().all(|(log, _)| log - top < OF_NO_ACCOUNT) {
            return anywhere + FRESH.ln();
        }
        let told =
            |((log, wider), level): (&(f64, f64), &Level)| level.share * wider.sqrt() * (log - top).exp();
        anywhere
            + top
            + (FRESH * (-top).exp() + (1.0 - FRESH) * near.iter().zip(paces).map(told).sum::<f64>()).ln()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    fn pressed(ratio: Ratio) -> Force {
        Force::Presses { ratio, touching: 0.0, off: f64::NEG_INFINITY, foretold: Foretold::default() }
    }

    /// Of a ratio that falls slowly through a wide bin each reading is as likely as its own noise makes it, and not as the width of the bin does; and where it jumps,
    /// as likely as before but for the share that nothing foretells.
    #[test]
    fn where_a_ratio_is_in_a_bin_is_foretold() {
        let (mut normal, mut way, mut gained) = (Normal::seeded(3), Foretold::default(), 0.0);
        let (noise, edges): (f64, [f64; 2]) = (1e-3, [0.36, 0.372]);
        let spread = (edges[1] - edges[0]).powi(2) / 12.0;
        let anywhere = |ratio: &Ratio| log_density(ratio.size - 0.366, noise * noise + spread);
        for k in 0..40 {
            let size = 0.371 - 2e-4 * f64::from(k) + noise * normal.draw();
            let mut force = pressed(Ratio { size, deviation: noise });
            way.tell(1e-3, &mut force);
            let Force::Presses { ratio, foretold, .. } = force else { continue };
            if k > 5 {
                gained += foretold.log_in(&ratio, edges, spread) - anywhere(&ratio);
            }
        }
        // A walk that is known to 1.4 deviations of a reading, against a spread of 3.6.
        assert!((0.4..1.3).contains(&(gained / 34.0)), "{}", gained / 34.0);
        let jumped = Ratio { size: 0.371, deviation: noise };
        let lost = anywhere(&jumped) - way.log_in(&jumped, edges, spread);
        assert!(lost > 1.0 && lost <= -FRESH.ln() + 1e-12, "{lost}");
    }
}
