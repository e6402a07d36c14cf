//! Motion of a body, with mass and inertia if they are unknown, from contacts of any palms.

use super::advice::Advice;
use super::any_palms_bounds::estimate_bounds;
use super::any_palms_words::{Checks, evidence, mode_doubts, touch_next, verdict};
use super::bounds::{BoundsResult, CONFIDENCE, NOTABLE_NOISE};
use super::export::Object;
use super::least_model::choice_rows;
use super::repeated::without_repeated;
use super::truth::{true_motion, true_shape};
use super::views::bounds_views;
use super::words::{margins, sentence};
use crate::error::CliError;
use crate::progress::Progress;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::Direction;
use recon::least_model::{Accuracy, Choice, least_estimate, one_of};
use recon::object_dynamics::{ContactLog, LoggedPalm, MassProperties, NotThreePlanes, SensedAxes, TrueState};
use recon::observer::contacts::{
    ContactEstimate, ContactEstimateError, ContactNoiseLevel, ContactOptions, ImpulseNoise, estimate_contacts,
};
use recon::observer::rigid::nearest_turn;
use recon::shape_bounds::ContactSample;
use recon_io::{
    EstimateData, INERTIA_LEARNED, Implausibility, Level, MassDeviations, PalmContact, Scene, Sensors,
};
use std::error::Error;
use std::path::Path;

/// What was asked for.
pub(crate) struct AnyPalmsRequest<'a> {
    pub(crate) scene: &'a Scene,
    pub(crate) title: &'a str,
    /// Whether mass and inertia of the scene are not to be looked at.
    pub(crate) identify: bool,
    /// Coefficient of friction of the palms that do not state one, if it is known.
    pub(crate) friction: Option<f64>,
    /// How near the motion is wanted, where the least model is to be chosen by that.
    pub(crate) accuracy: Option<Accuracy>,
    /// Whether covariances of all poses are wanted.
    pub(crate) covariances: bool,
    /// Samples of the log that were taken as one.
    pub(crate) together: usize,
    /// Why it is this estimate, in one sentence.
    pub(crate) note: String,
    /// What the reader must know beforehand.
    pub(crate) warnings: Vec<String>,
    /// Whether something in the log does not go with the scene.
    pub(crate) implausible: bool,
}

impl<'a> AnyPalmsRequest<'a> {
    pub(crate) fn new(scene: &'a Scene, title: &'a str, identify: bool) -> Self {
        let (note, warnings, accuracy, friction, covariances, implausible) = Default::default();
        Self {
            scene,
            title,
            identify,
            friction,
            accuracy,
            covariances,
            together: 1,
            note,
            warnings,
            implausible,
        }
    }

    /// What does not go with the scene, before all other warnings.
    pub(super) fn doubt(&mut self, odd: &[Implausibility], warnings: Vec<String>) {
        self.implausible = !odd.is_empty();
        self.warnings = odd.iter().map(|odd| sentence(&odd.to_string())).chain(warnings).collect();
    }
}

/// What contacts of any palms tell.
pub(crate) struct AnyPalms {
    pub(crate) data: EstimateData,
    /// Bounds on the shape, where there are any.
    pub(crate) bounds: Option<BoundsResult>,
    /// Noise of contacts, m.
    pub(crate) contact_noise: f64,
    /// Why it was modelled as it is, where an accuracy was wanted.
    pub(crate) choice: Option<Choice>,
}

impl AnyPalms {
    /// The object for simulators.
    ///
    /// # Errors
    /// Where the inertia is that of no body, as rounding may leave one.
    pub(crate) fn object(&self) -> Result<Object<'_>, CliError> {
        let (data, found) = (&self.data, &self.data.estimate);
        let entry = |i: usize| found.inertia_covariance[i][i].max(0.0).sqrt();
        let [xx, yy, zz, xy, xz, yz] = std::array::from_fn(entry);
        let deviations = found.axes_deviations.is_none().then(|| MassDeviations {
            mass: found.mass * found.mass_deviation,
            inertia: DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]),
        });
        let sample = |contact: &PalmContact| ContactSample {
            point: contact.p_OC,
            normal: Direction::new_unchecked(contact.normal),
        };
        Ok(Object {
            title: &data.title,
            verdict: &data.verdict.text,
            mass: MassProperties::new(found.mass, found.inertia)?,
            deviations,
            lower: self.bounds.as_ref().and_then(|bounds| bounds.lower.as_ref()),
            upper: self.bounds.as_ref().and_then(|bounds| bounds.upper.as_ref()),
            contacts: data.curves.iter().flatten().flatten().map(sample).collect(),
            contact_noise: self.contact_noise,
            start: found.states.first().map(|state| (*state).into()),
        })
    }
}

