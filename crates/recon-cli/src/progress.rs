//! What is told while work goes on: a bar on a terminal for what takes over a second, or a caller in the same program.

use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::fmt::Write;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// How long work may take before a bar appears.
const PATIENCE: Duration = Duration::from_secs(1);

/// Is told each step as it begins.
pub type Watch = Box<dyn Fn(&'static str) + Send + Sync>;

/// The steps of a command, shown as `[####    ] 2/4 estimating the motion`.
pub(crate) struct Progress {
    bar: ProgressBar,
    step: Arc<Mutex<String>>,
    watch: Option<Watch>,
}

impl Progress {
    /// Begins work of `steps` steps; `quiet` shows nothing.
    pub(crate) fn new(steps: u64, quiet: bool) -> Self {
        let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new(steps) };
        let step = Arc::new(Mutex::new(String::new()));
        let shown = Arc::clone(&step);
        let late = move |state: &ProgressState, line: &mut dyn Write| {
            if state.elapsed() > PATIENCE {
                let (done, all) = (state.pos() as usize, state.len().unwrap_or(0) as usize);
                let filled = "#".repeat(8 * done.min(all) / all.max(1));
                let _ = write!(line, "[{filled:<8}] {done}/{all} {}", *locked(&shown));
            }
        };
        if let Ok(style) = ProgressStyle::with_template("{late}") {
            bar.set_style(style.with_key("late", late));
        }
        bar.enable_steady_tick(Duration::from_millis(200));
        Self { bar, step, watch: None }
    }

    /// Begins work of which `watch` is told instead.
    pub(crate) fn watched(watch: Option<Watch>) -> Self {
        Self { bar: ProgressBar::hidden(), step: Arc::default(), watch }
    }

    /// Begins the next step.
    pub(crate) fn step(&self, what: &'static str) {
        self.say(what);
        self.bar.inc(1);
        if let Some(watch) = &self.watch {
            watch(what);
        }
    }

    /// Says how far the present step is.
    pub(crate) fn say(&self, what: &str) {
        what.clone_into(&mut locked(&self.step));
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

fn locked(step: &Mutex<String>) -> MutexGuard<'_, String> {
    // A word cannot be left half-set by a panic elsewhere.
    step.lock().unwrap_or_else(PoisonError::into_inner)
}
