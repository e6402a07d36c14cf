//! What is compared, and how far it is from the body.

use super::{Failure, bodies::Body};
use glam::DVec3;
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::approximation::{PrincipalSurface, SplineSurface};
use recon::shape_bounds::concave::{AlphaShape, HermiteSurface};
use recon::shape_bounds::exact_hull::{Hull, TriangleMesh};
use shape_bounds::generators::Source;

/// Places of the body's surface from which distances are measured.
const PLACES: usize = 300;
/// Triangles of a spline's mesh along an edge of the octahedron, and cells of a Hermite surface's.
const PARTS: usize = 10;
const CELLS: usize = 24;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Method {
    Hull,
    Alpha,
    Hermite,
    Spline,
    /// With the smoothing chosen by leaving out.
    Principal,
    /// With the noise stated.
    Stated,
}

/// The hull, which concave bodies have none of, behind those that all have: a method has one colour.
pub(super) const ALL: [Method; 6] =
    [Method::Alpha, Method::Hermite, Method::Spline, Method::Principal, Method::Hull, Method::Stated];

impl Method {
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Hull => "hull",
            Self::Alpha => "alpha shape",
            Self::Hermite => "Hermite surface",
            Self::Spline => "spline",
            Self::Principal => "principal surface",
            Self::Stated => "principal, noise stated",
        }
    }

    /// The name in a legend.
    pub(super) fn short(self) -> &'static str {
        match self {
            Self::Hull => "hull",
            Self::Alpha => "alpha",
            Self::Hermite => "Hermite",
            Self::Spline => "spline",
            Self::Principal => "principal",
            Self::Stated => "noise stated",
        }
    }
}

/// An approximation of any kind.
enum Made {
    Mesh(TriangleMesh),
    Hermite(Box<HermiteSurface>),
    Spline(Box<SplineSurface>),
}

/// Root mean square distance of the body's surface from the approximation, the largest distance either way (Hausdorff), and what the
/// approximation took, in ms.
#[derive(Clone, Copy)]
pub(super) struct Errors {
    pub(super) rms: f64,
    pub(super) largest: f64,
    pub(super) ms: f64,
}

/// The errors of a method; none where it refuses the contacts.
pub(super) fn errors(
    method: Method,
    body: &Body,
    contacts: &[ContactSample],
    noise: f64,
) -> Result<Option<Errors>, Failure> {
    let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
    let clock = cpu_time::ThreadTime::now();
    let made = match method {
        Method::Hull => Hull::of(&points)?.solid().map(|hull| Made::Mesh(hull.mesh())),
        Method::Alpha => {
            let shape = AlphaShape::of(&points)?;
            Some(Made::Mesh(shape.mesh(shape.connecting_radius())?))
        }
        Method::Hermite => HermiteSurface::through(contacts).ok().map(|s| Made::Hermite(Box::new(s))),
        Method::Spline => SplineSurface::through(contacts).ok().map(|s| Made::Spline(Box::new(s))),
        Method::Principal | Method::Stated => {
            let stated = Some(noise).filter(|_| method == Method::Stated);
            let found = PrincipalSurface::of(&points, stated).ok();
            found.map(|found| Made::Spline(Box::new(found.surface().clone())))
        }
    };
    let ms = clock.elapsed().as_secs_f64() * 1e3;
    let Some(made) = made else { return Ok(None) };
    let mut s = Source::new(0xF00D);
    let (mut squares, mut largest) = (0.0, 0.0_f64);
    for _ in 0..PLACES {
        let off = made.distance(body.seen(s.direction())?.point);
        squares += off * off;
        largest = largest.max(off);
    }
    for place in made.places() {
        largest = largest.max(body.distance(place)?);
    }
    Ok(Some(Errors { rms: (squares / PLACES as f64).sqrt(), largest, ms }))
}

impl Made {
    /// How far a point is from the surface, in m.
    fn distance(&self, x: DVec3) -> f64 {
        match self {
            Self::Mesh(mesh) => {
                mesh.corners().map(|corners| x.distance(nearest_of(x, corners))).fold(f64::INFINITY, f64::min)
            }
            Self::Spline(spline) => spline.distance(x).abs(),
            Self::Hermite(surface) => {
                // Down the gradient to the surface: its nearest place but for the square of the distance over the radius of curvature.
                let mut at = x;
                for _ in 0..6 {
                    let (value, gradient) = surface.value(at);
                    at -= gradient * (value / gradient.length_squared());
                }
                x.distance(at)
            }
        }
    }

    /// Points of the surface all over it.
    fn places(&self) -> Vec<DVec3> {
        let middles = |mesh: &TriangleMesh| mesh.corners().map(|[a, b, c]| (a + b + c) / 3.0).collect();
        match self {
            Self::Mesh(mesh) => middles(mesh),
            Self::Spline(spline) => spline.mesh(PARTS).vertices,
            Self::Hermite(surface) => {
                // Those of the mesh, put on the surface.
                let onto = |p: &DVec3| {
                    let (value, gradient) = surface.value(*p);
                    *p - gradient * (value / gradient.length_squared())
                };
                surface.mesh(CELLS).vertices.iter().map(onto).collect()
            }
        }
    }
}

/// The point of a triangle that is nearest (Ericson, "Real-time collision detection", 2005, section 5.1.5).
fn nearest_of(x: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let along = |p: DVec3| (ab.dot(x - p), ac.dot(x - p));
    let ((d1, d2), (d3, d4), (d5, d6)) = (along(a), along(b), along(c));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    a + (ab * vb + ac * vc) / (va + vb + vc)
}