/// Refuses a log of which a palm measures too little of its force.
pub(crate) fn refuse_unfelt(log: &ContactLog, path: &Path, why: &NotThreePlanes) -> Result<(), CliError> {
    let felt = |palm: &LoggedPalm| by_force(palm) || palm.impulse_axes() == Some(SensedAxes::Three);
    let lacks = log.palms().iter().position(|palm| !felt(palm));
    let refused = |i| CliError::NotThreeAxes { path: path.to_owned(), palm: i + 1, source: why.clone() };
    lacks.map_or(Ok(()), |i| Err(refused(i)))
}

/// Everything that contacts of any palms tell. Truth in the log is only compared with, never used.
pub(crate) fn estimate_any_palms(
    log: ContactLog,
    request: AnyPalmsRequest,
    progress: &Progress,
) -> Result<AnyPalms, CliError> {
    let (log, repeated) = without_repeated(log);
    let mut options = options(&log, request.scene, request.together)?;
    options.friction = request.friction;
    options.pose_covariances = request.covariances;
    if !request.identify {
        options.body = request.scene.mass_properties().ok().flatten();
    }
    progress.step("estimating the motion");
    let (log, truth, estimate, choice) = modelled(log, &mut options, request.accuracy)?;
    let curves: Vec<_> = log.palms().iter().enumerate().map(|of| curve(of, &estimate)).collect();
    let truth = truth.filter(|truth| !truth.is_empty());
    let axes = truth.as_ref().map(|truth| {
        let (at, found) = (truth[0].R_WO, estimate.states[0].R_WO);
        // Axes of an unknown body are those of the world at the first sample, those of a known one its own but for half turns.
        options.body.as_ref().map_or(at.inverse() * found, |mass| nearest_turn(mass, at, found))
    });
    let simulated = request.scene.simulation.as_ref().zip(axes);
    let true_shape = simulated.map(|(simulation, axes)| true_shape(simulation, axes)).transpose()?;
    let truth = truth.zip(axes).map(|(truth, axes)| true_motion(&truth, axes));
    let mut warnings = request.warnings;
    warnings.extend(choice.iter().filter(|choice| !choice.is_reached).map(Choice::verdict));
    warnings.extend(repeated.iter().map(|repeated| sentence(repeated)));
    warnings.extend(not_relied_on(&estimate));
    warnings.extend(impulses_not_read(&log, &options));
    warnings.extend(misread(&log, &estimate));
    warnings.extend(misread_forces(&log, &estimate));
    warnings.extend(estimate.mode_odds.as_ref().and_then(mode_doubts));
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
    if let Some(bounds) = &bounds
        && options.noise.contact > NOTABLE_NOISE * bounds.drawn.lower.volume.cbrt()
    {
        warnings.push(margins(options.noise.contact, CONFIDENCE));
    }
    if bounds.is_none() {
        warnings
            .push("There are no bounds on the shape: at no sample the pose is known well enough.".to_owned());
    }
    let checks = Checks {
        implausible: request.implausible,
        stands_out: bounds.as_ref().filter(|bounds| bounds.contradicts()).map(|bounds| bounds.contradiction),
        bounds_at: bounds.is_some().then_some(CONFIDENCE),
        together: request.together,
    };
    let verdict = verdict(&estimate, &checks);
    let volumes =
        |bounds: &BoundsResult| Some([bounds.drawn.lower.volume, bounds.drawn.upper.as_ref()?.volume]);
    let advice = Advice {
        reliable: verdict.level == Level::Good,
        bounds: bounds.as_ref().and_then(volumes),
        identified: estimate.axes_deviations.is_none(),
        learned: estimate.inertia_deviations.iter().all(|deviation| *deviation < INERTIA_LEARNED),
        in_plane: false,
    };
    let mut evidence = evidence(&estimate, &options, &checks);
    evidence.extend(bounds.as_ref().and_then(|bounds| bounds.drawn.largest_gap).map(|gap| touch_next(&gap)));
    let marks = bounds.as_ref().and_then(BoundsResult::marks);
    let touched: Vec<DVec3> = curves.iter().flatten().flatten().map(|c| c.p_OC).collect();
    let data = EstimateData {
        title: request.title.to_owned(),
        next: advice.next().to_owned(),
        verdict,
        note: request.note,
        evidence,
        least_model: choice.iter().flat_map(choice_rows).collect(),
        log,
        estimate,
        curves,
        truth,
        true_shape,
        marks: marks.as_ref().map(|marks| marks.facts.clone()).unwrap_or_default(),
        shape: bounds
            .as_ref()
            .map(|of| bounds_views(of, &touched))
            .into_iter()
            .chain(marks.map(|of| of.panels))
            .flatten()
            .collect(),
        force_noise: [options.noise.force_fixed, options.noise.force_share],
        bounds: bounds.as_ref().map(|bounds| bounds.drawn.clone()),
        warnings,
    };
    Ok(AnyPalms { data, bounds, contact_noise: options.noise.contact, choice })
}

