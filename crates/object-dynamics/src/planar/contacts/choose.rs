//! Which modes the contacts take.

use super::{ContactProblem, PlanarMode, Response, respond};
use nalgebra::{DMatrix, Vector3};
use thiserror::Error;

/// Share of the largest force or rate by which a sign may be wrong: what a run is held to.
pub(in crate::planar) const CONSISTENT: f64 = 1e-9;
/// Accelerations of two sets that differ by more than this share are two answers: a thousand times what sets within
/// [`CONSISTENT`] of their border differ by.
const DIFFERENT: f64 = 1e-6;
/// A principal minor below this wedges: forces are a million times those that would move the free body as much, and
/// grow without bound.
pub(in crate::planar) const WEDGED: f64 = 1e-6;

/// The modes taken, and what they do.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::planar) struct Choice {
    /// One mode for each contact of the problem.
    pub(in crate::planar) modes: Vec<PlanarMode>,
    /// Accelerations and forces.
    pub(in crate::planar) response: Response,
}

/// Why no modes can be taken. A set is told by the letters of its touching contacts, in the order of the palms: `O`
/// off, `S` sliding (with the sign of its slip along the palm's tangent), `R` sticking.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ModeError {
    /// Painleve's paradox or a jam: rigid bodies with this friction have no motion here.
    #[error(
        "no mode set of the contacts is consistent (friction wedges the object: a jam, or Painleve's paradox)"
    )]
    Inconsistent,
    /// Several motions are possible.
    #[error(
        "mode sets {first} and {second} are both consistent: rigid bodies leave open which motion follows"
    )]
    Ambiguous {
        /// One of them.
        first: String,
        /// Another.
        second: String,
    },
    /// The sliding contacts' matrix is no P-matrix, or has all but ceased to be one: forces without bound are near.
    #[error(
        "mode set {modes}: the sliding contacts wedge the object (smallest principal minor {minor:.2e}, not above \
         {WEDGED:.0e}): no P-matrix, so motion need not exist or be one"
    )]
    NotP {
        /// The set.
        modes: String,
        /// Smallest principal minor, dimensionless.
        minor: f64,
    },
}

struct Consistent {
    choice: Choice,
    changes: usize,
}

impl ContactProblem {
    /// The modes that agree with the signs of forces, gaps and slips: the `present` ones if they do, else those with
    /// the fewest changes. Sets in `ended` are left out, unless nothing else is consistent: an event has just told
    /// against them.
    pub(in crate::planar) fn choose(
        &self,
        present: &[PlanarMode],
        ended: &[Vec<PlanarMode>],
    ) -> Result<Choice, ModeError> {
        let mut found: Vec<Consistent> = Vec::new();
        let options: Vec<Vec<PlanarMode>> = self.contacts.iter().map(|c| options(&c.contact)).collect();
        let count: usize = options.iter().map(Vec::len).product();
        for number in 0..count {
            let modes = pick(&options, number);
            let Ok(response) = self.respond(&modes) else { continue };
            if self.margin(&modes, &response) < -CONSISTENT {
                continue;
            }
            let changes = modes.iter().zip(present).filter(|(a, b)| a != b).count();
            found.push(Consistent { choice: Choice { modes, response }, changes });
        }
        self.refuse_two_answers(&found)?;
        // The last resort comes last; sets of as few changes keep their order, in which sticking stands first.
        found.sort_by_key(|c| (ended.contains(&c.choice.modes), c.changes));
        let choice = found.into_iter().next().ok_or(ModeError::Inconsistent)?.choice;
        let minor = self.smallest_minor(&choice.modes, &choice.response);
        if minor < WEDGED {
            return Err(ModeError::NotP { modes: letters(&choice.modes), minor });
        }
        Ok(choice)
    }

    fn refuse_two_answers(&self, found: &[Consistent]) -> Result<(), ModeError> {
        let Some(first) = found.first() else { return Ok(()) };
        let limit = DIFFERENT * self.scale() * self.roots[0];
        match found.iter().find(|c| (c.choice.response.x - first.choice.response.x).norm() > limit) {
            Some(second) => Err(ModeError::Ambiguous {
                first: letters(&first.choice.modes),
                second: letters(&second.choice.modes),
            }),
            None => Ok(()),
        }
    }

