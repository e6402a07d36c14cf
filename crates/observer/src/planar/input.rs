//! From a log to what drives the flow: palms, forces and contacts at the ends and in the middle of each interval.

use super::error::PlanarEstimateError;
use super::polynomial::{Fit, Row, curvatures, interpolate, value};
use contact_kinematics::planar::PalmPair;
use glam::DVec2;
use object_dynamics::planar::{PlanarLog, PlanarSample};

/// Samples that a polynomial is laid through at most, half of them on either side of an interval once they are there. Four would
/// match the order of the integrator, `h^4`. At 100 Hz, where the contacts of a 50 mm object change by a third of a radian of
/// their fastest harmonic in one interval, six leave an error of the forces that is seen beside contact noise of 0.1 mm.
const NODES: usize = 10;

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
    /// Error of the forces in the middle, N, as interpolation of exact readings leaves it.
    pub force_error: [f64; 2],
}

/// Turns samples into inputs as they come. The first ones wait until the polynomial has all its samples; after that each
/// sample yields the input of the interval that it ends, and with it, better than before, those of the intervals before it
/// that have not yet as many samples behind them as in front.
#[derive(Clone, Debug, Default)]
pub struct InputBuilder {
    rows: Vec<Row>,
    /// Motor torques of the rows, where forces follow from them.
    torques: Vec<Option<[f64; 2]>>,
    palm_inertias: [f64; 2],
    force_deviation: f64,
    started: bool,
}

impl InputBuilder {
    /// Samples behind an interval from which on its input does not change any more.
    pub const LAG: usize = NODES / 2 - 1;

    /// A builder that takes forces from the log, or from torques with massless palms.
    #[must_use]
    pub fn new() -> Self {
        let (rows, torques) = (Vec::with_capacity(NODES + 1), Vec::with_capacity(NODES + 1));
        Self { rows, torques, ..Self::default() }
    }

    /// Palms with moments of inertia (kg m^2): `f_1 = (tau_1 - I_1 A_1) / s_1`, `f_2 = (I_2 A_2 - tau_2) / s_2`, with the
    /// accelerations of the polynomial through the palms' angles.
    #[must_use]
    pub fn with_palm_inertias(mut self, inertias: [f64; 2]) -> Self {
        self.palm_inertias = inertias;
        self
    }

    /// Force readings with noise of this standard deviation (N): the polynomial takes no more of them than tell more than noise.
    #[must_use]
    pub fn with_force_deviation(mut self, deviation: f64) -> Self {
        self.force_deviation = deviation;
        self
    }

    /// Takes a sample and hands on the inputs that are complete, in the order of time. An input whose time has been seen
    /// takes the place of the earlier one; [`place`](Self::place) does that.
    ///
    /// # Errors
    /// [`PlanarEstimateError`]: lost contact, no forces, no lever arm, time that does not increase, a closed wedge.
    pub fn push(
        &mut self,
        sample: &PlanarSample,
        mut sink: impl FnMut(PairInput),
    ) -> Result<(), PlanarEstimateError> {
        if self.take(sample)? {
            let first = if self.started { NODES / 2 } else { 0 };
            self.started = true;
            self.inputs(first..NODES, &mut sink)?;
        }
        Ok(())
    }

    /// Takes a sample; whether the polynomial has all its rows.
    fn take(&mut self, sample: &PlanarSample) -> Result<bool, PlanarEstimateError> {
        let row = self.row(sample)?;
        if self.rows.len() == NODES {
            self.rows.remove(0);
            self.torques.remove(0);
        }
        self.rows.push(row);
        self.torques.push(if sample.forces.is_some() { None } else { sample.torques });
        Ok(self.rows.len() == NODES)
    }

    /// Inputs of the intervals that end at the rows `ends`.
    fn inputs(
        &mut self,
        ends: std::ops::Range<usize>,
        sink: &mut impl FnMut(PairInput),
    ) -> Result<(), PlanarEstimateError> {
        self.forces_of_torques()?;
        let fits = [2, 3].map(|i| Fit::new(&self.rows, i, self.force_deviation));
        let mut start = self.stage(self.rows[ends.start.saturating_sub(1)].t)?;
        for end in ends {
            let input = self.interval(start, end, &fits)?;
            start = input.stages[2];
            sink(input);
        }
        Ok(())
    }

