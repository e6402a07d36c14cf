//! `summary.json`: the figures of a reconstruction for programs.

use crate::report::{
    Bounds, Departure, EstimateData, Evidence, EvidenceValue, Verdict, estimated_mode_spans, level,
    mode_times,
};
use glam::DMat3;
use recon::observer::contact_modes::{ContactModesDoubt, LearnedFriction};
use recon::observer::contacts::EstimatedModes;
use recon::observer::faults::{Assumption, Constant, Explanation, Suspect};
use serde_json::{Map, Value, json};

/// What a `summary.json` is of. Its keys are those of `docs/schema/summary.schema.json`.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum SummaryOf {
    /// Motion and shape from contacts and forces, in space.
    Reconstruction,
    /// The same without forces.
    WithoutForces,
    /// Motion and outline in the plane.
    PlaneReconstruction,
    /// Outline and motion in the plane without forces.
    PlaneWithoutForces,
    /// Bounds on a shape.
    Bounds,
    /// Touches, one after the other, to a goal.
    Exploration,
    /// Motions of palms, one after the other, to a goal.
    Rolling,
    /// Strokes of one of two parallel palms, one after the other, to a goal.
    Strokes,
    /// An outline that a finger followed.
    Contour,
    /// A body that a finger came down on.
    Relief,
    /// A simulated scene.
    Simulation,
    /// An object or a scene for simulators.
    Export,
    /// Files to begin with.
    Start,
    /// Pushes by a round finger.
    Pushes,
}

impl SummaryOf {
    /// The value of the key `schema`: what it is of, and the version of its keys.
    #[must_use]
    pub fn schema(self) -> &'static str {
        match self {
            Self::Reconstruction => "reconstruction/1",
            Self::WithoutForces => "without-forces/1",
            Self::PlaneReconstruction => "plane-reconstruction/1",
            Self::PlaneWithoutForces => "plane-without-forces/1",
            Self::Bounds => "bounds/1",
            Self::Exploration => "exploration/1",
            Self::Rolling => "rolling/1",
            Self::Strokes => "strokes/1",
            Self::Contour => "contour/1",
            Self::Relief => "relief/1",
            Self::Simulation => "simulation/1",
            Self::Export => "export/1",
            Self::Start => "start/1",
            Self::Pushes => "pushes/1",
        }
    }

    /// The figures, with their schema and the version of recon.
    #[must_use]
    pub fn named(self, mut figures: Value) -> Value {
        figures["schema"] = self.schema().into();
        figures["recon"] = env!("CARGO_PKG_VERSION").into();
        figures
    }
}

