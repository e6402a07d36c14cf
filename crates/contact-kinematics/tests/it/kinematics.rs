//! The paper's kinematics, each equation against an independent one: rates against differences, sensors against shape,
//! chart-free forms against the paper's chart, and the chart where it fails.

use contact_kinematics::*;
use glam::{DMat3, DQuat, DVec3};
use proptest::prelude::*;

const STEP: f64 = 1e-4;

fn body() -> impl SupportFunction {
    let dent = Monomial { powers: [1, 1, 1], coefficient: 0.08 };
    let shift = Monomial { powers: [1, 0, 0], coefficient: 0.2 };
    MinkowskiSum(
        Ellipsoid::new(DVec3::new(2.5, 2.0, 1.5)).unwrap(),
        PolynomialSupport::new(vec![dent, shift]).unwrap(),
    )
}

fn palms() -> [Palm; 3] {
    let palm = |azimuth, slope, amplitude, frequency, phase| {
        Palm::new(azimuth, MotionLaw::Sinusoid { mean: slope, amplitude, frequency, phase }).unwrap()
    };
    [palm(0.1, 0.9, 0.08, 1.7, 0.3), palm(2.0, 1.05, 0.1, 2.1, 1.0), palm(4.3, 1.0, 0.06, 1.3, 2.0)]
}

/// A smooth prescribed rotation `R(t) = exp(w t + u t^2 / 2) R(0)` and what the kinematics make of it at time `t`.
#[derive(Debug)]
struct Scene {
    start: DQuat,
    rate: DVec3,
    bend: DVec3,
}

struct Instant {
    palms: [PalmState; 3],
    touch: ThreeContacts,
}

impl Scene {
    fn orientation(&self, t: f64) -> DMat3 {
        DMat3::from_quat(
            (DQuat::from_scaled_axis(self.rate * t + 0.5 * self.bend * t * t) * self.start).normalize(),
        )
    }

    fn at(&self, t: f64) -> Instant {
        let palms = palms().map(|p| p.at(t));
        let triple = PalmTriple::new(palms.map(|p| p.frame.n)).unwrap();
        Instant { palms, touch: ThreeContacts::new(&body(), self.orientation(t), triple) }
    }

    /// Angular velocity at `t = 0` is exactly `rate` and the angular acceleration exactly `bend` (the exponential's
    /// derivative there has no other terms of that order).
    fn instant(&self) -> (Instant, ContactRates) {
        let now = self.at(0.0);
        let rates = now.touch.rates(&now.palms, self.rate);
        (now, rates)
    }
}

