//! An error of the twist that all slips share: what the other contacts say of it.
//!
//! Slips `sh_i = s_i + J_i e` share the error `e` of the twist. Exact would be one covariance for each set of modes of all
//! contacts; nearly as good is to learn, for each contact, `e` from the others, each taken to stick as far as it is likely to.

use super::density::CREEP;
use nalgebra::{Matrix2, Matrix2x6, Matrix6, Vector2, Vector6};

/// Deviation of the slip of what slides, in shares of the natural speed.
const SLIDING: f64 = 0.15;

/// The error that the twist of the body shares among all slips.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TwistError<'a> {
    /// For each contact, how its slip changes with the twist.
    pub slopes: &'a [Matrix2x6<f64>],
    /// Covariance of the twist's error, positive definite, in units that fit the slopes.
    pub covariance: &'a Matrix6<f64>,
}

/// What one contact's slip says of the error: information matrix and vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    information: Matrix6<f64>,
    vector: Vector6<f64>,
}

impl Row {
    pub(super) const NONE: Self = Self {
        information: Matrix6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 6])),
        vector: Vector6::from_array_storage(nalgebra::ArrayStorage([[0.0; 6]; 1])),
    };

    /// Of a contact with these probabilities to slide and to stick; `noise` is that of its slip alone.
    pub(super) fn new(
        slope: &Matrix2x6<f64>,
        slip: &Vector2<f64>,
        noise: &Matrix2<f64>,
        [_, slides, sticks]: [f64; 3],
        speed: f64,
    ) -> Self {
        let spread = |deviation: f64| noise + Matrix2::identity() * (deviation * speed).powi(2);
        let weight = |deviation: f64| spread(deviation).try_inverse().unwrap_or_default();
        let weight = weight(CREEP) * sticks + weight(SLIDING) * slides;
        let left = slope.transpose() * weight;
        Self { information: left * slope, vector: left * slip }
    }
}

/// Mean and covariance of the slip's error of contact `own`, from the twist's covariance and what all others say. None where the
/// sum is not positive definite, which rounding alone can do.
pub(super) fn left_out(
    rows: &[Row],
    own: usize,
    prior: &Matrix6<f64>,
    slope: &Matrix2x6<f64>,
) -> Option<(Vector2<f64>, Matrix2<f64>)> {
    let mut information = *prior;
    let mut vector = Vector6::zeros();
    for row in rows.iter().enumerate().filter(|(i, _)| *i != own).map(|(_, row)| row) {
        information += row.information;
        vector += row.vector;
    }
    let root = information.cholesky()?;
    let spread = slope * root.solve(&slope.transpose());
    Some((slope * root.solve(&vector), (spread + spread.transpose()) * 0.5))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SMatrix;

    /// Against the joint covariance of all slips, where every contact sticks: conditioning by its Schur complement.
    #[test]
    fn sticking_contacts_condition_each_other_as_the_joint_covariance_does() {
        let slope = |k: f64| Matrix2x6::from_fn(|i, j| (1.3 * k + 0.7 * i as f64 + 1.9 * j as f64).sin());
        let slopes = [slope(0.0), slope(1.0), slope(2.0)];
        let covariance = Matrix6::from_fn(|i, j| if i == j { 1e-4 } else { 1e-5 });
        let prior = covariance.try_inverse().unwrap();
        let (speed, noise) = (0.6, Matrix2::new(2e-6, 5e-7, 5e-7, 3e-6));
        let slips = [Vector2::new(3e-3, -1e-3), Vector2::new(-4e-3, 2e-3), Vector2::new(1e-3, 5e-3)];
        let rows: Vec<Row> =
            (0..3).map(|i| Row::new(&slopes[i], &slips[i], &noise, [0.0, 0.0, 1.0], speed)).collect();
        let (mean, spread) = left_out(&rows, 0, &prior, &slopes[0]).unwrap();
        let alone = noise + Matrix2::identity() * (CREEP * speed).powi(2);
        let mut others = SMatrix::<f64, 4, 6>::zeros();
        others.fixed_view_mut::<2, 6>(0, 0).copy_from(&slopes[1]);
        others.fixed_view_mut::<2, 6>(2, 0).copy_from(&slopes[2]);
        let mut joint = others * covariance * others.transpose();
        for i in 0..2 {
            let block = joint.fixed_view::<2, 2>(2 * i, 2 * i) + alone;
            joint.fixed_view_mut::<2, 2>(2 * i, 2 * i).copy_from(&block);
        }
        let cross = slopes[0] * covariance * others.transpose();
        let gain = cross * joint.try_inverse().unwrap();
        let read = SMatrix::<f64, 4, 1>::new(slips[1].x, slips[1].y, slips[2].x, slips[2].y);
        assert!((mean - gain * read).norm() < 1e-10 * mean.norm());
        let expected = slopes[0] * covariance * slopes[0].transpose() - gain * cross.transpose();
        assert!((spread - expected).norm() < 1e-9 * expected.norm());
    }
}
