use super::NoForceError;
use super::closure::{Closure, closure};
use super::deviations::deviations;
use super::problem::{Guess, Row, TouchProblem, UNKNOWNS};
use super::search::search;
use super::series::{Nodes, TouchSeries};
use super::shape::FreeEllipsoid;
use super::suspects::{Doubts, Wrong, doubts};
use crate::core::describe_direction;
use crate::faults::Suspect;
use crate::least_squares::{FitStatus, LevenbergMarquardt, Observability};
use crate::rigid::inertia_of_numbers;
use crate::three_palms::motion_state::MotionState;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, SMatrix, SymmetricEigen};
use object_dynamics::{Instant, SensorLog};

/// Nodes in a natural time `sqrt(length / g)`: the error of the Runge-Kutta steps is then below 1e-5 of the length over
/// 4 s, and falls with the fourth power.
const NODES_PER_NATURAL_TIME: f64 = 24.0;
/// The same for the last fit.
const FINE: f64 = 2.0;
/// Shortest log in natural times.
const SHORTEST: f64 = 2.0;
/// A direction known to worse than this share of its natural size is not determined: the linearisation that its
/// covariance comes from does not reach that far.
const LARGEST_DEVIATION: f64 = 0.25;
/// Smallest share of the largest information that still counts, as derivatives are taken from differences.
const RANK_TOLERANCE: f64 = 1e-13;
/// A right fit leaves at most this multiple of the noise, or this share of the length where there is next to no noise.
const EXPLAINED: (f64, f64) = (1.4, 1e-5);

/// Linearisations of the last fit, which begins near its minimum.
pub(super) const ITERATIONS: usize = 100;

/// What is known beside the log.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownTouch {
    /// Acceleration of free fall, world, m/s^2.
    pub gravity: DVec3,
    /// Standard deviation of a contact coordinate, m; where it is not known it is taken from the readings' roughness.
    pub contact_noise: Option<f64>,
}

/// An ellipsoid in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TouchShape {
    /// Its centre from the centre of mass, m.
    pub centre: DVec3,
    /// Turns its axes into those of the body.
    pub orientation: DQuat,
    /// Semi-axes, m, ascending.
    pub semi_axes: DVec3,
}

/// What an estimate without forces rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct NoForceEvidence {
    /// How the last fit ended: in a minimum, or where rounding hides every way down.
    pub status: FitStatus,
    /// Samples used.
    pub samples: usize,
    /// Root mean square of the differences between predicted and measured block means, m.
    pub residual_rms: f64,
    /// What noise leaves of it, m.
    pub noise_explains: f64,
    /// Directions of the 18 unknowns that the data determine.
    pub rank: usize,
    /// Largest over smallest singular value of the scaled Jacobian.
    pub condition: f64,
    /// The worst known direction in words, with the shares of the unknowns in it.
    pub weakest: String,
    /// Its standard deviation in natural sizes.
    pub weakest_deviation: f64,
    /// Agreement of the contact curves where they cross; none where they do not.
    pub closure: Option<Closure>,
    /// What the data say of tilts of palms and of offsets of contacts. What may be wrong counts in all deviations, by its odds. Nothing where more is left than
    /// noise explains, as steps leave of exact logs.
    pub suspects: Vec<Suspect>,
}

/// Motion, shape and inertia over mass of a body of which only contacts are known. The mass itself cannot be known:
/// every force would only be larger.
#[derive(Clone, Debug)]
pub struct NoForceEstimate {
    /// Motion at the nodes of the estimate. Body axes are those of the world at the first sample.
    pub motion: Vec<MotionState>,
    /// Standard deviations of the motion at the same nodes: centre of mass (m), velocity (m/s), angular velocity (rad/s) and turn since the
    /// first node (rad), world axes.
    pub deviations: Vec<[DVec3; 4]>,
    /// The shape.
    pub shape: TouchShape,
    /// Inertia tensor over mass about the centre of mass, body axes, m^2.
    pub inertia_per_mass: DMat3,
    /// Covariance of angular velocity at the first sample (3, rad/s), of the entries `xx, yy, zz, xy, xz, yz` of the
    /// shape's matrix `D` (`h = sqrt(n' D n) + c . n`; m^2), of the centre `c` (3, m) and of the entries of the inertia
    /// over mass, in the same order (m^2).
    pub covariance: SMatrix<f64, UNKNOWNS, UNKNOWNS>,
    /// How well the data determine it.
    pub evidence: NoForceEvidence,
}

/// Names of the unknowns.
const NAMES: [&str; UNKNOWNS] = [
    "angular velocity about x",
    "angular velocity about y",
    "angular velocity about z",
    "extent of the shape along x",
    "extent of the shape along y",
    "extent of the shape along z",
    "skewness of the shape in xy",
    "skewness of the shape in xz",
    "skewness of the shape in yz",
    "offset of the shape along x",
    "offset of the shape along y",
    "offset of the shape along z",
    "second moment along x",
    "second moment along y",
    "second moment along z",
    "product of inertia xy",
    "product of inertia xz",
    "product of inertia yz",
];

