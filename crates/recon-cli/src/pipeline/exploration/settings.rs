//! What an exploration is asked to do, from the command line and from the summary of an earlier one.

use super::Side;
use crate::cli::{GoalArgs, PlannerAs, Until, until};
use crate::error::CliError;
use clap::ValueEnum;
use recon::exploration::{Confidence, Goal, Heading, Knowledge, Spending};
use recon::observer::rolling::RollingNoise;
use serde_json::{Value, json};

pub(crate) const CONFIDENCE: f64 = 0.95;
/// Touches at most in the plane and in space: some four times what ten and twenty per cent take.
const BUDGETS: [u32; 2] = [60, 200];

/// Standard deviations of points (m) and normals (rad), and the confidence; none of exact contacts.
pub(crate) type Noise = Option<([f64; 2], f64)>;

/// As the command line has it.
pub(super) fn noise_of(args: &GoalArgs) -> Noise {
    let noise = args.contact_noise.zip(args.normal_noise);
    noise.map(|(point, normal)| ([point, normal], args.confidence.unwrap_or(CONFIDENCE)))
}

/// Says it among the settings of a summary.
pub(super) fn add_noise(noise: Noise, figures: &mut Value) {
    if let Some(([point, normal], confidence)) = noise {
        figures["contact_noise_m"] = point.into();
        figures["normal_noise_rad"] = normal.into();
        figures["confidence"] = confidence.into();
    }
}

/// Everything but the goal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Settings {
    pub(crate) planner: PlannerAs,
    pub(crate) seed: u64,
    pub(crate) budget: usize,
    pub(crate) noise: Noise,
    /// Standard deviations of points along palms (m) and of forces (N), and the confidence, where palms turn and the motion is estimated.
    pub(crate) sensors: Option<([f64; 2], f64)>,
    /// Of bounds, where noise is stated.
    pub(crate) confidence: Option<f64>,
    /// Noise of parallel palms, where the pose is estimated from what they sense.
    pub(crate) between: Option<RollingNoise>,
}

impl Settings {
    /// As given, else as in the summary of an earlier exploration, else as always.
    pub(crate) fn new(args: &GoalArgs, earlier: &Value, dimension: usize) -> Self {
        let was = &earlier["settings"];
        let number = |key: &str| was[key].as_f64();
        let planner = was["planner"].as_str().and_then(|name| PlannerAs::from_str(name, false).ok());
        let given = args.contact_noise.zip(args.normal_noise);
        let noise = given.or_else(|| number("contact_noise_m").zip(number("normal_noise_rad")));
        let stated = args.confidence.or_else(|| number("confidence"));
        let confidence = stated.unwrap_or(CONFIDENCE);
        let always = BUDGETS[usize::from(dimension == 3)];
        let budget = args.budget.map(u64::from).or_else(|| was["budget"].as_u64());
        Self {
            planner: args.planner.or(planner).unwrap_or(PlannerAs::PathAware),
            seed: args.seed.or_else(|| was["seed"].as_u64()).unwrap_or(1),
            budget: budget.unwrap_or(u64::from(always)) as usize,
            noise: noise.map(|(point, normal)| ([point, normal], confidence)),
            sensors: number("contact_noise_m")
                .zip(number("force_noise_n"))
                .map(|(a, b)| ([a, b], confidence)),
            confidence: stated,
            between: None,
        }
    }

    /// Of parallel palms that sense with noise. Contacts are off by no less than the place of the palm; each states its own noise.
    pub(crate) fn estimated_between(mut self, noise: RollingNoise, confidence: f64) -> Self {
        self.noise = Some(([noise.palm, 0.0], confidence));
        self.between = Some(noise);
        self
    }

    /// As [`Settings::new`] reads them.
    pub(crate) fn figures(&self) -> Value {
        let mut figures = json!({
            "planner": self.planner.name(),
            "seed": self.seed,
            "budget": self.budget,
        });
        match (self.between, self.noise) {
            (Some(between), Some((_, confidence))) => {
                figures["contact_noise_m"] = between.contact.into();
                figures["palm_noise_m"] = between.palm.into();
                figures["spin_noise_rad"] = between.spin.into();
                figures["confidence"] = confidence.into();
            }
            _ => add_noise(self.noise, &mut figures),
        }
        if let Some(([point, force], confidence)) = self.sensors {
            figures["contact_noise_m"] = point.into();
            figures["force_noise_n"] = force.into();
            figures["confidence"] = confidence.into();
        }
        figures
    }

    /// How the confidence is shared; none for exact contacts.
    pub(crate) fn spending(&self) -> Option<Spending> {
        self.noise.map(|_| Spending::Budget(self.budget))
    }

    /// Noise of contacts with the confidence of the bounds.
    pub(crate) fn stated_noise(&self) -> Result<Option<([f64; 2], Confidence)>, CliError> {
        let stated = |(noise, level)| {
            Confidence::new(level, Spending::Budget(self.budget)).map(|confidence| (noise, confidence))
        };
        Ok(self.noise.map(stated).transpose()?)
    }
}

type HeadingOf<S> = <<S as Side>::Known as Knowledge>::Heading;

/// The goal on one side.
pub(crate) fn goal_of<S: Side>(asked: &Until) -> Result<Goal<HeadingOf<S>>, CliError> {
    Ok(match asked {
        Until::Gap(gap) => Goal::Gap(*gap),
        Until::Hausdorff(distance) => Goal::Hausdorff(*distance),
        Until::Width(within, along) => Goal::Width {
            along: S::heading(along).map_err(|what| CliError::Goal(format!("its direction {what}")))?,
            within: *within,
        },
    })
}

/// The goal as text, as [`until`] reads it.
pub(super) fn words_of<H: Heading>(goal: &Goal<H>) -> String {
    match goal {
        Goal::Width { along, within } => {
            let along: Vec<String> = along.coordinates().iter().map(f64::to_string).collect();
            format!("width={within}@{}", along.join(","))
        }
        other => format!("{}={}", other.kind(), other.value()),
    }
}

/// The goal of an earlier exploration.
pub(crate) fn until_of(earlier: &Value) -> Option<Until> {
    earlier["goal"]["until"].as_str().and_then(|text| until(text).ok())
}