/// The log without its truth, its truth, and the estimate: by the least model that serves where an accuracy is wanted, which then changes the options, as
/// readings do that are noisier than stated: bounds count on their noise.
type Modelled = (ContactLog, Option<Vec<TrueState>>, ContactEstimate, Option<Choice>);

fn modelled(
    log: ContactLog,
    options: &mut ContactOptions,
    accuracy: Option<Accuracy>,
) -> Result<Modelled, CliError> {
    let refused = |log: &ContactLog, error| match error {
        ContactEstimateError::NoSize => no_size(log),
        other => CliError::ContactEstimate(other),
    };
    let Some(wanted) = accuracy else {
        let (log, truth) = log.split_truth();
        let estimate = estimate_contacts(&log, None, options).map_err(|error| refused(&log, error))?;
        options.noise = options.noise.times(estimate.evidence.rougher);
        return Ok((log, truth, estimate, None));
    };
    let least = least_estimate(&log.clone().split_truth().0, options, wanted)
        .map_err(|error| refused(&log, error))?;
    *options = least.options;
    options.noise = options.noise.times(least.estimate.evidence.rougher);
    let (log, truth) = one_of(&log, least.every)?.split_truth();
    Ok((log, truth, least.estimate, Some(least.choice)))
}

/// What the estimator is told: as the scene states it, and the noise that it does not state from the roughness of the readings.
fn options(log: &ContactLog, scene: &Scene, together: usize) -> Result<ContactOptions, CliError> {
    let sensors = &scene.sensors;
    let floor =
        ContactNoiseLevel::floor_of_log(log, scene.gravity, scene.size).ok_or_else(|| no_size(log))?;
    let floor = sensors.contact_speed_std.unwrap_or(floor);
    // Impulses beside forces are read where their noise is stated.
    let has_impulses = |palm: &LoggedPalm| (0..log.times().len()).any(|k| palm.impulse(k).is_some());
    let alone = !log.palms().iter().all(by_force) && log.palms().iter().any(has_impulses);
    let stated =
        !alone && sensors.contact_std.is_some() && sensors.force_std.or(sensors.force_share).is_some();
    let rough = if stated {
        ContactNoiseLevel { contact: 0.0, force_fixed: 0.0, force_share: 0.0, impulse: None, floor }
    } else {
        let rough = ContactNoiseLevel::by_roughness(log, floor, false);
        ContactNoiseLevel { impulse: rough.impulse.filter(|_| alone), ..rough }
    };
    // Of means the noise is that of their samples over the root of how many there are.
    let noise = as_stated(sensors, rough, 1.0 / (together as f64).sqrt());
    let (pose_errors, suspects, mode_odds) = (true, true, true);
    let guessed_floor = sensors.contact_speed_std.is_none();
    Ok(ContactOptions {
        size: scene.size,
        pose_errors,
        suspects,
        mode_odds,
        guessed_floor,
        ..ContactOptions::new(noise, scene.gravity)
    })
}

