//! Whole noisy logs of three palms without friction: random bodies from hand scale to metres, white noise as it is stated, and sensors,
//! bodies and palms that are not as stated.
//!
//! Usage: `whole_logs [COUNT [SEED [WHAT]]]`: with a word of what is not as stated its rows alone.

pub(crate) mod body;
mod tally;

use body::Body;
use recon::object_dynamics::ContactLog;
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon_benches::fault::{FAULTS, Fault};
use tally::{Run, Tally, judged};

type Failure = Box<dyn std::error::Error>;

/// Seed of the bodies, and of the noise.
const SEED: u64 = 94_000;
/// Noise of contacts as a share of the size, of forces as one of the weight.
const NOISE: [f64; 2] = [0.001, 0.01];
const RATES: [f64; 2] = [200.0, 1000.0];
/// Lengths of the logs, s.
const LENGTHS: [f64; 3] = [1.0, 3.0, 6.0];
/// Of the logs with faults.
const OF_FAULTS: (f64, f64) = (3.0, 500.0);

pub(crate) fn main() -> Result<(), Failure> {
    let count: usize = crate::words().next().map_or(Ok(40), |word| word.parse())?;
    let seed: u64 = crate::words().nth(1).map_or(Ok(SEED), |word| word.parse())?;
    let bodies = body::some(count, seed)?;
    println!("# Whole noisy logs\n\nMade by `cargo xtask study whole_logs {count} {seed}`.\n");
    println!(
        "{count} ellipsoids of 2 cm to 3 m, axes of up to 1 : 3, moments up to 10 % off those of uniform ones, on three palms without friction that slope by"
    );
    println!(
        "35 to 85 degrees, spins of up to 0.6 in natural units (the root of gravity over size); logs of {} s, or up to the loss of contact, those of less than five natural",
        LENGTHS.map(|of| of.to_string()).join(", ")
    );
    println!(
        "times left out; from no guess. Noise: of contacts as a share of the size, of forces as one of the weight. Errors of centre of mass, velocity and angular velocity at all"
    );
    println!(
        "samples over their deviations: squared ones in the mean, and runs with one beyond five at any of some thousand samples. Milliseconds of processor time.\n"
    );
    let what = crate::words().nth(2);
    if what.is_none() {
        as_stated(&bodies)?;
    }
    not_as_stated(&bodies, &what.unwrap_or_default())
}

fn as_stated(bodies: &[Body]) -> Result<(), Failure> {
    println!("## As stated\n");
    println!(
        "| noise | samples a second | body | runs | relied on | mean squares | beyond 5 | largest | beyond 5 where refused | median ms | 90 % ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for noise in NOISE {
        for rate in RATES {
            for known in [true, false] {
                let mut tally = Tally::default();
                for body in bodies {
                    for seconds in LENGTHS {
                        run(body, (noise, rate, seconds), known, None, &mut tally)?;
                    }
                }
                let name = if known { "known" } else { "unknown" };
                println!("| {} % | {rate} | {name} | {} |", noise * 100.0, tally.row());
            }
        }
    }
    Ok(())
}

/// With this word in its name.
fn not_as_stated(bodies: &[Body], word: &str) -> Result<(), Failure> {
    println!("\n## Not as stated\n");
    println!(
        "The same bodies over {} s at {} Hz, known where the body is what is wrong, else unknown. Named: refused, and the first reason is the constant that is off. Silent: relied on with an error",
        OF_FAULTS.0, OF_FAULTS.1
    );
    println!("beyond five deviations.\n");
    println!("| what | noise | runs | relied on within 5 | named | refused otherwise | silent | largest |");
    println!("|---|---|---|---|---|---|---|---|");
    for fault in FAULTS.iter().filter(|fault| fault.name().contains(word)) {
        for noise in NOISE {
            let mut tally = Tally::default();
            for body in bodies {
                run(body, (noise, OF_FAULTS.1, OF_FAULTS.0), fault.of_body(), Some(fault), &mut tally)?;
            }
            println!("| {} | {} % | {} |", fault.name(), noise * 100.0, tally.faulty());
        }
    }
    Ok(())
}

/// One log; none that is too short for its natural time.
fn run(
    body: &Body,
    (noise, rate, seconds): (f64, f64, f64),
    known: bool,
    fault: Option<&Fault>,
    tally: &mut Tally,
) -> Result<(), Failure> {
    let run = crate::rows::row(|| -> Result<Option<Run>, Failure> {
        let Some((log, truth)) = body.log(noise, rate, seconds)? else { return Ok(None) };
        let log = match fault {
            Some(fault) => fault.of_log(&log, body.scale())?,
            None => log,
        };
        let stated = fault.map_or(body.mass, |fault| fault.of_mass(body.mass));
        let options = options(body, noise, known.then_some(stated));
        let times: Vec<f64> = log.samples().iter().map(|sample| sample.t).collect();
        let log = ContactLog::try_from(&log)?;
        Ok(Some(judged(|| estimate_contacts(&log, None, &options), &times, (&truth, rate))))
    })?;
    run.flatten().into_iter().for_each(|run| tally.take(run));
    Ok(())
}

pub(crate) fn options(
    body: &Body,
    noise: f64,
    mass: Option<recon::object_dynamics::MassProperties>,
) -> ContactOptions {
    let [contact, force] = body.noise(noise);
    let floor = 3e-5 * (body::G * body.size).sqrt();
    let noise = ContactNoiseLevel { contact, force_fixed: force, force_share: 0.0, impulse: None, floor };
    ContactOptions { friction: Some(0.0), body: mass, suspects: true, ..ContactOptions::new(noise, body::G) }
}
