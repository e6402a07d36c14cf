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
/// Steps (rad) below this that get no shorter are rounding of the body's own support function: polynomials of high degree lose some digits.
const NO_SHORTER: f64 = 1e-11;
/// Share of the step before from which on a step is no shorter. Where curvatures nearly match steps still halve.
const STALLED: f64 = 0.9;

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
    let search = |kind| Search { body, D_O, kind };
    let start = guess.map_or(D_O, Direction::get);
    match surface {
        PalmSurface::Plane => {
            let n_O = Direction::new_unchecked(-(R_OW * palm.R_WP.z_axis));
            let jet = body.jet(n_O);
            Ok(Found { gap: n_O.get().dot(D_O) - jet.value, n_O, jet })
        }
        PalmSurface::Sphere { radius } => search(Kind::Nearest).settle(start)?.outside(radius),
        PalmSurface::Cylinder { radius } => {
            let axis = R_OW * palm.R_WP.x_axis;
            search(Kind::NearestAround { axis }).settle(start)?.outside(radius)
        }
        PalmSurface::Cup { radius } => {
            let now = search(Kind::Farthest).farthest(guess)?;
            Ok(Found { gap: radius + now.distance, n_O: Direction::new_unchecked(now.u), jet: now.jet })
        }
    }
}

/// Directions of the search over the whole sphere: the centres of so many squares along each edge of a cube about it.
const SQUARES: u32 = 8;
/// What a stationary value can give up at most on the way from its own direction to the nearest of these, as a share of its
/// bend: the square of half the diagonal of a square, halved. Seen from the centre the diagonal is at most that long in rad.
const GIVEN_UP: f64 = 1.0 / (SQUARES * SQUARES) as f64;

/// The directions of the search over the whole sphere.
fn directions() -> impl Iterator<Item = DVec3> {
    let centre = |k: u32| f64::from(2 * k + 1) / f64::from(SQUARES) - 1.0;
    let square = move |k: u32| (centre(k % SQUARES), centre(k / SQUARES));
    (0..SQUARES * SQUARES).map(square).flat_map(|(a, b)| {
        let faces = [DVec3::new(1.0, a, b), DVec3::new(a, 1.0, b), DVec3::new(a, b, 1.0)];
        faces.into_iter().flat_map(|v| [v.normalize(), -v.normalize()])
    })
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
    /// The farthest point: the stationary value near the guess if that is proved to be it, else the best of all that are reached
    /// from directions that can be nearest to the best.
    ///
    /// A stationary value at least as far as every radius of curvature is the farthest one: the body lies inside of the ball
    /// through it (Blaschke). Contacts are, as cups are wider than that.
    fn farthest(&self, guess: Option<Direction>) -> Result<Trial, ContactError> {
        let largest = self.body.curvature_radii().max;
        let is_proved = |now: &Trial| -now.distance >= largest;
        if let Some(Ok(now)) = guess.map(|guess| self.settle(guess.get()))
            && is_proved(&now)
        {
            return Ok(now);
        }
        let mut starts: Vec<Trial> = directions().map(|u| self.trial(u)).collect();
        starts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        let most = starts.iter().map(|start| start.distance.abs()).fold(0.0, f64::max);
        let given_up = GIVEN_UP * (most + largest) / (1.0 - GIVEN_UP);
        let best = starts.first().map_or(f64::NAN, |start| start.distance);
        let mut found: Result<Trial, _> = Err(ContactError::NotFinite);
        for start in starts.iter().take_while(|start| start.distance - best <= given_up) {
            found = match (self.settle(start.u), found) {
                (Ok(now), Ok(before)) if now.distance < before.distance => Ok(now),
                (_, Ok(before)) => Ok(before),
                (now, Err(_)) => now,
            };
            if found.as_ref().is_ok_and(is_proved) {
                break;
            }
        }
        found
    }

    /// Newton's method from `start` on.
    fn settle(&self, start: DVec3) -> Result<Trial, ContactError> {
        let Some(start) = self.unit(start) else { return Err(ContactError::CentreInside { depth: 0.0 }) };
        let (mut now, mut before) = (self.trial(start), f64::INFINITY);
        for _ in 0..MOST_STEPS {
            let step = self.newton(&now);
            let length = step.along.length();
            if length <= step.rounding || (length <= NO_SHORTER && length >= STALLED * before) {
                return Ok(now);
            }
            before = length;
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

impl Trial {
    /// The contact with a palm of this radius that the body is outside of.
    fn outside(self, radius: f64) -> Result<Found, ContactError> {
        if self.distance <= 0.0 {
            return Err(ContactError::CentreInside { depth: -self.distance });
        }
        Ok(Found { gap: self.distance - radius, n_O: Direction::new_unchecked(self.u), jet: self.jet })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Monomial, PolynomialSupport, SurfacePose};
    use glam::DQuat;

    /// A ball with a wave of degree 16, whose terms are some hundred times as large as their sum: jets are rounded by as much more.
    fn wavy() -> Result<PolynomialSupport, crate::ShapeError> {
        let (mut before, mut now) = ([0.0; 17], [0.0; 17]);
        now[0] = 1.0;
        for l in 0..16 {
            let m = l as f64;
            let shifted = |k: usize| if k > 0 { now[k - 1] } else { 0.0 };
            let next = std::array::from_fn(|k| ((2.0 * m + 1.0) * shifted(k) - m * before[k]) / (m + 1.0));
            (before, now) = (now, next);
        }
        let wave = now.iter().enumerate().map(|(k, c)| (k as u32, 3e-3 * c));
        let terms = wave.chain([(0, 1.0)]);
        let term = |(power, coefficient)| Monomial { powers: [0, 0, power], coefficient };
        PolynomialSupport::new(terms.map(term).collect())
    }

    #[test]
    fn a_body_whose_own_function_is_rounded_more_is_found_to_that() {
        let body = wavy().unwrap();
        let place = BodyPlace { p_WCm: DVec3::ZERO, R_WO: glam::DMat3::IDENTITY };
        let kinds = [(PalmSurface::Sphere { radius: 0.5 }, 1.6), (PalmSurface::Cup { radius: 4.0 }, 2.9)];
        for (k, along) in directions().enumerate() {
            let (surface, away) = kinds[k % kinds.len()];
            let palm = SurfacePose::new(along * away, DQuat::IDENTITY).unwrap().at_rest();
            let found = find(&body, &place, surface, &palm, None);
            let found = found.unwrap_or_else(|e| panic!("{surface:?} {along}: {e}"));
            // The palm's centre lies along the normal at the contact.
            let across = (palm.p_WP - found.jet.point).reject_from_normalized(found.n_O.get());
            assert!(across.length() < 1e-10, "{surface:?} {along}: {across}");
        }
    }
}
