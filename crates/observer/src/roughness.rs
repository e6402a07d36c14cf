//! What of the readings of a sensor is noise: what no polynomial through some of them in a row explains.

use glam::DVec3;

/// Readings in a row of which the polynomial of the last degree but one is taken off. What is left of noise is the same for all of them,
/// of a smooth motion that is sampled rarely it falls.
const IN_A_ROW: [usize; 3] = [5, 7, 9];
/// What is left of a smooth motion falls by more than this: medians of noise differ by less.
const LESS: f64 = 0.8;
/// Median of |x| for a standard normal x.
const MEDIAN_OF_NORMAL: f64 = 0.674_489_750_196_081_7;
/// Twice the deviation of a standard deviation by the median of some numbers, times the root of how many: 1.2 of independent ones, and each of these hangs
/// together with those of the rows beside its own.
const CHANCE: f64 = 3.3;
/// Groups of forces by their size, at most, and the readings in one, at least.
const GROUPS: usize = 12;
const LEAST_IN_GROUP: usize = 40;
/// Rows of a sensor that tell its noise, at most: of long logs every so many-th does.
const TELL: usize = 20_000;
/// Share of readings equal to the one before from which on they are counted in steps.
const REPEATED: f64 = 0.1;
/// Times from sample to sample that are alike but for rounding, as a share of a row's.
const ALIKE: f64 = 1e-12;
/// Steps of readings that are rounding, as a share of the largest.
const ROUNDING: f64 = 1e-9;

/// Axes along which a sensor reads a vector.
#[derive(Clone, Copy)]
pub(crate) struct SensedAlong([DVec3; 3], usize);

impl<const N: usize> From<[DVec3; N]> for SensedAlong {
    fn from(axes: [DVec3; N]) -> Self {
        Self(std::array::from_fn(|i| axes.get(i).copied().unwrap_or_default()), N.min(3))
    }
}

impl SensedAlong {
    fn of(&self, vector: DVec3) -> impl Iterator<Item = f64> {
        self.0.iter().take(self.1).map(move |axis| vector.dot(*axis).abs())
    }
}

/// What is rough about the readings of sensors of one kind.
#[derive(Default)]
pub(crate) struct Rough {
    /// Size of a reading, and what of it no polynomial explains: of unit variance for white noise of unit variance.
    all: [Vec<(f64, f64)>; IN_A_ROW.len()],
    /// Differences of successive readings, without sign.
    steps: Vec<f64>,
}

impl Rough {
    /// Vectors as one sensor reads them, along those axes in which it does.
    pub(crate) fn add(
        &mut self,
        times: &[f64],
        reading: impl Fn(usize) -> Option<DVec3>,
        axes: impl Fn(usize) -> SensedAlong,
    ) {
        let readings: Vec<Option<DVec3>> = (0..times.len()).map(reading).collect();
        let axes: Vec<SensedAlong> = (0..times.len()).map(axes).collect();
        for (k, pair) in readings.windows(2).enumerate() {
            if let [Some(a), Some(b)] = pair {
                self.steps.extend(axes[k].of(*b - *a));
            }
        }
        let every = times.len().div_ceil(TELL).max(1);
        for (all, count) in self.all.iter_mut().zip(IN_A_ROW) {
            let mut weights = Weights::default();
            for (k, row) in readings.windows(count).enumerate().step_by(every) {
                let middle = k + count / 2;
                let weights = weights.at(&times[k..k + count]);
                let weighed = row.iter().zip(weights).map(|(reading, weight)| Some((*reading)? * *weight));
                let Some(rough) = weighed.sum::<Option<DVec3>>() else { continue };
                let size = readings[middle].map_or(0.0, DVec3::length);
                all.extend(axes[middle].of(rough).map(|rough| (size, rough)));
            }
        }
    }

    /// In units that differ by the size of a reading. Of no readings where the usual one is zero.
    pub(crate) fn over(self, unit: impl Fn(f64) -> f64) -> Self {
        let mut sizes: Vec<f64> = self.all[0].iter().map(|(size, _)| *size).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        let usual = sizes.get(sizes.len() / 2).map_or(0.0, |size| unit(*size));
        if usual <= 0.0 {
            return Self::default();
        }
        let of = |(size, rough): (f64, f64)| (size, rough / unit(size).max(f64::MIN_POSITIVE));
        Self {
            all: self.all.map(|all| all.into_iter().map(of).collect()),
            steps: self.steps.into_iter().map(|step| step / usual).collect(),
        }
    }

    /// Standard deviation of the noise.
    pub(crate) fn deviation(&self) -> f64 {
        of(self.least()).max(self.counted())
    }

