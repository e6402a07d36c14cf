//! Whether it is said where nothing that palms can do uncovers more, and there alone.

use super::statistics::median_and_tail;

/// A run, against what can be reached on its body.
#[derive(Clone, Debug)]
pub struct Told {
    /// Why it ended short, in a word; none where the goal is proven.
    pub short: Option<&'static str>,
    /// Way of the palms until its end.
    pub way: Option<f64>,
    /// The least gap that anything the palms can do leaves.
    pub least: f64,
    /// Directions that were named as out of reach, and how many of them are.
    pub named: [usize; 2],
}

/// Heads of the columns of [`cells`]; `way` is what the way is measured in.
#[must_use]
pub fn heads(way: &str) -> String {
    format!(
        "out of reach | of these said | {way} until then, median / 90 % | spent or lost | directions named that cannot be felt | in reach | of these proven | said to be out of reach"
    )
}

/// What became of runs to the gap `goal`; `not_found` is the word of those that say that nothing is left.
#[must_use]
pub fn cells(all: &[Told], goal: f64, not_found: &str) -> String {
    let (out, within): (Vec<&Told>, Vec<&Told>) = all.iter().partition(|run| run.least > goal);
    let is_said = |run: &&&Told| run.short == Some(not_found);
    let said = |runs: &[&Told]| runs.iter().filter(is_said).count();
    let ways: Vec<Option<f64>> = out.iter().filter(is_said).map(|run| run.way).collect();
    let ways = if ways.is_empty() { "-".to_owned() } else { median_and_tail(&ways, 1) };
    let sum = |k: usize| out.iter().map(|run| run.named[k]).sum::<usize>();
    let ended = out.iter().filter(|run| run.short.is_some()).count() - said(&out);
    format!(
        "{} | {} | {ways} | {ended} | {} of {} | {} | {} | {}",
        out.len(),
        said(&out),
        sum(1),
        sum(0),
        within.len(),
        within.iter().filter(|run| run.short.is_none()).count(),
        said(&within)
    )
}
