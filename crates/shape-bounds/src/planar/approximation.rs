//! Approximations of an outline: a spline through contacts, a principal curve of noisy points.

use super::ContactSample;
use crate::approximation::principal::{Principal, principal};
use crate::approximation::star::{Frame, Prepared};
use crate::approximation::through::Spline;
use crate::approximation::{ApproximationError, cells, check, unit};
use exact_hull::planar::{ConvexPolygon, Direction, HalfPlane, Hull, Intersection, IntersectionError};
use glam::DVec2;
use nalgebra::Vector2;
use std::f64::consts::TAU;

/// Cells to a spacing of the contacts, and from centre to circle.
const FINE: f64 = 2.0;
const SPLINE_CELLS: [usize; 2] = [2, 128];
const PRINCIPAL_CELLS: [usize; 2] = [2, 32];
/// Contacts of a spline, and points of a principal curve, at least.
const LEAST: usize = 3;
const LEAST_SCATTERED: usize = 12;

/// The smooth closed curve through contact points with the contact normals, of an outline that is seen from some place inside as a
/// whole: what [`crate::approximation::SplineSurface`] is in space.
///
/// ```
/// use glam::DVec2;
/// use shape_bounds::planar::ContactSample;
/// use shape_bounds::planar::approximation::SplineCurve;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // The outline at 1 + 0.3 cos 2t m, which has a waist, touched at 16 places.
/// let point = |t: f64| DVec2::from_angle(t) * (1.0 + 0.3 * (2.0 * t).cos());
/// let contact = |t: f64| {
///     let (out, across) = (DVec2::from_angle(t), DVec2::from_angle(t).perp());
///     let normal = out * (1.0 + 0.3 * (2.0 * t).cos()) + across * (0.6 * (2.0 * t).sin());
///     (point(t), normal.normalize())
/// };
/// let contacts = ContactSample::from_raw((0..16).map(|k| contact(std::f64::consts::TAU * f64::from(k) / 16.0)))?;
/// let curve = SplineCurve::through(&contacts)?;
/// // Halfway between two contacts:
/// assert!(curve.distance(point(std::f64::consts::PI / 16.0)).abs() < 1e-3);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct SplineCurve(Spline<2>);

impl SplineCurve {
    /// The curve through `contacts`, in any order.
    ///
    /// # Errors
    /// [`ApproximationError`] for fewer than 3 contacts, points that are not finite or on one line, an outline that is not
    /// star-shaped as far as its contacts tell, and equations that are singular.
    pub fn through(contacts: &[ContactSample]) -> Result<Self, ApproximationError> {
        let points: Vec<DVec2> = contacts.iter().map(|c| c.point).collect();
        let Prepared { framed, points, hull } = prepared(&points, LEAST)?;
        let pairs: Vec<_> = points.iter().zip(contacts).map(|(p, c)| (*p, vector(c.normal.get()))).collect();
        let half = cells(FINE, TAU / contacts.len() as f64, SPLINE_CELLS);
        let kernel = || {
            let half_planes = points.iter().zip(contacts);
            let half_planes: Vec<HalfPlane> =
                half_planes.map(|(p, c)| HalfPlane { point: glam(p), ..c.half_plane() }).collect();
            let inner = match Intersection::of(&half_planes).map_err(not_star_shaped)? {
                Intersection::Bounded(kernel) => centroid(kernel.shape().vertices()),
                Intersection::Unbounded(open) => open.interior(),
            };
            Ok(hull.contains(inner).then(|| vector(inner)))
        };
        Ok(Self(Spline::through(framed, &pairs, half, kernel)?))
    }

    /// Root mean square distance in m of what the curve was made of: contacts, or points.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.0.residual
    }

    /// The place from which the curve is seen as a whole, in m.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        glam(&self.0.centre())
    }

    /// The point of the curve (m) that the centre sees along a direction of any length.
    #[must_use]
    pub fn point(&self, direction: DVec2) -> DVec2 {
        glam(&self.0.seen(&vector(direction)).0)
    }

    /// The outward normal there.
    #[must_use]
    pub fn normal(&self, direction: DVec2) -> Direction {
        Direction::from_angle(glam(&self.0.seen(&vector(direction)).1).to_angle())
    }

    /// Whether a point (m) is inside.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        self.0.contains(&vector(point))
    }

    /// How far outside of the curve a point near it is, in m; below zero inside.
    #[must_use]
    pub fn distance(&self, point: DVec2) -> f64 {
        self.0.distance(&vector(point))
    }

    /// So many points of the curve, anticlockwise.
    #[must_use]
    pub fn outline(&self, count: usize) -> Vec<DVec2> {
        let turn = |k: usize| vector(DVec2::from_angle(TAU * k as f64 / count as f64));
        (0..count).map(|k| glam(&self.0.at(&turn(k)))).collect()
    }
}

