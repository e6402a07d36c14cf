//! Where readings of a topic are missing: by its stamps, and by the numbers of its messages.

use super::clock::Clock;
use super::palm::Source;
use super::topic::{Message, Topic};
use crate::brief_to;
use recon::object_dynamics::Rhythm;

/// Gaps of a topic that are told one by one.
pub(super) const MOST_GAPS: usize = 8;

/// An interval without messages of a topic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TopicGap {
    /// Time of the last message before it, s since the first stamp of the bag.
    pub from: f64,
    /// Time of the next, s.
    pub to: f64,
    /// How many are missing, by the usual time between two.
    pub missing: usize,
    /// First and last number that is missing, where the recorder counts messages and these agree that some are.
    pub sequences: Option<(u32, u32)>,
}

/// The usual time between messages of a topic (s), and its gaps.
pub(super) fn gaps(topic: &Topic, clock: &Clock) -> (Option<f64>, Vec<TopicGap>) {
    let mut all: Vec<(f64, &Message)> =
        topic.messages.iter().map(|message| (clock.seconds(&topic.name, message), message)).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    let times: Vec<f64> = all.iter().map(|(t, _)| *t).collect();
    let rhythm = Rhythm::of(&times);
    // Two channels count apart.
    let counted = topic.channels == 1 && all.iter().any(|(_, message)| message.sequence > 0);
    let gap = |silence: &recon::object_dynamics::Silence| {
        let [before, next] = [all[silence.after].1.sequence, all[silence.after + 1].1.sequence];
        let skips = counted && next > before.saturating_add(1);
        TopicGap {
            from: silence.from,
            to: silence.to,
            missing: silence.missing,
            sequences: skips.then(|| (before + 1, next - 1)),
        }
    };
    (rhythm.period, rhythm.silences.iter().map(gap).collect())
}

/// The gaps of a topic in words: one by one if they are few, else the longest and how many there are.
pub(super) fn silences(source: Source, topic: &str) -> Vec<String> {
    let Some(found) = source.bag.topics.get(topic) else { return Vec::new() };
    let (_, gaps) = gaps(found, source.clock);
    if gaps.len() <= MOST_GAPS {
        return gaps.iter().map(|gap| format!("{topic} {}.", said(gap))).collect();
    }
    let longest = gaps.iter().max_by(|a, b| (a.to - a.from).total_cmp(&(b.to - b.from)));
    let missing: usize = gaps.iter().map(|gap| gap.missing).sum();
    let of = format!("{topic} is silent {} times, with {missing} messages missing by its period", gaps.len());
    longest.map(|gap| format!("{of}; the longest time it {}.", said(gap))).into_iter().collect()
}

/// A gap in words, as in `has nothing from t = 0.599 to 0.64 s: 40 messages are missing (numbers 600 to 639)`.
pub(super) fn said(gap: &TopicGap) -> String {
    let TopicGap { from, to, missing, sequences } = gap;
    let numbers = match sequences {
        Some((first, last)) => format!(" (numbers {first} to {last})"),
        None => String::new(),
    };
    let [from, to] = [from, to].map(|t| brief_to(9, *t));
    let are = if *missing == 1 { "message is" } else { "messages are" };
    format!("has nothing from t = {from} to {to} s: {missing} {are} missing{numbers}")
}
