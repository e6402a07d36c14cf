use super::{Rhythm, Track};
use glam::DVec3;

/// Readings that take part in the search for the minimum; the last steps take all.
const MOST_IN_SEARCH: usize = 2000;
/// Of the readings of the one track so many must have partners in the other, or the two are not compared.
const LEAST_OVERLAP: f64 = 0.5;
/// Gauss-Newton steps at the end; from within a step of the search three are enough.
const STEPS: usize = 20;

/// By how much one clock is ahead of another, as two tracks of the same point tell it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClockOffset {
    /// Time of the second track minus time of the first for one event, s.
    pub ahead: f64,
    /// Its standard deviation by what is left over, s; infinite where the point does not move.
    pub deviation: f64,
    /// Root mean square of the distance of the tracks as they stand, m; none where they do not overlap as they stand.
    pub distance_before: Option<f64>,
    /// The same with the offset taken out.
    pub distance: f64,
    /// Readings of the second track that were compared.
    pub readings: usize,
}

impl ClockOffset {
    /// Whether the offset is one: more than `deviations` of its standard deviation, and the tracks at least half as far
    /// apart again without it.
    #[must_use]
    pub fn is_seen(&self, deviations: f64) -> bool {
        let helps = self.distance_before.is_none_or(|before| before > 1.5 * self.distance);
        self.ahead.abs() > deviations * self.deviation && helps
    }
}

/// The offset `d`, within `farthest` (s) of zero, with which `second(t)` is nearest to `first(t - d)` in the mean square: a search
/// in steps of half the shorter period, then Gauss-Newton. Intervals without readings of the first track are left out.
///
/// The deviation is `s / sqrt(sum |v|^2)` with the root mean square `s` of what is left on each axis and the velocities `v` of the point: independent errors
/// are assumed, and errors of interpolation count as such.
///
/// None where fewer than half of the second track's readings, or fewer than four, have partners in the first.
#[must_use]
pub fn clock_offset(first: &Track, second: &Track, farthest: f64) -> Option<ClockOffset> {
    let rhythms = [first, second].map(|track| Rhythm::of(track.times()));
    let pair = Pair { first, second, longest: rhythms[0].longest() };
    let step = 0.5 * rhythms[0].period?.min(rhythms[1].period?);
    let count = (farthest / step).clamp(1.0, 1e4).ceil();
    let stride = second.times().len().div_ceil(MOST_IN_SEARCH);
    let mut best: Option<(f64, f64)> = None;
    let whole = count as i64;
    for k in -whole..=whole {
        let ahead = farthest * k as f64 / count;
        if let Some(Left { mean_square, .. }) = pair.left(ahead, stride)
            && best.is_none_or(|(_, least)| mean_square < least)
        {
            best = Some((ahead, mean_square));
        }
    }
    let mut ahead = best?.0;
    for _ in 0..STEPS {
        let left = pair.left(ahead, 1)?;
        let change = left.change();
        // Beyond a step of the search lies another minimum, which is not the least.
        if !change.is_finite() || change.abs() > 2.0 * step {
            break;
        }
        ahead += change;
        if change.abs() <= 1e-12 * step {
            break;
        }
    }
    let left = pair.left(ahead, 1)?;
    let deviation = (left.mean_square / (3.0 * left.speed_square)).sqrt();
    Some(ClockOffset {
        ahead,
        deviation: if left.speed_square > 0.0 { deviation } else { f64::INFINITY },
        distance_before: pair.left(0.0, 1).map(|left| left.mean_square.sqrt()),
        distance: left.mean_square.sqrt(),
        readings: left.readings,
    })
}

struct Pair<'a> {
    first: &'a Track,
    second: &'a Track,
    longest: f64,
}

/// What is left between two tracks at an offset.
struct Left {
    mean_square: f64,
    /// Sum of squared velocities, and of velocities times what is left.
    speed_square: f64,
    product: f64,
    readings: usize,
}

