//! Exploration.
mod scenes;
use glam::{DQuat, DVec3};
use scenes::{World, scene};
use std::time::Instant;

type Failure = Box<dyn std::error::Error>;

fn run(world: &World, times: recon::object_dynamics::SampleTimes, tol: f64) -> Result<(Vec<(DVec3, DQuat)>, usize, usize), Failure> {
    Ok(match world {
        World::Space { scene, start } => {
            let run = scene.simulate(start, times, tol)?;
            (run.instants.iter().map(|i| (i.state.body.p_WCm, i.state.body.R_WO)).collect(), run.statistics.evaluations, run.events.len())
        }
        World::Plane { scene, start } => {
            let run = scene.simulate(start, &times.all()?, tol)?;
            (run.instants.iter().map(|i| (DVec3::new(i.body.p_WCm.x, 0.0, i.body.p_WCm.y), DQuat::from_rotation_y(-i.body.phi0))).collect(), run.statistics.evaluations, run.events.len())
        }
    })
}

fn off(a: &[(DVec3, DQuat)], b: &[(DVec3, DQuat)], size: f64) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a.0.distance(b.0) / size).max(a.1.angle_between(b.1))).fold(0.0, f64::max)
}

pub(crate) fn main() -> Result<(), Failure> {
    if crate::words().next().as_deref() == Some("b") { return logs(); }
    for kind in 0..3 {
        for seed in 1..8 {
            let Some(of) = scene(kind, seed)? else { continue };
            let Ok(truth) = run(&of.world, of.times, 3e-14) else { println!("{kind} {seed} no truth"); continue };
            println!("{} {seed} samples {} of {} events {}", of.kind, truth.0.len(), of.times.duration * of.times.rate, truth.2);
            for e in 2..13 {
                let tol = 10f64.powi(-e);
                let clock = Instant::now();
                let Ok(made) = run(&of.world, of.times, tol) else { println!("  {tol:e} failed"); continue };
                let us = clock.elapsed().as_secs_f64() * 1e6;
                let n = truth.0.len();
                let q = |k: usize| off(&made.0[..n * k / 8], &truth.0, of.size);
                println!("  {tol:e} {:>6} ev {us:>8.0} us  err/tol: 1/8 {:.1e} 1/4 {:.1e} 1/2 {:.1e} all {:.1e}  err {:.1e}", made.1, q(1) / tol, q(2) / tol, q(4) / tol, q(8) / tol, q(8));
            }
        }
    }
    Ok(())
}

use crate::whole_logs::body;
use cpu_time::ProcessTime;
use recon::object_dynamics::{ContactLog, SensorLog};
use recon::observer::{ContactEstimate, estimate_contacts};

fn every(log: &SensorLog, k: usize) -> Result<SensorLog, Failure> {
    Ok(SensorLog::new(log.samples().iter().copied().step_by(k).collect(), None)?)
}

fn bound(found: &ContactEstimate, size: f64) -> [f64; 2] {
    let n = found.deviations.len() as f64;
    [0, 3].map(|i| (found.deviations.iter().map(|d| d[i].length_squared()).sum::<f64>() / n).sqrt() / if i == 0 { size } else { 1.0 })
}

pub(crate) fn logs() -> Result<(), Failure> {
    for (noise, rate, seconds) in [(0.001, 1000.0, 3.0), (0.01, 1000.0, 3.0), (0.0, 1000.0, 3.0), (1e-5, 1000.0, 3.0)] {
        for of in &body::some(4, 7)? {
            let Some((log, truth)) = of.log(noise, rate, seconds)? else { continue };
            println!("noise {noise} size {} samples {} natural times {:.1}", of.size, log.samples().len(), log.duration() / (of.size / 9.81).sqrt());
            for known in [true, false] {
                for k in [1, 2, 4, 8, 16, 32, 64] {
                    let part = ContactLog::try_from(&every(&log, k)?)?;
                    let mut options = crate::whole_logs::options(of, noise, known.then_some(of.mass));
                    if noise == 0.0 {
                        options.noise = recon::observer::ContactNoiseLevel::guessed(&part, 9.81, None).ok_or("no")?;
                    }
                    let mut line = format!("  known {known} every {k:>2}: ");
                    for suspects in [false, true] {
                        options.suspects = suspects;
                        let clock = ProcessTime::now();
                        let found = estimate_contacts(&part, None, &options);
                        let ms = clock.elapsed().as_secs_f64() * 1e3;
                        let Ok(found) = found else { line += "none"; continue };
                        if suspects { line += &format!(" with suspects {ms:.0} ms"); continue; }
                        let n = found.states.len() as f64;
                        let p = (found.states.iter().zip(truth.iter().step_by(k)).map(|(s, t)| s.p_WCm.distance_squared(t.p_WCm)).sum::<f64>() / n).sqrt() / of.size;
                        let t0 = truth[0].R_WO;
                        let f0 = found.states[0].R_WO;
                        let q = (found.states.iter().zip(truth.iter().step_by(k)).map(|(s, t)| (s.R_WO * f0.inverse()).angle_between(t.R_WO * t0.inverse()).powi(2)).sum::<f64>() / n).sqrt();
                        let [bp, bq] = bound(&found, of.size);
                        line += &format!("{:>5.0} ms nodes {:>4} it {:>3} bound {bp:.1e} {bq:.1e} err {p:.1e} {q:.1e} {}", ms, found.evidence.nodes, found.evidence.iterations[1], if found.reliability.is_reliable() { "" } else { "UNRELIABLE" });
                    }
                    println!("{line}");
                }
            }
        }
    }
    Ok(())
}
