//! Bounds that hold at a stated confidence: from noisy contacts, and from poses above a plane.

use super::bounds::{BoundsResult, meshes, own, unbounded};
use crate::error::CliError;
use glam::DMat3;
use recon::contact_kinematics::CurvatureRadii;
use recon::observer::MotionEstimate;
use recon::shape_bounds::{
    BodyPose, ContactNoise, ContactSample, FacetError, NoisyContact, Outlier, PoseBounds, PoseRule,
    ShapeBounds, SharpBounds, estimate_noise, without_outliers,
};
use recon_io::{Bound, Bounds};
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
    let Cleaned { kept, warning, about } = cleaned(curves, noise, confidence)?;
    let bounds = ShapeBounds::from_noisy_curves(&kept, confidence)?;
    Ok((finished(&bounds, warning)?, about))
}

/// Bounds of a convex body with radii of curvature within `radii`, from exact contacts or from noisy ones at a confidence.
pub(crate) fn sharp_bounds(
    curves: &[Vec<ContactSample>],
    radii: CurvatureRadii,
    noise: Option<(Noise, f64)>,
) -> Result<(BoundsResult, Value), CliError> {
    let (bounds, warning, mut about) = match noise {
        Some((noise, confidence)) => {
            let Cleaned { kept, warning, about } = cleaned(curves, noise, confidence)?;
            (SharpBounds::from_noisy_curves(&kept, radii, confidence)?, warning, about)
        }
        None => (SharpBounds::from_contacts(&curves.concat(), radii)?, None, json!({ "noise": "none" })),
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
        largest_gap: polytopes.largest_gap().map(|gap| gap.distance),
    };
    let warnings = warning.into_iter().collect();
    Ok((BoundsResult { drawn, lower, upper, others: Vec::new(), contradiction: 0.0, warnings }, about))
}

/// Bounds of the body of a motion estimate, from the uncertainty of its contact curves.
pub(crate) fn curve_bounds(estimate: &MotionEstimate, confidence: f64) -> Result<BoundsResult, CliError> {
    let mut curves = [const { Vec::new() }; 3];
    let times: Vec<f64> = estimate.motion.iter().map(|m| m.t).collect();
    for known in &estimate.uncertainty {
        let k = times.partition_point(|t| *t < known.t).min(times.len() - 1);
        for (i, curve) in curves.iter_mut().enumerate() {
            let Some(point) = estimate.curves[i].points().get(k) else { continue };
            // Errors of the motion are alike along a curve: nothing is gained on them by averaging.
            let noise = ContactNoise {
                point: DMat3::ZERO,
                normal: 0.0,
                pose_translation: largest_deviation(known.points[i]),
                pose_rotation: largest_deviation(known.normals[i]),
            };
            curve.push(NoisyContact {
                contact: ContactSample { point: point.beta_O, normal: point.n_O },
                noise,
            });
        }
    }
    let bounds = ShapeBounds::from_noisy_curves(&curves, confidence)?;
    finished(&bounds, None)
}

/// No less than the largest standard deviation along any direction: a symmetric matrix has no eigenvalue above its largest
/// sum of absolute values in a row.
fn largest_deviation(m: DMat3) -> f64 {
    let rows = [m.x_axis, m.y_axis, m.z_axis].map(|row| row.abs().element_sum());
    rows.into_iter().fold(0.0, f64::max).sqrt()
}

/// Meshes and figures of bounds.
fn finished(bounds: &ShapeBounds, warning: Option<String>) -> Result<BoundsResult, CliError> {
    let (lower, upper) = meshes(bounds)?;
    let drawn = Bounds {
        lower: Bound { mesh: lower.clone().unwrap_or_default(), volume: bounds.lower_volume() },
        upper: upper.clone().map(|mesh| Bound { mesh, volume: bounds.upper_volume() }),
        largest_gap: bounds.largest_gap().map(|gap| gap.distance),
    };
    let warnings = warning.into_iter().chain(unbounded(bounds)).collect();
    Ok(BoundsResult { drawn, lower, upper, others: Vec::new(), contradiction: 0.0, warnings })
}

/// Contacts with their noise, without outliers.
pub(super) struct Cleaned {
    pub(super) kept: Vec<Vec<NoisyContact>>,
    warning: Option<String>,
    about: Value,
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
    let (kept, outliers) = without_outliers(&noisy, confidence)?;
    let levels: Vec<Value> = noisy.iter().filter_map(|curve| curve.first()).map(level).collect();
    let about = json!({ "confidence": confidence, "noise": { how: levels }, "outliers": listed(&outliers) });
    Ok(Cleaned { kept, warning: left_out(&outliers), about })
}

/// Outliers, counted from 1.
pub(super) fn listed(outliers: &[Outlier]) -> Value {
    let one =
        |o: &Outlier| json!({ "curve": o.curve + 1, "contact": o.index + 1, "deviations": o.deviations });
    outliers.iter().map(one).collect()
}

pub(super) fn left_out(outliers: &[Outlier]) -> Option<String> {
    let name = |o: &Outlier| {
        format!("contact {} of curve {} ({:.0} deviations)", o.index + 1, o.curve + 1, o.deviations)
    };
    let named: Vec<String> = outliers.iter().take(NAMED).map(name).collect();
    let more = if outliers.len() > NAMED { ", and others" } else { "" };
    (!outliers.is_empty()).then(|| {
        format!(
            "{} contact(s) cannot be right beside the others and are left out: {}{more}.",
            outliers.len(),
            named.join(", ")
        )
    })
}

/// Standard deviations of a contact across and along the surface and of its normal.
fn level(c: &NoisyContact) -> Value {
    let n = c.contact.normal.get();
    let along = n.any_orthonormal_vector();
    json!({
        "across_m": n.dot(c.noise.point * n).max(0.0).sqrt(),
        "along_m": along.dot(c.noise.point * along).max(0.0).sqrt(),
        "normal_rad": c.noise.normal,
    })
}

/// Bounds of a convex body from `runs` of poses above the plane at `height` (m), and what is to be said about them.
pub(crate) fn pose_bounds(
    runs: &[Vec<BodyPose>],
    height: f64,
    confidence: f64,
    rule: &PoseRule,
) -> Result<(BoundsResult, Value), CliError> {
    let made = PoseBounds::by_rule(runs, height, confidence, rule)?;
    let solid = made.lower.as_ref().and_then(|lower| lower.solid());
    let lower = solid.map(|s| own(s.mesh())).transpose()?;
    let upper = own(made.upper.mesh())?;
    let mut warnings = Vec::new();
    if lower.is_none() {
        warnings.push(format!(
            "The poses need a margin of {:.3} m to agree with each other, which leaves no lower bound: is the height of the plane right?",
            made.margin
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
    let about = json!({
        "confidence": confidence,
        "plane_height_m": height,
        "margin_m": made.margin,
        "touching_poses": made.touching,
        "outliers": made.outliers.iter().map(|(run, frame)| json!({ "run": run + 1, "frame": frame + 1 })).collect::<Vec<_>>(),
    });
    let drawn = Bounds {
        lower: Bound { mesh: lower.clone().unwrap_or_default(), volume: solid.map_or(0.0, |s| s.volume()) },
        upper: Some(Bound { mesh: upper.clone(), volume: made.upper.volume() }),
        largest_gap: made.largest_gap().map(|gap| gap.distance),
    };
    Ok((
        BoundsResult { drawn, lower, upper: Some(upper), others: Vec::new(), contradiction: 0.0, warnings },
        about,
    ))
}
