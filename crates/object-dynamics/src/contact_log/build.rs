//! From what palms recorded to what a log holds.

use super::PalmHinge;
use super::error::ContactLogError as Error;
use super::palm::{LoggedMotion, LoggedPalm, Touch};
use super::record::{
    ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion, TwistSource, not_finite,
    not_taken,
};
use super::twice::{self, contradiction};
use super::twists::{Apart, against_poses};
use crate::MOST_PALMS;
use crate::modes::check_friction;
use crate::series::{check_lengths, check_order, is_taken};
use contact_kinematics::{
    CurvatureRadii, FASTEST_PALM, FASTEST_TURN, PalmSurface, PoseTable, SurfaceError, SurfacePose,
    SurfaceState,
};
use glam::DVec3;

/// A force may pull by noise up to this share of the largest force of the log.
const PULL_BY_NOISE: f64 = 0.1;
/// Length of a quaternion that differs from 1 by its own rounding alone.
const UNIT_TO_ROUNDING: f64 = 2.0 * f64::EPSILON;

/// Any turn between two poses, degrees: none is farther. It is the quickest way.
const HALF_TURN: f64 = 180.0;

pub(super) fn palms(
    times: &[f64],
    records: Vec<PalmRecord>,
    truth: Option<usize>,
) -> Result<Vec<LoggedPalm>, Error> {
    check_lengths(times.len(), truth)?;
    for (sample, &time) in times.iter().enumerate() {
        if !time.is_finite() {
            return Err(Error::TimeNotFinite { sample, value: time });
        }
        check_order(sample, sample.checked_sub(1).map(|before| times[before]), time)?;
    }
    if !(1..=MOST_PALMS).contains(&records.len()) {
        return Err(Error::PalmCount { found: records.len() });
    }
    let number = |(index, record)| Builder { palm: index + 1, times }.palm(record);
    let palms: Vec<LoggedPalm> = records.into_iter().enumerate().map(number).collect::<Result<_, _>>()?;
    for (i, palm) in palms.iter().enumerate() {
        if let Some([impulse, integral]) = contradiction(&twice::impulses(times, palm)) {
            return Err(Error::ImpulseAgainstForce { palm: i + 1, impulse, integral });
        }
        if let Some([torque, moment]) = contradiction(&twice::torques(times, palm)) {
            return Err(Error::TorqueAgainstForce { palm: i + 1, torque: torque.x, moment: moment.x });
        }
    }
    check_pulls(times, &palms)?;
    Ok(palms)
}

struct Builder<'a> {
    /// Number from 1.
    palm: usize,
    times: &'a [f64],
}

