//! The paper's equations (10) and (14) to (24): what palm sensors and the motion say of the contact curves.
//!
//! All are in chart-free form. The paper writes (3), (16), (19), (20) and (22) in spherical coordinates, which divide
//! by `cos theta_2`; there `r_dot = beta . n_dot` takes the place of (16) with (22), and nothing is divided.

use crate::{Direction, PalmFrame, PalmState, PalmTriple};
use glam::{DMat3, DVec3};

/// Contact point of a body in the tangent axes of the palm that it touches, in m.
///
/// The paper's contact support function `(r, d, e)`, with the palm's axes in place of the chart's: `beta = r n_O +
/// d R_WO' t1 + e R_WO' t2`, `n_O = -R_WO' n`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactSupport {
    /// Along the outward normal: the radius function.
    pub r: f64,
    /// Along the palm's `t1`.
    pub d: f64,
    /// Along the palm's `t2`.
    pub e: f64,
}

impl ContactSupport {
    /// Of three contacts, from the radius function values at them (paper, (17) and (18)).
    ///
    /// The paper's 6 x 6 system (18) is the 3 x 3 system `n_i . p_WCm = r_i` in disguise: its determinant is that of
    /// the normals up to sign. `p_WC` are the contact points in the world, in m.
    #[must_use]
    pub fn from_radii(
        palms: &PalmTriple,
        frames: &[PalmFrame; 3],
        r: [f64; 3],
        p_WC: &[DVec3; 3],
    ) -> [Self; 3] {
        let p_WCm = palms.solve(DVec3::from_array(r));
        std::array::from_fn(|i| {
            let b = p_WC[i] - p_WCm;
            Self { r: r[i], d: frames[i].t1.dot(b), e: frames[i].t2.dot(b) }
        })
    }

    /// The contact point from the centre of mass, world axes, in m.
    #[must_use]
    pub fn arm(&self, frame: &PalmFrame) -> DVec3 {
        self.d * frame.t1 + self.e * frame.t2 - self.r * frame.n
    }
}

/// Outward normal of the body at its contact with a palm, body axes (paper, (10)).
#[must_use]
pub fn body_normal(R_WO: DMat3, n: DVec3) -> Direction {
    Direction::new_unchecked(R_WO.transpose() * -n)
}

/// Rate of [`body_normal`], 1/s, body axes (paper, (21)).
#[must_use]
pub fn body_normal_rate(R_WO: DMat3, palm: &PalmState, w_WO: DVec3) -> DVec3 {
    R_WO.transpose() * (w_WO - palm.omega()).cross(palm.frame.n)
}

/// Rate of the radius function along a contact curve, m/s: `r_dot = beta . n_dot` (paper, (16) without its chart).
///
/// It follows from `r = beta . n` and `beta_dot . n = 0`. Both arguments are in the same axes.
#[must_use]
pub fn radius_rate(beta: DVec3, n_dot: DVec3) -> f64 {
    beta.dot(n_dot)
}

/// Velocity of the contact point in the world, m/s, from sensor coordinates and their rates.
#[must_use]
pub fn contact_velocity(palm: &PalmState, s: [f64; 2], s_dot: [f64; 2]) -> DVec3 {
    palm.frame.contact_from_sensor(s_dot) + palm.omega().cross(palm.frame.contact_from_sensor(s))
}

/// The paper's matrix `Q` of (14): entry `(j, i)` is `n_j . (c_i' - c_j' - w x (c_i - c_j))`, m/s.
#[must_use]
pub fn separation_rates(
    normals: &[DVec3; 3],
    p_WC: &[DVec3; 3],
    p_dot_WC: &[DVec3; 3],
    w_WO: DVec3,
) -> DMat3 {
    let column = |i: usize| {
        let entry = |j: usize| normals[j].dot(p_dot_WC[i] - p_dot_WC[j] - w_WO.cross(p_WC[i] - p_WC[j]));
        DVec3::new(entry(0), entry(1), entry(2))
    };
    DMat3::from_cols(column(0), column(1), column(2))
}

/// Velocities of the contact points on the body, body axes, m/s: the columns of `B^-1 Q` (paper, (15)).
///
/// Needs no shape: positions and velocities of the three contacts in the world, and the motion of the body.
#[must_use]
pub fn contact_curve_rates(
    palms: &PalmTriple,
    R_WO: DMat3,
    p_WC: &[DVec3; 3],
    p_dot_WC: &[DVec3; 3],
    w_WO: DVec3,
) -> [DVec3; 3] {
    let rates = R_WO.transpose() * palms.inverse() * separation_rates(palms.normals(), p_WC, p_dot_WC, w_WO);
    [rates.x_axis, rates.y_axis, rates.z_axis]
}

/// By how much a contact fails the acceleration constraint (paper, (24)), m/s^2: left side minus right side.
///
/// `b` is the contact point from the centre of mass and `beta_dot` its velocity on the body, both in world axes;
/// `p_ddot_WC` the acceleration of the contact point in the world; `a` and `alpha` the accelerations of the body.
/// The paper's step before (24) misses a rotation: `R0 (n' . beta')` there means `(R0 n') . (R0 beta')`.
#[must_use]
pub fn acceleration_defect(
    palm: &PalmState,
    w_WO: DVec3,
    b: DVec3,
    beta_dot: DVec3,
    p_ddot_WC: DVec3,
    a: DVec3,
    alpha: DVec3,
) -> f64 {
    let n = palm.frame.n;
    let left = n.cross(w_WO + palm.omega()).dot(beta_dot);
    left - n.dot(p_ddot_WC - a - alpha.cross(b) - w_WO.cross(w_WO.cross(b)))
}
