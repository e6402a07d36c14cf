//! Coming down on a lattice of lines from several directions, more densely where the normal turns.

use super::edges::Edge;
use super::felt::{Relief, ReliefEnd};
use super::lines::{Line, ProbingFinger, Touch};
use crate::contour::Margins;
use contact_kinematics::Direction;
use glam::DVec3;
use thiserror::Error;

/// How densely a body is touched.
#[derive(Clone, Debug, PartialEq)]
pub struct Probing {
    /// Where the finger comes from; enough that each place is seen by two of them at less than 60 degrees.
    pub directions: Vec<Direction>,
    /// The body is within a ball of this radius about the origin, m: taken for known, and a contact outside of it is an error.
    pub reach: f64,
    /// Lines are so far apart at most, m, and less than the finger's radius.
    pub spacing: f64,
    /// And at least: what turns the normal inwards by more than `turn` over so little is a jump.
    pub least: f64,
    /// The normal turns by so much from line to line at most, rad, unless over the least spacing.
    pub turn: f64,
    /// How far touches may be off.
    pub margins: Margins,
    /// Lines at most, with those that are missed.
    pub readings: usize,
}

/// Why nothing is made of touches.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ProbingError<E> {
    /// A setting that is none.
    #[error(
        "{what} is {value}; it must be positive and finite, the spacing below the finger's radius, the least one no larger than it, and the turn below 1.5"
    )]
    Setting {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// No direction.
    #[error("there is no direction to come from")]
    NoDirections,
    /// A contact where the body was said not to be.
    #[error(
        "contact {touch} is at {distance} m from the origin, where the body was said to be within {reach} m: state a larger reach"
    )]
    BeyondReach {
        /// Number of the touch, from 0.
        touch: usize,
        /// m.
        distance: f64,
        /// m.
        reach: f64,
    },
    /// A contact that is not one of this finger on its line.
    #[error(
        "contact {touch} with its normal puts the finger's centre {off} m off the line that it came on, more than the {margin} m that touches may be off"
    )]
    OffLine {
        /// Number of the touch, from 0.
        touch: usize,
        /// m.
        off: f64,
        /// m.
        margin: f64,
    },
    /// The finger.
    #[error(transparent)]
    Finger(E),
}

/// Of exact touches, what a centre may be off its line by rounding and by the iteration that found them, over the reach.
const OFF_LINE: f64 = 1e-6;

impl Probing {
    fn check<E>(&self, q: f64) -> Result<(), ProbingError<E>> {
        let Self { reach, spacing, least, turn, margins, .. } = *self;
        if self.directions.is_empty() {
            return Err(ProbingError::NoDirections);
        }
        let settings = [
            ("radius of the finger", q, q > 0.0),
            ("reach", reach, reach > 0.0),
            ("spacing", spacing, spacing > 0.0 && spacing < q),
            ("least spacing", least, least > 0.0 && least <= spacing),
            ("turn", turn, turn > 0.0 && turn < 1.5),
            ("margin of points", margins.point, margins.point >= 0.0),
            ("margin of normals", margins.normal, margins.normal >= 0.0),
        ];
        let bad = settings.into_iter().find(|(_, value, good)| !(*good && value.is_finite()));
        bad.map_or(Ok(()), |(what, value, _)| Err(ProbingError::Setting { what, value }))
    }

    /// How wide what a finger of radius `q` (m) jumps over may be at most without being told, m: as [`crate::contour::Tracing::unseen`], over the way of a centre
    /// that climbs by 60 degrees from one line to the next.
    #[must_use]
    pub fn unseen(&self, q: f64) -> f64 {
        (self.turn + 2.0 * self.margins.of_turn()).mul_add(q, self.spacing / super::edges::FACING)
    }
}

/// Brings a finger down on a body.
///
/// Each direction has a lattice of lines. Between neighbours that both face the direction lines are added half-way where the normal turns by too much, down to the least spacing.
/// Where the readings are used up what was felt so far is handed back.
///
/// # Errors
/// [`ProbingError`].
pub fn probe<F: ProbingFinger>(finger: &mut F, probing: &Probing) -> Result<Relief, ProbingError<F::Error>> {
    probing.check(finger.radius())?;
    let mut run = Run { finger, probing, relief: Relief::new(probing, 0.0) };
    run.relief.radius = run.finger.radius();
    for along in &probing.directions {
        if !run.from(*along)? {
            return Ok(run.relief);
        }
    }
    run.relief.end = ReliefEnd::Done;
    run.relief.look_for_rims();
    Ok(run.relief)
}

