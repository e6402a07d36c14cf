use super::error::ContactSimulationError as Error;
use crate::BodyState;
use crate::SimulationError;
use crate::contacts::{ContactScene, MOST_PALMS, PalmCoordinates, SceneState};
use contact_kinematics::{PalmSurface, SupportFunction, SurfaceState};

/// Gaps below this share of the object's size are taken for contact, and closed; an object placed to five digits starts so.
const TOUCHING: f64 = 1e-4;

/// State at `t = 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactStart {
    /// The body.
    pub body: BodyState,
    /// Palms that give way; none: as [`ContactScene::palms_at_start`].
    pub palms: Option<[PalmCoordinates; MOST_PALMS]>,
    /// Whether the object may start without touching anything.
    pub in_flight: bool,
}

impl ContactStart {
    /// A body that touches some palm, with springs without load.
    #[must_use]
    pub fn touching(body: BodyState) -> Self {
        Self { body, palms: None, in_flight: false }
    }

    pub(super) fn state<S: SupportFunction>(&self, scene: &ContactScene<S>) -> Result<SceneState, Error> {
        let body = &self.body;
        let unusable = |what| Err(SimulationError::InitialMotion { what }.into());
        if !(body.R_WO.is_finite() && body.R_WO.length() > 1e-6) {
            return unusable("orientation");
        }
        if !(body.p_WCm.is_finite() && body.v_WCm.is_finite() && body.w_WO.is_finite()) {
            return unusable("position or velocity");
        }
        let palms = self.palms.unwrap_or_else(|| scene.palms_at_start());
        if !palms.iter().all(|p| p.position.is_finite() && p.velocity.is_finite()) {
            return unusable("state of a palm");
        }
        let body = BodyState { R_WO: body.R_WO.normalize(), ..*body };
        Ok(SceneState { t: 0.0, body, palms })
    }

    /// Which palms the body touches at the start.
    pub(super) fn closed(&self, gaps: &[f64], size: f64) -> Result<[bool; MOST_PALMS], Error> {
        let mut closed = [false; MOST_PALMS];
        let mut nearest = (0, f64::INFINITY);
        for (i, &gap) in gaps.iter().enumerate() {
            if gap < -TOUCHING * size {
                return Err(Error::Penetration { palm: i + 1, depth: -gap });
            }
            closed[i] = gap <= TOUCHING * size;
            if gap < nearest.1 {
                nearest = (i, gap);
            }
        }
        if self.in_flight || closed.contains(&true) {
            Ok(closed)
        } else {
            Err(Error::NotInContact { palm: nearest.0 + 1, gap: nearest.1 })
        }
    }
}

/// Axes and planes within this angle (rad) of each other are parallel: directions that are given to six digits are.
const PARALLEL: f64 = 1e-6;

/// Palms nearer to each other than this share of the object's size are the same.
const SAME: f64 = 1e-6;

/// Refuses palms that overlap each other. A plane is taken to end where a plane, a cup or a cylinder crosses it, and a cylinder
/// where a cup does: only what lies along a plane, or is round, can be sunk into it.
pub(super) fn check_overlap(surfaces: &[(PalmSurface, SurfaceState)], size: f64) -> Result<(), Error> {
    for (second, b) in surfaces.iter().enumerate() {
        for (first, a) in surfaces[..second].iter().enumerate() {
            if coincide(a, b, size) {
                let (first, second, kind) = (first + 1, second + 1, a.0.name());
                return Err(Error::PalmsCoincide { first, second, kind });
            }
            let depth = -distance(a, b).min(distance(b, a));
            if depth > 0.0 {
                return Err(Error::PalmsOverlap { first: first + 1, second: second + 1, depth });
            }
        }
    }
    Ok(())
}

/// Whether two planes or cups are one: the object would touch both at the same point, and nothing says which bears it.
fn coincide((a, at): &(PalmSurface, SurfaceState), (b, bt): &(PalmSurface, SurfaceState), size: f64) -> bool {
    let (between, n) = (bt.p_WP - at.p_WP, at.R_WP.z_axis);
    match (*a, *b) {
        (PalmSurface::Plane, PalmSurface::Plane) => {
            (bt.R_WP.z_axis - n).length() <= PARALLEL && n.dot(between).abs() <= SAME * size
        }
        (PalmSurface::Cup { radius: r }, PalmSurface::Cup { radius: s }) => {
            between.length() + (r - s).abs() <= SAME * size
        }
        _ => false,
    }
}

/// Distance of two palms, in the order in which one kind is treated; infinite for the other order and where none is defined.
fn distance((a, at): &(PalmSurface, SurfaceState), (b, bt): &(PalmSurface, SurfaceState)) -> f64 {
    let between = bt.p_WP - at.p_WP;
    let (axis_a, axis_b) = (at.R_WP.x_axis, bt.R_WP.x_axis);
    match (*a, *b) {
        (PalmSurface::Sphere { radius: r }, PalmSurface::Sphere { radius: s }) => between.length() - r - s,
        (PalmSurface::Plane, PalmSurface::Sphere { radius }) => at.R_WP.z_axis.dot(between) - radius,
        (PalmSurface::Plane, PalmSurface::Cylinder { radius }) => {
            let parallel = at.R_WP.z_axis.dot(axis_b).abs() <= PARALLEL;
            if parallel { at.R_WP.z_axis.dot(between) - radius } else { f64::INFINITY }
        }
        (PalmSurface::Cup { radius }, PalmSurface::Sphere { radius: s }) => radius - between.length() - s,
        (PalmSurface::Cylinder { radius: r }, PalmSurface::Sphere { radius: s }) => {
            between.reject_from_normalized(axis_a).length() - r - s
        }
        (PalmSurface::Cylinder { radius: r }, PalmSurface::Cylinder { radius: s }) => {
            let normal = axis_a.cross(axis_b);
            // Nearly parallel axes are as far apart as seen across one of them.
            let apart = if normal.length() > PARALLEL {
                between.dot(normal.normalize()).abs()
            } else {
                between.reject_from_normalized(axis_a).length()
            };
            apart - r - s
        }
        _ => f64::INFINITY,
    }
}
