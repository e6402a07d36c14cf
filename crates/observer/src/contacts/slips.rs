//! Slips of contacts by the estimated motion, with their covariances.
//!
//! A contact that was taken to stick has no slip in a motion that rests on that: its slip is asked of the motion that is found where it, and it
//! alone, is taken to slide. What it then is says something of its mode that was not put in.

use super::body::CONSTANTS;
use super::noise::{ContactNoiseLevel, WrenchNoise};
use super::problem::{Problem, Unknowns};
use super::record::{Contact, Record};
use super::samples::{Deviations, at_all, covariance};
use super::search::{ENOUGH, fine_nodes};
use super::solve::{Covariances, Solved, solve};
use super::state::{MOTION, Motion};
use crate::contact_modes::ContactSlip;
use crate::rigid::cross_matrix;
use glam::DVec3;
use nalgebra::{Matrix2, Matrix3, SMatrix, Vector2, Vector3};
use object_dynamics::{ContactMode, MOST_PALMS};

/// Linearisations at most of a motion without the sticking of one palm: it begins where all is known but that.
const MOST: usize = 8;

/// Share of the noise between two nodes that a sample halfway has beside theirs. All samples get it: contacts are averaged over as long, and a node's own
/// covariance was seen to be short of its slip's errors by factors of 3 to 9 in deviations for stretches in which all others were within 2.
const HALFWAY: f64 = 0.25;

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
        if self.modes.iter().all(|modes| modes[palm] != ContactMode::Stick) {
            let Self { log, problem, solved, covariances, motions, .. } = *self;
            let motions: Vec<Motion> = motions.iter().map(|(motion, _)| *motion).collect();
            let found = &solved.unknowns;
            return Seen { log, problem, found, covariances, motions: &motions }.slips(palm, solved.misfit());
        }
        let seen = self.without_sticking(palm, |own, solved, covariances| {
            let motions = at_all(self.log, &own, &solved.unknowns, &covariances);
            let motions: Vec<Motion> = motions.into_iter().map(|(motion, _)| motion).collect();
            let (log, found, covariances) = (self.log, &solved.unknowns, &covariances);
            let seen = Seen { log, problem: &own, found, covariances, motions: &motions };
            seen.slips(palm, solved.misfit())
        });
        seen.unwrap_or_else(|| vec![None; self.log.times.len()])
    }

    /// What comes of the motion in which one palm, and it alone, is taken to slide wherever it is touched. None where no such motion is found.
    pub(super) fn without_sticking<T>(
        &self,
        palm: usize,
        then: impl FnOnce(Problem, Solved<CONSTANTS>, Covariances<CONSTANTS>) -> T,
    ) -> Option<T> {
        let Self { log, modes, problem, solved, motions, longest, .. } = *self;
        let mut free = modes.to_vec();
        for mode in free.iter_mut().map(|modes| &mut modes[palm]).filter(|m| **m == ContactMode::Stick) {
            *mode = ContactMode::Slide;
        }
        let mut record = log.clone();
        record.set_modes(&free);
        let averaged = record.averaged(longest);
        let mut own = problem.on(&averaged);
        own.blurred.clear();
        own.nodes = fine_nodes(&own);
        let at = own.node_samples().iter().map(|&k| motions[k].0).collect();
        let start = Unknowns { motions: at, body: solved.unknowns.body };
        let solved = solve::<CONSTANTS>(&own, start, MOST, ENOUGH[1])?;
        let covariances = solved.equations.covariances(&own.natural_information())?;
        Some(then(own, solved, covariances))
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
        let at = |(j, &k): (usize, &usize)| covariance(&motions[k], &found.body, j, covariances);
        let known: Vec<_> = nodes.iter().enumerate().map(at).collect();
        let mut slips = vec![None; log.times.len()];
        for (j, &start) in nodes.iter().enumerate() {
            let next = (j + 1).min(nodes.len() - 1);
            // The last node stands for itself alone.
            let (end, last) = (nodes[next].max(start + 1), nodes[next]);
            let between = &log.intervals[start..last];
            let noise = between.iter().fold(WrenchNoise::default(), |sum, interval| sum + interval.noise);
            let white = problem.about(&noise, motions[start].p).white * HALFWAY;
            let duration = (log.times[last] - log.times[start]).max(f64::MIN_POSITIVE);
            for k in start..end {
                let Some(contact) = log.contacts[k].iter().find(|c| c.palm == palm) else { continue };
                let share = (log.times[k] - log.times[start]) / duration;
                let covariance = known[j] * (1.0 - share) + known[next] * share;
                let (motion, wider) = (&motions[k], misfit.max(1.0));
                let turn = found.body.turn(motion.q, motion.L);
                let mut by_wrench = SMatrix::<f64, 3, 6>::zeros();
                let by_force = Matrix3::identity() * found.body.inverse_mass();
                let by_moment = -Matrix3::from(cross_matrix(contact.c - motion.p)) * Matrix3::from(turn.K);
                by_wrench.fixed_view_mut::<3, 3>(0, 0).copy_from(&by_force);
                by_wrench.fixed_view_mut::<3, 3>(0, 3).copy_from(&by_moment);
                let moving = Moving {
                    p_WCm: motion.p,
                    v_WCm: motion.v,
                    w_WO: turn.w,
                    covariance: covariance * wider,
                    beside: by_wrench * white * by_wrench.transpose() * wider,
                };
                slips[k] = slip(contact, &moving, &problem.noise);
            }
        }
        slips
    }
}

