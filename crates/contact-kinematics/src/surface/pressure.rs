use super::PalmSurface;
use glam::DVec3;
use thiserror::Error;

/// Why a measured wrench has no point of contact on a palm.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PressureError {
    /// Force or torque is NaN or infinite.
    #[error("force or torque is not finite")]
    NotFinite,
    /// There is no force along the normal that a contact could exert.
    #[error("the force pulls the object, or is zero")]
    NoPush,
    /// The line along which the force acts passes the palm.
    #[error(
        "the line along which the force acts passes {distance} m from the palm's centre or axis, beyond its radius {radius} m"
    )]
    Misses {
        /// Distance of the line from the centre of a sphere or cup, or from the axis of a cylinder, m.
        distance: f64,
        /// The palm's radius, m.
        radius: f64,
    },
}

impl PalmSurface {
    /// Where the palm is touched, by the `force` (N) that it exerts on the object and the `torque` (N m) of that force about
    /// the origin of the palm's frame; all in palm axes, m.
    ///
    /// A contact that transmits no torque of its own lies on the line `F x T / F^2 + s F`; that line is cut with the
    /// surface, on the side where the force pushes. A torque along the force (torsional friction) moves the line by nothing.
    /// A. Bicchi, J. K. Salisbury and D. L. Brock, "Contact sensing from force measurements" (1993), point contacts. On a
    /// plane it is the centre of pressure `(-T_y / F_z, T_x / F_z, 0)` however the pressure is spread.
    ///
    /// # Errors
    /// [`PressureError`].
    pub fn centre_of_pressure(&self, force: DVec3, torque: DVec3) -> Result<DVec3, PressureError> {
        if !(force.is_finite() && torque.is_finite()) {
            return Err(PressureError::NotFinite);
        }
        if let Self::Plane = self {
            let point = DVec3::new(-torque.y / force.z, torque.x / force.z, 0.0);
            // Forces so small that the division overflows push nothing either.
            return if force.z > 0.0 && point.is_finite() { Ok(point) } else { Err(PressureError::NoPush) };
        }
        let along = force.normalize_or_zero();
        let foot = along.cross(torque) / force.length();
        if along == DVec3::ZERO || !foot.is_finite() {
            return Err(PressureError::NoPush);
        }
        let point = match *self {
            Self::Plane => return Err(PressureError::NoPush),
            Self::Sphere { radius } => cut(foot, along, radius, 1.0),
            Self::Cup { radius } => cut(foot, along, radius, -1.0),
            Self::Cylinder { radius } => {
                // Across the axis it is a circle; along it the point goes with the line.
                let across = DVec3::new(0.0, along.y, along.z);
                let share = across.length();
                let Some(unit) = across.try_normalize() else { return Err(PressureError::NoPush) };
                let start = DVec3::new(0.0, foot.y, foot.z);
                let near = start - start.dot(unit) * unit;
                cut(near, unit, radius, 1.0)
                    .map(|on_circle| foot + (on_circle - start).dot(unit) / share * along)
            }
        }?;
        if point.is_finite() { Ok(point) } else { Err(PressureError::NoPush) }
    }
}

/// Where the line from its foot `near` under the centre along the unit vector leaves the sphere (`side` 1) or enters it (-1).
fn cut(near: DVec3, along: DVec3, radius: f64, side: f64) -> Result<DVec3, PressureError> {
    let distance = near.length();
    let square = (radius - distance) * (radius + distance);
    // A radius that is no number cuts nothing.
    if square >= 0.0 {
        Ok(near + side * square.sqrt() * along)
    } else {
        Err(PressureError::Misses { distance, radius })
    }
}

/// A rectangle of taxels in the plane `z = 0` of its own frame, centred on the origin: columns along x, rows along y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaxelArray {
    /// Number of rows.
    pub rows: usize,
    /// Number of columns.
    pub columns: usize,
    /// Distance of the middles of two columns, m.
    pub pitch_x: f64,
    /// Distance of the middles of two rows, m.
    pub pitch_y: f64,
}

/// What an array of taxels feels as a whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pressed {
    /// Sum of the taxels that count, in their unit.
    pub sum: f64,
    /// Their weighted mean, in the array's frame, m.
    pub centre: DVec3,
}

impl TaxelArray {
    /// Middle of the taxel in a row and a column, both from 0, m.
    #[must_use]
    pub fn middle(&self, row: usize, column: usize) -> DVec3 {
        let from_middle = |index: usize, count: usize| index as f64 - 0.5 * (count as f64 - 1.0);
        let (x, y) = (from_middle(column, self.columns), from_middle(row, self.rows));
        DVec3::new(x * self.pitch_x, y * self.pitch_y, 0.0)
    }

