//! Intervals without samples: what forces did in them is not known, but how they change over such a time elsewhere in the log is.

use super::noise::about;
use super::record::{Interval, Record, Wrench, six};
use nalgebra::Matrix6;

/// Times the usual interval, and natural times, from which on an interval is a gap.
const LONG: f64 = 2.5;
const BENT: f64 = 0.01;
/// Places at most at which it is looked how forces change.
const PLACES: usize = 64;
/// Times of a gap between which what is known of one serves another.
const ALIKE: f64 = 1.2;
/// Natural times that a motion is carried in one step over a gap, and steps at most.
const STEP: f64 = 0.05;
const MOST: f64 = 200.0;
/// Shares of a gap over which slopes at its ends are taken: next to none without noise.
const SLOPES: [f64; 2] = [0.0, 0.25];

/// How forces go on over a gap.
#[derive(Clone, Copy)]
enum Rule {
    /// From one end to the other along a line: the trapezoidal rule.
    Line,
    /// By a cubic with their slopes at both ends, taken over such a share of the gap or one sample.
    Cubic(f64),
}

/// A rule for gaps of about one length, and the mean square of what it misses.
#[derive(Clone, Copy)]
struct Known {
    h: f64,
    rule: Rule,
    missed: Matrix6<f64>,
}

impl Record {
    /// With forces carried over gaps in the samples by the rule that misses less over so long a time elsewhere, and that left open; none
    /// without gaps. Gaps of the impulses that palms measure are none. `natural` is the natural time, s.
    pub(super) fn with_gaps_open(&self, natural: f64) -> Option<Self> {
        let mut usual: Vec<f64> = self.intervals.iter().map(|interval| interval.h).collect();
        usual.sort_by(f64::total_cmp);
        let longest = (LONG * usual.get(usual.len() / 2)?).max(BENT * natural);
        let gaps: Vec<usize> = (0..self.intervals.len()).filter(|&k| self.intervals[k].h > longest).collect();
        if self.all_impulses || gaps.is_empty() {
            return None;
        }
        let sums = self.running();
        let mut known: Vec<Known> = Vec::new();
        let mut open = self.clone();
        for k in gaps {
            let h = self.intervals[k].h;
            let alike = known.iter().find(|of| (1.0..ALIKE).contains(&(of.h / h))).copied();
            let Known { rule, missed, .. } = alike.unwrap_or_else(|| {
                let new = self.known(&sums, h * ALIKE.sqrt());
                known.push(new);
                new
            });
            let (impulse, first) = self.ruled(k, k + 1, rule);
            let interval = &mut open.intervals[k];
            let mut noise = interval.noise;
            noise.white += missed;
            let parts = (h / (STEP * natural)).ceil().clamp(1.0, MOST) as usize;
            *interval = Interval { impulse, first: first.force, noise, parts, ..*interval };
        }
        Some(open)
    }

    fn known(&self, sums: &[Wrench], h: f64) -> Known {
        let of = |rule| Known { h, rule, missed: self.missed(sums, h, rule) };
        let force = |of: &Known| of.missed.fixed_view::<3, 3>(0, 0).trace();
        SLOPES
            .map(Rule::Cubic)
            .map(of)
            .into_iter()
            .fold(of(Rule::Line), |best, new| if force(&new) < force(&best) { new } else { best })
    }

    /// Integrals of wrench, and of wrench times time, from one sample to another by the wrenches at them and beyond.
    fn ruled(&self, from: usize, to: usize, rule: Rule) -> (Wrench, Wrench) {
        let (times, wrenches) = (&self.times, &self.wrenches);
        let (h, a, b) = (times[to] - times[from], wrenches[from], wrenches[to]);
        let slope = |i: usize, j: usize| (wrenches[j] + wrenches[i] * -1.0) * (1.0 / (times[j] - times[i]));
        let share = if let Rule::Cubic(share) = rule { share } else { 0.0 };
        let before = times.partition_point(|t| *t < times[from] - share * h).min(from.saturating_sub(1));
        let after =
            times.partition_point(|t| *t < times[to] + share * h).clamp(to + 1, times.len().max(to + 1));
        match rule {
            Rule::Cubic(_) if before < from && after < times.len() => {
                let (s, e) = (slope(before, from), slope(to, after));
                let impulse = (a + b) * (0.5 * h) + (s + e * -1.0) * (h * h / 12.0);
                let first =
                    a * (0.15 * h * h) + b * (0.35 * h * h) + (s * (1.0 / 30.0) + e * -0.05) * (h * h * h);
                (impulse, first)
            }
            _ => ((a + b) * (0.5 * h), (a + b * 2.0) * (h * h / 6.0)),
        }
    }

    /// Mean square of what a rule misses of an impulse over a time `h`, s, with its moment about the record's origin.
    fn missed(&self, sums: &[Wrench], h: f64, rule: Rule) -> Matrix6<f64> {
        let times = &self.times;
        let last = times.len() - 1;
        let (mut all, mut count) = (Matrix6::zeros(), 0);
        let apart = (last / PLACES).max(1);
        for from in (0..last).step_by(apart) {
            let to = times.partition_point(|t| *t < times[from] + h);
            // Not over another gap.
            if to > last || times[to] - times[from] > ALIKE * h || to < from + 2 {
                continue;
            }
            let missed = self.ruled(from, to, rule).0 + (sums[to] + sums[from] * -1.0) * -1.0;
            let column = six(missed.force, missed.moment);
            all.ger(1.0, &column, &column, 1.0);
            count += 1;
        }
        if count > 0 { all / f64::from(count) } else { self.anything(h) }
    }

    /// Where nothing can be learned: as much as the forces are.
    fn anything(&self, h: f64) -> Matrix6<f64> {
        let mut all = Matrix6::zeros();
        for wrench in &self.wrenches {
            let column = six(wrench.force, wrench.moment) * h;
            all.ger(1.0 / self.wrenches.len() as f64, &column, &column, 1.0);
        }
        all
    }

    /// Impulses since the first sample.
    fn running(&self) -> Vec<Wrench> {
        let mut sum = Wrench::default();
        let mut sums = vec![sum];
        for interval in &self.intervals {
            sum = sum + interval.impulse;
            sums.push(sum);
        }
        sums
    }

    /// What the trapezoidal rule misses over a time, with moments about the world's origin.
    pub(super) fn missed_in_world(&self, h: f64) -> Matrix6<f64> {
        about(&self.missed(&self.running(), h, Rule::Line), -self.origin)
    }
}
