//! What the topics of one palm say, in the palm's own frame.

use super::clock::Clock;
use super::error::BagErrorKind as Kind;
use super::frames::{Frames, Way, plain};
use super::mapping::{BagMapping, ForceOn, PalmTopics, TaxelTopic, TaxelValue};
use super::message::{MessageKind, Reading};
use super::read::Bag;
use super::topic::{Message, Topic};
use crate::PalmSetup;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{PalmSurface, PressureError, SurfacePose, TaxelArray};
use recon::object_dynamics::{Rhythm, Track};

/// Force below which a palm is not touched where the mapping does not say it, as a share of the largest.
const LEAST_SHARE: f64 = 0.01;

/// Everything that is needed to read topics.
#[derive(Clone, Copy)]
pub(super) struct Source<'a> {
    pub(super) bag: &'a Bag,
    pub(super) mapping: &'a BagMapping,
    pub(super) clock: &'a Clock,
    pub(super) frames: &'a Frames,
}

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

/// Readings that come at a steady rate, but for silences.
pub(super) struct Steady {
    track: Track,
    /// What is interpolated over at most, s.
    longest: f64,
}

impl Steady {
    fn new(track: Track) -> Self {
        Self { longest: Rhythm::of(track.times()).longest(), track }
    }

    pub(super) fn times(&self) -> &[f64] {
        self.track.times()
    }

    pub(super) fn values(&self) -> &[DVec3] {
        self.track.values()
    }

    pub(super) fn at(&self, t: f64) -> Option<DVec3> {
        self.track.at(t, self.longest)
    }

    pub(super) fn interpolation_error(&self) -> Option<f64> {
        self.track.interpolation_error(self.longest)
    }
}

/// Contacts of a palm over time, palm axes; none while it is not touched.
pub(super) struct Touches {
    pub(super) topic: String,
    pub(super) times: Vec<f64>,
    pub(super) points: Vec<Option<DVec3>>,
    pub(super) longest: f64,
}

/// A contact at one time.
pub(super) enum Touched {
    /// There are no readings.
    Unknown,
    No,
    At {
        point: DVec3,
        /// Whether it lies between two readings.
        between: bool,
    },
}

impl Touches {
    fn new(topic: &str, readings: Vec<(f64, Option<DVec3>)>) -> Self {
        let (times, points): (Vec<f64>, Vec<Option<DVec3>>) = readings.into_iter().unzip();
        let longest = Rhythm::of(&times).longest();
        Self { topic: topic.to_owned(), times, points, longest }
    }

    pub(super) fn at(&self, t: f64) -> Touched {
        let after = self.times.partition_point(|&time| time <= t);
        let Some(before) = after.checked_sub(1) else { return Touched::Unknown };
        if self.times[before] == t {
            return self.points[before].map_or(Touched::No, |point| Touched::At { point, between: false });
        }
        let Some(step) = self.times.get(after).map(|end| end - self.times[before]) else {
            return Touched::Unknown;
        };
        if step > self.longest {
            return Touched::Unknown;
        }
        match (self.points[before], self.points[after]) {
            (Some(a), Some(b)) => {
                Touched::At { point: a.lerp(b, (t - self.times[before]) / step), between: true }
            }
            // Somewhere between a contact and none it began or ended.
            _ => Touched::No,
        }
    }

    /// The contacts alone.
    pub(super) fn track(&self) -> Option<Track> {
        let touched = self.times.iter().zip(&self.points).filter_map(|(t, point)| Some((*t, (*point)?)));
        let (times, points) = touched.unzip();
        Track::new(times, points).ok()
    }
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