    /// Puts an input into a list in the order of time: in the place of the one with the same time, or at the end.
    pub fn place(inputs: &mut Vec<PairInput>, input: PairInput) {
        match inputs.iter_mut().rev().take(NODES).find(|old| old.t == input.t) {
            Some(old) => *old = input,
            None => inputs.push(input),
        }
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
        // Refused at once rather than when the polynomial is complete.
        let [p1, p2] = sample.palms().map_err(|source| PlanarEstimateError::Palms { t, source })?.angles();
        let forces = match (sample.forces, sample.torques) {
            (Some(f), _) => f,
            (None, Some(torques)) => force_of_torque(t, torques, [0.0; 2], s)?,
            (None, None) => return Err(PlanarEstimateError::NoForces { t }),
        };
        Ok(Row { t, values: [p1, p2, forces[0], forces[1], s[0], s[1]] })
    }

    /// Forces of all rows with torques, with the palms' accelerations as the present polynomial has them.
    fn forces_of_torques(&mut self) -> Result<(), PlanarEstimateError> {
        if self.palm_inertias == [0.0; 2] {
            return Ok(());
        }
        for k in 0..self.rows.len() {
            let Some(torques) = self.torques[k] else { continue };
            let Row { t, values } = self.rows[k];
            let [a, b] = curvatures(&self.rows, t);
            let inertial = [self.palm_inertias[0] * a, self.palm_inertias[1] * b];
            let forces = force_of_torque(t, torques, inertial, [values[4], values[5]])?;
            self.rows[k].values[2..4].copy_from_slice(&forces);
        }
        Ok(())
    }

    /// The interval that ends at row `end` and begins with `first`; of no length for row 0.
    fn interval(
        &self,
        first: PairStage,
        end: usize,
        fits: &[Fit; 2],
    ) -> Result<PairInput, PlanarEstimateError> {
        let t = self.rows[end].t;
        if end == 0 {
            return Ok(PairInput { t, dt: 0.0, stages: [first; 3], force_error: [0.0; 2] });
        }
        let start_t = self.rows[end - 1].t;
        let middle_t = 0.5 * (start_t + t);
        let mut middle = self.stage(middle_t)?;
        let mut force_error = [0.0; 2];
        for (i, fit) in fits.iter().enumerate() {
            let rows = fit.rows(&self.rows, end);
            middle.forces[i] = value(rows, 2 + i, middle_t);
            force_error[i] = fit.error(rows, middle_t);
        }
        let stages = [first, middle, self.stage(t)?];
        Ok(PairInput { t, dt: t - start_t, stages, force_error })
    }

    /// Polynomial through the rows at time `t`.
    fn stage(&self, t: f64) -> Result<PairStage, PlanarEstimateError> {
        let (value, slope) = interpolate(&self.rows, t);
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
}

/// Contact forces of motor torques, less what moves the palms themselves.
fn force_of_torque(
    t: f64,
    torques: [f64; 2],
    inertial: [f64; 2],
    s: [f64; 2],
) -> Result<[f64; 2], PlanarEstimateError> {
    let mut forces = [0.0; 2];
    for i in 0..2 {
        let lever = if i == 0 { s[0] } else { -s[1] };
        forces[i] = (torques[i] - inertial[i]) / lever;
        if !forces[i].is_finite() {
            return Err(PlanarEstimateError::NoLever { palm: i + 1, t, distance: s[i] });
        }
    }
    Ok(forces)
}

/// Inputs of a whole log, each as good as the samples on both sides of it make it: a filter that is fed with them as they
/// come runs [`InputBuilder::LAG`] samples late.
///
/// # Errors
/// As [`InputBuilder::push`]; [`crate::ObserverError::TooFewSamples`] for fewer samples than the polynomial needs.
pub fn planar_samples(log: &PlanarLog, force_deviation: f64) -> Result<Vec<PairInput>, PlanarEstimateError> {
    let mut inputs = Vec::with_capacity(log.samples().len());
    let mut builder = InputBuilder::new().with_force_deviation(force_deviation);
    for sample in log.samples() {
        if builder.take(sample)? {
            // Each interval once, when as many samples have come after it as before; those near the ends as they are.
            let first = if inputs.is_empty() { 0 } else { NODES / 2 };
            builder.inputs(first..NODES / 2 + 1, &mut |input| inputs.push(input))?;
        }
    }
    if !inputs.is_empty() {
        builder.inputs(NODES / 2 + 1..NODES, &mut |input| inputs.push(input))?;
    }
    if inputs.is_empty() {
        let found = log.samples().len();
        return Err(crate::ObserverError::TooFewSamples { found, needed: NODES }.into());
    }
    Ok(inputs)
}
