//! Which assumption fails: how often score tests of the sensors' constants are wrong on clean logs, and what is named where something is not as stated.
//!
//! `cargo xtask study assumptions [BODIES [SEED]]` writes docs/assumptions.md.

use crate::whole_logs::body::{self, Body};
use crate::whole_logs::options;
use recon::object_dynamics::ContactLog;
use recon::observer::contacts::{ContactEstimate, estimate_contacts};
use recon::observer::faults::{Assumption, Constant};
use recon_benches::fault::Fault;

type Failure = Box<dyn std::error::Error>;

const NOISE: [f64; 2] = [0.001, 0.01];
const SECONDS: f64 = 2.0;
/// Of clean logs: each makes another one of the same motion.
const RATES: [f64; 5] = [200.0, 220.0, 240.0, 260.0, 280.0];
const RATE_OF_FAULTS: f64 = 500.0;
/// Two-sided odds of score tests, and the deviations of a normal number that they are.
const TESTS: [(f64, f64); 3] = [(0.01, 2.5758), (0.001, 3.2905), (2e-6, 4.75)];
const KINDS: [&str; 5] = ["gain", "bias", "delay", "offset", "tilt"];
/// Natural logarithm of odds from which on something is told apart.
const HUNDREDFOLD: f64 = 4.605_170_185_988_092;
/// Chi-squared over the conditions that explains a log.
const EXPLAINED: f64 = 1.4;

const FAULTS: [Fault; 15] = [
    Fault::Gain(0.005),
    Fault::Gain(0.02),
    Fault::Gain(0.2),
    Fault::Bias(0.02),
    Fault::Delay(0.005),
    Fault::Lag(0.01),
    Fault::Shifted(0.01),
    Fault::Shifted(0.05),
    Fault::Turned(0.4),
    Fault::Turned(1.0),
    Fault::Turned(5.0),
    Fault::Mass(0.05),
    Fault::Inertia(0.1),
    Fault::Moment(0.05),
    Fault::Taxels(0.01),
];

pub(crate) fn main() -> Result<(), Failure> {
    let count: usize = crate::words().next().map_or(Ok(50), |word| word.parse())?;
    let seed: u64 = crate::words().nth(1).map_or(Ok(103_000), |word| word.parse())?;
    let bodies = body::some(count, seed)?;
    println!("# Which assumption fails\n\nMade by `cargo xtask study assumptions {count} {seed}`.\n");
    println!("{count} bodies as in [whole-logs.md](whole-logs.md), over {SECONDS} s.\n\n## Clean logs\n");
    clean(&bodies)?;
    println!("\n## Not as stated\n");
    println!(
        "At {RATE_OF_FAULTS} Hz; body known where it is what is wrong, else unknown. Explained: what was changed is the most probable of all that was tried"
    );
    println!(
        "(and noise explains what it leaves), or less than a hundred times less probable than the first; noise, or another constant: it is not, and these explain the log;"
    );
    println!(
        "not: nothing does; not seen: nothing contradicts the log. Value: of those that are explained first, within five deviations.\n"
    );
    println!(
        "| what | noise | runs | not seen | first | within 100 | noise | another | not | value |\n|---|---|---|---|---|---|---|---|---|---|"
    );
    for fault in &FAULTS {
        for noise in NOISE {
            let mut counts = [0; 8];
            for body in &bodies {
                let made = crate::rows::row(|| faulty(body, noise, fault))?;
                let Some(made) = made.flatten() else { continue };
                counts[0] += 1;
                counts[made.0] += 1;
                counts[7] += usize::from(made.1);
            }
            let [runs, unseen, first, within, noise_itself, another, not, value] = counts;
            println!(
                "| {} | {} % | {runs} | {unseen} | {first} | {within} | {noise_itself} | {another} | {not} | {value} of {first} |",
                fault.name(),
                100.0 * noise
            );
        }
    }
    Ok(())
}

