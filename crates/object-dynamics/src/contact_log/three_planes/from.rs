use crate::contact_log::record::{ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion};
use crate::contact_log::{ContactLog, ContactLogError};
use crate::{Sample, SensorLog};
use contact_kinematics::{PalmFrame, PalmSurface, SurfacePose};
use glam::{DQuat, DVec3};

impl TryFrom<&SensorLog> for ContactLog {
    type Error = ContactLogError;

    /// Three planes through the origin, each in the frame `[t1 t2 n]` of its normal. Their friction is not known.
    fn try_from(log: &SensorLog) -> Result<Self, ContactLogError> {
        let times = log.samples().iter().map(|sample| sample.t).collect();
        let palms = [0, 1, 2].map(|i| plane(log.samples(), i));
        let palms = palms.into_iter().collect::<Result<Vec<_>, _>>()?;
        Self::new(times, palms, log.truth().map(<[_]>::to_vec))
    }
}

fn plane(samples: &[Sample], i: usize) -> Result<PalmRecord, ContactLogError> {
    let (mut poses, mut states, mut points) = (Vec::new(), Vec::new(), Vec::new());
    let readings = || samples.iter().map(|sample| sample.palms[i]);
    for (sample, reading) in readings().enumerate() {
        let (palm, time) = (i + 1, samples[sample].t);
        let frame = PalmFrame::from_normal(reading.normal).map_err(|source| ContactLogError::Frame {
            palm,
            sample,
            time,
            source,
        })?;
        let pose = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::from_mat3(&frame.rotation()).normalize() };
        let spin = |rate| MeasuredMotion { pose, v_WP: DVec3::ZERO, w_WP: rate * frame.t1 };
        poses.push(pose);
        states.extend(reading.rate.map(spin));
        points.push(reading.contact.map(|s| frame.contact_from_sensor(s)));
    }
    // A palm that is not touched exerts no force, whether or not that was measured.
    let forces = readings().map(|r| r.force.or(r.contact.is_none().then_some(0.0)));
    let measured = readings().any(|r| r.force.is_some());
    let all_or_none = |what, first_missing: Option<usize>| match first_missing {
        Some(sample) => Err(ContactLogError::Missing { what, palm: i + 1, sample, time: samples[sample].t }),
        None => Ok(()),
    };
    if measured {
        all_or_none("force", forces.clone().position(|force| force.is_none()))?;
    }
    if !states.is_empty() {
        all_or_none("rate", readings().position(|r| r.rate.is_none()))?;
    }
    let torques = || readings().map(|r| r.torque).collect::<Vec<_>>();
    Ok(PalmRecord {
        surface: PalmSurface::Plane,
        friction: None,
        motion: if states.is_empty() {
            RecordedMotion::Poses(poses)
        } else {
            RecordedMotion::Measured(states)
        },
        contacts: ContactPoints::World(points),
        force: if measured {
            ForceChannel::Normal(forces.flatten().collect())
        } else {
            ForceChannel::Missing
        },
        impulse: ForceChannel::Missing,
        torque: readings().any(|r| r.torque.is_some()).then(torques),
        hinge: None,
        truth: None,
        largest_offset: f64::INFINITY,
    })
}
