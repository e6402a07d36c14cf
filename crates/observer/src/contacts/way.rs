//! How a reading of a palm goes on from sample to sample, and which of its values leave that way.

use glam::DVec3;

/// Deviations from which on a value is off: of what the motion itself leaves of a cubic at most samples, and of what noise does.
pub(super) const OFF: f64 = 8.0;
const NOISE: f64 = 4.5;
/// Values on either side that tell where one should be, and among how many samples they are looked for.
const BESIDE: usize = 2;
const AMONG: usize = 6;
/// Samples on either side over which the same palms must be touched: a landing bends the way of all contacts.
pub(super) const STEADY: usize = 3;
/// Share of the spread of all values of a palm that one is off by at least: at 3e-4 two of 24 logs as good as exact had right contacts put elsewhere, where an
/// object turns within a sample or two.
const NOTABLE: f64 = 3e-3;
/// Neighbours that may be off together: more are a motion that turns sharply.
pub(super) const TOGETHER: usize = 2;
/// Share of a palm's values beyond which they are not outliers but what the sensor is like.
pub(super) const MOST: f64 = 0.05;
/// Root of one and the squared weights of a cubic through two values on either side, evenly spaced: noise of what a value is off it by over that of one.
const OF_CUBIC: f64 = 1.394;
/// Fewest values of a palm whose scatter can be told.
pub(super) const FEWEST: usize = 20;
/// Values of a palm that tell the scatter of all of them, at most.
const TELL: usize = 5000;
/// Median of the length of a vector of two standard normal numbers.
pub(super) const MEDIAN_LENGTH: f64 = 1.177_410_022_515_474_7;

/// What others say that a value is, in its units, and the sum of the squares of what they count by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told {
    pub(super) value: DVec3,
    pub(super) squares: f64,
}

/// Places of seven values whose smaller one comes first, one after the other, until the fourth is their median.
const EXCHANGES: [[usize; 2]; 13] =
    [[0, 5], [0, 3], [1, 6], [2, 4], [0, 1], [3, 5], [2, 6], [2, 3], [3, 6], [4, 5], [1, 4], [1, 3], [3, 4]];

/// A value that is off.
#[derive(Clone, Copy, Debug)]
pub(super) struct Off {
    pub(super) sample: usize,
    /// What others say that it is.
    pub(super) told: Told,
    /// How far the same puts values around it from what they are, at most.
    pub(super) around: f64,
}

/// The first values of some, by number, of which a polynomial goes through four at most.
#[derive(Default)]
struct Few {
    of: [usize; 2 * BESIDE],
    count: usize,
}

impl FromIterator<usize> for Few {
    fn from_iter<I: IntoIterator<Item = usize>>(all: I) -> Self {
        let mut few = Self::default();
        for (of, value) in few.of.iter_mut().zip(all) {
            *of = value;
            few.count += 1;
        }
        few
    }
}

impl std::ops::Deref for Few {
    type Target = [usize];
    fn deref(&self) -> &[usize] {
        &self.of[..self.count]
    }
}

/// Values of a reading of a palm.
#[derive(Default)]
pub(super) struct Way {
    pub(super) samples: Vec<usize>,
    times: Vec<f64>,
    points: Vec<DVec3>,
    /// What the motion may leave of them.
    bends: Vec<f64>,
    /// Whether one may be judged by those around it.
    steady: Vec<bool>,
    /// Whether the palm gave all that it gave the sample before, to the last digit.
    repeated: Vec<bool>,
}

impl Way {
    /// Adds the value of a sample, in order of time (s). The motion may leave `bend` of it; it is judged only where it is `steady`, and is no reading
    /// where it is `repeated`.
    pub(super) fn add(
        &mut self,
        (sample, time): (usize, f64),
        value: DVec3,
        bend: f64,
        [steady, repeated]: [bool; 2],
    ) {
        self.samples.push(sample);
        self.times.push(time);
        self.points.push(value);
        self.bends.push(bend);
        self.steady.push(steady);
        self.repeated.push(repeated);
    }

    /// Whether each value is the one before once more, while those before and after it change: none is where many are.
    fn stale(&self) -> Vec<bool> {
        let count = self.points.len();
        let changes = |j: usize| j + 1 < count && self.points[j] != self.points[j + 1];
        let one = |j: usize| self.repeated[j] && self.steady[j] && j > 1 && changes(j) && changes(j - 2);
        let all: Vec<bool> = (0..count).map(one).collect();
        let many = all.iter().filter(|stale| **stale).count() as f64 > MOST * count as f64;
        if many { vec![false; count] } else { all }
    }

