//! A start that needs no guess: static balance for the centre of mass, rest for the momentum, a grid of orientations,
//! and windows that grow while the fit follows.

use super::clean::information_inverse;
use super::covariance::{NoiseLevel, Sampling, propagate};
use super::estimate::WORTH_ADJUSTING;
use super::momentum::{MomentumProblem, Scales, StartState, UNKNOWNS};
use super::track::{Node, Track, smoothing_variance};
use crate::least_squares::{Fit, FitStatus, LevenbergMarquardt, Observability};
use contact_kinematics::PalmTriple;
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::MassProperties;
use std::cell::OnceCell;

/// The search, round by round. Bodies near rest come first; then the log read backwards, whose first windows have other
/// noise; then other first windows, since far below one natural time the data determine little and far above it the
/// motion has left the neighbourhood of rest; then bodies that spin, at heights about that of rest.
pub(super) const ROUNDS: [Round; 12] = [
    Round { window: 1.5, height: 1.0, spin: 0.0, backwards: false },
    Round { window: 1.5, height: 1.0, spin: 0.0, backwards: true },
    Round { window: 3.0, height: 1.0, spin: 0.0, backwards: false },
    Round { window: 3.0, height: 1.0, spin: 0.0, backwards: true },
    Round { window: 0.75, height: 1.0, spin: 0.0, backwards: false },
    Round { window: 1.5, height: 1.0, spin: 0.5, backwards: false },
    Round { window: 1.5, height: 0.8, spin: 0.5, backwards: false },
    Round { window: 1.5, height: 1.2, spin: 0.5, backwards: false },
    Round { window: 1.5, height: 1.0, spin: 0.5, backwards: true },
    Round { window: 1.5, height: 1.0, spin: 1.0, backwards: false },
    Round { window: 1.5, height: 0.8, spin: 1.0, backwards: false },
    Round { window: 1.5, height: 1.2, spin: 1.0, backwards: false },
];

/// One family of starts.
#[derive(Clone, Copy)]
pub(super) struct Round {
    /// First window in units of the natural time `sqrt(length / g)`, or of a quarter of a short log.
    pub(super) window: f64,
    /// Height of the centre of mass as a share of the one that static balance suggests.
    pub(super) height: f64,
    /// Angular velocity in natural units, about each axis in both senses.
    pub(super) spin: f64,
    /// Whether the windows grow from the end of the log.
    pub(super) backwards: bool,
}

/// Factor by which the window grows.
pub(super) const GROWTH: f64 = 1.35;
/// Samples per natural time while the window grows: enough for the Runge-Kutta steps and for the shape of the motion.
pub(super) const SAMPLES_PER_NATURAL_TIME: f64 = 24.0;
/// The same before all of the log is fitted: the quadrature keeps its accuracy, only residuals are fewer.
pub(super) const SEARCHED_PER_NATURAL_TIME: f64 = 10.0;
/// Linearisations after which the starts of a round are compared.
const SCREENED: usize = 4;
/// Weight of the contact normals' common point against static balance: it decides the height alone.
const NORMALS_WEIGHT: f64 = 0.01;
/// Candidates that are followed beyond the first window before what noise explains is looked at.
pub(super) const FOLLOWED: usize = 4;
/// Candidates of a round that are followed in all.
const FOLLOWED_IN_ALL: usize = 12;
/// Share of the mean information that holds a candidate near its start in the first windows.
const PRIOR: f64 = 1e-3;
/// Residual below which a fit is taken as right, in natural velocities: logs of other simulators leave up to 5e-6,
/// wrong minima of random scenes 1e-4 and more.
pub(super) const NEXT_TO_NOTHING: f64 = 1e-5;
/// Part of the natural sizes that an unexplained residual may hide: one wrong minimum of 200 random scenes left 4e-7 of the
/// natural velocity, and room for 0.6.
const HIDDEN: f64 = 0.05;
/// Multiple of the residual that sensor noise leaves, below which a fit is taken as right: right fits scatter by 12 %
/// about 1, wrong minima begin at 1.7.
pub(super) const EXPLAINED: f64 = 1.4;
/// Natural times from which on a log without noise is searched a second time. Over 2.1 of them a wrong motion was found so that
/// left next to nothing (two palms 4 degrees apart).
const LONG_ENOUGH: f64 = 3.0;
/// Least damping that a fit of more data begins with.
const CONTINUED: f64 = 1e-6;
/// Fits on the way: good enough to start the next from.
pub(super) const COARSE: LevenbergMarquardt =
    LevenbergMarquardt { iterations: 25, step_tolerance: 1e-6, damping: 1e-2, prior: 0.0 };
