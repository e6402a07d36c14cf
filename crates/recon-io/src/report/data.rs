use super::ModeSpan;
use crate::TriangleMesh;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::PalmFrame;
use recon::object_dynamics::TrueState;
use recon::shape_bounds::Gap;
use thiserror::Error;

/// Everything that is told about one reconstruction, independent of how it was made. SI units.
///
/// Frames: world `W` (Z up), body `O` (origin in the estimated centre of mass, axes as estimated). Truth, where there
/// is one, must be given in the same body axes, so that orientations can be compared.
#[derive(Clone, Debug, PartialEq)]
pub struct ReportData {
    /// What was reconstructed, such as the name of the log.
    pub title: String,
    /// How far the result can be relied on.
    pub verdict: Verdict,
    /// Times of the samples in s, strictly increasing.
    pub times: Vec<f64>,
    /// The three palms, one entry per time.
    pub palms: [PalmTrack; 3],
    /// Estimated motion, one state per time.
    pub motion: Vec<MotionState>,
    /// Standard deviations of centre of mass, velocity, angular velocity and turn, world axes, one entry per time.
    pub deviations: Vec<[DVec3; 4]>,
    /// Whether the motion is relied on, one entry per time.
    pub relied_on: Vec<bool>,
    /// What the contact of each palm does.
    pub spans: Vec<Vec<ModeSpan>>,
    /// True motion, one state per time.
    pub truth: Option<Vec<MotionState>>,
    /// Bounds on the shape, in body axes.
    pub bounds: Option<Bounds>,
    /// The true shape, in body axes.
    pub true_shape: Option<TrueShape>,
    /// What the numbers rest on: residual, rank, condition and the like.
    pub evidence: Vec<Evidence>,
    /// What the reader must know, in plain words.
    pub warnings: Vec<String>,
    /// What to do next, in plain words.
    pub next: String,
}

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

/// One palm over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PalmTrack {
    /// Frame at each time, world axes.
    pub frames: Vec<PalmFrame>,
    /// Contact at each time; none where the palm does not touch.
    pub contacts: Vec<Option<PalmContact>>,
    /// Size of the normal force on the object at each time, N; none where it was not measured.
    pub forces: Vec<Option<f64>>,
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
    /// Lines on the surface, body axes.
    pub wireframe: Vec<Vec<DVec3>>,
    /// Volume in m^3.
    pub volume: Option<f64>,
}

/// Report data that do not fit together.
#[derive(Clone, Debug, Error, PartialEq)]
pub enum ReportError {
    /// A track has another length than the times.
    #[error("{what} has {found} entries for {expected} times")]
    Length {
        /// Which track.
        what: String,
        /// Number of times.
        expected: usize,
        /// Its length.
        found: usize,
    },
    /// There is nothing to show.
    #[error("a report needs at least two times; there are {found}")]
    TooShort {
        /// How many there are.
        found: usize,
    },
    /// Times that are not numbers or do not increase.
    #[error("time {index} is {value}; times must be finite and increase")]
    Times {
        /// Which, from 0.
        index: usize,
        /// As given.
        value: f64,
    },
}

impl ReportData {
    /// Checks that all tracks are as long as the times, and that time increases.
    ///
    /// # Errors
    /// [`ReportError`] names the track or the time.
    pub fn check(&self) -> Result<(), ReportError> {
        let expected = self.times.len();
        if expected < 2 {
            return Err(ReportError::TooShort { found: expected });
        }
        let increasing =
            |k: usize| self.times[k].is_finite() && (k == 0 || self.times[k] > self.times[k - 1]);
        if let Some(index) = (0..expected).find(|&k| !increasing(k)) {
            return Err(ReportError::Times { index, value: self.times[index] });
        }
        let palms = self.palms.iter().zip(1..).flat_map(|(palm, i)| {
            [
                (format!("frames of palm {i}"), palm.frames.len()),
                (format!("contacts of palm {i}"), palm.contacts.len()),
                (format!("forces of palm {i}"), palm.forces.len()),
            ]
        });
        let own = [
            ("motion", self.motion.len()),
            ("deviations", self.deviations.len()),
            ("reliance", self.relied_on.len()),
        ];
        let tracks = own
            .into_iter()
            .map(|(what, found)| (what.to_owned(), found))
            .chain(self.truth.iter().map(|t| ("truth".to_owned(), t.len())))
            .chain(palms);
        for (what, found) in tracks {
            if found != expected {
                return Err(ReportError::Length { what, expected, found });
            }
        }
        Ok(())
    }

    /// Largest error of a radius function, m; none without truth.
    #[must_use]
    pub fn largest_radius_error(&self) -> Option<f64> {
        Some(self.departures()?.iter().map(|of| of.radius).fold(0.0, f64::max))
    }

    /// How far the estimate is from the truth at each time; none without truth.
    pub(crate) fn departures(&self) -> Option<Vec<Departure>> {
        let truth = self.truth.as_ref()?;
        let one = |(k, (a, b)): (usize, (&MotionState, &MotionState))| Departure {
            radius: self.palms.iter().fold(0.0, |most: f64, palm| {
                let error = palm.contacts[k].map_or(0.0, |c| c.radius - palm.frames[k].n.dot(b.p_WCm));
                most.max(error.abs())
            }),
            ..Departure::between(a, b)
        };
        Some(self.motion.iter().zip(truth).enumerate().map(one).collect())
    }

    /// True radius functions at time `k`: `r_i = n_i . p_WCm`, as the palms pass through the origin.
    pub(crate) fn true_radii(&self, k: usize) -> Option<[f64; 3]> {
        let state = self.truth.as_ref()?[k];
        Some([0, 1, 2].map(|i| self.palms[i].frames[k].n.dot(state.p_WCm)))
    }
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
    /// Of the worst of the three radius functions, m.
    pub(crate) radius: f64,
}

impl Departure {
    /// Of two states of motion; nothing is said of radius functions.
    pub(crate) fn between(a: &MotionState, b: &MotionState) -> Self {
        Self {
            position: a.p_WCm.distance(b.p_WCm),
            angle: rotation_between(a.R_WO, b.R_WO),
            velocity: a.v_WCm.distance(b.v_WCm),
            angular_velocity: a.w_WO.distance(b.w_WO),
            radius: 0.0,
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
