//! What the estimator reads of a log: contacts at samples, and what the forces do between them.

use super::between::intervals;
use super::both::of_each;
use super::feet;
use super::impulses;
use super::misread_forces::{MisreadForce, mend_forces, misread_forces};
use super::noise::{ContactNoiseLevel, WrenchNoise, traces};
use super::options::ContactOptions;
use super::outliers::{Misread, mend, misread};
use super::palm_rates::MissedTwist;
use super::problem::Units;
use contact_kinematics::PalmSurface;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix6, Vector6};
use object_dynamics::{
    ContactLog, ContactMode, LoggedPalm, MOST_PALMS, MeasuredMotion, SensedAxes, SensedForce, Touch,
};
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
    /// Standard deviation of that velocity at a sample, m/s, where it follows from poses.
    pub(super) u_deviation: f64,
    /// Shape operator of the palm in world axes, 1/m: how its normal turns along it.
    pub(super) shape: DMat3,
    pub(super) f: DVec3,
    /// Standard deviation of each axis of the force, N.
    pub(super) f_deviation: f64,
    /// Whether the force is along the normal without friction, and so is its noise.
    pub(super) frictionless: bool,
    /// Whether it moves in the plane of x and z alone.
    pub(super) planar: bool,
    pub(super) mode: ContactMode,
    /// Of how many samples it is as good as the mean.
    pub(super) samples: f64,
    /// Impulses through it before and after its sample, N s, whose moments are off by what it is read beside where it is.
    pub(super) J_before: DVec3,
    pub(super) J_after: DVec3,
    /// Whether the palm gave what it gave the sample before, to the last digit.
    pub(super) repeated: bool,
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
    pub(super) noise: WrenchNoise,
    /// Whether a blow may have changed the velocities.
    pub(super) blow: bool,
    /// Steps in which a motion is carried over it: more than one over a gap.
    pub(super) parts: usize,
}

/// Samples of a log.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub(super) times: Vec<f64>,
    /// Numbers of the log's samples at these times.
    pub(super) samples: Vec<usize>,
    /// What all positions are measured from, world: the mean of the contacts.
    pub(super) origin: DVec3,
    pub(super) contacts: Vec<Vec<Contact>>,
    pub(super) wrenches: Vec<Wrench>,
    pub(super) intervals: Vec<Interval>,
    /// Whether the impulses of all palms are read.
    pub(super) all_impulses: bool,
    /// Whether none is.
    pub(super) by_samples: bool,
    /// Contacts that were misread, and stand where those around them say.
    pub(super) misread: Vec<Misread>,
    /// The same of forces.
    pub(super) misread_forces: Vec<MisreadForce>,
    /// Deviation of the mean of what they scatter by along y, m: of the plane's place, where all is in one.
    pub(super) across: f64,
    /// Deviation of a contact at a sample in each direction along its palm, m.
    pub(super) deviation: f64,
}

impl Contact {
    /// From the world's origin, sliding for now; of the force (N) the standard deviation of each axis as well.
    pub(super) fn new(
        palm: usize,
        surface: PalmSurface,
        touch: &Touch,
        motion: &MeasuredMotion,
        (force, f_deviation): (DVec3, f64),
        frictionless: bool,
        planar: bool,
    ) -> Self {
        let n = touch.n.get();
        Self {
            palm,
            c: touch.p_WC,
            n,
            u: motion.material_velocity(touch.p_WC),
            W: motion.w_WP,
            u_deviation: 0.0,
            shape: shape_operator(surface, n, motion.pose.R_WP * DVec3::X),
            f: if frictionless { force.project_onto_normalized(n) } else { force },
            f_deviation,
            frictionless,
            planar,
            mode: ContactMode::Slide,
            samples: 1.0,
            J_before: DVec3::ZERO,
            J_after: DVec3::ZERO,
            repeated: false,
        }
    }

    /// To another place on its plane, as good as the mean of so many samples.
    pub(super) fn move_to(&mut self, c: DVec3, samples: f64) {
        self.u += self.W.cross(c - self.c);
        (self.c, self.samples) = (c, samples);
    }

