//! The estimator's evidence in words and numbers for people.

use glam::DMat3;
use recon::observer::{IdentifiedBody, MotionEstimate, PoseAxes, PoseErrors, Reliability};
use recon_io::{Evidence, EvidenceValue, Level, Verdict};

/// Unknowns of the estimate: centre of mass, velocity, angular momentum, orientation.
const UNKNOWNS: usize = 12;
/// With mass and inertia, in axes of which the orientation at the start is a choice.
const UNKNOWNS_WITH_BODY: usize = 16;

/// Contacts that contradict each other by more than this share of the object's size are not those of a convex object
/// in the motion found.
const LARGEST_CONTRADICTION: f64 = 0.01;
/// Up to this share of its size, and this many deviations of the sensors' noise, they agree.
const AGREEMENT: (f64, f64) = (1e-6, 10.0);

/// What speaks for or against an estimate beside its own evidence.
pub(crate) struct Checks {
    /// Something in the log does not go with the scene.
    pub(crate) implausible: bool,
    /// How far contacts contradict each other, m.
    pub(crate) contradiction: f64,
    /// Size of the object, m.
    pub(crate) size: f64,
    /// Mass and inertia where they were estimated.
    pub(crate) identified: Option<IdentifiedBody>,
    /// Confidence of the bounds where there are any.
    pub(crate) bounds_at: Option<f64>,
    /// Samples of the log that were taken as one.
    pub(crate) together: usize,
}

impl Checks {
    fn unknowns(&self) -> usize {
        if self.identified.is_some() { UNKNOWNS_WITH_BODY } else { UNKNOWNS }
    }

    fn contradicts(&self) -> bool {
        // A contradiction that is not a number is one.
        self.contradiction.is_nan() || self.contradiction > LARGEST_CONTRADICTION * self.size
    }

    fn level(&self, noise: f64) -> Level {
        if self.contradicts() {
            Level::Bad
        } else if self.contradiction > AGREEMENT.0 * self.size + AGREEMENT.1 * noise {
            Level::Caution
        } else {
            Level::Good
        }
    }
}

/// Whether the estimate can be relied on, in one sentence.
pub(crate) fn verdict(estimate: &MotionEstimate, checks: &Checks) -> Verdict {
    let mut reasons: Vec<String> = match &estimate.reliability {
        Reliability::Reliable => Vec::new(),
        Reliability::Unreliable(reasons) => reasons.iter().map(ToString::to_string).collect(),
    };
    if checks.implausible {
        reasons.push("log and scene do not go together (see the warnings)".to_owned());
    }
    if checks.contradicts() {
        reasons.push(format!(
            "contacts lie up to {:.1e} m outside of what other contacts allow, so the motion is wrong or the object is \
             not convex",
            checks.contradiction
        ));
    }
    if !reasons.is_empty() {
        let text = format!("Do not rely on this result: {}.", reasons.join("; "));
        return Verdict { level: Level::Bad, text };
    }
    let text = format!(
        "The fit settled, and the log determines all {} unknowns of the motion{}; the least certain is the {}.",
        checks.unknowns(),
        if checks.identified.is_some() { ", mass and inertia" } else { "" },
        estimate.evidence.weakest
    );
    Verdict { level: Level::Good, text }
}

