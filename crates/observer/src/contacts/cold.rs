//! A start from nothing: twists that the contacts alone suggest.

use super::body::Body;
use super::problem::{Problem, Units, Unknowns};
use super::record::{Contact, Record, six};
use super::state::Motion;
use crate::rigid::exponential;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Matrix6, Vector3, Vector6};
use object_dynamics::ContactMode;

/// Weight of no motion at all against one contact condition, in natural units.
const RIDGE: f64 = 1e-2;

/// Units of a body of the size `length`, m, with the mean force for its weight.
pub(super) fn units(record: &Record, gravity: f64, length: f64) -> Units {
    let forces: DVec3 = record.intervals.iter().map(|i| i.impulse.force).sum();
    let time: f64 = record.intervals.iter().map(|i| i.h).sum();
    let mass = (forces.length() / (time * gravity)).max(f64::MIN_POSITIVE);
    Units { length, speed: (gravity * length).sqrt(), mass }
}

/// A ball of the natural size and mass.
pub(super) fn ball(units: &Units) -> Body {
    let Units { length, mass, .. } = *units;
    Body::free(mass.ln(), DMat3::from_diagonal(DVec3::splat(0.4 * mass * length * length)))
}

/// Radius of the ball that fits contacts and normals of the same time best, m; none where no two normals differ.
pub(super) fn size(record: &Record) -> Option<f64> {
    let (mut along, mut square) = (0.0, 0.0);
    for contacts in &record.contacts {
        let count = contacts.len() as f64;
        let c = contacts.iter().map(|c| c.c).sum::<DVec3>() / count;
        let n = contacts.iter().map(|c| c.n).sum::<DVec3>() / count;
        for contact in contacts {
            along -= (contact.n - n).dot(contact.c - c);
            square += (contact.n - n).length_squared();
        }
    }
    (square > 0.0 && along > 0.0).then(|| along / square)
}

pub(super) fn start(problem: &Problem, body: Body, orientation: DQuat) -> Unknowns {
    let mut motions: Vec<Motion> = Vec::with_capacity(problem.nodes.len());
    let record = problem.record;
    let mut centre = DVec3::ZERO;
    let (mut q, mut last) = (orientation, None);
    for (j, &k) in problem.nodes.iter().enumerate() {
        let before = problem.nodes[j.saturating_sub(1)];
        let after = problem.nodes.get(j + 1).copied().unwrap_or(k);
        let samples = ((before + k) / 2)..=((k + after) / 2);
        let contacts: Vec<_> = samples.flat_map(|k| &record.contacts[k]).collect();
        if !contacts.is_empty() {
            let within = |c: &&Contact| c.c + c.n * problem.units.length;
            centre = contacts.iter().map(within).sum::<DVec3>() / contacts.len() as f64;
        }
        let (v, w) = twist(&contacts, centre, problem.units.length);
        q = turned(q, &mut last, record.times[k], w);
        let L = body.inertia_along(DMat3::from_quat(q)) * w;
        motions.push(Motion { p: centre, v, L, q });
    }
    Unknowns { motions, body }
}

/// An orientation at the time `t`, from where it was at the last time with the angular velocity there; these become `t` and `w`.
fn turned(q: DQuat, last: &mut Option<(f64, DVec3)>, t: f64, w: DVec3) -> DQuat {
    match last.replace((t, w)) {
        Some((before, w_before)) => (exponential(0.5 * (w + w_before) * (t - before)) * q).normalize(),
        None => q,
    }
}

/// A body that turns at a constant angular velocity, with the velocities that contacts leave it.
pub(super) fn turning(problem: &Problem, body: Body, w: DVec3) -> Unknowns {
    let of_contacts = start(problem, body, DQuat::IDENTITY);
    let times = &problem.record.times;
    let one = |(motion, &k): (Motion, &usize)| {
        let q = exponential(w * (times[k] - times[0]));
        spinning(problem, k, &body, Motion { q, ..motion }, w)
    };
    let motions = of_contacts.motions.into_iter().zip(&problem.nodes).map(one).collect();
    Unknowns { motions, body }
}

