//! Impulses that palms measure, in place of integrals of forces at samples: exact through blows and jumps.

use super::noise::{ContactNoiseLevel, ImpulseNoise, WrenchNoise};
use super::record::{Contact, Interval, Wrench, add_contact_noise, six};
use glam::DVec3;
use nalgebra::Matrix6;
use object_dynamics::{ContactLog, LoggedPalm, SensedAxes};

/// Deviations of an impulse at a palm that is not touched at either end of the interval below which it is none.
const FELT: f64 = 5.0;
/// Squared weights of two samples from which a contact is continued by half an interval: 1.5 and -0.5.
const CONTINUED: f64 = 2.5;

/// The noise of a palm's impulse, if it is read: in three axes, and with a noise.
pub(super) fn read(palm: &LoggedPalm, noise: &ContactNoiseLevel) -> Option<ImpulseNoise> {
    noise.impulse.filter(|_| palm.impulse_axes() == Some(SensedAxes::Three))
}

/// Force of a palm at sample `k` by its impulses, and the standard deviation of each axis: the mean over those intervals beside it
/// over which no palm is newly touched or left, where nothing speaks of a blow; over both where there is none.
///
/// It is of second order in the time between samples, of first order beside a change. Neighbouring samples share an interval: the
/// deviation is that of one interval, so that means over some samples are as good as stated.
pub(super) fn force(log: &ContactLog, palm: &LoggedPalm, k: usize, noise: &ImpulseNoise) -> (DVec3, f64) {
    let times = log.times();
    let touched = |k: usize| log.palms().iter().map(move |palm| palm.touch(k).is_some());
    let inside = |k: &usize| (1..times.len()).contains(k);
    let calm = |&k: &usize| touched(k - 1).eq(touched(k));
    let beside = || [k, k + 1].into_iter().filter(inside);
    let any_calm = beside().any(|k| calm(&k));
    let (mut sum, mut time, mut variance, mut count) = (DVec3::ZERO, 0.0, 0.0, 0.0);
    for k in beside().filter(|k| !any_calm || calm(k)) {
        let (h, J) = (times[k] - times[k - 1], palm.impulse(k).map_or(DVec3::ZERO, |J| J.vector));
        sum += J;
        time += h;
        variance += (noise.of(J) / h).powi(2);
        count += 1.0;
    }
    // A log has two samples at least.
    if time > 0.0 { (sum / time, f64::sqrt(variance / count)) } else { (DVec3::ZERO, 0.0) }
}

/// The impulse of a palm over the interval that ends at sample `k`, N s.
pub(super) fn over(log: &ContactLog, palm: usize, k: usize) -> DVec3 {
    log.palms()[palm].impulse(k).map_or(DVec3::ZERO, |J| J.vector)
}

/// Adds to `intervals` what palms whose impulses are read do over them, `spread` being how far contacts are from the origin.
pub(super) fn add(
    log: &ContactLog,
    contacts: &[Vec<Contact>],
    noise: &ContactNoiseLevel,
    spread: f64,
    intervals: &mut [Interval],
) {
    for (i, palm) in log.palms().iter().enumerate() {
        let Some(of_impulse) = read(palm, noise) else { continue };
        for (k, interval) in (1..).zip(intervals.iter_mut()) {
            let J = over(log, i, k);
            let at = |k: usize| contacts.get(k).and_then(|all| all.iter().find(|contact| contact.palm == i));
            let path =
                Path::new([k.checked_sub(2).and_then(at), at(k - 1), at(k), at(k + 1)], k, log.times());
            let bend = |k: usize| kink(|back: usize| at((k + 2).checked_sub(back)?), noise.contact);
            match path.map(|path| path.kinked([bend(k - 1), bend(k), bend(k + 1)])) {
                Some(path) => path.push(J, of_impulse.of(J), noise.contact, interval),
                None if J.length() > FELT * of_impulse.of(J) => unseen(J, of_impulse.of(J), spread, interval),
                None => {}
            }
        }
    }
}

/// Where a palm is touched over an interval.
struct Path<'a> {
    /// The contact at the start, else at the end.
    contact: &'a Contact,
    /// Mean over the interval, and change.
    mean: DVec3,
    change: DVec3,
    /// Change of the force.
    force: DVec3,
    /// Of the mean: variance of what noise of contacts does to it over that of a contact, and how far off it may be as nobody knows
    /// when the palm was touched, or when within the intervals the contact changed its speed.
    noise: f64,
    unsure: DVec3,
}

