use super::{ContactError, PalmSurface, SurfaceState, forward};
use crate::planar::radius::{RadiusFunction, RadiusJet};
use glam::DVec2;

/// Where a body stands: what a contact with a palm depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BodyPlace {
    /// Centre of mass, world, m.
    pub p_WCm: DVec2,
    /// Orientation, rad.
    pub phi0: f64,
}

/// The one datum of a contact: where a body is next to a palm, and how both are curved there. It holds off contact too.
///
/// Off contact the palm is taken inflated by the gap (an arc's radius is then `radius + gap`), so that it touches the body
/// in the body's nearest point; every rate is exact for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceContact {
    /// Distance of body and palm in m, negative where they penetrate.
    pub gap: f64,
    /// Direction of the body's outward normal at the contact, body axes, rad.
    pub theta: f64,
    /// Radius function there; its `rho` is the body's radius of curvature.
    pub jet: RadiusJet,
    /// Contact point from the centre of mass, world axes, m.
    pub b_W: DVec2,
    /// Contact point, world, m.
    pub p_WC: DVec2,
    /// The palm's normal, into the object, world axes.
    pub n: DVec2,
    /// Its tangent, world axes: `n` is `t` turned by a quarter counter-clockwise.
    pub t: DVec2,
    /// Curvature of the (inflated) palm, 1/m: positive where it bulges towards the body.
    pub palm_curvature: f64,
}

impl SurfaceContact {
    /// The contact of `shape` with a palm. `guess` is the direction of the body's outward normal there (rad, body axes),
    /// where one is known.
    ///
    /// In closed form for lines. For arcs and cups the distance of the palm's centre from the body is a maximum or minimum
    /// over the normal: Newton's method in a bracket, to rounding.
    ///
    /// # Errors
    /// [`ContactError`].
    pub fn new(
        shape: &(impl RadiusFunction + ?Sized),
        place: &BodyPlace,
        surface: PalmSurface,
        palm: &SurfaceState,
        guess: Option<f64>,
    ) -> Result<Self, ContactError> {
        let found = forward::find(shape, place, surface, palm, guess)?;
        let outward = match surface {
            // The angle's sum would cost digits that the palm's own axes have.
            PalmSurface::Line => -DVec2::from_angle(palm.angle).perp(),
            PalmSurface::Arc { .. } | PalmSurface::Cup { .. } => DVec2::from_angle(found.theta + place.phi0),
        };
        let (n, t) = (-outward, outward.perp());
        let b_W = -(found.jet.r * n + found.jet.d * t);
        let palm_curvature = match surface {
            PalmSurface::Line => 0.0,
            PalmSurface::Arc { radius } => 1.0 / (radius + found.gap),
            PalmSurface::Cup { radius } => 1.0 / (found.gap - radius),
        };
        Ok(Self {
            gap: found.gap,
            theta: found.theta,
            jet: found.jet,
            b_W,
            p_WC: place.p_WCm + b_W,
            n,
            t,
            palm_curvature,
        })
    }
}
