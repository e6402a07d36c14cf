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

/// Takes in place of the trapezoidal rule that of some which is least off: the one of order 6, or parabolas through so many samples that noise makes next to
/// nothing of their bend. The one of order 6 it is as well where it differs from that by more than noise makes; not else at the ends of the log, where it is noisier.
///
/// What noise makes of a rule beyond the trapezoidal one is not counted: it shakes the motion at samples, of which conditions know more than forces do.
fn smooth(since: &[f64], wrenches: &[Wrench], all: &mut [Interval]) {
    let Some(last) = all.len().checked_sub(1) else { return };
    let sixth = of_order_6(since, wrenches, all);
    let gained = |rule: Rule, k: usize| match rule {
        Rule::Trapezoid => Gained::default(),
        Rule::OfOrder6 => sixth[k],
        Rule::Parabola(count) => {
            let from = (k + 1).saturating_sub(count / 2).min(since.len() - count);
            parabola(&since[from..from + count], &wrenches[from..from + count], all[k].h)
        }
    };
    let noise = |k: usize| force_trace(&all[k].noise.white);
    let apart = |k: usize, own: &Gained| (own.impulse.force - sixth[k].impulse.force).length_squared();
    let told = |k: usize, own: &Gained| apart(k, own) > SEEN * noise(k) * sixth[k].share;
    // Of noise there is as little in a parabola's bend as in any linear estimate of it, and in its difference from the rule of order 6 as much as their
    // variances differ by; what is beyond that it misses (Mallows).
    let off = |rule: Rule, k: usize| {
        let own = gained(rule, k);
        let own = if told(k, &own) { sixth[k] } else { own };
        apart(k, &own) + noise(k) * (2.0 * own.share - sixth[k].share)
    };
    let parabolas = || PARABOLAS.into_iter().filter(|count| *count <= since.len()).map(Rule::Parabola);
    let rules = [Rule::Trapezoid, Rule::OfOrder6].into_iter().chain(parabolas());
    // Of long logs some intervals tell as much as all.
    let tell = (ENDS..all.len().saturating_sub(ENDS)).step_by(all.len().div_ceil(TELL).max(1));
    let sums = rules.map(|rule| (rule, tell.clone().map(|k| off(rule, k)).sum::<f64>()));
    let within = sums.min_by(|a, b| a.1.total_cmp(&b.1)).map_or(Rule::Trapezoid, |(rule, _)| rule);
    let at_ends = if let Rule::OfOrder6 = within { parabolas().next().unwrap_or(within) } else { within };
    let one = |k: usize| {
        let own = gained(if k.min(last - k) < ENDS { at_ends } else { within }, k);
        if told(k, &own) { sixth[k] } else { own }
    };
    let gains: Vec<Gained> = (0..all.len()).map(one).collect();
    for (interval, Gained { impulse, first, .. }) in all.iter_mut().zip(gains) {
        interval.impulse = interval.impulse + impulse;
        interval.first += first;
    }
}

#[derive(Clone, Copy)]
enum Rule {
    Trapezoid,
    OfOrder6,
    /// Through so many samples around an interval.
    Parabola(usize),
}

/// What a rule gives of an interval beyond the trapezoidal one.
#[derive(Clone, Copy, Default)]
struct Gained {
    impulse: Wrench,
    /// Of the first moment in time.
    first: DVec3,
    /// Variance of that impulse over the interval's, as noise of samples makes it.
    share: f64,
}

fn of_order_6(since: &[f64], wrenches: &[Wrench], all: &[Interval]) -> Vec<Gained> {
    let sums = running_integral(since, wrenches, Wrench::default());
    let timed: Vec<DVec3> = wrenches.iter().zip(since).map(|(w, t)| w.force * *t).collect();
    let firsts = running_integral(since, &timed, DVec3::ZERO);
    let last = all.len() - 1;
    let one = |(k, interval): (usize, &Interval)| {
        let impulse = sums[k + 1] + sums[k] * -1.0;
        let first = firsts[k + 1] - firsts[k] - impulse.force * since[k] - interval.first;
        let share = RULES_DIFFER[k.min(last - k).min(ENDS)];
        Gained { impulse: impulse + interval.impulse * -1.0, first, share }
    };
    all.iter().enumerate().map(one).collect()
}

