//! What sampled forces do between samples, and what that may be off by.

use super::both::of_each;
use super::noise::{ContactNoiseLevel, WrenchNoise, force_trace, traces};
use super::record::{Contact, Interval, Wrench, add_noise, six, wrench};
use crate::quadrature::running_integral;
use glam::DVec3;
use nalgebra::{Matrix6, Vector6};

/// By the forces at samples of the contacts that are `felt` there.
pub(super) fn intervals<'a, I: Iterator<Item = &'a Contact>>(
    times: &[f64],
    felt: impl Fn(usize) -> I + Sync,
    noise: &ContactNoiseLevel,
) -> Vec<Interval> {
    let wrenches: Vec<Wrench> = (0..times.len()).map(|k| wrench(felt(k))).collect();
    let since: Vec<f64> = times.iter().map(|t| t - times[0]).collect();
    let rough = |k: usize| {
        let h = since[k] - since[k - 1];
        // The noise of a sample is felt on both its sides; put into the interval after it alone it is white.
        let mut white = Matrix6::zeros();
        felt(k - 1).for_each(|contact| add_noise(&mut white, contact, noise.contact, h));
        let noise = WrenchNoise { white, ..WrenchNoise::default() };
        Interval::trapezoid(h, [&wrenches[k - 1], &wrenches[k]], noise)
    };
    let mut all = of_each(times.len(), &(1..times.len()).collect::<Vec<_>>(), rough);
    smooth(&since, &wrenches, &mut all);
    let rubs = (0..times.len()).any(|k| felt(k).any(|contact| contact.planar && !contact.frictionless));
    doubt(&mut all, &wrenches, rubs);
    all
}

/// Takes the rule of order 6 in place of the trapezoidal one, unless noise is what makes them differ.
fn smooth(since: &[f64], wrenches: &[Wrench], all: &mut [Interval]) {
    let sums = running_integral(since, wrenches, Wrench::default());
    let impulse = |k: usize| sums[k + 1] + sums[k] * -1.0;
    let differ = |(k, of): (usize, &Interval)| (impulse(k).force - of.impulse.force).length_squared();
    let differences: f64 = all.iter().enumerate().map(differ).sum();
    let expected: f64 = all.iter().map(|i| RULES_DIFFER * force_trace(&i.noise.white)).sum();
    if differences < 2.0 * expected {
        return;
    }
    let timed: Vec<DVec3> = wrenches.iter().zip(since).map(|(w, t)| w.force * *t).collect();
    let firsts = running_integral(since, &timed, DVec3::ZERO);
    for (k, interval) in all.iter_mut().enumerate() {
        interval.impulse = impulse(k);
        interval.first = firsts[k + 1] - firsts[k] - interval.impulse.force * since[k];
    }
}

/// Adds to the noise what the impulse and moment of each interval may be off by, if the force jumps within one: nobody knows when. Where palms rub in
/// the plane jumps are expected, at the ends of a log too.
fn doubt(all: &mut [Interval], wrenches: &[Wrench], rubs: bool) {
    all.iter_mut().for_each(|interval| interval.noise.sampled = traces(&interval.noise.white));
    let jumps: Vec<Option<Vector6<f64>>> = (0..all.len()).map(|k| jump(k, &all[k], wrenches, rubs)).collect();
    for (k, interval) in all.iter_mut().enumerate() {
        let beside = [k.checked_sub(1), Some(k + 1)].into_iter().flatten().map(|j| (j, BESIDE));
        for (j, share) in beside.chain([(k, 1.0)]) {
            if let Some(Some(jump)) = jumps.get(j) {
                interval.noise.white.ger(share, jump, jump, 1.0);
            }
        }
    }
}

/// Standard deviation that a jump within the interval after sample `k` gives to its impulse and moment; none where none is seen.
///
/// A jump is what a step between two samples is more than the mean of the steps beside it, at an end of the log than the one beside it, and more than
/// noise makes of it.
fn jump(k: usize, interval: &Interval, wrenches: &[Wrench], rubs: bool) -> Option<Vector6<f64>> {
    let h = interval.h;
    let step = |k: usize| Some(*wrenches.get(k + 1)? + wrenches[k] * -1.0);
    let own = step(k)?;
    // Noise of one sample makes so many times its variance of a jump.
    let (jump, times) = match (k.checked_sub(1).and_then(step), step(k + 1)) {
        (Some(before), Some(after)) => (own + (before + after) * -0.5, 5.0),
        (Some(beside), None) | (None, Some(beside)) if rubs => (own + beside * -1.0, 6.0),
        _ => return None,
    };
    let noise = times * if rubs { EXPECTED } else { SEEN } / (h * h);
    // Palms that press against each other leave each other's force, and the moment alone jumps as they let go.
    let seen = |(jump, variance): (DVec3, f64)| {
        1.0 - noise * variance / jump.length_squared().max(f64::MIN_POSITIVE)
    };
    let seen =
        [jump.force, jump.moment].into_iter().zip(interval.noise.sampled).map(seen).fold(0.0, f64::max);
    // Of a time that is uniform over the interval.
    (seen > 0.0).then(|| six(jump.force, jump.moment) * (h * (seen / 12.0).sqrt()))
}