    /// The values that are off; `deviation` is that of one.
    pub(super) fn off(&self, deviation: f64) -> Vec<Off> {
        let count = self.points.len();
        if count < FEWEST {
            return Vec::new();
        }
        let mean = self.points.iter().sum::<DVec3>() / count as f64;
        let square = self.points.iter().map(|point| point.distance_squared(mean)).sum::<f64>();
        let spread = (square / count as f64).sqrt();
        // Of long logs some tell the scatter as well as all do.
        let every = count.div_ceil(TELL).max(1);
        let limit = |left: &dyn Fn(usize) -> f64| {
            let mut scatter: Vec<f64> =
                (0..count).step_by(every).map(left).filter(|left| *left > 0.0).collect();
            let middle = scatter.len() / 2;
            let usual = if scatter.is_empty() {
                f64::INFINITY
            } else {
                *scatter.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_LENGTH
            };
            // Noise makes no tails; a motion that bends does.
            let bent = (usual * usual - deviation * deviation).max(0.0).sqrt();
            (NOISE * deviation).max(OFF * bent).max(NOTABLE * spread)
        };
        // Medians are not misled by a few that are off, but by the bend of the way; cubics the other way round.
        let left = |j: usize| self.points[j].distance(self.usual(j));
        let most = limit(&left);
        let stale = self.stale();
        let suspected: Vec<bool> = (0..count).map(|j| stale[j] || self.steady[j] && left(j) > most).collect();
        let left = |j: usize| self.told(j, &suspected).map_or(0.0, |told| self.left(j, &told));
        let most = limit(&left);
        let is_off = |&j: &usize| {
            let limit = most + self.bends[j];
            stale[j] || suspected[j] && left(j) > limit && !self.goes_on(j, OF_CUBIC * limit)
        };
        let off: Vec<usize> = (0..count).filter(is_off).collect();
        let together = off.chunk_by(|a, b| *b == a + 1).filter(|run| run.len() <= TOGETHER);
        let one = |&j: &usize| {
            let told = self.told(j, &suspected)?;
            Some(Off { sample: self.samples[j], told, around: self.around(j, &suspected) })
        };
        let off: Vec<_> = together.flatten().filter_map(one).collect();
        if off.len() as f64 > MOST * count as f64 { Vec::new() } else { off }
    }

    /// How far values around one are, at most, from what others as far from them as those that tell of this one say.
    fn around(&self, j: usize, suspected: &[bool]) -> f64 {
        let by = self.beside(j, suspected);
        let near = j.saturating_sub(AMONG)..(j + AMONG + 1).min(suspected.len());
        let one = |i: usize| {
            let moved: Option<Vec<usize>> = by.iter().map(|&other| (other + i).checked_sub(j)).collect();
            let moved = moved.filter(|moved| moved.iter().all(|&m| m < suspected.len() && !suspected[m]))?;
            Some(self.left(i, &self.through(&moved, i)))
        };
        near.filter(|&i| !suspected[i]).filter_map(one).fold(0.0, f64::max)
    }

    /// How far the value of a sample is from what those around it say, all of them; infinite where they are too few, nothing where there is none.
    pub(super) fn left_at(&self, sample: usize) -> f64 {
        let Ok(j) = self.samples.binary_search(&sample) else { return 0.0 };
        let told = self.told(j, &vec![false; self.points.len()]);
        told.map_or(f64::INFINITY, |told| self.left(j, &told))
    }

    /// The median of the values around one, at an end carried on to it by the slope of medians.
    fn usual(&self, j: usize) -> DVec3 {
        let inner = |j: usize| j.clamp(STEADY, self.points.len() - 1 - STEADY);
        let centre = inner(j);
        let median = self.median(centre);
        if centre == j {
            return median;
        }
        let further = inner(2 * centre - j);
        let share = (j as f64 - centre as f64) / (further as f64 - centre as f64);
        median + (self.median(further) - median) * share
    }

