//! What the estimator reads of a log: contacts at samples, and what the forces do between them.

use super::noise::ContactNoiseLevel;
use super::options::ContactOptions;
use crate::three_palms::running_integral;
use contact_kinematics::PalmSurface;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix6, Vector6};
use object_dynamics::{ContactLog, ContactMode, MOST_PALMS};
use std::ops::{Add, Mul};

/// Intervals from the one in which a contact closes that a blow is taken to last: soft ones are over a sample later.
const BLOW: usize = 2;

/// Share of the weight that presses a contact which opens by a blow: one that opens by itself is not pressed then.
const SUDDEN: f64 = 0.1;

/// A contact at one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    /// Number of the palm, from 0.
    pub(super) palm: usize,
    /// Contact point from the record's origin, m.
    pub(super) c: DVec3,
    pub(super) n: DVec3,
    /// Velocity of the palm's material at the contact, m/s, and the palm's angular velocity, rad/s.
    pub(super) u: DVec3,
    pub(super) W: DVec3,
    /// Shape operator of the palm in world axes, 1/m: how its normal turns along it.
    pub(super) shape: DMat3,
    pub(super) f: DVec3,
    /// Whether the force is along the normal without friction, and so is its noise.
    pub(super) frictionless: bool,
    pub(super) mode: ContactMode,
    /// Samples that it is the mean of.
    pub(super) samples: usize,
}

/// Forces of all palms and their moments about the origin, or an integral of them.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wrench {
    pub(super) force: DVec3,
    pub(super) moment: DVec3,
}

/// What forces and their noise do from one sample to the next.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interval {
    pub(super) h: f64,
    pub(super) impulse: Wrench,
    /// Integral of the force times the time since the interval's start, N s^2.
    pub(super) first: DVec3,
    /// Covariance of `impulse`; the moment about the origin.
    pub(super) noise: Matrix6<f64>,
    /// Whether a blow may have changed the velocities.
    pub(super) blow: bool,
}

/// Samples of a log.
#[derive(Debug)]
pub(super) struct Record {
    pub(super) times: Vec<f64>,
    /// Numbers of the log's samples at these times.
    pub(super) samples: Vec<usize>,
    /// What all positions are measured from, world: the mean of the contacts.
    pub(super) origin: DVec3,
    pub(super) contacts: Vec<Vec<Contact>>,
    pub(super) wrenches: Vec<Wrench>,
    pub(super) intervals: Vec<Interval>,
}

impl Interval {
    /// Variance of the impulse, of the moment as well at so long a lever, N^2 s^2.
    pub(super) fn velocity_noise(&self, lever: f64) -> f64 {
        let part = |i: usize| self.noise.fixed_view::<3, 3>(i, i).trace();
        part(0).max(part(3) / (lever * lever))
    }
}

impl Add for Wrench {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, moment: self.moment + other.moment }
    }
}

impl Mul<f64> for Wrench {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { force: self.force * factor, moment: self.moment * factor }
    }
}

impl Record {
    /// Of a log whose palms measure forces of three axes or have no friction, every contact sliding for now; none without a contact.
    pub(super) fn new(log: &ContactLog, options: &ContactOptions) -> Option<Self> {
        let times = log.times().to_vec();
        let points =
            || (0..times.len()).flat_map(|k| log.palms().iter().filter_map(move |palm| palm.touch(k)));
        let count = points().count();
        if count == 0 {
            return None;
        }
        let origin = points().map(|touch| touch.p_WC).sum::<DVec3>() / count as f64;
        let frictionless: Vec<bool> = log.palms().iter().map(|palm| options.frictionless(palm)).collect();
        let contacts: Vec<Vec<Contact>> =
            (0..times.len()).map(|k| contacts_at(log, k, origin, &frictionless)).collect();
        let wrench = |contacts: &Vec<Contact>| {
            let of = |c: &Contact| Wrench { force: c.f, moment: c.c.cross(c.f) };
            contacts.iter().map(of).fold(Wrench::default(), Add::add)
        };
        let wrenches: Vec<Wrench> = contacts.iter().map(wrench).collect();
        let intervals = intervals(log, &contacts, &wrenches, &options.noise);
        let samples = (0..times.len()).collect();
        Some(Self { times, samples, origin, contacts, wrenches, intervals })
    }

