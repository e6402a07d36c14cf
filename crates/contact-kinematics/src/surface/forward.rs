//! Where a body touches a palm: the normal at which the distance of body and palm is stationary.
//!
//! With `D = p_WP - p_WCm` in body axes, `f(u) = u . D - h(u)` over outward normals `u` of the body is the distance of the
//! palm's centre from the body: its largest value for a sphere (over all `u`) and a cylinder (over the circle of `u`
//! orthogonal to the axis); minus its smallest is the distance of the farthest point, for a cup.

use super::{BodyPlace, ContactError, PalmSurface, SurfaceState};
use crate::{Direction, SupportFunction, SupportJet};
use glam::DVec3;

/// Newton's method takes 3 to 6 steps; a search that needs more than this is lost.
const MOST_STEPS: u32 = 60;
/// Longest step in rad: beyond it the quadratic model of the distance says little.
const LONGEST_STEP: f64 = 0.3;
/// A residual of `D - x` below this many units of rounding of its terms is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

pub(super) struct Found {
    pub(super) gap: f64,
    pub(super) n_O: Direction,
    pub(super) jet: SupportJet,
}

pub(super) fn find(
    body: &(impl SupportFunction + ?Sized),
    place: &BodyPlace,
    surface: PalmSurface,
    palm: &SurfaceState,
    guess: Option<Direction>,
) -> Result<Found, ContactError> {
    let R_OW = place.R_WO.transpose();
    let D_O = R_OW * (palm.p_WP - place.p_WCm);
    if !(D_O.is_finite() && palm.R_WP.is_finite()) {
        return Err(ContactError::NotFinite);
    }
    let search = |kind, start: DVec3, radius: f64| {
        Search { body, D_O, kind }.run(guess.map_or(start, Direction::get), radius)
    };
    match surface {
        PalmSurface::Plane => {
            let n_O = Direction::new_unchecked(-(R_OW * palm.R_WP.z_axis));
            let jet = body.jet(n_O);
            Ok(Found { gap: n_O.get().dot(D_O) - jet.value, n_O, jet })
        }
        PalmSurface::Sphere { radius } => search(Kind::Nearest, D_O, radius),
        PalmSurface::Cylinder { radius } => {
            let axis = R_OW * palm.R_WP.x_axis;
            search(Kind::NearestAround { axis }, D_O, radius)
        }
        PalmSurface::Cup { radius } => {
            let start = if guess.is_some() { DVec3::ZERO } else { farthest(body, D_O) };
            search(Kind::Farthest, start, radius)
        }
    }
}

/// A normal near that of the point farthest from `D_O`: the best of the six axes and of the direction away from `D_O`.
fn farthest(body: &(impl SupportFunction + ?Sized), D_O: DVec3) -> DVec3 {
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    let away = Direction::new(-D_O).map(Direction::get).ok();
    let mut best = (f64::NEG_INFINITY, DVec3::Z);
    for u in axes.into_iter().chain(away) {
        let distance = (body.jet(Direction::new_unchecked(u)).point - D_O).length();
        if distance > best.0 {
            best = (distance, u);
        }
    }
    best.1
}

#[derive(Clone, Copy)]
enum Kind {
    Nearest,
    NearestAround { axis: DVec3 },
    Farthest,
}

struct Search<'a, S: ?Sized> {
    body: &'a S,
    D_O: DVec3,
    kind: Kind,
}

