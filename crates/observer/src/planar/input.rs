//! From a log to what drives the flow: palms, forces and contacts at the ends and in the middle of each interval.

use super::error::PlanarEstimateError;
use contact_kinematics::planar::PalmPair;
use glam::DVec2;
use object_dynamics::planar::{PlanarLog, PlanarSample};

/// Samples that a polynomial is laid through. Four would match the order of the integrator, `h^4`; six keep the
/// interpolation's share of the error small at 100 Hz too, where the contacts of a 50 mm object change by a third of a
/// radian of their fastest harmonic in one interval.
const NODES: usize = 6;

/// Palms and readings at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairStage {
    /// Unit vectors along the palms.
    pub along: [DVec2; 2],
    /// Unit normals of the palms, towards the object.
    pub normals: [DVec2; 2],
    /// Absolute palm rates, rad/s.
    pub rates: [f64; 2],
    /// Contact forces, N.
    pub forces: [f64; 2],
    /// Contact readings, m.
    pub contacts: [f64; 2],
}

/// What drives the flow over one interval: its start, middle and end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairInput {
    /// Time at the end, s.
    pub t: f64,
    /// Length of the interval, s; zero for the first sample.
    pub dt: f64,
    /// Start, middle and end.
    pub stages: [PairStage; 3],
    /// How much the interpolated forces in the middle change when the oldest sample is left out, N.
    pub force_change: [f64; 2],
    /// Error of these forces for exact readings, N: the change above times its ratio to the change before it, as in a
    /// geometric series.
    pub force_error: [f64; 2],
}

/// Readings of one sample in the order that is interpolated: `P1, P2, f1, f2, s1, s2`.
#[derive(Clone, Copy, Debug)]
struct Row {
    t: f64,
    values: [f64; 6],
}

/// Turns samples into inputs as they come. The first five wait for the sixth, so that the polynomial through six samples
/// covers them too; after that each sample yields its input at once.
#[derive(Clone, Debug, Default)]
pub struct InputBuilder {
    rows: Vec<Row>,
    palm_inertias: [f64; 2],
    before: Option<PairStage>,
}

impl InputBuilder {
    /// A builder that takes forces from the log, or from torques with massless palms.
    #[must_use]
    pub fn new() -> Self {
        Self { rows: Vec::with_capacity(NODES + 1), ..Self::default() }
    }

    /// Palms with moments of inertia (kg m^2): `f_1 = (tau_1 - I_1 A_1) / s_1`, `f_2 = (I_2 A_2 - tau_2) / s_2`. The
    /// palms' accelerations come from the differences of three angles, hence of first order where they change.
    #[must_use]
    pub fn with_palm_inertias(mut self, inertias: [f64; 2]) -> Self {
        self.palm_inertias = inertias;
        self
    }

    /// Takes a sample and hands on the inputs that are complete.
    ///
    /// # Errors
    /// [`PlanarEstimateError`]: lost contact, no forces, no lever arm, time that does not increase, a closed wedge.
    pub fn push(
        &mut self,
        sample: &PlanarSample,
        mut sink: impl FnMut(PairInput),
    ) -> Result<(), PlanarEstimateError> {
        let row = self.row(sample)?;
        if self.rows.len() == NODES {
            self.rows.remove(0);
        }
        self.rows.push(row);
        if self.rows.len() < NODES {
            return Ok(());
        }
        let first_time = self.before.is_none();
        for end in if first_time { 0..NODES } else { NODES - 1..NODES } {
            sink(self.interval(end)?);
        }
        Ok(())
    }

    fn row(&self, sample: &PlanarSample) -> Result<Row, PlanarEstimateError> {
        let t = sample.t;
        if let Some(last) = self.rows.last()
            && t.partial_cmp(&last.t) != Some(std::cmp::Ordering::Greater)
        {
            return Err(PlanarEstimateError::Time { t, previous: last.t });
        }
        let mut s = [0.0; 2];
        for (i, contact) in sample.contacts.iter().enumerate() {
            s[i] = contact.ok_or(PlanarEstimateError::LostContact { palm: i + 1, t })?;
        }
        let angles = [sample.angles[0], sample.angles[0] + sample.angles[1]];
        let forces = match (sample.forces, sample.torques) {
            (Some(f), _) => f,
            (None, Some(torques)) => self.forces_of_torques(t, angles, torques, s)?,
            (None, None) => return Err(PlanarEstimateError::NoForces { t }),
        };
        Ok(Row { t, values: [angles[0], angles[1], forces[0], forces[1], s[0], s[1]] })
    }

