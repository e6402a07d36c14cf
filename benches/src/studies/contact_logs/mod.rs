//! The reference logs of general contacts, simulated from their start: how far from the logs, and with which changes of modes.
//!
//! Arguments: the folder of the logs, seconds to simulate, tolerance, scenes. The palms' paths are splines through every
//! pose of the log; the commands of palms on springs are found from their paths and forces. Writes a Markdown table.
//!
//! Modes are told as the logs tell them: a contact sticks where its slip is below the log's tolerance.

pub(crate) mod log;

use log::{Anything, Log};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{BodyState, ContactScene, ContactSimulation, ContactStart, SampleTimes};
use std::path::{Path, PathBuf};

/// Changes of modes are the same when they are at most this far apart, s.
const APART: f64 = 2e-3;
pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seconds: f64 = words.next().map_or(Ok(1.0), |s| s.parse())?;
    let tolerance: f64 = words.next().map_or(Ok(1e-8), |s| s.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = (1..=8).map(|k| format!("S{k}")).collect();
    }
    println!("# Reference logs of any palms, simulated from their start");
    println!();
    println!(
        "Eight scenes that another simulator logged (one to four palms, friction, fingertips, cups, springs, blows): {seconds} s from \
         the log's first state at tolerance {tolerance:e}, the palms on splines through every pose of the log. Modes are told as \
         the logs tell them: a contact sticks where its slip is below the log's tolerance. A log's own departure is what its residuals of \
         Newton and Euler, integrated twice, move its contacts by, and how far they creep while they stick and sink in."
    );
    println!();
    println!(
        "| log | to first change (s) | departure until then (m) | the log's own until then: Newton and Euler, creep (m) | growth of a change of the start | changes in the log | same, within 2 ms, until the first other | same in all | first other (s) | departure until then (m) | steps | time (ms) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    for name in names {
        match one(&folder, &name, seconds, tolerance) {
            Ok(row) => println!("| {name} | {row} |"),
            Err(error) => println!("| {name} | {error} | | | | | | | | | | |"),
        }
    }
    Ok(())
}

fn one(folder: &Path, name: &str, seconds: f64, tolerance: f64) -> Anything<String> {
    let log = Log::read(folder, name)?;
    let scene = log.scene()?;
    let body = log.body(0)?;
    let started = std::time::Instant::now();
    let simulation = simulate(&log, &scene, body, seconds, tolerance)?;
    let spent = started.elapsed().as_secs_f64() * 1e3;
    let count = simulation.instants.len();
    let (theirs, ours) = (log.changes(count)?, changes(&log, &simulation));
    let same = same_changes(&theirs, &ours);
    let t = log.column("t")?;
    let first = theirs.first().map_or(t[count - 1], |change| change.t);
    let other = theirs.get(same).or(ours.get(same)).map_or(t[count - 1], |change| change.t);
    let [laws, creep] = log.own_departure(first)?;
    let growth = growth(&log, &scene, body, (first, tolerance))?;
    Ok(format!(
        "{first:.3} | {:.1e} | {laws:.1e}, {creep:.1e} | {growth:.1} | {} | {same} | {} | {other:.3} | {:.1e} | {} | {spent:.1}",
        departure(&log, &simulation, first)?,
        theirs.len(),
        matching(&theirs, &ours),
        departure(&log, &simulation, other)?,
        simulation.statistics.accepted,
    ))
}

/// How many changes of modes are the same from the start: palm, new mode, and time.
fn same_changes(theirs: &[log::Change], ours: &[log::Change]) -> usize {
    let same = |(a, b): &(&log::Change, &log::Change)| {
        a.palm == b.palm && a.mode == b.mode && (a.t - b.t).abs() <= APART
    };
    // Two palms that change within the tolerance may do so in either order.
    let mut left: Vec<&log::Change> = ours.iter().collect();
    let mut count = 0;
    for change in theirs {
        let Some(at) = left.iter().take(3).position(|other| same(&(change, other))) else { break };
        left.remove(at);
        count += 1;
    }
    count
}

/// How many changes of the log have one of ours of the same palm and mode within the tolerance, each of ours once.
fn matching(theirs: &[log::Change], ours: &[log::Change]) -> usize {
    let mut left: Vec<&log::Change> = ours.iter().collect();
    let taken = theirs.iter().filter(|change| {
        let same = |o: &&log::Change| {
            o.palm == change.palm && o.mode == change.mode && (o.t - change.t).abs() <= APART
        };
        left.iter().position(same).map(|at| left.remove(at)).is_some()
    });
    taken.count()
}

fn departure(log: &Log, simulation: &ContactSimulation, until: f64) -> Anything<f64> {
    let cm = log.vectors("cm", "")?;
    let before = simulation.instants.iter().zip(&cm).filter(|(now, _)| now.state.t <= until);
    Ok(before.map(|(now, cm)| (now.state.body.p_WCm - *cm).length()).fold(0.0, f64::max))
}

/// By how much a turn of 1e-7 rad of the body at the start has grown at a time.
fn growth<S: SupportFunction>(
    log: &Log,
    scene: &ContactScene<S>,
    body: BodyState,
    (at, tolerance): (f64, f64),
) -> Anything<f64> {
    let turn = 1e-7;
    let changed = BodyState { R_WO: glam::DQuat::from_rotation_x(turn) * body.R_WO, ..body };
    let end = |body| -> Anything<glam::DQuat> {
        let run = simulate(log, scene, body, at, tolerance)?;
        Ok(run.instants.last().ok_or("no sample")?.state.body.R_WO)
    };
    Ok(end(body)?.angle_between(end(changed)?) / turn)
}

/// Changes of modes at the samples, told as the logs tell them.
fn changes(log: &Log, simulation: &ContactSimulation) -> Vec<log::Change> {
    let mut found = Vec::new();
    let mode = |k: usize, i: usize| {
        let now = &simulation.instants[k];
        match now.modes[i].number() {
            0 => 0,
            _ if now.rates[i].slip.length() < log.slip_tolerance() => 2,
            _ => 1,
        }
    };
    for k in 1..simulation.instants.len() {
        for i in 0..log.palm_count() {
            if mode(k, i) != mode(k - 1, i) {
                found.push(log::Change { t: simulation.instants[k].state.t, palm: i, mode: mode(k, i) });
            }
        }
    }
    found
}

fn simulate<S: SupportFunction>(
    log: &Log,
    scene: &ContactScene<S>,
    body: BodyState,
    seconds: f64,
    tolerance: f64,
) -> Anything<ContactSimulation> {
    let start = ContactStart { body, palms: Some(log.palm_coordinates(0)?), in_flight: false };
    Ok(scene.simulate(&start, SampleTimes { duration: seconds, rate: 1000.0 }, tolerance)?)
}
