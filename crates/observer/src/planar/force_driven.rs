//! The object driven by measured contact forces, in regular coordinates.

use super::constants::{Constant, PlanarNominal, Side};
use super::error::PlanarEstimateError;
use super::input::{PairInput, PairStage};
use super::palm_contact::PalmContact;
use super::scale::NaturalScale;
use crate::{Model, Sample, rk4, rk4_linearised};
use nalgebra::{SMatrix, SVector};

/// Number of states of the motion: centre of mass, its velocity, angular velocity.
pub(super) const MOTION: usize = 5;
/// Relative rate of object and palm, as a share of the natural rate, below which the contact offset `d` is taken from the
/// sensor rather than from the motion. Small enough to cost no information in motion, large against rounding.
const BLEND_SHARE: f64 = 0.02;
/// State `(cm, v, omega0)` and, after it, constants to be estimated; driven by forces, with the contacts as output.
///
/// `cm' = v`, `m v' = m g + f_1 n_1 + f_2 n_2`, `I0 omega0' = -f_1 d_1 - f_2 d_2`, where rigid contact gives
/// `d_1 z_1 = n_1 . v - W_1 u_1 . cm` and `d_2 z_2 = n_2 . v + W_2 u_2 . cm` with `z_i = omega0 - W_i`, and the outputs are
/// `s_1 = u_1 . cm - d_1`, `s_2 = u_2 . cm + d_2`.
///
/// The paper's coordinates divide by `z_i`; here nothing does: `d_i` is the ridge solution
/// `(z e + zeta^2 d_measured) / (z^2 + zeta^2)`, which is the motion's `e / z` where the object turns and the sensor's where it
/// does not, and exact in both. The residual of an output carries the matching weight `|z| / sqrt(z^2 + zeta^2)`, up to sign.
#[derive(Clone, Debug)]
pub struct ForceDriven<const N: usize> {
    nominal: PlanarNominal,
    scale: NaturalScale,
    constants: Vec<Constant>,
    blend: f64,
    exact: bool,
}

impl<const N: usize> ForceDriven<N> {
    /// A model of `N = 5 + constants.len()` states.
    ///
    /// # Errors
    /// [`PlanarEstimateError::Constants`] when `N` does not match, [`PlanarEstimateError::Value`] for unusable numbers.
    pub fn new(
        nominal: PlanarNominal,
        scale: NaturalScale,
        constants: &[Constant],
    ) -> Result<Self, PlanarEstimateError> {
        nominal.check()?;
        let expected = N.checked_sub(MOTION).filter(|&n| n == constants.len());
        if expected.is_none() {
            let expected = N.saturating_sub(MOTION);
            return Err(PlanarEstimateError::Constants { states: N, expected, found: constants.len() });
        }
        let blend = BLEND_SHARE * scale.rate();
        Ok(Self { nominal, scale, constants: constants.to_vec(), blend, exact: false })
    }

    /// The same model with a flow that is taken as exact, for a first fit in which only the start values are free.
    #[must_use]
    pub fn without_process_noise(mut self) -> Self {
        self.exact = true;
        self
    }

    /// What is taken as known.
    #[must_use]
    pub fn nominal(&self) -> &PlanarNominal {
        &self.nominal
    }

    /// The scene's natural scale.
    #[must_use]
    pub fn scale(&self) -> NaturalScale {
        self.scale
    }

    /// Constants that are estimated, in the order of the states after the fifth.
    #[must_use]
    pub fn constants(&self) -> &[Constant] {
        &self.constants
    }

    /// Mass (kg) and moment of inertia (kg m^2) at a state.
    #[must_use]
    pub fn mass_and_inertia(&self, x: &SVector<f64, N>) -> (f64, f64) {
        (
            self.nominal.mass.mass() * self.constant(x, Constant::Mass).exp(),
            self.nominal.mass.inertia() * self.constant(x, Constant::Inertia).exp(),
        )
    }

    /// A sample: its contacts are the outputs, their noise the nominal one. Exact data count as one part in a million of
    /// the natural length, which only sets the unit of the information.
    #[must_use]
    pub fn sample(&self, input: PairInput) -> Sample<PairInput, 2> {
        let deviation = if self.nominal.contact_deviation > 0.0 {
            self.nominal.contact_deviation
        } else {
            1e-6 * self.scale.length
        };
        let measured = SVector::<f64, 2>::from(input.stages[2].contacts);
        Sample { input, measured, information: SVector::<f64, 2>::repeat(1.0 / (deviation * deviation)) }
    }

