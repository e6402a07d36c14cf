use super::*;
use crate::random::Source;
use proptest::prelude::*;

fn configuration(source: &mut Source, spread: f64) -> Vec<PalmPose> {
    (0..3).map(|_| PalmPose { R_OP: source.rotation(), p_OP: source.normal3() * spread }).collect()
}

fn near(source: &mut Source, to: &[PalmPose], by: f64) -> Vec<PalmPose> {
    let moved = |p: &PalmPose| PalmPose {
        R_OP: DQuat::from_scaled_axis(source.normal3() * by) * p.R_OP,
        p_OP: p.p_OP + source.normal3() * by,
    };
    to.iter().map(moved).collect()
}

type Metric = fn(&[PalmPose], &[PalmPose]) -> f64;

/// All that are claimed to be metrics.
fn metrics() -> Vec<(&'static str, Metric)> {
    vec![
        ("at once", |a, b| distance(a, b, 0.7, Together::AtOnce).unwrap()),
        ("one by one", |a, b| distance(a, b, 0.7, Together::OneByOne).unwrap()),
        ("duration", |a, b| duration(a, b, Speeds { linear: 0.3, angular: 1.1 }, Together::AtOnce).unwrap()),
        ("duration one by one", |a, b| {
            duration(a, b, Speeds { linear: 0.3, angular: 1.1 }, Together::OneByOne).unwrap()
        }),
        ("equal palms", |a, b| distance_of_equal_palms(a, b, 0.7, Together::OneByOne).unwrap()),
        ("touches", |a, b| {
            let touch = |c: &[PalmPose]| (c[0].p_OP, Direction::new(c[0].R_OP * DVec3::Z).unwrap());
            distance_of_touches(touch(a), touch(b), 0.7).unwrap()
        }),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]
    #[test]
    fn the_laws_of_a_metric_hold(seed in any::<u64>(), spread in 0.0..2.0f64, close in 0.0..1.0f64) {
        let mut source = Source::new(seed);
        let a = configuration(&mut source, spread);
        // Between close configurations the triangle inequality is nearly tight.
        let b = near(&mut source, &a, close);
        let c = if seed % 2 == 0 { near(&mut source, &b, close) } else { configuration(&mut source, spread) };
        let flipped: Vec<_> = a.iter().map(|p| PalmPose { R_OP: -p.R_OP, ..*p }).collect();
        let (turn, shift) = (source.rotation(), source.normal3());
        let moved = |c: &[PalmPose]| -> Vec<PalmPose> {
            c.iter().map(|p| PalmPose { R_OP: turn * p.R_OP, p_OP: turn * p.p_OP + shift }).collect()
        };
        for (name, d) in metrics() {
            prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12, "{name}: triangle");
            prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-12, "{name}: symmetry");
            prop_assert!(d(&a, &flipped) < 1e-12, "{name}: q and -q");
            prop_assert!(d(&a, &b) > 0.0 || close == 0.0, "{name}: only equal ones are at 0");
            prop_assert!((d(&a, &b) - d(&moved(&a), &moved(&b))).abs() < 1e-10, "{name}: another frame");
        }
    }
}

/// What is not a metric, for the reader who would rather have squares: each breaks a law somewhere.
#[test]
fn sums_of_squares_and_quaternions_with_a_sign_are_no_metrics() {
    let mut source = Source::new(5);
    let squares = |a: &[PalmPose], b: &[PalmPose]| -> f64 {
        let one = |(p, q): (&PalmPose, &PalmPose)| {
            p.p_OP.distance_squared(q.p_OP) + (0.7 * rotation_angle(p.R_OP, q.R_OP)).powi(2)
        };
        a.iter().zip(b).map(one).sum()
    };
    let mut broken = 0;
    for _ in 0..1000 {
        let a = configuration(&mut source, 1.0);
        let c = near(&mut source, &a, 1.0);
        let middle = |(p, q): (&PalmPose, &PalmPose)| PalmPose {
            R_OP: p.R_OP.slerp(q.R_OP, 0.5),
            p_OP: p.p_OP.midpoint(q.p_OP),
        };
        let b: Vec<_> = a.iter().zip(&c).map(middle).collect();
        broken += usize::from(squares(&a, &c) > squares(&a, &b) + squares(&b, &c) + 1e-9);
    }
    assert!(broken > 900, "squares broke the triangle inequality {broken} times");
    // The same orientation, at two distances from itself.
    let q = source.rotation();
    assert!((q - q).length() == 0.0 && (q - (-q)).length() > 1.9);
    assert!(rotation_angle(q, -q) < 1e-15);
}

/// Spins of a palm about its own axis: what is left is the angle of the axes.
#[test]
fn the_least_turn_over_all_spins_is_the_angle_between_axes() {
    let mut source = Source::new(6);
    for _ in 0..50 {
        let (a, b) = (source.rotation(), source.rotation());
        let spun = |k: u32| b * DQuat::from_rotation_z(f64::from(k) * std::f64::consts::TAU / 20_000.0);
        let least = (0..20_000).map(|k| rotation_angle(a, spun(k))).fold(f64::INFINITY, f64::min);
        let axes = (a * DVec3::Z).angle_between(b * DVec3::Z);
        assert!((least - axes).abs() < 1e-6, "{least} {axes}");
    }
}

#[test]
fn what_has_no_distance_is_said() {
    let pose = PalmPose { R_OP: DQuat::IDENTITY, p_OP: DVec3::ZERO };
    assert_eq!(
        distance(&[pose], &[pose, pose], 1.0, Together::AtOnce),
        Err(MetricError::Palms { from: 1, to: 2 })
    );
    assert!(matches!(distance(&[pose], &[pose], 0.0, Together::AtOnce), Err(MetricError::Scale { .. })));
    let none = PalmPose { p_OP: DVec3::NAN, ..pose };
    assert_eq!(distance(&[pose], &[none], 1.0, Together::AtOnce), Err(MetricError::Pose { palm: 0 }));
}
