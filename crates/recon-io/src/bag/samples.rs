//! Readings of all topics at the times of one.

use super::error::BagErrorKind as Kind;
use super::palm::{PalmStreams, Standing, Steady, Touched};
use crate::{PalmSetup, brief_to};
use glam::DVec3;
use recon::contact_kinematics::{PoseTable, SurfacePose, in_parts};
use recon::object_dynamics::{
    ContactPoints, ForceChannel, PalmRecord, PoseTrack, RecordedMotion, Rhythm, TrueState, TurnAndShift,
};

/// The samples, palm by palm.
pub(super) struct Samples {
    pub(super) times: Vec<f64>,
    palms: Vec<PalmSamples>,
    truth: Vec<Option<SurfacePose>>,
    pub(super) left_out: usize,
    /// What lacked readings, and how often.
    lacks: Vec<(String, usize)>,
}

struct PalmSamples {
    poses: Vec<SurfacePose>,
    points: Vec<Option<DVec3>>,
    forces: Vec<DVec3>,
    normal_forces: Vec<f64>,
    torques: Vec<Option<f64>>,
    /// How many samples lie between readings of contacts, of forces and of poses.
    between: [usize; 3],
}

/// One palm at one time.
struct Instant {
    pose: SurfacePose,
    point: Option<DVec3>,
    force: Option<DVec3>,
    normal_force: Option<f64>,
    torque: Option<f64>,
    between: [bool; 3],
}

impl Samples {
    pub(super) fn of(
        streams: &[PalmStreams],
        truth: Option<&PoseTrack>,
        label: &str,
        times: &[f64],
    ) -> Result<Self, Kind> {
        let truth = truth.map(|truth| (truth, Rhythm::of(truth.times()).longest()));
        let parts = in_parts(times, |times| vec![Self::part(streams, truth, times)]);
        let made = parts.into_iter().fold(Self::none(streams, times.len()), Self::followed_by);
        if made.times.len() < 2 {
            let (topic, asked, lacking) = (label.to_owned(), times.len(), made.lacking());
            return Err(Kind::NoSamples { topic, asked, lacking });
        }
        Ok(made)
    }

    fn none(streams: &[PalmStreams], room: usize) -> Self {
        let palms = streams.iter().map(|_| PalmSamples::none(room)).collect();
        let (times, truth) = (Vec::with_capacity(room), Vec::with_capacity(room));
        Self { times, palms, truth, left_out: 0, lacks: Vec::new() }
    }

    /// Those at some of the times; of the truth how long it may be silent as well, s.
    fn part(streams: &[PalmStreams], truth: Option<(&PoseTrack, f64)>, times: &[f64]) -> Self {
        let mut made = Self::none(streams, times.len());
        let mut instants = Vec::with_capacity(streams.len());
        for &t in times {
            instants.clear();
            match streams.iter().try_for_each(|palm| instant(palm, t).map(|of| instants.push(of))) {
                Ok(()) => {
                    made.times.push(t);
                    made.truth.push(truth.and_then(|(truth, longest)| truth.at(t, longest)));
                    made.palms.iter_mut().zip(&instants).for_each(|(palm, instant)| palm.push(instant));
                }
                Err(what) => made.lack(what, 1),
            }
        }
        made
    }

    fn lack(&mut self, what: String, times: usize) {
        self.left_out += times;
        match self.lacks.iter_mut().find(|(known, _)| *known == what) {
            Some((_, count)) => *count += times,
            None => self.lacks.push((what, times)),
        }
    }

    fn followed_by(mut self, other: Self) -> Self {
        self.times.extend(other.times);
        self.truth.extend(other.truth);
        self.palms.iter_mut().zip(other.palms).for_each(|(palm, other)| palm.extend(other));
        other.lacks.into_iter().for_each(|(what, times)| self.lack(what, times));
        self
    }

    pub(super) fn lacking(&self) -> String {
        let worst = self.lacks.iter().max_by_key(|(_, count)| *count);
        worst.map_or_else(|| "nothing".to_owned(), |(what, _)| what.clone())
    }

    /// Truth of all samples, velocities from a spline through the poses; none where it is not at all of them.
    pub(super) fn true_states(&self) -> Option<Vec<TrueState>> {
        let rows: Option<Vec<(f64, SurfacePose)>> =
            self.times.iter().zip(&self.truth).map(|(t, pose)| Some((*t, (*pose)?))).collect();
        let rows = rows?;
        let table = PoseTable::new(&rows).ok()?;
        let state = |(t, pose): (f64, SurfacePose)| {
            let state = table.at(t);
            TrueState { p_WCm: pose.p_WP, R_WO: pose.R_WP, v_WCm: state.v_WP, w_WO: state.w_WP }
        };
        Some(rows.into_iter().map(state).collect())
    }

