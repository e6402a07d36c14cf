//! What became of a run.

use super::Failure;
use crate::rows::Cells;
use std::any::Any;
use std::cell::RefCell;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Once;
use std::time::Instant;

/// What became of a run, by its error and by what it said of itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Relied on, and within what it states.
    Right,
    /// A doubt in words came with it, whatever its error is.
    Reported,
    /// A typed error.
    Error,
    /// Relied on, and beyond what it states, or no number.
    Silent,
    /// A panic.
    Crash,
    /// There is nothing to judge: the scene cannot be made.
    NoScene,
}

impl Outcome {
    /// All of them, in the order of the legend.
    pub const ALL: [Self; 6] =
        [Self::Right, Self::Reported, Self::Error, Self::Silent, Self::Crash, Self::NoScene];

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Right => "right",
            Self::Reported => "reported",
            Self::Error => "typed error",
            Self::Silent => "wrong without a warning",
            Self::Crash => "crash",
            Self::NoScene => "no such scene",
        }
    }
}

/// What a method gave.
pub(super) enum Ran {
    /// The scene of this strength cannot be made, and why.
    NoScene(String),
    /// A typed error in its words.
    Refused(String),
    /// An answer.
    Found {
        /// Its largest error in what is allowed of it: beyond 1 it is wrong.
        off: f64,
        /// Why it says not to rely on it.
        doubt: Option<String>,
    },
}

impl Ran {
    /// Refused, with the words of an error.
    pub(super) fn refused(error: &impl ToString) -> Self {
        Self::Refused(error.to_string())
    }
}

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub struct Run {
    /// What became of it.
    pub outcome: Outcome,
    /// Its largest error in what is allowed of it.
    pub off: f64,
    /// Its words, where there are some.
    pub why: String,
    /// Wall time, ms.
    pub milliseconds: f64,
}

impl Cells for Run {
    fn write(&self, to: &mut Vec<String>) {
        to.push(self.outcome.words().to_owned());
        self.off.write(to);
        self.why.write(to);
        self.milliseconds.write(to);
    }

    fn read<'a>(from: &mut impl Iterator<Item = &'a str>) -> Option<Self> {
        let words = from.next()?;
        let outcome = Outcome::ALL.into_iter().find(|of| of.words() == words)?;
        let (off, why) = (f64::read(from)?, String::read(from)?);
        Some(Self { outcome, off, why, milliseconds: f64::read(from)? })
    }
}

thread_local! {
    /// Where the last panic of this thread was.
    static PLACE: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Runs it; a panic is an outcome like others.
pub(super) fn caught(run: impl FnOnce() -> Result<Ran, Failure>) -> Run {
    static QUIET: Once = Once::new();
    QUIET.call_once(|| {
        std::panic::set_hook(Box::new(|info| {
            let place = info.location().map_or_else(String::new, |at| format!("{}:{}", at.file(), at.line()));
            PLACE.set(place);
        }));
    });
    let clock = Instant::now();
    let ran = catch_unwind(AssertUnwindSafe(run));
    let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
    let (outcome, off, why) = match ran {
        Err(panic) => (Outcome::Crash, f64::NAN, format!("{} at {}", words_of(&*panic), PLACE.take())),
        Ok(Err(error)) => (Outcome::NoScene, f64::NAN, error.to_string()),
        Ok(Ok(Ran::NoScene(why))) => (Outcome::NoScene, f64::NAN, why),
        Ok(Ok(Ran::Refused(why))) => (Outcome::Error, f64::NAN, why),
        Ok(Ok(Ran::Found { off, doubt: Some(why) })) => (Outcome::Reported, off, why),
        Ok(Ok(Ran::Found { off, doubt: None })) => {
            (if off <= 1.0 { Outcome::Right } else { Outcome::Silent }, off, String::new())
        }
    };
    Run { outcome, off, why, milliseconds }
}

fn words_of(panic: &(dyn Any + Send)) -> String {
    let fixed = panic.downcast_ref::<&str>().map(ToString::to_string);
    fixed.or_else(|| panic.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panic".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome(ran: Ran) -> Outcome {
        caught(|| Ok(ran)).outcome
    }

    #[test]
    fn silence_is_right_only_within_what_is_allowed() {
        for (off, expected) in [(1.0, Outcome::Right), (1.1, Outcome::Silent), (f64::NAN, Outcome::Silent)] {
            assert_eq!(outcome(Ran::Found { off, doubt: None }), expected, "{off}");
            assert_eq!(outcome(Ran::Found { off, doubt: Some("doubt".to_owned()) }), Outcome::Reported);
        }
    }

    #[test]
    fn a_panic_is_an_outcome_with_its_words_and_place() {
        let run = caught(|| {
            let empty: [f64; 0] = [];
            Ok(Ran::Found { off: empty[std::hint::black_box(0)], doubt: None })
        });
        assert_eq!(run.outcome, Outcome::Crash);
        assert!(run.why.contains("out of bounds") && run.why.contains("judged.rs"), "{}", run.why);
    }

    #[test]
    fn a_run_reads_back_to_the_last_bit() {
        let run =
            Run { outcome: Outcome::Silent, off: 1.0 / 3.0, why: "a, \"b\"".to_owned(), milliseconds: 0.1 };
        let mut cells = Vec::new();
        run.write(&mut cells);
        assert_eq!(Run::of_row(&cells), Some(run));
    }
}