    /// Leaves open what the velocities change by, up to about `impulse` in N s and `moment` in N m s, where a contact closes, or opens while it
    /// is pressed by more than a share of `weight` in N: a blow is over before a sample sees it, at a palm that may not be touched at any.
    pub(super) fn free_blows(&mut self, impulse: f64, moment: f64, weight: f64) {
        let lost = |from: usize, to: usize| {
            let gone = |c: &&Contact| self.contacts[to].iter().all(|other| other.palm != c.palm);
            self.contacts[from].iter().filter(gone).map(|c| c.f.length()).reduce(f64::max)
        };
        let lasts = |k: usize| match (lost(k, k - 1), lost(k - 1, k)) {
            (Some(_), _) => BLOW,
            (None, Some(force)) if force > SUDDEN * weight => 1,
            _ => 0,
        };
        let blows: Vec<usize> = (1..self.times.len()).map(lasts).collect();
        for (k, lasts) in blows.into_iter().enumerate() {
            for interval in self.intervals[k..].iter_mut().take(lasts).filter(|interval| !interval.blow) {
                interval.blow = true;
                for i in 0..6 {
                    interval.noise[(i, i)] += if i < 3 { impulse } else { moment }.powi(2);
                }
            }
        }
    }

    /// Whether a blow ends or begins at a sample.
    pub(super) fn beside_blow(&self, k: usize) -> bool {
        [k.checked_sub(1), Some(k)]
            .into_iter()
            .flatten()
            .any(|i| self.intervals.get(i).is_some_and(|i| i.blow))
    }

    /// Puts its contacts into the modes of each palm at each sample. In the middle of a blow there is none.
    pub(super) fn set_modes(&mut self, modes: &[[ContactMode; MOST_PALMS]]) {
        let blows = |k: usize| {
            k > 0 && k < self.intervals.len() && self.intervals[k - 1].blow && self.intervals[k].blow
        };
        let amid: Vec<bool> = (0..self.times.len()).map(blows).collect();
        for ((contacts, modes), amid) in self.contacts.iter_mut().zip(modes).zip(amid) {
            let mode = |palm: usize| if amid { ContactMode::Off } else { modes[palm] };
            contacts.iter_mut().for_each(|contact| contact.mode = mode(contact.palm));
        }
    }
}

fn contacts_at(log: &ContactLog, k: usize, origin: DVec3, frictionless: &[bool]) -> Vec<Contact> {
    let one = |(palm, logged): (usize, &object_dynamics::LoggedPalm)| {
        let touch = logged.touch(k)?;
        let motion = logged.motion(k);
        let n = touch.n.get();
        let f = logged.force(k)?.vector;
        let frictionless = frictionless[palm];
        Some(Contact {
            palm,
            c: touch.p_WC - origin,
            n,
            u: motion.material_velocity(touch.p_WC),
            W: motion.w_WP,
            shape: shape_operator(logged.surface(), n, motion.pose.R_WP * DVec3::X),
            f: if frictionless { f.project_onto_normalized(n) } else { f },
            frictionless,
            mode: ContactMode::Slide,
            samples: 1,
        })
    };
    log.palms().iter().enumerate().filter_map(one).collect()
}

/// How the normal `n` of a palm, whose axis is `axis`, turns along its surface.
fn shape_operator(surface: PalmSurface, n: DVec3, axis: DVec3) -> DMat3 {
    let outer = |a: DVec3| DMat3::from_cols(a * a.x, a * a.y, a * a.z);
    let [along, across] = surface.curvatures(0.0);
    (DMat3::IDENTITY - outer(n)) * along + outer(axis.cross(n)) * (across - along)
}