/// A motion whose angular velocity is another one by `shift` all along, of the body `body`: it is turned accordingly, and has the velocities that
/// contacts leave it.
pub(super) fn shifted(problem: &Problem, from: &Unknowns, body: Body, shift: DVec3) -> Unknowns {
    let times = &problem.record.times;
    let one = |(motion, &k): (&Motion, &usize)| {
        let w = from.body.spin(motion.q, motion.L) + shift;
        let q = (exponential(shift * (times[k] - times[0])) * motion.q).normalize();
        spinning(problem, k, &body, Motion { q, ..*motion }, w)
    };
    let motions = from.motions.iter().zip(&problem.nodes).map(one).collect();
    Unknowns { motions, body }
}

/// A motion whose centre of mass is another one by `shift` all along, with the same velocity, and the angular velocity that contacts leave it: in the plane.
pub(super) fn displaced(problem: &Problem, from: &Unknowns, shift: DVec3) -> Unknowns {
    let times = &problem.record.times;
    let mut motions: Vec<Motion> = Vec::with_capacity(from.motions.len());
    let (mut q, mut last) = (from.motions.first().map_or(DQuat::IDENTITY, |motion| motion.q), None);
    for (motion, &k) in from.motions.iter().zip(&problem.nodes) {
        let p = motion.p + shift;
        let (mut right, mut normal) = (0.0, RIDGE * problem.units.length * problem.units.length);
        for contact in problem.record.contacts[k].iter().filter(|contact| contact.mode != ContactMode::Off) {
            let lever = (contact.c - p).cross(contact.n).y;
            normal += lever * lever;
            right += lever * contact.n.dot(contact.u - motion.v);
        }
        let w = DVec3::Y * (right / normal);
        q = turned(q, &mut last, times[k], w);
        let L = from.body.inertia_along(DMat3::from_quat(q)) * w;
        motions.push(Motion { p, v: motion.v, L, q });
    }
    Unknowns { motions, body: from.body }
}

/// A motion at sample `k` with another angular velocity, and the velocity that contacts leave it.
fn spinning(problem: &Problem, k: usize, body: &Body, motion: Motion, w: DVec3) -> Motion {
    let contacts: Vec<_> = problem.record.contacts[k].iter().collect();
    let L = body.inertia_along(DMat3::from_quat(motion.q)) * w;
    Motion { v: along(&contacts, motion.p, w), L, ..motion }
}

/// Velocity of `centre` that fits the normal conditions of some contacts at an angular velocity, as small as it may be.
fn along(contacts: &[&Contact], centre: DVec3, w: DVec3) -> DVec3 {
    let mut normal = Matrix3::identity() * RIDGE;
    let mut right = Vector3::zeros();
    for contact in contacts.iter().filter(|contact| contact.mode != ContactMode::Off) {
        let n = Vector3::from(contact.n);
        normal.ger(1.0, &n, &n, 1.0);
        right += n * contact.n.dot(contact.u - w.cross(contact.c - centre));
    }
    normal.cholesky().map_or(DVec3::ZERO, |factor| DVec3::from_slice(factor.solve(&right).as_slice()))
}

/// Velocity of `centre` and angular velocity that fit the conditions of some contacts, as small as they may be.
///
/// Where friction is felt the slip is along it: a condition across it says what the normal one leaves open.
fn twist(contacts: &[&Contact], centre: DVec3, length: f64) -> (DVec3, DVec3) {
    let mut normal = Matrix6::identity() * (RIDGE * contacts.len().max(1) as f64);
    let mut right = Vector6::zeros();
    for contact in contacts {
        let arm = (contact.c - centre) / length;
        let mut add = |e: DVec3, weight: f64| {
            let row = six(e, arm.cross(e));
            normal.ger(weight, &row, &row, 1.0);
            right += row * (weight * e.dot(contact.u));
        };
        let [t1, t2] = contact.tangents();
        match contact.mode {
            ContactMode::Off => {}
            ContactMode::Slide => {
                add(contact.n, 1.0);
                if contact.frictionless {
                    continue;
                }
                let friction = contact.f.reject_from_normalized(contact.n);
                let deviation = contact.f_deviation;
                let known = friction.length_squared();
                if known > deviation * deviation {
                    let across = contact.n.cross(friction).normalize_or_zero();
                    add(across, known / (known + deviation * deviation));
                }
            }
            ContactMode::Stick => [contact.n, t1, t2].into_iter().for_each(|e| add(e, 1.0)),
        }
    }
    let Some(factor) = normal.cholesky() else { return (DVec3::ZERO, DVec3::ZERO) };
    let x = factor.solve(&right);
    (DVec3::new(x[0], x[1], x[2]), DVec3::new(x[3], x[4], x[5]) / length)
}