    pub(super) fn records(&mut self, setups: &[PalmSetup], streams: &[PalmStreams]) -> Vec<PalmRecord> {
        let palms = std::mem::take(&mut self.palms);
        let record = |((made, setup), streams): ((PalmSamples, &PalmSetup), &PalmStreams)| PalmRecord {
            surface: setup.surface,
            friction: setup.friction,
            motion: match &streams.pose {
                Standing::Fixed(pose) => RecordedMotion::Fixed(*pose),
                Standing::Way(_) => RecordedMotion::Poses(made.poses),
            },
            contacts: ContactPoints::Palm(made.points),
            force: match (&streams.wrench, &streams.normal_force) {
                (Some(_), _) => ForceChannel::Three(made.forces),
                (None, Some(_)) => ForceChannel::Normal(made.normal_forces),
                (None, None) => ForceChannel::Missing,
            },
            impulse: ForceChannel::Missing,
            torque: streams.motor.is_some().then_some(made.torques),
            hinge: setup.hinge,
            truth: None,
            largest_offset: setup.largest_offset,
        };
        palms.into_iter().zip(setups).zip(streams).map(record).collect()
    }

    /// How the readings were brought together.
    pub(super) fn notes(&self, streams: &[PalmStreams], label: &str) -> Vec<String> {
        let rate = Rhythm::of(&self.times).period.map_or(0.0, f64::recip);
        let mut notes =
            vec![format!("{} samples at the times of {label} ({} Hz).", self.times.len(), brief_to(4, rate))];
        for (made, palm) in self.palms.iter().zip(streams) {
            let [contacts, forces, poses] = made.between;
            let mut say = |what: &str, count: usize, error: Option<String>| {
                if let Some(error) = error.filter(|_| count > 0) {
                    notes.push(format!(
                        "Palm {}: at {count} samples {what} lies between readings; linear interpolation is off by {error} at most.",
                        palm.number
                    ));
                }
            };
            let longest = palm.touches.longest;
            let error = palm.touches.track().and_then(|track| track.interpolation_error(longest));
            say("the contact", contacts, error.map(|e| format!("{} m", brief_to(2, e))));
            let track = palm.wrench.as_ref().map(|wrench| &wrench.forces).or(palm.normal_force.as_ref());
            let error = track.and_then(Steady::interpolation_error);
            say("the force", forces, error.map(|e| format!("{} N", brief_to(2, e))));
            if let Standing::Way(way) = &palm.pose {
                let error = way.interpolation_error();
                let words =
                    |e: TurnAndShift| format!("{} m and {} rad", brief_to(2, e.shift), brief_to(2, e.turn));
                say("the pose", poses, error.map(words));
            }
        }
        notes
    }
}

impl PalmSamples {
    fn none(room: usize) -> Self {
        Self {
            poses: Vec::with_capacity(room),
            points: Vec::with_capacity(room),
            forces: Vec::with_capacity(room),
            normal_forces: Vec::with_capacity(room),
            torques: Vec::with_capacity(room),
            between: [0; 3],
        }
    }

    fn extend(&mut self, other: Self) {
        self.poses.extend(other.poses);
        self.points.extend(other.points);
        self.forces.extend(other.forces);
        self.normal_forces.extend(other.normal_forces);
        self.torques.extend(other.torques);
        self.between.iter_mut().zip(other.between).for_each(|(count, more)| *count += more);
    }

    fn push(&mut self, instant: &Instant) {
        self.poses.push(instant.pose);
        self.points.push(instant.point);
        self.forces.push(instant.force.unwrap_or_default());
        self.normal_forces.push(instant.normal_force.unwrap_or_default());
        self.torques.push(instant.torque);
        self.between.iter_mut().zip(instant.between).for_each(|(count, is)| *count += usize::from(is));
    }
}

/// A palm at `t` (s), or what has no readings then.
fn instant(palm: &PalmStreams, t: f64) -> Result<Instant, String> {
    let mut between = [false; 3];
    let pose = match &palm.pose {
        Standing::Fixed(pose) => *pose,
        Standing::Way(way) => {
            let topic = || way.slowest().map_or_else(String::new, |(topic, _)| topic.to_owned());
            between[2] = way.slowest().is_some_and(|(_, times)| !is_among(times, t));
            way.at(t).ok_or_else(topic)?
        }
    };
    let point = match palm.touches.at(t) {
        Touched::Unknown => return Err(palm.touches.topic.clone()),
        Touched::No => None,
        Touched::At { point, between: is } => {
            between[0] = is;
            Some(point)
        }
    };
    let mut at = |track: &Steady, topic: &str| {
        between[1] = !is_among(track.times(), t);
        track.at(t).ok_or_else(|| topic.to_owned())
    };
    let force = palm.wrench.as_ref().map(|wrench| at(&wrench.forces, &wrench.topic)).transpose()?;
    let normal = palm.normal_force.as_ref().map(|track| at(track, &palm.touches.topic)).transpose()?;
    let torque = palm.motor.as_ref().and_then(|motor| motor.at(t));
    Ok(Instant {
        pose,
        point,
        force: force.map(|force| pose.R_WP * force),
        normal_force: normal.map(|force| force.x),
        torque: torque.map(|torque| torque.x),
        between,
    })
}

fn is_among(times: &[f64], t: f64) -> bool {
    times.binary_search_by(|time| time.total_cmp(&t)).is_ok()
}
