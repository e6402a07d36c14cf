//! Modes whose states are orientations.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, UnitQuaternion, Vector3};
use observer::bank::*;
use observer::*;

/// Attitude from a gyro that is off by a bias which differs from mode to mode; what is measured is a direction `g` of the world
/// in the body's axes.
#[derive(Clone, Copy)]
struct Attitude {
    bias: Vector3<f64>,
    g: Vector3<f64>,
}

impl Model<3, 3> for Attitude {
    type Input = Vector3<f64>;
    fn flow(&self, x: &Vector3<f64>, turn: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let step = turn + self.bias;
        (rotation_retract(x, &step), Rotation3::new(-step).into_inner())
    }
    fn output(&self, x: &Vector3<f64>, _: &Vector3<f64>) -> (Vector3<f64>, Matrix3<f64>) {
        let y = Rotation3::new(*x).inverse() * self.g;
        (y, y.cross_matrix())
    }
    fn process_noise(&self, _: &Vector3<f64>, _: &Vector3<f64>) -> Option<Matrix3<f64>> {
        Some(Matrix3::identity() * 1e-4)
    }
    fn retract(&self, x: &Vector3<f64>, step: &Vector3<f64>) -> Vector3<f64> {
        rotation_retract(x, step)
    }
    fn difference(&self, to: &Vector3<f64>, from: &Vector3<f64>) -> Vector3<f64> {
        rotation_difference(to, from)
    }
    fn difference_slope(&self, to: &Vector3<f64>, from: &Vector3<f64>) -> Matrix3<f64> {
        rotation_slope(&rotation_difference(to, from))
    }
    fn scales(&self) -> Vector3<f64> {
        Vector3::from_element(1.0)
    }
    fn names(&self) -> [&'static str; 3] {
        ["orientation about x", "orientation about y", "orientation about z"]
    }
}

/// Probabilities and the first mode's orientation over a log, seen from a world that is turned by `turn`.
fn seen_from(
    turn: &UnitQuaternion<f64>,
    memory: Memory,
) -> Vec<(f64, UnitQuaternion<f64>, SMatrix<f64, 3, 3>)> {
    let down = Vector3::new(0.1, -0.3, 9.0);
    let member = |bias| {
        let model = Attitude { bias, g: turn * down };
        Box::new(KalmanMember::new(model, Vector3::from_element(0.5)).unwrap()) as _
    };
    let members = vec![member(Vector3::new(0.3, 0.0, -0.1)), member(Vector3::new(-0.3, 0.2, 0.1))];
    let modes = Modes::new(members, &[&[0.8, 0.2], &[0.3, 0.7]]).unwrap();
    let at = |x: f64, y: f64, z: f64| {
        let attitude = turn * UnitQuaternion::from_scaled_axis(Vector3::new(x, y, z));
        let variances = Vector3::new(0.02, 0.01, 0.03);
        ModeState {
            probability: 0.5,
            state: Gaussian::new(&attitude.scaled_axis(), &Matrix3::from_diagonal(&variances)),
        }
    };
    let start = [at(0.3, -0.4, 1.0), at(-0.2, 0.2, 1.4)];
    let mut bank = Bank::new(modes, &start, BankOptions { memory, ..BankOptions::default() }).unwrap();
    (0..12)
        .map(|k| {
            let s = f64::from(k);
            let body = UnitQuaternion::from_scaled_axis(Vector3::new(0.1 * s, -0.05 * s, 1.2));
            let measured = body.inverse() * down;
            let turned = Vector3::new(0.02 * s, 0.03, -0.2);
            bank.push(&turned, &[Some(measured[0]), Some(measured[1]), Some(measured[2])]).unwrap();
            let (mean, covariance) = bank.mode_states()[0].state.read::<3>();
            (bank.probability(0), UnitQuaternion::from_scaled_axis(mean), covariance)
        })
        .collect()
}

/// Which way the world's axes point is a convention: probabilities and covariances about the body's axes do not depend on it,
/// and orientations turn along. Averages of rotation vectors or quaternion components would fail this.
#[test]
fn odds_do_not_depend_on_the_world_s_axes() {
    let turns = [Vector3::new(0.4, 0.1, -2.9), Vector3::new(3.0, 0.0, 0.0), Vector3::new(-1.0, 2.0, 0.5)];
    for memory in [Memory::MergedBeforeUpdate, Memory::Hypotheses(4)] {
        let plain = seen_from(&UnitQuaternion::identity(), memory);
        for turn in turns.map(UnitQuaternion::from_scaled_axis) {
            for (a, b) in plain.iter().zip(seen_from(&turn, memory)) {
                assert!((a.0 - b.0).abs() < 1e-9, "{} {}", a.0, b.0);
                assert!((turn * a.1).angle_to(&b.1) < 1e-9);
                assert!((a.2 - b.2).amax() < 1e-9);
            }
        }
        // The modes are told apart, but not at once.
        assert!(
            plain.iter().any(|p| p.0 > 0.05 && p.0 < 0.95) && plain.iter().any(|p| (p.0 - 0.5).abs() > 0.2)
        );
    }
}