impl<S: SupportFunction + ?Sized> Search<'_, S> {
    fn run(&self, start: DVec3, radius: f64) -> Result<Found, ContactError> {
        let Some(start) = self.unit(start) else { return Err(ContactError::CentreInside { depth: 0.0 }) };
        let mut now = self.trial(start);
        for _ in 0..MOST_STEPS {
            let step = self.newton(&now);
            if step.along.length() <= step.rounding {
                return self.found(&now, radius);
            }
            now = self.along(&now, step.along);
        }
        Err(ContactError::NotFound { iterations: MOST_STEPS, residual: self.newton(&now).along.length() })
    }

    /// `u` as a unit vector that the search may use.
    fn unit(&self, u: DVec3) -> Option<DVec3> {
        let allowed = match self.kind {
            Kind::NearestAround { axis } => u - axis.dot(u) * axis,
            Kind::Nearest | Kind::Farthest => u,
        };
        Direction::new(allowed).ok().map(Direction::get)
    }

    fn trial(&self, u: DVec3) -> Trial {
        let jet = self.body.jet(Direction::new_unchecked(u));
        Trial { u, jet, distance: u.dot(self.D_O) - jet.value }
    }

    /// Newton's step for the stationary value of the distance, in the tangent plane at `u`; where its matrix is not
    /// definite (the start is far off), a step that leads downhill all the same.
    fn newton(&self, now: &Trial) -> Step {
        let residual = self.D_O - now.jet.point;
        let noise = ROUNDING * (self.D_O.length() + now.jet.point.length());
        let (a, b) = match self.kind {
            Kind::NearestAround { axis } => {
                let around = axis.cross(now.u);
                let (slope, bend) = (around.dot(residual), around.dot(now.jet.hessian * around));
                let stiffness = bend + now.distance.max(-0.5 * bend);
                return Step { along: around * (slope / stiffness), rounding: noise / stiffness };
            }
            Kind::Nearest | Kind::Farthest => Direction::new_unchecked(now.u).tangent_basis(),
        };
        let (ha, hb) = (now.jet.hessian * a, now.jet.hessian * b);
        let (haa, hab, hbb) = (a.dot(ha), a.dot(hb), b.dot(hb));
        // Eigenvalues of the Hessian bound the shift that keeps the matrix definite.
        let (mean, half) = (0.5 * (haa + hbb), (0.5 * (haa - hbb)).hypot(hab));
        let shift = match self.kind {
            Kind::Farthest => now.distance.min(-(mean + half) * (1.0 + 1e-12)),
            _ => now.distance.max(-0.5 * (mean - half)),
        };
        let (saa, sbb) = (haa + shift, hbb + shift);
        let determinant = saa * sbb - hab * hab;
        let (ra, rb) = (a.dot(residual), b.dot(residual));
        if determinant.abs() <= f64::EPSILON * (saa * saa + sbb * sbb) {
            // Curvatures match: any small step downhill.
            let sign = if matches!(self.kind, Kind::Farthest) { -1.0 } else { 1.0 };
            let along = (a * ra + b * rb) * (sign * LONGEST_STEP / residual.length().max(f64::MIN_POSITIVE));
            return Step { along, rounding: ROUNDING };
        }
        let (da, db) = ((sbb * ra - hab * rb) / determinant, (saa * rb - hab * ra) / determinant);
        let softest = (mean + shift).abs() - half;
        Step { along: a * da + b * db, rounding: noise / softest.max(f64::MIN_POSITIVE) }
    }

    /// Goes along a step, shortened until the distance gets no worse.
    fn along(&self, now: &Trial, step: DVec3) -> Trial {
        let size = step.length();
        let mut scale = (LONGEST_STEP / size).min(1.0);
        let slack = 8.0 * f64::EPSILON * (now.jet.value.abs() + self.D_O.length());
        for _ in 0..40 {
            let Some(u) = self.unit(now.u + step * scale) else { break };
            let trial = self.trial(u);
            let gain = match self.kind {
                Kind::Farthest => now.distance - trial.distance,
                _ => trial.distance - now.distance,
            };
            if gain >= -slack {
                return trial;
            }
            scale *= 0.5;
        }
        *now
    }

    fn found(&self, now: &Trial, radius: f64) -> Result<Found, ContactError> {
        let gap = match self.kind {
            Kind::Farthest => radius + now.distance,
            Kind::Nearest | Kind::NearestAround { .. } => {
                if now.distance <= 0.0 {
                    return Err(ContactError::CentreInside { depth: -now.distance });
                }
                now.distance - radius
            }
        };
        Ok(Found { gap, n_O: Direction::new_unchecked(now.u), jet: now.jet })
    }
}

/// A step in the tangent plane, and the length of one that is made of rounding alone, rad.
struct Step {
    along: DVec3,
    rounding: f64,
}

#[derive(Clone, Copy)]
struct Trial {
    u: DVec3,
    jet: SupportJet,
    distance: f64,
}