    /// Unit vectors along the palm, normal to each other; in the plane the first one is in it.
    pub(super) fn tangents(&self) -> [DVec3; 2] {
        if self.planar { [self.n.cross(DVec3::Y), DVec3::Y] } else { self.n.any_orthonormal_pair().into() }
    }

    /// Angle in rad by which noise of its place of the given deviation (m) turns the normal of a curved palm, in the axis that turns more.
    pub(super) fn turning(&self, deviation: f64) -> f64 {
        deviation * self.tangents().into_iter().map(|t| (self.shape * t).length()).fold(0.0, f64::max)
    }

    /// Directions along the palm that it may move in.
    pub(super) fn freedoms(&self) -> usize {
        if self.planar { 1 } else { 2 }
    }
}

impl Interval {
    /// By the wrenches at its ends.
    pub(super) fn trapezoid(h: f64, wrenches: [&Wrench; 2], noise: WrenchNoise) -> Self {
        let impulse = (*wrenches[0] + *wrenches[1]) * (0.5 * h);
        let first = (wrenches[0].force + 2.0 * wrenches[1].force) * (h * h / 6.0);
        Self { h, impulse, first, noise, blow: false, parts: 1 }
    }

    /// In its parts, each with the wrenches at its ends: a parabola through those at the ends with the impulse that there was.
    pub(super) fn in_parts(&self, [start, end]: [&Wrench; 2]) -> impl Iterator<Item = (Self, [Wrench; 2])> {
        let (h, count) = (self.h, self.parts as f64);
        let (start, change) = (*start, *end + *start * -1.0);
        // In time over the duration: `start + s change + s (1 - s) bulge`.
        let bulge = (self.impulse * (1.0 / h) + (start + *end) * -0.5) * 6.0;
        let (noise, blow) = (self.noise, self.blow);
        let at = move |s: f64| start + change * s + bulge * (s * (1.0 - s));
        // Integrals from 0 to `s`, of the wrench and of it times time, over the duration and its square.
        let once = move |s: f64| start * s + change * (s * s / 2.0) + bulge * (s * s / 2.0 - s.powi(3) / 3.0);
        let timed = move |s: f64| {
            start * (s * s / 2.0) + change * (s.powi(3) / 3.0) + bulge * (s.powi(3) / 3.0 - s.powi(4) / 4.0)
        };
        (0..self.parts).map(move |i| {
            let (a, b) = (i as f64 / count, (i as f64 + 1.0) / count);
            let impulse = (once(b) + once(a) * -1.0) * h;
            let first = (timed(b) + timed(a) * -1.0) * (h * h) + impulse * (-a * h);
            let part = Self { h: h / count, impulse, first: first.force, noise, blow, parts: 1 };
            (part, [at(a), at(b)])
        })
    }

