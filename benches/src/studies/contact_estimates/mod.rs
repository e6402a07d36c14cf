//! Motion, mass and inertia from the reference logs of any palms, from no guess.

use super::contact_logs::log::{Anything, Log};
use glam::{DMat3, DQuat};
use recon::object_dynamics::{ChannelNoise, ContactNoise};
use recon::observer::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use std::path::PathBuf;

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let contact: f64 = words.next().map_or(Ok(0.0), |s| s.parse())?;
    let share: f64 = words.next().map_or(Ok(0.0), |s| s.parse())?;
    let seconds: f64 = words.next().map_or(Ok(1.8), |s| s.parse())?;
    let seeds: u64 = words.next().map_or(Ok(1), |s| s.parse())?;
    let floor: f64 = words.next().map_or(Ok(1e-3), |s| s.parse())?;
    let names: Vec<String> = words.collect();
    println!("| log | iterations | settled | cost | cm (l) | v | w | turn (rad) | mass | K | ms |");
    for name in names {
        let log = Log::read(&folder, &name)?;
        for seed in 0..seeds {
            one(&name, &log, (contact, share, seconds, seed, floor))?;
        }
    }
    Ok(())
}

fn one(
    name: &str,
    file: &Log,
    (contact, share, seconds, seed, floor): (f64, f64, f64, u64, f64),
) -> Anything<()> {
    let (log, modes) = file.contact_log(seconds)?;
    let axes = file.semi_axes();
    let l = (axes.x + axes.y + axes.z) / 3.0;
    let g = 9.81;
    let log = if contact > 0.0 || share > 0.0 {
        let noise = ContactNoise {
            contact: 2.0 * l * contact,
            force: ChannelNoise { fixed: 0.0, share },
            ..Default::default()
        };
        log.with_noise(&noise, seed)?
    } else {
        log
    };
    let noise = ContactNoiseLevel {
        contact: 2.0 * l * contact,
        force_fixed: 0.0,
        force_share: share,
        floor: floor * (g * l).sqrt(),
    };
    let size = (file.palm_count() == 1).then_some(0.8 * l);
    let options = ContactOptions { noise, gravity: g, size };
    let started = std::time::Instant::now();
    let found = estimate_contacts(&log, &modes, &options)?;
    let ms = started.elapsed().as_secs_f64() * 1e3;
    let errors = errors(file, &found, l, g)?;
    println!(
        "| {name} | {:?} | {} | {:.3} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {ms:.0} | {:.1e} {:.1?} {:.1e}",
        found.iterations,
        found.settled,
        found.chi_squared / found.conditions as f64,
        errors[0],
        errors[1],
        errors[2],
        errors[3],
        errors[4],
        errors[5],
        found.mass_deviation,
        found.inertia_deviations,
        found.deviations[found.nodes.len() / 2][0].length() / l
    );
    Ok(())
}

fn errors(file: &Log, found: &ContactEstimate, l: f64, g: f64) -> Anything<[f64; 6]> {
    let mut sums = [0.0; 4];
    let truth = |k: usize| file.body(k);
    let first = truth(0)?.R_WO;
    let (cm, v, w, q) =
        (file.vectors("cm", "")?, file.vectors("v", "")?, file.vectors("w", "")?, file.quaternions("q", "")?);
    for (state, &k) in found.states.iter().zip(&found.nodes) {
        sums[0] += ((state.p_WCm - cm[k]) / l).length_squared();
        sums[1] += (state.v_WCm - v[k]).length_squared() / (g * l);
        sums[2] += (state.w_WO - w[k]).length_squared() * l / g;
        let turn: DQuat = state.R_WO * (q[k] * first.conjugate()).conjugate();
        sums[3] += turn.to_scaled_axis().length_squared();
    }
    let [a, b, c, d] = sums.map(|s| (s / found.nodes.len() as f64).sqrt());
    let (mass, inertia) = file.mass();
    let R = DMat3::from_quat(first);
    let ratio = (R * inertia * R.transpose()) * found.inertia.inverse();
    let K = (ratio - DMat3::IDENTITY).to_cols_array().iter().map(|x| x * x).sum::<f64>().sqrt() / 3f64.sqrt();
    Ok([a, b, c, d, (found.mass / mass - 1.0).abs(), K])
}
