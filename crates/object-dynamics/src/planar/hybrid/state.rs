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

/// Body state, work of the palms, work of friction (J), and time (s), which lets a projection know when it is.
pub(super) type Vector = [f64; 9];
pub(super) const PALM_WORK: usize = 6;
pub(super) const FRICTION_WORK: usize = 7;
pub(super) const TIME: usize = 8;

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
