//! Integrals over closed surfaces of triangles: the one home of volumes, areas and centroids of polytopes.

use glam::DVec3;

/// Volume, centroid and surface area of a solid.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SolidMoments {
    /// In m^3.
    pub volume: f64,
    /// In m; the mean of the corners where the volume is zero.
    pub centroid: DVec3,
    /// In m^2.
    pub area: f64,
}

/// Moments of the solid that `triangles`, anticlockwise from outside, enclose.
///
/// The divergence theorem over tetrahedra from `reference`, which should lie in or near the solid: then no digits are
/// lost to the distance from the origin.
pub(crate) fn solid_moments(triangles: impl Iterator<Item = [DVec3; 3]>, reference: DVec3) -> SolidMoments {
    let mut volume = Compensated::default();
    let mut area = Compensated::default();
    let mut first = DVec3::ZERO;
    for [a, b, c] in triangles {
        let (a, b, c) = (a - reference, b - reference, c - reference);
        // The normal by differences of corners: exact to rounding for small triangles far from the reference.
        let normal = (b - a).cross(c - a);
        let sixfold = a.dot(normal);
        volume.add(sixfold);
        area.add(normal.length());
        first += (a + b + c) * sixfold;
    }
    let sixfold = volume.value();
    let centroid = if sixfold > 0.0 { reference + first / (4.0 * sixfold) } else { reference };
    SolidMoments { volume: sixfold / 6.0, centroid, area: area.value() / 2.0 }
}

/// Neumaier's compensated sum: a million small terms cost no digits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Compensated {
    sum: f64,
    lost: f64,
}

impl Compensated {
    /// Adds a term.
    #[inline]
    pub fn add(&mut self, term: f64) {
        let sum = self.sum + term;
        self.lost +=
            if self.sum.abs() >= term.abs() { (self.sum - sum) + term } else { (term - sum) + self.sum };
        self.sum = sum;
    }

    /// The sum so far.
    #[must_use]
    pub fn value(&self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_far_away_keeps_its_moments() {
        let shift = DVec3::new(3e6, -2e6, 1e6);
        let [o, x, y, z] = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| p + shift);
        let faces = [[o, y, x], [o, x, z], [o, z, y], [x, y, z]];
        let moments = solid_moments(faces.into_iter(), o);
        assert!((moments.volume - 1.0 / 6.0).abs() < 1e-15);
        assert!((moments.area - (1.5 + 0.75_f64.sqrt())).abs() < 1e-14);
        assert!((moments.centroid - (shift + DVec3::splat(0.25))).length() < 1e-9);
    }

    #[test]
    fn small_terms_survive_a_large_sum() {
        let mut sum = Compensated::default();
        sum.add(1e16);
        for _ in 0..1000 {
            sum.add(0.5);
        }
        sum.add(-1e16);
        assert_eq!(sum.value(), 500.0);
    }
}