/// How a fit ended, in words: `OutOfIterations` as `out of iterations`.
#[must_use]
pub fn status_in_words(status: impl std::fmt::Debug) -> String {
    let mut words = String::new();
    for letter in format!("{status:?}").chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

/// Deviation of the logarithm of the root of a second moment below which it was learned from the log.
pub const INERTIA_LEARNED: f64 = 0.5;

/// The figures of a motion that was estimated from contacts of any palms: numbers at full precision, in SI units; one that is not finite is null. Errors are over the samples that are relied on.
#[must_use]
pub fn estimate_summary(data: &EstimateData) -> Value {
    let (times, found) = (data.log.times(), &data.estimate);
    let relied = found.relied_on.iter().filter(|relied| **relied).count();
    let duration = data.log.duration();
    let palm = |i: usize| {
        let [off, slides, sticks] =
            mode_times(&estimated_mode_spans(times, &found.modes, None, i)).map(|seconds| seconds / duration);
        json!({ "palm": i + 1, "off": off, "slides": slides, "sticks": sticks })
    };
    let departures = data.departures().filter(|of| !of.is_empty());
    let departures: Option<Vec<Departure>> = departures.map(|of| of.into_iter().map(|(_, d)| d).collect());
    let mut figures = json!({
        "title": data.title,
        "method": "motion, mass and inertia from contacts of any palms",
        "status": if found.evidence.settled { "converged" } else { "not settled" },
        "verdict": verdict_figures(&data.verdict),
        "note": data.note,
        "samples": times.len(),
        "t_first_s": times.first(),
        "t_last_s": times.last(),
        "mass_kg": found.mass,
        "inertia_kg_m2": rows(&found.inertia),
        "relied_on_share": relied as f64 / times.len() as f64,
        "mode_shares": (0..data.log.palms().len()).map(palm).collect::<Vec<_>>(),
        "evidence": data.evidence.iter().map(evidence).collect::<Map<_, _>>(),
        "bounds": data.bounds.as_ref().map(bounds),
        "largest_error": departures.as_deref().map(|d| errors(d, largest_of)),
        "rms_error": departures.as_deref().map(|d| errors(d, rms_of)),
        "warnings": data.warnings,
    });
    if let Some(shape) = &data.true_shape {
        figures["true_volume_m3"] = shape.volume.into();
    }
    if !found.suspects.is_empty() {
        figures["sensor_faults"] =
            found.suspects.iter().filter(|of| of.deviation.is_finite()).map(sensor_fault).collect();
    }
    if !found.explanations.is_empty() {
        figures["explanations"] = found.explanations.iter().map(explanation).collect();
    }
    if let Some(modes) = &found.mode_odds {
        mode_figures(modes, &mut figures);
    }
    match found.axes_deviations {
        Some(of) => figures["std_axes_rad"] = json!(of.to_array()),
        None => {
            figures["std_mass_kg"] = json!(found.mass_deviation * found.mass);
            figures["std_log_second_moment_roots"] = json!(found.inertia_deviations);
            figures["inertia_learned"] = json!(found.inertia_deviations.map(|of| of < INERTIA_LEARNED));
        }
    }
    SummaryOf::Reconstruction.named(figures)
}

/// What is known of contact modes: frictions, samples of unsure modes, and what of the readings is doubted.
pub fn mode_figures(modes: &EstimatedModes, figures: &mut Value) {
    let friction = |(i, of): (usize, &Option<LearnedFriction>)| {
        let of = (*of)?;
        Some(json!({ "palm": i + 1, "coefficient": of.coefficient, "std": of.deviation }))
    };
    figures["friction"] = modes.frictions.iter().enumerate().filter_map(friction).collect();
    figures["unsure_mode_samples"] = modes.unsure().into();
    let doubt = |of: &ContactModesDoubt| json!({ "palm": of.contact + 1, "about": of.about.name(), "by": of.by, "deviations": of.score, "text": of.to_string() });
    figures["mode_doubts"] = modes.doubts.iter().map(doubt).collect();
}

/// A verdict as level and text.
#[must_use]
pub fn verdict_figures(verdict: &Verdict) -> Value {
    json!({ "level": level(verdict.level), "text": verdict.text })
}

/// What the data say of a constant that was taken as known.
#[must_use]
pub fn sensor_fault(of: &Suspect) -> Value {
    let mut said = constant(of.fault);
    said["value"] = json!(of.value);
    said["std"] = json!(of.deviation);
    said["score"] = json!(of.score());
    if of.tolerated.is_finite() {
        said["moves_motion_by_one_deviation"] = json!(of.tolerated);
        said["told_from"] = json!(of.told_from());
    }
    said
}

/// One thing that may be wrong of what was taken as known, as `summary.json` has it.
#[must_use]
pub fn explanation(of: &Explanation) -> Value {
    let mut said = match of.assumption {
        Assumption::None => json!({ "constant": "none" }),
        Assumption::One(fault) => constant(fault),
        Assumption::Body => json!({ "constant": "mass_and_inertia" }),
        Assumption::Noise => json!({ "constant": "noise" }),
    };
    said["value"] = json!(of.value);
    said["std"] = json!(of.deviation);
    said["chi_squared"] = json!(of.misfit);
    said["log_odds"] = json!(of.log_odds);
    said
}

/// A constant by its name, palm and axis.
fn constant(fault: Constant) -> Value {
    let (kind, palm, axis) = match fault {
        Constant::ForceGain { palm } => ("force_gain", Some(palm), None),
        Constant::ForceBias { palm } => ("force_bias_n", Some(palm), None),
        Constant::ForceDelay => ("force_delay_s", None, None),
        Constant::ContactDelay => ("contact_delay_s", None, None),
        Constant::ContactOffset { palm, axis } => ("contact_offset_m", Some(palm), Some(axis)),
        Constant::PalmTilt { palm, axis } => ("palm_tilt_rad", Some(palm), Some(axis)),
        Constant::Friction => ("friction", None, None),
        Constant::Mass => ("mass", None, None),
        Constant::Moment { axis } => {
            let which = ["smallest", "middle", "largest"][axis.min(2)];
            return json!({ "constant": "moment", "moment": which });
        }
    };
    let mut said = json!({ "constant": kind });
    if let Some(palm) = palm {
        said["palm"] = json!(palm);
    }
    if let Some(axis) = axis {
        said["axis"] = json!(["x", "y"][axis.min(1)]);
    }
    said
}

fn rows(m: &DMat3) -> [[f64; 3]; 3] {
    m.transpose().to_cols_array_2d()
}

fn largest_of(values: &mut dyn Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

fn rms_of(values: &mut dyn Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), v| (sum + v * v, count + 1.0));
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}

/// Errors of a motion, all samples taken together by `of`.
fn errors(departures: &[Departure], of: fn(&mut dyn Iterator<Item = f64>) -> f64) -> Value {
    let one = |value: fn(&Departure) -> f64| of(&mut departures.iter().map(value));
    json!({
        "position_m": one(|d| d.position),
        "orientation_rad": one(|d| d.angle),
        "velocity_m_per_s": one(|d| d.velocity),
        "angular_velocity_rad_per_s": one(|d| d.angular_velocity),
    })
}

fn evidence(row: &Evidence) -> (String, Value) {
    let value = match &row.value {
        EvidenceValue::Number(v) => json!(v),
        EvidenceValue::Count(n) => json!(n),
        EvidenceValue::Text(text) => json!(text),
    };
    (row.key.clone(), json!({ "value": value, "unit": row.unit, "level": level(row.level) }))
}

fn bounds(bounds: &Bounds) -> Value {
    let (lower, upper) = (bounds.lower.volume, bounds.upper.as_ref().map(|u| u.volume));
    json!({
        "lower_volume_m3": lower,
        "upper_volume_m3": upper,
        "lower_over_upper": upper.map(|u| lower / u),
        "largest_gap_m": bounds.largest_gap.map(|gap| gap.distance),
    })
}
