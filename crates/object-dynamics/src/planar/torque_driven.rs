//! Simulation with palms that have inertia and are driven by torques.

use super::error::PlanarSimulationError;
use super::log::{PlanarSample, PlanarTruth};
use super::reaction::{PlanarObject, bias, dual};
use super::simulate::{PlanarRun, PlanarRunSample, drive};
use contact_kinematics::planar::{PairContact, PairRates, PalmPair, PalmPairState, RadiusFunction};
use nalgebra::{Matrix3, Vector3};

/// Palms with moments of inertia about the hinge (kg m^2). Their weight is balanced, as in the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrivenPalms {
    inertias: [f64; 2],
}

/// State at the first sample of a torque-driven run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueStart {
    /// Orientation of the object, rad.
    pub phi0: f64,
    /// Absolute palm angles `P1`, `P2`, rad.
    pub palm_angles: [f64; 2],
    /// Angular velocity of the object, rad/s.
    pub omega0: f64,
    /// Absolute palm rates, rad/s.
    pub palm_rates: [f64; 2],
}

/// Accelerations and forces of object and palms at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueReaction {
    /// Angular accelerations of the object, palm 1 and palm 2, rad/s^2.
    pub accelerations: [f64; 3],
    /// Normal contact forces, N.
    pub forces: [f64; 2],
}

impl DrivenPalms {
    /// From the moments of inertia of the palms about the hinge, kg m^2.
    ///
    /// # Errors
    /// [`PlanarSimulationError::PalmInertia`] unless both are positive.
    pub fn new(inertias: [f64; 2]) -> Result<Self, PlanarSimulationError> {
        match inertias.iter().position(|&i| !(i > 0.0 && i.is_finite())) {
            Some(index) => {
                Err(PlanarSimulationError::PalmInertia { palm: index + 1, value: inertias[index] })
            }
            None => Ok(Self { inertias }),
        }
    }

    /// Moments of inertia in kg m^2.
    #[must_use]
    pub fn inertias(&self) -> [f64; 2] {
        self.inertias
    }

    /// Solves `(diag(I0, I1, I2) + m N^T Q N) a = (0, tau1, tau2) - m N^T Q b` with `N = [[d1, s1, 0], [d2, 0, -s2]]`.
    ///
    /// Palm 2 obeys `I2 A2 = tau2 + f2 s2`: with both torques counter-clockwise its sign differs from palm 1's and from the
    /// paper's equation (29). None where the matrix is not positive definite to rounding, which positive inertias exclude.
    #[must_use]
    pub fn reaction(
        &self,
        object: &PlanarObject<impl RadiusFunction>,
        state: &TorqueState,
        torques: [f64; 2],
    ) -> Option<TorqueReaction> {
        let TorqueState { contact, palms, v, omega0 } = state;
        let mass = object.mass.mass();
        let b = bias(contact, *v, palms, *omega0, object.gravity);
        let (d, s) = (contact.jets.map(|j| j.d), contact.s);
        let columns = [[d[0], d[1]], [s[0], 0.0], [0.0, -s[1]]];
        let inertias = Vector3::new(object.mass.inertia(), self.inertias[0], self.inertias[1]);
        let product = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
        let coupling = Matrix3::from_fn(|i, j| mass * product(columns[i], dual(palms, columns[j])));
        let load = Vector3::from_fn(|i, _| {
            [0.0, torques[0], torques[1]][i] - mass * product(columns[i], dual(palms, b))
        });
        let a = (Matrix3::from_diagonal(&inertias) + coupling).cholesky()?.solve(&load);
        let normal = [d[0] * a[0] + s[0] * a[1] + b[0], d[1] * a[0] - s[1] * a[2] + b[1]];
        let forces = dual(palms, normal).map(|x| mass * x);
        Some(TorqueReaction { accelerations: [a[0], a[1], a[2]], forces })
    }
}

/// Kinematic state that a torque-driven reaction is computed from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueState {
    contact: PairContact,
    palms: PalmPairState,
    v: glam::DVec2,
    omega0: f64,
}

impl TorqueState {
    /// Contacts and velocities of `object` between moving palms.
    #[must_use]
    pub fn new(
        object: &PlanarObject<impl RadiusFunction>,
        pair: PalmPair,
        palm_rates: [f64; 2],
        phi0: f64,
        omega0: f64,
    ) -> Self {
        let palms = PalmPairState { pair, motion: PairRates { rates: palm_rates, accelerations: [0.0; 2] } };
        let contact = PairContact::new(&object.shape, &pair, phi0);
        let v = contact.velocity(&palms, omega0).v_WCm;
        Self { contact, palms, v, omega0 }
    }
}

/// Simulates `object` and `palms` under motor torques `torques(t)` (N m, ground-referenced, counter-clockwise).
///
/// State: orientation, both absolute palm angles, their rates, and the motors' work.
///
/// # Errors
/// As [`super::simulate_prescribed`].
pub fn simulate_torque_driven(
    object: &PlanarObject<impl RadiusFunction>,
    palms: &DrivenPalms,
    torques: impl Fn(f64) -> [f64; 2],
    start: TorqueStart,
    times: &[f64],
    tolerance: f64,
) -> Result<PlanarRun, PlanarSimulationError> {
    let evaluate = |t: f64, y: &[f64; 7]| {
        let pair = PalmPair::from_absolute(y[1], y[2])?;
        let state = TorqueState::new(object, pair, [y[4], y[5]], y[0], y[3]);
        let failed = TorqueReaction { accelerations: [f64::NAN; 3], forces: [f64::NAN; 2] };
        let reaction = palms.reaction(object, &state, torques(t)).unwrap_or(failed);
        Ok((state, reaction))
    };
    let field = |t: f64, y: &[f64; 7]| {
        let [a0, a1, a2] = evaluate(t, y)?.1.accelerations;
        let tau = torques(t);
        Ok([y[3], y[4], y[5], a0, a1, a2, tau[0] * y[4] + tau[1] * y[5]])
    };
    let observe = |t: f64, y: &[f64; 7]| {
        let (state, reaction) = evaluate(t, y)?;
        let [i1, i2] = palms.inertias;
        let palm_energy = 0.5 * (i1 * y[4] * y[4] + i2 * y[5] * y[5]);
        Ok(PlanarRunSample {
            sample: PlanarSample {
                t,
                angles: [y[1], y[2] - y[1]],
                contacts: state.contact.s.map(Some),
                forces: Some(reaction.forces),
                torques: Some(torques(t)),
            },
            truth: PlanarTruth { p_WCm: state.contact.p_WCm, phi0: y[0], v_WCm: state.v, omega0: y[3] },
            alpha0: reaction.accelerations[0],
            palm_rates: [y[4], y[5]],
            energy: object.energy(state.contact.p_WCm, state.v, y[3]) + palm_energy,
            work: y[6],
        })
    };
    let y = [
        start.phi0,
        start.palm_angles[0],
        start.palm_angles[1],
        start.omega0,
        start.palm_rates[0],
        start.palm_rates[1],
        0.0,
    ];
    drive(field, observe, y, times, tolerance)
}