/// Root mean square of what the mean of a contact over an interval is off by, over what its change of speed within makes in one interval, if the time is
/// uniform: `x (1 - x) / 2` of it at the share `x` of the interval, where the parabola has a 24th.
const KINKED: f64 = 0.056;
/// The same where it is in an interval beside, whose bend the parabola takes for its own: at most a 24th, a half of the variance as good as that.
const BESIDE: f64 = 0.5;
/// Variance of a kink by noise of contacts over that of one of them, and times that from which on it is one.
const OF_KINK: f64 = 28.0;
const SEEN: f64 = 9.0;

/// What a contact goes on by in an interval that it would not but for a change of its speed within the one between the two samples in the middle of six, the last of
/// which is `at(0)`: what the way changes by there beyond the changes beside it, as far as noise of the given deviation, m, does not make it. None where none is seen.
pub(super) fn kink<'a>(at: impl Fn(usize) -> Option<&'a Contact>, deviation: f64) -> Option<DVec3> {
    let c = |back: usize| at(back).map(|contact| contact.c);
    let (a, b, c, d, e, f) = (c(5)?, c(4)?, c(3)?, c(2)?, c(1)?, c(0)?);
    let beside = a - 2.0 * b + c + (d - 2.0 * e + f);
    let kink = b - c - d + e - beside;
    // A smooth path changes its speed about as much beside.
    if kink.length_squared() < beside.length_squared() {
        return None;
    }
    let seen = 1.0 - SEEN * OF_KINK * deviation * deviation / kink.length_squared().max(f64::MIN_POSITIVE);
    (seen > 0.0).then(|| kink * seen.sqrt())
}

