//! Times of messages in seconds of one clock.

use super::mapping::{BagMapping, TimeOf, TopicClock};
use super::read::Bag;
use super::topic::{Message, Topic};
use std::collections::HashMap;

/// What makes stamps of topics seconds since one epoch.
pub(super) struct Clock {
    /// The earliest stamp of the bag, ns.
    pub(super) epoch: i64,
    topics: HashMap<String, (TimeOf, i64)>,
}

impl Clock {
    /// Seconds since the earliest time of the topics named (of all that are read where none is).
    pub(super) fn new(bag: &Bag, clocks: &[TopicClock], topics: &[&str]) -> Self {
        let mut clock = Self { epoch: 0, topics: HashMap::new() };
        for TopicClock { topic, ahead, time } in clocks {
            clock.topics.insert(topic.clone(), (*time, nanoseconds(*ahead)));
        }
        let named = |topic: &&Topic| topics.is_empty() || topics.contains(&topic.name.as_str());
        // A static transform may be older than anything that happens.
        let timed = |topic: &&Topic| !topic.name.ends_with("tf_static");
        let all = bag.topics.values().filter(named).filter(timed);
        let times = all.flat_map(|topic| topic.messages.iter().map(|m| clock.time(&topic.name, m)));
        clock.epoch = times.min().unwrap_or(0);
        clock
    }

    pub(super) fn of_mapping(bag: &Bag, mapping: &BagMapping, topics: &[&str]) -> Self {
        Self::new(bag, &mapping.clocks, topics)
    }

    /// Time of a message, ns.
    pub(super) fn time(&self, topic: &str, message: &Message) -> i64 {
        self.shifted(topic, message, message.stamp)
    }

    /// The same in seconds since the epoch.
    pub(super) fn seconds(&self, topic: &str, message: &Message) -> f64 {
        self.since_epoch(self.time(topic, message))
    }

    /// Time of one of the transforms of a message, s.
    pub(super) fn of_transform(&self, topic: &str, message: &Message, stamp: i64) -> f64 {
        self.since_epoch(self.shifted(topic, message, stamp))
    }

    /// Nanoseconds as seconds since the epoch, correctly rounded for logs of up to a hundred days.
    pub(super) fn since_epoch(&self, time: i64) -> f64 {
        time.saturating_sub(self.epoch) as f64 / 1e9
    }

    /// By how much a topic is said to be ahead, s.
    pub(super) fn ahead(&self, topic: &str) -> f64 {
        self.topics.get(topic).map_or(0.0, |(_, ahead)| *ahead as f64 / 1e9)
    }

    fn shifted(&self, topic: &str, message: &Message, stamp: i64) -> i64 {
        let signed = |time: u64| i64::try_from(time).unwrap_or(i64::MAX);
        match self.topics.get(topic) {
            None => stamp,
            Some((TimeOf::Stamp, ahead)) => stamp.saturating_sub(*ahead),
            Some((TimeOf::Log, ahead)) => signed(message.logged).saturating_sub(*ahead),
            Some((TimeOf::Published, ahead)) => signed(message.published).saturating_sub(*ahead),
        }
    }
}

/// Seconds in nanoseconds; the cast saturates.
fn nanoseconds(seconds: f64) -> i64 {
    (seconds * 1e9).round() as i64
}
