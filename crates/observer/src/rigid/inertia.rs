//! Inertia tensors as six free numbers: every value of them is a body that can exist.

use glam::{DMat3, DVec3};

/// Number of free numbers of an inertia tensor.
pub(crate) const INERTIA_NUMBERS: usize = 6;
/// Smallest entry on the diagonal of the Cholesky factor against the largest: a flat plate, whose second moment across
/// is zero, still has a logarithm.
const FLATTEST: f64 = 1e-6;

/// Logarithms of the diagonal and entries below it, `(1,0) (2,0) (2,1)`, of the Cholesky factor `C` of the second
/// moments `S = C C'`, `S = tr(I)/2 - I`. The moments of any body with extent in all directions are positive definite,
/// which is the same as positive moments of inertia that obey the triangle inequality.
pub(crate) fn numbers_of_inertia(inertia: DMat3) -> [f64; INERTIA_NUMBERS] {
    let half = 0.5 * (inertia.x_axis.x + inertia.y_axis.y + inertia.z_axis.z);
    let s = DMat3::from_diagonal(DVec3::splat(half)) - inertia;
    let floor = (FLATTEST * half.abs().sqrt()).max(f64::MIN_POSITIVE);
    let root = |square: f64| square.max(0.0).sqrt().max(floor);
    let c00 = root(s.x_axis.x);
    let (c10, c20) = (s.x_axis.y / c00, s.x_axis.z / c00);
    let c11 = root(s.y_axis.y - c10 * c10);
    let c21 = (s.y_axis.z - c20 * c10) / c11;
    let c22 = root(s.z_axis.z - c20 * c20 - c21 * c21);
    [c00.ln(), c11.ln(), c22.ln(), c10, c20, c21]
}

/// Lower triangular factor of the second moments.
fn factor(numbers: &[f64; INERTIA_NUMBERS]) -> DMat3 {
    let [a, b, c, d, e, f] = *numbers;
    DMat3::from_cols(DVec3::new(a.exp(), d, e), DVec3::new(0.0, b.exp(), f), DVec3::new(0.0, 0.0, c.exp()))
}

/// `tr(S) - S`.
fn from_second_moments(s: DMat3) -> DMat3 {
    DMat3::from_diagonal(DVec3::splat(s.x_axis.x + s.y_axis.y + s.z_axis.z)) - s
}

/// The inertia tensor, kg m^2.
pub(crate) fn inertia_of_numbers(numbers: &[f64; INERTIA_NUMBERS]) -> DMat3 {
    let c = factor(numbers);
    from_second_moments(c * c.transpose())
}

/// Its derivative by one of the numbers.
pub(crate) fn inertia_slope(numbers: &[f64; INERTIA_NUMBERS], number: usize) -> DMat3 {
    let c = factor(numbers);
    let mut slope = DMat3::ZERO;
    match number {
        0 => slope.x_axis.x = c.x_axis.x,
        1 => slope.y_axis.y = c.y_axis.y,
        2 => slope.z_axis.z = c.z_axis.z,
        3 => slope.x_axis.y = 1.0,
        4 => slope.x_axis.z = 1.0,
        _ => slope.y_axis.z = 1.0,
    }
    let half = slope * c.transpose();
    from_second_moments(half + half.transpose())
}

#[cfg(test)]
mod tests {
    use super::*;
    use object_dynamics::MassProperties;
    use proptest::prelude::*;

    fn size(m: DMat3) -> f64 {
        m.to_cols_array().iter().fold(0.0, |a: f64, v| a.max(v.abs()))
    }

    proptest! {
        #[test]
        fn any_numbers_are_a_body_and_come_back(n in proptest::array::uniform6(-1.5..1.5f64)) {
            let inertia = inertia_of_numbers(&n);
            prop_assert!(MassProperties::new(1.0, inertia).is_ok());
            let back = numbers_of_inertia(inertia);
            // The conditioning of a Cholesky factor is the square root of the tensor's: digits to spare at 1e-10.
            prop_assert!((0..6).all(|k| (back[k] - n[k]).abs() < 1e-10), "{:?} {:?}", n, back);
            for k in 0..6 {
                let moved = |h: f64| { let mut m = n; m[k] += h; inertia_of_numbers(&m) };
                let slope = (moved(1e-5) - moved(-1e-5)) * 0.5e5;
                prop_assert!(size(slope - inertia_slope(&n, k)) < 1e-7 * (1.0 + size(inertia)));
            }
        }
    }

    #[test]
    fn a_flat_plate_has_numbers_too() {
        let plate = DMat3::from_diagonal(DVec3::new(1.0, 2.0, 3.0));
        assert!(size(inertia_of_numbers(&numbers_of_inertia(plate)) - plate) < 1e-10);
    }
}
