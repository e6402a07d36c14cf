//! Several samples as one, where a log has more of them than the motion needs.

use crate::{PalmReading, Sample, SensorLog, TrueState};
use contact_kinematics::Direction;
use glam::DVec3;

/// A block may last at most so many times as long as the median one: else there is a gap in it.
const LONGEST_BLOCK: f64 = 1.5;
/// The mean over a block lies off the middle by a 24th of the second difference of such means, to third order.
const MEAN_OFF_MIDDLE: f64 = 24.0;
/// Variance of fourth differences of white noise of unit variance.
const FOURTH_DIFFERENCE: f64 = 70.0;
/// What means may be off the middle, in deviations of their noise. White noise alone seems to be off by `sqrt(6) / 24`, 0.10.
const LARGEST_BIAS: f64 = 0.15;
/// Channels of a palm: normal, contact, force, torque, rate.
const CHANNELS: usize = 8;

impl SensorLog {
    /// The log up to its first loss of contact with one sample for every `block` of them: means of the readings, at the mean of
    /// their times, and the truth of the middle sample. Sums of readings over time stay what they are, so nothing is lost of white noise's
    /// averaging; its deviations become smaller by `sqrt(block)`. What follows the last whole block before a loss stays as it is.
    ///
    /// `None` where that would change the readings: where a block has a gap or lasts long enough for the mean to be off the
    /// middle by 0.15 deviations of its own noise (root mean square, noise from fourth differences), and by a share `blurred` of the largest
    /// reading, so that readings without noise have means as well; and where a channel is not measured throughout.
    #[must_use]
    pub fn condensed(&self, block: usize, blurred: f64) -> Option<Self> {
        let end = self.first_contact_loss().map_or(self.samples().len(), |(sample, _)| sample);
        let whole = end / block.max(1) * block;
        let blocks: Vec<&[Sample]> = self.samples()[..whole].chunks_exact(block.max(1)).collect();
        let means: Option<Vec<Sample>> = blocks.iter().map(|samples| mean(samples)).collect();
        let means = means.filter(|means| means.len() >= 5)?;
        if has_gap(&blocks) || has_bias(&means, blurred) {
            return None;
        }
        let after = if end < self.samples().len() { &self.samples()[whole..] } else { &[] };
        let truth = self.truth().map(|truth| {
            let middles = truth[..whole].chunks_exact(block).map(|states| states[block / 2]);
            middles.chain(truth[whole..whole + after.len()].iter().copied()).collect::<Vec<TrueState>>()
        });
        let samples = means.into_iter().chain(after.iter().copied()).collect();
        Self::new(samples, truth).ok()
    }
}

fn has_gap(blocks: &[&[Sample]]) -> bool {
    let mut lengths: Vec<f64> = blocks.windows(2).map(|pair| pair[1][0].t - pair[0][0].t).collect();
    let longest = lengths.iter().copied().fold(0.0, f64::max);
    let middle = lengths.len() / 2;
    longest > LONGEST_BLOCK * *lengths.select_nth_unstable_by(middle, f64::total_cmp).1
}

/// The mean of samples that are all in contact; `None` where a reading is not in all of them.
fn mean(samples: &[Sample]) -> Option<Sample> {
    let count = samples.len() as f64;
    let mut palms = samples[0].palms;
    for (i, palm) in palms.iter_mut().enumerate() {
        let mut sum = [0.0; CHANNELS];
        for sample in samples {
            let now = &sample.palms[i];
            let alike = now.force.is_some() == palm.force.is_some()
                && now.torque.is_some() == palm.torque.is_some()
                && now.rate.is_some() == palm.rate.is_some();
            if !alike {
                return None;
            }
            sum.iter_mut().zip(channels(now)?).for_each(|(sum, value)| *sum += value);
        }
        let [x, y, z, s1, s2, force, torque, rate] = sum.map(|sum| sum / count);
        *palm = PalmReading {
            normal: Direction::new(DVec3::new(x, y, z)).ok()?,
            contact: Some([s1, s2]),
            force: palm.force.map(|_| force),
            torque: palm.torque.map(|_| torque),
            rate: palm.rate.map(|_| rate),
        };
    }
    Some(Sample { t: samples.iter().map(|sample| sample.t).sum::<f64>() / count, palms })
}

/// What a palm reads; 0 for what it does not measure.
fn channels(palm: &PalmReading) -> Option<[f64; CHANNELS]> {
    let (n, s) = (palm.normal.get(), palm.contact?);
    let [force, torque, rate] = [palm.force, palm.torque, palm.rate].map(Option::unwrap_or_default);
    Some([n.x, n.y, n.z, s[0], s[1], force, torque, rate])
}