/// Score tests of clean logs.
fn clean(bodies: &[Body]) -> Result<(), Failure> {
    let mut beyond = [[0_usize; TESTS.len()]; KINDS.len()];
    let (mut tests, mut squares) = ([0_usize; KINDS.len()], [0.0; KINDS.len()]);
    let (mut runs, mut contradicted, mut named) = (0, 0, 0);
    for noise in NOISE {
        for known in [true, false] {
            for rate in RATES {
                for body in bodies {
                    let made = crate::rows::row(|| scores(body, noise, rate, known))?;
                    let Some((explained, scores)) = made.flatten() else { continue };
                    runs += 1;
                    contradicted += usize::from(explained > 0);
                    named += usize::from(explained > 1);
                    for (kind, score) in scores.into_iter().flatten() {
                        tests[kind] += 1;
                        squares[kind] += score * score;
                        for (count, (_, limit)) in beyond[kind].iter_mut().zip(TESTS) {
                            *count += usize::from(score.abs() > limit);
                        }
                    }
                }
            }
        }
    }
    println!(
        "{runs} logs of known and unknown bodies at {RATES:?} Hz, noise of contacts {NOISE:?} of the size. In {contradicted} something is contradicted, in {named} of them a constant is"
    );
    println!("named at odds above a hundred.\n");
    println!(
        "| constant | tests | mean square | beyond 2.58 (1 %) | beyond 3.29 (0.1 %) | beyond 4.75 |\n|---|---|---|---|---|---|"
    );
    for (k, kind) in KINDS.iter().enumerate() {
        let share = |i: usize| 100.0 * beyond[k][i] as f64 / tests[k].max(1) as f64;
        let mean = squares[k] / tests[k].max(1) as f64;
        println!(
            "| {kind} | {} | {mean:.2} | {:.2} % | {:.3} % | {} |",
            tests[k],
            share(0),
            share(1),
            beyond[k][2]
        );
    }
    Ok(())
}

/// Scores by kind; none of a constant of which a log does not tell.
type Scores = [Option<(usize, f64)>; 20];

/// Whether a clean log is contradicted (1) and something named (2), and its scores.
fn scores(body: &Body, noise: f64, rate: f64, known: bool) -> Result<Option<(usize, Scores)>, Failure> {
    let Some((log, _)) = body.log(noise, rate, SECONDS)? else { return Ok(None) };
    let options = options(body, noise, known.then_some(body.mass));
    let Ok(found) = estimate_contacts(&ContactLog::try_from(&log)?, None, &options) else { return Ok(None) };
    let kind = |fault| match fault {
        Constant::ForceGain { .. } => 0,
        Constant::ForceBias { .. } => 1,
        Constant::ForceDelay => 2,
        Constant::ContactOffset { .. } => 3,
        _ => 4,
    };
    let mut scores = [None; 20];
    let told = found.suspects.iter().filter(|of| of.deviation.is_finite() && of.fault != Constant::Friction);
    for (score, suspect) in scores.iter_mut().zip(told) {
        *score = Some((kind(suspect.fault), suspect.score()));
    }
    let named = match found.explanations.first() {
        None => 0,
        Some(first) if first.assumption != Assumption::None && first.log_odds > HUNDREDFOLD => 2,
        Some(_) => 1,
    };
    Ok(Some((named, scores)))
}

/// Which count a run goes to, and whether the value is right where it is the first.
fn faulty(body: &Body, noise: f64, fault: &Fault) -> Result<Option<(usize, bool)>, Failure> {
    let Some((log, _)) = body.log(noise, RATE_OF_FAULTS, SECONDS)? else { return Ok(None) };
    let log = fault.of_log(&log, body.scale())?;
    let options = options(body, noise, fault.of_body().then(|| fault.of_mass(body.mass)));
    let Ok(found) = estimate_contacts(&ContactLog::try_from(&log)?, None, &options) else { return Ok(None) };
    Ok(Some(outcome(&found, fault, body)))
}

fn outcome(found: &ContactEstimate, fault: &Fault, body: &Body) -> (usize, bool) {
    let explains = |of: &&recon::observer::faults::Explanation| {
        of.assumption != Assumption::None && of.misfit < EXPLAINED
    };
    let Some(first) = found.explanations.first() else { return (1, false) };
    let own = found.explanations.iter().filter(explains).find(|of| fault.is(&of.assumption));
    match own {
        Some(own) if own.assumption == first.assumption => {
            let right = fault
                .value(body.scale(), RATE_OF_FAULTS)
                .is_none_or(|value| (own.value - value).abs() < 5.0 * own.deviation);
            (2, right)
        }
        Some(own) if first.log_odds - own.log_odds < HUNDREDFOLD => (3, false),
        _ if first.assumption == Assumption::Noise => (4, false),
        _ if explains(&first) => (5, false),
        _ => (6, false),
    }
}
