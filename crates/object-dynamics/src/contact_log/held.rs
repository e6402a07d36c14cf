//! Readings that are told again and again until there is a new one: of a sensor that measures less often than the log has samples.

use super::ContactLog;
use super::stuck::{ROUNDING, RepeatedReading, on_palm};
use glam::DVec3;

/// Readings from which on it is told whether they are held, and how many of a hundred new ones may be as one before: of a sensor that counts in steps
/// more are, and of one that measures none.
const FEWEST: usize = 10;
const IN_STEPS: usize = 5;

/// Readings of a palm that repeat, most of them, until there is a new one. What is told again comes late by so much.
#[derive(Clone, Debug, PartialEq)]
pub struct Held {
    /// From 1.
    pub palm: usize,
    /// Which of its readings.
    pub reading: RepeatedReading,
    /// Samples for each reading, on average.
    pub samples: f64,
    /// Samples at which the palm is touched and the reading is as the one before.
    pub again: Vec<usize>,
}

impl ContactLog {
    /// All that is held.
    #[must_use]
    pub fn held(&self) -> Vec<Held> {
        let mut all = Vec::new();
        for (palm, logged) in self.palms.iter().enumerate() {
            let touched: Vec<usize> = (0..self.times.len()).filter(|&k| logged.touch(k).is_some()).collect();
            let held = |reading, of: &dyn Fn(usize) -> Option<DVec3>| {
                let readings: Vec<_> = touched.iter().filter_map(|&k| Some((k, of(k)?.to_array()))).collect();
                let (samples, again) = held(&readings)?;
                Some(Held { palm: palm + 1, reading, samples, again })
            };
            // As it was told, of a palm that turns: as a part along its normal, as a place on it.
            let force = |k: usize| Some(logged.force(k)?.vector);
            let along = |k: usize| Some(DVec3::X * force(k)?.dot(logged.touch(k)?.n.get()));
            let place = |k: usize| Some(logged.touch(k)?.p_WC);
            let own_place = |k: usize| Some(on_palm(&logged.motion(k).pose, place(k)?));
            let reading = RepeatedReading::Force;
            all.extend(held(reading, &force).or_else(|| held(reading, &along)));
            let reading = RepeatedReading::Contact;
            all.extend(held(reading, &place).or_else(|| held(reading, &own_place)));
        }
        all
    }
}

/// Samples for each reading where most are told more than once, and those at which one is told again. None where they are not, of too few, and of what
/// is in steps.
fn held(readings: &[(usize, [f64; 3])]) -> Option<(f64, Vec<usize>)> {
    let mut runs: Vec<usize> = Vec::new();
    let mut new: Vec<[u64; 3]> = Vec::new();
    let mut again = Vec::new();
    let mut before: Option<&[f64; 3]> = None;
    for (k, reading) in readings {
        match runs.last_mut() {
            Some(run) if before.is_some_and(|before| is_same(before, reading)) => {
                *run += 1;
                again.push(*k);
            }
            _ => {
                runs.push(1);
                new.push(reading.map(f64::to_bits));
            }
        }
        before = Some(reading);
    }
    // Of what rests one reading is told long, and others once.
    let (_, &mut median, _) = (runs.len() >= FEWEST).then(|| runs.select_nth_unstable(new.len() / 2))?;
    if median <= 1 {
        return None;
    }
    new.sort_unstable();
    let recur = new.windows(2).filter(|pair| pair[0] == pair[1]).count();
    (recur * 100 <= IN_STEPS * new.len()).then(|| (readings.len() as f64 / new.len() as f64, again))
}

fn is_same(a: &[f64; 3], b: &[f64; 3]) -> bool {
    let size = b.iter().map(|x| x.abs()).fold(0.0, f64::max);
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ROUNDING * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn each(of: impl Fn(usize) -> f64) -> Option<f64> {
        let readings: Vec<_> = (0..60).map(|k| (k, [of(k), 0.0, 1.0])).collect();
        held(&readings).map(|(samples, again)| {
            assert!(again.iter().all(|k| of(*k) == of(k - 1)));
            samples
        })
    }

    /// Told again two or three times in turn it is; new in each sample, at rest for half of the time, in steps, or stuck once it is not.
    #[test]
    fn readings_are_held_where_most_of_them_repeat() {
        let smooth = |k: usize| (0.37 * k as f64).sin() + 0.01 * k as f64;
        assert_eq!(each(|k| smooth(k - k % 2)), Some(2.0));
        assert_eq!(each(|k| smooth(k - k % 3)), Some(3.0));
        assert_eq!(each(smooth), None);
        assert_eq!(each(|k| smooth(k.max(30))), None);
        assert_eq!(each(|k| (0.5 * (0.05 * k as f64).sin() * 4.0).round()), None);
        assert_eq!(each(|k| if (20..40).contains(&k) { smooth(20) } else { smooth(k) }), None);
        assert_eq!(held(&[]), None);
    }
}
