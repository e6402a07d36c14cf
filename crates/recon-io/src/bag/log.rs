//! From topics of different rates and clocks to one log in memory.

use super::clock::Clock;
use super::error::BagErrorKind as Kind;
use super::frames::Frames;
use super::mapping::{BagMapping, described};
use super::message::{MessageKind, Reading};
use super::palm::{PalmStreams, Source, Standing};
use super::read::Bag;
use super::samples::Samples;
use super::silences::silences;
use crate::{PalmSetup, Scene};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{PalmSurface, SurfacePose};
use recon::object_dynamics::{ClockOffset, ContactLog, PoseTrack, Rhythm, clock_offset};

/// Farthest offset between clocks that is looked for, s.
const FARTHEST_OFFSET: f64 = 0.1;
/// An offset is one beyond so many of its standard deviations: by chance of Gaussian noise once in a million bags.
const SEEN: f64 = 5.0;
/// An offset below this share of the time between contacts changes nothing that matters, and is no error.
const NEGLIGIBLE: f64 = 0.05;

/// A log that was made of a bag.
#[derive(Clone, Debug, PartialEq)]
pub struct BagLog {
    /// The log; its times are seconds since `epoch`.
    pub log: ContactLog,
    /// Earliest stamp of the mapped topics, ns since the epoch of their clock.
    pub epoch: i64,
    /// How it was brought together: whose times, and by how much what lies between readings is off.
    pub notes: Vec<String>,
    /// What the reader must know: readings that are missing, samples that are left out.
    pub warnings: Vec<String>,
}

/// By how much contacts of a palm come later than its forces say.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmClock {
    /// Palm from 1.
    pub palm: usize,
    /// Topic of the contacts.
    pub contact: String,
    /// Topic of the forces.
    pub wrench: String,
    /// What is left when what the mapping says is taken out.
    pub offset: ClockOffset,
    /// What the mapping says that the contacts are ahead of the forces, s.
    pub stated: f64,
    /// Whether it is an offset, and one that matters.
    pub disagrees: bool,
}

/// What a scene and a mapping say together of the palms' shapes.
///
/// A scene without `[[palm]]` has three flat palms; a mapping may then have others, of its own kinds.
///
/// # Errors
/// [`BagErrorKind::PalmCount`](Kind::PalmCount) and [`BagErrorKind::OtherShape`](Kind::OtherShape).
pub fn palms_of(mapping: &BagMapping, scene: Option<&Scene>) -> Result<Vec<PalmSetup>, Kind> {
    let shape = |i: usize| mapping.palms[i].surface(i + 1).ok().flatten();
    if let Some(setups) = scene.and_then(Scene::palm_setups) {
        if setups.len() != mapping.palms.len() {
            return Err(Kind::PalmCount { mapped: mapping.palms.len(), palms: setups.len() });
        }
        for (i, setup) in setups.iter().enumerate() {
            if let Some(mapped) = shape(i).filter(|mapped| !alike(*mapped, setup.surface)) {
                let [mapped, scene] = [mapped, setup.surface].map(described);
                return Err(Kind::OtherShape { palm: i + 1, mapped, scene });
            }
        }
        return Ok(setups);
    }
    let sensors = scene.map(|scene| scene.sensors).unwrap_or_default();
    let setup = |i: usize| PalmSetup {
        surface: shape(i).unwrap_or(PalmSurface::Plane),
        friction: scene.and_then(|scene| scene.friction),
        pose: None,
        hinge: None,
        largest_offset: sensors.contact_off_palm.unwrap_or(f64::INFINITY),
    };
    Ok((0..mapping.palms.len()).map(setup).collect())
}

/// Radii that agree to a hundredth are one: contacts know them no better.
fn alike(a: PalmSurface, b: PalmSurface) -> bool {
    let radii = a.radius().zip(b.radius());
    a.name() == b.name() && radii.is_none_or(|(a, b)| (a - b).abs() <= 0.01 * b)
}

