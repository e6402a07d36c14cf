//! What a bag holds, in words and numbers.

use super::clock::Clock;
use super::error::{BagErrorKind, Unread};
use super::mapping::{MappingDraft, draft_mapping};
use super::message::Reading;
use super::read::Bag;
use super::silences::{MOST_GAPS, TopicGap, gaps, said};
use super::topic::Topic;
use crate::brief_to;
use serde_json::{Value, json};
use std::fmt::Write;

/// What a bag holds.
#[derive(Clone, Debug, PartialEq)]
pub struct BagOverview {
    /// Its topics, by name.
    pub topics: Vec<TopicOverview>,
    /// What wrote it.
    pub library: String,
    /// Where it was cut off, bytes.
    pub cut: Option<u64>,
    /// A mapping as far as the bag tells it.
    pub draft: MappingDraft,
}

/// What a topic holds.
#[derive(Clone, Debug, PartialEq)]
pub struct TopicOverview {
    /// Its name.
    pub name: String,
    /// Name of its schema.
    pub schema: String,
    /// How many messages it has.
    pub count: usize,
    /// Why they are not read.
    pub unread: Option<Unread>,
    /// First and last stamp, s since the first of the bag.
    pub span: Option<[f64; 2]>,
    /// Messages a second, by the median of the time between two.
    pub rate: Option<f64>,
    /// Log time minus stamp: least, median, largest, s.
    pub latency: Option<[f64; 3]>,
    /// Intervals without messages.
    pub gaps: Vec<TopicGap>,
    /// Frames of its messages.
    pub frames: Vec<String>,
    /// Messages with NaN or infinities, and the time of the first, s.
    pub not_finite: Option<(usize, f64)>,
}

/// Looks a bag over, and drafts a mapping of its topics; `name` is its file's.
///
/// # Errors
/// As [`draft_mapping`].
pub fn overview(bag: &Bag, name: &str) -> Result<BagOverview, BagErrorKind> {
    let clock = Clock::new(bag, &[], &[]);
    let topics = bag.topics.values().map(|topic| TopicOverview::of(topic, &clock)).collect();
    let (library, cut) = (bag.library.clone(), bag.cut);
    Ok(BagOverview { topics, library, cut, draft: draft_mapping(bag, name)? })
}

impl TopicOverview {
    fn of(topic: &Topic, clock: &Clock) -> Self {
        let (period, gaps) = gaps(topic, clock);
        let times = || topic.messages.iter().map(|message| clock.seconds(&topic.name, message));
        let (first, last) = (times().reduce(f64::min), times().reduce(f64::max));
        let bad = |reading: &Reading| match reading {
            Reading::Wrench(all) => all.iter().any(|v| !v.is_finite()),
            Reading::Pose(all) => all.iter().any(|v| !v.is_finite()),
            // Three NaN are no contact.
            Reading::Point(all) => all.iter().any(|v| !v.is_finite()) && !all.iter().all(|v| v.is_nan()),
            Reading::Taxels { values, .. } => values.iter().any(|v| !v.is_finite()),
            _ => false,
        };
        let mut not_finite = topic.messages.iter().filter(|message| bad(&message.reading));
        let first_bad = not_finite.next().map(|message| clock.seconds(&topic.name, message));
        Self {
            name: topic.name.clone(),
            schema: topic.schema.clone(),
            count: topic.count,
            unread: topic.kind.clone().err(),
            span: first.zip(last).map(|(first, last)| [first, last]),
            rate: period.filter(|period| *period > 0.0).map(f64::recip),
            latency: latency(topic),
            gaps,
            frames: topic.frames().into_iter().map(str::to_owned).collect(),
            not_finite: first_bad.map(|t| (not_finite.count() + 1, t)),
        }
    }
}

/// Log time minus stamp: least, median, largest, s.
fn latency(topic: &Topic) -> Option<[f64; 3]> {
    let late =
        |message: &super::Message| (i128::from(message.logged) - i128::from(message.stamp)) as f64 / 1e9;
    let mut all: Vec<f64> = topic.messages.iter().map(late).collect();
    all.sort_by(f64::total_cmp);
    Some([*all.first()?, all[all.len() / 2], *all.last()?])
}