fn vector(range: f64) -> impl Strategy<Value = DVec3> {
    (-range..range, -range..range, -range..range).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn scene() -> impl Strategy<Value = Scene> {
    (vector(3.0), vector(1.0), vector(1.0)).prop_map(|(start, rate, bend)| Scene {
        start: DQuat::from_scaled_axis(start),
        rate,
        bend,
    })
}

/// Central difference with error `STEP^2` times third derivatives of order 100, plus rounding `1e-16 * 10 / STEP`.
fn difference(f: impl Fn(f64) -> DVec3) -> DVec3 {
    (f(STEP) - f(-STEP)) / (2.0 * STEP)
}

fn second_difference(f: impl Fn(f64) -> DVec3) -> DVec3 {
    let h = 1e-3;
    (f(h) - 2.0 * f(0.0) + f(-h)) / (h * h)
}

proptest! {
    #[test]
    fn contact_points_lie_in_the_palms(scene in scene()) {
        let (now, _) = scene.instant();
        for (contact, palm) in now.touch.contacts.iter().zip(&now.palms) {
            prop_assert!(palm.frame.n.dot(contact.p_WC).abs() < 1e-13);
            prop_assert!((palm.frame.n.dot(now.touch.p_WCm) - contact.jet.value).abs() < 1e-13);
        }
    }

    #[test]
    fn rates_are_the_derivatives(scene in scene()) {
        let (_, rates) = scene.instant();
        prop_assert!((difference(|t| scene.at(t).touch.p_WCm) - rates.v_WCm).length() < 1e-5);
        for i in 0..3 {
            let contact = |t: f64| scene.at(t).touch.contacts[i];
            prop_assert!((difference(|t| contact(t).p_WC) - rates.p_dot_WC[i]).length() < 1e-5);
            prop_assert!((difference(|t| contact(t).jet.point) - rates.beta_dot_O[i]).length() < 1e-5);
            prop_assert!((difference(|t| contact(t).n_O.get()) - rates.n_dot_O[i]).length() < 1e-6);
            prop_assert!(rates.beta_dot_O[i].dot(contact(0.0).n_O.get()).abs() < 1e-13);
        }
    }

    #[test]
    fn acceleration_bias_is_what_the_angular_acceleration_leaves(scene in scene()) {
        let (now, rates) = scene.instant();
        let acceleration = second_difference(|t| scene.at(t).touch.p_WCm);
        let predicted = now.touch.jacobian * scene.bend + rates.acceleration_bias;
        prop_assert!((acceleration - predicted).length() < 1e-3, "{acceleration} {predicted}");
    }

    #[test]
    fn sensors_and_shape_give_the_same_curve_rates(scene in scene()) {
        // (14), (15) from contact velocities alone against R H n_dot from the shape.
        let (now, rates) = scene.instant();
        let p_WC = now.touch.contacts.map(|c| c.p_WC);
        let sensed = contact_curve_rates(now.touch.palms(), now.touch.R_WO, &p_WC, &rates.p_dot_WC, scene.rate);
        for i in 0..3 {
            prop_assert!((sensed[i] - rates.beta_dot_O[i]).length() < 1e-12);
            // (16) without its chart, and (21).
            let n_dot = body_normal_rate(now.touch.R_WO, &now.palms[i], scene.rate);
            prop_assert!((n_dot - rates.n_dot_O[i]).length() < 1e-14);
            let r = |t: f64| DVec3::splat(scene.at(t).touch.contacts[i].jet.value);
            prop_assert!((difference(r).x - radius_rate(now.touch.contacts[i].jet.point, n_dot)).abs() < 1e-5);
        }
    }

    #[test]
    fn contact_support_from_radii_is_the_contact_point(scene in scene()) {
        let (now, _) = scene.instant();
        let r = now.touch.contacts.map(|c| c.jet.value);
        let p_WC = now.touch.contacts.map(|c| c.p_WC);
        let frames = now.palms.map(|p| p.frame);
        for (i, support) in ContactSupport::from_radii(now.touch.palms(), &frames, r, &p_WC).iter().enumerate() {
            prop_assert!((support.arm(&frames[i]) - now.touch.contacts[i].b_W).length() < 1e-13);
        }
    }

    #[test]
    fn acceleration_constraint_holds(scene in scene()) {
        // (24), with the accelerations from differences and the rates from the shape.
        let (now, rates) = scene.instant();
        let a = second_difference(|t| scene.at(t).touch.p_WCm);
        for i in 0..3 {
            let p_ddot = second_difference(|t| scene.at(t).touch.contacts[i].p_WC);
            let b = now.touch.contacts[i].b_W;
            let beta_dot = now.touch.R_WO * rates.beta_dot_O[i];
            let defect = acceleration_defect(&now.palms[i], scene.rate, b, beta_dot, p_ddot, a, scene.bend);
            prop_assert!(defect.abs() < 2e-3, "{defect}");
        }
    }

    #[test]
    fn contact_velocity_from_sensor_rates(scene in scene()) {
        let (now, rates) = scene.instant();
        for i in 0..3 {
            let sensor = |t: f64| {
                let now = scene.at(t);
                let s = now.palms[i].frame.sensor_from_contact(now.touch.contacts[i].p_WC);
                DVec3::new(s[0], s[1], 0.0)
            };
            let (s, s_dot) = (sensor(0.0), difference(sensor));
            let velocity = contact_velocity(&now.palms[i], [s.x, s.y], [s_dot.x, s_dot.y]);
            prop_assert!((velocity - rates.p_dot_WC[i]).length() < 1e-5);
        }
    }
}

/// The paper's equations in its own chart, (3), (18), (19), (22): an oracle where `cos theta_2` is not small.
mod paper {
    use super::*;
    use nalgebra::{SMatrix, SVector};

    pub(super) struct Chart {
        pub(super) t1: DVec3,
        pub(super) t2: DVec3,
        pub(super) cos2: f64,
    }

    pub(super) fn chart(n: DVec3) -> Chart {
        let (theta1, theta2) = (n.y.atan2(n.x), n.z.asin());
        let t1 = DVec3::new(-theta1.sin(), theta1.cos(), 0.0);
        let t2 = DVec3::new(-theta1.cos() * theta2.sin(), -theta1.sin() * theta2.sin(), theta2.cos());
        Chart { t1, t2, cos2: theta2.cos() }
    }

    /// (22).
    pub(super) fn theta_dot(chart: &Chart, R_WO: DMat3, palm: &PalmState, w_WO: DVec3) -> [f64; 2] {
        let rate = R_WO.transpose() * (w_WO - palm.omega()).cross(palm.frame.n);
        [chart.t1.dot(rate) / chart.cos2, chart.t2.dot(rate)]
    }

    /// (18): `(d_i, e_i)` of the three contacts by the 6 x 6 system, and its determinant.
    pub(super) fn support(now: &Instant) -> (SVector<f64, 6>, f64) {
        let contacts = &now.touch.contacts;
        let charts = contacts.map(|c| chart(c.n_O.get()));
        let R_OW = now.touch.R_WO.transpose();
        let mut matrix = SMatrix::<f64, 6, 6>::zeros();
        let mut rhs = SVector::<f64, 6>::zeros();
        for (row, other) in [(0, 1), (3, 2)] {
            let gap = R_OW * (contacts[0].p_WC - contacts[other].p_WC)
                - (contacts[0].jet.value * contacts[0].n_O.get()
                    - contacts[other].jet.value * contacts[other].n_O.get());
            for axis in 0..3 {
                matrix[(row + axis, 0)] = charts[0].t1[axis];
                matrix[(row + axis, 1)] = charts[0].t2[axis];
                matrix[(row + axis, 2 * other)] = -charts[other].t1[axis];
                matrix[(row + axis, 2 * other + 1)] = -charts[other].t2[axis];
                rhs[row + axis] = gap[axis];
            }
        }
        (matrix.lu().solve(&rhs).unwrap(), matrix.determinant())
    }
}

proptest! {
    #[test]
    fn the_papers_chart_agrees_where_it_is_regular(scene in scene()) {
        let (now, rates) = scene.instant();
        let charts = now.touch.contacts.map(|c| paper::chart(c.n_O.get()));
        prop_assume!(charts.iter().all(|c| c.cos2 > 0.05));
        let (support, determinant) = paper::support(&now);
        let condition = now.touch.palms().condition();
        let normals = now.touch.palms().normals();
        let det_normals = normals[0].dot(normals[1].cross(normals[2]));
        prop_assert!((determinant.abs() - det_normals.abs()).abs() < 1e-12);
        for (i, chart) in charts.iter().enumerate() {
            let beta = now.touch.contacts[i].jet.point;
            prop_assert!((support[2 * i] - beta.dot(chart.t1)).abs() < 1e-12 * condition);
            prop_assert!((support[2 * i + 1] - beta.dot(chart.t2)).abs() < 1e-12 * condition);
            // (16) with (22).
            let theta_dot = paper::theta_dot(chart, now.touch.R_WO, &now.palms[i], scene.rate);
            let r_dot = support[2 * i] * chart.cos2 * theta_dot[0] + support[2 * i + 1] * theta_dot[1];
            prop_assert!((r_dot - radius_rate(beta, rates.n_dot_O[i])).abs() < 1e-10);
        }
    }
}

#[test]
fn at_the_charts_pole_the_paper_fails_and_the_chart_free_form_does_not() {
    // Turn the body so that palm 1 touches it exactly at theta_2 = pi / 2.
    let palm = palms()[0].at(0.0);
    let start = DQuat::from_rotation_arc(DVec3::Z, -palm.frame.n);
    let scene = Scene { start, rate: DVec3::new(0.2, 0.3, -0.4), bend: DVec3::ZERO };
    let (now, rates) = scene.instant();
    let n = now.touch.contacts[0].n_O.get();
    assert!((n - DVec3::Z).length() < 1e-15);
    let chart = paper::chart(n);
    let theta_dot = paper::theta_dot(&chart, now.touch.R_WO, &now.palms[0], scene.rate);
    assert!(theta_dot[0].is_nan() || theta_dot[0].abs() > 1e6, "{theta_dot:?}");
    let r_dot = radius_rate(now.touch.contacts[0].jet.point, rates.n_dot_O[0]);
    let r = |t: f64| DVec3::splat(scene.at(t).touch.contacts[0].jet.value);
    assert!((difference(r).x - r_dot).abs() < 1e-6);
}

#[test]
fn darboux_data_of_a_rolling_body_match_its_hessian() {
    // On any surface kappa_n = -T' H^-1 T along the curve: the curvature of the body in the direction of travel.
    let scene =
        Scene { start: DQuat::IDENTITY, rate: DVec3::new(0.2, 0.3, -0.4), bend: DVec3::new(0.1, 0.0, 0.2) };
    let (now, rates) = scene.instant();
    for i in 0..3 {
        let contact = now.touch.contacts[i];
        let point = CurvePoint {
            t: 0.0,
            beta_O: contact.jet.point,
            n_O: contact.n_O,
            beta_dot_O: rates.beta_dot_O[i],
            n_dot_O: rates.n_dot_O[i],
        };
        let frame = darboux(&point, DVec3::ZERO, 1e-9).unwrap();
        let n = contact.n_O.get();
        let normal_part = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        let shape_operator = (contact.jet.hessian + normal_part).inverse();
        let expected = -frame.tangent.dot(shape_operator * frame.tangent);
        let torsion = -frame.binormal.dot(shape_operator * frame.tangent);
        assert!((frame.normal_curvature - expected).abs() < 1e-12);
        assert!((frame.geodesic_torsion - torsion).abs() < 1e-12);
    }
}
