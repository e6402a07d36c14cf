//! What is known of a log's first samples from an estimate that was made when it was shorter.

use super::body::Body;
use super::estimate::ContactEstimate;
use super::plane;
use super::problem::Problem;
use super::state::Motion;
use glam::{DMat3, DVec3};
use object_dynamics::BodyState;

/// Motion of a body at the first samples of a log, to go on from: where one is looked for from nothing, that of a long log takes long and is not always found.
#[derive(Clone, Debug)]
pub struct Beginning {
    /// Motion at the first samples.
    states: Vec<BodyState>,
    /// Mass (kg) and inertia about the centre of mass in axes of the body, kg m^2.
    mass: f64,
    inertia: DMat3,
}

impl Beginning {
    /// Of motions at the first samples of a body of the mass `mass` (kg) and the inertia `inertia` about its centre of mass, kg m^2, axes of the body.
    pub(crate) fn new(states: Vec<BodyState>, mass: f64, inertia: DMat3) -> Self {
        Self { states, mass, inertia }
    }

    /// How many samples it is of.
    pub(super) fn samples(&self) -> usize {
        self.states.len()
    }

    /// The body, in axes that are those of the world at the first sample.
    pub(super) fn body(&self, problem: &Problem) -> Body {
        let R = self.states.first().map_or(DMat3::IDENTITY, |first| DMat3::from_quat(first.R_WO));
        let free = Body::free(self.mass.ln(), R * self.inertia * R.transpose());
        if problem.planar { plane::ball(&free) } else { free }
    }

    /// Of that body at sample `k` of the log, positions from `origin`; none where it is not known.
    pub(super) fn motion(&self, k: usize, origin: DVec3, body: &Body) -> Option<Motion> {
        let (state, first) = (self.states.get(k)?, self.states.first()?);
        let q = (state.R_WO * first.R_WO.conjugate()).normalize();
        let L = body.inertia_along(DMat3::from_quat(q)) * state.w_WO;
        Some(Motion { p: state.p_WCm - origin, v: state.v_WCm, L, q })
    }
}

impl ContactEstimate {
    /// What it tells of a log that goes on after its last sample; none where it is not to be relied on.
    #[must_use]
    pub fn beginning(&self) -> Option<Beginning> {
        let known = || Beginning::new(self.states.clone(), self.mass, self.inertia);
        self.reliability.is_reliable().then(known)
    }
}