impl Builder<'_> {
    fn palm(&self, record: PalmRecord) -> Result<LoggedPalm, Error> {
        let palm = self.palm;
        self.check_lengths(&record)?;
        // Of a body without any extent, as none is known here.
        let none = CurvatureRadii { min: 0.0, max: 0.0 };
        record.surface.check(none).map_err(|source| Error::Surface { palm, source })?;
        if let Some(friction) = record.friction {
            check_friction(friction).map_err(|source| Error::Friction { palm, source })?;
        }
        for (what, channel) in [("force", &record.force), ("impulse", &record.impulse)] {
            self.check_taken(what, channel.first_not_taken())?;
        }
        let torques = record.torque.iter().flatten().enumerate();
        self.check_taken("torque", torques.filter_map(|(k, t)| Some((k, (*t)?))).find(|t| !is_taken(t.1)))?;
        self.check_hinge(record.hinge.as_ref())?;
        let motion = self.motion(record.motion)?;
        let (touches, offset) =
            self.touches(record.surface, &motion, &record.contacts, record.largest_offset)?;
        Ok(LoggedPalm {
            surface: record.surface,
            friction: record.friction,
            motion,
            force: while_touched(record.force, &touches),
            touches,
            impulse: record.impulse,
            torque: record.torque,
            hinge: record.hinge,
            truth: record.truth,
            offset,
        })
    }

    fn check_lengths(&self, record: &PalmRecord) -> Result<(), Error> {
        let motion = match &record.motion {
            RecordedMotion::Fixed(_) => None,
            RecordedMotion::Poses(poses) => Some(poses.len()),
            RecordedMotion::Measured(states) => Some(states.len()),
        };
        let channels = [
            ("motion", motion),
            ("contact", Some(record.contacts.points().len())),
            ("force", record.force.len()),
            ("impulse", record.impulse.len()),
            ("torque", record.torque.as_ref().map(Vec::len)),
            ("truth", record.truth.as_ref().map(Vec::len)),
        ];
        let expected = self.times.len();
        match channels.into_iter().find(|(_, length)| length.is_some_and(|found| found != expected)) {
            Some((what, Some(found))) => Err(Error::ChannelLength { what, palm: self.palm, expected, found }),
            _ => Ok(()),
        }
    }

    fn check_taken(&self, what: &'static str, bad: Option<(usize, f64)>) -> Result<(), Error> {
        let Some((sample, value)) = bad else { return Ok(()) };
        let (palm, time) = (self.palm, self.times[sample]);
        Err(if value.is_finite() {
            Error::TooLarge { what, palm, sample, time, value }
        } else {
            Error::ReadingNotFinite { what, palm, sample, time, value }
        })
    }

    fn check_hinge(&self, hinge: Option<&PalmHinge>) -> Result<(), Error> {
        let Some(hinge) = hinge else { return Ok(()) };
        let wrong = |what, value, must| Err(Error::Hinge { palm: self.palm, what, value, must });
        match not_finite(hinge.pivot) {
            Some(value) => wrong("pivot", value, "finite"),
            None if hinge.inertia >= 0.0 && hinge.inertia.is_finite() => Ok(()),
            None => wrong("moment of inertia", hinge.inertia, "zero or above, and finite"),
        }
    }

    fn motion(&self, recorded: RecordedMotion) -> Result<LoggedMotion, Error> {
        let pose = |(sample, pose): (usize, SurfacePose)| {
            let (palm, time) = (self.palm, self.times[sample]);
            unit(pose).map_err(|source| Error::Pose { palm, sample, time, source })
        };
        match recorded {
            RecordedMotion::Fixed(fixed) => Ok(LoggedMotion::Fixed(pose((0, fixed))?)),
            RecordedMotion::Poses(poses) => {
                let poses = poses.into_iter().enumerate().map(pose).collect::<Result<Vec<_>, _>>()?;
                if poses.iter().all(|pose| *pose == poses[0]) {
                    return Ok(LoggedMotion::Fixed(poses[0]));
                }
                let states = self.splined(&poses)?;
                Ok(LoggedMotion::Moving { states, twists: TwistSource::FromPoses })
            }
            RecordedMotion::Measured(states) => {
                let state = |(sample, state): (usize, MeasuredMotion)| -> Result<_, Error> {
                    let bad = |v| not_finite(v).map(|value| (sample, value));
                    self.check_taken("velocity (V)", bad(state.v_WP))?;
                    self.check_taken("angular velocity (W)", bad(state.w_WP))?;
                    Ok(MeasuredMotion { pose: pose((sample, state.pose))?, ..state })
                };
                let states = states.into_iter().enumerate().map(state).collect::<Result<Vec<_>, _>>()?;
                self.check_steps(&states)?;
                self.check_twists(&states)?;
                self.check_against_poses(&states)?;
                let first = MeasuredMotion::at_rest(states[0].pose);
                if states.iter().all(|state| *state == first) {
                    return Ok(LoggedMotion::Fixed(first.pose));
                }
                Ok(LoggedMotion::Moving { states, twists: TwistSource::Stated })
            }
        }
    }

    /// Steps between poses whose velocities are measured: a log may be so coarse that a palm turns far in one.
    fn check_steps(&self, states: &[MeasuredMotion]) -> Result<(), Error> {
        for (sample, pair) in (1..).zip(states.windows(2)) {
            let (palm, time) = (self.palm, self.times[sample]);
            pair[1]
                .pose
                .check_step(&pair[0].pose, time - self.times[sample - 1], sample, HALF_TURN)
                .map_err(|source| Error::Pose { palm, sample, time, source })?;
        }
        Ok(())
    }

    fn check_twists(&self, states: &[MeasuredMotion]) -> Result<(), Error> {
        let limits =
            [("velocity (m/s)", FASTEST_PALM), ("angular velocity (rad/s)", FASTEST_TURN.to_radians())];
        for (sample, state) in states.iter().enumerate() {
            let speeds = [state.v_WP.length(), state.w_WP.length()];
            if let Some(((what, most), value)) =
                limits.into_iter().zip(speeds).find(|((_, most), v)| v > most)
            {
                let (palm, time) = (self.palm, self.times[sample]);
                return Err(Error::TooFast { what, palm, sample, time, value, most });
            }
        }
        Ok(())
    }

    fn check_against_poses(&self, states: &[MeasuredMotion]) -> Result<(), Error> {
        let Some(Apart { what, sample, posed, stated, distance }) = against_poses(self.times, states) else {
            return Ok(());
        };
        let (palm, time) = (self.palm, self.times[sample]);
        Err(Error::TwistAgainstPoses { what, palm, sample, time, posed, stated, distance })
    }

    fn splined(&self, poses: &[SurfacePose]) -> Result<Vec<MeasuredMotion>, Error> {
        let rows: Vec<_> = self.times.iter().copied().zip(poses.iter().copied()).collect();
        // Times and poses were checked: only steps between them and their number can be wrong.
        let table = PoseTable::new(&rows).map_err(|source| match source {
            SurfaceError::Jump { row, .. } => {
                Error::Pose { palm: self.palm, sample: row, time: self.times[row], source }
            }
            _ => Error::TwistFromPoses { palm: self.palm, samples: poses.len() },
        })?;
        let state = |(t, pose)| {
            let SurfaceState { v_WP, w_WP, .. } = table.at(t);
            MeasuredMotion { pose, v_WP, w_WP }
        };
        Ok(rows.into_iter().map(state).collect())
    }

    /// The contacts on the palm, and how far the farthest was off it.
    fn touches(
        &self,
        surface: PalmSurface,
        motion: &LoggedMotion,
        contacts: &ContactPoints,
        limit: f64,
    ) -> Result<(Vec<Option<Touch>>, f64), Error> {
        let in_palm = matches!(contacts, ContactPoints::Palm(_));
        let mut farthest = 0.0_f64;
        let mut touches = Vec::with_capacity(self.times.len());
        for (sample, point) in contacts.points().iter().enumerate() {
            let Some(point) = *point else {
                touches.push(None);
                continue;
            };
            let (palm, time) = (self.palm, self.times[sample]);
            self.check_taken("contact", not_taken(point).map(|value| (sample, value)))?;
            let pose = match motion {
                LoggedMotion::Fixed(pose) => pose,
                LoggedMotion::Moving { states, .. } => &states[sample].pose,
            };
            let frame = pose.at_rest();
            let p_W = if in_palm { frame.to_world(point) } else { point };
            let (touch, distance) =
                Touch::on(surface, &frame, p_W).ok_or(Error::NoNormal { palm, sample, time })?;
            // A limit that is not a number limits nothing.
            if distance.abs() > limit {
                return Err(Error::OffPalm { palm, sample, time, distance, limit });
            }
            farthest = farthest.max(distance.abs());
            touches.push(Some(touch));
        }
        Ok((touches, farthest))
    }
}

