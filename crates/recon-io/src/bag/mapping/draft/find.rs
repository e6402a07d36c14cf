//! Which topics are of which palm.

use super::super::{PalmTopics, Pitch, TaxelTopic, TaxelValue};
use crate::bag::frames::{Frames, plain};
use crate::bag::message::{MessageKind, Reading};
use crate::bag::read::Bag;
use crate::bag::topic::Topic;

/// One palm as it is found, with remarks for the file.
pub(super) struct DraftPalm {
    pub(super) topics: PalmTopics,
    /// Names before the last slash of its first topic.
    space: String,
    /// Lines of the file about it that are no keys.
    pub(super) remarks: Vec<String>,
}

impl DraftPalm {
    /// The distance of taxels, where a metadata record of the bag says it.
    pub(super) fn pitch_from(&mut self, bag: &Bag) {
        let pitch = bag.metadata.get("taxel_layout").and_then(|layout| layout.get("pitch_m")?.parse().ok());
        if let (Some(taxels), Some(pitch)) = (&mut self.topics.taxels, pitch) {
            taxels.pitch = Pitch::Both(pitch);
        }
    }
}

/// The palms as they are found.
pub(super) struct Palms<'a> {
    pub(super) bag: &'a Bag,
    pub(super) frames: &'a Frames,
    pub(super) all: Vec<DraftPalm>,
    /// What is of no palm.
    pub(super) remarks: Vec<String>,
}

impl Palms<'_> {
    pub(super) fn find(&mut self) {
        let of = |kinds: &[MessageKind]| -> Vec<&Topic> {
            let is =
                |topic: &&Topic| MessageKind::of(&topic.schema).is_some_and(|kind| kinds.contains(&kind));
            self.bag.topics.values().filter(is).collect()
        };
        let wrenches = of(&[MessageKind::Wrench]);
        let contacts = of(&[MessageKind::Point, MessageKind::Contact]);
        let taxels: Vec<&Topic> = of(&[MessageKind::Image, MessageKind::Tactile]);
        for topic in wrenches {
            self.add(topic, |topics| topics.wrench = Some(topic.name.clone()));
        }
        for topic in contacts {
            let frame = topic.frames().first().map_or("", |frame| plain(frame)).to_owned();
            let name = Some(topic.name.clone());
            let alone = self.all.iter().all(|palm| palm.topics.wrench.is_none());
            match self.palm_of(&frame, &space(&topic.name)) {
                Some(palm) if palm.topics.contact.is_none() => {
                    palm.topics.contact = name;
                    if frame.is_empty() && topic.count > 0 {
                        palm.remarks.push(format!("{} names no frame: `contact_frame` says it", topic.name));
                    }
                }
                Some(_) => {}
                None if alone => {
                    self.add(topic, |topics| topics.contact = name);
                }
                None => self.remarks.push(format!("{} is of no palm that has a wrench.", topic.name)),
            }
        }
        for topic in taxels {
            self.taxels(topic);
        }
    }

    fn add(&mut self, topic: &Topic, set: impl FnOnce(&mut PalmTopics)) {
        let frame =
            topic.frames().first().map(|frame| plain(frame).to_owned()).filter(|frame| !frame.is_empty());
        let mut palm =
            DraftPalm { topics: PalmTopics::default(), space: space(&topic.name), remarks: Vec::new() };
        if let Some(frame) = &frame
            && !self.frames.names().contains(&frame.as_str())
        {
            palm.remarks.push(format!("the frame `{frame}` of {} is in no transform", topic.name));
        }
        if let Err(why) = &topic.kind {
            palm.remarks.push(format!("{}: {why}", topic.name));
        } else if topic.count == 0 {
            palm.remarks.push(format!("{} has no message", topic.name));
        }
        palm.topics.frame = frame;
        set(&mut palm.topics);
        self.all.push(palm);
    }

    /// The palm in whose frame a topic is, else the one beside which it stands by name.
    fn palm_of(&mut self, frame: &str, space: &str) -> Option<&mut DraftPalm> {
        let known = self.frames.names().contains(&frame);
        let stands = |palm: &DraftPalm| {
            palm.topics.frame.as_deref().is_some_and(|its| !frame.is_empty() && self.frames.is_in(frame, its))
        };
        let beside = |palm: &DraftPalm| palm.space == space && !space.is_empty();
        let by_name = self.all.iter().filter(|palm| beside(palm)).count() == 1;
        // Of several palms whose readings are told in one frame it is the one of that name.
        let both = self.all.iter().position(|palm| stands(palm) && beside(palm));
        let found = both.or_else(|| self.all.iter().position(stands));
        let found = found.or_else(|| self.all.iter().position(beside).filter(|_| by_name))?;
        let names = self.frames.names();
        let lost = |its: &String| !names.contains(&its.as_str());
        // A sensor that stands in the frame of the contacts: that is the palm, unless contacts are told in the world.
        let in_it = |its: &String| self.frames.is_in(its, frame) && self.frames.root(frame) != frame;
        let palm = &mut self.all[found];
        // The frame of the other topic stands where that of the first one is lost.
        if known && palm.topics.frame.as_ref().is_none_or(|its| lost(its) || in_it(its)) {
            palm.topics.frame = Some(frame.to_owned());
        }
        Some(palm)
    }

    fn taxels(&mut self, topic: &Topic) {
        let arrays: Vec<(String, Option<String>)> =
            match topic.messages.first().map(|message| &message.reading) {
                Some(Reading::Taxels { .. }) => {
                    vec![(topic.frames().first().map_or("", |frame| plain(frame)).to_owned(), None)]
                }
                Some(Reading::Arrays(all)) => {
                    all.iter().map(|(name, _)| (name.to_string(), Some(name.to_string()))).collect()
                }
                _ => return,
            };
        for (frame, sensor) in arrays {
            let (topic_name, floor) = (topic.name.clone(), Some(0.05));
            // An image says its rows and columns; of an array of values nobody can.
            let taxels = TaxelTopic {
                topic: topic_name,
                sensor: sensor.clone(),
                frame: None,
                rows: None,
                columns: None,
                pitch: Pitch::Both(0.0),
                value: TaxelValue::Pressure,
                factor: 1.0,
                floor,
            };
            match self.palm_of(&frame, &space(&topic.name)) {
                Some(palm) if palm.topics.taxels.is_none() => palm.topics.taxels = Some(taxels),
                Some(_) => {}
                None if sensor.is_none() => self.add(topic, |topics| topics.taxels = Some(taxels)),
                None => self
                    .remarks
                    .push(format!("Array {frame} of {} is of no palm that was found.", topic.name)),
            }
        }
    }
}

fn space(topic: &str) -> String {
    topic.rsplit_once('/').map_or("", |(space, _)| space).to_owned()
}