/// Makes a log of a bag: readings of all topics at the times of one of them, linear between their neighbours.
///
/// The times are those that the mapping names, else those of the slowest topic that moves, so that no reading is made of others
/// alone. A sample at which a topic has no readings (a silence of more than one and a half of its periods, and before its
/// first and after its last) is left out. Contacts come from their topic, else from taxels, else from the wrench.
///
/// # Errors
/// [`BagErrorKind`](Kind) names topic, place and mend; [`BagErrorKind::ClocksDisagree`](Kind::ClocksDisagree) where contacts and the wrench
/// of one palm tell different times.
pub fn log_of_bag(bag: &Bag, mapping: &BagMapping, palms: &[PalmSetup]) -> Result<BagLog, Kind> {
    refuse_cut(bag, mapping)?;
    if mapping.palms.is_empty() {
        return Err(Kind::NoPalms { found: bag.listed() });
    }
    if palms.len() != mapping.palms.len() {
        return Err(Kind::PalmCount { mapped: mapping.palms.len(), palms: palms.len() });
    }
    let topics = mapped_topics(mapping);
    let clock = Clock::of_mapping(bag, mapping, &topics);
    let frames = Frames::of(bag, &clock)?;
    let source = Source { bag, mapping, clock: &clock, frames: &frames };
    let streams = streams(source, palms)?;
    check_overlap(&streams)?;
    for found in clocks(source, &streams) {
        if found.disagrees && !mapping.clocks_as_stamped {
            let ahead = found.stated + found.offset.ahead;
            let deviation = found.offset.deviation;
            return Err(Kind::ClocksDisagree {
                topic: found.contact,
                other: found.wrench,
                palm: found.palm,
                ahead,
                deviation,
            });
        }
    }
    let truth = mapping.truth.as_ref().map(|topic| true_poses(source, topic)).transpose()?;
    let (label, times) = base(source, &streams)?;
    let mut made = Samples::of(&streams, truth.as_ref(), &label, &times)?;
    let mut warnings: Vec<String> = topics.iter().flat_map(|topic| silences(source, topic)).collect();
    if let Some(place) = bag.cut {
        warnings.push(format!("The bag was cut off at byte {place}; what is before that is used."));
    }
    if made.left_out > 0 {
        warnings.push(format!(
            "{} of {} samples are left out: at their times {} has no readings.",
            made.left_out,
            times.len(),
            made.lacking()
        ));
    }
    let truth = truth.as_ref().and_then(|_| made.true_states());
    if mapping.truth.is_some() && truth.is_none() {
        warnings.push("The truth is not at all samples, and is left out.".to_owned());
    }
    let notes = made.notes(&streams, &label);
    let records = made.records(palms, &streams);
    let stamps = made.times.clone();
    let log = ContactLog::new(made.times, records, truth).map_err(|source| {
        let stamp = source.sample().and_then(|k| stamps.get(k));
        Kind::Samples { stamp: stamp.map(|t| clock.epoch.saturating_add((t * 1e9).round() as i64)), source }
    })?;
    Ok(BagLog { log, epoch: clock.epoch, notes, warnings })
}

/// By how much the contacts of each palm come later than its wrench says, as the path of the contact tells.
///
/// # Errors
/// As [`log_of_bag`].
pub fn clocks_of_bag(bag: &Bag, mapping: &BagMapping, palms: &[PalmSetup]) -> Result<Vec<PalmClock>, Kind> {
    let clock = Clock::of_mapping(bag, mapping, &mapped_topics(mapping));
    let frames = Frames::of(bag, &clock)?;
    let source = Source { bag, mapping, clock: &clock, frames: &frames };
    Ok(clocks(source, &streams(source, palms)?))
}

fn streams<'a>(source: Source<'a>, palms: &[PalmSetup]) -> Result<Vec<PalmStreams<'a>>, Kind> {
    let all = source.mapping.palms.iter().zip(palms).enumerate();
    all.map(|(i, (palm, setup))| source.palm(i + 1, palm, setup)).collect()
}

fn refuse_cut(bag: &Bag, mapping: &BagMapping) -> Result<(), Kind> {
    let Some(place) = bag.cut.filter(|_| !mapping.cut_off) else { return Ok(()) };
    let clock = Clock::new(bag, &[], &[]);
    let all = || bag.topics.values().flat_map(|topic| topic.messages.iter().map(move |m| (topic, m)));
    let last = all().max_by_key(|(_, message)| message.logged);
    let last = last.map(|(topic, message)| (topic.name.clone(), clock.seconds(&topic.name, message)));
    Err(Kind::Cut { place, messages: bag.topics.values().map(|topic| topic.count).sum(), last })
}

/// Topics that a mapping names.
pub(super) fn mapped_topics(mapping: &BagMapping) -> Vec<&str> {
    let mut topics: Vec<&str> = Vec::new();
    for palm in &mapping.palms {
        let taxels = palm.taxels.as_ref().filter(|_| palm.contact.is_none()).map(|taxels| &taxels.topic);
        let joint = palm.joint.as_ref().map(|joint| &joint.topic);
        topics.extend(
            [palm.wrench.as_ref(), palm.contact.as_ref(), taxels, joint]
                .into_iter()
                .flatten()
                .map(String::as_str),
        );
    }
    topics.dedup();
    topics
}

fn clocks(source: Source, streams: &[PalmStreams]) -> Vec<PalmClock> {
    let of = |palm: &PalmStreams| {
        let pressed = palm.pressed.as_ref()?;
        let (first, second) = (pressed.track()?, palm.touches.track()?);
        let offset = clock_offset(&first, &second, FARTHEST_OFFSET)?;
        let period = Rhythm::of(second.times()).period?;
        let stated = source.clock.ahead(&palm.touches.topic) - source.clock.ahead(&pressed.topic);
        let disagrees = offset.is_seen(SEEN) && offset.ahead.abs() > NEGLIGIBLE * period;
        let (contact, wrench) = (palm.touches.topic.clone(), pressed.topic.clone());
        Some(PalmClock { palm: palm.number, contact, wrench, offset, stated, disagrees })
    };
    streams.iter().filter_map(of).collect()
}

