//! How much of a misfit chance alone makes.

/// Chi-squared of so many degrees of freedom as a normal variable: the cube root's approximation (Wilson and Hilferty 1931).
pub(crate) fn excess(chi_squared: f64, degrees: f64) -> f64 {
    let variance = 2.0 / (9.0 * degrees.max(1.0));
    ((chi_squared / degrees.max(1.0)).cbrt() - (1.0 - variance)) / variance.sqrt()
}
