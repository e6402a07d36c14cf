//! One classical Runge-Kutta step, alone and with its variational equations.
//!
//! ```
//! use nalgebra::SVector;
//! use observer::rk4::rk4;
//!
//! // A swing, a hundredth of its turn a step: after all of them it is where it was.
//! let step = |x| rk4(&x, std::f64::consts::TAU / 100.0, |_, x| SVector::<f64, 2>::new(x[1], -x[0]));
//! let start = SVector::<f64, 2>::new(1.0, 0.0);
//! let end = (0..100).fold(start, |x, _| step(x));
//! assert!((end - start).norm() < 1e-6);
//! ```

use nalgebra::{SMatrix, SVector};

/// One step of size `h` for `x' = field(fraction, x)`; `fraction` is 0, 1/2 or 1 of the step. Error of order `h^5`.
#[must_use]
pub fn rk4<const N: usize>(
    x: &SVector<f64, N>,
    h: f64,
    field: impl Fn(f64, &SVector<f64, N>) -> SVector<f64, N>,
) -> SVector<f64, N> {
    let k1 = field(0.0, x);
    let k2 = field(0.5, &(x + k1 * (0.5 * h)));
    let k3 = field(0.5, &(x + k2 * (0.5 * h)));
    let k4 = field(1.0, &(x + k3 * h));
    x + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0)
}

/// The step of [`rk4`] and its exact derivative with respect to `x`, from a field that returns its Jacobian too.
#[must_use]
pub fn rk4_linearised<const N: usize>(
    x: &SVector<f64, N>,
    h: f64,
    field: impl Fn(f64, &SVector<f64, N>) -> (SVector<f64, N>, SMatrix<f64, N, N>),
) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
    let (k1, d1) = field(0.0, x);
    let (k2, j2) = field(0.5, &(x + k1 * (0.5 * h)));
    let d2 = j2 + j2 * d1 * (0.5 * h);
    let (k3, j3) = field(0.5, &(x + k2 * (0.5 * h)));
    let d3 = j3 + j3 * d2 * (0.5 * h);
    let (k4, j4) = field(1.0, &(x + k3 * h));
    let d4 = j4 + j4 * d3 * h;
    let end = x + (k1 + (k2 + k3) * 2.0 + k4) * (h / 6.0);
    (end, SMatrix::identity() + (d1 + (d2 + d3) * 2.0 + d4) * (h / 6.0))
}
