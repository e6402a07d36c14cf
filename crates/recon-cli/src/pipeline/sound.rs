//! Bounds that hold at a stated confidence: from noisy contacts, and from poses above a plane.

use super::bounds::{BoundsResult, drawn_surfaces, meshes, own};
use super::doubts::Doubts;
use super::features::FoundFeatures;
use crate::error::CliError;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{CurvatureRadii, at_once};
use recon::observer::rigid::{PoseCovariance, PoseErrors};
use recon::shape_bounds::curvature::SharpBounds;
use recon::shape_bounds::features::{FeatureOptions, Features, Pieces};
use recon::shape_bounds::noise::{
    CertainBounds, ContactNoise, NoisyContact, Outlier, PoseNoise, correlated_noise, estimate_noise,
    independence_is_tested, with_noise_as_found, without_outliers,
};
use recon::shape_bounds::poses::{BodyPose, ContradictingRun, PlaneHeight, PoseBounds, PoseRule};
use recon::shape_bounds::{ContactSample, FacetError};
use recon_io::{Bound, Bounds, brief_to};
use serde_json::{Value, json};

/// Outliers that are named one by one; the rest is counted.
const NAMED: usize = 5;
/// How far meshes of curved bounds may be from them, as a share of the size.
const MESH_TOLERANCE: f64 = 1e-3;

/// Where the noise of contacts is known from.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Noise {
    /// Standard deviations of points (m) and normals (rad).
    Stated { point: f64, normal: f64 },
    /// The curves themselves.
    Estimated,
}

/// Bounds of a convex body from `curves` of noisy contacts, and what is to be said about them.
pub(crate) fn noisy_bounds(
    curves: &[Vec<ContactSample>],
    noise: Noise,
    confidence: f64,
) -> Result<(BoundsResult, Value), CliError> {
    let Cleaned { kept, warnings, mut about, correlated, features } = cleaned(curves, noise, confidence)?;
    let bounds = if correlated {
        CertainBounds::from_correlated_curves(&kept, confidence)?
    } else {
        CertainBounds::from_features(&kept, &FeatureOptions::default(), confidence)?
    };
    let made = finished(&bounds, warnings)?.with_features(features)?;
    if let Some(features) = &made.features {
        about["features"] = features.figures();
    }
    Ok((made, about))
}

/// Bounds of a convex body with radii of curvature within `radii`, from exact contacts or from noisy ones at a confidence.
pub(crate) fn sharp_bounds(
    curves: &[Vec<ContactSample>],
    radii: CurvatureRadii,
    noise: Option<(Noise, f64)>,
) -> Result<(BoundsResult, Value), CliError> {
    let (bounds, warnings, mut about) = match noise {
        Some((noise, confidence)) => {
            let Cleaned { kept, warnings, about, correlated, .. } = cleaned(curves, noise, confidence)?;
            // Each in a curve of its own: nothing is gained by means then.
            let single = || kept.iter().flatten().map(|c| vec![*c]).collect::<Vec<_>>();
            let kept = if correlated { single() } else { kept };
            (SharpBounds::from_noisy_curves(&kept, radii, confidence)?, warnings, about)
        }
        None => {
            (SharpBounds::from_contacts(&curves.concat(), radii)?, Vec::new(), json!({ "noise": "none" }))
        }
    };
    let size = bounds.upper().volume().cbrt();
    let mut tolerance = MESH_TOLERANCE * size;
    // Bounds that are curved too strongly for meshes this fine get coarser ones.
    let polytopes = loop {
        match bounds.polytopes(tolerance) {
            Err(FacetError::TooFine { gap, .. }) if gap < size => tolerance = gap.max(2.0 * tolerance),
            other => break other?,
        }
    };
    about["radii_of_curvature_m"] = json!([radii.min, radii.max]);
    about["mesh_tolerance_m"] = json!(tolerance);
    let (lower, upper) = meshes(&polytopes)?;
    let drawn = Bounds {
        lower: Bound { mesh: lower.clone().unwrap_or_default(), volume: bounds.lower().volume() },
        upper: upper.clone().map(|mesh| Bound { mesh, volume: bounds.upper().volume() }),
        largest_gap: polytopes.largest_gap(),
    };
    Ok((
        BoundsResult {
            drawn,
            lower,
            upper,
            others: Vec::new(),
            features: None,
            contradiction: 0.0,
            warnings,
        }
        .compared(),
        about,
    ))
}

