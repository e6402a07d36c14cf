use super::bounds::{BoundsResult, contradiction};
use super::evidence::{Checks, evidence, verdict};
use super::export::{Object, deviations};
use super::simulate::known_body;
use super::sound::motion_bounds;
use super::truth::{true_motion, true_shape};
use crate::error::CliError;
use crate::progress::Progress;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::{MassProperties, SensorLog};
use recon::observer::{
    EstimateError, IdentifiedBody, KnownBody, MotionEstimate, NoiseLevel, TrackError, UnknownBody,
    estimate_body, estimate_motion, nearest_turn,
};
use recon::shape_bounds::ContactSample;
use recon_io::{
    Level, MotionState, PalmContact, PalmTrack, ReportData, Scene, TriangleMesh, implausibilities,
};

/// Contact noise above this share of the object's size is worth a warning beside the bounds.
pub(crate) const NOTABLE_NOISE: f64 = 1e-6;

/// Samples of longer logs are taken together, where that loses nothing.
const MOST_SAMPLES: usize = 200_000;

/// Confidence of bounds from noisy contacts.
pub(super) const CONFIDENCE: f64 = 0.95;

/// Everything that was reconstructed from a log.
pub(crate) struct Reconstruction {
    pub(crate) data: ReportData,
    /// Surface of the lower bound from all contacts.
    pub(crate) lower: Option<TriangleMesh>,
    /// Surface of the upper bound from all contacts.
    pub(crate) upper: Option<TriangleMesh>,
    /// How far the lower one stands out of it, m.
    pub(crate) stands_out: f64,
    /// Mass and inertia in the body axes of the estimate.
    pub(crate) mass: MassProperties,
    /// The same with deviations where they were estimated.
    pub(crate) identified: Option<IdentifiedBody>,
    /// All contacts, body axes.
    pub(crate) contacts: Vec<ContactSample>,
    /// Noise of the contact positions, m.
    pub(crate) contact_noise: f64,
}

impl Reconstruction {
    /// The object for simulators.
    pub(crate) fn object(&self) -> Object<'_> {
        Object {
            title: &self.data.title,
            verdict: &self.data.verdict.text,
            mass: self.mass,
            deviations: self.identified.as_ref().map(deviations),
            lower: self.lower.as_ref(),
            upper: self.upper.as_ref(),
            contacts: self.contacts.clone(),
            contact_noise: self.contact_noise,
            start: self.data.motion.first().copied(),
        }
    }

    /// Whether the result may be relied on.
    pub(crate) fn is_reliable(&self) -> bool {
        self.data.verdict.level == Level::Good
    }
}

/// Motion, contact curves and bounds from a log. Truth in the log is only compared with, never used.
pub(crate) fn reconstruct(
    log: SensorLog,
    scene: &Scene,
    title: &str,
    (identify, together): (bool, usize),
    progress: &Progress,
) -> Result<Reconstruction, CliError> {
    let known = if identify { None } else { Some(known_body(scene)?) };
    let odd = implausibilities(&log, scene);
    let mut warnings: Vec<String> = odd.iter().map(|w| sentence(&w.to_string())).collect();
    progress.begin("estimating the motion")?;
    let (log, truth) = log.split_truth();
    let (mass, identified, mut estimate) =
        estimated(&log, scene, known, noise(scene, together)).map_err(|error| {
            match (error, odd.first()) {
                (CliError::Estimate(source), Some(odd)) => CliError::OddLog { odd: odd.to_string(), source },
                (error, _) => error,
            }
        })?;
    let used = estimate.motion.len();
    warnings.extend(contact_loss(&log, used));
    let palms = tracks(&log, &estimate)?;
    // Of long logs there is no room for what is not needed any more.
    drop(log);
    progress.begin("bounding the shape")?;
    let contacts = samples(&palms);
    let size = size(&palms);
    let bounded = bounds_of(&estimate)?;
    (estimate.curves, estimate.radii) = Default::default();
    if bounded.is_none() {
        warnings.push(
            "There are no bounds on the shape: how far the contacts are off is not known under a motion that is not to be relied on."
                .to_owned(),
        );
    }
    let noise = estimate.evidence.noise.contact;
    if bounded.is_some() && noise > NOTABLE_NOISE * size {
        warnings.push(margins(noise));
    }
    // Contacts that cannot even be compared contradict each other: the verdict on the motion says so.
    let stands_out = bounded.as_ref().map_or(0.0, |b| b.contradiction);
    let contradiction = contradiction(&contacts).unwrap_or(f64::NAN);
    let (drawn, lower, upper) = match bounded {
        Some(BoundsResult { drawn, lower, upper, warnings: of_bounds, .. }) => {
            warnings.extend(of_bounds);
            (Some(drawn), lower, upper)
        }
        None => (None, None, None),
    };
    let bounds_at = drawn.is_some().then_some(CONFIDENCE);
    let checks =
        Checks { implausible: !odd.is_empty(), contradiction, size, identified, bounds_at, together };
    let axes = truth.as_ref().map_or(DQuat::IDENTITY, |truth| match identified {
        None => nearest_turn(&mass, truth[0].R_WO, estimate.start.R_WO),
        // Axes that were found need not be those of the truth: turns are compared from the first sample on.
        Some(_) => truth[0].R_WO.inverse() * estimate.start.R_WO,
    });
    let shape = match (&scene.simulation, &truth) {
        (Some(simulation), Some(_)) => Some(true_shape(simulation, axes)?),
        _ => None,
    };
    let data = ReportData {
        title: title.to_owned(),
        verdict: verdict(&estimate, &checks),
        times: estimate.motion.iter().map(|m| m.t).collect(),
        palms,
        motion: estimate.motion.iter().map(state).collect(),
        truth: truth.map(|truth| true_motion(&truth[..used], axes)),
        bounds: drawn,
        true_shape: shape,
        evidence: evidence(&estimate, &checks),
        warnings,
    };
    let contact_noise = estimate.evidence.noise.contact;
    Ok(Reconstruction { data, lower, upper, stands_out, mass, identified, contacts, contact_noise })
}