/// The principal curve of noisy points, closed: each of its points is the mean of those that are nearest to it. What
/// [`crate::approximation::PrincipalSurface`] is in space, with the same words; points spread by `s` lie `s^2 / 2r` too far out where the radius of
/// curvature is `r`.
///
/// ```
/// use glam::DVec2;
/// use shape_bounds::planar::approximation::PrincipalCurve;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A disc of radius 0.1 m; every other point is 1 mm too far out, the others too far in.
/// let turn = |k: u32| DVec2::from_angle(std::f64::consts::TAU * f64::from(k) / 100.0);
/// let points: Vec<DVec2> = (0..100).map(|k| turn(k) * if k % 2 == 0 { 0.101 } else { 0.099 }).collect();
/// let found = PrincipalCurve::of(&points, None)?;
/// assert!((found.curve().point(DVec2::X).length() - 0.1).abs() < 2e-4);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct PrincipalCurve(Principal<SplineCurve>);

impl PrincipalCurve {
    /// The principal curve of `points` (m), whose `noise` across it has this standard deviation (m) if it is stated.
    ///
    /// # Errors
    /// [`ApproximationError`] for fewer than 12 points, values that are not finite, points on one line, noise that is not above
    /// zero, and equations that are singular.
    pub fn of(points: &[DVec2], noise: Option<f64>) -> Result<Self, ApproximationError> {
        let Prepared { framed, points, .. } = prepared(points, LEAST_SCATTERED)?;
        let half = cells(1.0, TAU / points.len() as f64, PRINCIPAL_CELLS);
        Ok(Self(principal(framed, &points, half, noise)?.map(SplineCurve)))
    }

    /// The curve itself; its residual is the scatter.
    #[must_use]
    pub fn curve(&self) -> &SplineCurve {
        &self.0.surface
    }

    /// Standard deviation of the points across the curve in m, what was spent on the curve accounted for.
    #[must_use]
    pub fn scatter(&self) -> f64 {
        self.0.surface.residual()
    }

    /// How many parameters were spent on the points: between 3 and their number.
    #[must_use]
    pub fn freedom(&self) -> f64 {
        self.0.freedom
    }

    /// By how much the curve is too far out on the average because it is curved, in m, if the scatter is noise alike in all directions.
    #[must_use]
    pub fn bias(&self) -> f64 {
        self.0.bias
    }

    /// Rounds of projecting and smoothing.
    #[must_use]
    pub fn rounds(&self) -> usize {
        self.0.rounds
    }

    /// Whether the last round moved the curve by less than a thousandth of the scatter (root mean square at the points).
    #[must_use]
    pub fn has_converged(&self) -> bool {
        self.0.converged
    }
}

fn vector(v: DVec2) -> Vector2<f64> {
    Vector2::new(v.x, v.y)
}

fn glam(v: &Vector2<f64>) -> DVec2 {
    DVec2::new(v.x, v.y)
}

fn not_star_shaped(error: IntersectionError) -> ApproximationError {
    let contacts = match error {
        IntersectionError::Contradiction { conflict, .. } => conflict,
        IntersectionError::NoInterior { tight, .. } => tight,
        _ => Vec::new(),
    };
    ApproximationError::NotStarShaped { contacts }
}

/// Of a polygon, about its first corner.
fn centroid(corners: &[DVec2]) -> DVec2 {
    let (mut sum, mut area) = (DVec2::ZERO, 0.0);
    for pair in corners.windows(2) {
        let (a, b) = (pair[0] - corners[0], pair[1] - corners[0]);
        area += a.perp_dot(b);
        sum += (a + b) * (a.perp_dot(b) / 3.0);
    }
    corners[0] + sum / area
}

/// The frame of the points' hull with the power of two that it is in units of, points and hull in these.
fn prepared(points: &[DVec2], least: usize) -> Result<Prepared<2, ConvexPolygon>, ApproximationError> {
    check(points.iter().map(|p| p.is_finite()), least)?;
    let unit = unit(points.iter().flat_map(|p| p.to_array()));
    let points: Vec<DVec2> = points.iter().map(|p| *p / unit).collect();
    let hull = Hull::of(&points).map_err(|_| ApproximationError::Range)?;
    let flat = ApproximationError::Flat { dimension: hull.dimension() };
    let polygon = hull.polygon().ok_or(flat)?.shape();
    let centre = centroid(polygon.vertices());
    let facets = polygon.edges().map(|(a, b)| {
        let (a, b) = (a - centre, b - centre);
        ([a, b].map(vector), a.perp_dot(b))
    });
    let frame = Frame::of_hull(vector(centre), facets)?;
    let points = points.into_iter().map(vector).collect();
    Ok(Prepared { framed: (frame, unit), points, hull: polygon.clone() })
}
