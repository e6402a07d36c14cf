use crate::TriangleMesh;
use glam::{DQuat, DVec3};
use recon::object_dynamics::TrueState;
use recon::shape_bounds::Gap;

/// Whether the result can be relied on, and why, in one sentence.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The level.
    pub level: Level,
    /// One sentence.
    pub text: String,
}

/// How a piece of evidence speaks.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Level {
    /// For the result.
    Good,
    /// It must be known to judge the result.
    Caution,
    /// Against the result.
    Bad,
    /// Neither for nor against.
    Neutral,
}

/// The name of a level in JSON and in style.
pub(crate) fn level(level: Level) -> &'static str {
    match level {
        Level::Good => "good",
        Level::Caution => "caution",
        Level::Bad => "bad",
        Level::Neutral => "neutral",
    }
}

/// One number or word that the result rests on.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// Name that a program can look for, such as `residual_rms`.
    pub key: String,
    /// What it is called.
    pub name: String,
    /// Its value.
    pub value: EvidenceValue,
    /// SI unit; empty for a pure number.
    pub unit: String,
    /// What it means, in one short sentence.
    pub meaning: String,
    /// How it speaks.
    pub level: Level,
}

/// A number or a word.
#[derive(Clone, Debug, PartialEq)]
pub enum EvidenceValue {
    /// A measured or computed number.
    Number(f64),
    /// A count.
    Count(u64),
    /// A word, such as a status.
    Text(String),
}

/// Where a palm touches the object at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmContact {
    /// Contact in the world, m.
    pub p_WC: DVec3,
    /// Contact from the centre of mass, body axes, m: a point of the contact curve.
    pub p_OC: DVec3,
    /// Outward unit normal of the object there, body axes.
    pub normal: DVec3,
    /// Radius function `r`: distance of the tangent plane from the centre of mass, m.
    pub radius: f64,
}

/// Motion at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionState {
    /// Centre of mass, m, world.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Velocity of the centre of mass, m/s, world.
    pub v_WCm: DVec3,
    /// Angular velocity, rad/s, world axes.
    pub w_WO: DVec3,
}

impl From<TrueState> for MotionState {
    fn from(s: TrueState) -> Self {
        Self { p_WCm: s.p_WCm, R_WO: s.R_WO, v_WCm: s.v_WCm, w_WO: s.w_WO }
    }
}

/// Lower and upper bound on the object.
#[derive(Clone, Debug, PartialEq)]
pub struct Bounds {
    /// Inside the object.
    pub lower: Bound,
    /// Around the object; none where the contacts leave it unbounded.
    pub upper: Option<Bound>,
    /// Where the upper bound is farthest from the lower one, body axes: a touch tells most there, and the distance is the Hausdorff distance of the
    /// two. None without an upper bound, or where nothing is between them.
    pub largest_gap: Option<Gap>,
}

/// A convex bound.
#[derive(Clone, Debug, PartialEq)]
pub struct Bound {
    /// Surface, body axes.
    pub mesh: TriangleMesh,
    /// Volume in m^3.
    pub volume: f64,
}

/// The true shape, as far as it is known.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrueShape {
    /// Surface, body axes.
    pub mesh: TriangleMesh,
    /// Volume in m^3.
    pub volume: Option<f64>,
}

/// How far an estimate is from the truth at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Departure {
    /// Of the centre of mass, m.
    pub(crate) position: f64,
    /// Of the orientation, rad.
    pub(crate) angle: f64,
    /// Of the velocity, m/s.
    pub(crate) velocity: f64,
    /// Of the angular velocity, rad/s.
    pub(crate) angular_velocity: f64,
}

impl Departure {
    /// Of two states of motion.
    pub(crate) fn between(a: &MotionState, b: &MotionState) -> Self {
        Self {
            position: a.p_WCm.distance(b.p_WCm),
            angle: rotation_between(a.R_WO, b.R_WO),
            velocity: a.v_WCm.distance(b.v_WCm),
            angular_velocity: a.w_WO.distance(b.w_WO),
        }
    }
}

/// Angle between two orientations in rad, exact for small ones too: `2 atan2(|v|, |w|)` of their quotient.
fn rotation_between(a: DQuat, b: DQuat) -> f64 {
    let d = a.conjugate() * b;
    2.0 * d.xyz().length().atan2(d.w.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_rotations_are_measured_exactly() {
        for angle in [1e-12, 1e-6, 0.1, 3.0] {
            let a = DQuat::from_scaled_axis(DVec3::new(0.3, -1.0, 0.2));
            let b = a * DQuat::from_axis_angle(DVec3::Z, angle);
            for b in [b, -b] {
                assert!((rotation_between(a, b) - angle).abs() < 4.0 * f64::EPSILON, "{angle}");
            }
        }
    }
}
