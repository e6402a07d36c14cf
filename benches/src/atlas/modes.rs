//! Contact modes from forces and slips, sample by sample.

use super::judged::Ran;
use super::{Failure, Method, Way};
use nalgebra::{Matrix2, Vector2};
use recon::observer::contact_modes::{ContactFriction, ContactModes, ContactModesOptions, ContactSeen};
use recon_tests::Random;
use recon_tests::contact_modes::{Moment, classify, drawn};

const SAMPLES: usize = 1000;
const FRICTION: f64 = 0.3;
/// Share of the samples that may be told with more than 0.99 and wrong.
const WRONG: f64 = 0.01;
/// Share of the samples whose likeliest mode must be true, else nothing is told.
const TOLD: f64 = 0.6;

pub(super) const METHOD: Method = Method {
    name: "contact modes",
    about: "one contact that sticks and slides at 1 kHz, friction known; right: at most one sample in a hundred told with more than 0.99 and wrong; reported: the likeliest mode is the true one at less than six in ten",
    ways: {
        use Way::*;
        &[Unstated, Bias, Gain, Delay, Correlation, Gap, Dropped, Coefficient, Friction]
    },
    seeds: 30,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let friction = if way == Way::Friction { strength } else { FRICTION };
    let mut moments = drawn(friction, SAMPLES, seed);
    changed(&mut moments, way, strength, seed);
    let stated = if way == Way::Coefficient { friction * (1.0 + strength) } else { friction };
    let options = ContactModesOptions::new(1.0, 0.02, 1.0);
    let mut modes = match ContactModes::new(&[ContactFriction::Known(stated)], options) {
        Ok(modes) => modes,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    Ok(match classify(&mut modes, &moments) {
        Err(error) => Ran::refused(&error),
        Ok(score) => {
            let open = (score.right() < TOLD).then(|| "modes are left open".to_owned());
            let wrong = score.confident_and_wrong() / WRONG;
            // What is confident and wrong is no doubt.
            let doubt = modes.doubts().next().map(|doubt| doubt.to_string());
            Ran::Found { off: wrong, doubt: doubt.or(open.filter(|_| wrong <= 1.0)) }
        }
    })
}

fn changed(moments: &mut Vec<Moment>, way: Way, strength: f64, seed: u64) {
    let mut random = Random::new(seed ^ 0x70AD);
    let original = moments.clone();
    let (mut held, fresh) = ([Vector2::zeros(); 2], (1.0 - strength * strength).max(0.0).sqrt());
    for (k, moment) in moments.iter_mut().enumerate() {
        let Some(ContactSeen::Read(reading)) = moment.seen.first_mut() else { continue };
        match way {
            Way::Unstated => {
                reading.force_deviation /= strength;
                if let Some(slip) = &mut reading.slip {
                    slip.covariance /= strength * strength;
                }
            }
            Way::Bias => reading.friction.x += strength,
            Way::Gain => reading.friction *= 1.0 + strength,
            Way::Delay => {
                // A natural time is that of 5 cm.
                let late = (strength * (0.05_f64 / super::G).sqrt() / moment.dt) as usize;
                if let Some(ContactSeen::Read(old)) = original[k.saturating_sub(late)].seen.first() {
                    (reading.friction, reading.normal_force) = (old.friction, old.normal_force);
                }
            }
            Way::Correlation => {
                let mut draw = |deviation: f64| {
                    let mut sum = || (0..12).map(|_| random.within(-0.5, 0.5)).sum::<f64>();
                    Vector2::new(sum(), sum()) * deviation
                };
                let fresh = if k == 0 { 1.0 } else { fresh };
                let parts = [draw(reading.force_deviation), draw(3.6e-3)];
                for (held, part) in held.iter_mut().zip(parts) {
                    *held = *held * if k == 0 { 0.0 } else { strength } + part * fresh;
                }
                // Beside the noise that is there, and stated as a whole: what is not as stated is that it lasts.
                reading.friction += held[0];
                reading.force_deviation *= std::f64::consts::SQRT_2;
                if let Some(slip) = &mut reading.slip {
                    slip.velocity += held[1];
                    slip.covariance += Matrix2::identity() * 3.6e-3 * 3.6e-3;
                }
            }
            _ => {}
        }
    }
    let natural = (0.05_f64 / super::G).sqrt();
    let middle = 0.5 * SAMPLES as f64 * 1e-3;
    let mut t = 0.0;
    let mut since = 0.0;
    moments.retain_mut(|moment| {
        (t, since) = (t + moment.dt, since + moment.dt);
        let lost = match way {
            Way::Gap => (t - middle).abs() < 0.5 * strength * natural,
            Way::Dropped => random.within(0.0, 1.0) < strength,
            _ => false,
        };
        if !lost {
            moment.dt = std::mem::take(&mut since);
        }
        !lost
    });
}