impl<'a> Path<'a> {
    /// From contacts at the samples `k - 2` to `k + 1`, for the interval that ends at `k`. None of a palm that is touched at neither end.
    fn new(around: [Option<&'a Contact>; 4], k: usize, times: &[f64]) -> Option<Self> {
        let h = times[k] - times[k - 1];
        match around {
            [before, Some(a), Some(b), after] => {
                let change = b.c - a.c;
                // Half the second derivative, from both sides where there are two. A parabola's mean is off that of its ends by its bend.
                let slope = change / h;
                let left = before.map(|before| {
                    let h_before = times[k - 1] - times[k - 2];
                    (slope - (a.c - before.c) / h_before) / (h + h_before)
                });
                let right = after.map(|after| {
                    let h_after = times[k + 1] - times[k];
                    ((after.c - b.c) / h_after - slope) / (h + h_after)
                });
                let bend = left.or(right).zip(right.or(left)).map_or(DVec3::ZERO, |(a, b)| a + b);
                let mean = 0.5 * (a.c + b.c) - bend * (h * h / 12.0);
                let (force, unsure) = (b.f - a.f, DVec3::ZERO);
                Some(Self { contact: a, mean, change, force, noise: 1.0, unsure })
            }
            [_, None, Some(b), after] => {
                let step = after.map(|after| (b.c - after.c) * (h / (times[k + 1] - times[k])));
                Some(Self::continued(b, step, b.f))
            }
            [before, Some(a), None, _] => {
                let step = before.map(|before| (a.c - before.c) * (h / (times[k - 1] - times[k - 2])));
                Some(Self::continued(a, step, -a.f))
            }
            [_, None, None, _] => None,
        }
    }

    /// Touched for some time from or until one end, from where the contact goes on by `step` over the interval.
    fn continued(contact: &'a Contact, step: Option<DVec3>, force: DVec3) -> Self {
        let noise = if step.is_some() { CONTINUED } else { 1.0 };
        let step = step.unwrap_or_default();
        let (mean, unsure) = (contact.c + 0.5 * step, step / 12.0_f64.sqrt());
        Self { contact, mean, change: DVec3::ZERO, force, noise, unsure }
    }

    /// With what changes of its speed make unsure, in the interval before, its own and the one after.
    fn kinked(self, [before, own, after]: [Option<DVec3>; 3]) -> Self {
        let square = |of: Option<DVec3>| of.map_or(0.0, DVec3::length_squared);
        let variance = square(own) + BESIDE * (square(before) + square(after));
        let along = own.or(before).or(after).unwrap_or_default().normalize_or_zero();
        let beside = along * (KINKED * variance.sqrt());
        Self { unsure: if beside == DVec3::ZERO { self.unsure } else { beside }, ..self }
    }

    /// Adds the impulse `J` along it, of which each axis has the standard deviation `deviation`.
    ///
    /// The moment is that of the mean contact, with what a force that grows while the contact moves adds: exact for contacts and forces
    /// that are parabolas, an error of the fifth power of the time between samples for others.
    fn push(&self, J: DVec3, deviation: f64, contact: f64, interval: &mut Interval) {
        let h = interval.h;
        let moment = self.mean.cross(J) + self.change.cross(self.force) * (h / 12.0);
        interval.impulse = interval.impulse + Wrench { force: J, moment };
        interval.first += J * (0.5 * h) + self.force * (h * h / 12.0);
        let white = &mut interval.noise.white;
        for axis in DVec3::AXES {
            let column = six(axis, self.mean.cross(axis)) * deviation;
            white.ger(1.0, &column, &column, 1.0);
        }
        add_contact_noise(white, self.contact, J, contact * self.noise.sqrt());
        let column = six(DVec3::ZERO, self.unsure.cross(J));
        white.ger(1.0, &column, &column, 1.0);
    }
}

/// A push between two samples at neither of which the palm is touched: it was somewhere among the contacts, sometime.
fn unseen(J: DVec3, deviation: f64, spread: f64, interval: &mut Interval) {
    let mut white = Matrix6::zeros();
    for axis in DVec3::AXES {
        let force = six(axis, DVec3::ZERO) * deviation;
        let moment = six(DVec3::ZERO, axis.cross(J) * spread);
        white.ger(1.0, &force, &force, 1.0);
        white.ger(1.0, &moment, &moment, 1.0);
    }
    interval.noise += WrenchNoise { white, ..WrenchNoise::default() };
    interval.impulse = interval.impulse + Wrench { force: J, moment: DVec3::ZERO };
    interval.first += J * (0.5 * interval.h);
    interval.blow = true;
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DMat3;
    use object_dynamics::ContactMode;

    const NOISE: f64 = 1e-5;

    fn contact(x: f64) -> Contact {
        Contact {
            palm: 0,
            c: DVec3::new(x, 0.0, 0.0),
            n: DVec3::Z,
            u: DVec3::ZERO,
            W: DVec3::ZERO,
            u_deviation: 0.0,
            shape: DMat3::ZERO,
            f: DVec3::Z,
            f_deviation: 0.01,
            frictionless: true,
            planar: true,
            mode: ContactMode::Slide,
            samples: 1.0,
            J_before: DVec3::ZERO,
            J_after: DVec3::ZERO,
            repeated: false,
        }
    }

    /// A contact on its way `x` over the time in samples, and what its mean over the interval that ends at sample `k` is off by and said to be off by.
    fn off(x: impl Fn(f64) -> f64, k: usize) -> (f64, f64) {
        let times: Vec<f64> = (0..12).map(f64::from).collect();
        let way: Vec<Contact> = times.iter().map(|t| contact(x(*t))).collect();
        let bend = |k: usize| kink(|back| way.get((k + 2).checked_sub(back)?), NOISE);
        let path = Path::new([k - 2, k - 1, k, k + 1].map(|k| way.get(k)), k, &times).unwrap();
        let path = path.kinked([bend(k - 1), bend(k), bend(k + 1)]);
        const PARTS: u32 = 2000;
        let mean = (0..PARTS).map(|i| x(k as f64 - 1.0 + (f64::from(i) + 0.5) / f64::from(PARTS)));
        (path.mean.x - mean.sum::<f64>() / f64::from(PARTS), path.unsure.length())
    }

    /// Where the curvature of the object jumps a contact changes its speed within an interval; the parabola does not follow that, and it is said, there and beside.
    #[test]
    fn what_a_mean_is_off_by_where_a_contact_changes_its_speed_is_told() {
        for part in [0.05, 0.3, 0.5, 0.8, 0.95] {
            let bent = |t: f64| 1e-3 * t + 5e-3 * (t - 5.0 - part).max(0.0);
            for k in [5, 6, 7] {
                let (error, said) = off(bent, k);
                assert!(error.abs() < 2.5 * said, "{part} {k}: {error} {said}");
            }
            let (_, said) = off(bent, 6);
            assert!(said < 5e-3 / 8.0, "no more than it can be: {said}");
            assert_eq!(off(bent, 10).1, 0.0, "farther away than six samples reach nothing is doubted");
        }
    }

    #[test]
    fn a_smooth_way_and_one_that_bends_by_less_than_noise_are_not_doubted() {
        for k in 4..9 {
            assert_eq!(off(|t| 3e-3 * (0.7 * t).sin(), k).1, 0.0, "{k}");
            assert_eq!(off(|t| 1e-4 * (t - 5.5).max(0.0), k).1, 0.0, "{k}");
        }
    }
}