    /// How far the signs are from being wrong, as a share of the largest rate or force: the least over all conditions.
    ///
    /// A gap that is off must not close; normal forces push; sticking forces stay in the cone; where a contact starts
    /// to slide it does so against its friction; the palms do not tear redundant contacts apart.
    pub(in crate::planar) fn margin(&self, modes: &[PlanarMode], response: &Response) -> f64 {
        let mass = self.roots[0] * self.roots[0];
        let largest = response.forces.iter().flatten().fold(0.0_f64, |s, f| s.max(f.abs())) / mass;
        let scale = self.scale().max(largest);
        let mut margin = if response.torn > 0.0 { -response.torn / scale } else { f64::INFINITY };
        for ((c, mode), [normal, along]) in self.contacts.iter().zip(modes).zip(&response.forces) {
            let own = match *mode {
                PlanarMode::Off => c.normal.dot(&response.x) + c.contact.biases[0],
                PlanarMode::Stick => (c.contact.mu * normal - along.abs()).min(*normal) / mass,
                PlanarMode::Slide { .. } if c.contact.sense != 0.0 => normal / mass,
                PlanarMode::Slide { sense } => {
                    (normal / mass).min(sense * (c.tangent.dot(&response.x) + c.contact.biases[1]))
                }
            };
            margin = margin.min(own / scale);
        }
        // A NaN is no margin.
        if margin.is_nan() { f64::NEG_INFINITY } else { margin }
    }

    /// The smallest principal minor of the matrix (rows times columns) of the sliding contacts, sticking ones
    /// eliminated, in units of the rows' lengths. Positive where one answer is guaranteed.
    ///
    /// Infinite where there is nothing to ask: nothing slides, or the forces are not unique.
    pub(in crate::planar) fn smallest_minor(&self, modes: &[PlanarMode], response: &Response) -> f64 {
        let (mut held, mut sliding) = (Vec::new(), Vec::new());
        for (c, mode) in self.contacts.iter().zip(modes) {
            match *mode {
                PlanarMode::Off => {}
                PlanarMode::Stick => held.extend([c.normal, c.tangent]),
                PlanarMode::Slide { sense } => {
                    sliding.push((c.normal, c.normal - c.tangent * (c.contact.mu * sense)));
                }
            }
        }
        if response.redundant {
            return f64::INFINITY;
        }
        let free = |x: &Vector3<f64>| {
            let right: Vec<f64> = held.iter().map(|row| row.dot(x)).collect();
            x - respond::least_norm(&held, &right).solution
        };
        let columns: Vec<Vector3<f64>> = sliding.iter().map(|(_, column)| free(column)).collect();
        let sets = 1..(1_usize << sliding.len());
        let minor = |set: usize| {
            let chosen: Vec<usize> = (0..sliding.len()).filter(|i| set >> i & 1 == 1).collect();
            let entry = |i: usize, j: usize| {
                let (row, other) = (&sliding[chosen[i]].0, &sliding[chosen[j]].0);
                row.dot(&columns[chosen[j]]) / (row.norm() * other.norm())
            };
            DMatrix::from_fn(chosen.len(), chosen.len(), entry).determinant()
        };
        sets.map(minor).fold(f64::INFINITY, f64::min)
    }
}

/// The letters of a set.
pub(in crate::planar) fn letters(modes: &[PlanarMode]) -> String {
    let sign = |mode: &PlanarMode| match *mode {
        PlanarMode::Slide { sense } if sense > 0.0 => "+",
        PlanarMode::Slide { sense } if sense < 0.0 => "-",
        _ => "",
    };
    modes.iter().map(|mode| format!("{}{}", mode.mode().letter(), sign(mode))).collect()
}

/// What a contact may do: with friction four things, or two where it slips or there is no friction.
fn options(contact: &super::TouchingContact) -> Vec<PlanarMode> {
    let slide = |sense| PlanarMode::Slide { sense };
    if contact.mu == 0.0 {
        vec![slide(0.0), PlanarMode::Off]
    } else if contact.sense == 0.0 {
        vec![PlanarMode::Stick, slide(1.0), slide(-1.0), PlanarMode::Off]
    } else {
        vec![slide(contact.sense), PlanarMode::Off]
    }
}

/// One option of each contact: the digits of `number`.
fn pick(options: &[Vec<PlanarMode>], mut number: usize) -> Vec<PlanarMode> {
    let digit = |list: &Vec<PlanarMode>| {
        let mode = list[number % list.len()];
        number /= list.len();
        mode
    };
    options.iter().map(digit).collect()
}