/// Fits of one of the windows as they grow: what it does not reach, the next one may.
const GROWING: LevenbergMarquardt = LevenbergMarquardt { iterations: 8, ..COARSE };

/// Fits of the first window.
pub(super) const FIRST: LevenbergMarquardt = LevenbergMarquardt { prior: PRIOR, ..COARSE };

/// Natural sizes of the track's scene.
pub(super) fn scales(track: &Track, mass: &MassProperties) -> Scales {
    let contacts = track.nodes.iter().flat_map(|n| n.p_WC);
    let count = (3 * track.nodes.len()) as f64;
    let mean = contacts.clone().sum::<DVec3>() / count;
    let length = contacts.map(|c| c.distance(mean)).sum::<f64>() / count;
    // A log of one point is no scene, but must not divide by zero.
    let length = if length > 0.0 { length } else { 1.0 };
    let rate = 1.0 / natural_time(track, length);
    let inertia = mass.inertia();
    let moment = (inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z) / 3.0;
    Scales { length, velocity: length * rate, momentum: moment * rate }
}

pub(super) fn natural_time(track: &Track, length: f64) -> f64 {
    let g = track.gravity.length();
    if g > 0.0 { (length / g).sqrt() } else { track.duration() / 4.0 }
}

/// Samples for one node, of so many in a natural time.
pub(super) fn stride(track: &Track, natural: f64, nodes: f64) -> usize {
    let spacing = track.duration() / (track.len() - 1).max(1) as f64;
    (natural / nodes / spacing).floor().max(1.0) as usize
}

/// How the samples of a log enter the nodes of a track with so many of them a node.
pub(super) fn sampling(per_node: usize) -> Sampling {
    Sampling { per_node: per_node as f64, weight: 1.0, direct: smoothing_variance(per_node / 2) }
}

/// A solver for more of the same data: it begins with the damping that the fit of less of them came to.
pub(super) fn continuing<Point, const P: usize>(
    solver: LevenbergMarquardt,
    from: &Fit<Point, P>,
) -> LevenbergMarquardt {
    LevenbergMarquardt { damping: from.damping.clamp(CONTINUED, solver.damping), ..solver }
}

/// The best fits found, best first, each over the whole (thinned) track.
///
/// The candidate that fits the first window best after a few steps is followed first. One that leaves next to nothing ends the
/// search. Noise may hide that a motion is wrong: of noisy data a few candidates are followed, and the best of them is taken
/// if it leaves noise alone. Otherwise others are tried, and then other first windows.
pub(super) fn cold_start(
    track: &Track,
    mass: &MassProperties,
    noise: NoiseLevel,
) -> Vec<Fit<StartState, UNKNOWNS>> {
    let scales = scales(track, mass);
    let natural = natural_time(track, scales.length);
    let per_node = stride(track, natural, SAMPLES_PER_NATURAL_TIME);
    let sampling = sampling(per_node);
    let thin = track.thinned(per_node);
    let searched_per_node = stride(track, natural, SEARCHED_PER_NATURAL_TIME);
    let coarse = track.thinned(searched_per_node);
    let backwards = [OnceCell::new(), OnceCell::new()];
    let search = |track| Search { track, mass, scales, noise, sampling };
    let forwards = search(&thin);
    let unit = natural.min(0.25 * track.duration());
    let mut found = Vec::new();
    // What is left of a short log does not tell right from wrong, however long it is searched.
    let clean = noise.contact <= WORTH_ADJUSTING * scales.length && track.duration() > LONG_ENOUGH * natural;
    for (fine, round) in rounds(clean) {
        let (nodes, per_node) = if fine { (&thin, per_node) } else { (&coarse, searched_per_node) };
        let searched = match round.backwards {
            true => search(backwards[usize::from(fine)].get_or_init(|| track.reversed().thinned(per_node))),
            false => search(nodes),
        };
        let growing = if fine { COARSE } else { GROWING };
        let first = (round.window * unit).min(track.duration());
        let candidates = searched.candidates(first, round);
        let last = candidates.len();
        for (number, candidate) in (1..).zip(candidates) {
            let fit = searched.follow(candidate, first, growing);
            let start = if round.backwards { searched.reversed_end(&fit.point) } else { fit.point };
            found.push(continuing(COARSE, &fit).fit(&forwards.problem(f64::INFINITY), start));
            sort(&mut found);
            let looked_at = number % FOLLOWED == 0 || number == last;
            let done = |best| next_to_nothing(best, &scales) || looked_at && forwards.explains(best);
            if found.first().is_some_and(done) {
                return found;
            }
        }
    }
    found
}

