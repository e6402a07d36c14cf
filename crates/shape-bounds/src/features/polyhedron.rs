//! The polyhedron, where corners, edges and faces are all there is.

use super::found::{FeatureKind, Features};
use crate::noise::quantile::length3;
use exact_hull::HalfSpace;
use exact_hull::Hull;
use exact_hull::Intersection;
use exact_hull::TriangleMesh;
use glam::DVec3;

/// Odds at which a corner that all its faces meet in is taken for another.
const APART: f64 = 1e-3;

/// Share of the contacts that may be told to be smooth: so many may be told wrong.
const MAY_BE_WRONG: f64 = 0.05;

/// A polyhedron that was found by its corners and faces. An estimate, and no bound.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPolyhedron {
    /// Its surface, body axes, m.
    pub mesh: TriangleMesh,
    /// Its volume, m^3.
    pub volume: f64,
    /// Whether faces make it, and corners agree; else it is the hull of the corners, and may lack some that were not touched.
    pub by_faces: bool,
}

impl Features {
    /// The polyhedron that corners and faces make: where faces close it, and each corner is one of theirs, the intersection of their
    /// half-spaces, else the hull of the corners. None where more than one in twenty contacts is on smooth surface, or they enclose nothing.
    #[must_use]
    pub fn polyhedron(&self) -> Option<FoundPolyhedron> {
        let all: usize = self.runs.iter().map(|run| run.count).sum();
        if self.contacts(Some(FeatureKind::Smooth)) as f64 > MAY_BE_WRONG * all as f64 {
            return None;
        }
        self.by_faces().or_else(|| self.by_corners())
    }

    fn by_corners(&self) -> Option<FoundPolyhedron> {
        let corners: Vec<DVec3> = self.corners.iter().map(|corner| corner.point).collect();
        let Ok(Hull::Solid(hull)) = Hull::of(&corners) else { return None };
        Some(FoundPolyhedron { volume: hull.volume(), mesh: hull.mesh(), by_faces: false })
    }

    fn by_faces(&self) -> Option<FoundPolyhedron> {
        if self.faces.len() < 4 {
            return None;
        }
        let half_space =
            |face: &super::Face| HalfSpace { point: face.point, normal: face.normal, margin: 0.0 };
        let half_spaces: Vec<HalfSpace> = self.faces.iter().map(half_space).collect();
        let Ok(Intersection::Bounded(made)) = Intersection::of(&half_spaces) else { return None };
        let limit = length3(APART);
        // Where faces meet is known no better than they are.
        let lever = |v: &DVec3| self.faces.iter().map(|f| f.turn * v.distance(f.point)).fold(0.0, f64::max);
        let agrees = |corner: &super::Corner| {
            let c = corner.covariance;
            let deviation = (c.x_axis.x + c.y_axis.y + c.z_axis.z).max(0.0).sqrt();
            made.vertices().iter().any(|v| v.distance(corner.point) <= limit * (deviation + lever(v)))
        };
        self.corners.iter().all(agrees).then(|| FoundPolyhedron {
            volume: made.volume(),
            mesh: made.mesh(),
            by_faces: true,
        })
    }
}