/// Refuses topics that have no time in common.
fn check_overlap(streams: &[PalmStreams]) -> Result<(), Kind> {
    let mut all: Vec<(String, f64, f64)> = Vec::new();
    let mut add = |topic: &str, times: &[f64]| {
        if let (Some(first), Some(last)) = (times.first(), times.last()) {
            all.push((topic.to_owned(), *first, *last));
        }
    };
    for palm in streams {
        if let Standing::Way(way) = &palm.pose
            && let Some((topic, times)) = way.slowest()
        {
            add(topic, times);
        }
        if let Some(wrench) = &palm.wrench {
            add(&wrench.topic, wrench.forces.times());
        }
        add(&palm.touches.topic, &palm.touches.times);
    }
    for (i, (topic, from, to)) in all.iter().enumerate() {
        for (other, other_from, other_to) in &all[..i] {
            if from > other_to || other_from > to {
                return Err(Kind::NoOverlap {
                    topic: topic.clone(),
                    from: *from,
                    to: *to,
                    other: other.clone(),
                    other_from: *other_from,
                    other_to: *other_to,
                });
            }
        }
    }
    Ok(())
}

fn true_poses(source: Source, topic: &str) -> Result<PoseTrack, Kind> {
    let (found, all) = source.messages(topic, "truth", &[MessageKind::Pose])?;
    let world = &source.mapping.world;
    let frame = found.frames().first().map_or("", |frame| super::frames::plain(frame)).to_owned();
    let into = if frame.is_empty() || frame == *world { None } else { source.frames.way(&frame, world) };
    let mut rows = Vec::with_capacity(all.len());
    for (t, message) in all {
        let Reading::Pose([x, y, z, i, j, k, w]) = message.reading else { continue };
        let pose = SurfacePose::new(DVec3::new(x, y, z), DQuat::from_xyzw(i, j, k, w));
        let pose = pose.map_err(|source| Kind::Transform { frame: topic.to_owned(), t, source })?;
        let outer = match &into {
            None => Some(SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }),
            Some(way) => way.at(t),
        };
        rows.extend(outer.map(|outer| {
            let p_WP = outer.p_WP + outer.R_WP * pose.p_WP;
            (t, SurfacePose { p_WP, R_WP: outer.R_WP * pose.R_WP })
        }));
    }
    let (times, poses) = rows.into_iter().unzip();
    // Times increase and poses are finite: both were checked.
    PoseTrack::new(times, poses)
        .map_err(|_| Kind::Silent { topic: topic.to_owned(), asked: "truth".to_owned() })
}

/// The topic at whose times the samples are, and these times.
fn base(source: Source, streams: &[PalmStreams]) -> Result<(String, Vec<f64>), Kind> {
    if let Some(topic) = &source.mapping.times {
        let (_, all) = source.messages(topic, "times", &MessageKind::ALL)?;
        return Ok((topic.clone(), all.into_iter().map(|(t, _)| t).collect()));
    }
    let mut slowest: Option<(f64, &str, &[f64])> = None;
    for palm in streams {
        let moving = match &palm.pose {
            Standing::Way(way) => way.slowest(),
            Standing::Fixed(_) => None,
        };
        let wrench = palm.wrench.as_ref().map(|wrench| (wrench.topic.as_str(), wrench.forces.times()));
        let touches = (palm.touches.topic.as_str(), &palm.touches.times[..]);
        for (topic, times) in [Some(touches), wrench, moving].into_iter().flatten() {
            let period = Rhythm::of(times).period.unwrap_or(f64::INFINITY);
            // Rates that differ by jitter alone are one.
            if slowest.is_none_or(|(longest, _, _)| period > 1.001 * longest) {
                slowest = Some((period, topic, times));
            }
        }
    }
    slowest.map_or_else(
        || Ok((String::new(), Vec::new())),
        |(_, topic, times)| Ok((topic.to_owned(), times.to_vec())),
    )
}

/// Contacts of a palm by their topic, and the sum of its forces, in its own axes.
pub(super) struct FeltInPalm {
    /// Contacts, m.
    pub(super) contacts: Vec<DVec3>,
    /// Sum of forces, N.
    pub(super) force: DVec3,
}

/// What is felt of each palm, where topics tell it.
pub(super) fn felt_in_palms(bag: &Bag, mapping: &BagMapping) -> Vec<Option<FeltInPalm>> {
    let clock = Clock::of_mapping(bag, mapping, &mapped_topics(mapping));
    let (Ok(frames), Ok(setups)) = (Frames::of(bag, &clock), palms_of(mapping, None)) else {
        return Vec::new();
    };
    let source = Source { bag, mapping, clock: &clock, frames: &frames };
    let of = |(i, setup): (usize, &PalmSetup)| {
        let palm = source.palm(i + 1, &mapping.palms[i], setup).ok()?;
        let stated = mapping.palms[i].contact.is_some();
        let contacts = palm.touches.points.iter().flatten().copied().filter(|_| stated).collect();
        let force = palm.wrench.iter().flat_map(|wrench| wrench.forces.values()).sum();
        Some(FeltInPalm { contacts, force })
    };
    setups.iter().enumerate().map(of).collect()
}
