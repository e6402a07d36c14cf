//! Which contacts stick, slide or leave: the mode set that is consistent with the forces that it asks for.

use super::MOST_PALMS;
use super::cones::forces_in_cones;
use super::coulomb::Search;
use super::directions::NO_DIRECTIONS;
use super::painleve::smallest_minor;
use super::problem::{ContactProblem, Directions, FULFILLED, Modes, Reaction};
use crate::ContactMode;
use glam::DVec2;
use thiserror::Error;

/// Forces and accelerations within this share of the largest are zero.
const SLACK: f64 = 1e-9;
/// Two consistent mode sets are one where their accelerations differ by less than this share: at a transition both sides hold.
const SAME: f64 = 1e-5;
/// Slip starts where it is accelerated by more than this share.
const STARTS: f64 = 1e-7;
/// Sticking contacts that contradict each other by less than this share do so by rounding.
pub(crate) const EXACT: f64 = 1e-10;

/// Why no mode set can be taken. Modes are given as letters, palm by palm: O off, S slides, R sticks and rolls.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ModeError {
    /// Painlevé's paradox or a jam: rigid bodies with this friction have no motion here.
    #[error(
        "no mode set of the contacts is consistent (friction wedges the object: a jam, or Painlevé's paradox)"
    )]
    Inconsistent,
    /// Several motions are possible.
    #[error(
        "mode sets {first} and {second} are both consistent: rigid bodies leave open which motion follows (the slip at palm \
         {palm} changes by {:.3e} or by {:.3e}, m/s^2; m/s in a blow)", rates[0], rates[1]
    )]
    Ambiguous {
        /// One of them.
        first: String,
        /// Another.
        second: String,
        /// The palm (from 1) at which the two motions differ most.
        palm: usize,
        /// Rate of the slip there in each of them, m/s^2; its change in m/s where it is a blow.
        rates: [f64; 2],
    },
    /// The sliding contacts' matrix is no P-matrix: forces without bound are near.
    #[error(
        "mode set {modes}: friction wedges the sliding contacts (smallest principal minor {minor:.2e}, not above zero): \
         no P-matrix, so motion need not exist or be one"
    )]
    NotP {
        /// The set.
        modes: String,
        /// Smallest principal minor, dimensionless.
        minor: f64,
    },
}

/// What is known of a contact before modes are chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Touch {
    /// It does not touch, or leaves: no force.
    Apart,
    /// It touches and slides along the unit tangent.
    Slides(DVec2),
    /// It touches without slip: it may stick, or start to slide.
    Rests,
}

/// A mode of a contact that has just ended: it may seem to hold still, by rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Left {
    pub(crate) contact: usize,
    pub(crate) mode: ContactMode,
}

/// What speaks against a consistent mode set, the weightiest first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Rank {
    /// It has just ended, and may seem to hold still by rounding.
    left: bool,
    /// Its sticking contacts contradict each other a little.
    strained: bool,
    /// A contact that is said to start to slide is not accelerated: it may be said to stick as well.
    sticks_as_well: bool,
}

/// A consistent mode set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Choice {
    pub(crate) modes: Modes,
    pub(crate) directions: Directions,
    pub(crate) reaction: Reaction,
}

impl ContactProblem {
    /// The consistent mode set; of several that mean the same motion the one with the fewest changes from `present`.
    ///
    /// `not`: what has just ended, taken only where nothing else is consistent.
    pub(crate) fn choose(
        &self,
        touches: &[Touch; MOST_PALMS],
        present: &Modes,
        not: Option<Left>,
    ) -> Result<Choice, ModeError> {
        let force = self.force_scale(|i| touches[i] != Touch::Apart);
        let search = Search { creep: SLACK, starts: 0 };
        let solved = self.coulomb(touches, &[[0.0; 3]; MOST_PALMS], search).map(|(choice, _)| choice);
        let mut sets = self.candidates(touches);
        sets.sort_by_key(|modes| (0..self.contacts().len()).filter(|&i| modes[i] != present[i]).count());
        let mut found: Option<(Rank, Choice)> = None;
        for modes in &sets {
            let near = solved.as_ref().filter(|known| known.modes == *modes).map(|known| &known.directions);
            let Some(choice) = self.consistent(touches, modes, near, force) else { continue };
            let rank = Rank {
                left: not.is_some_and(|left| modes[left.contact] == left.mode),
                strained: choice.reaction.unmet > EXACT,
                sticks_as_well: !self.starts_truly(touches, &choice, force),
            };
            match &found {
                Some((best, _)) if *best < rank => {}
                Some((best, first)) if *best == rank => {
                    if let Some((palm, rates)) = self.differ(first, &choice, force) {
                        let [first, second] = [first, &choice].map(|choice| self.letters(&choice.modes));
                        return Err(ModeError::Ambiguous { first, second, palm, rates });
                    }
                }
                _ => found = Some((rank, choice)),
            }
        }
        let (_, choice) = found.ok_or(ModeError::Inconsistent)?;
        self.check_wedging(touches, &choice)?;
        Ok(choice)
    }

