//! Noisy logs of three flat palms without friction: the estimate is that from contacts of any palms, the page that of three palms.

use super::any_palms::{AnyPalms, AnyPalmsRequest, spread};
use super::reconstruct::sentence;
use super::truth::true_shape;
use crate::error::CliError;
use glam::DVec3;
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::{ContactLog, ForceChannel, PalmHinge, SensorLog};
use recon::observer::{ContactNoiseLevel, EstimateError, TrackError};
use recon_io::{PalmTrack, ReportData, Scene, implausibilities};

/// Noise of contacts, as a share of the size, up to which a log is taken as exact.
const EXACT: f64 = 1e-7;

/// The log as one of any palms, with forces where torques of the motors tell them; none where it is as good as exact, or forces are not
/// known.
pub(crate) fn noisy_planes(log: &SensorLog, scene: &Scene) -> Result<Option<ContactLog>, CliError> {
    let contacts = with_forces(ContactLog::try_from(log)?, scene)?;
    if contacts.palms().iter().any(|palm| palm.force_axes().is_none()) {
        return Ok(None);
    }
    let points = contacts.palms().iter().flat_map(|palm| (0..log.samples().len()).map(|k| palm.touch(k)));
    let size = spread(points.flatten().map(|touch| touch.p_WC));
    let rough = || ContactNoiseLevel::by_roughness(&contacts, 0.0, false).contact;
    let noise = scene.sensors.contact_std.unwrap_or_else(rough);
    Ok((noise > EXACT * size).then_some(contacts))
}

/// With the normal forces that torques tell of palms without a force.
fn with_forces(log: ContactLog, scene: &Scene) -> Result<ContactLog, CliError> {
    let lacks = |i: usize| log.palms()[i].force_axes().is_none() && log.palms()[i].has_torque();
    let lacking: Vec<usize> = (0..log.palms().len()).filter(|i| lacks(*i)).collect();
    let (false, Some(inertias)) = (lacking.is_empty(), scene.palm_inertia) else { return Ok(log) };
    let (times, truth) = (log.times().to_vec(), log.truth().map(<[_]>::to_vec));
    let mut records = log.records();
    for (i, (record, inertia)) in records.iter_mut().zip(inertias).enumerate() {
        let axis = Direction::new_unchecked(log.palms()[i].motion(0).pose.R_WP * DVec3::X);
        record.hinge = Some(PalmHinge { pivot: DVec3::ZERO, axis, inertia });
    }
    let hinged = ContactLog::new(times.clone(), records.clone(), truth.clone())?;
    for i in lacking {
        let forces = hinged.forces_of_torque(i)?.into_iter().map(Option::unwrap_or_default);
        records[i].force = ForceChannel::Normal(forces.collect());
    }
    Ok(ContactLog::new(times, records, truth)?)
}

impl AnyPalmsRequest<'_> {
    /// Of a noisy log of three planes, each sample the mean of so many.
    pub(crate) fn of_noisy_planes(&mut self, log: &SensorLog, together: usize, said: Vec<String>) {
        let odd = implausibilities(log, self.scene);
        self.friction = Some(0.0);
        self.together = together;
        self.note =
            "Three flat palms without friction, and noise: the estimate is that from contacts of any palms."
                .to_owned();
        self.implausible = !odd.is_empty();
        self.warnings = odd.iter().map(|odd| sentence(&odd.to_string())).chain(said).collect();
    }
}

/// What the page of three palms shows.
pub(crate) fn as_planes(made: &AnyPalms, log: &SensorLog, scene: &Scene) -> Result<ReportData, CliError> {
    let data = &made.data;
    let mut palms = [PalmTrack::default(), PalmTrack::default(), PalmTrack::default()];
    for (i, (palm, curve)) in palms.iter_mut().zip(&data.curves).enumerate() {
        palm.contacts = curve.clone();
        for sample in log.samples() {
            let frame = PalmFrame::from_normal(sample.palms[i].normal).map_err(|source| {
                CliError::Estimate(EstimateError::Track(TrackError::Palm {
                    palm: i + 1,
                    t: sample.t,
                    source,
                }))
            })?;
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
        truth: data.truth.clone(),
        bounds: data.bounds.clone(),
        true_shape: shape,
        evidence: data.evidence.clone(),
        warnings: std::iter::once(data.note.clone()).chain(data.warnings.clone()).collect(),
    })
}
