//! Nested norms, which are the support functions of superquadrics.

use glam::{DMat3, DVec3};

/// Shares of the norm below this are taken for this in second derivatives, which have no bound there.
const SMALLEST_SHARE: f64 = 1e-6;

/// `|(|(s1, s2)|_q2, s3)|_q1` with derivatives.
pub(super) struct Nested {
    pub(super) value: f64,
    pub(super) gradient: DVec3,
    pub(super) hessian: DMat3,
    /// Derivatives of the gradient by `q1` and `q2`.
    pub(super) by_exponents: [DVec3; 2],
}

/// A norm of two components: value, gradient, second derivatives, and what its exponent does.
struct Norm2 {
    value: f64,
    first: [f64; 2],
    /// Second derivatives: both diagonal entries and the mixed one.
    second: [f64; 3],
    /// Derivative of the logarithm of the value by the exponent.
    by_exponent: f64,
    /// Derivative of each first derivative by the exponent.
    first_by_exponent: [f64; 2],
}

impl Norm2 {
    fn at(s: [f64; 2], q: f64) -> Self {
        let largest = s[0].abs().max(s[1].abs()).max(f64::MIN_POSITIVE);
        let scaled = s.map(|v| v.abs() / largest);
        let value = largest * (scaled[0].powf(q) + scaled[1].powf(q)).powf(1.0 / q);
        let share = s.map(|v| v.abs() / value);
        let logarithm = share.map(|t| if t > 0.0 { t.ln() } else { 0.0 });
        let power = share.map(|t| t.powf(q - 1.0));
        let first = [power[0] * s[0].signum(), power[1] * s[1].signum()];
        let by_exponent = (power[0] * share[0] * logarithm[0] + power[1] * share[1] * logarithm[1]) / q;
        let own = [0, 1]
            .map(|i| (q - 1.0) / value * (share[i].max(SMALLEST_SHARE).powf(q - 2.0) - power[i] * power[i]));
        let mixed = (1.0 - q) / value * first[0] * first[1];
        let first_by_exponent = [0, 1].map(|i| first[i] * (logarithm[i] - (q - 1.0) * by_exponent));
        Self { value, first, second: [own[0], own[1], mixed], by_exponent, first_by_exponent }
    }
}

impl Norm2 {
    /// What stands for the norm where both components vanish: the size `least` and no slope.
    fn at_zero(least: f64, q: f64) -> Self {
        let own = (q - 1.0) / least * SMALLEST_SHARE.powf(q - 2.0);
        Self {
            value: least,
            first: [0.0; 2],
            second: [own, own, 0.0],
            by_exponent: 0.0,
            first_by_exponent: [0.0; 2],
        }
    }
}

impl Nested {
    pub(super) fn at(s: DVec3, q: [f64; 2]) -> Self {
        // At the pole the inner norm vanishes; a share of 1e-12 of the outer one stands for it.
        let least = 1e-12 * s.abs().max_element();
        let mut inner = Norm2::at([s.x, s.y], q[1]);
        if inner.value < least {
            inner = Norm2::at_zero(least, q[1]);
        }
        let outer_norm = Norm2::at([inner.value, s.z], q[0]);
        let [nw, nz] = outer_norm.first;
        let [nww, nzz, nwz] = outer_norm.second;
        let [wx, wy] = inner.first;
        let [wxx, wyy, wxy] = inner.second;
        let xy = nww * wx * wy + nw * wxy;
        let hessian = DMat3::from_cols(
            DVec3::new(nww * wx * wx + nw * wxx, xy, nwz * wx),
            DVec3::new(xy, nww * wy * wy + nw * wyy, nwz * wy),
            DVec3::new(nwz * wx, nwz * wy, nzz),
        );
        let [qw, qz] = outer_norm.first_by_exponent;
        let grown = inner.value * inner.by_exponent;
        let [gx, gy] = inner.first_by_exponent;
        Self {
            value: outer_norm.value,
            gradient: DVec3::new(nw * wx, nw * wy, nz),
            hessian,
            by_exponents: [
                DVec3::new(qw * wx, qw * wy, qz),
                DVec3::new(nww * grown * wx + nw * gx, nww * grown * wy + nw * gy, nwz * grown),
            ],
        }
    }
}