    fn forces_of_torques(
        &self,
        t: f64,
        angles: [f64; 2],
        torques: [f64; 2],
        s: [f64; 2],
    ) -> Result<[f64; 2], PlanarEstimateError> {
        let mut forces = [0.0; 2];
        for i in 0..2 {
            let inertial = self.palm_inertias[i] * self.acceleration(t, angles, i);
            let lever = if i == 0 { s[0] } else { -s[1] };
            forces[i] = (torques[i] - inertial) / lever;
            if !forces[i].is_finite() {
                return Err(PlanarEstimateError::NoLever { palm: i + 1, t, distance: s[i] });
            }
        }
        Ok(forces)
    }

    fn acceleration(&self, t: f64, angles: [f64; 2], palm: usize) -> f64 {
        let [.., a, b] = self.rows.as_slice() else { return 0.0 };
        let (early, late) = (b.t - a.t, t - b.t);
        let rise = (angles[palm] - b.values[palm]) / late - (b.values[palm] - a.values[palm]) / early;
        rise / (0.5 * (early + late))
    }

    /// The interval that ends at row `end`; of no length for row 0.
    fn interval(&mut self, end: usize) -> Result<PairInput, PlanarEstimateError> {
        let t = self.rows[end].t;
        let last = self.stage(t)?;
        let start_t = if end == 0 { t } else { self.rows[end - 1].t };
        let first = match self.before {
            Some(stage) if end > 0 => stage,
            _ => last,
        };
        let middle = if end == 0 { last } else { self.stage(0.5 * (start_t + t))? };
        self.before = Some(last);
        let middle_t = 0.5 * (start_t + t);
        let changes = [2, 3].map(|i| if end == 0 { [0.0; 2] } else { self.changes(i, middle_t) });
        let force_change = changes.map(|[last, _]| last);
        let force_error =
            changes.map(|[last, before]| if before > last { last * last / before } else { last });
        Ok(PairInput { t, dt: t - start_t, stages: [first, middle, last], force_change, force_error })
    }

    /// Changes of the interpolated value `i` at `t` when the oldest row is left out, and when the next one is too: by
    /// Newton's form, the highest divided difference times the distances to the other rows.
    fn changes(&self, i: usize, t: f64) -> [f64; 2] {
        [0, 1].map(|oldest| {
            let rows = &self.rows[oldest..];
            let spread =
                |own: f64| -> f64 { rows.iter().filter(|row| row.t != own).map(|row| own - row.t).product() };
            let difference: f64 = rows.iter().map(|row| row.values[i] / spread(row.t)).sum();
            let reach: f64 = rows[1..].iter().map(|row| t - row.t).product();
            (difference * reach).abs()
        })
    }

    /// Polynomial through the rows, values and (for the palms) rates, at time `t`.
    fn stage(&self, t: f64) -> Result<PairStage, PlanarEstimateError> {
        let (mut value, mut slope) = ([0.0; 6], [0.0; 2]);
        for (k, row) in self.rows.iter().enumerate() {
            let (weight, rise) = self.lagrange(k, t);
            for (sum, v) in value.iter_mut().zip(row.values) {
                *sum += weight * v;
            }
            // Angles relative to the first row: the weights of a slope add up to zero, and large angles would cancel.
            for (i, sum) in slope.iter_mut().enumerate() {
                *sum += rise * (row.values[i] - self.rows[0].values[i]);
            }
        }
        let pair = PalmPair::from_absolute(value[0], value[1])
            .map_err(|source| PlanarEstimateError::Palms { t, source })?;
        Ok(PairStage {
            along: pair.along(),
            normals: pair.normals(),
            rates: slope,
            forces: [value[2], value[3]],
            contacts: [value[4], value[5]],
        })
    }

    /// Lagrange polynomial of row `k` and its derivative at `t`.
    fn lagrange(&self, k: usize, t: f64) -> (f64, f64) {
        let own = self.rows[k].t;
        let (mut weight, mut rise) = (1.0, 0.0);
        for (j, row) in self.rows.iter().enumerate().filter(|&(j, _)| j != k) {
            let step = own - row.t;
            let others: f64 = self
                .rows
                .iter()
                .enumerate()
                .filter(|&(i, _)| i != k && i != j)
                .map(|(_, other)| (t - other.t) / (own - other.t))
                .product();
            weight *= (t - row.t) / step;
            rise += others / step;
        }
        (weight, rise)
    }
}

/// Inputs of a whole log.
///
/// # Errors
/// As [`InputBuilder::push`]; [`crate::ObserverError::TooFewSamples`] for fewer than six samples.
pub fn planar_samples(log: &PlanarLog) -> Result<Vec<PairInput>, PlanarEstimateError> {
    let mut inputs = Vec::with_capacity(log.samples().len());
    let mut builder = InputBuilder::new();
    for sample in log.samples() {
        builder.push(sample, |input| inputs.push(input))?;
    }
    if inputs.is_empty() {
        let found = log.samples().len();
        return Err(crate::ObserverError::TooFewSamples { found, needed: NODES }.into());
    }
    Ok(inputs)
}
