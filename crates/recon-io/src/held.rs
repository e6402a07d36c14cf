//! Readings that are told again and again until there is a new one: of a sensor that measures less often than the log has rows.

use glam::DVec3;
use recon::object_dynamics::ContactLog;
use std::fmt;

/// Readings from which on it is told whether they are held, and how many of a hundred new ones may be as one before: of a sensor that counts in steps
/// more are, and of one that measures none.
const FEWEST: usize = 10;
const IN_STEPS: usize = 5;
/// Difference of a place in the palm's frame that is rounding, as a share of the place.
const ROUNDING: f64 = 1e-12;

/// What of a palm is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum HeldReading {
    /// Its forces.
    Forces,
    /// Its contacts, in the world or on the palm.
    Contacts,
}

/// Readings of a palm that repeat, most of them, until there is a new one. What is told late so is taken for what it was when it was told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Number from 1.
    pub palm: usize,
    /// Which of its readings.
    pub reading: HeldReading,
    /// Rows for each reading, on average.
    pub rows: f64,
}

impl fmt::Display for Held {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { palm, reading, rows } = self;
        let what = if *reading == HeldReading::Forces { "forces" } else { "contacts" };
        write!(
            f,
            "the {what} of palm {palm} repeat to the last digit until there is a new reading, over {rows:.1} rows on average: a sensor that measures less often \
             than the log has rows. What repeats comes late, as much as {:.1} rows, and is taken for new: give a log with a row for each of its readings",
            rows - 1.0
        )
    }
}

/// All that is held in a log.
#[must_use]
pub fn held_readings(log: &ContactLog) -> Vec<Held> {
    let mut all = Vec::new();
    for (palm, logged) in log.palms().iter().enumerate() {
        let samples: Vec<usize> = (0..log.times().len()).filter(|&k| logged.touch(k).is_some()).collect();
        let rows = |of: &dyn Fn(usize) -> Option<DVec3>| {
            rows_of_each(&samples.iter().filter_map(|&k| Some(of(k)?.to_array())).collect::<Vec<_>>())
        };
        let force = |k: usize| Some(logged.force(k)?.vector);
        // Held as it was told, of a palm that turns: as a part along its normal, as a place on it.
        let along = |k: usize| Some(DVec3::X * force(k)?.dot(logged.touch(k)?.n.get()));
        let place = |k: usize| Some(logged.touch(k)?.p_WC);
        let on_palm = |k: usize| {
            let pose = logged.motion(k).pose;
            Some(pose.R_WP.conjugate() * (place(k)? - pose.p_WP))
        };
        let of = |reading| move |rows| Held { palm: palm + 1, reading, rows };
        all.extend(rows(&force).or_else(|| rows(&along)).map(of(HeldReading::Forces)));
        all.extend(rows(&place).or_else(|| rows(&on_palm)).map(of(HeldReading::Contacts)));
    }
    all
}

/// Rows for each reading where most are told more than once. None where they are not, of too few, and of what is in steps.
fn rows_of_each(readings: &[[f64; 3]]) -> Option<f64> {
    let mut runs: Vec<usize> = Vec::new();
    let mut new: Vec<[u64; 3]> = Vec::new();
    let mut before: Option<&[f64; 3]> = None;
    for reading in readings {
        match runs.last_mut() {
            Some(run) if before.is_some_and(|before| is_same(before, reading)) => *run += 1,
            _ => {
                runs.push(1);
                new.push(reading.map(f64::to_bits));
            }
        }
        before = Some(reading);
    }
    // Of what rests one reading is told long, and others once.
    let (_, &mut median, _) = (runs.len() >= FEWEST).then(|| runs.select_nth_unstable(new.len() / 2))?;
    new.sort_unstable();
    let again = new.windows(2).filter(|pair| pair[0] == pair[1]).count();
    let held = median > 1 && again * 100 <= IN_STEPS * new.len();
    held.then(|| readings.len() as f64 / new.len() as f64)
}

fn is_same(a: &[f64; 3], b: &[f64; 3]) -> bool {
    let size = b.iter().map(|x| x.abs()).fold(0.0, f64::max);
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ROUNDING * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn each(of: impl Fn(usize) -> f64) -> Option<f64> {
        rows_of_each(&(0..60).map(|k| [of(k), 0.0, 1.0]).collect::<Vec<_>>())
    }

    /// Told again two or three times in turn it is; new in each row, at rest for half of the time, in steps, or stuck once it is not.
    #[test]
    fn readings_are_held_where_most_of_them_repeat() {
        let smooth = |k: usize| (0.37 * k as f64).sin() + 0.01 * k as f64;
        assert_eq!(each(|k| smooth(k - k % 2)), Some(2.0));
        assert_eq!(each(|k| smooth(k - k % 3)), Some(3.0));
        assert_eq!(each(smooth), None);
        assert_eq!(each(|k| smooth(k.max(30))), None);
        assert_eq!(each(|k| (0.5 * (0.05 * k as f64).sin() * 4.0).round()), None);
        assert_eq!(each(|k| if (20..40).contains(&k) { smooth(20) } else { smooth(k) }), None);
        assert_eq!(rows_of_each(&[]), None);
    }
}
