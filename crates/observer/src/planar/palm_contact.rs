//! One palm's contact at a state: its offset `d` and how that depends on the state.

use super::constants::Constant;
use super::force_driven::MOTION;
use glam::DVec2;

/// One palm at one instant: `d`, its gradient, and what the output needs.
pub(super) struct PalmContact {
    pub(super) palm: usize,
    pub(super) u: DVec2,
    pub(super) n: DVec2,
    pub(super) sign: f64,
    pub(super) rate: f64,
    pub(super) z: f64,
    pub(super) e: f64,
    pub(super) denominator: f64,
    pub(super) d: f64,
    pub(super) force: f64,
    /// Force without its bias.
    pub(super) measured: f64,
    /// Contact reading without its offset, minus `u . cm`.
    pub(super) reach: f64,
}

impl PalmContact {
    /// Derivative of `d` with respect to `(cm, v, omega0)`.
    pub(super) fn d_gradient(&self, blend: f64) -> [f64; MOTION] {
        let along = self.sign * (self.z * self.rate - blend * blend) / self.denominator;
        let across = self.z / self.denominator;
        [
            along * self.u.x,
            along * self.u.y,
            across * self.n.x,
            across * self.n.y,
            (self.e - 2.0 * self.z * self.d) / self.denominator,
        ]
    }

    /// Derivatives of this palm's force and of its `d` with respect to a constant.
    pub(super) fn constant_slopes(&self, constant: Constant, blend: f64) -> (f64, f64) {
        match constant {
            Constant::ForceGain(side) if side.index() == self.palm => (self.measured, 0.0),
            Constant::ForceBias(side) if side.index() == self.palm => (1.0, 0.0),
            Constant::ContactOffset(side) if side.index() == self.palm => {
                (0.0, -self.sign * blend * blend / self.denominator)
            }
            _ => (0.0, 0.0),
        }
    }
}
