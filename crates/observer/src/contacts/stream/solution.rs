//! The motion at the end of a window, and whether to believe it.

use super::estimate::StreamBody;
use crate::contacts::body::{Body, CONSTANTS};
use crate::contacts::flow::Transition;
use crate::contacts::problem::Problem;
use crate::contacts::record::Record;
use crate::contacts::samples::{Deviations, at_all, deviations};
use crate::contacts::solve::{Covariances, Solved};
use crate::contacts::state::{MOTION, Motion};
use crate::contacts::suspects::{Readings, Scores, Sensors, suspects};
use crate::contacts::verdict::{ContactEvidence, UNEXPLAINED, relied_on, stretches};
use glam::DQuat;
use nalgebra::{Matrix6, SMatrix};
use object_dynamics::MassProperties;

/// What was solved.
pub(super) struct Of<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) solved: &'a Solved<CONSTANTS>,
    pub(super) covariances: Covariances<CONSTANTS>,
    /// Whether the body is another one than was stated.
    pub(super) against: bool,
    /// Whether another motion explains it as well.
    pub(super) open: bool,
    /// How far noise lasts, and what is missed between samples.
    pub(super) lasting: f64,
    pub(super) unresolved: f64,
}

/// The motion at the end of a window.
#[derive(Clone, Debug)]
pub(super) struct Solution {
    /// Number of the sample at its end, and its time, s.
    pub(super) number: usize,
    pub(super) t: f64,
    /// From the world's origin.
    pub(super) motion: Motion,
    pub(super) body: Body,
    /// Own axes of a known body in those of the motion.
    pub(super) own: DQuat,
    pub(super) known: bool,
    /// Covariance of the motion for given constants of the body, how it follows those, and their covariance.
    pub(super) covariance: Transition,
    pub(super) follows: SMatrix<f64, MOTION, CONSTANTS>,
    pub(super) of_body: SMatrix<f64, CONSTANTS, CONSTANTS>,
    pub(super) stated: StreamBody,
    pub(super) misfit: f64,
    /// What the trapezoidal rule misses of an impulse over a time, s, about the world's origin.
    pub(super) missed: (f64, Matrix6<f64>),
    /// Whether iterations came to an end, whether the data do not speak against it, and whether it is known well enough at its end.
    pub(super) settled: bool,
    pub(super) explained: bool,
    pub(super) relied_on: bool,
}

impl Of<'_> {
    /// At node `j`, from the world's origin.
    pub(super) fn motion(&self, j: usize) -> Motion {
        let motion = &self.solved.unknowns.motions[j];
        Motion { p: motion.p + self.problem.record.origin, ..*motion }
    }

    /// Whether iterations came to an end and noise explains what is left.
    pub(super) fn is_sound(&self) -> bool {
        self.solved.settled && self.evidence().is_explained() && !self.against
    }

    /// Counts what constants of the sensors that may be wrong make of motion and body; where one is wrong for sure, the data speak against them.
    pub(super) fn doubt(&mut self, record: &Record, readings: &Readings) {
        let Self { problem, solved, covariances, .. } = self;
        let motions = at_all(record, problem, &solved.unknowns, covariances);
        let sensors = Sensors::new(readings, &motions, solved.unknowns.body);
        let Some(scores) = Scores::new(&sensors, problem, solved) else { return };
        let (evidence, of) = (self.evidence(), &self.covariances);
        let (suspects, errors) = suspects(&scores, of, &evidence);
        self.covariances.errors.extend(errors);
        self.open |= ContactEvidence::against(&suspects, &[]).is_some();
    }

    fn evidence(&self) -> ContactEvidence {
        let Self { problem, solved, .. } = self;
        ContactEvidence {
            samples: problem.record.times.len(),
            nodes: problem.nodes.len(),
            conditions: solved.equations.conditions,
            misfit: solved.misfit(),
            lasting: self.lasting,
            unresolved: self.unresolved,
            rougher: [1.0; 2],
            iterations: [0, solved.iterations],
            settled: solved.settled,
        }
    }

    fn deviations(&self, j: usize) -> Deviations {
        let unknowns = &self.solved.unknowns;
        let wider = self.evidence().widening();
        deviations(&unknowns.motions[j], &unknowns.body, j, &self.covariances).map(|of| of * wider)
    }

    /// Whether the data do not speak against it, and whether it is known well enough at its end.
    fn verdict(&self) -> [bool; 2] {
        let (unknowns, last) = (&self.solved.unknowns, self.problem.nodes.len() - 1);
        let spin = |j: usize| {
            let motion = &unknowns.motions[j];
            (unknowns.body.turn(motion.q, motion.L).w, self.deviations(j))
        };
        let still = ContactEvidence::still(&(0..=last).map(spin).collect::<Vec<_>>());
        let excess = stretches(self.problem, &self.solved.equations)[last];
        let well_known = relied_on(excess, &self.deviations(last), &self.problem.units);
        let explained = self.evidence().is_explained() && !self.against && excess <= UNEXPLAINED;
        [explained, well_known && still.is_none() && !self.open]
    }

    fn stated(&self, known: Option<&MassProperties>) -> StreamBody {
        let (body, of_body) = (&self.solved.unknowns.body, &self.covariances.of_body());
        let square = self.evidence().widening().powi(2);
        match known {
            Some(mass) => StreamBody {
                mass: mass.mass(),
                mass_deviation: 0.0,
                inertia: mass.inertia(),
                inertia_covariance: Default::default(),
            },
            None => StreamBody {
                mass: body.log_mass.exp(),
                mass_deviation: body.log_mass.exp() * (of_body[(0, 0)] * square).max(0.0).sqrt(),
                inertia: body.inertia(),
                inertia_covariance: (body.inertia_covariance(of_body) * square).into(),
            },
        }
    }
}

impl Solution {
    /// `at` the sample of a number and a time, s, of a body that may be `known`.
    pub(super) fn new(
        of: &Of,
        (number, t): (usize, f64),
        known: Option<&MassProperties>,
        missed: (f64, Matrix6<f64>),
    ) -> Self {
        let last = of.problem.nodes.len() - 1;
        let (body, square) = (of.solved.unknowns.body, of.evidence().widening().powi(2));
        let (covariance, follows, of_body) = of.covariances.folded(last);
        let [explained, relied_on] = of.verdict();
        Self {
            number,
            t,
            motion: of.motion(last),
            body,
            own: known.map_or(DQuat::IDENTITY, |mass| body.orientation(mass)),
            known: known.is_some(),
            covariance: covariance * square,
            follows,
            of_body: of_body * square,
            stated: of.stated(known),
            misfit: of.solved.misfit(),
            missed,
            settled: of.solved.settled,
            explained,
            relied_on,
        }
    }
}