/// A contact that an estimated pose of the body, that of a `sample`, brought into its axes.
pub(super) struct PosedContact {
    pub(super) sample: usize,
    pub(super) contact: ContactSample,
    /// Covariance of the point beside that of the pose, m^2.
    pub(super) point: DMat3,
    /// Deviation of the normal beside that of the pose, rad.
    pub(super) normal: f64,
}

/// Bounds that hold at `confidence` for the noise of such contacts and the errors of the poses. None where these are known at no odds.
pub(super) fn bounds_of_poses(
    errors: &PoseErrors,
    curves: &[Vec<PosedContact>],
    confidence: f64,
) -> Result<Option<BoundsResult>, CliError> {
    let alpha = 1.0 - confidence;
    let deviations = errors.deviations(1.0 - SHARE_OF_POSES * alpha);
    if !deviations.is_finite() {
        return Ok(None);
    }
    let noisy = |of: &PosedContact| {
        let PoseCovariance { rotation, translation, cross } = errors.covariance(of.sample);
        let pose = PoseNoise { rotation, translation, cross };
        NoisyContact { contact: of.contact, noise: ContactNoise { point: of.point, normal: of.normal, pose } }
    };
    let noisy_curves: Vec<Vec<_>> = curves.iter().map(|curve| curve.iter().map(noisy).collect()).collect();
    let left = 1.0 - (1.0 - SHARE_OF_POSES) * alpha;
    let options = FeatureOptions::default();
    let (features, bounds) = at_once(
        || Features::find(&noisy_curves, &options),
        || CertainBounds::from_features_of_poses(&noisy_curves, &options, left, deviations),
    );
    let (features, bounds) = (features?, bounds?);
    let numbers = curves.iter().map(|curve| curve.iter().map(|of| of.sample + 1).collect()).collect();
    let features = FoundFeatures::new(features, &noisy_curves, numbers, options.odds);
    finished(&bounds, Vec::new())?.with_features(features).map(Some)
}

/// Covariance of a contact whose palm feels where on its surface it is touched, with this variance in each tangent direction.
pub(super) fn in_tangent(contact: &ContactSample, variance: f64) -> DMat3 {
    let (a, b) = contact.normal.tangent_basis();
    let square = |t: DVec3| DMat3::from_cols(t * t.x, t * t.y, t * t.z);
    // From the tangents themselves: what is left of the identity has no better than rounding along an axis of the frame.
    (square(a) + square(b)) * variance
}

/// Share of the odds of a failure that errors of the poses may have; the contacts' own margins hardly grow when they get less.
const SHARE_OF_POSES: f64 = 0.9;

/// Meshes and figures of bounds, of which each may be missing, and what is to be said then.
fn finished(bounds: &CertainBounds, mut warnings: Vec<String>) -> Result<BoundsResult, CliError> {
    let solid = bounds.lower.as_ref().and_then(|lower| lower.solid());
    let lower = solid.map(|solid| own(solid.mesh())).transpose()?;
    let upper = bounds.upper.as_ref().map(|upper| own(upper.mesh())).transpose()?;
    let (few_lower, few_upper) = drawn_surfaces(solid, bounds.upper.as_ref())?;
    let drawn = Bounds {
        lower: Bound {
            mesh: few_lower.unwrap_or_default(),
            volume: solid.map_or(0.0, |solid| solid.volume()),
        },
        upper: few_upper.map(|mesh| Bound {
            mesh,
            volume: bounds.upper.as_ref().map_or(f64::INFINITY, |upper| upper.volume()),
        }),
        largest_gap: bounds.largest_gap(),
    };
    if lower.is_none() {
        warnings.push(
            "Nothing is certain to be inside of the object at this confidence: the lower bound is empty."
                .to_owned(),
        );
    }
    if upper.is_none() {
        warnings.push(
            "Nothing finite is certain to contain the object at this confidence: there is no upper bound."
                .to_owned(),
        );
    }
    Ok(BoundsResult { drawn, lower, upper, others: Vec::new(), features: None, contradiction: 0.0, warnings }
        .compared())
}

/// Contacts with their noise, without outliers.
pub(super) struct Cleaned {
    pub(super) kept: Vec<Vec<NoisyContact>>,
    warnings: Vec<String>,
    about: Value,
    /// Whether noise is alike from one contact to the next.
    correlated: bool,
    /// What all contacts show of corners, edges and faces.
    features: FoundFeatures,
}

