//! How far runs from starts that differ a little come apart.

use super::log::{Anything, Log};
use super::simulate;
use glam::{DQuat, DVec3};
use nalgebra::SMatrix;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{BodyState, ContactScene, ContactSimulation};

/// Change of the start in natural units: small, and far above the tolerance.
const CHANGE: f64 = 1e-5;

/// Natural units of a log's body: its mean semi-axis (m) and the root of gravity over it (1/s).
#[derive(Clone, Copy)]
pub(super) struct Natural {
    pub(super) length: f64,
    pub(super) rate: f64,
}

impl Natural {
    pub(super) fn of(log: &Log) -> Self {
        let length = log.semi_axes().element_sum() / 3.0;
        Self { length, rate: (log.gravity() / length).sqrt() }
    }

    /// Difference of two states: place, orientation, velocity, angular velocity.
    fn difference(&self, a: &BodyState, b: &BodyState) -> [f64; 12] {
        let turn = (a.R_WO * b.R_WO.conjugate()).to_scaled_axis();
        let parts = [
            (a.p_WCm - b.p_WCm) / self.length,
            turn,
            (a.v_WCm - b.v_WCm) / (self.length * self.rate),
            (a.w_WO - b.w_WO) / self.rate,
        ];
        std::array::from_fn(|k| parts[k / 3][k % 3])
    }

    /// How far two bodies are apart, m: a turn counts by the mean semi-axis.
    pub(super) fn apart(&self, a: &BodyState, b: &BodyState) -> f64 {
        self.difference(a, b)[..6].iter().map(|x| x * x).sum::<f64>().sqrt() * self.length
    }

    /// A body moved by a small step along one of the twelve directions.
    fn moved(&self, body: &BodyState, direction: usize) -> BodyState {
        let mut step = DVec3::ZERO;
        step[direction % 3] = CHANGE;
        let mut moved = *body;
        match direction / 3 {
            0 => moved.p_WCm += self.length * step,
            1 => moved.R_WO = DQuat::from_scaled_axis(step) * body.R_WO,
            2 => moved.v_WCm += self.length * self.rate * step,
            _ => moved.w_WO += self.rate * step,
        }
        moved
    }
}

/// The largest growth until each sample of a change of the start that the contacts allow: of the place, and of the velocity.
///
/// Runs from the start moved along each of twelve directions (pulled back onto the contacts as every start is) make the columns of a
/// matrix; its largest singular value is the growth of the worst of all changes.
pub(super) fn growths<S: SupportFunction>(
    log: &Log,
    scene: &ContactScene<S>,
    base: &ContactSimulation,
    (seconds, tolerance): (f64, f64),
) -> Anything<Vec<[f64; 2]>> {
    let (natural, start) = (Natural::of(log), log.body(0)?);
    let runs =
        (0..12).map(|direction| simulate(log, scene, natural.moved(&start, direction), seconds, tolerance));
    let runs = runs.collect::<Anything<Vec<_>>>()?;
    let mut largest = [0.0_f64; 2];
    let each = base.instants.iter().enumerate().map(|(k, now)| {
        let mut columns = SMatrix::<f64, 12, 12>::zeros();
        for (j, run) in runs.iter().enumerate() {
            let change = natural.difference(&run.instants[k].state.body, &now.state.body);
            columns.set_column(j, &SMatrix::from(change.map(|x| x / CHANGE)));
        }
        for (part, largest) in largest.iter_mut().enumerate() {
            let rows: SMatrix<f64, 6, 12> = columns.fixed_rows::<6>(6 * part).into();
            *largest = largest.max(rows.singular_values().max());
        }
        largest
    });
    Ok(each.collect())
}