    /// A stage with readings as the constants of a state correct them.
    #[must_use]
    pub fn corrected(&self, x: &SVector<f64, N>, stage: &PairStage) -> PairStage {
        let mut stage = *stage;
        for (i, which) in [Side::First, Side::Second].into_iter().enumerate() {
            let gain = self.constant(x, Constant::ForceGain(which)).exp();
            stage.forces[i] = gain * stage.forces[i] + self.constant(x, Constant::ForceBias(which));
            stage.contacts[i] -= self.constant(x, Constant::ContactOffset(which));
        }
        stage
    }

    /// Contact offsets `d_1`, `d_2` (m) at a state.
    #[must_use]
    pub fn contact_offsets(&self, x: &SVector<f64, N>, stage: &PairStage) -> [f64; 2] {
        [0, 1].map(|palm| self.side(x, stage, palm).d)
    }

    /// Standard deviations of the contact offsets (m) for a covariance of the state.
    #[must_use]
    pub fn offset_deviations(
        &self,
        x: &SVector<f64, N>,
        stage: &PairStage,
        covariance: &SMatrix<f64, N, N>,
    ) -> [f64; 2] {
        [0, 1].map(|palm| {
            let mut slope = SVector::<f64, N>::zeros();
            slope
                .fixed_rows_mut::<MOTION>(0)
                .copy_from_slice(&self.side(x, stage, palm).d_gradient(self.blend));
            slope.dot(&(covariance * slope)).max(0.0).sqrt()
        })
    }

    /// Angular acceleration (rad/s^2) at a state.
    #[must_use]
    pub fn angular_acceleration(&self, x: &SVector<f64, N>, stage: &PairStage) -> f64 {
        self.rate(stage, x)[4]
    }

    fn constant(&self, x: &SVector<f64, N>, constant: Constant) -> f64 {
        self.constants.iter().position(|&c| c == constant).map_or(0.0, |i| x[MOTION + i])
    }

    fn side(&self, x: &SVector<f64, N>, stage: &PairStage, palm: usize) -> PalmContact {
        let which = if palm == 0 { Side::First } else { Side::Second };
        let (u, n, rate) = (stage.along[palm], stage.normals[palm], stage.rates[palm]);
        let sign = if palm == 0 { -1.0 } else { 1.0 };
        let p = u.x * x[0] + u.y * x[1];
        let e = n.x * x[2] + n.y * x[3] + sign * rate * p;
        let z = x[4] - rate;
        let reach = stage.contacts[palm] - self.constant(x, Constant::ContactOffset(which)) - p;
        let ridge = self.blend * self.blend;
        // At least the ridge, which is positive because the natural rate is.
        let denominator = z * z + ridge;
        let d = (z * e + ridge * sign * reach) / denominator;
        let measured = stage.forces[palm] * self.constant(x, Constant::ForceGain(which)).exp();
        let force = measured + self.constant(x, Constant::ForceBias(which));
        PalmContact { palm, u, n, sign, rate, z, e, denominator, d, force, measured, reach }
    }

    fn rate(&self, stage: &PairStage, x: &SVector<f64, N>) -> SVector<f64, N> {
        let (mass, inertia) = self.mass_and_inertia(x);
        let [a, b] = [0, 1].map(|palm| self.side(x, stage, palm));
        let push = a.n * a.force + b.n * b.force;
        let mut rate = SVector::zeros();
        rate[0] = x[2];
        rate[1] = x[3];
        rate[2] = push.x / mass;
        rate[3] = push.y / mass - self.nominal.gravity;
        rate[4] = -(a.force * a.d + b.force * b.d) / inertia;
        rate
    }

    fn rate_linearised(
        &self,
        stage: &PairStage,
        x: &SVector<f64, N>,
    ) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let rate = self.rate(stage, x);
        let (mass, inertia) = self.mass_and_inertia(x);
        let mut j = SMatrix::<f64, N, N>::zeros();
        (j[(0, 2)], j[(1, 3)]) = (1.0, 1.0);
        for side in [0, 1].map(|palm| self.side(x, stage, palm)) {
            let slope = side.d_gradient(self.blend);
            let torque = -side.force / inertia;
            for (k, value) in slope.into_iter().enumerate() {
                j[(4, k)] += torque * value;
            }
            for (i, constant) in self.constants.iter().enumerate() {
                let column = MOTION + i;
                let (force, offset) = side.constant_slopes(*constant, self.blend);
                j[(2, column)] += force * side.n.x / mass;
                j[(3, column)] += force * side.n.y / mass;
                j[(4, column)] += -force * side.d / inertia + torque * offset;
            }
        }
        for (i, constant) in self.constants.iter().enumerate() {
            match constant {
                Constant::Mass => {
                    j[(2, MOTION + i)] -= rate[2];
                    j[(3, MOTION + i)] -= rate[3] + self.nominal.gravity;
                }
                Constant::Inertia => j[(4, MOTION + i)] -= rate[4],
                _ => {}
            }
        }
        (rate, j)
    }
}

