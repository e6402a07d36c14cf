use super::events::ContactEventKind;
use super::state::BodyState;
use crate::ContactMode;
use crate::integrate::Statistics;
use contact_kinematics::planar::{SurfaceContact, SurfaceState};
use glam::DVec2;

/// Everything about a body and its contacts at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInstant {
    /// Time in s.
    pub t: f64,
    /// The body.
    pub body: BodyState,
    /// What each contact does.
    pub modes: Vec<ContactMode>,
    /// Pose and motion of each palm.
    pub palms: Vec<SurfaceState>,
    /// Where each palm touches, or is nearest.
    pub contacts: Vec<SurfaceContact>,
    /// Force of each palm on the body, world, N.
    pub forces: Vec<DVec2>,
    /// Integral of each force since the start, blows included, N s.
    pub impulses: Vec<DVec2>,
    /// Acceleration of the centre of mass, world, m/s^2.
    pub a_WCm: DVec2,
    /// Angular acceleration, rad/s^2.
    pub alpha0: f64,
    /// Work since the start that friction has done on the slip, J: not above zero.
    pub friction_work: f64,
    /// Work since the start that the palms' motion has done on the body, blows included, J.
    pub palm_work: f64,
    /// Energy that blows have taken since the start, J: not above zero.
    pub blow_work: f64,
}

impl ContactInstant {
    /// Velocity of the body against palm `palm` (from 0) at the contact, m/s. Without gap rate: the slip.
    #[must_use]
    pub fn slip(&self, palm: usize) -> DVec2 {
        self.contacts[palm].slip(&self.palms[palm], self.body.v_WCm, self.body.omega0)
    }
}

/// A change of modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEvent {
    /// When, s.
    pub t: f64,
    /// At which palm, from 0; none where it is not one palm's.
    pub palm: Option<usize>,
    /// What.
    pub kind: ContactEventKind,
    /// Modes of all contacts after it.
    pub modes: Vec<ContactMode>,
    /// Energy that a blow has taken, J; none where there was none.
    pub blow_work: Option<f64>,
}

/// A simulated motion through contact modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactSimulation {
    /// One for each sample time.
    pub instants: Vec<ContactInstant>,
    /// The changes of modes, in time order.
    pub events: Vec<ContactEvent>,
    /// Work of the integrator.
    pub statistics: Statistics,
}
