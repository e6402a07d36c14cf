//! Slips of contacts by the estimated motion, with their covariances.
//!
//! A contact that was taken to stick has no slip in a motion that rests on that: its slip is asked of the motion that is found where it, and it
//! alone, is taken to slide. What it then is says something of its mode that was not put in.

use super::body::{Body, CONSTANTS};
use super::problem::{Problem, Unknowns};
use super::record::{Contact, Record};
use super::samples::{Deviations, at_all, covariance};
use super::search::{ENOUGH, fine_nodes};
use super::solve::{Covariances, Solved, solve};
use super::state::{MOTION, Motion};
use crate::contact_modes::ContactSlip;
use crate::rigid::cross_matrix;
use glam::DVec3;
use nalgebra::{Matrix2, Matrix3, Matrix6, SMatrix, Vector2};
use object_dynamics::{ContactMode, MOST_PALMS};

/// Linearisations at most of a motion without the sticking of one palm: it begins where all is known but that.
const MOST: usize = 8;

/// An estimate, and the record with its modes that it is of.
pub(super) struct Known<'a> {
    pub(super) log: &'a Record,
    pub(super) modes: &'a [[ContactMode; MOST_PALMS]],
    pub(super) problem: &'a Problem<'a>,
    pub(super) solved: &'a Solved<CONSTANTS>,
    pub(super) covariances: &'a Covariances<CONSTANTS>,
    pub(super) motions: &'a [(Motion, Deviations)],
    /// Longest window over which contacts are averaged, s.
    pub(super) longest: f64,
}

impl Known<'_> {
    /// The slip of one palm's contact at each sample along its tangents; none where nothing is touched, or nothing is known of it.
    pub(super) fn slips(&self, palm: usize) -> Vec<Option<ContactSlip>> {
        let Self { log, modes, problem, solved, covariances, motions, longest } = *self;
        let mut free = modes.to_vec();
        let stuck = free.iter_mut().map(|modes| &mut modes[palm]).filter(|m| **m == ContactMode::Stick);
        if stuck.map(|mode| *mode = ContactMode::Slide).count() == 0 {
            let motions: Vec<Motion> = motions.iter().map(|(motion, _)| *motion).collect();
            return Seen { log, problem, found: &solved.unknowns, covariances, motions: &motions }
                .slips(palm, solved.misfit());
        }
        let mut record = log.clone();
        record.set_modes(&free);
        let averaged = record.averaged(longest);
        let mut own = problem.on(&averaged);
        own.nodes = fine_nodes(&own);
        let at = own.node_samples().iter().map(|&k| motions[k].0).collect();
        let start = Unknowns { motions: at, body: solved.unknowns.body };
        let solved = solve::<CONSTANTS>(&own, start, MOST, ENOUGH[1]);
        let found = solved.and_then(|solved| {
            let covariances = solved.equations.covariances(&own.natural_information())?;
            Some((solved, covariances))
        });
        let Some((solved, covariances)) = found else { return vec![None; log.times.len()] };
        let motions: Vec<Motion> =
            at_all(log, &own, &solved.unknowns, &covariances).into_iter().map(|(motion, _)| motion).collect();
        let seen = Seen {
            log,
            problem: &own,
            found: &solved.unknowns,
            covariances: &covariances,
            motions: &motions,
        };
        seen.slips(palm, solved.misfit())
    }
}

/// A motion at all samples of a record.
struct Seen<'a> {
    log: &'a Record,
    problem: &'a Problem<'a>,
    found: &'a Unknowns,
    covariances: &'a Covariances<CONSTANTS>,
    motions: &'a [Motion],
}

impl Seen<'_> {
    fn slips(&self, palm: usize, misfit: f64) -> Vec<Option<ContactSlip>> {
        let Self { log, problem, found, covariances, motions } = *self;
        let nodes = problem.node_samples();
        let body = &found.body;
        let known: Vec<_> =
            nodes.iter().enumerate().map(|(j, &k)| covariance(&motions[k], body, j, covariances)).collect();
        let mut slips = vec![None; log.times.len()];
        for j in 0..nodes.len() {
            let end = nodes.get(j + 1).copied().unwrap_or(nodes[j] + 1);
            let mut noise = super::noise::WrenchNoise::default();
            log.intervals[nodes[j]..end.min(log.intervals.len())]
                .iter()
                .for_each(|interval| noise += interval.noise);
            let white = problem.about(&noise, motions[nodes[j]].p).white;
            let last = &known[(j + 1).min(known.len() - 1)];
            for k in nodes[j]..end {
                let Some(contact) = log.contacts[k].iter().find(|c| c.palm == palm) else { continue };
                let s = if end > nodes[j] + 1 || j + 1 < nodes.len() {
                    (log.times[k] - log.times[nodes[j]])
                        / (log.times[end.min(log.times.len() - 1)] - log.times[nodes[j]])
                            .max(f64::MIN_POSITIVE)
                } else {
                    0.0
                };
                let between = known[j] * (1.0 - s) + last * s;
                let bridge = white * 0.25;
                slips[k] = slip(contact, &motions[k], body, problem, (&between, &bridge, misfit.max(1.0)));
            }
        }
        slips
    }
}

fn slip(
    contact: &Contact,
    motion: &Motion,
    body: &Body,
    problem: &Problem,
    (covariance, bridge, wider): (&SMatrix<f64, MOTION, MOTION>, &Matrix6<f64>, f64),
) -> Option<ContactSlip> {
    let turn = body.turn(motion.q, motion.L);
    let arm = contact.c - motion.p;
    let velocity = motion.v + turn.w.cross(arm) - contact.u;
    let tangents = contact.tangents();
    let by_spin = -Matrix3::from(cross_matrix(arm));
    let mut by_motion = SMatrix::<f64, 3, MOTION>::zeros();
    by_motion.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Matrix3::from(cross_matrix(turn.w)));
    by_motion.fixed_view_mut::<3, 3>(0, 3).copy_from(&Matrix3::identity());
    by_motion.fixed_view_mut::<3, 3>(0, 6).copy_from(&by_spin);
    let mut by_wrench = SMatrix::<f64, 3, 6>::zeros();
    by_wrench.fixed_view_mut::<3, 3>(0, 0).copy_from(&(Matrix3::identity() * body.inverse_mass()));
    by_wrench.fixed_view_mut::<3, 3>(0, 3).copy_from(&(by_spin * Matrix3::from(turn.K)));
    let all =
        (by_motion * covariance * by_motion.transpose() + by_wrench * bridge * by_wrench.transpose()) * wider;
    let turning = turn.w - contact.W;
    let shifts = tangents.map(|tangent| turning.cross(tangent) * problem.noise.contact);
    let floor = problem.noise.floor.powi(2);
    let entry = |a: DVec3, b: DVec3| {
        let known = nalgebra::Vector3::from(a).dot(&(all * nalgebra::Vector3::from(b)));
        let read: f64 = shifts.iter().map(|shift| shift.dot(a) * shift.dot(b)).sum();
        known + read
    };
    let [a, b] = tangents;
    let covariance = Matrix2::new(entry(a, a) + floor, entry(a, b), entry(b, a), entry(b, b) + floor);
    let covariance = (covariance + covariance.transpose()) * 0.5;
    let slip = ContactSlip { velocity: Vector2::new(velocity.dot(a), velocity.dot(b)), covariance };
    let sound =
        covariance.iter().chain(&slip.velocity).all(|x| x.is_finite()) && covariance.determinant() > 0.0;
    sound.then_some(slip)
}