    /// The same in units of what is stated, as white noise that makes means of readings as noisy, where it is more than one beyond chance. None where
    /// longer rows would leave less: what is left may be the motion's.
    ///
    /// A reading that a sensor which counts in steps repeats tells nothing new: the mean of many is as good as that of the others.
    pub(crate) fn beyond_chance(&self) -> Option<f64> {
        let (counted, deviations) = (self.counted(), self.deviations());
        let [.., shorter, longest] = deviations;
        let least = deviations[self.least_of(&deviations)];
        let noise = if counted > least {
            let [repeated, all] = self.repeated();
            // Some step is no repetition where one is counted.
            Some(counted * (all / (all - repeated)).sqrt())
        } else {
            (longest >= LESS * shorter).then_some(least)
        };
        let chance = CHANCE / (self.all[0].len().max(1) as f64).sqrt();
        noise.filter(|noise| *noise > 1.0 + chance)
    }

    /// What is rough over so few readings in a row that more of them would leave as much.
    pub(crate) fn least(&self) -> &[(f64, f64)] {
        &self.all[self.least_of(&self.deviations())]
    }

    fn deviations(&self) -> [f64; IN_A_ROW.len()] {
        self.all.each_ref().map(|all| of(all))
    }

    /// Which of these rows that is.
    fn least_of(&self, deviations: &[f64; IN_A_ROW.len()]) -> usize {
        let less =
            |least: usize, i: usize| !self.all[i].is_empty() && deviations[i] < LESS * deviations[least];
        (1..IN_A_ROW.len()).fold(0, |least, i| if less(least, i) { i } else { least })
    }

    /// Of noise that grows with the readings: its fixed part, and its share of them.
    pub(crate) fn growing(&self) -> [f64; 2] {
        let mut all = self.least().to_vec();
        all.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let group = all.len().div_ceil(GROUPS).max(LEAST_IN_GROUP);
        // Square of the size over the variance, and one over it, in each group: a line in the former has both parts.
        let in_group = |group: &[(f64, f64)]| {
            let size = group[group.len() / 2].0;
            let variance = of(group).powi(2);
            (variance > 0.0).then(|| (1.0 / variance, size * size / variance))
        };
        let groups: Vec<_> = all.chunks(group).filter_map(in_group).collect();
        let sum = |of: fn(&(f64, f64)) -> f64| groups.iter().map(of).sum::<f64>();
        let (one, size) = (sum(|g| g.0), sum(|g| g.1));
        let (ones, both, sizes) = (sum(|g| g.0 * g.0), sum(|g| g.0 * g.1), sum(|g| g.1 * g.1));
        let alone = |of: f64, squares: f64| if squares > 0.0 { of / squares } else { 0.0 };
        let determinant = ones * sizes - both * both;
        let fixed = (one * sizes - size * both) / determinant;
        let share = (size * ones - one * both) / determinant;
        let [fixed, share] = match (fixed > 0.0, share > 0.0) {
            (true, true) => [fixed, share],
            (true, false) => [alone(one, ones), 0.0],
            (false, true) => [0.0, alone(size, sizes)],
            // Forces of one size, or no noise at all.
            (false, false) => [alone(one, ones), 0.0],
        };
        [fixed.sqrt().max(self.counted()), share.sqrt()]
    }

    /// Of sensors that count in steps, the deviation of what that leaves out.
    fn counted(&self) -> f64 {
        let rounding = self.rounding();
        let [repeated, all] = self.repeated();
        let step = self.steps.iter().copied().filter(|step| *step > rounding).reduce(f64::min);
        step.filter(|_| repeated >= REPEATED * all).map_or(0.0, |step| step / 12.0_f64.sqrt())
    }

    /// How many readings are those before them, and of how many.
    fn repeated(&self) -> [f64; 2] {
        let rounding = self.rounding();
        let repeated = self.steps.iter().filter(|step| **step <= rounding).count();
        [repeated as f64, self.steps.len() as f64]
    }

    fn rounding(&self) -> f64 {
        ROUNDING * self.steps.iter().copied().fold(0.0, f64::max)
    }
}

/// Weights of one row of readings after the other, made anew where the times between them change.
#[derive(Default)]
struct Weights {
    times: Vec<f64>,
    of: Vec<f64>,
}

impl Weights {
    fn at(&mut self, times: &[f64]) -> &[f64] {
        let after = |of: &[f64], i: usize| of[i] - of[0];
        let last = times.len() - 1;
        let alike = |i: usize| (after(times, i) - after(&self.times, i)).abs() < ALIKE * after(times, last);
        if self.times.len() != times.len() || !(0..times.len()).all(alike) {
            (self.times, self.of) = (times.to_vec(), beyond_polynomials(times));
        }
        &self.of
    }
}

/// Weights of readings at some times whose sum is zero for any polynomial of a degree below the last, and of unit variance for white
/// noise of unit variance.
fn beyond_polynomials(times: &[f64]) -> Vec<f64> {
    let all = times[times.len() - 1] - times[0];
    let apart = |i: usize, j: usize| if i == j { 1.0 } else { (times[i] - times[j]) / all };
    let weight = |i: usize| (0..times.len()).map(|j| apart(i, j)).product::<f64>().recip();
    let weights: Vec<f64> = (0..times.len()).map(weight).collect();
    let norm = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
    weights.into_iter().map(|w| w / norm).collect()
}

