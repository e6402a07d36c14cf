//! A body on three palms of one kind, and the motion of the palms, which is the same for all kinds.

use super::body::{PalmBody, SIZE};
use super::rest::lowest;
use super::shape::PalmShape;
use exploration::Source;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{
    Direction, DirectionError, MotionLaw, MotionPart, PalmFrame, PalmSurface, SupportFunction, SurfaceError,
    SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::{BodyState, ContactScene, ContactSceneError, PalmDrive, ScenePalm};
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// Gravity, m/s^2.
pub const GRAVITY: f64 = 9.81;

/// How palms are curved, radii in sizes of the body (half of its mean width).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PalmKind {
    /// Planes.
    Flat,
    /// Balls, the body outside of them.
    Convex(f64),
    /// Hollow spheres, the body inside of them.
    Concave(f64),
}

impl PalmKind {
    /// All that are compared, flat ones first.
    pub const ALL: [Self; 7] = [
        Self::Flat,
        Self::Convex(1.25),
        Self::Convex(0.75),
        Self::Convex(0.5),
        Self::Concave(10.0),
        Self::Concave(5.0),
        Self::Concave(3.5),
    ];

    /// Its name in tables.
    #[must_use]
    pub fn name(self) -> String {
        match self {
            Self::Flat => "flat".to_owned(),
            Self::Convex(radius) => format!("convex, {radius}"),
            Self::Concave(radius) => format!("concave, {radius}"),
        }
    }

    /// Curvature over that of a ball of the body's size: positive where palms bulge towards the body.
    #[must_use]
    pub fn curvature(self) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Convex(radius) => 1.0 / radius,
            Self::Concave(radius) => -1.0 / radius,
        }
    }

    /// The surface.
    #[must_use]
    pub fn surface(self) -> PalmSurface {
        match self {
            Self::Flat => PalmSurface::Plane,
            Self::Convex(radius) => PalmSurface::Sphere { radius: radius * SIZE },
            Self::Concave(radius) => PalmSurface::Cup { radius: radius * SIZE },
        }
    }

    /// From a point of the surface to the origin of the palm's frame, along the palm's normal there, m.
    fn to_origin(self) -> f64 {
        match self {
            Self::Flat => 0.0,
            Self::Convex(radius) => -radius * SIZE,
            Self::Concave(radius) => radius * SIZE,
        }
    }
}

/// What is held equal for all kinds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// Slope of the palms at the start, rad.
    pub slope: f64,
    /// Largest angle of a tilt about the palm's hinge, and about the line up the palm, rad.
    pub tilts: [f64; 2],
    /// From the start of a palm's tilt to that of the next palm's, s: half of what a tilt lasts.
    pub ramp: f64,
    /// Tilts, each about both axes.
    pub count: usize,
    /// Coefficient of friction.
    pub friction: f64,
}

/// As compared: chosen on seeds 150000 to 150009.
pub const MOTION: Motion =
    Motion { slope: 55.0 * PI / 180.0, tilts: [0.25; 2], ramp: 0.3, count: 12, friction: 0.0 };

/// A change of one palm's tilt about one of its axes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tilt {
    palm: usize,
    axis: usize,
    angle: f64,
    start: f64,
}

impl Motion {
    /// Seconds from the start to the end.
    #[must_use]
    pub fn duration(&self) -> f64 {
        (self.count as f64 + 1.0) * self.ramp + 0.1
    }

    /// Tilts in an order and with angles drawn from a seed: each goes from one angle to another, palm by palm.
    fn tilts(&self, seed: u64) -> Vec<Tilt> {
        let mut source = Source::new(seed);
        let mut at = [[0.0; 2]; 3];
        let (mut all, mut palm) = (Vec::new(), 0);
        for k in 0..self.count {
            palm = (palm + if source.unit() < 0.5 { 1 } else { 2 }) % 3;
            for axis in 0..2 {
                let most = self.tilts[axis];
                let to = source.between(0.5, 1.0) * most * if at[palm][axis] > 0.0 { -1.0 } else { 1.0 };
                all.push(Tilt { palm, axis, angle: to - at[palm][axis], start: k as f64 * self.ramp });
                at[palm][axis] = to;
            }
        }
        all
    }

    /// The palms' frames at the start: three planes through the world's origin, evenly around.
    #[must_use]
    pub fn frames(&self) -> [PalmFrame; 3] {
        [0, 1, 2].map(|k| PalmFrame::from_azimuth_slope(f64::from(k) * TAU / 3.0, self.slope))
    }

    /// Turns, about the point where it touches at the start, of a palm that touches at `p_WC` (m) at the start, whatever its surface.
    ///
    /// # Errors
    /// An axis without a direction, which frames do not have.
    pub fn parts(&self, palm: usize, p_WC: DVec3, seed: u64) -> Result<Vec<MotionPart>, DirectionError> {
        let frame = self.frames()[palm];
        let axes = [Direction::new(frame.t1)?, Direction::new(frame.t2)?];
        let part = |tilt: Tilt| MotionPart::Turn {
            pivot: p_WC,
            axis: axes[tilt.axis],
            law: MotionLaw::Ramp { height: tilt.angle, start: tilt.start, duration: 2.0 * self.ramp },
        };
        Ok(self.tilts(seed).into_iter().filter(|t| t.palm == palm).map(part).collect())
    }
}

/// Why a body cannot be put on palms.
#[derive(Debug, Error)]
pub enum HoldError {
    /// An axis.
    #[error(transparent)]
    Axis(#[from] DirectionError),
    /// A pose.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// The scene.
    #[error(transparent)]
    Scene(#[from] ContactSceneError),
}

/// A scene and where its body is at the start.
pub type Held<'a> = (ContactScene<&'a PalmShape>, BodyState);

/// The body at rest on three palms of one kind. Where it touches, and with which normals, is that of a rest on flat palms without
/// friction: the palms' curved surfaces are put to the same points and normals.
///
/// # Errors
/// [`HoldError`].
pub fn held<'a>(
    body: &'a PalmBody,
    kind: PalmKind,
    motion: &Motion,
    seed: u64,
) -> Result<Held<'a>, HoldError> {
    let frames = motion.frames();
    let start = lowest(&body.shape, frames.map(|f| f.n), Source::new(seed).rotation());
    let mut palms = Vec::with_capacity(3);
    for (k, frame) in frames.iter().enumerate() {
        let n_O = Direction::new(start.R_WO.inverse() * -frame.n)?;
        let p_WC = start.p_WCm + start.R_WO * body.shape.point(n_O);
        let origin = p_WC + frame.n * kind.to_origin();
        let pose = SurfacePose::new(origin, DQuat::from_mat3(&frame.rotation()))?;
        palms.push(ScenePalm {
            surface: kind.surface(),
            drive: PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts: motion.parts(k, p_WC, seed)? }),
            friction: motion.friction,
        });
    }
    Ok((ContactScene::new(&body.shape, body.mass, palms, GRAVITY)?, start))
}
