//! How a chance of being wrong is shared among touches of which nobody knows the number beforehand.
//!
//! A planner looks at the bounds after each touch and stops when it likes what it sees. A confidence that is stated for the
//! touches made so far is then wrong: with enough looks, one will please by luck. What is shared here is over **all touches
//! that may be made**: a touch is allowed to mislead with a probability that was fixed before it was made.

use std::f64::consts::PI;
use thiserror::Error;

/// How the chance of being wrong is spent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spending {
    /// At most so many touches, with an equal share each.
    Budget(usize),
    /// Any number of touches: `6 a / (pi^2 k^2)` for touch `k`, which sums to `a` (Basel).
    Unlimited,
}

/// A confidence that stays true however the touches are chosen and whenever the looking ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Confidence {
    level: f64,
    spending: Spending,
}

/// Why a confidence is none.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ConfidenceError {
    /// A level that is none.
    #[error("confidence {0}: it must lie between 0.5 and 1, both excluded")]
    Level(f64),
    /// No touches at all.
    #[error("a budget of 0 touches proves nothing: allow for at least as many as the start takes")]
    NoTouches,
    /// More touches than allowed for.
    #[error(
        "touch {touch} was not allowed for: the confidence was shared among {budget} touches before the first one; state a \
         larger budget, or an unlimited one"
    )]
    Spent {
        /// Number of the touch, from 1.
        touch: usize,
        /// Touches allowed for.
        budget: usize,
    },
}

impl Confidence {
    /// Confidence `level` for all touches together.
    ///
    /// # Errors
    /// [`ConfidenceError`] for a level outside of 0.5 to 1 and for a budget of no touches.
    pub fn new(level: f64, spending: Spending) -> Result<Self, ConfidenceError> {
        if !(level > 0.5 && level < 1.0) {
            return Err(ConfidenceError::Level(level));
        }
        if spending == Spending::Budget(0) {
            return Err(ConfidenceError::NoTouches);
        }
        Ok(Self { level, spending })
    }

    /// The level as stated.
    #[must_use]
    pub fn level(&self) -> f64 {
        self.level
    }

    /// How it is spent.
    #[must_use]
    pub fn spending(&self) -> Spending {
        self.spending
    }

    /// Probability with which one touch may mislead when `touches` have been made: the same for all of them, and falling with
    /// their number, so that what misleads later has misled when it was made, at the probability of then.
    ///
    /// # Errors
    /// [`ConfidenceError::Spent`] beyond the budget.
    pub fn share(&self, touches: usize) -> Result<f64, ConfidenceError> {
        let alpha = 1.0 - self.level;
        match self.spending {
            Spending::Budget(budget) if touches > budget => {
                Err(ConfidenceError::Spent { touch: touches, budget })
            }
            Spending::Budget(budget) => Ok(alpha / budget as f64),
            Spending::Unlimited => Ok(6.0 * alpha / (PI * touches.max(1) as f64).powi(2)),
        }
    }

    /// The confidence that bounds of `touches` contacts are to be made for, so that each has its share.
    ///
    /// # Errors
    /// As [`Self::share`].
    pub fn of_touches(&self, touches: usize) -> Result<f64, ConfidenceError> {
        Ok(1.0 - self.share(touches)? * touches as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_all_touches_sum_to_what_may_go_wrong() {
        for spending in [Spending::Budget(150), Spending::Unlimited] {
            let confidence = Confidence::new(0.95, spending).unwrap();
            let last = if spending == Spending::Unlimited { 100_000 } else { 150 };
            let sum: f64 = (1..=last).map(|k| confidence.share(k).unwrap()).sum();
            assert!(sum <= 0.05 + 1e-12 && sum > 0.0499, "{spending:?} {sum}");
        }
    }

    #[test]
    fn no_share_grows_with_the_touches() {
        let confidence = Confidence::new(0.9, Spending::Unlimited).unwrap();
        assert!((1..200).all(|k| confidence.share(k + 1).unwrap() < confidence.share(k).unwrap()));
    }

    #[test]
    fn what_was_not_allowed_for_is_refused() {
        let confidence = Confidence::new(0.95, Spending::Budget(3)).unwrap();
        assert_eq!(confidence.share(4), Err(ConfidenceError::Spent { touch: 4, budget: 3 }));
        assert_eq!(Confidence::new(0.4, Spending::Unlimited), Err(ConfidenceError::Level(0.4)));
        assert!(Confidence::new(f64::NAN, Spending::Unlimited).is_err());
        assert_eq!(Confidence::new(0.95, Spending::Budget(0)), Err(ConfidenceError::NoTouches));
    }
}