/// Rounds of the search, with few residuals and steps; and, where no noise hides what is right, all of them once more with more
/// of both (`true`): two palms 15 and 25 degrees apart need them.
fn rounds(clean: bool) -> impl Iterator<Item = (bool, Round)> {
    let of = |fine: bool| ROUNDS.into_iter().map(move |round| (fine, round));
    of(false).chain(of(true).filter(move |_| clean))
}

/// The fit of the thinned track from a start that is near.
pub(super) fn fit_near(
    track: &Track,
    mass: &MassProperties,
    scales: Scales,
    near: StartState,
) -> Option<Fit<StartState, UNKNOWNS>> {
    let thin = track.thinned(stride(track, natural_time(track, scales.length), SAMPLES_PER_NATURAL_TIME));
    let problem = MomentumProblem::new(&thin, mass, scales, f64::INFINITY);
    let fit = LevenbergMarquardt { damping: 1e-4, ..COARSE }.fit(&problem, near);
    (fit.status != FitStatus::Failed).then_some(fit)
}

pub(super) struct Search<'a> {
    pub(super) track: &'a Track,
    pub(super) mass: &'a MassProperties,
    pub(super) scales: Scales,
    pub(super) noise: NoiseLevel,
    pub(super) sampling: Sampling,
}

impl Search<'_> {
    pub(super) fn problem(&self, window: f64) -> MomentumProblem<'_> {
        MomentumProblem::new(self.track, self.mass, self.scales, window)
    }

    /// The more promising starts of a round, best first, after a few steps on the first window.
    fn candidates(&self, window: f64, round: Round) -> Vec<Fit<StartState, UNKNOWNS>> {
        let problem = self.problem(window);
        let screen = LevenbergMarquardt { iterations: SCREENED, ..FIRST };
        let starts = self.starts(window, round);
        let mut fits: Vec<_> = starts.into_iter().map(|start| screen.fit(&problem, start)).collect();
        sort(&mut fits);
        fits.truncate(FOLLOWED_IN_ALL);
        fits
    }

    /// The starts of a round.
    pub(super) fn starts(&self, window: f64, round: Round) -> Vec<StartState> {
        let mut rest = rest_state(self.track, window);
        rest.p_WCm.z *= round.height;
        let axes = self.mass.principal().axes.inverse();
        let orientations = orientations().into_iter().map(|R_WI| R_WI * axes);
        if round.spin == 0.0 {
            return orientations.map(|R_WO| StartState { R_WO, ..rest }).collect();
        }
        let rate = round.spin * self.scales.velocity / self.scales.length;
        let turns = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| [axis * rate, axis * -rate]);
        let basic: Vec<DQuat> = orientations.take(BASIC_ORIENTATIONS).collect();
        turns
            .flat_map(|w_WO| basic.iter().map(move |&R_WO| (w_WO, R_WO)))
            .map(|(w_WO, R_WO)| self.spinning(StartState { R_WO, ..rest }, w_WO))
            .collect()
    }

    /// The state with an angular velocity, and the velocity that keeps its contacts.
    fn spinning(&self, rest: StartState, w_WO: DVec3) -> StartState {
        let node = &self.track.nodes[0];
        let L_WO = rest.R_WO * (self.mass.inertia() * (rest.R_WO.inverse() * w_WO));
        let carried =
            |i: usize| w_WO.dot(node.palms[i].frame.n.cross(node.p_WC[i] - rest.p_WCm)) - node.lift[i];
        StartState {
            L_WO,
            v_WCm: from_normal_speeds(node, DVec3::new(carried(0), carried(1), carried(2))),
            ..rest
        }
    }

    fn follow(
        &self,
        candidate: Fit<StartState, UNKNOWNS>,
        first: f64,
        growing: LevenbergMarquardt,
    ) -> Fit<StartState, UNKNOWNS> {
        let mut fit = FIRST.resume(&self.problem(first), candidate);
        let mut window = first;
        while window < self.track.duration() {
            window = (window * GROWTH).min(self.track.duration());
            fit = continuing(growing, &fit).fit(&self.problem(window), fit.point);
        }
        fit
    }

    /// Start, in the log read the other way, of the motion that begins like this: velocities change their sign.
    fn reversed_end(&self, start: &StartState) -> StartState {
        let end = self.problem(f64::INFINITY).end(start);
        StartState { v_WCm: -end.v_WCm, L_WO: -end.L_WO, ..end }
    }

    /// Whether what is left of the data is noise, or next to nothing: then no other minimum can be better to speak of.
    fn explains(&self, fit: &Fit<StartState, UNKNOWNS>) -> bool {
        next_to_nothing(fit, &self.scales) || fit.normal.rms() < EXPLAINED * self.explained(fit)
    }

    /// Residual that noise explains, m/s.
    fn explained(&self, fit: &Fit<StartState, UNKNOWNS>) -> f64 {
        let inverse = information_inverse(&Observability::new(&fit.normal.information));
        propagate(&self.problem(f64::INFINITY), &fit.point, &inverse, &self.noise, self.sampling).residual
    }
}

