//! Lie derivatives against closed forms, flows and symmetries.

use super::*;
use object_dynamics::planar::PlanarMass;

const F: LieField = [1.0, 0.0, 0.0];
const G1: LieField = [0.0, 1.0, 0.0];
const G2: LieField = [0.0, 0.0, 1.0];

fn fields(gravity: f64, palm_rates: [f64; 2]) -> AuthorsFields {
    AuthorsFields { mass: PlanarMass::new(0.2, 1.5e-4).unwrap(), gravity, palm_rates }
}

/// A state off symmetry: m, rad/s, rad.
fn state() -> AuthorsState {
    AuthorsState::from([0.045, 0.038, 3.0, 0.047, 0.052, 0.8, 1.6])
}

fn units() -> NaturalUnits {
    NaturalUnits { length: 0.04, time: 0.064, torque: 0.2 * 9.81 * 0.04 }
}

/// `tan phi_2` and `d_1` of a state.
fn lever(q: &AuthorsState) -> (f64, f64) {
    let (sin, cos) = q[6].sin_cos();
    (cos / sin, (q[0] * cos + q[1]) / sin - q[3])
}

#[test]
fn low_orders_are_the_closed_forms() {
    let (own, q) = (fields(9.81, [0.3, 0.1]), state());
    let (m, i) = (own.mass.mass(), own.mass.inertia());
    let (value, _) = own.lie_derivative(&q, &[F]).unwrap();
    let drift = own.drift(&q).unwrap();
    assert!((0..4).all(|k| (value[k] - drift[3 + k]).abs() < 1e-15));
    // L_g1 s_1 = -(1 / m + d_1^2 / I) / (s_1 z_1), with d_1 = p_1(r, phi) - s_1.
    let ((cot, d), z, s) = (lever(&q), q[2] - 0.3, q[3]);
    let along = 1.0 / m + d * d / i;
    let (value, gradient) = own.lie_derivative(&q, &[G1]).unwrap();
    assert!((value[0] + along / (s * z)).abs() < 1e-14 * value[0].abs());
    let by_r1 = -2.0 * d * cot / (i * s * z);
    let by_omega = along / (s * z * z);
    let by_s1 = along / (s * s * z) + 2.0 * d / (i * s * z);
    for (k, expected) in [(0, by_r1), (2, by_omega), (3, by_s1), (4, 0.0)] {
        assert!((gradient[0][k] - expected).abs() <= 1e-13 * expected.abs(), "{k}");
    }
    // L_g2 L_g1 s_1: the gradient along g_2, which moves omega0 and the readings alone.
    let g2 = own.inputs(&q).unwrap()[1];
    let expected = by_omega * g2[2] + by_s1 * g2[3];
    let (value, _) = own.lie_derivative(&q, &[G2, G1]).unwrap();
    assert!((value[0] - expected).abs() < 1e-13 * expected.abs(), "{} {expected}", value[0]);
    assert!(matches!(
        own.lie_derivative(&q, &[F; 5]),
        Err(PlanarEstimateError::ChainTooLong { found: 5, most: 4 })
    ));
}

/// The state after `time`, by steps of the classical fourth order.
fn flow(own: &AuthorsFields, q: AuthorsState, torques: [f64; 2], time: f64) -> AuthorsState {
    const STEPS: u32 = 400;
    let (h, rate) = (time / f64::from(STEPS), |q: AuthorsState| own.rate(&q, torques).unwrap());
    (0..STEPS).fold(q, |q, _| {
        let a = rate(q);
        let b = rate(q + a * (h / 2.0));
        let c = rate(q + b * (h / 2.0));
        q + (a + b * 2.0 + c * 2.0 + rate(q + c * h)) * (h / 6.0)
    })
}

#[test]
fn the_series_of_lie_derivatives_is_the_flow() {
    let (own, q, torques) = (fields(9.81, [0.3, 0.1]), state(), [0.03, -0.04]);
    let field = [1.0, torques[0], torques[1]];
    for order in 1..=LONGEST_CHAIN {
        // Readings and their gradients, by the series that ends with this order.
        let series = |time: f64| {
            let mut factor = 1.0;
            let mut sum = AuthorsFields::output(&q);
            for k in 1..=order {
                factor *= time / k as f64;
                sum += own.lie_derivative(&q, &vec![field; k]).unwrap().0 * factor;
            }
            sum
        };
        let error = |time: f64| (series(time) - AuthorsFields::output(&flow(&own, q, torques, time))).norm();
        let observed = (error(2.5e-4) / error(1.25e-4)).log2();
        assert!((observed - (order + 1) as f64).abs() < 0.15, "order {order}: {observed}");
    }
}

#[test]
fn a_motion_without_forces_hides_one_direction() {
    // Without gravity, torques and motion of the palms d_i are constant and s' depends on omega0 d_i alone: a faster spin with shorter
    // levers reads the same.
    let (own, q) = (fields(0.0, [0.0; 2]), state());
    let told = own.observability(&q, &[(F, units().time)], 4, units()).unwrap();
    assert_eq!(told.rank, 6, "{told:?}");
    // d = K r - s, so that r moves by K^-1 d as omega0 falls.
    let (sin, cos) = q[6].sin_cos();
    let d = [(q[0] * cos + q[1]) / sin - q[3], q[4] - (q[0] + q[1] * cos) / sin];
    // p_1 = (r_1 C + r_2) / S and p_2 = (r_1 + r_2 C) / S grow by d_1 and -d_2.
    let (p1, p2) = (d[0], -d[1]);
    let r = [(p2 - p1 * cos) / sin, (p1 - p2 * cos) / sin].map(|v| v / units().length);
    let hidden = [r[0], r[1], -q[2] * units().time, 0.0, 0.0, 0.0, 0.0];
    let length = hidden.iter().map(|v| v * v).sum::<f64>().sqrt();
    let along: f64 = hidden.iter().zip(told.worst).map(|(a, b)| a * b / length).sum();
    assert!((along.abs() - 1.0).abs() < 1e-8, "{:?} {hidden:?}", told.worst);
}

#[test]
fn the_spin_of_a_balanced_disc_is_hidden_from_torques_that_are_held_but_not_from_free_ones() {
    let own = fields(9.81, [0.0; 2]);
    let (radius, phi1, phi2) = (0.04, 0.7, 1.7_f64);
    // Levers are zero: s_1 = s_2 = r / tan(phi_2 / 2).
    let s = radius / (phi2 / 2.0).tan();
    let q = AuthorsState::from([radius, radius, 4.0, s, s, phi1, phi2]);
    let weight = own.mass.mass() * own.gravity;
    let torque = [weight * (phi1 + phi2).sin() * s / phi2.sin(), -weight * phi1.sin() * s / phi2.sin()];
    assert!(own.rate(&q, torque).unwrap().amax() < 1e-12);
    let held = own.observability(&q, &[([1.0, torque[0], torque[1]], units().time)], 4, units()).unwrap();
    assert!(held.rank < 7 && held.worst[2].abs() > 0.99, "{held:?}");
    let (time, input) = (units().time, units().time * units().torque);
    let free = own.observability(&q, &[(F, time), (G1, input), (G2, input)], 2, units()).unwrap();
    assert_eq!(free.rank, 7, "{free:?}");
}