/// Standard deviation of normal variables by the median of their absolute values; zero of none.
fn of(rough: &[(f64, f64)]) -> f64 {
    let mut absolute: Vec<f64> = rough.iter().map(|(_, rough)| *rough).collect();
    if absolute.is_empty() {
        return 0.0;
    }
    let middle = absolute.len() / 2;
    *absolute.select_nth_unstable_by(middle, f64::total_cmp).1 / MEDIAN_OF_NORMAL
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

    /// A smooth vector with noise of its own kind.
    fn rough(noise: impl Fn(&mut Normal, DVec3) -> DVec3) -> Rough {
        let mut random = Normal::seeded(5);
        // Samples come when they come.
        let times: Vec<f64> = (0..8000).map(|k| 1e-3 * (f64::from(k) + 0.4 * random.draw().tanh())).collect();
        let readings: Vec<DVec3> = times
            .iter()
            .map(|t| DVec3::new(t.sin(), t.cos(), 0.3 * t))
            .map(|smooth| smooth + noise(&mut random, smooth))
            .collect();
        let mut rough = Rough::default();
        rough.add(&times, |k| Some(readings[k]), |_| DVec3::AXES.into());
        rough
    }

    fn vector(random: &mut Normal) -> DVec3 {
        DVec3::new(random.draw(), random.draw(), random.draw())
    }

    #[test]
    fn a_smooth_signal_is_not_noise_and_noise_has_its_deviation() {
        assert!(rough(|_, _| DVec3::ZERO).deviation() < 1e-11);
        // Twenty samples a radian leave 1e-7 of it beyond a cubic.
        let rare = |k: u32| DVec3::splat((0.05 * f64::from(k)).sin());
        let mut all = Rough::default();
        let times: Vec<f64> = (0..400).map(f64::from).collect();
        all.add(&times, |k| Some(rare(k as u32)), |_| [DVec3::X].into());
        assert!(of(&all.all[0]) > 3e-7 && all.deviation() < 1e-11, "{}", all.deviation());
        let found = rough(|random, _| 1e-3 * vector(random)).deviation();
        // The median of 24000 correlated numbers is known to about a hundredth.
        assert!((found / 1e-3 - 1.0).abs() < 0.04, "{found}");
        // One reading in a hundred is nonsense.
        let outliers = |random: &mut Normal, _: DVec3| {
            let nonsense = if random.draw() > 2.33 { 10.0 } else { 1e-3 };
            nonsense * vector(random)
        };
        let found = rough(outliers).deviation();
        assert!((found / 1e-3 - 1.0).abs() < 0.15, "{found}");
    }

    #[test]
    fn what_longer_rows_leave_less_of_is_no_noise() {
        // Two samples a radian: nine in a row leave a tenth of what seven do.
        let rare = |noise: f64| {
            let mut random = Normal::seeded(6);
            let times: Vec<f64> = (0..400).map(f64::from).collect();
            let readings: Vec<DVec3> =
                times.iter().map(|t| DVec3::splat((0.5 * t).sin() + noise * random.draw())).collect();
            let mut all = Rough::default();
            all.add(&times, |k| Some(readings[k]), |_| [DVec3::X].into());
            all.over(|_| 5e-3).beyond_chance()
        };
        assert_eq!(rare(0.0), None);
        assert_eq!(rare(4e-3), None);
        let found = rare(0.01).unwrap();
        assert!((found / 2.0 - 1.0).abs() < 0.15, "{found}");
    }

    #[test]
    fn noise_that_grows_with_the_reading_is_told_from_noise_that_does_not() {
        let [fixed, share] = rough(|random, smooth| 0.02 * smooth.length() * vector(random)).growing();
        assert!((share / 0.02 - 1.0).abs() < 0.1 && fixed < 0.01, "{fixed} {share}");
        let [fixed, share] = rough(|random, _| 0.01 * vector(random)).growing();
        assert!((fixed.hypot(share) / 0.01 - 1.0).abs() < 0.1 && share < 0.004, "{fixed} {share}");
    }

    #[test]
    fn sensors_that_count_in_steps_have_the_noise_of_these() {
        let counted = |random: &mut Normal, smooth: DVec3| {
            let _ = random;
            (smooth * 50.0).round() / 50.0 - smooth
        };
        let all = rough(counted);
        let (found, step) = (all.deviation(), 0.02 / 12.0_f64.sqrt());
        assert!((found / step - 1.0).abs() < 0.01, "{found}");
        // Eight seconds at speeds of 0.64, 0.64 and 0.3 in the mean: of 24000 readings 650 are not those before them.
        let alike = (24_000.0_f64 / 650.0).sqrt();
        let times = all.over(|_| step).beyond_chance().unwrap();
        assert!((times / alike - 1.0).abs() < 0.05, "{times}");
    }
}