/// Estimates motion, shape (an ellipsoid, its centre anywhere) and inertia over mass from contacts and palm poses, without
/// any force and with no guess.
///
/// The 18 unknowns make a motion by the equations of motion, in which contact forces do no work; the contacts that it
/// predicts are fitted to those felt, on windows that grow. With the mass unknown and no force measured, force and mass
/// are known up to a common factor only.
///
/// # Errors
/// [`NoForceError`]; in particular [`NoForceError::NotDetermined`], in words, for a sphere, a body of revolution that
/// spins about its axis, a body at rest and the like.
pub fn estimate_without_forces(log: &SensorLog, known: &KnownTouch) -> Result<NoForceEstimate, NoForceError> {
    let gravity = known.gravity;
    if !gravity.is_finite() || gravity.length() == 0.0 {
        return Err(NoForceError::Gravity { gravity });
    }
    if let Some(value) = known.contact_noise.filter(|n| !(*n > 0.0 && n.is_finite())) {
        return Err(NoForceError::Noise { value });
    }
    let series = TouchSeries::new(log)?;
    let (_, length) = series.ball();
    let length = length.abs();
    let natural = (length / gravity.length()).sqrt();
    // A ball of no size: contacts at the origin.
    if length.is_nan() || series.duration() < SHORTEST * natural || natural == 0.0 {
        return Err(NoForceError::TooShort { seconds: series.duration(), needed: SHORTEST * natural });
    }
    let noise = known.contact_noise.unwrap_or_else(|| series.noise());
    let stride = |per_time: f64| {
        let samples = series.t.len() as f64 * natural / series.duration() / per_time;
        ((samples / 2.0).floor() as usize * 2).clamp(2, (series.t.len() - 1) / 6 * 2)
    };
    let nodes = series.nodes(stride(NODES_PER_NATURAL_TIME));
    let fine = series.nodes(stride(FINE * NODES_PER_NATURAL_TIME));
    let scene = Scene { series: &series, gravity, length, noise, iterations: ITERATIONS };
    let best = search(&series, &nodes, gravity, scene.enough(&nodes));
    let best = best.ok_or(NoForceError::NoFit { residual: f64::NAN, noise })?;
    scene.estimate(&fine, best.point)
}

/// What the last fit works on.
pub(super) struct Scene<'a> {
    pub(super) series: &'a TouchSeries,
    pub(super) gravity: DVec3,
    pub(super) length: f64,
    pub(super) noise: f64,
    /// Linearisations after which a fit that has not settled never will.
    pub(super) iterations: usize,
}

