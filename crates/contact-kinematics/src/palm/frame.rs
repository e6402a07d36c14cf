use super::PalmError;
use crate::Direction;
use glam::{DMat3, DVec3};

/// Smallest horizontal part of a palm normal: below it the direction of the palm's axis is mostly rounding error
/// (an error of 1e-12 in the normal, that of a 12-digit log, turns the axis by 1e-12 / 1e-6 = 1e-6 rad).
const SMALLEST_HORIZONTAL: f64 = 1e-6;

/// Right-handed frame `[t1 t2 n]` of a flat palm through the world origin, in world axes.
///
/// `n` points at the object, `t1` is the horizontal axis of rotation, `t2` points up the palm (paper, section 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmFrame {
    /// Axis of rotation: horizontal, `t1 = t2 x n`.
    pub t1: DVec3,
    /// In the palm, perpendicular to the axis, pointing up.
    pub t2: DVec3,
    /// Unit normal towards the object.
    pub n: DVec3,
}

impl PalmFrame {
    /// The frame that follows from the palm's normal alone (world axes, towards the object).
    ///
    /// # Errors
    /// [`PalmError::VerticalNormal`] when the normal has no horizontal part to speak of.
    pub fn from_normal(n: Direction) -> Result<Self, PalmError> {
        let n = n.get();
        let horizontal = n.x.hypot(n.y);
        if horizontal < SMALLEST_HORIZONTAL {
            return Err(PalmError::VerticalNormal { normal: n, limit: SMALLEST_HORIZONTAL });
        }
        let h = DVec3::new(-n.x, -n.y, 0.0) / horizontal;
        // A palm whose normal points below the horizon still has its t2 pointing up: t2 = horizontal z + n_z h.
        let t2 = n.z * h + DVec3::new(0.0, 0.0, horizontal);
        Ok(Self { t1: t2.cross(n), t2, n })
    }

    /// The frame of a palm that rises in the horizontal direction `azimuth` at angle `slope`, both in rad.
    ///
    /// With `h = (cos azimuth, sin azimuth, 0)`: `t1 = h x z`, `t2 = cos(slope) h + sin(slope) z`,
    /// `n = -sin(slope) h + cos(slope) z`.
    #[must_use]
    pub fn from_azimuth_slope(azimuth: f64, slope: f64) -> Self {
        let (sin_a, cos_a) = azimuth.sin_cos();
        let (sin_s, cos_s) = slope.sin_cos();
        let h = DVec3::new(cos_a, sin_a, 0.0);
        Self {
            t1: DVec3::new(sin_a, -cos_a, 0.0),
            t2: cos_s * h + sin_s * DVec3::Z,
            n: -sin_s * h + cos_s * DVec3::Z,
        }
    }

    /// World position `c = s1 t1 + s2 t2` of sensor coordinates `(s1, s2)`, in m.
    #[must_use]
    pub fn contact_from_sensor(&self, s: [f64; 2]) -> DVec3 {
        s[0] * self.t1 + s[1] * self.t2
    }

    /// Sensor coordinates `(s1, s2)` of a world point, in m; the part along the normal is dropped.
    #[must_use]
    pub fn sensor_from_contact(&self, c: DVec3) -> [f64; 2] {
        [self.t1.dot(c), self.t2.dot(c)]
    }

    /// Rotation from palm axes to world axes, the paper's `R_i = [t1 t2 n]`.
    #[must_use]
    pub fn rotation(&self) -> DMat3 {
        DMat3::from_cols(self.t1, self.t2, self.n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn vertical_normal_is_an_error() {
        for n in [Direction::Z, -Direction::Z] {
            assert!(matches!(PalmFrame::from_normal(n), Err(PalmError::VerticalNormal { .. })));
        }
    }

    proptest! {
        #[test]
        fn both_constructions_agree(azimuth in -10.0..10.0f64, slope in 0.01..3.13f64) {
            let a = PalmFrame::from_azimuth_slope(azimuth, slope);
            let b = PalmFrame::from_normal(Direction::new(a.n).unwrap()).unwrap();
            // The construction from a normal amplifies rounding by 1 / sin(slope).
            let tolerance = 4.0 * f64::EPSILON / slope.sin();
            prop_assert!((a.t1 - b.t1).length() < tolerance && (a.t2 - b.t2).length() < tolerance);
            prop_assert!((a.rotation().determinant() - 1.0).abs() < 1e-14);
            let s = [0.3, -1.7];
            let back = b.sensor_from_contact(a.contact_from_sensor(s));
            prop_assert!((back[0] - s[0]).abs() + (back[1] - s[1]).abs() < 4.0 * tolerance);
        }
    }
}