    /// Refuses sliding contacts that friction wedges, those that would leave at once included: there it is chance whether one
    /// motion follows, none or several.
    fn check_wedging(&self, touches: &[Touch; MOST_PALMS], choice: &Choice) -> Result<(), ModeError> {
        let (mut modes, mut directions) = (choice.modes, choice.directions);
        for (i, touch) in touches.iter().enumerate() {
            if let Touch::Slides(tau) = touch {
                (modes[i], directions[i]) = (ContactMode::Slide, *tau);
            }
        }
        let minor = self.smallest_sliding_minor(&modes, &directions);
        if minor > 0.0 { Ok(()) } else { Err(self.not_p(&modes, minor)) }
    }

    /// The error of modes whose smallest principal minor is not above zero.
    pub(crate) fn not_p(&self, modes: &Modes, minor: f64) -> ModeError {
        ModeError::NotP { modes: self.letters(modes), minor }
    }

    /// The largest force that stops a contact which `touches`, N: a scale for what counts as zero. How the body moves against palms
    /// that it does not touch says nothing of forces.
    pub(crate) fn force_scale(&self, touches: impl Fn(usize) -> bool) -> f64 {
        let of = |i: usize| self.contacts()[i].free.length() / self.own_response(i);
        (0..self.contacts().len()).filter(|&i| touches(i)).map(of).fold(f64::MIN_POSITIVE, f64::max)
    }

    fn candidates(&self, touches: &[Touch; MOST_PALMS]) -> Vec<Modes> {
        let mut sets = vec![[ContactMode::Off; MOST_PALMS]];
        for (i, contact) in self.contacts().iter().enumerate() {
            let options: &[ContactMode] = match touches[i] {
                Touch::Apart => &[ContactMode::Off],
                Touch::Slides(_) => &[ContactMode::Slide, ContactMode::Off],
                Touch::Rests if contact.friction == 0.0 => &[ContactMode::Slide, ContactMode::Off],
                Touch::Rests => &[ContactMode::Stick, ContactMode::Slide, ContactMode::Off],
            };
            sets = sets
                .iter()
                .flat_map(|set| {
                    options.iter().map(|&mode| {
                        let mut set = *set;
                        set[i] = mode;
                        set
                    })
                })
                .collect();
        }
        sets
    }

    /// The set with its forces, if those are what its modes ask for.
    /// `near`: directions close to those of contacts that start to slide, where they are known.
    fn consistent(
        &self,
        touches: &[Touch; MOST_PALMS],
        modes: &Modes,
        near: Option<&Directions>,
        force: f64,
    ) -> Option<Choice> {
        let slack = SLACK * force;
        let mut directions = near.copied().unwrap_or(NO_DIRECTIONS);
        let mut starting = Vec::new();
        for (i, contact) in self.contacts().iter().enumerate() {
            match touches[i] {
                Touch::Slides(tau) => directions[i] = tau,
                Touch::Rests if modes[i] == ContactMode::Slide && contact.friction > 0.0 => starting.push(i),
                Touch::Rests | Touch::Apart => {}
            }
        }
        let reaction = if starting.is_empty() {
            self.solve(modes, &directions).ok()?
        } else {
            let known = near.and_then(|near| self.directions_near(modes, near, &starting));
            let (found, reaction) =
                known.or_else(|| self.starting_directions(modes, &directions, &starting, slack))?;
            directions = found;
            reaction
        };
        let leaves = |i: usize| {
            touches[i] == Touch::Apart || self.gap_acceleration(i, &reaction) >= -slack * self.own_response(i)
        };
        let all_leave = (0..self.contacts().len()).all(|i| modes[i] != ContactMode::Off || leaves(i));
        if !all_leave {
            return None;
        }
        let reaction = Some(reaction).filter(|reaction| reaction.unmet <= FULFILLED)?;
        let reaction = self.within_cones(modes, reaction, force)?;
        self.with_frictionless_directions(touches, modes, &mut directions, &reaction);
        Some(Choice { modes: *modes, directions, reaction })
    }