    /// The median of each coordinate.
    fn median(&self, centre: usize) -> DVec3 {
        let mut of: [DVec3; 2 * STEADY + 1] = std::array::from_fn(|i| self.points[centre + i - STEADY]);
        // Of all coordinates at once.
        for [i, j] in EXCHANGES {
            (of[i], of[j]) = (of[i].min(of[j]), of[i].max(of[j]));
        }
        of[STEADY]
    }

    /// Whether a contact is where the way from one side leads, to within so many metres, by the line through two contacts there or the parabola through three;
    /// where there is a fourth, by that with it in place of the third as well: a third that is off by as much as this one leads to it.
    ///
    /// Where the curvature of the object jumps, its contact changes its speed from one sample to the next: nothing that is smooth over both sides leads there.
    fn goes_on(&self, j: usize, within: f64) -> bool {
        let near = |other: &usize| self.samples[*other].abs_diff(self.samples[j]) <= AMONG;
        // Those that may be off themselves as well: so few in a row lead to no other one.
        let before: Vec<usize> = (0..j).rev().take(AMONG).filter(near).collect();
        let after: Vec<usize> = (j + 1..self.points.len()).take(AMONG).filter(near).collect();
        let leads = |few: &[usize]| self.through(few, j).value.distance(self.points[j]) <= within;
        [&before[..], &after].iter().any(|side| match *side {
            [a, b, c, d, ..] => leads(&[*a, *b]) || (leads(&[*a, *b, *c]) && leads(&[*a, *b, *d])),
            [a, b, c] => leads(&[*a, *b]) || leads(&[*a, *b, *c]),
            [a, b] => leads(&[*a, *b]),
            _ => false,
        })
    }

    /// The polynomial through some contacts at the time of another one.
    fn through(&self, beside: &[usize], j: usize) -> Told {
        let weight = |i: &usize| -> f64 {
            let others = beside.iter().filter(|other| *other != i);
            others
                .map(|&other| (self.times[j] - self.times[other]) / (self.times[*i] - self.times[other]))
                .product()
        };
        beside.iter().fold(Told { value: DVec3::ZERO, squares: 0.0 }, |Told { value, squares }, i| {
            let weight = weight(i);
            Told { value: value + self.points[*i] * weight, squares: squares + weight * weight }
        })
    }

    /// By how many metres of unit noise a contact is elsewhere than it is told.
    fn left(&self, j: usize, told: &Told) -> f64 {
        told.value.distance(self.points[j]) / (1.0 + told.squares).sqrt()
    }

    /// What the cubic through the values beside one leads to, at an end the parabola; those that are `out` say nothing. None with too few of them.
    fn told(&self, j: usize, out: &[bool]) -> Option<Told> {
        let beside = self.beside(j, out);
        (!beside.is_empty()).then(|| self.through(&beside, j))
    }

    /// The values beside one that tell what it is, less than all that are needed none.
    fn beside(&self, j: usize, out: &[bool]) -> Few {
        let near = |other: &usize| !out[*other] && self.samples[*other].abs_diff(self.samples[j]) <= AMONG;
        let before: Few = (0..j).rev().take(AMONG).filter(near).collect();
        let after: Few = (j + 1..self.points.len()).take(AMONG).filter(near).collect();
        // At an end more of them on one side; a cubic that leads beyond all of them has eight times the noise of one.
        let most = if before.is_empty() || after.is_empty() { 2 * BESIDE - 1 } else { 2 * BESIDE };
        let from_before = before.len().min(most.saturating_sub(after.len()).max(BESIDE));
        let from_after = after.len().min(most - from_before);
        if from_before + from_after < most {
            return Few::default();
        }
        before.iter().take(from_before).chain(after.iter().take(from_after)).copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exchanges that put all zeros and ones in order put all numbers in order (Knuth, 5.3.4, theorem Z), and the middle one no less.
    #[test]
    fn exchanges_leave_the_median_in_the_middle() {
        for bits in 0..1_u32 << 7 {
            let mut way = Way::default();
            for j in 0..7 {
                let value = DVec3::new(f64::from(bits >> j & 1), f64::from(bits >> (6 - j) & 1), -1.0);
                way.add((j, 0.0), value, 0.0, [true, false]);
            }
            let median = f64::from(u32::from(bits.count_ones() > 3));
            assert_eq!(way.median(STEADY), DVec3::new(median, median, -1.0), "{bits:07b}");
        }
    }
}
