//! What becomes of readings on their way.

use super::super::Failure;
use recon::object_dynamics::SensorLog;

/// Forces so many samples late, by a cubic through four of them; those before the first are as it.
pub(super) fn late(log: &SensorLog, by: f64) -> Result<SensorLog, Failure> {
    let mut samples = log.samples().to_vec();
    for (k, sample) in samples.iter_mut().enumerate() {
        let at = (k as f64 - by).max(0.0);
        let (from, x) = (at.floor(), at.fract());
        for (i, palm) in sample.palms.iter_mut().enumerate() {
            let place = |offset: f64| (from + offset).max(0.0) as usize;
            let force = |offset: f64| log.samples().get(place(offset))?.palms[i].force;
            let four = [force(-1.0), force(0.0), force(1.0), force(2.0)];
            let [Some(a), Some(b), Some(c), Some(d)] = four.map(|of| of.or(force(0.0))) else { continue };
            let slope = 0.5 * (c - a);
            let (bend, jerk) = (a - 2.5 * b + 2.0 * c - 0.5 * d, 0.5 * (d - a) + 1.5 * (b - c));
            palm.force = Some((b + x * (slope + x * (bend + x * jerk))).max(0.0));
        }
    }
    Ok(SensorLog::new(samples, None)?)
}

/// The white noise of a log through a filter of first order that leaves its deviation as it is.
pub(super) fn correlated(
    clean: &SensorLog,
    noisy: &SensorLog,
    correlation: f64,
) -> Result<SensorLog, Failure> {
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut samples = noisy.samples().to_vec();
    let mut held = [[0.0; 3]; 3];
    for (k, sample) in samples.iter_mut().enumerate() {
        for (i, (palm, held)) in sample.palms.iter_mut().zip(&mut held).enumerate() {
            let exact = &clean.samples()[k].palms[i];
            let share = if k == 0 { 1.0 } else { fresh };
            let before = if k == 0 { 0.0 } else { correlation };
            if let (Some(s), Some(e)) = (&mut palm.contact, exact.contact) {
                for axis in 0..2 {
                    held[axis] = before * held[axis] + share * (s[axis] - e[axis]);
                    s[axis] = e[axis] + held[axis];
                }
            }
            if let (Some(f), Some(e)) = (&mut palm.force, exact.force) {
                held[2] = before * held[2] + share * (*f - e);
                *f = e + held[2];
            }
        }
    }
    Ok(SensorLog::new(samples, None)?)
}