struct Run<'a, F> {
    finger: &'a mut F,
    probing: &'a Probing,
    relief: Relief,
}

/// A lattice of one direction: touches by their numbers, in rows.
pub(super) struct Lattice {
    pub(super) rows: Vec<Vec<Option<usize>>>,
}

impl<F: ProbingFinger> Run<'_, F> {
    /// One direction; whether there are readings left.
    fn from(&mut self, along: Direction) -> Result<bool, ProbingError<F::Error>> {
        let Probing { reach, spacing, .. } = *self.probing;
        let (e, f) = along.tangent_basis();
        // Whatever is across within the reach is within a spacing of a line on either side.
        let half = (reach / spacing).ceil() + 1.0;
        let count = 2 * half as usize + 1;
        let mut lattice = Lattice { rows: vec![vec![None; count]; count] };
        for i in 0..count {
            for j in 0..count {
                let at = (e * (i as f64 - half) + f * (j as f64 - half)) * spacing;
                if at.length() > reach + 1.5 * spacing {
                    continue;
                }
                if self.relief.readings >= self.probing.readings {
                    return Ok(false);
                }
                lattice.rows[i][j] = self.touch(Line { along, at })?;
            }
        }
        let judged = self.edges(&lattice, [e, f])?;
        self.relief.patch(&lattice, &judged);
        Ok(self.relief.readings < self.probing.readings)
    }

    /// All edges of a lattice, those that turn too much in pieces: of each touch whether the edges to the next one along both axes were felt all along or jumped.
    fn edges(
        &mut self,
        lattice: &Lattice,
        axes: [DVec3; 2],
    ) -> Result<Vec<Vec<[bool; 2]>>, ProbingError<F::Error>> {
        let count = lattice.rows.len();
        let mut judged = vec![vec![[false; 2]; count]; count];
        for i in 0..count {
            for j in 0..count {
                for (k, [p, q]) in [[i + 1, j], [i, j + 1]].into_iter().enumerate() {
                    let next = lattice.rows.get(p).and_then(|row| row.get(q)).copied().flatten();
                    if let (Some(from), Some(to)) = (lattice.rows[i][j], next) {
                        judged[i][j][k] = self.edge([from, to], axes[k])?;
                    }
                }
            }
        }
        Ok(judged)
    }

    /// An edge, halved as long as it turns too much; whether the lattice sees the surface all along it.
    fn edge(&mut self, ends: [usize; 2], axis: DVec3) -> Result<bool, ProbingError<F::Error>> {
        let (turn, margins) = (self.probing.turn + self.probing.margins.of_turn(), self.probing.margins);
        let mut open = vec![(ends, self.probing.spacing)];
        let mut seen = true;
        while let Some((ends, length)) = open.pop() {
            let edge = Edge::of(ends.map(|k| self.relief.touches[k]), axis, length, self.relief.radius);
            if !edge.is_seen(&margins) {
                seen = false;
                continue;
            }
            // As fine as it gets, but for rounding of halves.
            if edge.turn <= turn || length <= self.probing.least * (1.0 + 1e-9) {
                self.relief.judge(ends, &edge, turn, &margins);
                continue;
            }
            if self.relief.readings >= self.probing.readings {
                return Ok(false);
            }
            let [a, b] = ends.map(|k| self.relief.touches[k].line);
            match self.touch(Line { along: a.along, at: 0.5 * (a.at + b.at) })? {
                Some(middle) => {
                    open.extend([[ends[0], middle], [middle, ends[1]]].map(|ends| (ends, 0.5 * length)))
                }
                None => seen = false,
            }
        }
        Ok(seen)
    }

    /// Comes down a line: the number of its touch.
    fn touch(&mut self, line: Line) -> Result<Option<usize>, ProbingError<F::Error>> {
        self.relief.readings += 1;
        let Some(touch) = self.finger.approach(&line).map_err(ProbingError::Finger)? else {
            self.relief.misses.push(line);
            return Ok(None);
        };
        let (number, reach) = (self.relief.touches.len(), self.probing.reach);
        let touch = Touch { line, ..touch };
        let distance = touch.point.length();
        let margins = &self.probing.margins;
        if distance.is_nan() || distance > reach + margins.point {
            return Err(ProbingError::BeyondReach { touch: number, distance, reach });
        }
        let margin = margins.of_centre(self.relief.radius) + OFF_LINE * reach;
        let off = line.off(touch.centre(self.relief.radius)).length();
        if off.is_nan() || off > margin {
            return Err(ProbingError::OffLine { touch: number, off, margin });
        }
        self.relief.touches.push(touch);
        Ok(Some(number))
    }
}