/// What a bank merges are rotations: one step in which nothing turns and nothing is measured.
#[test]
fn a_bank_merges_as_rotations_are_matched() {
    let member = || {
        let model = Attitude { bias: Vector3::zeros(), g: Vector3::z() };
        Box::new(KalmanMember::new(model, Vector3::from_element(0.5)).unwrap()) as _
    };
    let modes = Modes::new(vec![member(), member()], &[&[0.8, 0.2], &[0.3, 0.7]]).unwrap();
    let rotations = [Vector3::new(0.3, -0.4, 1.0), Vector3::new(-0.2, 0.2, 1.4)];
    let p =
        [Vector3::new(0.02, 0.01, 0.05), Vector3::new(0.1, 0.04, 0.03)].map(|v| Matrix3::from_diagonal(&v));
    let at = |i: usize, probability| ModeState { probability, state: Gaussian::new(&rotations[i], &p[i]) };
    let options = BankOptions { memory: Memory::MergedBeforeUpdate, ..BankOptions::default() };
    let mut bank = Bank::new(modes, &[at(0, 0.6), at(1, 0.4)], options).unwrap();
    for _ in 0..2 {
        bank.push(&Vector3::zeros(), &[None; 3]).unwrap();
    }
    let stayed = 0.6 * 0.8 / (0.6 * 0.8 + 0.4 * 0.3);
    let weighted = [(stayed, rotations[0], p[0]), (1.0 - stayed, rotations[1], p[1])];
    let (mean, covariance) = match_rotations(&weighted).unwrap();
    let found = bank.mode_states()[0].state.read::<3>();
    assert!((found.0 - mean).amax() < 1e-13);
    assert!((found.1 - covariance - Matrix3::identity() * 1e-4).amax() < 1e-13);
}

/// The slope against differences of the step itself, from next to nothing to nearly half a turn.
#[test]
fn the_slope_is_the_derivative_of_the_difference() {
    let from = Vector3::new(0.3, -0.2, 0.5);
    for angle in [1e-9, 1e-3, 0.0999, 0.1001, 1.0, 2.5, 3.0] {
        let d = Vector3::new(0.6, -0.64, 0.48) * angle;
        let to = rotation_retract(&from, &d);
        assert!((rotation_difference(&to, &from) - d).amax() < 1e-13, "{angle}");
        let slope = rotation_slope(&d);
        let h = 1e-5;
        for axis in 0..3 {
            let step = Vector3::ith(axis, h);
            let there = rotation_difference(&rotation_retract(&to, &step), &from);
            let back = rotation_difference(&rotation_retract(&to, &-step), &from);
            let numeric = (there - back) / (2.0 * h);
            assert!((slope.column(axis) - numeric).amax() < 1e-7, "{angle} {axis}");
        }
    }
}

/// Means that need no computation: of two the middle of the shortest way, weighted; of one itself. Opposite signs of a quaternion
/// are the same rotation.
#[test]
fn means_of_rotations_are_where_they_must_be() {
    let axis = Vector3::new(2.0, -1.0, 2.0) / 3.0;
    let p = Matrix3::from_diagonal(&Vector3::new(0.01, 0.02, 0.03));
    let (mean, covariance) = match_rotations(&[(0.25, axis * 0.2, p), (0.75, axis * 1.0, p)]).unwrap();
    assert!((mean - axis * 0.8).amax() < 1e-14);
    // Along the axis: the common variance, and that of two points 0.8 rad apart.
    let along = axis.dot(&(p * axis)) + 0.25 * 0.75 * 0.64;
    assert!((axis.dot(&(covariance * axis)) - along).abs() < 1e-14);
    let (mean, covariance) = match_rotations(&[(1.0, axis * 3.1, p)]).unwrap();
    assert!((mean - axis * 3.1).amax() < 1e-14 && (covariance - p).amax() < 1e-14);
    // Both sides of half a turn: 3.1 and 2 pi - 3.0 about the same axis.
    let (mean, _) =
        match_rotations(&[(0.5, axis * 3.1, p), (0.5, axis * (3.0 - std::f64::consts::TAU), p)]).unwrap();
    assert!(rotation_difference(&mean, &(axis * 3.05)).norm() < 1e-13);
}

#[test]
fn unusable_rotations_are_named() {
    let (r, p) = (SVector::<f64, 3>::zeros(), Matrix3::identity());
    assert!(matches!(match_rotations(&[]), Err(BankError::Sum { .. })));
    assert!(matches!(match_rotations(&[(0.5, r, p)]), Err(BankError::Sum { .. })));
    assert!(matches!(match_rotations(&[(1.5, r, p), (-0.5, r, p)]), Err(BankError::Value { .. })));
    let nan = Vector3::new(0.0, f64::NAN, 0.0);
    assert!(matches!(match_rotations(&[(1.0, nan, p)]), Err(BankError::NotFinite { mode: 0, .. })));
}