    /// The messages of a topic at increasing times; `asked` is the key that names it.
    pub(super) fn messages(
        self,
        topic: &str,
        asked: &str,
        kinds: &[MessageKind],
    ) -> Result<(&'a Topic, Vec<(f64, &'a Message)>), Kind> {
        let found = self.topic(topic, asked)?;
        let kind = found.kind.clone().map_err(|why| Kind::Unread { topic: topic.to_owned(), why })?;
        if !kinds.contains(&kind) {
            return Err(Kind::OtherKind {
                topic: topic.to_owned(),
                asked: asked.to_owned(),
                found: kind.name().to_owned(),
                needed: kinds.iter().map(|kind| kind.name()).collect::<Vec<_>>().join(" or "),
            });
        }
        if found.messages.is_empty() {
            return Err(Kind::Silent { topic: topic.to_owned(), asked: asked.to_owned() });
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
        self.bag.topics.get(topic).ok_or_else(|| {
            let about = |topic: &Topic| format!("{} ({})", topic.name, topic.schema);
            let found: Vec<String> = self.bag.topics.values().map(about).collect();
            Kind::NoTopic { topic: topic.to_owned(), asked: asked.to_owned(), found: found.join(", ") }
        })
    }

    /// Refuses readings that are not finite, or leaves them out where the mapping says so.
    fn finite(
        self,
        topic: &str,
        mut all: Vec<(f64, &'a Message)>,
        bad: impl Fn(&Message) -> Option<(&'static str, f64)>,
    ) -> Result<Vec<(f64, &'a Message)>, Kind> {
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

struct PalmReader<'a> {
    source: Source<'a>,
    number: usize,
    palm: &'a PalmTopics,
    surface: PalmSurface,
}

/// A frame in the palm's.
enum Inside<'a> {
    Itself,
    Fixed(SurfacePose),
    Moving(Way<'a>),
}

impl Inside<'_> {
    fn at(&self, t: f64) -> Option<SurfacePose> {
        match self {
            Self::Itself => Some(SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }),
            Self::Fixed(pose) => Some(*pose),
            Self::Moving(way) => way.at(t),
        }
    }

    fn point(&self, t: f64, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Itself => Some(point),
            _ => self.at(t).map(|pose| pose.p_WP + pose.R_WP * point),
        }
    }
}

impl<'a> PalmReader<'a> {
    fn key(&self, name: &str) -> String {
        format!("palm[{}].{name}", self.number)
    }

