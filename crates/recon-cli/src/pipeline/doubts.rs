//! What is said where the noise of contacts is not as was stated.

use super::sound::Noise;
use crate::error::CliError;
use recon::shape_bounds::noise::NoiseDoubt;
use serde_json::{Value, json};

/// What is not as was assumed of the noise of contacts, in space or in the plane.
pub(super) struct Doubts {
    all: Vec<NoiseDoubt>,
    noise: Noise,
    /// Whether independence could be tested.
    tested: bool,
    /// Whether noise is alike from one contact to the next.
    pub(super) correlated: bool,
}

impl Doubts {
    /// Levels that were read off contacts whose noise is alike are none: an error.
    pub(super) fn new(
        mut levels: Vec<NoiseDoubt>,
        (alike, tested): (Option<NoiseDoubt>, bool),
        noise: Noise,
    ) -> Result<Self, CliError> {
        if let (Some(NoiseDoubt::Correlated { ratio, p_value }), Noise::Estimated) = (alike, noise) {
            return Err(CliError::CorrelatedNoise { ratio, p_value });
        }
        levels.extend(alike);
        Ok(Self { all: levels, noise, tested, correlated: alike.is_some() })
    }

    /// For programs, where there are any.
    pub(super) fn add_to(&self, about: &mut Value) {
        if !self.all.is_empty() {
            about["noise_doubts"] = self.all.iter().map(listed).collect();
        }
        about["independence_is_tested"] = json!(self.tested);
    }

    /// What is to be said of levels that were read off contacts too few, or too far apart, to tell whether their noise is alike: such
    /// noise is larger than it looks. Levels that were stated are the user's.
    pub(super) fn untested(&self) -> Option<String> {
        let said = "Contacts are too few, or too far apart, to tell whether their noise is alike from one to the next: if it is, the \
                    estimated noise is too small and the bounds do not hold.";
        (matches!(self.noise, Noise::Estimated) && !self.tested).then(|| said.to_owned())
    }

    /// In words, with what is done about each.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        let baseline = match self.noise {
            Noise::Stated { .. } => "was stated",
            Noise::Estimated => "the whole curve shows",
        };
        self.all.iter().map(move |doubt| in_words(doubt, baseline))
    }
}

/// What a fit has to say of doubts that `about` lists: it rests on the same noise.
pub(crate) fn doubtful_fit(about: &Value) -> Option<String> {
    let doubts = about["noise_doubts"].as_array()?;
    let independent = doubts.iter().all(|d| d["assumption"] != "independent");
    let (what, then) = if independent {
        ("its level", "contacts have the larger one where it was found")
    } else {
        (
            "its independence",
            "deviations of the parameters are too small, and a refusal of the shape is not certain",
        )
    };
    Some(format!(
        "The fit rests on noise that is not as assumed in {what} (noise_doubts in the summary): {then}."
    ))
}

fn listed(of: &NoiseDoubt) -> Value {
    match of {
        NoiseDoubt::Level { curve, what, stated, found, p_value } => json!({
            "assumption": "level", "curve": curve + 1, "what": what, "stated": stated, "found": found, "p_value": p_value,
        }),
        NoiseDoubt::Changing { curve, first, last, what, stated, found, p_value } => json!({
            "assumption": "level", "curve": curve + 1, "contacts": [first + 1, last + 1], "what": what,
            "stated": stated, "found": found, "p_value": p_value,
        }),
        NoiseDoubt::Correlated { ratio, p_value } => {
            json!({ "assumption": "independent", "ratio": ratio, "p_value": p_value })
        }
    }
}

fn in_words(of: &NoiseDoubt, baseline: &str) -> String {
    match of {
        NoiseDoubt::Level { curve, what, stated, found, p_value } => format!(
            "Noise of curve {} ({what}) is {found:.1e} where {stated:.1e} {baseline} (binomial test on what neighbours do not predict, \
             p = {p_value:.0e}): the larger one is used.",
            curve + 1
        ),
        NoiseDoubt::Changing { curve, first, last, what, stated, found, p_value } => format!(
            "Noise changes along curve {} ({what}): it is {found:.1e} from contact {} to {} where {stated:.1e} {baseline} (binomial test \
             on what neighbours do not predict, p = {p_value:.0e}): the larger one is used there.",
            curve + 1,
            first + 1,
            last + 1
        ),
        NoiseDoubt::Correlated { ratio, p_value } => format!(
            "Noise is alike from one contact to the next: {ratio:.1} times as large over every second contact as over every one (z-test, \
             p = {p_value:.0e}). No means are taken over contacts; the stated level must be that of the whole noise."
        ),
    }
}
