//! A mapping drafted from what a bag holds.

use super::{
    BagMapping, ForceOn, PalmTopics, Pitch, TaxelTopic, TaxelValue, TopicClock, described, guess_shape,
};
use crate::bag::clock::Clock;
use crate::bag::error::BagErrorKind;
use crate::bag::frames::{Frames, plain};
use crate::bag::log::{FeltInPalm, PalmClock, clocks_of_bag, felt_in_palms, palms_of};
use crate::bag::message::{MessageKind, Reading};
use crate::bag::read::Bag;
use crate::bag::topic::Topic;
use crate::brief_to;
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::ClockOffset;
use std::fmt::Write;

/// A mapping as far as a bag tells it.
#[derive(Clone, Debug, PartialEq)]
pub struct MappingDraft {
    /// The file, with remarks where somebody has to decide.
    pub text: String,
    /// The same in memory; clocks are those that were found.
    pub mapping: BagMapping,
    /// Clocks of contacts against those of forces, as stamped.
    pub clocks: Vec<PalmClock>,
    /// What was understood, and what was not.
    pub remarks: Vec<String>,
}

/// Drafts a mapping: palms are the topics of wrenches (else of contacts, else of taxels), and what is in their frames or beside them in name;
/// shapes are those on which contacts lie; clocks those that contacts and wrenches tell.
///
/// # Errors
/// [`BagErrorKind::TwoParents`] and [`BagErrorKind::Transform`]: the transforms of the bag are none.
pub fn draft_mapping(bag: &Bag, name: &str) -> Result<MappingDraft, BagErrorKind> {
    let clock = Clock::new(bag, &[], &[]);
    let frames = Frames::of(bag, &clock)?;
    let mut palms = Palms { bag, frames: &frames, all: Vec::new(), remarks: Vec::new() };
    palms.find();
    let Palms { all: mut palms, mut remarks, .. } = palms;
    for palm in &mut palms {
        palm.pitch_from(bag);
    }
    let mut mapping = BagMapping {
        world: world(&frames, &palms),
        times: None,
        truth: truth(bag),
        cut_off: bag.cut.is_some(),
        leave_out_not_finite: true,
        clocks_as_stamped: true,
        units: Default::default(),
        palms: palms.iter().map(|palm| palm.topics.clone()).collect(),
        clocks: Vec::new(),
    };
    for (i, felt) in felt_in_palms(bag, &mapping).into_iter().enumerate() {
        let Some(FeltInPalm { contacts, force }) = felt else { continue };
        let inward = force.dot(contacts.iter().sum()) < 0.0;
        let Some(surface) = guess_shape(&contacts, inward) else { continue };
        mapping.palms[i].kind = Some(surface.name().to_owned());
        mapping.palms[i].radius = surface.radius();
        remarks.push(format!("The contacts of palm {} lie as on one of kind {}.", i + 1, described(surface)));
        // Palms push: a flat one whose force points into it tells the force on itself.
        if surface == PalmSurface::Plane && force.z < 0.0 {
            mapping.palms[i].force_on = ForceOn::Palm;
            remarks.push(format!("The force of palm {} points into it: it is that on the palm.", i + 1));
        }
    }
    for topic in bag.topics.values().filter(|topic| topic.kind == Ok(MessageKind::Joints)) {
        remarks.push(format!(
            "{} has states of joints; a palm's `joint` takes the torque of its motor from there.",
            topic.name
        ));
    }
    if mapping.palms.is_empty() {
        remarks.push("No palm was found: no topic of wrenches, contacts or taxels is read.".to_owned());
    }
    let clocks =
        palms_of(&mapping, None).and_then(|setups| clocks_of_bag(bag, &mapping, &setups)).unwrap_or_default();
    for PalmClock { contact, offset, disagrees, .. } in &clocks {
        if *disagrees {
            let ahead = rounded(offset);
            mapping.clocks.push(TopicClock { topic: contact.clone(), ahead, time: Default::default() });
        }
    }
    let text = text(bag, name, &mapping, &palms, &clocks);
    (mapping.cut_off, mapping.leave_out_not_finite, mapping.clocks_as_stamped) = (false, false, false);
    Ok(MappingDraft { text, mapping, clocks, remarks })
}

/// To as many digits as matter: rounding moves the contacts by less than a sixth of what is left between the two paths (root mean
/// square), but is no finer than a nanosecond.
fn rounded(offset: &ClockOffset) -> f64 {
    // What is left over the speed of the contact, s: from how the deviation is made.
    let left = offset.deviation * (3.0 * offset.readings as f64).sqrt();
    let digits = (-(0.3 * left.clamp(1e-8, 1.0)).log10().floor()).clamp(0.0, 9.0) as usize;
    let ahead = offset.ahead;
    format!("{ahead:.digits$}").parse().unwrap_or(ahead)
}

/// One palm as it is found, with remarks for the file.
struct DraftPalm {
    topics: PalmTopics,
    /// Names before the last slash of its first topic.
    space: String,
    /// Lines of the file about it that are no keys.
    remarks: Vec<String>,
}

