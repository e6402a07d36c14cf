/// Explicit schemes of fixed step, for comparison and for data that come at fixed times.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FixedScheme {
    /// Order 1.
    Euler,
    /// Order 2: trapezoidal rule with an Euler predictor.
    Heun,
    /// Order 4: the classical Runge-Kutta scheme.
    Rk4,
}

impl FixedScheme {
    /// Order of convergence.
    #[must_use]
    pub fn order(self) -> i32 {
        match self {
            Self::Euler => 1,
            Self::Heun => 2,
            Self::Rk4 => 4,
        }
    }

    /// One step of size `h` from `(t, y)`.
    ///
    /// # Errors
    /// Those of the field.
    pub fn step<const N: usize, E>(
        self,
        field: &mut impl FnMut(f64, &[f64; N]) -> Result<[f64; N], E>,
        t: f64,
        y: &[f64; N],
        h: f64,
    ) -> Result<[f64; N], E> {
        let advance = |h: f64, k: &[f64; N]| -> [f64; N] { std::array::from_fn(|i| y[i] + h * k[i]) };
        let k1 = field(t, y)?;
        match self {
            Self::Euler => Ok(advance(h, &k1)),
            Self::Heun => {
                let k2 = field(t + h, &advance(h, &k1))?;
                Ok(std::array::from_fn(|i| y[i] + 0.5 * h * (k1[i] + k2[i])))
            }
            Self::Rk4 => {
                let k2 = field(t + 0.5 * h, &advance(0.5 * h, &k1))?;
                let k3 = field(t + 0.5 * h, &advance(0.5 * h, &k2))?;
                let k4 = field(t + h, &advance(h, &k3))?;
                Ok(std::array::from_fn(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i])))
            }
        }
    }
}

/// Integrates from `t` to `t_end` in `steps` equal steps (at least one).
///
/// # Errors
/// Those of the field.
pub fn integrate_fixed<const N: usize, E>(
    scheme: FixedScheme,
    mut field: impl FnMut(f64, &[f64; N]) -> Result<[f64; N], E>,
    t: f64,
    y: [f64; N],
    t_end: f64,
    steps: usize,
) -> Result<[f64; N], E> {
    let steps = steps.max(1);
    let h = (t_end - t) / steps as f64;
    (0..steps).try_fold(y, |y, k| scheme.step(&mut field, t + k as f64 * h, &y, h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn schemes_converge_with_their_order() {
        for scheme in [FixedScheme::Euler, FixedScheme::Heun, FixedScheme::Rk4] {
            let error = |steps| {
                let field = |t: f64, y: &[f64; 1]| Ok::<_, Infallible>([y[0] * t.cos()]);
                let end = integrate_fixed(scheme, field, 0.0, [1.0], 2.0, steps).unwrap();
                (end[0] - 2f64.sin().exp()).abs()
            };
            let order = (error(200) / error(400)).log2();
            assert!((order - f64::from(scheme.order())).abs() < 0.1, "{scheme:?}: {order}");
        }
    }
}
