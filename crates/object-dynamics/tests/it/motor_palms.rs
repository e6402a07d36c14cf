//! Palms of moment of inertia that motors turn, against the paper's equations (29), (34) and (37) and minimal coordinates that
//! are written out here by hand: three rates of turn of the body and three of the palms, and no kernel of the crates.

use contact_kinematics::{Direction, Ellipsoid, MotionLaw, PalmFrame, PalmSurface, SurfacePose};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix6, Vector6};
use object_dynamics::*;
use proptest::prelude::*;

const G: DVec3 = DVec3::new(0.0, 0.0, -9.81);
const AXES: DVec3 = DVec3::new(2.5, 2.0, 1.0);
const MASS: f64 = 1.3;
/// Largest difference of two formulations, as a share of the accelerations.
const AGREE: f64 = 1e-10;

/// A plane on a hinge, with its motor.
#[derive(Clone, Copy, Debug)]
struct Hinged {
    pivot: DVec3,
    axis: DVec3,
    /// A frame whose third axis is the normal, and a point of the plane, as they are now.
    frame: DMat3,
    point: DVec3,
    rate: f64,
    inertia: f64,
    torque: f64,
}

/// The body and its palms at one time.
#[derive(Clone, Copy, Debug)]
struct Case {
    palms: [Hinged; 3],
    R_WO: DQuat,
    w_WO: DVec3,
    friction: f64,
}

/// Where the body of a case is and how it moves.
struct Place {
    p_WCm: DVec3,
    v_WCm: DVec3,
    /// Acceleration of the centre of mass where neither body nor palms turn faster or slower.
    bias: DVec3,
    n: [DVec3; 3],
    /// Unit directions of the body over the palms.
    slip: [DVec3; 3],
    /// Contacts from the centre of mass and from the hinges, and their levers: velocities of the palms per rate.
    b: [DVec3; 3],
    l: [DVec3; 3],
    lever: [DVec3; 3],
}

/// Accelerations of body and palms.
struct Minimal {
    place: Place,
    a_WCm: DVec3,
    alpha_WO: DVec3,
    turns: [f64; 3],
    /// Normal forces by the moment of the whole contact force about the hinge.
    forces: [f64; 3],
}

/// Of each palm.
fn each<T>(of: impl FnMut(usize) -> T) -> [T; 3] {
    std::array::from_fn(of)
}

/// `N^-1 x` of the matrix whose rows are the normals.
fn unmix(n: [DVec3; 3], x: [f64; 3]) -> DVec3 {
    DMat3::from_cols_array_2d(&n.map(|n| n.to_array())).transpose().inverse() * DVec3::from_array(x)
}

impl Place {
    /// Velocity of the centre of mass at these rates of body and palms, less what it has at none.
    fn velocity(&self, w: DVec3, rates: [f64; 3]) -> DVec3 {
        let (n, b) = (self.n, self.b);
        unmix(n, each(|i| n[i].cross(b[i]).dot(w) + self.lever[i].dot(n[i]) * rates[i]))
    }
}

impl Case {
    fn inertia_W(&self) -> DMat3 {
        let [a, b, c] = (AXES * AXES).to_array();
        let principal = DMat3::from_diagonal(MASS / 5.0 * DVec3::new(b + c, a + c, a + b));
        let R = DMat3::from_quat(self.R_WO);
        R * principal * R.transpose()
    }