/// Whether the means are off the middles of their blocks by more than their noise hides and than this share of the largest one, in any channel.
fn has_bias(means: &[Sample], blurred: f64) -> bool {
    let is_biased = |palm: usize, channel: usize| {
        let series: Vec<f64> =
            means.iter().filter_map(|m| channels(&m.palms[palm]).map(|all| all[channel])).collect();
        let largest = series.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let second = series.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).powi(2));
        let fourth = series.windows(5).map(|w| (w[0] - 4.0 * w[1] + 6.0 * w[2] - 4.0 * w[3] + w[4]).powi(2));
        let rms = |squares: f64, count: usize| (squares / count as f64).sqrt();
        let bias = rms(second.sum(), series.len() - 2) / MEAN_OFF_MIDDLE;
        let noise = rms(fourth.sum(), series.len() - 4) / FOURTH_DIFFERENCE.sqrt();
        bias > LARGEST_BIAS * noise && bias > blurred * largest
    };
    (0..3).any(|palm| (0..CHANNELS).any(|channel| is_biased(palm, channel)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROWS: u32 = 20_000;
    /// Rows a second.
    const FAST: f64 = 300_000.0;

    /// Contacts that swing with some Hz, `rate` rows a second, with white noise.
    fn log(rate: f64, noise: f64) -> SensorLog {
        let mut state = 1_u64;
        let mut uniform = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let mut noisy = move |value: f64| value + noise * (0..12).map(|_| uniform()).sum::<f64>();
        let palm = |i: u32| {
            let azimuth = 2.1 * f64::from(i);
            Direction::new(DVec3::new(azimuth.sin(), azimuth.cos(), 0.5)).unwrap()
        };
        let samples = (0..ROWS).map(|k| {
            let t = f64::from(k) / rate;
            let palms = [0, 1, 2].map(|i| PalmReading {
                normal: palm(i),
                contact: Some([noisy((7.0 * t + f64::from(i)).sin()), noisy((5.0 * t).cos())]),
                force: Some(noisy(3.0 + (6.0 * t).sin())),
                torque: None,
                rate: None,
            });
            Sample { t, palms }
        });
        SensorLog::new(samples.collect(), None).unwrap()
    }

    #[test]
    fn means_keep_what_is_smooth_and_average_what_is_noise() {
        let (exact, noisy) = (log(FAST, 0.0), log(FAST, 1e-3));
        let (means, averaged) = (exact.condensed(5, 1e-9).unwrap(), noisy.condensed(5, 1e-9).unwrap());
        assert_eq!(means.samples().len(), ROWS as usize / 5);
        let s = |log: &SensorLog, k: usize| log.samples()[k].palms[0].contact.unwrap()[0];
        let mut squares = 0.0;
        for (k, sample) in means.samples().iter().enumerate() {
            let t = sample.t;
            assert!((t - (5.0 * k as f64 + 2.0) / FAST).abs() < 1e-15);
            // A 24th of the square of the block's length, less that of a sample, times 49, the largest second derivative.
            let allowed = 49.0 * (25.0 - 1.0) / 24.0 / (FAST * FAST) * (1.0 + 1e-4);
            assert!((s(&means, k) - (7.0 * t).sin()).abs() < allowed);
            squares += (s(&averaged, k) - s(&means, k)).powi(2);
        }
        let deviation = (squares / means.samples().len() as f64).sqrt();
        // 4000 draws: known to 1.1 %.
        assert!((deviation / (1e-3 / 5.0_f64.sqrt()) - 1.0).abs() < 0.04, "{deviation:.3e}");
    }

    #[test]
    fn what_means_would_blur_is_left_as_it_is() {
        // Blocks of 5 ms: off by 5e-5, which noise of 1e-2 hides and noise of 1e-6 does not.
        assert!(log(1000.0, 1e-2).condensed(5, 1e-9).is_some());
        assert!(log(1000.0, 1e-6).condensed(5, 1e-9).is_none());
        assert!(log(1000.0, 0.0).condensed(5, 1e-9).is_none());
        // Of 17 microseconds: off by 6e-10, which 1e-12 of the readings does not hide, and noise does.
        assert!(log(FAST, 0.0).condensed(5, 1e-12).is_none());
        assert!(log(FAST, 1e-3).condensed(5, 1e-12).is_some());
        let gap = |mut samples: Vec<Sample>| {
            samples.iter_mut().skip(777).for_each(|sample| sample.t += 1e-3);
            SensorLog::new(samples, None).unwrap()
        };
        assert!(gap(log(FAST, 0.0).samples().to_vec()).condensed(5, 1e-9).is_none());
    }

    #[test]
    fn a_loss_of_contact_stays_where_it_is() {
        let mut samples = log(FAST, 0.0).samples().to_vec();
        samples[10_003].palms[1].contact = None;
        samples[10_003].palms[1].force = Some(0.0);
        let lost = samples[10_003].t;
        let log = SensorLog::new(samples, None).unwrap().condensed(5, 1e-9).unwrap();
        assert_eq!(log.first_contact_loss(), Some((2003, 1)));
        assert_eq!(log.samples()[2003].t, lost);
        assert_eq!(log.samples().len(), 2000 + ROWS as usize - 10_000);
    }
}