    /// Sum and centre of pressure of `values`, row by row; of those alone that are at least `floor` times the largest
    /// (0.05, say, where noise on many idle taxels would draw the centre to the middle; with `None`, of all).
    ///
    /// None where there are too few values, one of them is not finite, or nothing is pressed.
    #[must_use]
    pub fn pressed(&self, values: &[f64], floor: Option<f64>) -> Option<Pressed> {
        if self.rows.checked_mul(self.columns) != Some(values.len()) || self.columns == 0 {
            return None;
        }
        let largest = values.iter().copied().fold(0.0, f64::max);
        let least = floor.map_or(f64::NEG_INFINITY, |floor| floor * largest);
        let (mut sum, mut first) = (0.0, DVec3::ZERO);
        for (row, line) in values.chunks_exact(self.columns).enumerate() {
            for (column, &value) in line.iter().enumerate() {
                if value >= least || !value.is_finite() {
                    sum += value;
                    first += value * self.middle(row, column);
                }
            }
        }
        let centre = first / sum;
        (sum > 0.0 && centre.is_finite()).then_some(Pressed { sum, centre })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const ALL: [PalmSurface; 4] = [
        PalmSurface::Plane,
        PalmSurface::Sphere { radius: 0.012 },
        PalmSurface::Cup { radius: 0.12 },
        PalmSurface::Cylinder { radius: 0.015 },
    ];

    proptest! {
        /// A planted contact: any point of the surface, any force within the friction cone of 45 degrees there.
        #[test]
        fn a_planted_contact_is_found_again(
            x in -0.1..0.1f64, y in -0.1..0.1f64, z in 0.005..0.1f64, size in 1e-3..100.0f64,
            tilt in 0.0..0.99f64, way in 0.0..6.0f64, twist in -1.0..1.0f64,
        ) {
            for surface in ALL {
                let near = surface.nearest(DVec3::new(x, y, z)).unwrap();
                let (n, c) = (near.n_P.get(), near.p_P);
                let t = n.any_orthonormal_vector();
                let force = size * (n + tilt * (way.cos() * t + way.sin() * n.cross(t)));
                // Torsional friction is along the force here, and must not matter off the plane.
                let along = if surface == PalmSurface::Plane { DVec3::ZERO } else { twist * 1e-3 * force };
                let found = surface.centre_of_pressure(force, c.cross(force) + along).unwrap();
                prop_assert!(found.distance(c) < 1e-14 * (1.0 + 1.0 / (1.0 - tilt)), "{surface:?} {found} {c}");
            }
        }

        #[test]
        fn no_wrench_makes_it_panic(w in proptest::array::uniform6(proptest::num::f64::ANY), r in proptest::num::f64::ANY) {
            let [force, torque] = [DVec3::new(w[0], w[1], w[2]), DVec3::new(w[3], w[4], w[5])];
            for surface in [
                PalmSurface::Plane,
                PalmSurface::Sphere { radius: r },
                PalmSurface::Cup { radius: r },
                PalmSurface::Cylinder { radius: r },
            ] {
                if let Ok(point) = surface.centre_of_pressure(force, torque) {
                    prop_assert!(!point.is_nan());
                }
            }
        }
    }

    #[test]
    fn what_no_contact_exerts_is_refused() {
        let plane = PalmSurface::Plane;
        assert_eq!(plane.centre_of_pressure(-DVec3::Z, DVec3::X), Err(PressureError::NoPush));
        assert_eq!(plane.centre_of_pressure(DVec3::ZERO, DVec3::X), Err(PressureError::NoPush));
        assert_eq!(plane.centre_of_pressure(DVec3::Z, DVec3::NAN), Err(PressureError::NotFinite));
        let ball = PalmSurface::Sphere { radius: 0.01 };
        let far = ball.centre_of_pressure(DVec3::Z, 0.02 * DVec3::X);
        assert_eq!(far, Err(PressureError::Misses { distance: 0.02, radius: 0.01 }));
        let along_the_axis = PalmSurface::Cylinder { radius: 0.01 }.centre_of_pressure(DVec3::X, DVec3::ZERO);
        assert_eq!(along_the_axis, Err(PressureError::NoPush));
    }

    #[test]
    fn taxels_are_about_the_middle_of_the_array() {
        let array = TaxelArray { rows: 2, columns: 3, pitch_x: 0.01, pitch_y: 0.02 };
        // All alike press in the middle, one alone in its own.
        let even = array.pressed(&[2.0; 6], None).unwrap();
        assert!(even.sum == 12.0 && even.centre.length() < 1e-18);
        let one = array.pressed(&[0.0, 0.0, 0.0, 0.0, 0.0, 5.0], None).unwrap();
        assert_eq!((one.sum, one.centre), (5.0, DVec3::new(0.01, 0.01, 0.0)));
        // What is below the floor counts for nothing; without one a pull counts.
        let values = [10.0, 0.0, 0.4, 0.0, -0.4, 0.0];
        assert_eq!(array.pressed(&values, Some(0.05)).unwrap().centre, array.middle(0, 0));
        assert_eq!(array.pressed(&values, None).unwrap().sum, 10.0);
        assert!(array.pressed(&[1.0; 5], None).is_none() && array.pressed(&[0.0; 6], None).is_none());
        assert!(array.pressed(&[1.0, 1.0, f64::NAN, 1.0, 1.0, 1.0], Some(0.5)).is_none());
    }
}