/// Why contacts tell no size: on palms whose normals lead the wrong way they lie as on a body that is turned inside out.
fn no_size(log: &ContactLog) -> CliError {
    let along_normals = |palm: &&LoggedPalm| palm.force_axes() == Some(SensedAxes::Normal);
    let upwards = |k| {
        let forces = log.palms().iter().filter(along_normals).filter_map(|palm| palm.force(k));
        forces.map(|force| force.vector.z).sum::<f64>()
    };
    let mean = (0..log.times().len()).map(upwards).sum::<f64>() / log.times().len() as f64;
    if mean < 0.0 { CliError::NormalsTurned { downwards: -mean } } else { CliError::SizeNotStated }
}

/// The noise that the sensors are stated to have, times `mean`, and what is not stated by the roughness of the readings.
pub(super) fn as_stated(sensors: &Sensors, rough: ContactNoiseLevel, mean: f64) -> ContactNoiseLevel {
    let stated = |fixed: Option<f64>, share: Option<f64>| {
        fixed.or(share).map(|_| [fixed, share].map(|of| mean * of.unwrap_or_default()))
    };
    let [force_fixed, force_share] =
        stated(sensors.force_std, sensors.force_share).unwrap_or([rough.force_fixed, rough.force_share]);
    let impulse = stated(sensors.impulse_std, sensors.impulse_share)
        .map(|[fixed, share]| ImpulseNoise { fixed, share })
        .or(rough.impulse);
    let contact = sensors.contact_std.map_or(rough.contact, |stated| mean * stated);
    ContactNoiseLevel { contact, force_fixed, force_share, impulse, ..rough }
}

/// What conditions are off by beside noise, m/s, of a body of the size `length`, m: as the scene states it.
pub(crate) fn condition_floor(scene: &Scene, length: f64) -> f64 {
    let guessed = || ContactNoiseLevel::guessed_floor(scene.gravity, length);
    scene.sensors.contact_speed_std.unwrap_or_else(guessed)
}

/// Root mean square of the distance of points from their mean, m; 0 of none.
pub(crate) fn spread(points: impl Iterator<Item = DVec3> + Clone) -> f64 {
    let count = points.clone().count().max(1) as f64;
    let mean = points.clone().sum::<DVec3>() / count;
    (points.map(|p| p.distance_squared(mean)).sum::<f64>() / count).sqrt()
}

/// Whether the force of a palm is measured as far as there is any.
fn by_force(palm: &LoggedPalm) -> bool {
    match palm.force_axes() {
        Some(SensedAxes::Three) => true,
        Some(SensedAxes::Normal) => palm.friction() == Some(0.0),
        None => false,
    }
}

/// Where a palm touches the object, at the samples that are relied on and where it was not misread.
fn curve((i, palm): (usize, &LoggedPalm), estimate: &ContactEstimate) -> Vec<Option<PalmContact>> {
    let contact = |(k, state): (usize, &recon::object_dynamics::BodyState)| {
        let read = estimate.relied_on[k] && estimate.misread.binary_search(&(k, i)).is_err();
        let touch = palm.touch(k).filter(|_| read)?;
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

/// What to say of contacts that were misread.
fn misread(log: &ContactLog, estimate: &ContactEstimate) -> Option<String> {
    let &(sample, palm) = estimate.misread.first()?;
    Some(format!(
        "{} contacts are off by far more than noise and than those around them allow (the first at t = {} s on palm {}): they count as where \
         those around them say, and bound nothing.",
        estimate.misread.len(),
        log.times()[sample],
        palm + 1
    ))
}

/// The same of forces.
fn misread_forces(log: &ContactLog, estimate: &ContactEstimate) -> Option<String> {
    let &(sample, palm) = estimate.misread_forces.first()?;
    Some(format!(
        "{} forces are no readings: those around them are others, and no contact shows what they would do (the first at t = {} s on palm {}). They \
         count as those around them say.",
        estimate.misread_forces.len(),
        log.times()[sample],
        palm + 1
    ))
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