impl BagOverview {
    /// Whether the bag has topics and is as long as it should be, and every topic of a kind that is read has messages that can be: with a frame, and without NaN.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        !self.topics.is_empty() && self.cut.is_none() && self.topics.iter().all(TopicOverview::is_whole)
    }

    /// For people.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = String::new();
        let width = self.topics.iter().map(|topic| topic.name.len()).max().unwrap_or(0);
        for topic in &self.topics {
            let rate = topic.rate.map_or(String::new(), |rate| format!(", {} Hz", brief_to(4, rate)));
            let span = topic.span.map_or(String::new(), |[from, to]| {
                format!(", t = {} to {} s", brief_to(9, from), brief_to(9, to))
            });
            let frames = match &topic.frames[..] {
                [] => String::new(),
                frames => {
                    format!(", in {}", frames.iter().map(|f| format!("`{f}`")).collect::<Vec<_>>().join(", "))
                }
            };
            let _ = writeln!(
                text,
                "{:width$}  {} x {}{rate}{span}{frames}",
                topic.name, topic.count, topic.schema
            );
            topic.remarks(&mut text);
        }
        if self.topics.is_empty() {
            let _ = writeln!(text, "The bag has no topics: record again.");
        }
        if let Some(place) = self.cut {
            let _ = writeln!(text, "The bag was cut off: it ends within the record at byte {place}.");
        }
        for remark in self.clock_remarks().into_iter().chain(self.draft.remarks.iter().cloned()) {
            let _ = writeln!(text, "{remark}");
        }
        text
    }

    /// What contacts and wrenches say of each other's clocks.
    fn clock_remarks(&self) -> Vec<String> {
        let said = |clock: &super::PalmClock| {
            let offset = clock.offset;
            let [ahead, deviation, distance] =
                [offset.ahead, offset.deviation, offset.distance].map(|v| brief_to(3, v));
            let (contact, wrench) = (&clock.contact, &clock.wrench);
            let verdict = match clock.disagrees {
                true => "the clocks disagree",
                false => "no offset that matters",
            };
            format!(
                "Palm {}: {contact} comes {ahead} s (deviation {deviation} s) after the contacts that {wrench} gives, which are then {distance} m from it \
                 (root mean square): {verdict}.",
                clock.palm
            )
        };
        self.draft.clocks.iter().map(said).collect()
    }

    /// For programs.
    #[must_use]
    pub fn json(&self) -> Value {
        let gap = |gap: &TopicGap| json!({ "from_s": gap.from, "to_s": gap.to, "missing": gap.missing, "sequences": gap.sequences.map(|(a, b)| [a, b]) });
        let topic = |topic: &TopicOverview| {
            json!({
                "name": topic.name, "schema": topic.schema, "messages": topic.count,
                "unread": topic.unread.as_ref().map(ToString::to_string),
                "span_s": topic.span, "rate_hz": topic.rate, "latency_s": topic.latency,
                "gaps": topic.gaps.iter().map(gap).collect::<Vec<_>>(), "frames": topic.frames,
                "not_finite": topic.not_finite.map(|(count, t)| json!({ "messages": count, "first_t_s": t })),
            })
        };
        let clock = |clock: &super::PalmClock| {
            json!({
                "palm": clock.palm, "contact": clock.contact, "wrench": clock.wrench, "ahead_s": clock.offset.ahead,
                "deviation_s": clock.offset.deviation, "distance_before_m": clock.offset.distance_before,
                "distance_m": clock.offset.distance, "disagrees": clock.disagrees,
            })
        };
        json!({
            "library": self.library, "cut_off_at_byte": self.cut,
            "topics": self.topics.iter().map(topic).collect::<Vec<_>>(),
            "clocks": self.draft.clocks.iter().map(clock).collect::<Vec<_>>(),
            "remarks": self.draft.remarks, "mapping": self.draft.text,
        })
    }
}

impl TopicOverview {
    fn is_whole(&self) -> bool {
        match &self.unread {
            Some(Unread::Schema { .. }) => true,
            Some(_) => false,
            None => self.count > 0 && self.not_finite.is_none() && !self.frames.iter().any(String::is_empty),
        }
    }

    /// What is odd about it, a line each.
    fn remarks(&self, text: &mut String) {
        let mut line = |remark: String| {
            let _ = writeln!(text, "    {remark}");
        };
        match &self.unread {
            None => {}
            // Bags hold much that has nothing to do with contacts: no need to say each time what has.
            Some(Unread::Schema { .. }) => line("not read: a message of another kind".to_owned()),
            Some(why) => line(format!("not read: {why}")),
        }
        if self.count == 0 && self.unread.is_none() {
            line("is announced and has no message".to_owned());
        }
        for gap in self.gaps.iter().take(MOST_GAPS) {
            line(said(gap));
        }
        if self.gaps.len() > MOST_GAPS {
            line(format!("and {} more such gaps", self.gaps.len() - MOST_GAPS));
        }
        if let Some((count, t)) = self.not_finite {
            line(format!("{count} message(s) with NaN or infinities, the first at t = {} s", brief_to(9, t)));
        }
        if self.frames.iter().any(String::is_empty) {
            line("has messages without a frame".to_owned());
        }
        if let Some([least, median, _]) = self.latency.filter(|[least, _, _]| *least < 0.0) {
            line(format!(
                "its stamps are later than when it was recorded, by up to {} s (median {} s): its clock is ahead",
                brief_to(3, -least),
                brief_to(3, -median)
            ));
        }
    }
}