    /// Variance of the impulse, of the moment as well at so long a lever, N^2 s^2.
    pub(super) fn velocity_noise(&self, lever: f64) -> f64 {
        let [force, moment] = traces(&self.noise.white);
        force.max(moment / (lever * lever))
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
    /// Of a log whose palms measure forces or impulses of three axes or have no friction, every contact sliding for now; none without a
    /// contact.
    ///
    /// Where an impulse is read it counts for what happens between samples, and the force at samples for everything else: for the
    /// direction of friction, the ratio by which modes are told, and how a force changes over an interval. The noises of both
    /// are taken to be independent; where no force is measured, it is that of the impulses around.
    pub(super) fn new(log: &ContactLog, options: &ContactOptions) -> Option<Self> {
        let noise = &options.noise;
        let times = log.times().to_vec();
        let points =
            || (0..times.len()).flat_map(|k| log.palms().iter().filter_map(move |palm| palm.touch(k)));
        let (count, sum) =
            points().fold((0_u32, DVec3::ZERO), |(count, sum), touch| (count + 1, sum + touch.p_WC));
        if count == 0 {
            return None;
        }
        let origin = sum / f64::from(count);
        let squares = points().map(|touch| touch.p_WC - origin).map(|off| off * off).sum::<DVec3>();
        let missed = MissedTwist::of(log);
        let samples: Vec<usize> = (0..times.len()).collect();
        let mut contacts =
            of_each(times.len(), &samples, |k| contacts_at(log, k, (origin, &missed), options));
        let misread = misread(&contacts, &times, noise.contact, options.gravity);
        mend(&mut contacts, &misread);
        let sampled: Vec<bool> =
            log.palms().iter().map(|palm| impulses::read(palm, noise).is_none()).collect();
        let misread_forces = misread_forces(&contacts, &times, &sampled, noise.contact, options.gravity);
        mend_forces(&mut contacts, &misread_forces);
        let felt = |k: usize| contacts[k].iter().filter(|contact| sampled[contact.palm]);
        let mut intervals = intervals(&times, felt, noise);
        impulses::add(
            log,
            &contacts,
            noise,
            (squares.element_sum() / f64::from(count)).sqrt(),
            &mut intervals,
        );
        let wrenches = contacts.iter().map(wrench).collect();
        if options.planar {
            feet::share(log, &intervals, &sampled, &mut contacts);
        }
        let all_impulses = sampled.iter().all(|sampled| !sampled);
        let by_samples = sampled.iter().all(|sampled| *sampled);
        Some(Self {
            times,
            samples,
            origin,
            contacts,
            wrenches,
            intervals,
            all_impulses,
            by_samples,
            misread,
            misread_forces,
            across: squares.y.sqrt() / f64::from(count),
            deviation: noise.contact,
        })
    }

    /// The intervals from every other sample to the next of these, by what was read at them alone. None where impulses are read or there are
    /// less than three samples.
    pub(super) fn every_other(&self, noise: &ContactNoiseLevel) -> Option<Vec<Interval>> {
        if !self.by_samples || self.times.len() < 3 {
            return None;
        }
        let times: Vec<f64> = self.times.iter().copied().step_by(2).collect();
        let felt = |k: usize| self.contacts[2 * k].iter();
        Some(intervals(&times, felt, noise))
    }

    /// Marks the intervals over which there may be a blow: a contact closes, or opens while it is pressed by more than a share of the weight under
    /// `gravity`, m/s^2.
    ///
    /// A blow is over before a sample sees it, at a palm that may not be touched at any. Where the impulses of all palms are read, it
    /// is known but for its time; else what the velocities change by is left open, up to about the natural sizes.
    pub(super) fn mark_blows(&mut self, units: &Units, gravity: f64) {
        let impulse = units.speed * units.mass;
        let (moment, weight) = (impulse * units.length, gravity * units.mass);
        let lost = |from: usize, to: usize| {
            let gone = |c: &&Contact| self.contacts[to].iter().all(|other| other.palm != c.palm);
            self.contacts[from].iter().filter(gone).map(|c| c.f.length()).reduce(f64::max)
        };
        let lasts = |k: usize| match (lost(k, k - 1), lost(k - 1, k)) {
            (Some(_), _) => BLOW,
            (None, Some(force)) if force > SUDDEN * weight => 1,
            _ => usize::from(self.intervals[k - 1].blow),
        };
        let mut blows = vec![false; self.intervals.len()];
        for k in 1..self.times.len() {
            blows[k - 1..].iter_mut().take(lasts(k)).for_each(|blow| *blow = true);
        }
        for (k, interval) in self.intervals.iter_mut().enumerate().filter(|(k, _)| blows[*k]) {
            interval.blow = true;
            if self.all_impulses {
                interval.noise.late += late(interval, [&self.wrenches[k], &self.wrenches[k + 1]]);
                continue;
            }
            for i in 0..6 {
                interval.noise.white[(i, i)] += if i < 3 { impulse } else { moment }.powi(2);
            }
        }
    }

    /// Whether there is any blow.
    pub(super) fn has_blows(&self) -> bool {
        self.intervals.iter().any(|interval| interval.blow)
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

/// What a blow over an interval does to the second integral, at a time of which nothing is known: all that the forces at its ends
/// do not make.
fn late(interval: &Interval, ends: [&Wrench; 2]) -> Matrix6<f64> {
    let h = interval.h;
    let blow = interval.impulse + (*ends[0] + *ends[1]) * (-0.5 * h);
    let column = six(blow.force, blow.moment) * (h / 12.0_f64.sqrt());
    column * column.transpose()
}

pub(super) fn wrench<'a>(contacts: impl IntoIterator<Item = &'a Contact>) -> Wrench {
    let of = |c: &Contact| Wrench { force: c.f, moment: c.c.cross(c.f) };
    contacts.into_iter().map(of).fold(Wrench::default(), Add::add)
}

fn contacts_at(
    log: &ContactLog,
    k: usize,
    (origin, missed): (DVec3, &[MissedTwist]),
    options: &ContactOptions,
) -> Vec<Contact> {
    let one = |(palm, logged): (usize, &LoggedPalm)| {
        let frictionless = options.frictionless(logged.friction());
        let touch = logged.touch(k)?;
        let force = force_at(log, logged, k, &options.noise, frictionless)?;
        let motion = logged.motion(k);
        let felt = Contact::new(palm, logged.surface(), &touch, &motion, force, frictionless, options.planar);
        // All in one plane, about which they scatter by noise alone.
        let c = felt.c - origin;
        let u_deviation = missed[palm].at(k, felt.c.distance(motion.pose.p_WP));
        // A contact that was read is put on the palm where that is now: what repeats itself is the force.
        let repeated = k.checked_sub(1).is_some_and(|before| {
            let along = |k: usize| Some(logged.force(k)?.vector.dot(logged.touch(k)?.n.get()));
            let vector = |k: usize| logged.force(k).map(|force| force.vector);
            // A part along a normal has been a vector in between.
            let same = |(last, own): (f64, f64)| (last - own).abs() <= 4.0 * f64::EPSILON * own.abs();
            vector(before) == vector(k) || along(before).zip(along(k)).is_some_and(same)
        });
        Some(Contact { u_deviation, c: if options.planar { c.with_y(0.0) } else { c }, repeated, ..felt })
    };
    // No larger than what is in it: there are as many of them as samples.
    let mut all = Vec::with_capacity(log.palms().len());
    all.extend(log.palms().iter().enumerate().filter_map(one));
    all
}

/// Force of a palm at a sample and the standard deviation of each axis: measured in three axes, else by its impulses.
fn force_at(
    log: &ContactLog,
    palm: &LoggedPalm,
    k: usize,
    noise: &ContactNoiseLevel,
    frictionless: bool,
) -> Option<(DVec3, f64)> {
    match palm.force(k) {
        Some(SensedForce { vector, axes }) if frictionless || axes == SensedAxes::Three => {
            Some((vector, noise.force(vector)))
        }
        _ => impulses::read(palm, noise).map(|noise| impulses::force(log, palm, k, &noise)),
    }
}

/// How the normal `n` of a palm, whose axis is `axis`, turns along its surface.
fn shape_operator(surface: PalmSurface, n: DVec3, axis: DVec3) -> DMat3 {
    let outer = |a: DVec3| DMat3::from_cols(a * a.x, a * a.y, a * a.z);
    let [along, across] = surface.curvatures(0.0);
    (DMat3::IDENTITY - outer(n)) * along + outer(axis.cross(n)) * (across - along)
}

/// What the noise of one contact does to the impulse and moment of an interval: samples are independent.
pub(super) fn add_noise(covariance: &mut Matrix6<f64>, contact: &Contact, deviation: f64, h: f64) {
    let [a, b] = contact.tangents();
    let axes = if contact.frictionless { 1 } else { 1 + contact.freedoms() };
    for axis in [contact.n, a, b].into_iter().take(axes) {
        let column = six(axis, contact.c.cross(axis)) * (contact.f_deviation * h);
        covariance.ger(1.0, &column, &column, 1.0);
    }
    add_contact_noise(covariance, contact, contact.f * h, deviation);
}

/// What a contact does to the moment of an impulse that is off in each direction along the palm, at one sample by `deviation`.
pub(super) fn add_contact_noise(
    covariance: &mut Matrix6<f64>,
    contact: &Contact,
    impulse: DVec3,
    deviation: f64,
) {
    for tangent in contact.tangents().into_iter().take(contact.freedoms()) {
        let column = six(DVec3::ZERO, tangent.cross(impulse)) * (deviation / contact.samples.sqrt());
        covariance.ger(1.0, &column, &column, 1.0);
    }
}

pub(super) fn six(a: DVec3, b: DVec3) -> Vector6<f64> {
    Vector6::new(a.x, a.y, a.z, b.x, b.y, b.z)
}
