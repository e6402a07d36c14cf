//! Power series in several variables, truncated after the first power of each: exact derivatives along chains of vector fields.

use crate::planar::authors::Scalar;
use std::array;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Variables: one for the gradient, one for each field of a chain.
const VARIABLES: usize = 5;
/// Products of different variables.
const TERMS: usize = 1 << VARIABLES;

/// A polynomial in `e_0` to `e_4` with `e_i^2 = 0`: the coefficient of the product of the variables in the bits of `k` is at `k`.
///
/// That of `e_0 e_1 .. e_n` of a function of `x + e_0 v_0 + ..` is its mixed derivative: to rounding, without a step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nilpotent([f64; TERMS]);

impl Nilpotent {
    /// The variable of this number, times a factor.
    pub(super) fn variable(k: usize, factor: f64) -> Self {
        Self(array::from_fn(|term| if term == 1 << k { factor } else { 0.0 }))
    }

    /// The coefficient of the product of variables that are the bits of `term`.
    pub(super) fn coefficient(&self, term: usize) -> f64 {
        self.0[term]
    }

    /// `sum_k derivatives[k] / k! (x - x_0)^k`, which ends, since no power beyond the number of variables is left.
    fn composed(self, derivatives: [f64; VARIABLES + 1]) -> Self {
        let mut rest = self;
        rest.0[0] = 0.0;
        let (mut power, mut factorial) = (Self::constant(1.0), 1.0);
        let mut sum = Self::constant(derivatives[0]);
        for (k, derivative) in derivatives.iter().enumerate().skip(1) {
            power = power * rest;
            factorial *= k as f64;
            sum = sum + power * Self::constant(derivative / factorial);
        }
        sum
    }
}

impl Scalar for Nilpotent {
    fn constant(value: f64) -> Self {
        Self(array::from_fn(|term| if term == 0 { value } else { 0.0 }))
    }

    fn sin_cos(self) -> (Self, Self) {
        let (s, c) = self.0[0].sin_cos();
        (self.composed([s, c, -s, -c, s, c]), self.composed([c, -s, -c, s, c, -s]))
    }
}

impl Add for Nilpotent {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Nilpotent {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        Self(array::from_fn(|k| self.0[k] - other.0[k]))
    }
}

impl Neg for Nilpotent {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|value| -value))
    }
}

impl Mul for Nilpotent {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        Self(array::from_fn(|term| {
            // All ways to share the variables of the term out, the empty share last.
            let (mut share, mut sum) = (term, 0.0);
            loop {
                sum += self.0[share] * other.0[term ^ share];
                if share == 0 {
                    return sum;
                }
                share = (share - 1) & term;
            }
        }))
    }
}

impl Div for Nilpotent {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let x = other.0[0];
        let mut derivative = 1.0 / x;
        let derivatives = array::from_fn(|k| {
            if k > 0 {
                derivative *= -(k as f64) / x;
            }
            derivative
        });
        self * other.composed(derivatives)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mixed_derivatives_are_those_of_the_closed_forms() {
        let x = |k: usize, at: f64| Nilpotent::constant(at) + Nilpotent::variable(k, 1.0);
        // sin(x y) / z: derivatives by x, y, z are products of known ones.
        let (a, b, c) = (0.7, -1.3, 2.1);
        let f = (x(0, a) * x(1, b)).sin_cos().0 / x(2, c);
        let (s, k) = (a * b).sin_cos();
        assert!((f.coefficient(0b001) - b * k / c).abs() < 1e-15);
        assert!((f.coefficient(0b011) - (k - a * b * s) / c).abs() < 1e-15);
        assert!((f.coefficient(0b111) + (k - a * b * s) / (c * c)).abs() < 1e-15);
        // All variables on one number: the fifth derivative, of 1 / x and of the cosine.
        let all = (0..VARIABLES).fold(Nilpotent::constant(a), |sum, k| sum + Nilpotent::variable(k, 1.0));
        let fifth = (Nilpotent::constant(1.0) / all).coefficient(TERMS - 1);
        assert!((fifth + 120.0 / a.powi(6)).abs() < 1e-12 * fifth.abs(), "{fifth}");
        assert!((all.sin_cos().1.coefficient(TERMS - 1) + a.sin()).abs() < 1e-15);
    }
}
