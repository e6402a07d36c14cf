use super::error::ApproximationError;
use super::mesh::sphere;
use super::principal::{Principal, principal};
use super::star::{Frame, Prepared};
use super::through::Spline;
use super::{cells, check, unit};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use exact_hull::{HalfSpace, Hull, Intersection, SolidHull, TriangleMesh};
use glam::DVec3;
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Cells to a spacing of the contacts: with fewer the lattice limits what contacts tell, more change nothing.
const FINE: f64 = 1.5;
/// Cells from centre to sphere, least and most: the equations of 10 take some seconds.
const SPLINE_CELLS: [usize; 2] = [2, 10];
/// The same of a principal surface, whose equations are solved for each smoothing that is compared.
const PRINCIPAL_CELLS: [usize; 2] = [2, 4];
/// Contacts of a spline, and points of a principal surface, at least.
const LEAST: usize = 4;
const LEAST_SCATTERED: usize = 20;

/// The smooth surface through contact points with the contact normals, of a body that is seen from some place inside as a whole.
///
/// Of all cubic splines on a lattice about the sphere it has the smallest second and third derivatives (mean squares), and is twice continuously differentiable. On a
/// smooth body it errs with the fourth power of the contacts' spacing. Contacts that are denser than the lattice, as along a curve, are
/// met by least squares ([`SplineSurface::residual`]). Noise is interpolated as well.
#[derive(Clone, Debug)]
pub struct SplineSurface(Spline<3>);

impl SplineSurface {
    /// The surface through `contacts`, in any order.
    ///
    /// # Errors
    /// [`ApproximationError`] for fewer than 4 contacts, points that are not finite or span no volume, a body that is not
    /// star-shaped as far as its contacts tell, and equations that are singular.
    pub fn through(contacts: &[ContactSample]) -> Result<Self, ApproximationError> {
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        let Prepared { framed, points, hull } = prepared(&points, LEAST)?;
        let pairs: Vec<_> = points.iter().zip(contacts).map(|(p, c)| (*p, vector(c.normal.get()))).collect();
        let half = cells(FINE, spacing(contacts.len()), SPLINE_CELLS);
        let kernel = || {
            let half_spaces = points.iter().zip(contacts);
            let half_spaces: Vec<HalfSpace> =
                half_spaces.map(|(p, c)| HalfSpace { point: glam(p), ..c.half_space() }).collect();
            let inner = match Intersection::of(&half_spaces).map_err(ApproximationError::of_kernel)? {
                Intersection::Bounded(kernel) => kernel.moments().centroid,
                Intersection::Unbounded(open) => open.interior(),
            };
            Ok(hull.contains(inner).then(|| vector(inner)))
        };
        Ok(Self(Spline::through(framed, &pairs, half, kernel)?))
    }

    /// Root mean square distance in m of what the surface was made of: contacts, or points.
    #[must_use]
    pub fn residual(&self) -> f64 {
        self.0.residual
    }

    /// The place from which the surface is seen as a whole, in m.
    #[must_use]
    pub fn centre(&self) -> DVec3 {
        glam(&self.0.centre())
    }

    /// The point of the surface (m) that the centre sees along a direction of any length.
    #[must_use]
    pub fn point(&self, direction: DVec3) -> DVec3 {
        glam(&self.0.seen(&vector(direction)).0)
    }

    /// The outward normal there.
    #[must_use]
    pub fn normal(&self, direction: DVec3) -> Direction {
        Direction::new_unchecked(glam(&self.0.seen(&vector(direction)).1).normalize())
    }

    /// Whether a point (m) is inside.
    #[must_use]
    pub fn contains(&self, point: DVec3) -> bool {
        self.0.contains(&vector(point))
    }

    /// How far outside of the surface a point near it is, in m; below zero inside.
    #[must_use]
    pub fn distance(&self, point: DVec3) -> f64 {
        self.0.distance(&vector(point))
    }

    /// The surface as `8 parts^2` triangles, anticlockwise from outside: closed, its corners on the surface.
    #[must_use]
    pub fn mesh(&self, parts: usize) -> TriangleMesh {
        let (directions, triangles) = sphere(parts);
        TriangleMesh {
            vertices: directions.iter().map(|u| glam(&self.0.at(&vector(*u)))).collect(),
            triangles,
        }
    }
}