/// Whether next to nothing is left of the data, and what is left cannot hide in a direction that they hardly determine: if
/// all of it were an error that lasts, it would have moved the unknowns by no more than a small part of their sizes.
pub(super) fn next_to_nothing<Point, const P: usize>(fit: &Fit<Point, P>, scales: &Scales) -> bool {
    fit.normal.rms() < NEXT_TO_NOTHING * scales.velocity && {
        let smallest = Observability::new(&fit.normal.information).eigenvalues[0];
        fit.normal.cost < HIDDEN.powi(2) * smallest
    }
}

fn sort(candidates: &mut Vec<Fit<StartState, UNKNOWNS>>) {
    candidates.retain(|c| c.status != FitStatus::Failed);
    candidates.sort_by(|a, b| a.normal.cost.total_cmp(&b.normal.cost));
}

/// A body at rest: the centre of mass where the contact wrench balances, at the height where the contact normals pass
/// each other most closely (they meet there for a ball).
pub(super) fn rest_state(track: &Track, window: f64) -> StartState {
    let end = track.t.partition_point(|&t| t <= window).max(1);
    let mut matrix = DMat3::ZERO;
    let mut rhs = DVec3::ZERO;
    for node in &track.nodes[..end] {
        let wrench = |i: usize| node.forces[i] * node.palms[i].frame.n;
        let force = wrench(0) + wrench(1) + wrench(2);
        let torque = (0..3).map(|i| node.p_WC[i].cross(wrench(i))).sum::<DVec3>();
        let square = force.length_squared().max(f64::MIN_POSITIVE);
        // Q = p x F, least squares: (|F|^2 1 - F F') p = F x Q.
        matrix += projector(force / square.sqrt());
        rhs += force.cross(torque) / square;
        for i in 0..3 {
            let across = projector(node.palms[i].frame.n);
            matrix += across * NORMALS_WEIGHT;
            rhs += across * node.p_WC[i] * NORMALS_WEIGHT;
        }
    }
    let node = &track.nodes[0];
    // Three palms apart make this matrix regular; parallel ones leave a height of zero.
    let invertible = matrix.determinant().abs() > 1e-12;
    let p_WCm = if invertible { matrix.inverse() * rhs } else { node.p_WC.iter().sum::<DVec3>() / 3.0 };
    let v_WCm = from_normal_speeds(node, -DVec3::from_array(node.lift));
    StartState { p_WCm, v_WCm, L_WO: DVec3::ZERO, R_WO: DQuat::IDENTITY }
}

/// The velocity with the given parts along the palms' normals; zero for palms that do not determine one.
pub(super) fn from_normal_speeds(node: &Node, speeds: DVec3) -> DVec3 {
    PalmTriple::new(node.palms.map(|p| p.frame.n)).map_or(DVec3::ZERO, |palms| palms.solve(speeds))
}

/// `1 - u u'`.
fn projector(u: DVec3) -> DMat3 {
    DMat3::IDENTITY - DMat3::from_cols(u * u.x, u * u.y, u * u.z)
}

/// The first of [`orientations`]: the axes along the world's, in every order.
const BASIC_ORIENTATIONS: usize = 6;

/// Orientations of principal axes, spread over all that differ: turns by pi about a principal axis change nothing, so
/// the 24 turns of a cube leave 6, and each is taken as it is and turned by 45 degrees about each axis.
pub(super) fn orientations() -> Vec<DQuat> {
    let third =
        |k: i32| DQuat::from_axis_angle(DVec3::ONE.normalize(), f64::from(k) * std::f64::consts::TAU / 3.0);
    let quarter = std::f64::consts::FRAC_PI_2;
    let mut all = Vec::new();
    for swap in [DQuat::IDENTITY, DQuat::from_rotation_z(quarter)] {
        for k in 0..3 {
            let base = third(k) * swap;
            all.push(base);
        }
    }
    let bases = all.clone();
    for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
        all.extend(bases.iter().map(|base| DQuat::from_axis_angle(axis, 0.5 * quarter) * *base));
    }
    all
}
