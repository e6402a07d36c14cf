//! The estimate from contacts on random scenes of three tilting palms from rest: modes, friction and body unknown.
//!
//! Arguments: scenes, first seed, rate (Hz), and `mixed` for palms of all shapes. Writes a Markdown table.

use super::super::mode_switches::scenes::slides_and_sticks;
use super::super::tilting_palms::{FRICTION, variant};
use super::mixed::mixed;
use super::{FLOOR, G};
use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::{
    ChannelNoise, ContactLog, ContactNoise, ContactScene, ContactSimulation, ContactStart, SampleTimes,
};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use shape_bounds::generators::Source;
use std::error::Error;

/// Contacts as a share of the mean semi-axis, forces of themselves.
const NOISE: (f64, f64) = (0.005, 0.02);

/// Largest errors of a run in the deviations that are stated, over the samples that are relied on: centre and velocity in any axis,
/// mass.
struct Errors {
    /// Share of the samples that are relied on.
    relied_on: f64,
    chi_squared: f64,
    centre: f64,
    velocity: f64,
    mass: f64,
    /// Root mean squares: centre over mean semi-axis, velocity over the natural one; mass relative.
    of_natural: [f64; 3],
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let mut words = crate::words();
    let wanted: u64 = words.next().map_or(Ok(40), |s| s.parse())?;
    let first: u64 = words.next().map_or(Ok(1), |s| s.parse())?;
    let rate: f64 = words.next().map_or(Ok(200.0), |s| s.parse())?;
    let all_shapes = words.next().is_some_and(|word| word == "mixed");
    let mut source = Source::new(first);
    println!(
        "| scene | relied on | chi-squared a condition | largest error relied on, in deviations: centre, velocity, mass | centre, velocity, mass (natural) | modes right | above 0.99 and wrong | friction: largest error, in deviations |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for k in 0..wanted {
        let (planes, body, duration) = variant(&mut source)?;
        let scene = if all_shapes { mixed(&planes, &body, &mut source)? } else { planes };
        let row = crate::rows::row(|| -> Result<String, Box<dyn Error>> {
            let run = scene.simulate(&ContactStart::touching(body), SampleTimes { duration, rate }, 1e-8)?;
            let exact = ContactLog::from_simulation(&scene, &run)?;
            let length = scene.body().semi_axes().element_sum() / 3.0;
            Ok(match estimated(&exact, length, first + k) {
                Ok(found) => {
                    let modes = modes(&found, &run, (G * length).sqrt());
                    format!("{} | {modes}", row(&errors(&found, &exact, &scene, length)))
                }
                Err(error) => format!("{error} | | | | | |"),
            })
        })?;
        row.iter().for_each(|row| println!("| {k} | {row} |"));
    }
    Ok(())
}

fn estimated(exact: &ContactLog, length: f64, seed: u64) -> Result<ContactEstimate, Box<dyn Error>> {
    let contact = NOISE.0 * length;
    let force = ChannelNoise { fixed: 0.0, share: NOISE.1 };
    let log = exact.with_noise(&ContactNoise { contact, force, ..ContactNoise::default() }, seed)?;
    let floor = FLOOR * (G * length).sqrt();
    let noise = ContactNoiseLevel { contact, force_fixed: 0.0, force_share: NOISE.1, impulse: None, floor };
    // As the command asks for it.
    let (suspects, mode_odds) = (true, true);
    let options = ContactOptions { suspects, mode_odds, ..ContactOptions::new(noise, G) };
    Ok(estimate_contacts(&log, None, &options)?)
}

fn errors(
    found: &ContactEstimate,
    exact: &ContactLog,
    scene: &ContactScene<Ellipsoid>,
    length: f64,
) -> Errors {
    let truth = exact.truth().unwrap_or_default();
    let (mut centre, mut velocity, mut squares, mut relied_on) = (0.0f64, 0.0f64, [0.0; 2], 0.0);
    for (k, (state, deviations)) in found.states.iter().zip(&found.deviations).enumerate() {
        let p = state.p_WCm - truth[k].p_WCm;
        let v = state.v_WCm - truth[k].v_WCm;
        if found.relied_on[k] {
            centre = centre.max((p / deviations[0]).abs().max_element());
            velocity = velocity.max((v / deviations[1]).abs().max_element());
            relied_on += 1.0 / found.states.len() as f64;
        }
        squares[0] += p.length_squared() / (length * length);
        squares[1] += v.length_squared() / (G * length);
    }
    let [p, v] = squares.map(|sum| (sum / found.states.len() as f64).sqrt());
    let mass = found.mass / scene.mass().mass() - 1.0;
    Errors {
        relied_on,
        chi_squared: found.evidence.misfit,
        centre,
        velocity,
        mass: mass.abs() / found.mass_deviation,
        of_natural: [p, v, mass.abs()],
    }
}

/// How the modes are, of contacts whose mode is one, and the coefficient of friction. `speed` is the natural one, m/s.
fn modes(found: &ContactEstimate, run: &ContactSimulation, speed: f64) -> String {
    let Some(odds) = &found.mode_odds else { return "none | |".to_owned() };
    let (mut all, mut right, mut wrong) = (0.0, 0.0, 0.0);
    for (now, odds) in run.instants.iter().zip(&odds.odds) {
        for (i, mode) in now.modes.iter().enumerate().filter(|(i, _)| !slides_and_sticks(now, *i, speed)) {
            let said = [odds[i].off, odds[i].slide, odds[i].stick];
            let of = said[usize::from(mode.number())];
            all += 1.0;
            right += f64::from(u8::from(said.iter().all(|other| *other <= of)));
            wrong += f64::from(u8::from(of < 0.01 && said.iter().any(|other| *other > 0.99)));
        }
    }
    let off = odds.frictions.iter().flatten().map(|of| {
        let off = (of.coefficient - FRICTION).abs();
        [off / FRICTION, off / of.deviation]
    });
    let [relative, deviations] = off.fold([0.0f64; 2], |[a, b], [c, d]| [a.max(c), b.max(d)]);
    let friction = format!("{:.1} %, {deviations:.1}", 100.0 * relative);
    format!("{:.3} | {:.4} | {friction}", right / all, wrong / all)
}

fn row(errors: &Errors) -> String {
    let [p, v, m] = errors.of_natural;
    format!(
        "{:.0} % | {:.2} | {:.1}, {:.1}, {:.1} | {p:.1e}, {v:.1e}, {m:.1e}",
        100.0 * errors.relied_on,
        errors.chi_squared,
        errors.centre,
        errors.velocity,
        errors.mass
    )
}