/// The principal surface of noisy points: each of its points is the mean of those that are nearest to it (Hastie and Stuetzle,
/// "Principal curves", 1989), on a closed surface that is seen from the centroid of the points' hull as a whole.
///
/// Normals are not needed. How much is smoothed the points tell: each is predicted by all others, or noise is stated. Points spread
/// about a surface by `s` lie farther out by `s^2 H` on the average, with the mean curvature `H`, as on a sphere of radius `r`
/// `s^2 / r` ([`PrincipalSurface::bias`]); smoothing adds what it takes off bumps narrower than it.
///
/// ```
/// use glam::DVec3;
/// use shape_bounds::approximation::PrincipalSurface;
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// // A ball of radius 0.1 m; every other point is 1 mm too far out, the others too far in.
/// let turn = std::f64::consts::PI * (3.0 - 5_f64.sqrt());
/// let points: Vec<DVec3> = (0..200)
///     .map(|k| {
///         let z = (2.0 * f64::from(k) + 1.0) / 200.0 - 1.0;
///         let (sin, cos) = (turn * f64::from(k)).sin_cos();
///         let out = (1.0 - z * z).sqrt();
///         DVec3::new(out * cos, out * sin, z) * (0.1 + if k % 2 == 0 { 1e-3 } else { -1e-3 })
///     })
///     .collect();
/// let found = PrincipalSurface::of(&points, None)?;
/// assert!((found.surface().point(DVec3::X).length() - 0.1).abs() < 3e-4);
/// assert!((found.scatter() - 1e-3).abs() < 2e-4 && found.has_converged());
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct PrincipalSurface(Principal<SplineSurface>);

impl PrincipalSurface {
    /// The principal surface of `points` (m), whose `noise` across the surface has this standard deviation (m) if it is stated.
    ///
    /// # Errors
    /// [`ApproximationError`] for fewer than 20 points, values that are not finite, points without volume, noise that is not above
    /// zero, and equations that are singular.
    pub fn of(points: &[DVec3], noise: Option<f64>) -> Result<Self, ApproximationError> {
        let Prepared { framed, points, .. } = prepared(points, LEAST_SCATTERED)?;
        let half = cells(1.0, spacing(points.len()), PRINCIPAL_CELLS);
        Ok(Self(principal(framed, &points, half, noise)?.map(SplineSurface)))
    }

    /// The surface itself; its residual is the scatter.
    #[must_use]
    pub fn surface(&self) -> &SplineSurface {
        &self.0.surface
    }

    /// Standard deviation of the points across the surface in m, what was spent on the surface accounted for.
    #[must_use]
    pub fn scatter(&self) -> f64 {
        self.0.surface.residual()
    }

    /// How many parameters were spent on the points: between 4 and their number.
    #[must_use]
    pub fn freedom(&self) -> f64 {
        self.0.freedom
    }

    /// By how much the surface is too far out on the average because it is curved, in m, if the scatter is noise alike in all
    /// directions: its square times the mean curvature (mean over the surface, by Minkowski's formula).
    #[must_use]
    pub fn bias(&self) -> f64 {
        self.0.bias
    }

    /// Rounds of projecting and smoothing.
    #[must_use]
    pub fn rounds(&self) -> usize {
        self.0.rounds
    }

    /// Whether the last round moved the surface by less than a thousandth of the scatter (root mean square at the points).
    #[must_use]
    pub fn has_converged(&self) -> bool {
        self.0.converged
    }
}

fn vector(v: DVec3) -> Vector3<f64> {
    Vector3::new(v.x, v.y, v.z)
}

fn glam(v: &Vector3<f64>) -> DVec3 {
    DVec3::new(v.x, v.y, v.z)
}

/// The distance of neighbours of so many on the unit sphere.
fn spacing(count: usize) -> f64 {
    (4.0 * PI / count as f64).sqrt()
}

/// The frame of the points' hull with the power of two that it is in units of, points and hull in these.
fn prepared(points: &[DVec3], least: usize) -> Result<Prepared<3, SolidHull>, ApproximationError> {
    check(points.iter().map(|p| p.is_finite()), least)?;
    let unit = unit(points.iter().flat_map(|p| p.to_array()));
    let points: Vec<DVec3> = points.iter().map(|p| *p / unit).collect();
    let hull = Hull::of(&points).map_err(|_| ApproximationError::Range)?;
    let dimension = hull.dimension();
    let hull = hull.into_solid().ok_or(ApproximationError::Flat { dimension })?;
    let centre = hull.moments().centroid;
    let facets = (0..hull.triangles().len()).map(|facet| {
        let [a, b, c] = hull.corners(facet).map(|p| p - centre);
        ([a, b, c].map(vector), a.dot((b - a).cross(c - a)))
    });
    let frame = Frame::of_hull(vector(centre), facets)?;
    let points = points.into_iter().map(vector).collect();
    Ok(Prepared { framed: (frame, unit), points, hull })
}
