use crate::ContactMode;
use crate::contacts::SceneState;
use crate::integrate::Statistics;
use contact_kinematics::{SurfaceContact, SurfaceRates, SurfaceState};
use glam::DVec3;

/// Everything about a body and its contacts at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactInstant {
    /// Body and palms.
    pub state: SceneState,
    /// What each contact does.
    pub modes: Vec<ContactMode>,
    /// Pose and motion of each palm. The acceleration of one that gives way is that without contact force.
    pub palms: Vec<SurfaceState>,
    /// Where each palm touches, or is nearest.
    pub contacts: Vec<SurfaceContact>,
    /// How each contact moves.
    pub rates: Vec<SurfaceRates>,
    /// Force of each palm on the body, world, N.
    pub forces: Vec<DVec3>,
    /// Integral of each force since the start, blows included, N s.
    pub impulses: Vec<DVec3>,
    /// Acceleration of the centre of mass, world, m/s^2.
    pub a_WCm: DVec3,
    /// Angular acceleration, world axes, rad/s^2.
    pub alpha_WO: DVec3,
    /// Work since the start that friction has done on the slip, J: not above zero.
    pub friction_work: f64,
    /// Work since the start that the palms' motion has done on the body, J.
    pub palm_work: f64,
    /// Energy that blows have taken since the start, J: not above zero for palms at rest.
    pub blow_work: f64,
}

/// What has changed at a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactEventKind {
    /// The body has come to touch the palm: a blow.
    Touches,
    /// Its normal force has fallen to zero.
    Lifts,
    /// Its slip has come to an end.
    SlipEnds,
    /// Its force has reached the edge of the friction cone.
    ConeLeft,
}

/// A change of modes.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEvent {
    /// When, s.
    pub t: f64,
    /// At which palm, from 0.
    pub palm: usize,
    /// What.
    pub kind: ContactEventKind,
    /// Modes of all contacts after it.
    pub modes: Vec<ContactMode>,
}

/// A simulated motion through contact modes.
#[derive(Clone, Debug)]
pub struct ContactSimulation {
    /// One for each sample time.
    pub instants: Vec<ContactInstant>,
    /// The changes of modes, in time order.
    pub events: Vec<ContactEvent>,
    /// Work of the integrator.
    pub statistics: Statistics,
}