impl Left {
    /// The offset grows by this, to first order: `second - first(t - d)` falls by `v` times the change.
    fn change(&self) -> f64 {
        -self.product / self.speed_square
    }
}

impl Pair<'_> {
    /// Over every `stride`-th reading of the second track.
    fn left(&self, ahead: f64, stride: usize) -> Option<Left> {
        let (times, values) = (self.second.times(), self.second.values());
        let half = 0.5 * self.longest / 1.5;
        let mut sum = Left { mean_square: 0.0, speed_square: 0.0, product: 0.0, readings: 0 };
        let mut asked = 0_usize;
        for (&t, &value) in times.iter().zip(values).step_by(stride.max(1)) {
            asked += 1;
            let t = t - ahead;
            let Some(at) = self.first.at(t, self.longest) else { continue };
            let rest: DVec3 = value - at;
            sum.mean_square += rest.length_squared();
            sum.readings += 1;
            // Central difference over one period; at the ends of the track the reading has no say in where the minimum is.
            let ends = self.first.at(t - half, self.longest).zip(self.first.at(t + half, self.longest));
            if let Some((before, after)) = ends {
                let speed = (after - before) / (2.0 * half);
                sum.speed_square += speed.length_squared();
                sum.product += speed.dot(rest);
            }
        }
        let enough = sum.readings >= 4 && sum.readings as f64 >= LEAST_OVERLAP * asked as f64;
        sum.mean_square /= sum.readings as f64;
        enough.then_some(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(t: f64) -> DVec3 {
        0.01 * DVec3::new((3.0 * t).sin(), (5.0 * t).cos(), t * t)
    }

    fn track(count: usize, h: f64, point: impl Fn(f64) -> DVec3) -> Track {
        let times: Vec<f64> = (0..count).map(|k| k as f64 * h).collect();
        let values = times.iter().map(|t| point(*t)).collect();
        Track::new(times, values).unwrap()
    }

    #[test]
    fn a_planted_offset_is_found_within_its_deviation() {
        let first = track(1001, 1e-3, curve);
        for planted in [-0.02, -0.0013, 0.0, 0.003, 0.0177] {
            let second = track(251, 4e-3, |t| curve(t - planted));
            let found = clock_offset(&first, &second, 0.05).unwrap();
            assert!((found.ahead - planted).abs() < 1e-6, "{planted} {found:?}");
            assert!(found.distance < 1e-7 && found.deviation < 1e-6, "{found:?}");
            assert_eq!(found.is_seen(5.0), planted != 0.0, "{found:?}");
        }
    }

    /// The deviation that is stated is that which occurs: of 200 logs with noise the offsets over it have a mean square of 1,
    /// within five deviations of such a mean square (0.1 each).
    #[test]
    fn the_deviation_is_that_of_noisy_tracks() {
        let mut state = 1_u64;
        let mut uniform = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
        };
        let first = track(1001, 1e-3, curve);
        let mut squares = 0.0;
        for _ in 0..200 {
            let values = track(251, 4e-3, |t| curve(t - 0.003))
                .values()
                .iter()
                .map(|v| *v + 1e-3 * DVec3::new(uniform(), uniform(), uniform()))
                .collect();
            let second = Track::new((0..251).map(|k| 4e-3 * f64::from(k)).collect(), values).unwrap();
            let found = clock_offset(&first, &second, 0.05).unwrap();
            squares += ((found.ahead - 0.003) / found.deviation).powi(2) / 200.0;
        }
        assert!((0.5..1.5).contains(&squares), "{squares}");
    }

    #[test]
    fn what_does_not_move_tells_no_offset_and_what_does_not_overlap_none() {
        let still = track(100, 1e-2, |_| DVec3::X);
        let found = clock_offset(&still, &still, 0.05).unwrap();
        assert!(found.deviation == f64::INFINITY && !found.is_seen(1.0), "{found:?}");
        let late = Track::new(still.times().iter().map(|t| t + 100.0).collect(), still.values().to_vec());
        assert_eq!(clock_offset(&still, &late.unwrap(), 0.05), None);
    }
}
