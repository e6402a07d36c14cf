//! What the topics of one palm say, in the palm's own frame.

mod reader;
mod streams;
mod taxels;

pub(super) use streams::{Steady, Touched, Touches};

use crate::PalmSetup;
use crate::bag::clock::Clock;
use crate::bag::error::BagErrorKind as Kind;
use crate::bag::frames::{Frames, Way};
use crate::bag::mapping::{BagMapping, PalmTopics};
use crate::bag::message::MessageKind;
use crate::bag::read::Bag;
use crate::bag::topic::{Message, Topic};
use reader::PalmReader;
use recon::contact_kinematics::SurfacePose;

/// Everything that is needed to read topics.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) bag: &'a Bag,
    pub(super) mapping: &'a BagMapping,
    pub(super) clock: &'a Clock,
    pub(super) frames: &'a Frames,
}

/// Messages with their times, s.
pub(super) type Timed<'a> = Vec<(f64, &'a Message)>;

/// Readings of a palm, each with its own times.
pub(super) struct PalmStreams<'a> {
    /// From 1.
    pub(super) number: usize,
    pub(super) pose: Standing<'a>,
    pub(super) wrench: Option<Wrenches>,
    /// Force along the normal, from taxels: x of the vectors, N.
    pub(super) normal_force: Option<Steady>,
    pub(super) touches: Touches,
    /// Where the wrench says that it is touched, where contacts come from elsewhere.
    pub(super) pressed: Option<Touches>,
    pub(super) motor: Option<Steady>,
}

/// Where a palm stands.
pub(super) enum Standing<'a> {
    Fixed(SurfacePose),
    Way(Way<'a>),
}

/// Force on the object and its torque about the palm's origin, palm axes.
pub(super) struct Wrenches {
    pub(super) topic: String,
    pub(super) forces: Steady,
    pub(super) torques: Steady,
}

impl<'a> Source<'a> {
    /// What the topics of a palm (numbered from 1) of this shape say.
    pub(super) fn palm(
        self,
        number: usize,
        palm: &'a PalmTopics,
        setup: &PalmSetup,
    ) -> Result<PalmStreams<'a>, Kind> {
        let reader = PalmReader { source: self, number, palm, surface: setup.surface };
        // A topic that is not there is named before a frame, which then is most likely not there either.
        let taxels = palm.taxels.as_ref().filter(|_| palm.contact.is_none()).map(|taxels| &taxels.topic);
        for (key, topic) in
            [("wrench", palm.wrench.as_ref()), ("contact", palm.contact.as_ref()), ("taxels.topic", taxels)]
        {
            topic.map(|topic| self.heard(topic, &reader.key(key))).transpose()?;
        }
        let pose = reader.pose(setup)?;
        let wrench = palm.wrench.as_ref().map(|topic| reader.wrenches(topic)).transpose()?;
        let (mut contact_force, mut normal_force) = (None, None);
        let felt = match (&palm.contact, &palm.taxels) {
            (Some(topic), _) => {
                let (touches, force) = reader.contacts(topic)?;
                contact_force = force;
                Some(touches)
            }
            (None, Some(taxels)) => {
                let (touches, force) = reader.taxels(taxels)?;
                normal_force = Some(force);
                Some(touches)
            }
            (None, None) => None,
        };
        let pressed = wrench.as_ref().map(|wrench| reader.pressed(wrench, felt.is_none())).transpose()?;
        let (touches, pressed) = match (felt, pressed) {
            (Some(felt), pressed) => (felt, pressed),
            (None, Some(pressed)) => (pressed, None),
            (None, None) => (Touches::new("", Vec::new()), None),
        };
        let motor = palm.joint.as_ref().map(|joint| reader.motor(&joint.topic, &joint.name)).transpose()?;
        let wrench = wrench.or(contact_force);
        let normal_force = normal_force.filter(|_| wrench.is_none());
        Ok(PalmStreams { number, pose, wrench, normal_force, touches, pressed, motor })
    }

    /// A topic that has messages, and what they are; `asked` is the key that names it.
    fn heard(self, topic: &str, asked: &str) -> Result<(&'a Topic, MessageKind), Kind> {
        let found = self.topic(topic, asked)?;
        let kind = found.kind.clone().map_err(|why| Kind::Unread { topic: topic.to_owned(), why })?;
        if found.messages.is_empty() {
            return Err(Kind::Silent { topic: topic.to_owned(), asked: asked.to_owned() });
        }
        Ok((found, kind))
    }

    /// The messages of a topic at increasing times; `asked` is the key that names it.
    pub(super) fn messages(
        self,
        topic: &str,
        asked: &str,
        kinds: &[MessageKind],
    ) -> Result<(&'a Topic, Timed<'a>), Kind> {
        let (found, kind) = self.heard(topic, asked)?;
        if !kinds.contains(&kind) {
            return Err(Kind::OtherKind {
                topic: topic.to_owned(),
                asked: asked.to_owned(),
                found: kind.name().to_owned(),
                needed: kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(" or "),
            });
        }
        let mut all: Vec<(f64, &Message)> =
            found.messages.iter().map(|message| (self.clock.seconds(topic, message), message)).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        // A message that was recorded twice is one.
        all.dedup_by(|a, b| a.0 == b.0 && a.1.reading == b.1.reading);
        if let Some(pair) = all.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            let stamp = pair[0].1.stamp;
            let count = all.iter().filter(|(t, _)| *t == pair[0].0).count();
            return Err(Kind::Repeated { topic: topic.to_owned(), stamp, count });
        }
        Ok((found, all))
    }

    pub(super) fn topic(self, topic: &str, asked: &str) -> Result<&'a Topic, Kind> {
        let (topic_name, found) = (topic.to_owned(), || self.bag.listed());
        let missing = || Kind::NoTopic { topic: topic_name, asked: asked.to_owned(), found: found() };
        self.bag.topics.get(topic).ok_or_else(missing)
    }

    /// Refuses readings that are not finite, or leaves them out where the mapping says so.
    fn finite(
        self,
        topic: &str,
        mut all: Timed<'a>,
        bad: impl Fn(&Message) -> Option<(&'static str, f64)>,
    ) -> Result<Timed<'a>, Kind> {
        let count = all.iter().filter(|(_, message)| bad(message).is_some()).count();
        let first = all.iter().find_map(|(t, message)| Some((*t, message.stamp, bad(message)?)));
        match first {
            Some((t, stamp, (what, value))) if !self.mapping.leave_out_not_finite => {
                Err(Kind::NotFinite { topic: topic.to_owned(), t, stamp, what, value, count })
            }
            _ => {
                all.retain(|(_, message)| bad(message).is_none());
                Ok(all)
            }
        }
    }
}
