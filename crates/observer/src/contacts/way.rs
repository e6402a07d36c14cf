//! How a reading of a palm goes on from sample to sample.

mod astray;

pub(super) use astray::{FEWEST, MEDIAN_LENGTH, MOST, OFF, Off, TOGETHER};
use glam::DVec3;

/// Values on either side that tell where one should be, and among how many samples they are looked for.
const BESIDE: usize = 2;
const AMONG: usize = 6;
/// Samples on either side over which the same palms must be touched: a landing bends the way of all contacts.
pub(super) const STEADY: usize = 3;
/// What others say that a value is, in its units, and the sum of the squares of what they count by.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told {
    pub(super) value: DVec3,
    pub(super) squares: f64,
}

/// Places of seven values whose smaller one comes first, one after the other, until the fourth is their median.
const EXCHANGES: [[usize; 2]; 13] =
    [[0, 5], [0, 3], [1, 6], [2, 4], [0, 1], [3, 5], [2, 6], [2, 3], [3, 6], [4, 5], [1, 4], [1, 3], [3, 4]];

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
    pub(super) fn left_at_sample(&self, sample: usize) -> f64 {
        let Ok(j) = self.samples.binary_search(&sample) else { return 0.0 };
        self.left_at(j, &vec![false; self.points.len()]).unwrap_or(f64::INFINITY)
    }

    /// How far a value is from what those beside it say that are not `out`.
    fn left_at(&self, j: usize, out: &[bool]) -> Option<f64> {
        self.told(j, out).map(|told| self.left(j, &told))
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
