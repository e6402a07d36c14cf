//! Modes by the classifier against those that are true.

use super::super::contact_modes_estimated::tally::{Run as Tally, reliability};
use super::scenes::Run;
use super::sensed::LASTING;
use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::{
    ContactFriction, ContactModes, ContactModesError, ContactModesOptions, ContactOdds, ContactSeen,
    LearnedFriction, whole_modes,
};
use std::fmt::Write as _;

/// Samples to either side of a switch that do not count, at 1 kHz.
const NEAR: usize = 5;

/// How modes are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// Sample by sample, of a known friction.
    Known,
    /// Sample by sample, one friction for all contacts, which is not known.
    Unknown,
    /// Of the whole log, the friction not known.
    Whole,
}

impl Way {
    pub(super) const ALL: [Self; 3] = [Self::Known, Self::Unknown, Self::Whole];

    pub(super) fn words(self) -> &'static str {
        match self {
            Self::Known => "sample by sample, friction known",
            Self::Unknown => "sample by sample, friction unknown",
            Self::Whole => "the whole log, friction unknown",
        }
    }
}

/// One run in one way.
pub(super) struct Judged {
    pub(super) way: Way,
    pub(super) spatial: bool,
    noise: f64,
    pub(super) tally: Tally,
    /// Samples by what is true (off, slides, sticks) and what is most probable.
    confusion: [[f64; 3]; 3],
    /// Samples that slide and stick, and all.
    either: [f64; 2],
    /// Largest error of a friction as a share of it, and in its deviations.
    friction: Option<[f64; 2]>,
    /// Whether readings of some contact are doubted, which are as stated.
    doubted: bool,
}

/// What was told of a run.
struct Told {
    /// Of each contact at each sample.
    odds: Vec<Vec<ContactOdds>>,
    frictions: Vec<Option<LearnedFriction>>,
    doubted: bool,
}

pub(super) fn judged(
    run: &Run,
    (seen, unloaded): &(Vec<Vec<ContactSeen>>, f64),
    way: Way,
    (spatial, noise): (bool, f64),
) -> Result<Judged, ContactModesError> {
    let mut options = ContactModesOptions::new(run.natural_speed(), *unloaded, 0.5 * run.weight);
    options.slip_errors_last = LASTING;
    let contacts = run.samples[0].len();
    let told = match way {
        Way::Whole => {
            let of = |i: usize| seen.iter().map(|seen| seen[i]).collect();
            let seen: Vec<Vec<ContactSeen>> = (0..contacts).map(of).collect();
            let times: Vec<f64> = (0..run.samples.len()).map(|k| k as f64 * Run::DT).collect();
            let found = whole_modes(&times, &seen, &options)?;
            Told { odds: found.odds, frictions: found.frictions, doubted: !found.doubts.is_empty() }
        }
        Way::Known => followed(seen, ContactFriction::Known(run.friction), contacts, options)?,
        Way::Unknown => followed(seen, ContactFriction::Unknown { material: 0 }, contacts, options)?,
    };
    let error = |found: &LearnedFriction| {
        let off = (found.coefficient - run.friction).abs();
        [off / run.friction, off / found.deviation]
    };
    let errors = told.frictions.iter().flatten().map(error);
    let friction = errors.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    let tally = Tally::new("", true);
    let mut judged = Judged {
        way,
        spatial,
        noise,
        tally,
        confusion: [[0.0; 3]; 3],
        either: [0.0; 2],
        friction,
        doubted: told.doubted,
    };
    (0..contacts).for_each(|i| judged.take(run, i, &told.odds[i]));
    Ok(judged)
}

/// Sample by sample.
fn followed(
    seen: &[Vec<ContactSeen>],
    friction: ContactFriction,
    contacts: usize,
    options: ContactModesOptions,
) -> Result<Told, ContactModesError> {
    let mut modes = ContactModes::new(&vec![friction; contacts], options)?;
    let mut odds = vec![Vec::with_capacity(seen.len()); contacts];
    for seen in seen {
        modes.push(Run::DT, seen)?;
        odds.iter_mut().enumerate().for_each(|(i, own)| own.extend(modes.odds(i)));
    }
    let frictions = (0..contacts).map(|i| modes.friction(i)).collect();
    Ok(Told { odds, frictions, doubted: modes.doubts().next().is_some() })
}