/// What to say of bounds from noisy contacts.
pub(super) fn margins(noise: f64) -> String {
    format!(
        "Contacts are noisy by {noise:.1e} m: the bounds have margins with which they hold at {:.0} % confidence.",
        100.0 * CONFIDENCE
    )
}

/// Body and motion; the body with its deviations where it is not known.
fn estimated(
    log: &SensorLog,
    scene: &Scene,
    known: Option<MassProperties>,
    noise: Option<NoiseLevel>,
) -> Result<(MassProperties, Option<IdentifiedBody>, MotionEstimate), CliError> {
    let gravity = DVec3::new(0.0, 0.0, -scene.gravity);
    let palm_inertias = scene.palm_inertia;
    Ok(match known {
        Some(mass) => (mass, None, estimate_motion(log, &KnownBody { mass, gravity, palm_inertias, noise })?),
        None => {
            let found = estimate_body(log, &UnknownBody { gravity, palm_inertias, noise })?;
            (found.body.mass, Some(found.body), found.motion)
        }
    })
}

/// The log, or of a long one the means of so many samples.
pub(crate) fn condensed(log: SensorLog) -> (SensorLog, usize) {
    // Odd, so that the truth of the middle one is that of the mean's time.
    let together = log.samples().len().div_ceil(MOST_SAMPLES) | 1;
    match (together > 1).then(|| log.condensed(together)).flatten() {
        Some(means) => (means, together),
        None => (log, 1),
    }
}

/// The noise of means of so many samples, where it is stated.
fn noise(scene: &Scene, together: usize) -> Option<NoiseLevel> {
    let mean = 1.0 / (together as f64).sqrt();
    Some(NoiseLevel { contact: mean * scene.sensors.contact_std?, force: mean * scene.sensors.force_std? })
}

fn state(m: &recon::observer::MotionState) -> MotionState {
    MotionState { p_WCm: m.p_WCm, R_WO: m.R_WO, v_WCm: m.v_WCm, w_WO: m.w_WO }
}

/// Frames and contacts of each palm over the samples that were used.
fn tracks(log: &SensorLog, estimate: &MotionEstimate) -> Result<[PalmTrack; 3], CliError> {
    let mut palms = [PalmTrack::default(), PalmTrack::default(), PalmTrack::default()];
    for (i, palm) in palms.iter_mut().enumerate() {
        let curve = estimate.curves[i].points();
        for (k, point) in curve.iter().enumerate() {
            let reading = &log.samples()[k].palms[i];
            let frame = PalmFrame::from_normal(reading.normal).map_err(|source| {
                CliError::Estimate(EstimateError::Track(TrackError::Palm { palm: i + 1, t: point.t, source }))
            })?;
            palm.frames.push(frame);
            palm.contacts.push(reading.contact.map(|s| PalmContact {
                p_WC: frame.contact_from_sensor(s),
                p_OC: point.beta_O,
                normal: point.n_O.get(),
                radius: estimate.radii[k][i],
            }));
        }
    }
    Ok(palms)
}

fn samples(palms: &[PalmTrack; 3]) -> Vec<ContactSample> {
    let contacts = palms.iter().flat_map(|p| p.contacts.iter().flatten());
    contacts.map(|c| ContactSample { point: c.p_OC, normal: Direction::new_unchecked(c.normal) }).collect()
}

/// What to say when the log goes on after a palm lost contact.
fn contact_loss(log: &SensorLog, used: usize) -> Option<String> {
    let (sample, palm) = log.first_contact_loss()?;
    Some(format!(
        "Palm {} lost contact at t = {} s. The {used} samples before it are used, the {} from there on are not.",
        palm + 1,
        log.samples()[sample].t,
        log.samples().len() - used
    ))
}

/// Largest distance of a contact from the centre of mass, m.
fn size(palms: &[PalmTrack; 3]) -> f64 {
    let contacts = palms.iter().flat_map(|p| p.contacts.iter().flatten());
    contacts.map(|c| c.p_OC.length()).fold(0.0, f64::max)
}

/// Bounds that hold at [`CONFIDENCE`] for all that is known to be uncertain. None under a motion that is not to be relied on: then
/// it is not known how far contacts are off.
fn bounds_of(estimate: &MotionEstimate) -> Result<Option<BoundsResult>, CliError> {
    if !estimate.reliability.is_reliable() {
        return Ok(None);
    }
    motion_bounds(estimate, CONFIDENCE)
}

/// A message as a sentence of its own.
pub(crate) fn sentence(text: &str) -> String {
    let mut letters = text.chars();
    let first = letters.next().map(|c| c.to_uppercase().to_string()).unwrap_or_default();
    let end = if text.ends_with(['.', '?', ')']) { "" } else { "." };
    format!("{first}{}{end}", letters.as_str())
}
