use super::{Source, Standing, Steady, Touches, Wrenches};
use crate::PalmSetup;
use crate::bag::error::BagErrorKind as Kind;
use crate::bag::frames::{Way, plain};
use crate::bag::mapping::{ForceOn, PalmTopics};
use crate::bag::message::{MessageKind, Reading};
use crate::bag::topic::{Message, Topic};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{PalmSurface, PressureError, SurfacePose};
use recon::object_dynamics::Track;

/// Force below which a palm is not touched where the mapping does not say it, as a share of the largest.
pub(super) const LEAST_SHARE: f64 = 0.01;

/// Share of a force below which its noise is for a centre of pressure to be taken from less than that.
const KNOWN: f64 = 1e-3;

/// Reads the topics of one palm.
pub(super) struct PalmReader<'a> {
    pub(super) source: Source<'a>,
    /// From 1.
    pub(super) number: usize,
    pub(super) palm: &'a PalmTopics,
    pub(super) surface: PalmSurface,
}

/// A frame in the palm's.
pub(super) enum Inside<'a> {
    Itself,
    Fixed(SurfacePose),
    Moving(Way<'a>),
}

impl Inside<'_> {
    pub(super) fn at(&self, t: f64) -> Option<SurfacePose> {
        match self {
            Self::Itself => Some(SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }),
            Self::Fixed(pose) => Some(*pose),
            Self::Moving(way) => way.at(t),
        }
    }

    pub(super) fn point(&self, t: f64, point: DVec3) -> Option<DVec3> {
        match self {
            Self::Itself => Some(point),
            _ => self.at(t).map(|pose| pose.p_WP + pose.R_WP * point),
        }
    }
}

impl<'a> PalmReader<'a> {
    pub(super) fn key(&self, name: &str) -> String {
        format!("palm[{}].{name}", self.number)
    }

    pub(super) fn pose(&self, setup: &PalmSetup) -> Result<Standing<'a>, Kind> {
        let world = &self.source.mapping.world;
        match (&self.palm.frame, setup.pose) {
            (Some(frame), _) => {
                let way = self.source.frames.way(frame, world);
                let way =
                    way.ok_or_else(|| self.unknown(format!("palm {}", self.number), frame, world, "frame"))?;
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
        let transforms = |topic: &&Topic| topic.schema == MessageKind::Transforms.name();
        let mut topics = self.source.bag.topics.values().filter(transforms);
        if let Some((topic, why)) =
            topics.find_map(|topic| Some((topic.name.clone(), topic.kind.clone().err()?)))
        {
            return Kind::Unread { topic, why };
        }
        let all = self.source.frames.names();
        // Where nothing stands in the world of the mapping, that is what has another name.
        let no_world = !all.is_empty() && !all.contains(&plain(to)) && to == self.source.mapping.world;
        let joined = |name: &&str| no_world || self.source.frames.way(name, to).is_some();
        let known: Vec<&str> = all.iter().copied().filter(joined).collect();
        let known = if known.is_empty() { "none".to_owned() } else { known.join(", ") };
        let key = if no_world { "world".to_owned() } else { self.key(key) };
        let (frame, to) = (frame.to_owned(), to.to_owned());
        Kind::UnknownFrame { asked, frame, to, known, key }
    }

    /// How a topic's frame stands in the palm's.
    pub(super) fn inside(
        &self,
        topic: &Topic,
        named: Option<&String>,
        key: &str,
    ) -> Result<Inside<'a>, Kind> {
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

    pub(super) fn wrenches(&self, name: &str) -> Result<Wrenches, Kind> {
        let (topic, all) = self.source.messages(name, &self.key("wrench"), &[MessageKind::Wrench])?;
        let into = self.inside(topic, self.palm.wrench_frame.as_ref(), "wrench_frame")?;
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
    pub(super) fn track(&self, topic: &str, times: Vec<f64>, values: Vec<DVec3>) -> Result<Steady, Kind> {
        Track::new(times, values).map(Steady::new).map_err(|error| Kind::Array {
            topic: topic.to_owned(),
            t: 0.0,
            found: error.to_string(),
            expected: "numbers that stay finite".to_owned(),
            key: "units".to_owned(),
        })
    }

    /// Contacts of a topic, and the forces that it states beside them.
    pub(super) fn contacts(&self, name: &str) -> Result<(Touches, Option<Wrenches>), Kind> {
        let kinds = [MessageKind::Point, MessageKind::Contact];
        let (topic, all) = self.source.messages(name, &self.key("contact"), &kinds)?;
        let into = self.inside(topic, self.palm.contact_frame.as_ref(), "contact_frame")?;
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

    /// Where the wrench says that the palm is touched; wrenches of no contact are an error if contacts are taken from them.
    pub(super) fn pressed(&self, wrench: &Wrenches, relied_on: bool) -> Result<Touches, Kind> {
        let push = |force: &DVec3| if self.surface == PalmSurface::Plane { force.z } else { force.length() };
        let largest = wrench.forces.values().iter().map(push).fold(0.0, f64::max);
        let least = self.palm.least_force.unwrap_or_else(|| least(wrench.forces.values(), largest));
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
    pub(super) fn motor(&self, topic: &str, joint: &str) -> Result<Steady, Kind> {
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

/// Below which a palm is not touched whose forces are at most so large, N: of forces that are as good as exact small ones still say where they act.
fn least(forces: &[DVec3], largest: f64) -> f64 {
    (LEAST_SHARE * largest).min(roughness(forces) / KNOWN)
}

/// Standard deviation of the noise of each axis, by the median of the third differences, of which smooth forces have next to none.
fn roughness(forces: &[DVec3]) -> f64 {
    let third = |f: &[DVec3]| (f[3] - f[0] + 3.0 * (f[1] - f[2])).length_squared();
    let mut squares: Vec<f64> = forces.windows(4).map(third).collect();
    if squares.is_empty() {
        return f64::INFINITY;
    }
    let middle = squares.len() / 2;
    // White noise of unit deviation has 20 in each of three axes, and a median of 0.79 times the mean.
    (*squares.select_nth_unstable_by(middle, f64::total_cmp).1 / (3.0 * 20.0 * 0.79)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::exploration::Source;

    /// A force that dips to 0.1 % of its largest, with white noise.
    fn forces(noise: f64) -> Vec<DVec3> {
        let mut source = Source::new(7);
        let mut of = |k: i32| {
            let t = f64::from(k) * 1e-3;
            DVec3::new(0.0, 0.0, 1.002 + (3.0 * t).cos()) + source.normal3() * noise
        };
        (0..2000).map(&mut of).collect()
    }

    #[test]
    fn a_small_force_says_where_it_acts_unless_it_is_noisy() {
        for (noise, expected) in [(0.0, 1e-6..1e-5), (1e-6, 0.9e-3..1.1e-3), (1e-3, 0.02..0.02003)] {
            let least = least(&forces(noise), 2.002);
            assert!(expected.contains(&least), "{noise}: {least}");
        }
        assert_eq!(least(&[DVec3::Z; 3], 1.0), LEAST_SHARE);
    }
}
