//! A mapping drafted from what a bag holds.

mod find;
mod text;

use super::{BagMapping, ForceOn, TopicClock, described, guess_shape};
use crate::bag::clock::Clock;
use crate::bag::error::BagErrorKind;
use crate::bag::frames::Frames;
use crate::bag::log::{FeltInPalm, PalmClock, clocks_of_bag, felt_in_palms, palms_of};
use crate::bag::message::MessageKind;
use crate::bag::read::Bag;
use crate::bag::topic::Topic;
use find::{DraftPalm, Palms};
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::ClockOffset;

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
    let text = text::text(bag, name, &mapping, &palms, &clocks);
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
