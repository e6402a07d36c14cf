//! Motion of a body, with mass and inertia if they are unknown, from contacts of any palms.

use super::any_palms_bounds::estimate_bounds;
use super::any_palms_words::{evidence, verdict};
use super::bounds::BoundsResult;
use super::reconstruct::{CONFIDENCE, sentence};
use super::truth::true_motion;
use crate::error::CliError;
use crate::progress::Progress;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, LoggedPalm, NotThreePlanes, SensedAxes};
use recon::observer::{
    ContactEstimate, ContactEstimateError, ContactNoiseLevel, ContactOptions, ImpulseNoise,
    estimate_contacts, nearest_turn,
};
use recon_io::{EstimateData, PalmContact, Scene};
use std::error::Error;
use std::path::Path;

/// What contact conditions are off by where the scene does not say it, as a share of the natural speed `sqrt(g l)`: that by which
/// contacts creep that stick in simulators.
const FLOOR: f64 = 3e-5;

/// What was asked for.
pub(crate) struct AnyPalmsRequest<'a> {
    pub(crate) scene: &'a Scene,
    /// File of the log.
    pub(crate) path: &'a Path,
    pub(crate) title: &'a str,
    /// Whether mass and inertia of the scene are not to be looked at.
    pub(crate) identify: bool,
}

/// What contacts of any palms tell.
pub(crate) struct AnyPalms {
    pub(crate) data: EstimateData,
    /// Bounds on the shape, where there are any.
    pub(crate) bounds: Option<BoundsResult>,
}

/// Everything that contacts of any palms tell, and why the log is not one of three planes. Truth in the log is only compared
/// with, never used.
pub(crate) fn estimate_any_palms(
    log: ContactLog,
    why: NotThreePlanes,
    request: &AnyPalmsRequest,
    progress: &Progress,
) -> Result<AnyPalms, CliError> {
    let felt = |palm: &LoggedPalm| by_force(palm) || palm.impulse_axes() == Some(SensedAxes::Three);
    if let Some(i) = log.palms().iter().position(|palm| !felt(palm)) {
        return Err(CliError::NotThreeAxes { path: request.path.to_owned(), palm: i + 1, source: why });
    }
    let mut options = options(&log, request.scene)?;
    if !request.identify {
        options.body = request.scene.mass_properties().ok().flatten();
    }
    progress.step("estimating the motion");
    let (log, truth) = log.split_truth();
    let estimate = estimate_contacts(&log, None, &options).map_err(|error| match error {
        ContactEstimateError::NoSize => CliError::SizeNotStated,
        other => CliError::ContactEstimate(other),
    })?;
    let curves: Vec<_> = log.palms().iter().map(|palm| curve(palm, &estimate)).collect();
    let truth = truth.filter(|truth| !truth.is_empty()).map(|truth| {
        let (at, found) = (truth[0].R_WO, estimate.states[0].R_WO);
        // Axes of an unknown body are those of the world at the first sample, those of a known one its own but for half turns.
        let axes = options.body.as_ref().map_or(at.inverse() * found, |mass| nearest_turn(mass, at, found));
        true_motion(&truth, axes)
    });
    let mut warnings = Vec::new();
    warnings.extend(not_relied_on(&estimate));
    warnings.extend(impulses_not_read(&log, &options));
    progress.step("bounding the shape");
    let bounds = match estimate_bounds(&log, &estimate, &curves, options.noise.contact, CONFIDENCE) {
        Ok(bounds) => bounds,
        Err(error) => {
            let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
            warnings.push(format!("The contacts give no bounds under this motion ({why})."));
            None
        }
    };
    warnings.extend(bounds.iter().flat_map(|bounds| bounds.warnings.clone()));
    if bounds.is_none() {
        warnings
            .push("There are no bounds on the shape: at no sample the pose is known well enough.".to_owned());
    }
    let bounds_at = bounds.is_some().then_some(CONFIDENCE);
    let data = EstimateData {
        title: request.title.to_owned(),
        verdict: verdict(&estimate),
        note: sentence(&format!("{why}; the estimate is that from contacts of any palms")),
        evidence: evidence(&estimate, &options, bounds_at),
        log,
        estimate,
        curves,
        truth,
        bounds: bounds.as_ref().map(|bounds| bounds.drawn.clone()),
        warnings,
    };
    Ok(AnyPalms { data, bounds })
}

