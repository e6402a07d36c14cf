//! The estimator's evidence in words and numbers for people.

use recon::observer::{MotionEstimate, Reliability};
use recon_io::{Evidence, EvidenceValue, Level, Verdict};

/// Unknowns of the estimate: centre of mass, velocity, angular momentum, orientation.
const UNKNOWNS: usize = 12;

/// Whether the estimate can be relied on, in one sentence.
pub(crate) fn verdict(estimate: &MotionEstimate) -> Verdict {
    match &estimate.reliability {
        Reliability::Reliable => Verdict {
            level: Level::Good,
            text: format!(
                "The fit settled, and the log determines all {UNKNOWNS} unknowns of the motion; the least certain is the {}.",
                estimate.evidence.weakest
            ),
        },
        Reliability::Unreliable(reasons) => {
            let reasons: Vec<_> = reasons.iter().map(ToString::to_string).collect();
            Verdict {
                level: Level::Bad,
                text: format!("Do not rely on this result: {}.", reasons.join("; ")),
            }
        }
    }
}

/// What the estimate rests on, row by row.
pub(crate) fn evidence(estimate: &MotionEstimate) -> Vec<Evidence> {
    let e = &estimate.evidence;
    let deviation = |block: usize| {
        let variance: f64 = (3 * block..3 * block + 3).map(|k| estimate.covariance[(k, k)]).sum();
        EvidenceValue::Number(variance.sqrt())
    };
    let misfit = e.residual_rms / e.noise_explains;
    let known = if e.rank == UNKNOWNS { Level::Good } else { Level::Bad };
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
    vec![
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
            EvidenceValue::Text(format!("{} of {UNKNOWNS}", e.rank)),
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
            "std_position",
            "Uncertainty of the centre of mass",
            deviation(0),
            "m",
            "Standard deviation at the first sample, all axes together.",
            neutral,
        ),
        row(
            "std_velocity",
            "Uncertainty of the velocity",
            deviation(1),
            "m/s",
            "Standard deviation at the first sample.",
            neutral,
        ),
        row(
            "std_orientation",
            "Uncertainty of the orientation",
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
    ]
}
