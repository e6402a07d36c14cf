//! What a simulation through contact modes came to, in space and in the plane, for people and for programs.

use recon_io::{ModeSpan, mode_times};
use serde_json::{Map, Value, json};

/// Changes and durations of contact modes.
pub(crate) struct ModesTold {
    pub(crate) samples: usize,
    /// s.
    pub(crate) duration: f64,
    /// Angle between the last orientation and the first, rad.
    pub(crate) turn: f64,
    /// Changes of modes of each kind, by name.
    pub(crate) changes: Vec<(&'static str, usize)>,
    /// What each contact does, one span after the other.
    pub(crate) spans: Vec<Vec<ModeSpan>>,
}

impl ModesTold {
    /// Time that each contact is off, slides and sticks, s.
    fn times(&self) -> impl Iterator<Item = [f64; 3]> {
        self.spans.iter().map(|spans| mode_times(spans))
    }

    /// For a person.
    pub(crate) fn describe(&self) -> String {
        let mut text = format!("{} samples over {} s", self.samples, self.duration);
        let happened = self.changes.iter().filter(|(_, count)| *count > 0);
        let named: Vec<String> =
            happened.map(|(name, count)| format!("{} {count}", name.replace('_', " "))).collect();
        let count: usize = self.changes.iter().map(|(_, count)| count).sum();
        text += &match named.is_empty() {
            true => ", no change of modes".to_owned(),
            false => format!(", {count} change(s) of modes ({})", named.join(", ")),
        };
        text + &describe_times(&self.spans)
    }

    /// For a program.
    pub(crate) fn figures(&self) -> Value {
        let changes: Map<String, Value> =
            self.changes.iter().map(|(name, count)| ((*name).to_owned(), (*count).into())).collect();
        let palm = |(i, [off, slides, sticks]): (usize, [f64; 3])| json!({ "palm": i + 1, "off_s": off, "slides_s": slides, "sticks_s": sticks });
        json!({
            "samples": self.samples,
            "duration_s": self.duration,
            "turn_rad": self.turn,
            "mode_changes": changes,
            "palms": self.times().enumerate().map(palm).collect::<Vec<_>>(),
        })
    }
}

/// What each contact does for how long, in a line for each.
pub(crate) fn describe_times(spans: &[Vec<ModeSpan>]) -> String {
    let line = |(i, spans): (usize, &Vec<ModeSpan>)| {
        let [off, slides, sticks] = mode_times(spans);
        format!("\n  palm {}: off {off:.3} s, slides {slides:.3} s, sticks {sticks:.3} s", i + 1)
    };
    spans.iter().enumerate().map(line).collect()
}
