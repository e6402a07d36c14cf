use glam::DVec3;
use thiserror::Error;

/// Why readings are no track.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TrackError {
    /// Two readings for three, say.
    #[error("{times} times for {values} values")]
    Lengths {
        /// Number of times.
        times: usize,
        /// Number of values.
        values: usize,
    },
    /// Times do not increase, or are not finite.
    #[error("time {time} s of reading {index} is not above {previous} s before it")]
    Order {
        /// Index from 0.
        index: usize,
        /// Its time, s.
        time: f64,
        /// The time before, s.
        previous: f64,
    },
    /// A value is NaN or infinite.
    #[error("reading {index} is not finite")]
    NotFinite {
        /// Index from 0.
        index: usize,
    },
}

/// A vector at strictly increasing times, linear between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    times: Vec<f64>,
    values: Vec<DVec3>,
}

impl Track {
    /// From values at their times in s.
    ///
    /// # Errors
    /// [`TrackError`] names the reading.
    pub fn new(times: Vec<f64>, values: Vec<DVec3>) -> Result<Self, TrackError> {
        check_times(&times, values.len())?;
        match values.iter().position(|value| !value.is_finite()) {
            Some(index) => Err(TrackError::NotFinite { index }),
            None => Ok(Self { times, values }),
        }
    }

    /// Times of the readings, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The readings.
    #[must_use]
    pub fn values(&self) -> &[DVec3] {
        &self.values
    }

    /// The value at `t` (s), linear between its neighbours; none outside of the readings, and none between two that are more
    /// than `longest` (s) apart.
    #[must_use]
    pub fn at(&self, t: f64, longest: f64) -> Option<DVec3> {
        let (k, share) = place(&self.times, t, longest)?;
        let after = if share > 0.0 { self.values[k + 1] } else { return Some(self.values[k]) };
        Some(self.values[k].lerp(after, share))
    }

    /// By how much linear interpolation halfway between readings is off, at most: each reading that is left out is taken
    /// from its two neighbours, over twice the interval, where the error of a line (`h^2 / 8` times the second derivative)
    /// is four times as large. Neighbours more than `longest` (s) apart are not looked at; none if there are no others.
    ///
    /// Noise counts too: of white noise of deviation `s` on each axis it is of the size of `s`.
    #[must_use]
    pub fn interpolation_error(&self, longest: f64) -> Option<f64> {
        let off = |[a, b, c]: [usize; 3], share: f64| {
            self.values[a].lerp(self.values[c], share).distance(self.values[b])
        };
        left_out(&self.times, longest, off)
    }
}

/// Where `t` is among `times`: the reading before it, and the share of the way to the next.
pub(super) fn place(times: &[f64], t: f64, longest: f64) -> Option<(usize, f64)> {
    let after = times.partition_point(|&time| time <= t);
    let k = after.checked_sub(1)?;
    if times[k] == t {
        return Some((k, 0.0));
    }
    let step = times.get(after)? - times[k];
    (step <= longest).then(|| (k, (t - times[k]) / step))
}

/// A quarter of the largest `off` of the readings that are left out, each taken from its neighbours.
pub(super) fn left_out(times: &[f64], longest: f64, off: impl Fn([usize; 3], f64) -> f64) -> Option<f64> {
    let mut largest: Option<f64> = None;
    for k in 1..times.len().saturating_sub(1) {
        let [before, at, after] = [times[k - 1], times[k], times[k + 1]];
        if at - before <= longest && after - at <= longest {
            let share = (at - before) / (after - before);
            // Off the middle the error of a line is smaller by this.
            let off = off([k - 1, k, k + 1], share) / (16.0 * share * (1.0 - share));
            largest = Some(largest.map_or(off, |largest| largest.max(off)));
        }
    }
    largest
}

pub(super) fn check_times(times: &[f64], values: usize) -> Result<(), TrackError> {
    if times.len() != values {
        return Err(TrackError::Lengths { times: times.len(), values });
    }
    let mut previous = f64::NEG_INFINITY;
    for (index, &time) in times.iter().enumerate() {
        if !(time > previous && time.is_finite()) {
            return Err(TrackError::Order { index, time, previous });
        }
        previous = time;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parabola(steps: usize, h: f64) -> Track {
        let times: Vec<f64> = (0..steps).map(|k| k as f64 * h).collect();
        let values = times.iter().map(|t| DVec3::new(t * t, 1.0, -t)).collect();
        Track::new(times, values).unwrap()
    }

    #[test]
    fn a_line_between_readings_and_nothing_beyond() {
        let track = parabola(3, 1.0);
        assert_eq!(track.at(1.0, 0.1), Some(DVec3::new(1.0, 1.0, -1.0)));
        assert_eq!(track.at(1.5, 2.0), Some(DVec3::new(2.5, 1.0, -1.5)));
        assert_eq!(track.at(2.0, 2.0), Some(DVec3::new(4.0, 1.0, -2.0)));
        for (t, longest) in [(-0.1, 2.0), (2.1, 2.0), (1.5, 0.9), (f64::NAN, 2.0)] {
            assert_eq!(track.at(t, longest), None);
        }
    }

    /// Of a parabola `x = t^2` a line over `h` is off by `h^2 / 4` halfway.
    #[test]
    fn the_stated_error_of_a_parabola_is_its_error() {
        let h = 0.125;
        let track = parabola(9, h);
        let midway = track.at(2.5 * h, h).unwrap().x - (2.5 * h) * (2.5 * h);
        assert!((midway - h * h / 4.0).abs() < 1e-15);
        assert!((track.interpolation_error(h).unwrap() - midway).abs() < 1e-15);
        assert_eq!(track.interpolation_error(0.5 * h), None);
        // Unevenly sampled as well: with the longer of the two steps it is exact up to the ratio of the steps.
        let times = vec![0.0, 0.1, 0.3];
        let values = times.iter().map(|t| DVec3::X * t * t).collect();
        let uneven = Track::new(times, values).unwrap();
        assert!((uneven.interpolation_error(1.0).unwrap() - 0.15 * 0.15 / 4.0).abs() < 1e-3);
    }

    #[test]
    fn readings_out_of_order_are_refused() {
        let values = vec![DVec3::ZERO; 2];
        let order = Track::new(vec![1.0, 1.0], values.clone());
        assert_eq!(order, Err(TrackError::Order { index: 1, time: 1.0, previous: 1.0 }));
        assert!(Track::new(vec![f64::NAN, 1.0], values.clone()).is_err());
        assert_eq!(Track::new(vec![1.0], values), Err(TrackError::Lengths { times: 1, values: 2 }));
        let bad = Track::new(vec![0.0, 1.0], vec![DVec3::ZERO, DVec3::NAN]);
        assert_eq!(bad, Err(TrackError::NotFinite { index: 1 }));
    }
}