/// Share of the variance that a jump makes of its interval which it makes of those beside it: in the middle of a peak the steps on
/// both sides are alike, and nothing seems to jump where the rule errs most.
const BESIDE: f64 = 0.5;

/// Times the variance that noise makes of a jump from which on it is one; and the same of palms that rub in the plane: whenever a slip ends friction jumps
/// there, and jumps below nine times, up to 13 deviations of a force at a sample, would be taken for none, which is five deviations of an interval's
/// impulse. In space the lower one mends nothing: one motion of twelve at 200 Hz is beyond five deviations with either.
const SEEN: f64 = 9.0;
const EXPECTED: f64 = 1.0;

/// Variance of the difference between the rule of order 6 and the trapezoidal one, of samples of unit variance and spacing.
///
/// Where noise makes all of it, the trapezoidal rule is as good, and what its noise does is known exactly.
const RULES_DIFFER: f64 = 2.0 * (11.0 * 11.0 + 93.0 * 93.0 + 82.0 * 82.0) / (1440.0 * 1440.0);

#[cfg(test)]
mod tests {
    use super::*;

    /// A force that rises and falls within some samples, and turns as it does: with the momentum that it makes up to a time.
    struct Peak {
        middle: f64,
        width: f64,
    }

    impl Peak {
        fn force(&self, t: f64) -> DVec3 {
            let s = (t - self.middle) / self.width;
            DVec3::new(s, 0.0, 1.0) * (-0.5 * s * s).exp()
        }

        /// Momentum from one time to another, by a rule of so many parts that it is exact.
        fn momentum(&self, from: f64, to: f64) -> DVec3 {
            const PARTS: usize = 200;
            let h = (to - from) / PARTS as f64;
            (0..PARTS).map(|i| self.force(from + (i as f64 + 0.5) * h) * h).sum()
        }
    }

    /// In intervals: what the impulse is off by, over its standard deviation in that direction.
    fn off(peak: &Peak) -> Vec<f64> {
        let times: Vec<f64> = (0..40).map(f64::from).collect();
        let wrenches: Vec<Wrench> =
            times.iter().map(|t| Wrench { force: peak.force(*t), ..Wrench::default() }).collect();
        let noise = WrenchNoise { white: Matrix6::identity() * 1e-6, ..WrenchNoise::default() };
        let ends = |k: usize| Interval::trapezoid(1.0, [&wrenches[k], &wrenches[k + 1]], noise);
        let mut all: Vec<Interval> = (0..39).map(ends).collect();
        smooth(&times, &wrenches, &mut all);
        doubt(&mut all, &wrenches, false);
        let one = |(interval, t): (&Interval, &f64)| {
            let off = interval.impulse.force - peak.momentum(*t, t + 1.0);
            let off = six(off, DVec3::ZERO);
            let inverse = interval.noise.white.cholesky().expect("noise has full rank").inverse();
            off.dot(&(inverse * off)).sqrt()
        };
        all.iter().zip(&times).map(one).collect()
    }

    /// Two palms that press against each other and let go: no force is left of them before or after, but a moment is.
    #[test]
    fn a_moment_that_jumps_alone_is_noise_of_its_interval_and_none_of_its_samples() {
        let moment = |k: usize| DVec3::Y * if k < 20 { 1.0 } else { 0.0 };
        let wrenches: Vec<Wrench> =
            (0..40).map(|k| Wrench { moment: moment(k), ..Wrench::default() }).collect();
        let noise = WrenchNoise { white: Matrix6::identity() * 1e-6, ..WrenchNoise::default() };
        for rubs in [false, true] {
            let ends = |k: usize| Interval::trapezoid(1.0, [&wrenches[k], &wrenches[k + 1]], noise);
            let mut all: Vec<Interval> = (0..39).map(ends).collect();
            doubt(&mut all, &wrenches, rubs);
            // Of a time that is uniform over the interval, and half of what is beside it at both sides.
            let variance = all[19].noise.white[(4, 4)];
            assert!((1.0..1.3).contains(&(12.0 * variance)), "{variance}");
            assert!(all[19].noise.sampled_share() < 1e-4 && all[10].noise.sampled_share() == 1.0);
            assert_eq!(all[19].noise.white[(0, 0)], 1e-6);
        }
    }

    /// Down to a standard deviation of half a spacing: one that is narrower stands between two samples, and is a blow.
    #[test]
    fn what_a_peak_between_samples_is_off_by_is_told_wherever_it_stands() {
        let mut worst = 0.0_f64;
        for phase in 0..10 {
            for width in [0.5, 0.7, 1.0, 1.5, 3.0] {
                let off = off(&Peak { middle: 20.0 + 0.1 * f64::from(phase), width });
                worst = off.into_iter().fold(worst, f64::max);
            }
        }
        assert!(worst < 2.5, "{worst} deviations");
    }
}