fn intervals(
    log: &ContactLog,
    contacts: &[Vec<Contact>],
    wrenches: &[Wrench],
    noise: &ContactNoiseLevel,
) -> Vec<Interval> {
    let times = log.times();
    let since: Vec<f64> = times.iter().map(|t| t - times[0]).collect();
    let sums = running_integral(&since, wrenches, Wrench::default());
    let timed: Vec<Wrench> = wrenches.iter().zip(&since).map(|(w, t)| *w * *t).collect();
    let firsts = running_integral(&since, &timed, Wrench::default());
    let fine: Vec<Interval> = (1..times.len())
        .map(|k| {
            let h = since[k] - since[k - 1];
            let impulse = sums[k] + sums[k - 1] * -1.0;
            let first = firsts[k].force - firsts[k - 1].force - impulse.force * since[k - 1];
            // The noise of a sample is felt on both its sides; put into the interval after it alone it is white.
            let mut noise_here = Matrix6::zeros();
            for contact in &contacts[k - 1] {
                add_noise(&mut noise_here, contact, noise, h);
            }
            Interval { h, impulse, first, noise: noise_here, blow: false }
        })
        .collect();
    let rough: Vec<Interval> =
        (1..times.len()).map(|k| trapezoid(&fine[k - 1], &wrenches[k - 1..=k])).collect();
    let differ = |(fine, rough): (&Interval, &Interval)| fine.impulse + rough.impulse * -1.0;
    let square = |pair| differ(pair).force.length_squared();
    let differences: f64 = fine.iter().zip(&rough).map(square).sum();
    let expected: f64 = fine.iter().map(|i| RULES_DIFFER * i.noise.fixed_view::<3, 3>(0, 0).trace()).sum();
    let all = if differences < 2.0 * expected { rough } else { fine };
    all.into_iter().enumerate().map(|(k, interval)| doubted(k, interval, wrenches)).collect()
}

/// With what the interval after sample `k` may be off by, if a force jumps within it: nobody knows when.
///
/// A jump is what a step between two samples is more than the mean of the steps beside it, and more than noise makes of it.
fn doubted(k: usize, interval: Interval, wrenches: &[Wrench]) -> Interval {
    let (Some(before), Some(after)) = (k.checked_sub(1).map(|k| wrenches[k]), wrenches.get(k + 2)) else {
        return interval;
    };
    let h = interval.h;
    let jump = (wrenches[k + 1] + wrenches[k] * -1.0) * 1.5 + (before + *after * -1.0) * 0.5;
    let square = jump.force.length_squared();
    // Noise of one sample makes five times its variance of a jump.
    let noise = 5.0 * interval.noise.fixed_view::<3, 3>(0, 0).trace() / (h * h);
    let seen = (1.0 - SEEN * noise / square.max(f64::MIN_POSITIVE)).max(0.0);
    // Of a time that is uniform over the interval.
    let column = six(jump.force, jump.moment) * (h * (seen / 12.0).sqrt());
    Interval { noise: interval.noise + column * column.transpose(), ..interval }
}

/// Times the variance that noise makes of a jump from which on it is one.
const SEEN: f64 = 9.0;

/// Variance of the difference between the rule of order 6 and the trapezoidal one, of samples of unit variance and spacing.
///
/// Where noise makes all of it, the trapezoidal rule is as good, and what its noise does is known exactly.
const RULES_DIFFER: f64 = 2.0 * (11.0 * 11.0 + 93.0 * 93.0 + 82.0 * 82.0) / (1440.0 * 1440.0);

fn trapezoid(interval: &Interval, wrenches: &[Wrench]) -> Interval {
    let h = interval.h;
    let impulse = (wrenches[0] + wrenches[1]) * (0.5 * h);
    let first = (wrenches[0].force + 2.0 * wrenches[1].force) * (h * h / 6.0);
    Interval { impulse, first, ..*interval }
}

/// What the noise of one contact does to the impulse and moment of an interval: samples are independent.
fn add_noise(covariance: &mut Matrix6<f64>, contact: &Contact, noise: &ContactNoiseLevel, h: f64) {
    let force = noise.force(contact.f) * h;
    let (a, b) = contact.n.any_orthonormal_pair();
    for axis in [contact.n, a, b].into_iter().take(if contact.frictionless { 1 } else { 3 }) {
        let column = six(axis, contact.c.cross(axis)) * force;
        covariance.ger(1.0, &column, &column, 1.0);
    }
    for tangent in [a, b] {
        let column = six(DVec3::ZERO, tangent.cross(contact.f)) * (noise.contact * h);
        covariance.ger(1.0, &column, &column, 1.0);
    }
}

pub(super) fn six(a: DVec3, b: DVec3) -> Vector6<f64> {
    Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}