    /// `n . (cm - P) = h(u)` and its rates determine the centre of mass, its velocity and its acceleration: with
    /// `l = c - pivot` and `e` the axis, `n . v = (n x b) . w + rate e . (l x n)`.
    fn place(&self) -> Place {
        let (R, w, D) = (DMat3::from_quat(self.R_WO), self.w_WO, AXES * AXES);
        let n = self.palms.map(|palm| palm.frame.z_axis);
        let u = n.map(|n| -(R.transpose() * n));
        let h = u.map(|u| u.dot(D * u).sqrt());
        let b = each(|i| R * (D * u[i] / h[i]));
        let p_WCm = unmix(n, each(|i| h[i] + n[i].dot(self.palms[i].point)));
        let l = each(|i| p_WCm + b[i] - self.palms[i].pivot);
        let lever = each(|i| self.palms[i].axis.cross(l[i]));
        let none = DVec3::ZERO;
        let mut place = Place { p_WCm, v_WCm: none, bias: none, n, slip: [none; 3], b, l, lever };
        let v = place.velocity(w, self.palms.map(|palm| palm.rate));
        let of_rates = |i: usize| {
            let turn = self.palms[i].rate * self.palms[i].axis;
            let (u_dot, Du) = (R.transpose() * (w - turn).cross(n[i]), D * u[i]);
            let b_dot = w.cross(b[i]) + R * (D * u_dot / h[i] - Du * (Du.dot(u_dot) / h[i].powi(3)));
            let n_dot = turn.cross(n[i]);
            let of_palm = turn.dot((v + b_dot).cross(n[i]) + l[i].cross(n_dot));
            w.dot(n_dot.cross(b[i]) + n[i].cross(b_dot)) + of_palm - n_dot.dot(v)
        };
        (place.v_WCm, place.bias) = (v, unmix(n, each(of_rates)));
        place.slip = each(|i| (v + w.cross(b[i]) - self.palms[i].rate * lever[i]).normalize());
        place
    }

    /// Virtual power of everything but the normal forces, which do none:
    /// `m (a - g) . dv + (I alpha + w x I w) . dw + sum (I_i turn_i - tau_i) drate_i = - sum mu f_i tau_i . dslip_i`,
    /// where `f_i` follows from (29) of the paper with the moment of the whole force,
    /// `I_i turn_i = tau_i - f_i (e x l) . (n - mu tau)`; without friction the right side is none.
    fn minimal(&self) -> Minimal {
        let (place, mu, I) = (self.place(), self.friction, self.inertia_W());
        let arm = each(|i| place.lever[i].dot(place.n[i] - mu * place.slip[i]));
        // The velocities that belong to each of the six rates.
        let unit = |k: usize| -> (DVec3, DVec3, [f64; 3]) {
            let spin = if k < 3 { DVec3::AXES[k] } else { DVec3::ZERO };
            let rates = each(|i| f64::from(u8::from(k == 3 + i)));
            (place.velocity(spin, rates), spin, rates)
        };
        let (mut matrix, mut side) = (Matrix6::zeros(), Vector6::zeros());
        for r in 0..6 {
            let (dv, dw, drate) = unit(r);
            side[r] = -MASS * dv.dot(place.bias - G) - dw.dot(self.w_WO.cross(I * self.w_WO));
            for c in 0..6 {
                let (v, spin, _) = unit(c);
                matrix[(r, c)] = MASS * dv.dot(v) + dw.dot(I * spin);
            }
            for (i, palm) in self.palms.iter().enumerate() {
                let slip = dv + dw.cross(place.b[i]) - drate[i] * place.lever[i];
                let power = drate[i] - mu * place.slip[i].dot(slip) / arm[i];
                matrix[(r, 3 + i)] += power * palm.inertia;
                side[r] += power * palm.torque;
            }
        }
        let found = matrix.full_piv_lu().solve(&side).unwrap();
        let (alpha_WO, turns) = (DVec3::new(found[0], found[1], found[2]), [found[3], found[4], found[5]]);
        let forces = each(|i| (self.palms[i].torque - self.palms[i].inertia * turns[i]) / arm[i]);
        let a_WCm = place.velocity(alpha_WO, turns) + place.bias;
        Minimal { place, a_WCm, alpha_WO, turns, forces }
    }

