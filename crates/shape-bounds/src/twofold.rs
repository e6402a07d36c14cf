//! Twofold ("double-double") precision for the few products that cancel (Dekker 1971; Ogita, Rump and Oishi 2005).

use glam::DVec3;

/// A sum `high + low` of two numbers that do not overlap.
#[derive(Clone, Copy)]
struct Twofold {
    high: f64,
    low: f64,
}

impl Twofold {
    /// `a - b`, exactly.
    fn difference(a: f64, b: f64) -> Self {
        let high = a - b;
        let v = high - a;
        Self { high, low: (a - (high - v)) - (b + v) }
    }

    /// The product, to about 2^-104.
    fn times(self, other: Self) -> Self {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high) + (self.high * other.low + self.low * other.high);
        Self { high, low }
    }

    /// The difference, rounded to one number.
    fn minus(self, other: Self) -> f64 {
        let d = Self::difference(self.high, other.high);
        d.high + (d.low + (self.low - other.low))
    }
}

/// `(j - i) x (k - i)` with the accuracy of twofold precision: right to rounding even where the product in single
/// precision has no correct digit.
pub(crate) fn cross_of_differences(i: DVec3, j: DVec3, k: DVec3) -> DVec3 {
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