    fn pose(&self, setup: &PalmSetup) -> Result<Standing<'a>, Kind> {
        let world = &self.source.mapping.world;
        match (&self.palm.frame, setup.pose) {
            (Some(frame), _) => {
                let way = self.source.frames.way(frame, world);
                let way = way.ok_or_else(|| self.unknown(self.key("frame"), frame, world, "frame"))?;
                Ok(way.fixed().map_or(Standing::Way(way), Standing::Fixed))
            }
            (None, Some(pose)) => Ok(Standing::Fixed(pose)),
            (None, None) => {
                let asked =
                    format!("palm {}, of which neither mapping nor scene say where it stands,", self.number);
                Err(self.unknown(asked, "", world, "frame"))
            }
        }
    }

    fn unknown(&self, asked: String, frame: &str, to: &str, key: &str) -> Kind {
        let joined = |name: &&str| self.source.frames.way(name, to).is_some();
        let known: Vec<&str> = self.source.frames.names().into_iter().filter(joined).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let (frame, to, key) = (frame.to_owned(), to.to_owned(), self.key(key));
        Kind::UnknownFrame { asked, frame, to, known, key }
    }

    /// How a topic's frame stands in the palm's.
    fn into_palm(&self, topic: &Topic, named: Option<&String>, key: &str) -> Result<Inside<'a>, Kind> {
        let Some(palm) = &self.palm.frame else { return Ok(Inside::Itself) };
        let frame = match (named, &topic.frames()[..]) {
            (Some(named), _) => named.clone(),
            (None, [one]) => (*one).to_owned(),
            (None, several) => {
                let (topic, key) = (topic.name.clone(), self.key(key));
                return Err(Kind::ManyFrames { topic, found: several.join(", "), key });
            }
        };
        if frame.is_empty() {
            return Err(Kind::NoFrame { topic: topic.name.clone(), key: self.key(key) });
        }
        if plain(&frame) == plain(palm) {
            return Ok(Inside::Itself);
        }
        let way = self.source.frames.way(&frame, palm);
        let way = way.ok_or_else(|| self.unknown(format!("topic `{}`", topic.name), &frame, palm, key))?;
        Ok(way.fixed().map_or(Inside::Moving(way), Inside::Fixed))
    }

    fn wrenches(&self, name: &str) -> Result<Wrenches, Kind> {
        let (topic, all) = self.source.messages(name, &self.key("wrench"), &[MessageKind::Wrench])?;
        let into = self.into_palm(topic, self.palm.wrench_frame.as_ref(), "wrench_frame")?;
        let all = self.source.finite(name, all, |message| match &message.reading {
            Reading::Wrench(wrench) => {
                const NAMES: [&str; 6] =
                    ["force.x", "force.y", "force.z", "torque.x", "torque.y", "torque.z"];
                NAMES.into_iter().zip(*wrench).find(|(_, value)| !value.is_finite())
            }
            _ => None,
        })?;
        let units = self.source.mapping.units;
        let sign = if self.palm.force_on == ForceOn::Palm { -1.0 } else { 1.0 };
        let read = |(t, message): (f64, &Message)| {
            let Reading::Wrench([a, b, c, d, e, f]) = message.reading else { return None };
            let force = sign * units.force * DVec3::new(a, b, c);
            let torque = sign * units.torque * DVec3::new(d, e, f);
            if let Inside::Itself = into {
                return Some((t, force, torque));
            }
            let pose = into.at(t)?;
            let force = pose.R_WP * force;
            Some((t, force, pose.R_WP * torque + pose.p_WP.cross(force)))
        };
        let (mut times, mut forces, mut torques) = (Vec::new(), Vec::new(), Vec::new());
        for (t, force, torque) in all.into_iter().filter_map(read) {
            times.push(t);
            forces.push(force);
            torques.push(torque);
        }
        let track = |values| self.track(name, times.clone(), values);
        Ok(Wrenches { topic: name.to_owned(), forces: track(forces)?, torques: track(torques)? })
    }

    /// Times increase and values are finite by now, so that it is a track unless units are out of all range.
    fn track(&self, topic: &str, times: Vec<f64>, values: Vec<DVec3>) -> Result<Steady, Kind> {
        Track::new(times, values).map(Steady::new).map_err(|error| Kind::Array {
            topic: topic.to_owned(),
            t: 0.0,
            found: error.to_string(),
            expected: "numbers that stay finite".to_owned(),
            key: "units".to_owned(),
        })
    }

    /// Contacts of a topic, and the forces that it states beside them.
    fn contacts(&self, name: &str) -> Result<(Touches, Option<Wrenches>), Kind> {
        let kinds = [MessageKind::Point, MessageKind::Contact];
        let (topic, all) = self.source.messages(name, &self.key("contact"), &kinds)?;
        let into = self.into_palm(topic, self.palm.contact_frame.as_ref(), "contact_frame")?;
        let all = self.source.finite(name, all, |message| {
            let (values, names): (&[f64], _) = match &message.reading {
                // Without contact there is no point.
                Reading::Point(point) if point.iter().all(|v| v.is_nan()) => return None,
                Reading::Point(point) => (point, ["point.x", "point.y", "point.z"]),
                Reading::Contact(Some((point, force))) => {
                    let bad = force.iter().zip(["force.x", "force.y", "force.z"]);
                    let bad = bad.map(|(v, n)| (n, *v)).find(|(_, v)| !v.is_finite());
                    if bad.is_some() {
                        return bad;
                    }
                    (point, ["point.x", "point.y", "point.z"])
                }
                _ => return None,
            };
            names.into_iter().zip(values.iter().copied()).find(|(_, v)| !v.is_finite())
        })?;
        let units = self.source.mapping.units;
        let (mut readings, mut times, mut forces) = (Vec::new(), Vec::new(), Vec::new());
        for (t, message) in all {
            let (point, force) = match message.reading {
                Reading::Point(point) if point[0].is_nan() => (None, None),
                Reading::Point(point) => (Some(point), None),
                Reading::Contact(None) => (None, Some([0.0; 3])),
                Reading::Contact(Some((point, force))) => (Some(point), Some(force)),
                _ => continue,
            };
            let Some(pose) = into.at(t) else { continue };
            readings.push((t, point.and_then(|point| into.point(t, units.length * DVec3::from(point)))));
            if let Some(force) = force {
                let sign = if self.palm.force_on == ForceOn::Palm { -1.0 } else { 1.0 };
                times.push(t);
                forces.push(pose.R_WP * (sign * units.force * DVec3::from(force)));
            }
        }
        let wrench = if forces.is_empty() {
            None
        } else {
            let torques = self.track(name, times.clone(), vec![DVec3::ZERO; times.len()])?;
            Some(Wrenches { topic: name.to_owned(), forces: self.track(name, times, forces)?, torques })
        };
        Ok((Touches::new(name, readings), wrench))
    }

    /// Contacts and normal forces from taxels.
    fn taxels(&self, taxels: &TaxelTopic) -> Result<(Touches, Steady), Kind> {
        let kinds = [MessageKind::Image, MessageKind::Tactile];
        let (topic, all) = self.source.messages(&taxels.topic, &self.key("taxels.topic"), &kinds)?;
        // A tactile state has one header for many arrays: the name of the array is a frame there.
        let named = taxels.frame.as_ref().or(match topic.kind {
            Ok(MessageKind::Tactile) => taxels.sensor.as_ref(),
            _ => None,
        });
        let into = self.into_palm(topic, named, "taxels.frame")?;
        let [pitch_x, pitch_y] = taxels.pitch.each();
        let area = if taxels.value == TaxelValue::Pressure { pitch_x * pitch_y } else { 1.0 };
        let mut felt = Vec::with_capacity(all.len());
        for (t, message) in all {
            let (rows, columns, values) = self.values(taxels, t, message)?;
            let array = TaxelArray { rows, columns, pitch_x, pitch_y };
            let pressed = array.pressed(values, taxels.floor);
            felt.push((t, pressed.map(|pressed| (taxels.factor * area * pressed.sum, pressed.centre))));
        }
        let largest = felt.iter().filter_map(|(_, felt)| *felt).map(|(force, _)| force).fold(0.0, f64::max);
        let least = self.palm.least_force.unwrap_or(LEAST_SHARE * largest);
        let (mut readings, mut times, mut forces) = (Vec::new(), Vec::new(), Vec::new());
        for (t, felt) in felt {
            let felt = felt.filter(|(force, _)| *force > least);
            readings.push((t, felt.and_then(|(_, centre)| into.point(t, centre))));
            times.push(t);
            forces.push(DVec3::X * felt.map_or(0.0, |(force, _)| force));
        }
        Ok((Touches::new(&taxels.topic, readings), self.track(&taxels.topic, times, forces)?))
    }

    /// Rows, columns and values of the palm's array in a message.
    fn values<'m>(
        &self,
        taxels: &TaxelTopic,
        t: f64,
        message: &'m Message,
    ) -> Result<(usize, usize, &'m [f64]), Kind> {
        let wrong = |found: String, expected: String, key: &str| Kind::Array {
            topic: taxels.topic.clone(),
            t,
            found,
            expected,
            key: self.key(key),
        };
        let (rows, columns, values) = match &message.reading {
            Reading::Taxels { rows, columns, values } => (*rows, *columns, values),
            Reading::Arrays(all) => {
                let sensor = taxels.sensor.as_deref().unwrap_or_default();
                let names = || all.iter().map(|(name, _)| &**name).collect::<Vec<_>>().join(", ");
                let found = all.iter().find(|(name, _)| **name == *sensor);
                let (_, values) = found.ok_or_else(|| {
                    wrong(format!("it has the arrays {}", names()), format!("`{sensor}`"), "taxels.sensor")
                })?;
                let (Some(rows), Some(columns)) = (taxels.rows, taxels.columns) else {
                    let found = format!("its array has {} values in no order that it says", values.len());
                    return Err(wrong(found, "nothing of rows and columns".to_owned(), "taxels"));
                };
                (rows, columns, values)
            }
            Reading::Picture { encoding, rows, columns } => {
                let found = format!("a picture of {columns} x {rows} with the encoding {encoding}");
                return Err(wrong(
                    found,
                    "that it is an array of taxels (32FC1, 16UC1, ...)".to_owned(),
                    "taxels.topic",
                ));
            }
            _ => (0, 0, const { &Vec::new() }),
        };
        let expected = (taxels.rows.unwrap_or(rows), taxels.columns.unwrap_or(columns));
        if expected != (rows, columns) || rows.checked_mul(columns) != Some(values.len()) {
            let found = format!("{} values in {rows} rows of {columns}", values.len());
            return Err(wrong(found, format!("{} rows of {}", expected.0, expected.1), "taxels"));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite())
            && !self.source.mapping.leave_out_not_finite
        {
            let (topic, stamp) = (taxels.topic.clone(), message.stamp);
            return Err(Kind::NotFinite { topic, t, stamp, what: "a taxel", value: *value, count: 1 });
        }
        Ok((rows, columns, values))
    }

    /// Where the wrench says that the palm is touched; wrenches of no contact are an error if contacts are taken from them.
    fn pressed(&self, wrench: &Wrenches, relied_on: bool) -> Result<Touches, Kind> {
        let push = |force: &DVec3| if self.surface == PalmSurface::Plane { force.z } else { force.length() };
        let largest = wrench.forces.values().iter().map(push).fold(0.0, f64::max);
        let least = self.palm.least_force.unwrap_or(LEAST_SHARE * largest);
        let mut readings = Vec::with_capacity(wrench.forces.times().len());
        for (k, &t) in wrench.forces.times().iter().enumerate() {
            let (force, torque) = (wrench.forces.values()[k], wrench.torques.values()[k]);
            let point = if push(&force) > least {
                match self.surface.centre_of_pressure(force, torque) {
                    Ok(point) => Some(point),
                    Err(PressureError::NoPush) => None,
                    Err(_) if !relied_on => None,
                    Err(source) => {
                        let topic = wrench.topic.clone();
                        return Err(Kind::Pressure { topic, palm: self.number, t, source });
                    }
                }
            } else {
                None
            };
            readings.push((t, point));
        }
        Ok(Touches::new(&wrench.topic, readings))
    }

    /// Torques of the palm's motor: x of the vectors, N m.
    fn motor(&self, topic: &str, joint: &str) -> Result<Steady, Kind> {
        let (_, all) = self.source.messages(topic, &self.key("joint.topic"), &[MessageKind::Joints])?;
        let effort = |(t, message): (f64, &Message)| {
            let Reading::Joints(joints) = &message.reading else { return None };
            let joint = joints.iter().find(|known| *known.name == *joint)?;
            joint.effort.filter(|effort| effort.is_finite()).map(|effort| (t, DVec3::X * effort))
        };
        let (times, torques): (Vec<f64>, Vec<DVec3>) = all.into_iter().filter_map(effort).unzip();
        if times.is_empty() {
            let (topic, key) = (topic.to_owned(), self.key("joint.name"));
            let found = "no message has an effort of that joint".to_owned();
            return Err(Kind::Array { topic, t: 0.0, found, expected: format!("`{joint}`"), key });
        }
        self.track(topic, times, torques)
    }
}
