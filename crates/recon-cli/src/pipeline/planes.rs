//! Logs of three flat palms without friction as logs of any palms.

use crate::error::CliError;
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::object_dynamics::{ContactLog, ForceChannel, PalmHinge, SensorLog};
use recon_io::Scene;

/// The log as one of any palms, with the normal forces that torques of the motors tell of palms without a force.
pub(super) fn with_forces(log: &SensorLog, scene: &Scene) -> Result<ContactLog, CliError> {
    let log = ContactLog::try_from(log)?;
    let lacking: Vec<usize> =
        (0..log.palms().len()).filter(|&i| log.palms()[i].force_axes().is_none()).collect();
    // The torque of a palm that stands still needs no inertia.
    let still = |i: usize| (0..log.times().len()).all(|k| log.palms()[i].motion(k).w_WP == DVec3::ZERO);
    let inertia = |i: usize| scene.palm_inertia.map(|of| of[i]).or(still(i).then_some(0.0));
    let usable = |i: usize| log.palms()[i].has_torque() && inertia(i).is_some();
    if let Some(palm) = lacking.iter().find(|i| !usable(**i)) {
        return Err(CliError::NoPalmForce { palm: palm + 1 });
    }
    if lacking.is_empty() {
        return Ok(log);
    }
    let (times, truth) = (log.times().to_vec(), log.truth().map(<[_]>::to_vec));
    let mut records = log.records();
    for &i in &lacking {
        let inertia = inertia(i).unwrap_or_default();
        let axis = Direction::new_unchecked(log.palms()[i].motion(0).pose.R_WP * DVec3::X);
        records[i].hinge = Some(PalmHinge { pivot: DVec3::ZERO, axis, inertia });
    }
    let hinged = ContactLog::new(times.clone(), records.clone(), truth.clone())?;
    for i in lacking {
        let forces = hinged.forces_of_torque(i)?;
        let open = |(k, force): (usize, &Option<f64>)| force.is_none() && log.palms()[i].touch(k).is_some();
        if forces.iter().enumerate().any(open) {
            return Err(CliError::NoPalmForce { palm: i + 1 });
        }
        records[i].force = ForceChannel::Normal(forces.into_iter().map(Option::unwrap_or_default).collect());
    }
    Ok(ContactLog::new(times, records, truth)?)
}