/// What the estimator is told: as the scene states it, and the noise that it does not state from the roughness of the readings.
fn options(log: &ContactLog, scene: &Scene) -> Result<ContactOptions, CliError> {
    let sensors = &scene.sensors;
    let length = scene.size.or_else(|| size(log)).ok_or(CliError::SizeNotStated)?;
    let floor = sensors.contact_speed_std.unwrap_or(FLOOR * (scene.gravity * length).sqrt());
    let rough = ContactNoiseLevel::by_roughness(log, floor);
    let stated = |fixed: Option<f64>, share: Option<f64>| {
        fixed.or(share).map(|_| [fixed, share].map(Option::unwrap_or_default))
    };
    let [force_fixed, force_share] =
        stated(sensors.force_std, sensors.force_share).unwrap_or([rough.force_fixed, rough.force_share]);
    // Impulses beside forces are read where their noise is stated.
    let alone = !log.palms().iter().all(by_force);
    let impulse = stated(sensors.impulse_std, sensors.impulse_share)
        .map(|[fixed, share]| ImpulseNoise { fixed, share })
        .or(rough.impulse.filter(|_| alone));
    let contact = sensors.contact_std.unwrap_or(rough.contact);
    let noise = ContactNoiseLevel { contact, force_fixed, force_share, impulse, floor };
    Ok(ContactOptions { size: scene.size, pose_errors: true, ..ContactOptions::new(noise, scene.gravity) })
}

/// Whether the force of a palm is measured as far as there is any.
fn by_force(palm: &LoggedPalm) -> bool {
    match palm.force_axes() {
        Some(SensedAxes::Three) => true,
        Some(SensedAxes::Normal) => palm.friction() == Some(0.0),
        None => false,
    }
}

/// Root mean square of the distance of contacts from the mean of those at the same time, m: about the size of the object. None
/// where no two are touched at once.
fn size(log: &ContactLog) -> Option<f64> {
    let (mut squares, mut count) = (0.0, 0.0);
    for k in 0..log.times().len() {
        let contacts: Vec<DVec3> = log.palms().iter().filter_map(|palm| Some(palm.touch(k)?.p_WC)).collect();
        if contacts.len() > 1 {
            let mean = contacts.iter().sum::<DVec3>() / contacts.len() as f64;
            squares += contacts.iter().map(|c| c.distance_squared(mean)).sum::<f64>();
            count += contacts.len() as f64;
        }
    }
    (squares > 0.0).then(|| f64::sqrt(squares / count))
}

/// Where a palm touches the object, at the samples that are relied on.
fn curve(palm: &LoggedPalm, estimate: &ContactEstimate) -> Vec<Option<PalmContact>> {
    let contact = |(k, state): (usize, &recon::object_dynamics::BodyState)| {
        let touch = palm.touch(k).filter(|_| estimate.relied_on[k])?;
        let turn = state.R_WO.inverse();
        let (p_OC, normal) = (turn * (touch.p_WC - state.p_WCm), turn * -touch.n.get());
        Some(PalmContact { p_WC: touch.p_WC, p_OC, normal, radius: p_OC.dot(normal) })
    };
    estimate.states.iter().enumerate().map(contact).collect()
}

/// What to say where the motion is relied on at some samples only.
fn not_relied_on(estimate: &ContactEstimate) -> Option<String> {
    let (all, doubtful) = (estimate.relied_on.len(), estimate.relied_on.iter().filter(|r| !**r).count());
    (estimate.reliability.is_reliable() && doubtful > 0).then(|| {
        format!(
            "At {doubtful} of {all} samples the motion is not relied on (relied_on in motion.csv is 0): noise does not explain what is \
             left there, or the deviations are too large for what they are made from."
        )
    })
}

/// What to say of impulses in the log that count for nothing.
fn impulses_not_read(log: &ContactLog, options: &ContactOptions) -> Option<String> {
    let measured = log.palms().iter().any(|palm| palm.impulse_axes() == Some(SensedAxes::Three));
    (measured && options.noise.impulse.is_none()).then(|| {
        "The log has impulses, which are not used: the scene does not state their noise ([sensors]: impulse_std or impulse_share). What \
         happens between samples is taken from the forces at them, which miss blows."
            .to_owned()
    })
}
