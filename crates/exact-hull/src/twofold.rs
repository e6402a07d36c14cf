//! Twofold ("double-double") precision for the few products that cancel (Dekker 1971; Ogita, Rump and Oishi 2005).

use glam::DVec3;

/// A sum `high + low` of two numbers that do not overlap.
#[derive(Clone, Copy)]
pub(crate) struct Twofold {
    high: f64,
    low: f64,
}

impl From<f64> for Twofold {
    fn from(high: f64) -> Self {
        Self { high, low: 0.0 }
    }
}

impl Twofold {
    /// `a - b`, exactly.
    #[inline]
    pub(crate) fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let v = high - a;
        Self { high, low: (a - (high - v)) - (b + v) }
    }

    /// `a b`, exactly (Dekker 1971): for numbers between 2^-400 and 2^400 in size, or zero.
    #[inline]
    fn product(a: f64, b: f64) -> Self {
        // 2^27 + 1 splits 53 bits into two halves whose products are exact.
        let split = |x: f64| {
            let c = 134_217_729.0 * x;
            let high = c - (c - x);
            (high, x - high)
        };
        let high = a * b;
        let ((ah, al), (bh, bl)) = (split(a), split(b));
        Self { high, low: ((ah * bh - high) + ah * bl + al * bh) + al * bl }
    }

    /// The product, to about 2^-104.
    #[inline]
    pub(crate) fn times(self, other: Self) -> Self {
        let Self { high, low } = Self::product(self.high, other.high);
        Self { high, low: low + (self.high * other.low + self.low * other.high) }
    }

    /// The sum, to about 2^-104 of the larger of the two.
    #[inline]
    pub(crate) fn plus(self, other: Self) -> Self {
        let sum = Self::difference(self.high, -other.high);
        Self { high: sum.high, low: sum.low + (self.low + other.low) }.normalised()
    }

    /// The difference, rounded to one number.
    #[inline]
    pub(crate) fn minus(self, other: Self) -> f64 {
        let d = Self::difference(self.high, other.high);
        d.high + (d.low + (self.low - other.low))
    }

    #[inline]
    pub(crate) fn value(self) -> f64 {
        self.high + self.low
    }

    #[inline]
    fn normalised(self) -> Self {
        let high = self.high + self.low;
        Self { high, low: self.low - (high - self.high) }
    }
}

/// `(j - i) x (k - i)` with the accuracy of twofold precision: right to rounding even where the product in single
/// precision has no correct digit.
#[must_use]
pub fn cross_of_differences(i: DVec3, j: DVec3, k: DVec3) -> DVec3 {
    let difference = |p: DVec3| [0, 1, 2].map(|axis| Twofold::difference(p[axis], i[axis]));
    let (a, b) = (difference(j), difference(k));
    let component = |p: usize, q: usize| a[p].times(b[q]).minus(a[q].times(b[p]));
    DVec3::new(component(1, 2), component(2, 0), component(0, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_collinear_points_keep_their_normal() {
        // k - i is twice j - i but for one unit in the last place of z.
        let i = DVec3::new(0.3125, 0.1875, -0.6875);
        let j = i + DVec3::new(0.25, 0.5, 0.125);
        let step = j - i;
        let k = i + 2.0 * step;
        let exact = k - i - 2.0 * step;
        assert_eq!(exact, DVec3::ZERO);
        let lifted = DVec3::new(k.x, k.y, k.z.next_up());
        let ulp = lifted.z - k.z;
        let found = cross_of_differences(i, j, lifted);
        let expected = DVec3::new(step.y * ulp, -step.x * ulp, 0.0);
        assert!((found - expected).length() <= 1e-15 * expected.length(), "{found} {expected}");
    }
}
