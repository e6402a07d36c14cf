//! Acceleration and contact forces of the object between palms that move as prescribed.

use super::mass::PlanarMass;
use contact_kinematics::planar::{PairContact, PalmPairState, RadiusFunction};
use glam::{DMat2, DVec2};

/// Share of what it is without friction below which the matrix of forces, or the inertia against them, counts as none: the object wedges.
const WEDGING: f64 = 1e-3;

/// A planar object in gravity.
#[derive(Clone, Copy, Debug)]
pub struct PlanarObject<S> {
    /// Its shape about the centre of mass.
    pub shape: S,
    /// Its mass and inertia.
    pub mass: PlanarMass,
    /// Gravity in m/s^2, along world -Y.
    pub gravity: f64,
}

/// What the palms do to the object at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairReaction {
    /// Angular acceleration of the object, rad/s^2.
    pub alpha0: f64,
    /// Normal contact forces, N; a negative one means that the contact would have to pull, and has broken.
    pub forces: [f64; 2],
    /// Where the contacts are.
    pub contact: PairContact,
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec2,
}

/// Part of the normal accelerations `n_i . a = d_i alpha0 + k_i` that does not depend on `alpha0`, without gravity's
/// share: `k_i - n_i . g`; with palm accelerations as given in `palms`.
pub(super) fn bias(
    contact: &PairContact,
    v: DVec2,
    palms: &PalmPairState,
    omega0: f64,
    gravity: f64,
) -> [f64; 2] {
    let [j1, j2] = contact.jets;
    let [u1, u2] = palms.pair.along();
    let [w1, w2] = palms.motion.rates;
    let [a1, a2] = palms.motion.accelerations;
    let (z1, z2) = (omega0 - w1, omega0 - w2);
    let k1 = (j1.rho - j1.r) * z1 * z1 + 2.0 * w1 * u1.dot(v) + w1 * w1 * j1.r + contact.s[0] * a1;
    let k2 = (j2.rho - j2.r) * z2 * z2 - 2.0 * w2 * u2.dot(v) + w2 * w2 * j2.r - contact.s[1] * a2;
    let [n1, n2] = palms.pair.normals();
    [k1 + gravity * n1.y, k2 + gravity * n2.y]
}

/// Gram matrix `Q = [[1, c], [c, 1]] / sin^2 phi2` of the dual of the two normals, applied to `x`.
pub(super) fn dual(palms: &PalmPairState, x: [f64; 2]) -> [f64; 2] {
    let (s2, c) = (palms.pair.sin().powi(2), palms.pair.cos());
    [(x[0] + c * x[1]) / s2, (c * x[0] + x[1]) / s2]
}

impl<S: RadiusFunction> PlanarObject<S> {
    /// Acceleration and forces at orientation `phi0` (rad) and angular velocity `omega0` (rad/s).
    ///
    /// With the metric `<a, b> = a . Q b`, `alpha0 = <d, gn - k> / (I0/m + <d, d>)` and `f = m Q (d alpha0 + k - gn)`.
    #[must_use]
    pub fn reaction(&self, palms: &PalmPairState, phi0: f64, omega0: f64) -> PairReaction {
        let contact = PairContact::new(&self.shape, &palms.pair, phi0);
        let v_WCm = contact.velocity(palms, omega0).v_WCm;
        let b = bias(&contact, v_WCm, palms, omega0, self.gravity);
        let d = contact.jets.map(|j| j.d);
        let dual_d = dual(palms, d);
        let alpha0 = -(dual_d[0] * b[0] + dual_d[1] * b[1])
            / (self.mass.gyration_squared() + dual_d[0] * d[0] + dual_d[1] * d[1]);
        let forces = dual(palms, [d[0] * alpha0 + b[0], d[1] * alpha0 + b[1]]).map(|x| self.mass.mass() * x);
        PairReaction { alpha0, forces, contact, v_WCm }
    }

    /// The same between palms with friction, both of which it slides along: none where it wedges, so that forces have no end.
    ///
    /// Of a contact that slips at `slip` friction is `friction slip / hypot(slip, creep)` of the normal force, so that one that sticks creeps at less
    /// than `creep` (m/s). With these ratios `m`, forces `f_i (n_i + m_i u_i)`, the matrix `G_ji = n_j . n_i + m_i n_j . u_i` and the levers
    /// `w_i = (p_C - p_Cm) x (n_i + m_i u_i)`: `f = m G^-1 (d alpha0 + k - gn)` and `alpha0 = w . G^-1 (k - gn) / (I0/m - w . G^-1 d)`.
    #[must_use]
    pub fn rubbing_reaction(
        &self,
        palms: &PalmPairState,
        phi0: f64,
        omega0: f64,
        [friction, creep]: [f64; 2],
    ) -> Option<PairReaction> {
        let contact = PairContact::new(&self.shape, &palms.pair, phi0);
        let v_WCm = contact.velocity(palms, omega0).v_WCm;
        let b = bias(&contact, v_WCm, palms, omega0, self.gravity);
        let ([n1, n2], [u1, u2]) = (palms.pair.normals(), palms.pair.along());
        let [j1, j2] = contact.jets;
        // What the contact is turned by about the centre of mass along the palm: palm 2 is on the other side of it.
        let [turn1, turn2] = [j1.r, -j2.r];
        let ratio = |slip: f64| if slip == 0.0 { 0.0 } else { -friction * slip / slip.hypot(creep) };
        let (m1, m2) = (ratio(u1.dot(v_WCm) + turn1 * omega0), ratio(u2.dot(v_WCm) + turn2 * omega0));
        let c = n1.dot(n2);
        // Along its own palm friction has no normal part; against the other one it has.
        let g = DMat2::from_cols(DVec2::new(1.0, c + m1 * n2.dot(u1)), DVec2::new(c + m2 * n1.dot(u2), 1.0));
        let least = WEDGING * (1.0 - c * c);
        let inverse = Some(g).filter(|g| g.determinant() > least)?.inverse();
        let (w, d) = (DVec2::new(m1 * turn1 - j1.d, m2 * turn2 - j2.d), DVec2::new(j1.d, j2.d));
        let inertia = self.mass.gyration_squared() - w.dot(inverse * d);
        if inertia <= WEDGING * self.mass.gyration_squared() {
            return None;
        }
        let b = DVec2::from(b);
        let alpha0 = w.dot(inverse * b) / inertia;
        let forces = (inverse * (d * alpha0 + b) * self.mass.mass()).to_array();
        Some(PairReaction { alpha0, forces, contact, v_WCm })
    }

    /// Kinetic and potential energy (J) of the object, the latter against the hinge's height.
    #[must_use]
    pub fn energy(&self, p_WCm: DVec2, v_WCm: DVec2, omega0: f64) -> f64 {
        let kinetic =
            0.5 * (self.mass.mass() * v_WCm.length_squared() + self.mass.inertia() * omega0 * omega0);
        kinetic + self.mass.mass() * self.gravity * p_WCm.y
    }
}
