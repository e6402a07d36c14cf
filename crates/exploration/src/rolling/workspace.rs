//! What the palms can do.

use contact_kinematics::planar::PalmPair;
use std::f64::consts::PI;
use thiserror::Error;

/// Limits of two hinged palms, and what is known of the body's size.
///
/// The set of allowed angles is convex: every straight way between two of them is allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Workspace {
    /// Least and largest absolute angle of each palm in rad. Both must stay in (0, pi): the weight is carried by both.
    pub angles: [[f64; 2]; 2],
    /// Least and largest angle from palm 1 to palm 2 in rad, in (0, pi).
    pub wedge: [f64; 2],
    /// Length of the palms from the hinge in m.
    pub length: f64,
    /// Largest speed of a palm in rad/s.
    pub speed: f64,
    /// Time in s that a body takes to come to rest after a fall.
    pub settle: f64,
    /// Mean width of the body in m, roughly: bodies are drawn so large where nothing is known yet. No proof rests on it.
    pub size: f64,
}

/// Why limits are none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum WorkspaceError {
    /// A number that is none or has the wrong sign.
    #[error("{what} is {value}; it must be positive and finite")]
    Positive {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// An interval that is none, or not where both palms carry.
    #[error("{what} from {low} to {high} rad: it must be an interval within (0, pi), the least first")]
    Interval {
        /// Which.
        what: &'static str,
        /// As given, rad.
        low: f64,
        /// As given, rad.
        high: f64,
    },
    /// No pair of angles is allowed.
    #[error(
        "the limits contradict each other: palms within theirs are {least:.4} to {most:.4} rad apart, and the wedge must be {low} to \
         {high} rad; widen one of them"
    )]
    Contradiction {
        /// Least wedge that the angles allow, rad.
        least: f64,
        /// Largest, rad.
        most: f64,
        /// Least wedge asked for, rad.
        low: f64,
        /// Largest, rad.
        high: f64,
    },
}

impl Workspace {
    /// Palms that turn almost from one side to the other, for a body of mean width `size` (m).
    #[must_use]
    pub fn for_size(size: f64) -> Self {
        Self {
            angles: [[0.1, 2.2], [PI - 2.2, PI - 0.1]],
            wedge: [0.6, 2.4],
            length: 4.0 * size,
            speed: 0.5,
            settle: 1.0,
            size,
        }
    }

    /// The same for a body that is not let come to rest: palms turn by 0.45 rad in a natural time (of half the size under `gravity`, m/s^2), as
    /// the estimate of its motion needs, and wait for two natural times after each motion.
    #[must_use]
    pub fn in_motion(size: f64, gravity: f64) -> Self {
        let time = (0.5 * size / gravity).sqrt();
        Self { speed: 0.45 / time, settle: 2.0 * time, ..Self::for_size(size) }
    }

    /// Whether these are limits.
    ///
    /// # Errors
    /// [`WorkspaceError`] names the first that is none.
    pub fn check(&self) -> Result<(), WorkspaceError> {
        let numbers = [
            ("length of the palms", self.length),
            ("speed of the palms", self.speed),
            ("size of the body", self.size),
        ];
        for (what, value) in numbers {
            if !(value > 0.0 && value.is_finite()) {
                return Err(WorkspaceError::Positive { what, value });
            }
        }
        if !(self.settle >= 0.0 && self.settle.is_finite()) {
            return Err(WorkspaceError::Positive { what: "time to settle", value: self.settle });
        }
        let [one, two] = self.angles;
        for (what, [low, high]) in [("palm 1", one), ("palm 2", two), ("the wedge", self.wedge)] {
            if !(low > 0.0 && high < PI && low <= high) {
                return Err(WorkspaceError::Interval { what, low, high });
            }
        }
        let ([least, most], [low, high]) = ([two[0] - one[1], two[1] - one[0]], self.wedge);
        if most < low || least > high {
            return Err(WorkspaceError::Contradiction { least, most, low, high });
        }
        Ok(())
    }

    /// Whether the palms can be at these absolute angles (rad); rounding counts as inside.
    #[must_use]
    pub fn allows(&self, palms: [f64; 2]) -> bool {
        const ROUNDING: f64 = 1e-9;
        let within = |x: f64, [low, high]: [f64; 2]| x >= low - ROUNDING && x <= high + ROUNDING;
        within(palms[0], self.angles[0])
            && within(palms[1], self.angles[1])
            && within(palms[1] - palms[0], self.wedge)
    }

    /// All allowed points of a lattice of `spacing` rad or less, row by row: in both angles, and where too few of these are allowed in one angle and the wedge.
    #[must_use]
    pub fn lattice(&self, spacing: f64) -> Vec<[f64; 2]> {
        let line = |[low, high]: [f64; 2]| -> Vec<f64> {
            if high <= low {
                return vec![low];
            }
            let parts = ((high - low) / spacing).ceil().max(1.0);
            (0..=parts as usize).map(|k| low + (high - low) * k as f64 / parts).collect()
        };
        let [one, two] = self.angles.map(line);
        let wedges = line(self.wedge);
        let pairs = |rows: &[f64], columns: &[f64], at: fn(f64, f64) -> [f64; 2]| -> Vec<[f64; 2]> {
            let all = rows.iter().flat_map(|a| columns.iter().map(move |b| at(*a, *b)));
            all.filter(|palms| self.allows(*palms)).collect()
        };
        let in_angles = pairs(&one, &two, |a, b| [a, b]);
        if in_angles.len() > 1 {
            return in_angles;
        }
        let with_wedge = [
            pairs(&one, &wedges, |a, wedge| [a, a + wedge]),
            pairs(&two, &wedges, |b, wedge| [b - wedge, b]),
        ];
        let larger =
            |all: Vec<[f64; 2]>, others: Vec<[f64; 2]>| if others.len() > all.len() { others } else { all };
        with_wedge.into_iter().fold(in_angles, larger)
    }

    /// Duration in s of a straight way between two pairs of angles, at the largest speed.
    #[must_use]
    pub fn seconds(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        let [a, b] = ways(from, to);
        a.max(b) / self.speed
    }
}

/// How far each palm turns, rad.
fn ways(from: [f64; 2], to: [f64; 2]) -> [f64; 2] {
    [(to[0] - from[0]).abs(), (to[1] - from[1]).abs()]
}

/// Radians of palm motion: the turns of both palms.
pub(super) fn radians(from: [f64; 2], to: [f64; 2]) -> f64 {
    let [a, b] = ways(from, to);
    a + b
}

/// Angles on the straight way, no palm turning by more than `step` rad from one to the next; the last is `to`.
pub(super) fn along(from: [f64; 2], to: [f64; 2], step: f64) -> impl Iterator<Item = [f64; 2]> {
    let [a, b] = ways(from, to);
    let parts = (a.max(b) / step).ceil().max(1.0) as usize;
    (1..=parts).map(move |k| {
        if k == parts {
            return to;
        }
        let share = k as f64 / parts as f64;
        [from[0] + share * (to[0] - from[0]), from[1] + share * (to[1] - from[1])]
    })
}

/// The pair of palms at absolute angles, where they enclose a wedge.
pub(super) fn pair(palms: [f64; 2]) -> Option<PalmPair> {
    PalmPair::from_absolute(palms[0], palms[1]).ok()
}
