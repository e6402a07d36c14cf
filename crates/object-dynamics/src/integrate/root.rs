use thiserror::Error;

/// Why no root was found.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum RootError {
    /// The function does not change sign between the ends.
    #[error("no sign change between {a} (value {fa}) and {b} (value {fb})")]
    NoSignChange {
        /// Left end.
        a: f64,
        /// Right end.
        b: f64,
        /// Value at the left end.
        fa: f64,
        /// Value at the right end.
        fb: f64,
    },
}

/// A root of `f` between `a` and `b`, where `f` must change sign, to within `tolerance` in the argument.
///
/// Chandrupatla's method: inverse quadratic interpolation where it is safe, bisection otherwise; at most about three
/// times the evaluations of bisection, usually fewer than ten. T. R. Chandrupatla, Advances in Engineering
/// Software 28 (1997) 145-149.
///
/// # Errors
/// [`RootError::NoSignChange`], also when an end value is NaN.
pub fn find_root(mut f: impl FnMut(f64) -> f64, a: f64, b: f64, tolerance: f64) -> Result<f64, RootError> {
    let (mut x1, mut x2) = (a, b);
    let (mut f1, mut f2) = (f(x1), f(x2));
    // Not `f1 * f2 <= 0`: the product of two small values underflows. A NaN is refused too.
    let brackets = (f1 <= 0.0 && f2 >= 0.0) || (f1 >= 0.0 && f2 <= 0.0);
    if !brackets {
        return Err(RootError::NoSignChange { a, b, fa: f1, fb: f2 });
    }
    let mut fraction = 0.5;
    loop {
        let x = x1 + fraction * (x2 - x1);
        let fx = f(x);
        let (x3, f3);
        if (fx > 0.0) == (f1 > 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, fx);
        let best = if f1.abs() < f2.abs() { x1 } else { x2 };
        let allowed = 2.0 * f64::EPSILON * best.abs() + 0.5 * tolerance;
        let width = (x2 - x1).abs();
        if f1 == 0.0 || f2 == 0.0 || width <= 2.0 * allowed || !fx.is_finite() {
            return Ok(best);
        }
        let limit = allowed / width;
        let xi = (x1 - x2) / (x3 - x2);
        let phi = (f1 - f2) / (f3 - f2);
        // Inverse quadratic interpolation stays inside of the bracket exactly under these two conditions.
        let safe = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        fraction = if safe {
            f1 / (f2 - f1) * f3 / (f2 - f3) + (x3 - x1) / (x2 - x1) * f1 / (f3 - f1) * f2 / (f3 - f2)
        } else {
            0.5
        };
        fraction = if fraction.is_finite() { fraction.clamp(limit, 1.0 - limit) } else { 0.5 };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_found_in_few_evaluations() {
        let mut count = 0;
        let root = find_root(
            |x| {
                count += 1;
                x.cos() - x
            },
            0.0,
            1.0,
            1e-15,
        );
        assert!((root.unwrap() - 0.739_085_133_215_160_6).abs() < 2e-15);
        assert!(count < 12, "{count}");
        // A triple root and a step are the hard cases: bisection takes over.
        assert!((find_root(|x: f64| (x - 0.3).powi(3), 0.0, 1.0, 1e-12).unwrap() - 0.3).abs() < 1e-5);
        assert!(
            (find_root(|x| if x < 0.7 { -1.0 } else { 1.0 }, 0.0, 1.0, 1e-12).unwrap() - 0.7).abs() < 1e-11
        );
    }

    #[test]
    fn missing_sign_change_and_nan_are_errors() {
        assert!(find_root(|x| x * x + 1.0, -1.0, 1.0, 1e-9).is_err());
        assert!(find_root(|_| f64::NAN, -1.0, 1.0, 1e-9).is_err());
    }
}
