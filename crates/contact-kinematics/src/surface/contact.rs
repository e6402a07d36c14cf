use super::{ContactError, PalmSurface, SurfaceState, forward};
use crate::{Direction, SupportFunction, SupportJet};
use glam::{DMat2, DMat3, DVec3};

/// Where a body stands: what a contact with a palm depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyPlace {
    /// Centre of mass, world, m.
    pub p_WCm: DVec3,
    /// Orientation, body axes to world axes.
    pub R_WO: DMat3,
}

/// The one datum of a contact: where a body is next to a palm, and how both are curved there. It holds off contact too.
///
/// Off contact the palm is taken inflated by the gap (a sphere's radius is then `radius + gap`), so that it touches the
/// body in the body's nearest point; every rate below is exact for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceContact {
    /// Distance of body and palm in m, negative where they penetrate.
    pub gap: f64,
    /// Outward normal of the body at the contact, body axes.
    pub n_O: Direction,
    /// Support function value, contact point from the centre of mass (body axes) and Hessian.
    pub jet: SupportJet,
    /// Contact point from the centre of mass, world axes, m.
    pub b_W: DVec3,
    /// Contact point, world, m.
    pub p_WC: DVec3,
    /// The palm's normal, into the object, world axes.
    pub n: DVec3,
    /// Tangent axes, world: `t[0] x t[1] = n`.
    pub t: [DVec3; 2],
    /// Radii of curvature of the body in the tangent axes, m: the inverse of its shape operator.
    pub body_radii: DMat2,
    /// Shape operator of the (inflated) palm in the tangent axes, 1/m: positive where the palm bulges towards the body.
    pub palm_shape: DMat2,
}

impl SurfaceContact {
    /// The contact of `body` with a palm. `guess` is the body's outward normal there, in body axes, where one is known.
    ///
    /// In closed form for planes. For spheres, cups and cylinders the distance is a minimum or maximum over the normal:
    /// Newton's method, safeguarded by that, to rounding.
    ///
    /// # Errors
    /// [`ContactError`].
    pub fn new(
        body: &(impl SupportFunction + ?Sized),
        place: &BodyPlace,
        surface: PalmSurface,
        palm: &SurfaceState,
        guess: Option<Direction>,
    ) -> Result<Self, ContactError> {
        let found = forward::find(body, place, surface, palm, guess)?;
        let b_W = place.R_WO * found.jet.point;
        let n = -(place.R_WO * found.n_O.get());
        let t0 = match surface {
            // Along the cylinder, so that its shape operator is diagonal.
            PalmSurface::Cylinder { .. } => palm.R_WP.x_axis,
            _ => tangent(palm.R_WP, n),
        };
        let t = [t0, n.cross(t0)];
        let hessian = place.R_WO * found.jet.hessian * place.R_WO.transpose();
        let entry = |i: usize, j: usize| t[i].dot(hessian * t[j]);
        Ok(Self {
            gap: found.gap,
            n_O: found.n_O,
            jet: found.jet,
            b_W,
            p_WC: place.p_WCm + b_W,
            n,
            t,
            body_radii: DMat2::from_cols_array(&[entry(0, 0), entry(1, 0), entry(0, 1), entry(1, 1)]),
            palm_shape: DMat2::from_diagonal(surface.curvatures(found.gap).into()),
        })
    }
}

/// A unit tangent at `n`: the palm's x axis made orthogonal to it, or its y axis where that is the longer one.
fn tangent(R_WP: DMat3, n: DVec3) -> DVec3 {
    let project = |axis: DVec3| axis - n.dot(axis) * n;
    let (x, y) = (project(R_WP.x_axis), project(R_WP.y_axis));
    // Of two orthogonal axes one is at least 45 degrees off n: the length is at least 0.7.
    let longer = if x.length_squared() >= 0.5 { x } else { y };
    longer.normalize()
}