    /// Modes, general contacts and maximal coordinates.
    fn general(&self, place: &Place) -> ContactInstant {
        let palm = |palm: Hinged| {
            let motor = PalmTorque {
                pose: SurfacePose::new(palm.point, DQuat::from_mat3(&palm.frame)).unwrap(),
                pivot: palm.pivot,
                axis: Direction::new(palm.axis).unwrap(),
                inertia: palm.inertia,
                torque: MotionLaw::Constant { value: palm.torque },
                angle: 0.0,
                rate: palm.rate,
            };
            ScenePalm {
                surface: PalmSurface::Plane,
                drive: PalmDrive::Torque(motor),
                friction: self.friction,
            }
        };
        let mass = MassProperties::uniform_ellipsoid(MASS, AXES).unwrap();
        let palms = self.palms.map(palm).to_vec();
        let scene = ContactScene::new(Ellipsoid::new(AXES).unwrap(), mass, palms, -G.z).unwrap();
        let body = BodyState { p_WCm: place.p_WCm, R_WO: self.R_WO, v_WCm: place.v_WCm, w_WO: self.w_WO };
        let state = SceneState { t: 0.0, body, palms: scene.palms_at_start() };
        scene.instant(&state, &[ContactMode::Slide; 3]).unwrap()
    }

    /// Both say the same of body, palms and forces.
    fn check(&self, now: &Minimal) -> Result<(), TestCaseError> {
        let (place, other) = (&now.place, self.general(&now.place));
        let size = 1.0
            + now.alpha_WO.length()
            + now.a_WCm.length()
            + now.turns.iter().chain(&now.forces).fold(0.0, |s, v| s + v.abs());
        prop_assert!((now.alpha_WO - other.alpha_WO).length() < AGREE * size);
        prop_assert!((now.a_WCm - other.a_WCm).length() < AGREE * size);
        for i in 0..3 {
            let palm = &self.palms[i];
            prop_assert!(
                other.contacts[i].gap.abs() < 1e-13 && other.rates[i].slip.dot(place.n[i]).abs() < 1e-13
            );
            let force = now.forces[i] * (place.n[i] - self.friction * place.slip[i]);
            prop_assert!((force - other.forces[i]).length() < AGREE * size, "{} {}", force, other.forces[i]);
            let moment = palm.axis.cross(place.l[i]).dot(other.forces[i]);
            let turn = (palm.torque - moment) / palm.inertia;
            prop_assert!(
                (turn - now.turns[i]).abs() < AGREE * size / palm.inertia,
                "{} {}",
                turn,
                now.turns[i]
            );
        }
        Ok(())
    }
}

fn vector(size: f64) -> impl Strategy<Value = DVec3> {
    [-size..size, -size..size, -size..size].prop_map(DVec3::from_array)
}

/// The paper's palms: planes through the origin that turn about their horizontal axes.
fn of_the_paper() -> impl Strategy<Value = [Hinged; 3]> {
    let palm = |k: usize| {
        (-0.3..0.3f64, 0.8..1.2f64, -1.0..1.0f64, 0.1..5.0f64, -20.0..40.0f64).prop_map(
            move |(shift, slope, rate, inertia, torque)| {
                let frame = PalmFrame::from_azimuth_slope(2.1 * k as f64 + shift, slope);
                let (pivot, point) = (DVec3::ZERO, DVec3::ZERO);
                Hinged { pivot, axis: frame.t1, frame: frame.rotation(), point, rate, inertia, torque }
            },
        )
    };
    [palm(0), palm(1), palm(2)]
}

/// Planes about any hinges, which they need not contain.
fn of_any_hinges() -> impl Strategy<Value = [Hinged; 3]> {
    let moved = || [vector(0.4), vector(0.4), vector(0.4)];
    (of_the_paper(), moved(), moved(), moved()).prop_map(|(mut palms, pivots, points, axes)| {
        for (i, palm) in palms.iter_mut().enumerate() {
            (palm.pivot, palm.point) = (pivots[i], points[i]);
            palm.axis = (palm.axis + axes[i]).normalize();
        }
        palms
    })
}

