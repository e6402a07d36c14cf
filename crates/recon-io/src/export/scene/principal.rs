use glam::{DMat3, DVec3};

/// Each sweep squares what is left beside the diagonal: from 1 to rounding takes 5 or 6.
const SWEEPS: u32 = 12;

/// Principal axes of a symmetric matrix as the columns of a rotation, and its values along them: Jacobi's method. Of a multiple of
/// the identity, the axes as they are.
pub(super) fn principal(matrix: DMat3) -> (DMat3, DVec3) {
    let (mut m, mut axes) = (matrix, DMat3::IDENTITY);
    for _ in 0..SWEEPS {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let off = m.col(j)[i];
            if off == 0.0 {
                continue;
            }
            // The smaller of the two turns that make the entry zero.
            let theta = (m.col(j)[j] - m.col(i)[i]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let (c, s) = (1.0 / t.hypot(1.0), t / t.hypot(1.0));
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(i)[i] = c;
            turn.col_mut(j)[j] = c;
            turn.col_mut(j)[i] = s;
            turn.col_mut(i)[j] = -s;
            m = turn.transpose() * m * turn;
            axes *= turn;
        }
    }
    (axes, DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_turned_diagonal_is_found(turn in [-3.0..3.0f64, -3.0..3.0, -3.0..3.0], values in [1.0..9.0f64, 1.0..9.0, -9.0..9.0]) {
            let rotation = DMat3::from_quat(DQuat::from_scaled_axis(turn.into()));
            let matrix = rotation * DMat3::from_diagonal(values.into()) * rotation.transpose();
            let (axes, found) = principal(matrix);
            let back = axes * DMat3::from_diagonal(found) * axes.transpose();
            prop_assert!((back - matrix).abs().to_cols_array().iter().all(|d| *d < 1e-13), "{}", back - matrix);
            prop_assert!((axes.determinant() - 1.0).abs() < 1e-14);
            prop_assert!((axes.transpose() * axes - DMat3::IDENTITY).abs().to_cols_array().iter().all(|d| *d < 1e-14));
        }
    }

    #[test]
    fn a_multiple_of_the_identity_keeps_its_axes() {
        assert_eq!(principal(DMat3::IDENTITY * 7.0), (DMat3::IDENTITY, DVec3::splat(7.0)));
    }
}
