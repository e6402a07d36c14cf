/// An interval longer than this many usual ones is one in which readings are missing.
const LONG: f64 = 1.5;

/// How regularly readings come.
#[derive(Clone, Debug, PartialEq)]
pub struct Rhythm {
    /// Median of the intervals, s; none of fewer than two readings.
    pub period: Option<f64>,
    /// Intervals of more than one and a half such periods.
    pub silences: Vec<Silence>,
}

/// An interval without readings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Silence {
    /// Index from 0 of the last reading before it.
    pub after: usize,
    /// Time of that, s.
    pub from: f64,
    /// Time of the next, s.
    pub to: f64,
    /// How many readings are missing, by the period.
    pub missing: usize,
}

impl Rhythm {
    /// Of readings at increasing `times` (s).
    #[must_use]
    pub fn of(times: &[f64]) -> Self {
        let mut steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let middle = steps.len() / 2;
        if steps.is_empty() {
            return Self { period: None, silences: Vec::new() };
        }
        let period = *steps.select_nth_unstable_by(middle, f64::total_cmp).1;
        let silence = |(after, pair): (usize, &[f64])| {
            let periods = (pair[1] - pair[0]) / period;
            // A cast from f64 saturates, and what is not above LONG is none.
            (periods > LONG).then(|| Silence {
                after,
                from: pair[0],
                to: pair[1],
                missing: (periods.round() - 1.0).max(1.0) as usize,
            })
        };
        let silences = times.windows(2).enumerate().filter_map(silence).collect();
        Self { period: Some(period), silences }
    }

    /// The longest interval that is none without readings, s: what may be interpolated over.
    #[must_use]
    pub fn longest(&self) -> f64 {
        self.period.map_or(0.0, |period| LONG * period)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_readings_are_counted_by_the_period() {
        let mut times: Vec<f64> = (0..1000).map(|k| f64::from(k) * 1e-3).collect();
        times.drain(600..640);
        let Rhythm { period, silences } = Rhythm::of(&times);
        assert!((period.unwrap() - 1e-3).abs() < 1e-15);
        let [Silence { after, from, to, missing }] = silences[..] else { panic!("{silences:?}") };
        assert_eq!((after, from, to, missing), (599, 0.599, 0.64, 40));
    }

    #[test]
    fn jitter_is_no_silence_and_few_readings_have_no_period() {
        let times: Vec<f64> = (0..100).map(|k| f64::from(k) + 0.2 * f64::from(k % 2)).collect();
        assert!(Rhythm::of(&times).silences.is_empty());
        assert_eq!(Rhythm::of(&[1.0]).period, None);
        assert_eq!(Rhythm::of(&[1.0]).longest(), 0.0);
        assert_eq!(Rhythm::of(&[1.0, 1.0]).silences, []);
    }
}
