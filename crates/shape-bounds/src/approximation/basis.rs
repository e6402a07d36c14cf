//! Uniform cubic B-splines on one interval.

/// The four B-splines that are not zero at `t` of an interval from 0 to 1, and their first three derivatives.
pub(super) fn cubic(t: f64) -> [[f64; 4]; 4] {
    let s = 1.0 - t;
    let [inner, mirrored] = [t, s].map(|x| (x * x * (3.0 * x - 6.0) + 4.0) / 6.0);
    let [rising, falling] = [t, s].map(|x| 0.5 * x * (3.0 * x - 4.0));
    [
        [s * s * s / 6.0, inner, mirrored, t * t * t / 6.0],
        [-0.5 * s * s, rising, -falling, 0.5 * t * t],
        [s, 3.0 * t - 2.0, 3.0 * s - 2.0, t],
        [-1.0, 3.0, -3.0, 1.0],
    ]
}

/// Places and weights of Gauss and Legendre's rule of four points on the interval from 0 to 1: exact to degree 7.
fn gauss() -> [(f64, f64); 4] {
    let root = (6.0_f64 / 5.0).sqrt();
    let place = |sign: f64| 0.5 * (3.0 / 7.0 + sign * 2.0 / 7.0 * root).sqrt();
    let weight = |sign: f64| (18.0 - sign * 30_f64.sqrt()) / 72.0;
    let (far, near) = (place(1.0), place(-1.0));
    let (light, heavy) = (weight(1.0), weight(-1.0));
    [(0.5 - far, light), (0.5 - near, heavy), (0.5 + near, heavy), (0.5 + far, light)]
}

/// Integrals over one interval of products of two of the four B-splines, and of two of their first, second and third derivatives.
pub(super) fn grams() -> [[[f64; 4]; 4]; 4] {
    let mut all = [[[0.0; 4]; 4]; 4];
    for (t, weight) in gauss() {
        let at = cubic(t);
        for order in 0..4 {
            for i in 0..4 {
                for j in 0..4 {
                    all[order][i][j] += weight * at[order][i] * at[order][j];
                }
            }
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_sum_to_one_and_differentiate() {
        for t in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let [value, first, second, third] = cubic(t);
            assert!((value.iter().sum::<f64>() - 1.0).abs() < 1e-15);
            assert!(first.iter().sum::<f64>().abs() < 1e-15 && second.iter().sum::<f64>().abs() < 1e-14);
            let (after, before) = (cubic(t + 1e-4), cubic(t - 1e-4));
            for k in 0..4 {
                assert!(((after[0][k] - before[0][k]) / 2e-4 - first[k]).abs() < 1e-8);
                assert!(((after[1][k] - before[1][k]) / 2e-4 - second[k]).abs() < 1e-8);
                assert!(((after[2][k] - before[2][k]) / 2e-4 - third[k]).abs() < 1e-8);
            }
        }
    }

    #[test]
    fn integrals_of_products_are_those_of_the_polynomials() {
        // The ends: integral of (t^3 / 6)^2 is 1 / 252, of (t^2 / 2)^2 is 1 / 20, of t^2 is 1 / 3.
        let [values, first, second, _] = grams();
        for (found, exact) in
            [(values[3][3], 1.0 / 252.0), (first[0][0], 1.0 / 20.0), (second[3][3], 1.0 / 3.0)]
        {
            assert!((found - exact).abs() < 1e-16, "{found} {exact}");
        }
    }
}