/// What the estimate rests on, row by row.
pub(crate) fn evidence(estimate: &MotionEstimate, checks: &Checks) -> Vec<Evidence> {
    let e = &estimate.evidence;
    let deviation = |block: usize| {
        let variance: f64 = (3 * block..3 * block + 3).map(|k| estimate.covariance[(k, k)]).sum();
        EvidenceValue::Number(variance.sqrt())
    };
    let misfit = e.residual_rms / e.noise_explains;
    let unknowns = checks.unknowns();
    let known = if e.rank == unknowns { Level::Good } else { Level::Bad };
    let misfit_level = if misfit > 3.0 { Level::Caution } else { Level::Good };
    // What is smooth but below the noise harms nobody.
    let white = if e.whiteness < 0.3 && misfit > 1.0 { Level::Caution } else { Level::Good };
    let neutral = Level::Neutral;
    let number = EvidenceValue::Number;
    let row = |key: &str, name: &str, value, unit: &str, meaning: &str, level| Evidence {
        key: key.to_owned(),
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        meaning: meaning.to_owned(),
        level,
    };
    let mut rows = vec![
        row(
            "samples",
            "Samples used",
            EvidenceValue::Count(e.samples as u64),
            "",
            "From the start of the log to its end or to the first loss of contact.",
            neutral,
        ),
        row(
            "rank",
            "Rank",
            EvidenceValue::Text(format!("{} of {unknowns}", e.rank)),
            "",
            "Combinations of the unknowns that the log determines at all.",
            known,
        ),
        row(
            "condition",
            "Condition number",
            number(e.condition),
            "",
            "How much better the best determined combination is known than the worst.",
            neutral,
        ),
        row(
            "residual_rms",
            "Residual",
            number(e.residual_rms),
            "m/s",
            "Root mean square of the speed at which contacts would part or sink in.",
            neutral,
        ),
        row(
            "misfit",
            "Residual over noise",
            number(misfit),
            "",
            "About 1 where sensor noise explains what is left; far above it, something else does.",
            misfit_level,
        ),
        row(
            "whiteness",
            "Von Neumann ratio",
            number(e.whiteness),
            "",
            "Near 1 for residuals without pattern, near 0 for smooth ones.",
            white,
        ),
        row(
            "contradiction",
            "Contradiction of contacts",
            number(checks.contradiction),
            "m",
            "How far a contact lies outside of what another allows; about zero for a convex object in the right motion.",
            checks.level(e.noise.contact),
        ),
        row(
            "std_position",
            "Uncertainty of position",
            deviation(0),
            "m",
            "Standard deviation of the centre of mass at the first sample, all axes together.",
            neutral,
        ),
        row(
            "std_velocity",
            "Uncertainty of velocity",
            deviation(1),
            "m/s",
            "Standard deviation at the first sample.",
            neutral,
        ),
        row(
            "std_orientation",
            "Uncertainty of orientation",
            deviation(3),
            "rad",
            "Standard deviation at the first sample.",
            neutral,
        ),
        row(
            "weakest",
            "Least certain",
            EvidenceValue::Text(e.weakest.to_string()),
            "",
            "The combination of unknowns that the log determines worst.",
            neutral,
        ),
        row(
            "noise_contact",
            "Noise of contact positions",
            number(e.noise.contact),
            "m",
            "From the scene, or from the roughness of the readings.",
            neutral,
        ),
        row(
            "noise_force",
            "Noise of forces",
            number(e.noise.force),
            "N",
            "From the scene, or from the roughness of the readings.",
            neutral,
        ),
        row(
            "iterations",
            "Iterations of the last fit",
            EvidenceValue::Count(e.iterations as u64),
            "",
            "Linearisations until the fit settled.",
            neutral,
        ),
    ];
    if checks.together > 1 {
        rows.push(samples_together(checks.together));
    }
    if let (Some(confidence), Some(errors)) = (checks.bounds_at, &estimate.pose_errors) {
        rows.extend(of_bounds(errors, confidence));
    }
    if let Some(body) = &checks.identified {
        let moments = body.mass.principal().moments;
        let mut add = |key: &str, name: &str, value, unit: &str, meaning: &str| {
            rows.push(row(key, name, number(value), unit, meaning, neutral));
        };
        add("mass", "Mass", body.mass.mass(), "kg", "As estimated from the log.");
        add("std_mass", "Uncertainty of the mass", body.mass_deviation, "kg", "Standard deviation.");
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let (key, title) = (format!("moment_{name}"), format!("Principal moment {name}"));
            add(&key, &title, moments[axis], "kg m^2", "As estimated from the log, about the body's axis.");
            let (key, title) = (format!("std_moment_{name}"), format!("Uncertainty of moment {name}"));
            add(&key, &title, body.moment_deviations[axis], "kg m^2", "Standard deviation.");
        }
    }
    rows
}

/// Of a log that was thinned by means.
pub(super) fn samples_together(together: usize) -> Evidence {
    Evidence {
        key: "samples_together".to_owned(),
        name: "Rows in a sample".to_owned(),
        value: EvidenceValue::Count(together as u64),
        unit: String::new(),
        meaning:
            "The log is denser than its motion needs: the means of so many rows are taken as one sample."
                .to_owned(),
        level: Level::Neutral,
    }
}

/// What bounds hold for, at which odds and in which axes.
pub(super) fn of_bounds(errors: &PoseErrors, confidence: f64) -> [Evidence; 4] {
    let shared = errors.shared();
    let deviation = |m: DMat3| (m.x_axis.x + m.y_axis.y + m.z_axis.z).max(0.0).sqrt();
    let axes = match errors.axes() {
        PoseAxes::Principal => "principal",
        PoseAxes::MeanPose => "mean pose",
    };
    let row = |key: &str, name: &str, value, unit: &str, meaning: &str| Evidence {
        key: key.to_owned(),
        name: name.to_owned(),
        value,
        unit: unit.to_owned(),
        meaning: meaning.to_owned(),
        level: Level::Neutral,
    };
    let number = EvidenceValue::Number;
    [
        row(
            "bounds_confidence",
            "Confidence of the bounds",
            number(confidence),
            "",
            "Both bounds hold with at least this probability for the noise of contacts and forces and for the error of the motion.",
        ),
        row(
            "bounds_frame",
            "Axes of the bounds",
            EvidenceValue::Text(axes.to_owned()),
            "",
            "Principal: the bounds hold in the body's own axes. Mean pose: in body axes in which the estimated poses are right on the \
             average over the samples, that is the body's own displaced by the mean error of the poses.",
        ),
        row(
            "std_bounds_turn",
            "Turn of these axes",
            number(deviation(shared.rotation)),
            "rad",
            "Standard deviation of how far they are turned against the body's own, all axes together.",
        ),
        row(
            "std_bounds_shift",
            "Shift of these axes",
            number(deviation(shared.translation)),
            "m",
            "Standard deviation of how far their origin is from the centre of mass.",
        ),
    ]
}