/// Weight of the middle of an interval in Simpson's rule: its share of the error of the mean force.
const MIDDLE_WEIGHT: f64 = 2.0 / 3.0;

/// Stage of an interval at fraction 0, 1/2 or 1.
fn at(input: &PairInput, fraction: f64) -> &PairStage {
    if fraction < 0.25 {
        &input.stages[0]
    } else if fraction < 0.75 {
        &input.stages[1]
    } else {
        &input.stages[2]
    }
}

impl<const N: usize> Model<N, 2> for ForceDriven<N> {
    type Input = PairInput;

    fn flow(&self, x: &SVector<f64, N>, input: &PairInput) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        rk4_linearised(x, input.dt, |fraction, x| self.rate_linearised(at(input, fraction), x))
    }

    fn advance(&self, x: &SVector<f64, N>, input: &PairInput) -> SVector<f64, N> {
        rk4(x, input.dt, |fraction, x| self.rate(at(input, fraction), x))
    }

    fn output(&self, x: &SVector<f64, N>, input: &PairInput) -> (SVector<f64, 2>, SMatrix<f64, 2, N>) {
        let stage = &input.stages[2];
        let (mut y, mut h) = (SVector::<f64, 2>::zeros(), SMatrix::<f64, 2, N>::zeros());
        for side in [0, 1].map(|palm| self.side(x, stage, palm)) {
            let row = side.palm;
            let root = side.denominator.sqrt();
            let residual = (side.z * side.reach - side.sign * side.e) / root;
            y[row] = stage.contacts[row] - residual;
            h[(row, 0)] = x[4] * side.u.x / root;
            h[(row, 1)] = x[4] * side.u.y / root;
            h[(row, 2)] = side.sign * side.n.x / root;
            h[(row, 3)] = side.sign * side.n.y / root;
            h[(row, 4)] = residual * side.z / side.denominator - side.reach / root;
            for (i, constant) in self.constants.iter().enumerate() {
                if matches!(constant, Constant::ContactOffset(s) if s.index() == row) {
                    h[(row, MOTION + i)] = side.z / root;
                }
            }
        }
        (y, h)
    }

    /// Noise of the forces, the error of their interpolation, and noise of the contacts as far as they enter `d`; one
    /// reading counts for one interval. Errors of interpolation count as independent, which is too much over many intervals
    /// (they are the derivative of something bounded), and matters only where they exceed the sensors' noise.
    fn process_noise(&self, x: &SVector<f64, N>, input: &PairInput) -> Option<SMatrix<f64, N, N>> {
        let PlanarNominal { contact_deviation, force_deviation, .. } = self.nominal;
        if self.exact || contact_deviation <= 0.0 && force_deviation <= 0.0 {
            return None;
        }
        // What enters during an interval acts on average from its middle on, and the flow carries it to the end.
        let half = 0.5 * input.dt;
        let middle = &input.stages[1];
        let x = x + self.rate(&input.stages[0], x) * half;
        let (_, slope) = self.rate_linearised(middle, &x);
        let (mass, inertia) = self.mass_and_inertia(&x);
        let mut q = SMatrix::<f64, N, N>::zeros();
        for side in [0, 1].map(|palm| self.side(&x, middle, palm)) {
            let interpolation = MIDDLE_WEIGHT * input.force_error[side.palm];
            let step = input.dt * force_deviation.hypot(interpolation);
            let mut kick = SVector::<f64, N>::zeros();
            kick[2] = step * side.n.x / mass;
            kick[3] = step * side.n.y / mass;
            kick[4] = -step * side.d / inertia;
            kick += slope * kick * half;
            q.ger(1.0, &kick, &kick, 1.0);
            let share = self.blend * self.blend / side.denominator;
            q[(4, 4)] += (input.dt * side.force * share * contact_deviation / inertia).powi(2);
        }
        Some(q)
    }

    fn scales(&self) -> SVector<f64, N> {
        let NaturalScale { length, gravity } = self.scale;
        let speed = self.scale.speed();
        SVector::from_fn(|i, _| match i {
            0 | 1 => length,
            2 | 3 => speed,
            4 => self.scale.rate(),
            _ => match self.constants[i - MOTION] {
                Constant::Mass | Constant::Inertia | Constant::ForceGain(_) => 1.0,
                Constant::ForceBias(_) => self.nominal.mass.mass() * gravity,
                Constant::ContactOffset(_) => length,
            },
        })
    }

    fn names(&self) -> [&'static str; N] {
        let motion = ["centre of mass x", "centre of mass y", "velocity x", "velocity y", "angular velocity"];
        std::array::from_fn(|i| motion.get(i).copied().unwrap_or_else(|| self.constants[i - MOTION].name()))
    }
}