/// A body that moves, and how well that is known.
pub(super) struct Moving {
    pub(super) p_WCm: DVec3,
    pub(super) v_WCm: DVec3,
    pub(super) w_WO: DVec3,
    /// Of centre of mass, velocity, angular velocity and turn.
    pub(super) covariance: SMatrix<f64, MOTION, MOTION>,
    /// Covariance of the velocity at the contact beside that.
    pub(super) beside: Matrix3<f64>,
}

/// `slip = v + w x (c - p) - u` along the contact's tangents. None where it is beyond all numbers.
pub(super) fn slip(contact: &Contact, of: &Moving, noise: &ContactNoiseLevel) -> Option<ContactSlip> {
    let arm = contact.c - of.p_WCm;
    let mut by_motion = SMatrix::<f64, 3, MOTION>::zeros();
    by_motion.fixed_view_mut::<3, 3>(0, 0).copy_from(&-Matrix3::from(cross_matrix(of.w_WO)));
    by_motion.fixed_view_mut::<3, 3>(0, 3).copy_from(&Matrix3::identity());
    by_motion.fixed_view_mut::<3, 3>(0, 6).copy_from(&-Matrix3::from(cross_matrix(arm)));
    let moved = by_motion * of.covariance * by_motion.transpose() + of.beside;
    let tangents = contact.tangents();
    // A contact that is read beside where it is has another velocity of body and palm.
    let shifts = tangents.map(|tangent| (of.w_WO - contact.W).cross(tangent) * noise.contact);
    let read = |a: DVec3, b: DVec3| shifts.iter().map(|shift| shift.dot(a) * shift.dot(b)).sum::<f64>();
    let entry = |a: DVec3, b: DVec3| Vector3::from(a).dot(&(moved * Vector3::from(b))) + read(a, b);
    let [a, b] = tangents;
    let both = 0.5 * (entry(a, b) + entry(b, a));
    let floor = contact.floor(noise.floor).powi(2);
    let covariance = Matrix2::new(entry(a, a) + floor, both, both, entry(b, b) + floor);
    let velocity = of.v_WCm + of.w_WO.cross(arm) - contact.u;
    let velocity = Vector2::new(velocity.dot(a), velocity.dot(b));
    let finite = covariance.iter().chain(&velocity).all(|x| x.is_finite());
    let sound = finite && covariance[(0, 0)] > 0.0 && covariance.determinant() > 0.0;
    sound.then_some(ContactSlip { velocity, covariance })
}
