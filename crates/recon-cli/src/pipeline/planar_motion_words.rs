//! A motion that was estimated in the plane, in words and numbers for people.

use super::any_palms_words::{fit, modes, neutral, relied, told, wider};
use super::planar_motion::ENOUGH;
use super::sensor_words::{explained, suspects};
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::PlaneEstimate;
use recon::observer::reliability::Reliability;
use recon_io::EvidenceValue::Number;
use recon_io::{Evidence, Level, Verdict};

/// How the estimate was made.
pub(super) const NOTE: &str = "Estimated from contacts and forces as in space, of a motion that is held in the plane; body axes are those of the world at the first sample.";

/// Whether the estimate can be relied on, in one sentence.
pub(super) fn verdict(estimate: &PlaneEstimate, share: f64, known_body: bool) -> Verdict {
    if let Reliability::Unreliable(reasons) = &estimate.reliability {
        let reasons: Vec<String> = reasons.iter().map(ToString::to_string).collect();
        let text = format!("Do not rely on this result: {}.", reasons.join("; "));
        return Verdict { level: Level::Bad, text };
    }
    let body = if known_body {
        "mass and inertia are taken as stated"
    } else {
        "mass and inertia are learned from the log"
    };
    let text = format!(
        "The fit settled, noise explains what is left (chi-squared {:.2} a condition), and {}; {body}.{}",
        estimate.evidence.misfit,
        relied(share),
        wider(&estimate.evidence),
    );
    Verdict { level: if share < ENOUGH { Level::Caution } else { Level::Good }, text }
}

/// What the estimate rests on, row by row.
pub(super) fn evidence(
    estimate: &PlaneEstimate,
    noise: &ContactNoiseLevel,
    share: f64,
    known_body: bool,
) -> Vec<Evidence> {
    let (mass, inertia) = (estimate.mass, estimate.inertia);
    let meaning = if known_body { "As it was stated." } else { "As estimated from the log." };
    let mut rows = vec![neutral("mass", "Mass", Number(mass.0), "kg", meaning)];
    let about = "About the centre of mass.";
    if !known_body {
        let deviation = Number(mass.0 * mass.1);
        rows.push(neutral("std_mass", "Uncertainty of the mass", deviation, "kg", "Standard deviation."));
    }
    rows.push(neutral("inertia", "Moment of inertia", Number(inertia.0), "kg m^2", about));
    if !known_body {
        let name = "Uncertainty of the moment";
        rows.push(neutral("std_inertia", name, Number(inertia.1), "kg m^2", "Standard deviation."));
    }
    rows.extend(fit(&estimate.evidence, &estimate.reliability, share));
    rows.extend(told(noise));
    rows.extend(suspects(&estimate.suspects));
    rows.extend(explained(&estimate.explanations));
    rows.extend(estimate.mode_odds.as_ref().map(modes).into_iter().flatten());
    rows
}
