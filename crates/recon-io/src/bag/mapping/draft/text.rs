//! A drafted mapping as a file.

use super::super::{BagMapping, ForceOn, PalmTopics, TaxelTopic, TopicClock};
use super::find::DraftPalm;
use crate::bag::log::PalmClock;
use crate::bag::message::MessageKind;
use crate::bag::read::Bag;
use crate::brief_to;
use recon::contact_kinematics::PalmSurface;
use std::fmt::Write;

/// The file, with remarks where somebody has to decide.
pub(super) fn text(
    bag: &Bag,
    name: &str,
    mapping: &BagMapping,
    palms: &[DraftPalm],
    clocks: &[PalmClock],
) -> String {
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