impl Judged {
    fn take(&mut self, run: &Run, contact: usize, odds: &[ContactOdds]) {
        let mut modes: Vec<ContactMode> = run.samples.iter().map(|all| all[contact].mode).collect();
        // To slide next to nothing is no switch.
        for k in 1..modes.len() {
            if run.samples[k][contact].either {
                modes[k] = modes[k - 1];
            }
        }
        for (k, of) in odds.iter().enumerate() {
            self.either[1] += 1.0;
            if run.samples[k][contact].either {
                self.either[0] += 1.0;
                continue;
            }
            let about = k.saturating_sub(NEAR)..(k + NEAR + 1).min(modes.len());
            let near = modes[about].iter().any(|mode| *mode != modes[k]);
            let told = [of.off, of.slide, of.stick];
            self.tally.add(modes[k], modes[k], told, near);
            if !near {
                let most = (0..3).fold(0, |best, m| if told[m] > told[best] { m } else { best });
                self.confusion[usize::from(modes[k].number())][most] += 1.0;
            }
        }
    }
}

pub(super) fn tables(all: &[&Judged]) -> String {
    let mut out = String::from(
        "| modes told from | scenes | noise | runs | samples | right | worst run | Brier | above 0.99 | of all: above 0.99 and wrong | slides and sticks | friction: largest error, in deviations | runs doubted |\n|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for way in Way::ALL {
        for spatial in [true, false] {
            for noise in super::NOISES {
                let of = |j: &&&Judged| j.way == way && j.spatial == spatial && j.noise == noise;
                let own: Vec<&Judged> = all.iter().filter(of).copied().collect();
                let _ = writeln!(out, "{}", row(&own));
            }
        }
    }
    for way in Way::ALL {
        let own: Vec<&Judged> = all.iter().filter(|j| j.way == way).copied().collect();
        let _ = writeln!(out, "\n## {}\n\n{}", capital(way.words()), confusion(&own));
        for (spatial, words) in [(true, "space"), (false, "the plane")] {
            let runs: Vec<&Tally> = own.iter().filter(|j| j.spatial == spatial).map(|j| &j.tally).collect();
            let _ = writeln!(out, "Scenes in {words}:\n\n{}", reliability(&runs));
        }
    }
    out
}

fn row(own: &[&Judged]) -> String {
    let sum = |of: fn(&Tally) -> f64| own.iter().map(|judged| of(&judged.tally)).sum::<f64>();
    let samples = sum(|tally| tally.samples).max(1.0);
    let worst = own.iter().map(|j| j.tally.right / j.tally.samples.max(1.0)).fold(1.0, f64::min);
    let either = |i: usize| own.iter().map(|judged| judged.either[i]).sum::<f64>();
    let friction =
        own.iter().filter_map(|judged| judged.friction).reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])]);
    let doubted = own.iter().filter(|judged| judged.doubted).count();
    let Some(first) = own.first() else { return String::new() };
    format!(
        "| {} | {} | {} % | {} | {samples} | {:.4} | {worst:.3} | {:.4} | {:.3} | {:.5} | {:.3} | {} | {doubted} |",
        first.way.words(),
        if first.spatial { "space" } else { "plane" },
        100.0 * first.noise,
        own.len(),
        sum(|tally| tally.right) / samples,
        sum(|tally| tally.brier) / samples,
        sum(|tally| tally.confident) / samples,
        sum(|tally| tally.wrong) / samples,
        either(0) / either(1).max(1.0),
        friction.map_or(String::new(), |[share, off]| format!("{:.2} %, {off:.1}", 100.0 * share)),
    )
}

fn confusion(own: &[&Judged]) -> String {
    let mut out = String::from("| true | told off | slides | sticks |\n|---|---|---|---|\n");
    for (i, name) in ["off", "slides", "sticks"].into_iter().enumerate() {
        let counts = [0, 1, 2].map(|k| own.iter().map(|judged| judged.confusion[i][k]).sum::<f64>());
        let all: f64 = counts.iter().sum::<f64>().max(1.0);
        let [off, slides, sticks] = counts.map(|count| count / all);
        let _ = writeln!(out, "| {name} | {off:.4} | {slides:.4} | {sticks:.4} |");
    }
    out
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}