/// That of a parabola through samples, of an interval of the duration `h`.
fn parabola(times: &[f64], wrenches: &[Wrench], h: f64) -> Gained {
    let count = times.len() as f64;
    let middle = times.iter().sum::<f64>() / count;
    let (two, three) =
        times.iter().map(|t| t - middle).fold((0.0, 0.0), |(two, three), t| (two + t * t, three + t * t * t));
    // Orthogonal to all that is linear in time, so that what the wrenches have of it is the parabola's.
    let bends = times.iter().map(|t| t - middle).map(|t| t * t - two / count - t * three / two);
    let squares: f64 = bends.clone().map(|bend| bend * bend).sum();
    let sum = bends.zip(wrenches).fold(Wrench::default(), |sum, (bend, w)| sum + *w * bend);
    let square = sum * squares.recip();
    Gained {
        impulse: square * (-h.powi(3) / 6.0),
        first: square.force * (-h.powi(4) / 12.0),
        share: h.powi(4) / (36.0 * squares),
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

/// Times the variance that noise makes of a jump, or of what two rules differ by, from which on it is one; and the same of palms that rub in the plane:
/// whenever a slip ends friction jumps there, and jumps below nine times, up to 13 deviations of a force at a sample, would be taken for none, which is five
/// deviations of an interval's impulse. In space the lower one mends nothing: one motion of twelve at 200 Hz is beyond five deviations with either.
const SEEN: f64 = 9.0;
const EXPECTED: f64 = 1.0;

/// Samples that parabolas are put through: as many as the rule of order 6 has, at least.
const PARABOLAS: [usize; 3] = [8, 16, 32];

/// Variance of the difference between the rule of order 6 and the trapezoidal one, of samples of unit variance and spacing: of the intervals at an end of the log,
/// which it has no samples beyond, and of all others.
const RULES_DIFFER: [f64; ENDS + 1] = [
    (245.0 * 245.0 + 707.0 * 707.0 + 798.0 * 798.0 + 482.0 * 482.0 + 173.0 * 173.0 + 27.0 * 27.0)
        / (1440.0 * 1440.0),
    (27.0 * 27.0 + 83.0 * 83.0 + 302.0 * 302.0 + 258.0 * 258.0 + 77.0 * 77.0 + 11.0 * 11.0)
        / (1440.0 * 1440.0),
    2.0 * (11.0 * 11.0 + 93.0 * 93.0 + 82.0 * 82.0) / (1440.0 * 1440.0),
];
const ENDS: usize = 2;
/// Intervals that tell which rule is least off, at most.
const TELL: usize = 2000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;

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

    /// What the impulses of noisy samples of a force are off by beyond what the trapezoidal rule makes of their noise, whose deviation is one.
    fn beyond_noise(
        force: impl Fn(f64) -> DVec3,
        momentum: impl Fn(f64, f64) -> DVec3,
        count: u32,
    ) -> Vec<f64> {
        let mut normal = Normal::seeded(3);
        let times: Vec<f64> = (0..count).map(f64::from).collect();
        let noise: Vec<DVec3> =
            times.iter().map(|_| DVec3::new(normal.draw(), normal.draw(), normal.draw())).collect();
        let at = |(t, noise): (&f64, &DVec3)| Wrench { force: force(*t) + *noise, ..Wrench::default() };
        let wrenches: Vec<Wrench> = times.iter().zip(&noise).map(at).collect();
        let white = WrenchNoise { white: Matrix6::identity(), ..WrenchNoise::default() };
        let ends = |pair: &[Wrench]| Interval::trapezoid(1.0, [&pair[0], &pair[1]], white);
        let mut all: Vec<Interval> = wrenches.windows(2).map(ends).collect();
        smooth(&times, &wrenches, &mut all);
        let off = |(k, interval): (usize, &Interval)| {
            let of_noise = 0.5 * (noise[k] + noise[k + 1]);
            (interval.impulse.force - of_noise - momentum(times[k], times[k + 1])).length()
        };
        all.iter().enumerate().map(off).collect()
    }

    /// Of a force whose bend the trapezoidal rule misses by 0.05, and in whose bend the noise makes 0.2 of the rule of order 6, a parabola gives both up.
    #[test]
    fn noise_makes_next_to_nothing_of_a_bend() {
        const RATE: f64 = 0.3;
        let axis = DVec3::new(0.6, 0.0, 0.8) * 10.0;
        let momentum = |from: f64, to: f64| axis * (((RATE * from).cos() - (RATE * to).cos()) / RATE);
        let off = beyond_noise(|t| axis * (RATE * t).sin(), momentum, 200);
        let rms = |of: &[f64]| (of.iter().map(|off| off * off).sum::<f64>() / of.len() as f64).sqrt();
        let (ends, within) = ([off[0], off[1], off[197], off[198]], &off[2..197]);
        assert!(rms(within) < 0.035, "{}", rms(within));
        assert!(rms(&ends) < 0.15, "{ends:?}");
    }

    /// A force that comes and goes within a few samples of a log in which nothing else bends.
    #[test]
    fn what_noise_does_not_make_is_followed() {
        let peak = Peak { middle: 600.3, width: 1.5 };
        let off = beyond_noise(|t| peak.force(t) * 50.0, |from, to| peak.momentum(from, to) * 50.0, 1200);
        // What differs by less than three deviations of the difference, 0.64, may be noise; the trapezoidal rule is off by 1.8.
        let worst = off.iter().copied().fold(0.0, f64::max);
        assert!(worst < 1.2, "{worst}");
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
