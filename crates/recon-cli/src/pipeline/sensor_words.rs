//! What the data say of constants of the sensors and of a stated body, in words for people.

use super::any_palms_words::neutral;
use recon::observer::faults::{Assumption, Explanation, Suspect};
use recon_io::EvidenceValue::Text;
use recon_io::{Evidence, Level, brief_to};

/// Chi-squared over the conditions up to which a log is explained, as the estimator has it.
const EXPLAINED: f64 = 1.4;
/// Deviations of a constant from what it was taken for that chance does not explain, as the estimator has it.
pub(super) const UNEXPLAINED: f64 = 4.75;
/// Decades of odds up to which explanations are told side by side.
const TOLD_APART: f64 = 2.0;
/// Deviations beyond which an error counts as wrong.
const UNTOLD: f64 = 5.0;

/// What the data say of constants that were taken as known, and how well these must be known: those that are farthest off, and those that matter
/// most.
pub(super) fn suspects(all: &[Suspect]) -> Vec<Evidence> {
    let sorted = |key: fn(&Suspect) -> f64| {
        let mut sorted: Vec<&Suspect> = all.iter().filter(|suspect| key(suspect).is_finite()).collect();
        sorted.sort_by(|a, b| key(a).total_cmp(&key(b)));
        sorted
    };
    let most = sorted(|suspect| -suspect.score().abs());
    let Some(first) = most.first() else { return Vec::new() };
    let score =
        |s: &&Suspect| format!("{} {} +- {}", s.fault, brief_to(2, s.value), brief_to(2, s.deviation));
    let said: Vec<String> = most.iter().take(3).map(score).collect();
    let needed: Vec<String> = of_each_kind(sorted(|suspect| suspect.tolerated))
        .iter()
        .map(|s| format!("{} {}", s.fault, brief_to(2, s.tolerated)))
        .collect();
    let meaning = "What was taken as known of the sensors and of a stated body, and what it is to be off by as the data have it (score tests): those that are farthest \
                   off in their deviations. Beyond 4.75 of them the result is not to be relied on.";
    let matters = "Of each kind the one that matters most: an error as large as this, which need not be seen, moves some number of the \
                   motion by one of its deviations.";
    vec![
        Evidence {
            level: if first.score().abs() > UNEXPLAINED { Level::Bad } else { Level::Good },
            ..neutral("sensor_faults", "Constants taken as known", Text(said.join("; ")), "", meaning)
        },
        neutral("sensor_accuracy_needed", "Needed to be known to", Text(needed.join("; ")), "", matters),
        untold(all),
    ]
}

/// Constants that may be so far off, unnoticed, that a number of the motion is off by more deviations than it is to be: of each kind the one that moves it
/// most.
fn untold(all: &[Suspect]) -> Evidence {
    let mut sorted: Vec<&Suspect> = all.iter().filter(|suspect| suspect.untold() > UNTOLD).collect();
    sorted.sort_by(|a, b| b.untold().total_cmp(&a.untold()));
    let one = |s: &&Suspect| match s.deviation.is_finite() {
        true => format!(
            "{} below {} ({} deviations)",
            s.fault,
            brief_to(2, s.told_from()),
            brief_to(2, s.untold())
        ),
        false => format!("{}, however large", s.fault),
    };
    let said: Vec<String> = of_each_kind(sorted).iter().map(one).collect();
    let said = if said.is_empty() { "nothing that counts".to_owned() } else { said.join("; ") };
    let meaning = "What a score test at one false alarm in a hundred finds less often than nine times in ten, and by how many of its deviations a number of the \
                   motion may then be off: sensors and a stated body must be that good by themselves. Of each kind the worst.";
    neutral("sensor_not_told", "Not told by the data", Text(said), "", meaning)
}

/// The first one of each kind.
fn of_each_kind(all: Vec<&Suspect>) -> Vec<&Suspect> {
    let mut kinds: Vec<&Suspect> = Vec::new();
    for suspect in all {
        let kind = std::mem::discriminant(&suspect.fault);
        if kinds.iter().all(|other| std::mem::discriminant(&other.fault) != kind) {
            kinds.push(suspect);
        }
    }
    kinds
}

/// What explains a log that contradicts what was taken as known; none of a log that does not.
pub(super) fn explained(all: &[Explanation]) -> Option<Evidence> {
    let (first, others) = all.split_first()?;
    let value = |of: &Explanation| match of.assumption {
        Assumption::None => of.assumption.to_string(),
        _ => format!("{}: {} +- {}", of.assumption, brief_to(3, of.value), brief_to(2, of.deviation)),
    };
    let explains = |of: &Explanation| of.assumption != Assumption::None && of.misfit < EXPLAINED;
    let odds = |of: &Explanation| (first.log_odds - of.log_odds) / std::f64::consts::LN_10;
    let said = if explains(first) {
        let as_good: Vec<String> =
            others.iter().filter(|of| odds(of) < TOLD_APART && explains(of)).map(value).collect();
        let next = others.get(as_good.len());
        let next = next.map(|of| format!("; {}, is 10^{:.0} times less probable", value(of), odds(of)));
        [vec![value(first)], as_good].concat().join(", or ") + &next.unwrap_or_default()
    } else {
        "no single constant that was tried, nor noise".to_owned()
    };
    let meaning = "The log contradicts what was taken as known. Each of the constants alone was let go, and mass and inertia, and the noise: what explains \
                   most, weighed against how much else it could have explained; those that are less than a hundred times less probable are told with it.";
    Some(Evidence { level: Level::Bad, ..neutral("explained_by", "Explained by", Text(said), "", meaning) })
}