/// The force, without the noise of a sensor that is not touched.
fn while_touched(mut force: ForceChannel, touches: &[Option<Touch>]) -> ForceChannel {
    for (k, _) in touches.iter().enumerate().filter(|(_, touch)| touch.is_none()) {
        match &mut force {
            ForceChannel::Missing => {}
            ForceChannel::Normal(values) => values[k] = 0.0,
            ForceChannel::Three(vectors) => vectors[k] = DVec3::ZERO,
        }
    }
    force
}

/// The pose with its quaternion at unit length; one that is unit to rounding stays as it is, digit by digit.
fn unit(pose: SurfacePose) -> Result<SurfacePose, SurfaceError> {
    let checked = SurfacePose::new(pose.p_WP, pose.R_WP)?;
    let as_it_is = (pose.R_WP.length() - 1.0).abs() <= UNIT_TO_ROUNDING;
    Ok(if as_it_is { pose } else { checked })
}

fn check_pulls(times: &[f64], palms: &[LoggedPalm]) -> Result<(), Error> {
    let normal_force = |palm: &LoggedPalm, k: usize| match (&palm.force, palm.touches[k]) {
        (ForceChannel::Normal(values), _) => values[k],
        (ForceChannel::Three(vectors), Some(touch)) => vectors[k].dot(touch.n.get()),
        _ => 0.0,
    };
    let all = || (0..times.len()).flat_map(|k| (0..palms.len()).map(move |i| (k, i)));
    let largest = all().map(|(k, i)| normal_force(&palms[i], k)).fold(0.0_f64, f64::max);
    for (sample, i) in all() {
        let value = normal_force(&palms[i], sample);
        if value < -PULL_BY_NOISE * largest {
            return Err(Error::Pull { palm: i + 1, sample, time: times[sample], value });
        }
    }
    Ok(())
}