    /// Whether every contact that starts to slide is accelerated.
    fn starts_truly(&self, touches: &[Touch; MOST_PALMS], choice: &Choice, force: f64) -> bool {
        self.contacts().iter().enumerate().all(|(i, contact)| {
            let starts = touches[i] == Touch::Rests && choice.modes[i] == ContactMode::Slide;
            let rate = contact.in_tangent(self.slip_rate(i, &choice.reaction));
            !starts || contact.friction == 0.0 || rate.length() > STARTS * force * self.own_response(i)
        })
    }

    /// The reaction, if its forces are in their cones to rounding of `force`, N; of over-constrained sticking any forces that are.
    pub(crate) fn within_cones(&self, modes: &Modes, reaction: Reaction, force: f64) -> Option<Reaction> {
        let slack = SLACK * force;
        if self.in_cones(modes, &reaction, slack) {
            Some(reaction)
        } else if reaction.unique {
            None
        } else {
            forces_in_cones(self, modes, &reaction, slack)
        }
    }

    pub(crate) fn in_cones(&self, modes: &Modes, reaction: &Reaction, slack: f64) -> bool {
        self.contacts().iter().enumerate().all(|(i, contact)| {
            let force = reaction.forces[i];
            let normal = contact.n.dot(force);
            match modes[i] {
                ContactMode::Off => true,
                ContactMode::Slide => normal >= -slack,
                ContactMode::Stick => {
                    normal >= -slack
                        && contact.in_tangent(force).length() <= contact.friction * normal.max(0.0) + slack
                }
            }
        })
    }

    /// Without friction a contact starts to slide wherever it is carried.
    fn with_frictionless_directions(
        &self,
        touches: &[Touch; MOST_PALMS],
        modes: &Modes,
        directions: &mut Directions,
        reaction: &Reaction,
    ) {
        for (i, contact) in self.contacts().iter().enumerate() {
            let free = touches[i] == Touch::Rests && contact.friction == 0.0;
            if free && modes[i] == ContactMode::Slide {
                let rate = contact.in_tangent(self.slip_rate(i, reaction));
                directions[i] = rate.try_normalize().unwrap_or(DVec2::X);
            }
        }
    }

    /// The palm (from 1) at which two sets differ most, with the slip's rate there in each; none where they mean one motion.
    ///
    /// Of palms that bear in either alone: forces that change no slip where they act are of no power, and change no motion.
    fn differ(&self, one: &Choice, other: &Choice, force: f64) -> Option<(usize, [f64; 2])> {
        let rate = |i: usize, choice: &Choice| self.slip_rate(i, &choice.reaction);
        let share = |i: usize| (rate(i, one) - rate(i, other)).length() / (force * self.own_response(i));
        let bears = |i: &usize| [one, other].iter().any(|choice| choice.modes[*i] != ContactMode::Off);
        let bearing = (0..self.contacts().len()).filter(bears);
        let worst = bearing.max_by(|&i, &j| share(i).total_cmp(&share(j)))?;
        let rates = [one, other].map(|choice| rate(worst, choice).length());
        (share(worst) > SAME).then_some((worst + 1, rates))
    }

    /// Smallest principal minor of the sliding contacts' matrix; infinite where none slides with friction.
    pub(crate) fn smallest_sliding_minor(&self, modes: &Modes, directions: &Directions) -> f64 {
        let sliding: Vec<usize> =
            (0..self.contacts().len()).filter(|&i| modes[i] == ContactMode::Slide).collect();
        if sliding.iter().all(|&i| self.contacts()[i].friction == 0.0) {
            return f64::INFINITY;
        }
        let scale: Vec<f64> = sliding.iter().map(|&i| self.own_response(i)).collect();
        match self.sliding_matrix(modes, directions) {
            Some(matrix) => smallest_minor(&matrix, &scale),
            None => f64::NEG_INFINITY,
        }
    }

    /// The modes as letters, palm by palm.
    pub(crate) fn letters(&self, modes: &Modes) -> String {
        modes[..self.contacts().len()].iter().map(|mode| mode.letter()).collect()
    }
}
