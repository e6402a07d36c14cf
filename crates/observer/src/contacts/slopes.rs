//! Slopes of sampled vectors: of the least squares line through the samples around each.

use super::ranges::Ranges;
use glam::DVec3;
use std::ops::Add;

/// Slope at each sample of the line through those at most `reach` away in time that follow on it without a gap; zero where there is no
/// value or no other one that near. `times` increase strictly and are as many as `values`; units are those of values over times.
pub(super) fn slopes(times: &[f64], values: &[Option<DVec3>], reach: f64) -> Vec<DVec3> {
    let mut all = Vec::with_capacity(times.len());
    for run in values.chunk_by(|a, b| a.is_some() == b.is_some()) {
        let times = &times[all.len()..all.len() + run.len()];
        match run.iter().copied().collect::<Option<Vec<DVec3>>>() {
            Some(values) => of_run(times, &values, reach, &mut all),
            None => all.resize(all.len() + run.len(), DVec3::ZERO),
        }
    }
    all
}

/// Of samples without a gap.
fn of_run(times: &[f64], values: &[DVec3], reach: f64, slopes: &mut Vec<DVec3>) {
    let since = |k: usize| times[k] - times[0];
    let one =
        |(k, value): (usize, &DVec3)| Line { count: 1.0, time: since(k), value: *value, ..Line::default() };
    let lines = Ranges::new(&values.iter().enumerate().map(one).collect::<Vec<_>>());
    let (mut from, mut to) = (0, 0);
    for k in 0..times.len() {
        while times[k] - times[from] > reach {
            from += 1;
        }
        while to < times.len() && times[to] - times[k] <= reach {
            to += 1;
        }
        slopes.push(lines.sum(from..to).slope());
    }
}

/// Of some samples: how many, means of time and value, and sums of squares and products of what they are off these.
#[derive(Clone, Copy, Default)]
struct Line {
    count: f64,
    time: f64,
    value: DVec3,
    squares: f64,
    products: DVec3,
}

impl Add for Line {
    type Output = Self;

    /// Of these and others together (Chan, Golub, LeVeque 1983, (2.1)): nothing is the small difference of large numbers.
    fn add(self, other: Self) -> Self {
        let count = self.count + other.count;
        if count == 0.0 {
            return self;
        }
        let (time, value) = (other.time - self.time, other.value - self.value);
        let (share, both) = (other.count / count, self.count * other.count / count);
        Self {
            count,
            time: self.time + time * share,
            value: self.value + value * share,
            squares: self.squares + other.squares + time * time * both,
            products: self.products + other.products + value * (time * both),
        }
    }
}

impl Line {
    fn slope(&self) -> DVec3 {
        if self.squares > 0.0 { self.products / self.squares } else { DVec3::ZERO }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    /// As it is defined, sample by sample.
    fn slope(times: &[f64], values: &[Option<DVec3>], reach: f64, k: usize) -> DVec3 {
        if values[k].is_none() {
            return DVec3::ZERO;
        }
        let near = |i: &usize| (times[*i] - times[k]).abs() <= reach && values[*i].is_some();
        let from = (0..k).rev().take_while(near).last().unwrap_or(k);
        let to = (k + 1..times.len()).take_while(near).last().unwrap_or(k);
        // No slope changes with what times and values are counted from.
        let (time, value) =
            (|i: usize| times[i] - times[k], |i: usize| values[i].unwrap() - values[k].unwrap());
        let mean = (from..=to).map(time).sum::<f64>() / (to + 1 - from) as f64;
        let (mut sum, mut squares) = (DVec3::ZERO, 0.0);
        for i in from..=to {
            let since = time(i) - mean;
            sum += value(i) * since;
            squares += since * since;
        }
        if squares > 0.0 { sum / squares } else { DVec3::ZERO }
    }

    /// Noise on an offset that is far larger, at uneven times from `start` on, with gaps in the values.
    fn sampled(start: f64, count: usize) -> (Vec<f64>, Vec<Option<DVec3>>) {
        let mut random = Normal::seeded(count as u64);
        let mut t = start;
        let times: Vec<f64> = (0..count)
            .map(|_| {
                t += 1e-3 * (1.0 + 0.5 * random.draw().abs());
                t
            })
            .collect();
        let mut value = |k: usize| {
            let noise = DVec3::new(random.draw(), random.draw(), random.draw());
            (k % 97 > 1).then_some(DVec3::new(1e3, -2e3, 5.0) + noise)
        };
        (times, (0..count).map(&mut value).collect())
    }

    #[test]
    fn slopes_are_those_of_the_lines_as_they_are_defined() {
        for (start, reach) in [(0.0, 0.02), (1e6, 0.02), (0.0, 0.0), (-3.0, 1e9), (0.0, 1.3e-3)] {
            let (times, values) = sampled(start, 700);
            let fast = slopes(&times, &values, reach);
            for (k, fast) in fast.into_iter().enumerate() {
                let simple = slope(&times, &values, reach, k);
                // Of values of 2e3 over the shortest window of two samples, 1e-3 s: rounding of 2e3 * 2^-52 / 1e-3, a few times.
                let allowed = 16.0 * 2e3 * f64::EPSILON / 1e-3 + 1e-12 * simple.length();
                assert!(fast.distance(simple) <= allowed, "{start} {reach} {k}: {fast} {simple}");
            }
        }
    }

    #[test]
    fn what_was_passed_leaves_no_trace() {
        // A force of 1e12 passes by; what is left of the sums must not know of it.
        let times: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        let value =
            |k: usize| DVec3::new(if (400..500).contains(&k) { 1e12 } else { 3.0 * times[k] }, 0.0, 1.0);
        let values: Vec<_> = (0..2000).map(|k| Some(value(k))).collect();
        let slopes = slopes(&times, &values, 0.05);
        assert!(slopes[560..].iter().all(|slope| (slope.x - 3.0).abs() < 1e-9 && slope.z == 0.0));
    }

    #[test]
    fn a_lone_sample_has_no_slope() {
        let values = [None, Some(DVec3::X), None, Some(DVec3::Y), Some(DVec3::ZERO)];
        let slopes = slopes(&[0.0, 1.0, 2.0, 3.0, 4.0], &values, 1.0);
        assert_eq!(slopes, [DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, -DVec3::Y, -DVec3::Y]);
        assert!(super::slopes(&[], &[], 1.0).is_empty());
    }
}
