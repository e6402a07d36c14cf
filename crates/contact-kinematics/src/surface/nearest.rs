use super::PalmSurface;
use crate::Direction;
use glam::DVec3;

/// The point of a palm's surface that is nearest to a given one, palm axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The point, m.
    pub p_P: DVec3,
    /// The palm's normal there, into the object.
    pub n_P: Direction,
    /// How far the given point is off the surface along the normal, m: positive on the object's side.
    pub distance: f64,
}

impl PalmSurface {
    /// The point of the surface nearest to `p_P` (palm axes, m); none in the centre of a sphere or cup and on the axis of a
    /// cylinder, where all are equally near, and where `p_P` is not finite.
    #[must_use]
    pub fn nearest(&self, p_P: DVec3) -> Option<SurfacePoint> {
        if !p_P.is_finite() {
            return None;
        }
        let round = |foot: DVec3, radius: f64| {
            let arm = p_P - foot;
            let out = Direction::new(arm).ok()?;
            Some(SurfacePoint { p_P: foot + radius * out.get(), n_P: out, distance: arm.length() - radius })
        };
        match *self {
            Self::Plane => {
                let foot = DVec3::new(p_P.x, p_P.y, 0.0);
                Some(SurfacePoint { p_P: foot, n_P: Direction::Z, distance: p_P.z })
            }
            Self::Sphere { radius } => round(DVec3::ZERO, radius),
            Self::Cylinder { radius } => round(DVec3::new(p_P.x, 0.0, 0.0), radius),
            Self::Cup { radius } => round(DVec3::ZERO, radius).map(|point| SurfacePoint {
                n_P: -point.n_P,
                distance: -point.distance,
                ..point
            }),
        }
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
        #[test]
        fn a_point_is_its_nearest_point_and_the_way_along_the_normal(
            x in -0.1..0.1f64, y in -0.1..0.1f64, z in -0.1..0.1f64,
        ) {
            let p = DVec3::new(x, y, z);
            prop_assume!(y.hypot(z) > 1e-3);
            for surface in ALL {
                let near = surface.nearest(p).unwrap();
                let along = near.p_P + near.distance * near.n_P.get();
                prop_assert!((along - p).length() < 1e-15, "{surface:?} {along} {p}");
                let again = surface.nearest(near.p_P).unwrap();
                prop_assert!(again.distance.abs() < 1e-16 && (again.n_P.get() - near.n_P.get()).length() < 1e-15);
            }
        }
    }

    #[test]
    fn normals_lead_into_the_object() {
        let at = |surface: PalmSurface| surface.nearest(DVec3::new(0.004, 0.0, 0.012)).unwrap();
        assert_eq!(ALL.map(|surface| at(surface).n_P.get().z > 0.0), [true, true, false, true]);
        // Outside of a fingertip and inside of a cup.
        assert_eq!(ALL.map(|surface| at(surface).distance > 0.0), [true, true, true, false]);
        assert_eq!(at(ALL[3]).n_P, Direction::Z);
        let low = PalmSurface::Plane.nearest(DVec3::new(1.0, 2.0, -3.0)).unwrap();
        assert_eq!((low.p_P, low.distance), (DVec3::new(1.0, 2.0, 0.0), -3.0));
    }

    #[test]
    fn where_all_are_equally_near_there_is_none() {
        let in_the_centre = ALL.map(|surface| surface.nearest(DVec3::ZERO).is_none());
        assert_eq!(in_the_centre, [false, true, true, true]);
        assert!(ALL[3].nearest(DVec3::X).is_none() && ALL[0].nearest(DVec3::NAN).is_none());
    }
}