pub(super) fn cleaned(
    curves: &[Vec<ContactSample>],
    noise: Noise,
    confidence: f64,
) -> Result<Cleaned, CliError> {
    let (how, noisy): (_, Vec<Vec<NoisyContact>>) = match noise {
        Noise::Stated { point, normal } => {
            let noise = ContactNoise::isotropic(point, normal);
            let with_noise = |contact: &ContactSample| NoisyContact { contact: *contact, noise };
            ("stated", curves.iter().map(|curve| curve.iter().map(with_noise).collect()).collect())
        }
        Noise::Estimated => ("estimated", estimate_noise(curves, confidence)?),
    };
    // Tests that take neighbours to lie on a smooth curve see pieces that do.
    let (features, pieces) = features_and_pieces(&noisy)?;
    let alike = (correlated_noise(&pieces.curves), independence_is_tested(&pieces.curves));
    let (found, levels) = with_noise_as_found(&pieces.curves);
    let levels = levels.into_iter().map(|doubt| pieces.doubt(doubt)).collect();
    let doubts = Doubts::new(levels, alike, noise)?;
    let (kept, outliers) = without_outliers(&found, confidence)?;
    let (noisy, kept) = (pieces.joined(found), pieces.joined(kept));
    let outliers: Vec<Outlier> = outliers.into_iter().map(|outlier| pieces.outlier(outlier)).collect();
    let levels: Vec<Value> = noisy.iter().map(|curve| largest(curve.iter().map(level))).collect();
    let mut about =
        json!({ "confidence": confidence, "noise": { how: levels }, "outliers": listed(&outliers) });
    doubts.add_to(&mut about);
    let warnings = doubts.warnings().chain(left_out(&outliers)).chain(doubts.untested()).collect();
    Ok(Cleaned { kept, warnings, about, correlated: doubts.correlated, features })
}

/// What curves show of corners, edges and faces, and the pieces in between.
fn features_and_pieces(curves: &[Vec<NoisyContact>]) -> Result<(FoundFeatures, Pieces), CliError> {
    let options = FeatureOptions::default();
    let found = Features::find(curves, &options)?;
    let pieces = Pieces::of(curves, &found);
    let numbers = curves.iter().map(|curve| (1..=curve.len()).collect()).collect();
    Ok((FoundFeatures::new(found, curves, numbers, options.odds), pieces))
}

/// Outliers, counted from 1.
pub(super) fn listed(outliers: &[Outlier]) -> Value {
    let one = |o: &Outlier| {
        let why = if o.share > 0.0 { "contradicts others" } else { "not on a smooth curve" };
        json!({ "curve": o.curve + 1, "contact": o.index + 1, "deviations": o.deviations, "why": why })
    };
    outliers.iter().map(one).collect()
}

pub(super) fn left_out(outliers: &[Outlier]) -> Option<String> {
    // One that contradicts no other contact may be an edge.
    let rough: Vec<&Outlier> = outliers.iter().filter(|o| o.share == 0.0).collect();
    let wrong: Vec<&Outlier> = outliers.iter().filter(|o| o.share > 0.0).collect();
    let named = |of: &[&Outlier]| {
        let name = |o: &&Outlier| {
            format!(
                "contact {} of curve {} ({} deviations)",
                o.index + 1,
                o.curve + 1,
                brief_to(2, o.deviations)
            )
        };
        let more = if of.len() > NAMED { ", and others" } else { "" };
        format!("{}{more}", of.iter().take(NAMED).map(name).collect::<Vec<_>>().join(", "))
    };
    let mut said = Vec::new();
    if !wrong.is_empty() {
        said.push(format!(
            "{} contact(s) cannot be right beside the others and are left out: {}.",
            wrong.len(),
            named(&wrong)
        ));
    }
    if !rough.is_empty() {
        said.push(format!(
            "{} contact(s) are not explained by a smooth curve (an edge, or an error) and are left out: {}.",
            rough.len(),
            named(&rough)
        ));
    }
    if !said.is_empty() {
        said.push(
            "Where some are wrong, others that are off by less may be unnoticed: the bounds hold if the rest is as noisy as assumed."
                .to_owned(),
        );
    }
    (!said.is_empty()).then(|| said.join(" "))
}

/// Standard deviations of a contact across and along the surface (m) and of its normal (rad).
fn level(c: &NoisyContact) -> [f64; 3] {
    let n = c.contact.normal.get();
    let along = n.any_orthonormal_vector();
    let deviation = |u: DVec3| u.dot(c.noise.point * u).max(0.0).sqrt();
    [deviation(n), deviation(along), c.noise.normal]
}

