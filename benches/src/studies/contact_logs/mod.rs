//! The reference logs of general contacts, simulated from their start: how far from the logs, and with which changes of modes.
//!
//! Arguments: the folder of the logs, seconds to simulate, scenes. The palms' paths are splines through every 10th pose of the
//! log; the commands of palms on springs are found from their paths and forces.

mod log;

use log::{Anything, Log};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{ContactScene, ContactSimulation, ContactStart, SampleTimes};
use std::path::PathBuf;

const TOLERANCE: f64 = 1e-10;

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seconds: f64 = words.next().map_or(Ok(1.0), |s| s.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = (1..=8).map(|k| format!("S{k}")).collect();
    }
    for name in names {
        if let Err(error) = one(&folder, &name, seconds) {
            println!("{name}: {error}");
        }
    }
    Ok(())
}

fn one(folder: &std::path::Path, name: &str, seconds: f64) -> Anything<()> {
    let log = Log::read(folder, name)?;
    let scene = log.scene(10)?;
    let started = std::time::Instant::now();
    let simulation = simulate(&log, &scene, seconds)?;
    let spent = started.elapsed();
    println!("{name}: {} events, {:?}, {spent:?}", simulation.events.len(), simulation.statistics);
    let mut modes: Vec<Vec<f64>> = Vec::new();
    for i in 1..=log.palm_count() {
        modes.push(log.column(&format!("mode_{i}"))?.to_vec());
    }
    let t = log.column("t")?;
    let cm = log.vectors("cm", "")?;
    for k in 1..simulation.instants.len() {
        let of = |k: usize| modes.iter().map(|m| m[k] as u8).collect::<Vec<_>>();
        if of(k) != of(k - 1) {
            let now = &simulation.instants[k].state.body;
            println!(
                "  log {:.3}: {:?} -> {:?}; departure {:.1e}",
                t[k],
                of(k - 1),
                of(k),
                (now.p_WCm - cm[k]).length()
            );
        }
    }
    for event in &simulation.events {
        let modes: Vec<u8> = event.modes.iter().map(|m| m.number()).collect();
        println!("  sim {:.4}: palm {} {:?} -> {modes:?}", event.t, event.palm + 1, event.kind);
    }
    for k in [100, 200, 400, 700, 1000] {
        if let Some(now) = simulation.instants.get(k) {
            println!("  t = {}: departure {:.2e} m", t[k], (now.state.body.p_WCm - cm[k]).length());
        }
    }
    Ok(())
}

fn simulate<S: SupportFunction>(
    log: &Log,
    scene: &ContactScene<S>,
    seconds: f64,
) -> Anything<ContactSimulation> {
    let start = ContactStart { body: log.body(0)?, palms: Some(log.palm_coordinates(0)?), in_flight: false };
    Ok(scene.simulate(&start, SampleTimes { duration: seconds, rate: 1000.0 }, TOLERANCE)?)
}
