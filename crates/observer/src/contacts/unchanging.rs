//! Whether the readings of a log change at all: what does not is explained by any motion.

use super::record::Record;
use crate::reliability::Reason;
use glam::DVec3;

/// Spread of the whole force over the deviation of its mean by noise, below which a log of the plane tells of a motion by its spin alone, however far contacts
/// move: of slow rocking on palms at rest motions up to 28 deviations off were found where it was 0, none from 50 on.
const FELT: f64 = 10.0;
/// Noise of the whole force that there is at least, as a share of it: that of readings of so many digits.
const SMALLEST: f64 = 1e-9;

/// Whether forces hardly change beyond noise: a judgement of the readings alone.
pub(super) fn still(record: &Record) -> Option<Reason> {
    let mut forces = [Spread::default(); 2];
    let mut variance = 0.0;
    for contacts in record.contacts.iter().filter(|contacts| !contacts.is_empty()) {
        let whole: DVec3 = contacts.iter().map(|contact| contact.f).sum();
        forces[0].add(whole.x);
        forces[1].add(whole.z);
        variance += contacts.iter().map(|contact| contact.f_deviation.powi(2)).sum::<f64>();
    }
    let samples = forces[0].count;
    let variance = variance / samples.max(1.0);
    let [x, z] = forces.map(|of| of.beyond(variance));
    let rounding = SMALLEST * forces[0].mean().hypot(forces[1].mean());
    let (spread, noise) = (x.max(z), variance.sqrt().max(rounding));
    let felt = spread * samples.sqrt() > FELT * noise;
    (!felt).then_some(Reason::Unchanging { forces: spread, noise })
}

/// Spread of readings: sums of value and square, about the first one, so that the square of a large mean does not cancel.
#[derive(Clone, Copy, Default)]
struct Spread {
    first: Option<f64>,
    sum: f64,
    squares: f64,
    count: f64,
}

impl Spread {
    fn add(&mut self, value: f64) {
        let away = value - *self.first.get_or_insert(value);
        self.sum += away;
        self.squares += away * away;
        self.count += 1.0;
    }

    fn mean(&self) -> f64 {
        self.first.unwrap_or(0.0) + self.sum / self.count.max(1.0)
    }

    /// Standard deviation beyond that of noise of such a variance.
    fn beyond(&self, noise: f64) -> f64 {
        let count = self.count.max(1.0);
        let mean = self.sum / count;
        (self.squares / count - mean * mean - noise).max(0.0).sqrt()
    }
}