fn case(palms: impl Strategy<Value = [Hinged; 3]>, friction: f64) -> impl Strategy<Value = Case> {
    (palms, vector(3.0), vector(2.0), 0.0..=friction).prop_map(|(palms, turn, w_WO, friction)| Case {
        palms,
        R_WO: DQuat::from_scaled_axis(turn),
        w_WO,
        friction,
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    #[test]
    fn the_paper_s_palms_without_friction(case in case(of_the_paper(), 0.0)) {
        let now = case.minimal();
        case.check(&now)?;
        // (30) determines the forces as well, and (29) gives the same; `s2` is the distance from the axis of rotation.
        let newton = DMat3::from_cols(now.place.n[0], now.place.n[1], now.place.n[2]).inverse() * (MASS * (now.a_WCm - G));
        let size = 1.0 + newton.length() + now.alpha_WO.length();
        let (mut moment, I) = (DVec3::ZERO, case.inertia_W());
        for i in 0..3 {
            let palm = &case.palms[i];
            let s2 = palm.frame.y_axis.dot(now.place.l[i]);
            let (left, right) = (palm.inertia * now.turns[i], palm.torque - newton[i] * s2);
            prop_assert!((left - right).abs() < AGREE * size, "(29): {} {}", left, right);
            // n of (34) points out of the body.
            moment += (palm.torque - palm.inertia * now.turns[i]) / s2 * now.place.b[i].cross(-now.place.n[i]);
        }
        let alpha = -(I.inverse() * (case.w_WO.cross(I * case.w_WO) + moment));
        prop_assert!((alpha - now.alpha_WO).length() < AGREE * size, "(34): {} {}", alpha, now.alpha_WO);
    }

    #[test]
    fn motors_that_hold_the_rates_of_the_paper_s_palms(case in case(of_the_paper(), 0.0)) {
        // A palm of infinite inertia keeps its rate; that of the torque which balances it there does as well.
        let heavy = Case { palms: case.palms.map(|palm| Hinged { inertia: 1e9, torque: 0.0, ..palm }), ..case };
        let held = heavy.general(&case.place());
        let mut case = case;
        for i in 0..3 {
            case.palms[i].torque = case.palms[i].axis.dot(held.contacts[i].p_WC.cross(held.forces[i]));
        }
        let now = case.minimal();
        case.check(&now)?;
        let size = 1.0 + now.alpha_WO.length() + now.forces.iter().fold(0.0, |s, f| s + f.abs());
        let (mut moment, I) = (DVec3::ZERO, case.inertia_W());
        for i in 0..3 {
            // The heavy palms gave way by a share of 1e-9 of that.
            prop_assert!(now.turns[i].abs() < 1e-7 * size / case.palms[i].inertia, "{}", now.turns[i]);
            let s2 = case.palms[i].frame.y_axis.dot(now.place.l[i]);
            moment += case.palms[i].torque / s2 * now.place.b[i].cross(-now.place.n[i]);
        }
        let alpha = -(I.inverse() * (case.w_WO.cross(I * case.w_WO) + moment));
        prop_assert!((alpha - now.alpha_WO).length() < 1e-7 * size, "(37): {} {}", alpha, now.alpha_WO);
    }

    #[test]
    fn the_paper_s_palms_with_friction(case in case(of_the_paper(), 0.5)) {
        let now = case.minimal();
        case.check(&now)?;
        // Friction in the plane of the palm has no moment about its hinge: (29) stands as it is.
        for i in 0..3 {
            let s2 = case.palms[i].frame.y_axis.dot(now.place.l[i]);
            let moment = case.palms[i].torque - case.palms[i].inertia * now.turns[i];
            prop_assert!((moment - now.forces[i] * s2).abs() < AGREE * (1.0 + now.forces[i].abs()));
        }
    }

    #[test]
    fn any_hinges_with_friction(case in case(of_any_hinges(), 0.5)) {
        case.check(&case.minimal())?;
    }
}
