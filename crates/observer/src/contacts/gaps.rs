//! Intervals without samples: what forces did in them is not known, but how they change over such a time elsewhere in the log is.

use super::record::{Interval, Record, Wrench, six};
use crate::three_palms::cross_matrix;
use nalgebra::{Matrix3, Matrix6};

/// Times the usual interval, and natural times, from which on an interval is a gap.
const LONG: f64 = 2.5;
const BENT: f64 = 0.01;
/// Places at most at which it is looked how forces change.
const PLACES: usize = 64;
/// Times of a gap between which what is known of one serves another.
const ALIKE: f64 = 1.2;

impl Record {
    /// Takes the trapezoidal rule over gaps in the samples, and leaves open what it misses over so long a time elsewhere. Gaps of the impulses
    /// that palms measure are none. `natural` is the natural time, s.
    pub(super) fn doubt_gaps(&mut self, natural: f64) {
        if self.all_impulses {
            return;
        }
        let mut usual: Vec<f64> = self.intervals.iter().map(|interval| interval.h).collect();
        usual.sort_by(f64::total_cmp);
        let Some(usual) = usual.get(usual.len() / 2) else { return };
        let longest = (LONG * usual).max(BENT * natural);
        let gaps: Vec<usize> = (0..self.intervals.len()).filter(|&k| self.intervals[k].h > longest).collect();
        let mut known: Vec<(f64, Matrix6<f64>)> = Vec::new();
        for k in gaps {
            let h = self.intervals[k].h;
            let alike =
                known.iter().find(|(of, _)| (1.0..ALIKE).contains(&(of / h))).map(|(_, missed)| *missed);
            let missed = alike.unwrap_or_else(|| {
                known.push((h * ALIKE.sqrt(), self.missed(h * ALIKE.sqrt())));
                known[known.len() - 1].1
            });
            let interval = &mut self.intervals[k];
            let mut noise = interval.noise;
            noise.white += missed;
            let wrenches = [&self.wrenches[k], &self.wrenches[k + 1]];
            *interval = Interval { blow: interval.blow, ..Interval::trapezoid(h, wrenches, noise) };
        }
    }

    /// Mean square of what the trapezoidal rule misses of an impulse over a time `h`, s, with its moment about the record's origin.
    pub(super) fn missed(&self, h: f64) -> Matrix6<f64> {
        let times = &self.times;
        let sums: Vec<Wrench> = self.running();
        let last = times.len() - 1;
        let (mut all, mut count) = (Matrix6::zeros(), 0);
        let apart = (last / PLACES).max(1);
        for from in (0..last).step_by(apart) {
            let to = times.partition_point(|t| *t < times[from] + h);
            // Not over another gap.
            if to > last || times[to] - times[from] > ALIKE * h || to < from + 2 {
                continue;
            }
            let ends = (self.wrenches[from] + self.wrenches[to]) * (0.5 * (times[to] - times[from]));
            let missed = ends + (sums[to] + sums[from] * -1.0) * -1.0;
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

    /// What is missed over a time, with moments about the world's origin.
    pub(super) fn missed_in_world(&self, h: f64) -> Matrix6<f64> {
        let mut shift = Matrix6::identity();
        shift.fixed_view_mut::<3, 3>(3, 0).copy_from(&Matrix3::from(cross_matrix(self.origin)));
        shift * self.missed(h) * shift.transpose()
    }
}
