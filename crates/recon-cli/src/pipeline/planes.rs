//! Logs of three flat palms without friction: the estimate is that from contacts of any palms, the page that of three palms.

use super::any_palms::AnyPalms;
use super::truth::true_shape;
use crate::error::CliError;
use glam::DVec3;
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::{ContactLog, ForceChannel, PalmHinge, SensorLog};
use recon_io::{PalmTrack, ReportData, Scene, estimated_mode_spans};

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

/// What the page of three palms shows.
pub(crate) fn as_planes(made: &AnyPalms, log: &SensorLog, scene: &Scene) -> Result<ReportData, CliError> {
    let data = &made.data;
    let mut palms = [PalmTrack::default(), PalmTrack::default(), PalmTrack::default()];
    for (i, (palm, curve)) in palms.iter_mut().zip(&data.curves).enumerate() {
        palm.contacts = curve.clone();
        let sensed = &data.log.palms()[i];
        palm.forces =
            (0..log.samples().len()).map(|k| sensed.force(k).map(|force| force.vector.length())).collect();
        for sample in log.samples() {
            let frame = PalmFrame::from_normal(sample.palms[i].normal)
                .map_err(|source| CliError::PalmFrame { palm: i + 1, t: sample.t, source })?;
            palm.frames.push(frame);
        }
    }
    // Truth stands in the body axes of the estimate.
    let own =
        log.truth().zip(data.truth.as_ref()).and_then(|(told, shown)| Some((told.first()?, shown.first()?)));
    let shape = match (&scene.simulation, own) {
        (Some(simulation), Some((told, shown))) => {
            Some(true_shape(simulation, told.R_WO.inverse() * shown.R_WO)?)
        }
        _ => None,
    };
    Ok(ReportData {
        title: data.title.clone(),
        verdict: data.verdict.clone(),
        times: data.log.times().to_vec(),
        palms,
        motion: data.estimate.states.iter().map(|state| (*state).into()).collect(),
        deviations: data.estimate.deviations.clone(),
        relied_on: data.estimate.relied_on.clone(),
        spans: (0..data.log.palms().len())
            .map(|palm| {
                estimated_mode_spans(
                    data.log.times(),
                    &data.estimate.modes,
                    data.estimate.mode_odds.as_ref(),
                    palm,
                )
            })
            .collect(),
        truth: data.truth.clone(),
        bounds: data.bounds.clone(),
        true_shape: shape,
        evidence: data.evidence.clone(),
        warnings: data.warnings.clone(),
        next: data.next.clone(),
    })
}