impl DraftPalm {
    /// The distance of taxels, where a metadata record of the bag says it.
    fn pitch_from(&mut self, bag: &Bag) {
        let pitch = bag.metadata.get("taxel_layout").and_then(|layout| layout.get("pitch_m")?.parse().ok());
        if let (Some(taxels), Some(pitch)) = (&mut self.topics.taxels, pitch) {
            taxels.pitch = Pitch::Both(pitch);
        }
    }
}

struct Palms<'a> {
    bag: &'a Bag,
    frames: &'a Frames,
    all: Vec<DraftPalm>,
    remarks: Vec<String>,
}

impl Palms<'_> {
    fn find(&mut self) {
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
        let found = self.all.iter().position(stands);
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

/// The frame above those of the palms.
fn world(frames: &Frames, palms: &[DraftPalm]) -> String {
    let roots =
        palms.iter().filter_map(|palm| palm.topics.frame.as_deref()).map(|frame| (frames.root(frame), frame));
    roots.filter(|(root, frame)| root != frame).map(|(root, _)| root).next().unwrap_or("world").to_owned()
}

/// A pose that is called the truth.
fn truth(bag: &Bag) -> Option<String> {
    let called = |topic: &&Topic| topic.kind == Ok(MessageKind::Pose) && topic.name.contains("truth");
    bag.topics.values().find(called).map(|topic| topic.name.clone())
}

fn text(bag: &Bag, name: &str, mapping: &BagMapping, palms: &[DraftPalm], clocks: &[PalmClock]) -> String {
    let mut text = format!("# Drafted by `recon inspect {name}`: look it over before it is used.\n");
    let _ = writeln!(text, "world = {:?}                      # z axis up", mapping.world);
    for topic in bag.topics.values().filter(|topic| topic.kind == Ok(MessageKind::Pose)) {
        let is = mapping.truth.as_ref() == Some(&topic.name);
        let _ = writeln!(
            text,
            "{}truth = {:?}    # pose of the body's axes in its centre of mass, to compare with alone",
            if is { "" } else { "# " },
            topic.name
        );
    }
    if let Some(place) = bag.cut {
        let _ = writeln!(
            text,
            "# cut_off = true    # the bag ends at byte {place} within a record; so what is before it is used"
        );
    }
    for (topics, palm) in mapping.palms.iter().zip(palms) {
        text.push_str("\n[[palm]]\n");
        for remark in &palm.remarks {
            let _ = writeln!(text, "# {remark}");
        }
        write_palm(&mut text, topics);
    }
    for clock in clocks {
        let said = mapping.clocks.iter().find(|said| said.topic == clock.contact);
        if let Some(TopicClock { topic, ahead, .. }) = said {
            let _ = writeln!(
                text,
                "\n[[clock]]\ntopic = {topic:?}\nahead = {ahead}    # s, deviation {}: contacts against those that {} gives",
                brief_to(2, clock.offset.deviation),
                clock.wrench
            );
        }
    }
    text
}

fn write_palm(text: &mut String, palm: &PalmTopics) {
    if let Some(frame) = &palm.frame {
        let _ = writeln!(text, "frame = {frame:?}");
    }
    match (&palm.kind, palm.radius) {
        (Some(kind), Some(radius)) => {
            let _ = writeln!(text, "kind = {kind:?}    # as its contacts lie\nradius = {radius}");
        }
        (Some(kind), None) => {
            let _ = writeln!(text, "kind = {kind:?}    # as its contacts lie");
        }
        _ => {
            let _ = writeln!(
                text,
                "# kind = {:?}    # or sphere, cup, cylinder with a radius: nothing tells it",
                PalmSurface::Plane.name()
            );
        }
    }
    if let Some(wrench) = &palm.wrench {
        let on = if palm.force_on == ForceOn::Palm { "palm" } else { "object" };
        let _ = writeln!(
            text,
            "wrench = {wrench:?}\nforce_on = {on:?}    # the body on which it acts: object, or palm, as many sensors measure it"
        );
    }
    if let Some(contact) = &palm.contact {
        let _ = writeln!(text, "contact = {contact:?}");
    }
    if let Some(taxels) = &palm.taxels {
        let TaxelTopic { topic, sensor, pitch, .. } = taxels;
        let off = if palm.contact.is_some() { "# " } else { "" };
        let named = sensor
            .as_ref()
            .map_or(String::new(), |sensor| format!(", sensor = {sensor:?}, rows = 0, columns = 0"));
        let [pitch, _] = pitch.each();
        let give = if pitch > 0.0 { "" } else { ": give pitch, m" };
        let _ = writeln!(
            text,
            "{off}taxels = {{ topic = {topic:?}{named}, pitch = {pitch}, value = \"pressure\", factor = 1.0, floor = 0.05 }}    # in place of `contact`{give}"
        );
    }
}