impl Scene<'_> {
    /// Root mean square that a right fit leaves at most, m.
    fn enough(&self, nodes: &Nodes) -> f64 {
        (EXPLAINED.0 * self.noise * nodes.variance.sqrt()).max(EXPLAINED.1 * self.length)
    }

    /// The minimum next to a start, and what it is worth.
    pub(super) fn estimate(&self, nodes: &Nodes, start: Guess) -> Result<NoForceEstimate, NoForceError> {
        let problem = TouchProblem::new(nodes, self.gravity, self.length, f64::INFINITY);
        let iterations = self.iterations;
        let solver = LevenbergMarquardt { iterations, step_tolerance: 1e-9, damping: 1e-9, prior: 0.0 };
        let fit = solver.fit(&problem, start);
        let rms = fit.normal.rms();
        let deviation = self.noise * nodes.variance.sqrt();
        let spectrum = Observability::new(&fit.normal.information);
        // What is left beyond noise, as steps between samples leave it in exact logs, moves the estimate as noise does.
        let left = deviation.max(rms);
        let (words, weakest) = weakest(&spectrum, left);
        let failed = fit.status == FitStatus::Failed;
        if !failed && (weakest.is_nan() || weakest > LARGEST_DEVIATION) {
            return Err(NoForceError::NotDetermined { words, deviation: weakest });
        }
        let no_fit = NoForceError::NoFit { residual: rms, noise: deviation };
        if failed || rms.is_nan() || rms > self.enough(nodes) {
            return Err(no_fit);
        }
        if fit.status == FitStatus::OutOfIterations {
            let (iterations, residual, noise) = (fit.iterations, rms, deviation);
            return Err(NoForceError::NotSettled { iterations, residual, noise });
        }
        let motion = problem.motion(&fit.point, nodes.t.len()).ok_or(no_fit.clone())?;
        let (largest, smallest) = (spectrum.eigenvalues[UNKNOWNS - 1], spectrum.eigenvalues[0]);
        let of_noise = spectrum.directions
            * SMatrix::from_diagonal(&spectrum.eigenvalues.map(|v| left * left / v))
            * spectrum.directions.transpose();
        // What steps leave of an exact log lasts, and would be laid to any constant.
        let by_noise = rms <= EXPLAINED.0 * deviation;
        let doubts = match by_noise {
            true => doubts(&problem, &fit.point, left, &of_noise).ok_or(no_fit.clone())?,
            false => Doubts::default(),
        };
        let evidence = NoForceEvidence {
            status: fit.status,
            samples: self.series.t.len(),
            residual_rms: rms,
            noise_explains: deviation,
            rank: spectrum.eigenvalues.iter().filter(|&&v| v > RANK_TOLERANCE * largest).count(),
            condition: (largest / smallest).sqrt(),
            weakest: words,
            weakest_deviation: weakest,
            closure: closure(self.series, &problem, &fit.point, self.noise),
            suspects: doubts.suspects,
        };
        let of_wrong = |sum, wrong: &Wrong| sum + wrong.numbers * wrong.numbers.transpose();
        let inverse = doubts.errors.iter().fold(of_noise, of_wrong);
        let scales = problem.scales();
        let outward = by_numbers(&fit.point) * SMatrix::from_diagonal(&scales);
        let state = |now: &Instant| MotionState {
            t: now.t + self.series.start,
            p_WCm: now.touch.p_WCm,
            R_WO: now.R_WO,
            v_WCm: now.rates.v_WCm,
            w_WO: now.w_WO,
        };
        let mut deviations =
            deviations(&problem, &fit.point, motion.len(), &of_noise, &doubts.errors).ok_or(no_fit)?;
        // A body shakes as its palms do, faster than steps tell.
        let missed = nodes.missed_rates;
        for [_, velocity, spin, _] in &mut deviations {
            *velocity = velocity.map(|of| of.hypot(missed * self.length));
            *spin = spin.map(|of| of.hypot(missed));
        }
        let mut covariance = outward * inverse * outward.transpose();
        (0..3).for_each(|i| covariance[(i, i)] += missed * missed);
        Ok(NoForceEstimate {
            motion: motion.iter().map(state).collect(),
            deviations,
            shape: shape(&fit.point),
            inertia_per_mass: inertia_of_numbers(&fit.point.inertia),
            covariance,
            evidence,
        })
    }
}

/// The direction with the least information in words, and its standard deviation in natural sizes.
fn weakest(spectrum: &Observability<UNKNOWNS>, deviation: f64) -> (String, f64) {
    let direction: Row = spectrum.directions.column(0).into_owned();
    let (smallest, largest) = (spectrum.eigenvalues[0], spectrum.eigenvalues[UNKNOWNS - 1]);
    let known = smallest > RANK_TOLERANCE * largest;
    let size = if known { deviation / smallest.sqrt() } else { f64::INFINITY };
    (describe_direction(&direction, &NAMES), size)
}

fn shape(guess: &Guess) -> TouchShape {
    let free = FreeEllipsoid::new(&guess.shape);
    let eigen = SymmetricEigen::new(Matrix3::from(free.matrix()));
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| eigen.eigenvalues[a].total_cmp(&eigen.eigenvalues[b]));
    let axis = |k: usize| DVec3::from_array(eigen.eigenvectors.column(order[k]).into());
    let axes = DMat3::from_cols(axis(0), axis(1), axis(0).cross(axis(1)));
    TouchShape {
        centre: free.centre(),
        orientation: DQuat::from_mat3(&axes).normalize(),
        semi_axes: DVec3::from_array(order.map(|k| eigen.eigenvalues[k].max(0.0).sqrt())),
    }
}

/// Unknowns as the covariance names them.
pub(super) fn entries(guess: &Guess) -> Row {
    let six = |m: DMat3| [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.y_axis.x, m.z_axis.x, m.z_axis.y];
    let shape = FreeEllipsoid::new(&guess.shape);
    let (d, c) = (six(shape.matrix()), shape.centre());
    let j = six(inertia_of_numbers(&guess.inertia));
    Row::from_fn(|i, _| match i {
        0..=2 => guess.w[i],
        3..=8 => d[i - 3],
        9..=11 => c[i - 9],
        _ => j[i - 12],
    })
}

/// Their derivatives by the numbers that were fitted.
fn by_numbers(guess: &Guess) -> SMatrix<f64, UNKNOWNS, UNKNOWNS> {
    let mut slopes = SMatrix::<f64, UNKNOWNS, UNKNOWNS>::zeros();
    for j in 0..UNKNOWNS {
        let moved = |h: f64| {
            let mut g = *guess;
            match j {
                0..=2 => g.w[j] += h,
                3..=11 => g.shape[j - 3] += h,
                _ => g.inertia[j - 12] += h,
            }
            entries(&g)
        };
        // The numbers are of the order of one, and their functions quadratic and exponential.
        let slope: Row = (moved(1e-6) - moved(-1e-6)) / 2e-6;
        slopes.set_column(j, &slope);
    }
    slopes
}
