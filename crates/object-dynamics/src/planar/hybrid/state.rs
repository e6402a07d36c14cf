use crate::MOST_PALMS;
use crate::planar::log::PlanarTruth;
use contact_kinematics::planar::BodyPlace;
use glam::DVec2;

/// State of a planar body: nothing in it knows of palms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyState {
    /// Centre of mass, world, m.
    pub p_WCm: DVec2,
    /// Orientation, rad.
    pub phi0: f64,
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec2,
    /// Angular velocity, rad/s.
    pub omega0: f64,
}

/// Length of [`Vector`].
pub(super) const LENGTH: usize = IMPULSES + 2 * MOST_PALMS;
/// Body state, work of the palms and of friction (J), time (s), which lets a projection know when it is, and the integrals of
/// the palms' forces (N s).
pub(super) type Vector = [f64; LENGTH];
pub(super) const PALM_WORK: usize = 6;
pub(super) const FRICTION_WORK: usize = 7;
pub(super) const TIME: usize = 8;
const IMPULSES: usize = 9;

/// Adds `change` to the impulse of palm `palm` in `y`.
pub(super) fn add_impulse(y: &mut Vector, palm: usize, change: DVec2) {
    y[IMPULSES + 2 * palm] += change.x;
    y[IMPULSES + 2 * palm + 1] += change.y;
}

/// Impulse of palm `palm`.
pub(super) fn impulse(y: &Vector, palm: usize) -> DVec2 {
    DVec2::new(y[IMPULSES + 2 * palm], y[IMPULSES + 2 * palm + 1])
}

impl BodyState {
    /// Where the body is.
    #[must_use]
    pub fn place(&self) -> BodyPlace {
        BodyPlace { p_WCm: self.p_WCm, phi0: self.phi0 }
    }

    pub(super) fn of(y: &Vector) -> Self {
        Self { p_WCm: DVec2::new(y[0], y[1]), phi0: y[2], v_WCm: DVec2::new(y[3], y[4]), omega0: y[5] }
    }

    pub(super) fn write(&self, y: &mut Vector) {
        let Self { p_WCm: p, phi0, v_WCm: v, omega0 } = *self;
        y[..6].copy_from_slice(&[p.x, p.y, phi0, v.x, v.y, omega0]);
    }

    pub(super) fn is_finite(&self) -> bool {
        self.p_WCm.is_finite() && self.phi0.is_finite() && self.v_WCm.is_finite() && self.omega0.is_finite()
    }
}

impl From<BodyState> for PlanarTruth {
    fn from(state: BodyState) -> Self {
        let BodyState { p_WCm, phi0, v_WCm, omega0 } = state;
        Self { p_WCm, phi0, v_WCm, omega0 }
    }
}