/// The largest deviations of the contacts of a curve.
pub(super) fn largest(levels: impl Iterator<Item = [f64; 3]>) -> Value {
    let [across, along, normal] =
        levels.fold([0.0; 3], |largest: [f64; 3], one| std::array::from_fn(|k| largest[k].max(one[k])));
    json!({ "across_m": across, "along_m": along, "normal_rad": normal })
}

/// What the tight rule is not good for.
const TIGHT: &str = "Margins of --tight are enough for trackers like the simulated ones and for no others: on the one real body \
that they were tried on they cut corners, by up to 1.2 mm of 105. Do not rely on this upper bound where the object must \
lie in it.";

/// Bounds of a convex body from `runs` of poses above the `plane`, and what is to be said about them.
pub(crate) fn pose_bounds(
    runs: &[Vec<BodyPose>],
    plane: PlaneHeight,
    confidence: f64,
    tight: bool,
) -> Result<(BoundsResult, Value), CliError> {
    let rule = if tight { PoseRule::tight() } else { PoseRule::default() };
    let made = PoseBounds::by_rule(runs, plane, confidence, &rule)?;
    let solid = made.lower.as_ref().and_then(|lower| lower.solid());
    let lower = solid.map(|s| own(s.mesh())).transpose()?;
    let upper = own(made.upper.mesh())?;
    let mut about = json!({
        "confidence": confidence,
        "rule": if made.propped { "runs" } else if tight { "tight" } else { "default" },
        "plane_height_m": plane.z,
        "std_plane_height_m": plane.deviation,
        "std_plane_height_of_runs_m": plane.run_deviation,
        "margin_m": made.margin,
        "touching_poses": made.touching,
        "propped": made.propped,
        "plane_seems_lower_m": made.plane_seems_lower,
        "runs_left_out": made.left_out.iter().map(contradicting).collect::<Vec<_>>(),
        "outliers": made.outliers.iter().map(|(run, frame)| json!({ "run": run + 1, "frame": frame + 1 })).collect::<Vec<_>>(),
    });
    let mut warnings = pose_warnings(&made, confidence);
    if tight && !made.propped {
        warnings.push(TIGHT.to_owned());
        about["not_good_for"] = json!(TIGHT);
    }
    let drawn = Bounds {
        lower: Bound { mesh: lower.clone().unwrap_or_default(), volume: solid.map_or(0.0, |s| s.volume()) },
        upper: Some(Bound { mesh: upper.clone(), volume: made.upper.volume() }),
        largest_gap: made.largest_gap(),
    };
    Ok((
        BoundsResult {
            drawn,
            lower,
            upper: Some(upper),
            others: Vec::new(),
            features: None,
            contradiction: 0.0,
            warnings,
        }
        .compared(),
        about,
    ))
}

fn contradicting(of: &ContradictingRun) -> Value {
    json!({ "run": of.run + 1, "contradicts_runs": of.against.iter().map(|run| run + 1).collect::<Vec<_>>() })
}

fn pose_warnings(made: &PoseBounds, confidence: f64) -> Vec<String> {
    let mut warnings = Vec::new();
    if !made.left_out.is_empty() {
        let name = |of: &ContradictingRun| format!("run {} ({} against it)", of.run + 1, of.against.len());
        let named: Vec<String> = made.left_out.iter().take(NAMED).map(name).collect();
        let more = if made.left_out.len() > NAMED { ", and others" } else { "" };
        warnings.push(format!(
            "{} run(s) contradict other runs and are left out: {}{more}.",
            made.left_out.len(),
            named.join(", ")
        ));
    }
    if made.propped {
        warnings.push(
            "Many poses that seem to touch the plane cannot: something else holds or pushes the object too. So the margin rests \
             on how far runs contradict each other, and there is no lower bound."
                .to_owned(),
        );
    } else if made.lower.is_none() {
        warnings.push(format!(
            "The poses need a margin of {} m to agree with each other, which leaves no lower bound: is the height of the plane right?",
            brief_to(3, made.margin)
        ));
    }
    if let Some(lower) = made.plane_seems_lower {
        warnings.push(format!(
            "The poses agree better with a plane about {} m lower than stated, which is more than the margins cover: is its height right? \
             What it may be off is stated by --height-deviation.",
            brief_to(2, lower)
        ));
    }
    // Frames beside an impact pass for touching, and a few of them always disagree.
    if made.outliers.len() as f64 > (1.0 - confidence) * made.touching as f64 {
        warnings.push(format!(
            "{} pose(s) that touch the plane disagree with the others by more than the margins, the first in run {}, frame {}.",
            made.outliers.len(),
            made.outliers[0].0 + 1,
            made.outliers[0].1 + 1
        ));
    }
    warnings
}
