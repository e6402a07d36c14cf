use crate::{Direction, PalmState, PalmTriple, SupportFunction, SupportJet};
use glam::{DMat3, DVec3};

/// One contact of a body of known shape with a flat palm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Outward unit normal of the body at the contact, body axes: `-R_WO' n` (paper, (10)).
    pub n_O: Direction,
    /// Radius function value, contact point from the centre of mass (body axes) and Hessian.
    pub jet: SupportJet,
    /// Contact point from the centre of mass, world axes, in m.
    pub b_W: DVec3,
    /// Contact point from the world origin, in m.
    pub p_WC: DVec3,
}

/// A body of known shape resting on three flat palms through the world origin, at one orientation.
///
/// With the orientation given, everything else follows: the palms determine the centre of mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThreeContacts {
    /// Orientation, body axes to world axes.
    pub R_WO: DMat3,
    /// Centre of mass, world, in m.
    pub p_WCm: DVec3,
    /// The contacts with palms 1, 2, 3.
    pub contacts: [Contact; 3],
    /// `J`: the part of the velocity of the centre of mass that is linear in the angular velocity, `v = J w - N^-1 p`.
    pub jacobian: DMat3,
    palms: PalmTriple,
}

/// Rates of change of [`ThreeContacts`] at one angular velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactRates {
    /// Velocity of the centre of mass, world, m/s.
    pub v_WCm: DVec3,
    /// Rates of the outward normals, body axes, 1/s (paper, (21)).
    pub n_dot_O: [DVec3; 3],
    /// Velocities of the contact points on the body, body axes, m/s (the tangents of the contact curves).
    pub beta_dot_O: [DVec3; 3],
    /// Velocities of the contact points in the world, m/s (paper, (7)).
    pub p_dot_WC: [DVec3; 3],
    /// Acceleration of the centre of mass at zero angular acceleration, world, m/s^2: `a = J alpha + bias`.
    pub acceleration_bias: DVec3,
}

impl ThreeContacts {
    /// Where the body touches the palms at orientation `R_WO`: `n_i . p_WCm = r_i` (paper, section 5).
    #[must_use]
    pub fn new(body: &(impl SupportFunction + ?Sized), R_WO: DMat3, palms: PalmTriple) -> Self {
        let R_OW = R_WO.transpose();
        let normals = palms.normals();
        let mut contacts: [Contact; 3] = std::array::from_fn(|i| {
            let n_O = Direction::new_unchecked(R_OW * -normals[i]);
            let jet = body.jet(n_O);
            let b_W = R_WO * jet.point;
            Contact { n_O, jet, b_W, p_WC: b_W }
        });
        let p_WCm = palms.solve(DVec3::from_array(std::array::from_fn(|i| contacts[i].jet.value)));
        contacts.iter_mut().for_each(|contact| contact.p_WC = p_WCm + contact.b_W);
        let arms: [DVec3; 3] = std::array::from_fn(|i| normals[i].cross(contacts[i].b_W));
        let jacobian = palms.inverse() * DMat3::from_cols(arms[0], arms[1], arms[2]).transpose();
        Self { R_WO, p_WCm, contacts, jacobian, palms }
    }

    /// The palms' normals.
    #[must_use]
    pub fn palms(&self) -> &PalmTriple {
        &self.palms
    }

    /// Velocity of the centre of mass at angular velocity `w_WO` (rad/s, world axes).
    #[must_use]
    pub fn velocity(&self, palms: &[PalmState; 3], w_WO: DVec3) -> DVec3 {
        // Speed of the palm's surface at the contact, along its normal: w_WP . (n x c) = -rate t2 . c.
        let lift = |i: usize| palms[i].rate * palms[i].frame.t2.dot(self.contacts[i].p_WC);
        self.jacobian * w_WO + self.palms.solve(DVec3::new(lift(0), lift(1), lift(2)))
    }

    /// All rates at angular velocity `w_WO` (rad/s, world axes), for palms that move as given.
    #[must_use]
    pub fn rates(&self, palms: &[PalmState; 3], w_WO: DVec3) -> ContactRates {
        let R_OW = self.R_WO.transpose();
        let v_WCm = self.velocity(palms, w_WO);
        let mut n_dot_O = [DVec3::ZERO; 3];
        let mut beta_dot_O = [DVec3::ZERO; 3];
        let mut p_dot_WC = [DVec3::ZERO; 3];
        let mut bias = DVec3::ZERO;
        for i in 0..3 {
            let (contact, palm) = (&self.contacts[i], &palms[i]);
            let (n, w_WP) = (palm.frame.n, palm.omega());
            n_dot_O[i] = R_OW * (w_WO - w_WP).cross(n);
            beta_dot_O[i] = contact.jet.hessian * n_dot_O[i];
            let b_dot = w_WO.cross(contact.b_W) + self.R_WO * beta_dot_O[i];
            p_dot_WC[i] = v_WCm + b_dot;
            let n_dot = w_WP.cross(n);
            let lift_rate = palm.alpha().dot(n.cross(contact.p_WC))
                + w_WP.dot(n_dot.cross(contact.p_WC) + n.cross(p_dot_WC[i]));
            bias[i] = w_WO.dot(n_dot.cross(contact.b_W) + n.cross(b_dot)) - lift_rate - n_dot.dot(v_WCm);
        }
        ContactRates { v_WCm, n_dot_O, beta_dot_O, p_dot_WC, acceleration_bias: self.palms.solve(bias) }
    }
}
