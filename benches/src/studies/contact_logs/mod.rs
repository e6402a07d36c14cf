//! The reference logs of general contacts, simulated from their start: how far from the logs, and with which changes of modes.
//!
//! Arguments: the folder of the logs, seconds to simulate, tolerance, scenes. The palms' paths are splines through every
//! pose of the log; the commands of palms on springs are found from their paths and forces. Writes a Markdown table.
//!
//! Modes are told as the logs tell them: a contact sticks where its slip is below the log's tolerance.

mod changes;
mod growth;
pub(crate) mod log;
mod own;
mod rebounds;

use changes::{changes, matching, nearest, same_changes};
use growth::{Natural, growths};
use log::{Anything, Log};
use own::{Own, own_departures};
use rebounds::{Restart, restarts, told_after_rebound};
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{BodyState, ContactScene, ContactSimulation, ContactStart, SampleTimes};
use std::path::{Path, PathBuf};

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
         the logs tell them: a contact sticks where its slip is below the log's tolerance. A departure is that of the centre of \
         mass, and of the orientation at the body's mean semi-axis."
    );
    println!();
    println!(
        "| log | to first change (s) | departure until then (m) | changes in the log | same, within 2 ms, until the first other | same in all | first other (s) | departure until then (m) | steps | time (ms) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let compared: Vec<_> =
        names.iter().map(|name| (name, Compared::new(&folder, name, seconds, tolerance))).collect();
    for (name, compared) in &compared {
        match compared {
            Ok(compared) => println!("| {name} | {} |", compared.row()),
            Err(error) => println!("| {name} | {error} | | | | | | | | |"),
        }
    }
    println!();
    println!("## What a log's own departures explain");
    println!();
    println!(
        "A log departs from rigid bodies by its residuals of Newton and Euler and of Coulomb's law, both integrated twice and taken to \
         the most distant contact, and by its softness: how far its contacts sink in, and creep while they stick. What softness moves \
         grows: the growth is that of the worst change of place or velocity at the start that the contacts allow, from runs \
         moved along twelve directions by 1e-5 in natural units, up to the time named. The ratio is the largest until that time of our departure over \
         (Newton and Euler + softness times growth + our tolerance), and over that and Coulomb's law, with the time (s) at which it is so large."
    );
    println!();
    println!(
        "| log | until (s) | Newton and Euler (m) | Coulomb (m) | softness (m) | growth of place, of velocity | departure (m) | ratio | ratio with Coulomb |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, compared) in &compared {
        let Ok(compared) = compared else { continue };
        for row in compared.explained() {
            println!("| {name} | {row} |");
        }
    }
    println!();
    println!("## Landings that a log rebounds from");
    println!();
    println!(
        "Contacts of a log that close and are open again within three samples: the speeds at which the gap closes before and opens \
         after. Runs are from the log's own state as soon after it as every contact is closed or clearly open, until the next such \
         landing or the end."
    );
    println!();
    println!(
        "| log | palm | lands (s) | comes at (m/s) | leaves at (m/s) | share | run (s) | changes | same, within 2 ms | departure (m) |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (name, compared) in &compared {
        for restart in compared.iter().flat_map(|compared| &compared.restarts) {
            println!("| {name} | {} |", restart.row());
        }
    }
    println!();
    println!(
        "Changes of modes that are not the same: the log's, ours of the same palm and mode nearest to it, by how much a change of \
         the slip by softness times growth of velocity shifts it, and what the run from the log's state after its last rebound has of it."
    );
    println!();
    println!(
        "| log | log's (s) | palm | mode | ours (s) | apart (ms) | by softness (ms) | after the rebound |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for (name, compared) in &compared {
        for row in compared.iter().flat_map(|compared| &compared.others) {
            println!("| {name} | {row} |");
        }
    }
    Ok(())
}

/// A log beside its simulation.
struct Compared {
    theirs: Vec<log::Change>,
    ours: Vec<log::Change>,
    /// Samples, departures and what the log is off by itself until each.
    t: Vec<f64>,
    departures: Vec<f64>,
    own: Vec<Own>,
    growths: Vec<[f64; 2]>,
    /// Runs from the log's states after landings that it rebounds from.
    restarts: Vec<Restart>,
    /// Rows of changes that are not the same.
    others: Vec<String>,
    /// Our own error: the tolerance, m.
    error: f64,
    steps: usize,
    /// ms.
    spent: f64,
}

impl Compared {
    fn new(folder: &Path, name: &str, seconds: f64, tolerance: f64) -> Anything<Self> {
        let log = Log::read(folder, name)?;
        let scene = log.scene()?;
        let started = std::time::Instant::now();
        let simulation = simulate(&log, &scene, log.body(0)?, seconds, tolerance)?;
        let spent = started.elapsed().as_secs_f64() * 1e3;
        let count = simulation.instants.len();
        let (natural, bodies) = (Natural::of(&log), log.bodies(count)?);
        let pairs = simulation.instants.iter().zip(&bodies);
        let mut compared = Self {
            theirs: log.changes(count)?,
            ours: changes(&log, &simulation),
            t: log.column("t")?[..count].to_vec(),
            departures: pairs.map(|(now, body)| natural.apart(&now.state.body, body)).collect(),
            own: own_departures(&log, count)?,
            growths: growths(&log, &scene, &simulation, (seconds, tolerance))?,
            restarts: restarts(&log, count, tolerance)?,
            others: Vec::new(),
            error: tolerance * natural.length,
            steps: simulation.statistics.accepted,
            spent,
        };
        compared.others = compared.other_changes(&log)?;
        Ok(compared)
    }

    /// The first change in the log, and the first that is not the same; else the end.
    fn stages(&self) -> [f64; 2] {
        let end = self.t[self.t.len() - 1];
        let same = same_changes(&self.theirs, &self.ours);
        let other = self.theirs.get(same).or(self.ours.get(same));
        [self.theirs.first().map_or(end, |change| change.t), other.map_or(end, |change| change.t)]
    }

    fn until(&self, time: f64) -> usize {
        self.t.partition_point(|t| *t <= time)
    }

    fn departure(&self, until: f64) -> f64 {
        self.departures[..self.until(until)].iter().copied().fold(0.0, f64::max)
    }

    fn row(&self) -> String {
        let [first, other] = self.stages();
        format!(
            "{first:.3} | {:.1e} | {} | {} | {} | {other:.3} | {:.1e} | {} | {:.1}",
            self.departure(first),
            self.theirs.len(),
            same_changes(&self.theirs, &self.ours),
            matching(&self.theirs, &self.ours).len(),
            self.departure(other),
            self.steps,
            self.spent,
        )
    }

    /// A row for each stage and the whole.
    fn explained(&self) -> Vec<String> {
        let [first, other] = self.stages();
        let mut stages = vec![first, other, self.t[self.t.len() - 1]];
        stages.dedup();
        let row = |until: f64| {
            let k = self.until(until) - 1;
            let mut ratios = [(0.0_f64, 0.0); 2];
            for k in 0..=k {
                let (own, [growth, _]) = (self.own[k], self.growths[k]);
                let soft = self.error + own.laws + own.softness * growth;
                for (ratio, allowed) in ratios.iter_mut().zip([soft, soft + own.coulomb]) {
                    let now = self.departures[k] / allowed;
                    *ratio = if now > ratio.0 { (now, self.t[k]) } else { *ratio };
                }
            }
            let (own, [place, velocity]) = (self.own[k], self.growths[k]);
            format!(
                "{until:.3} | {:.1e} | {:.1e} | {:.1e} | {place:.1}, {velocity:.1} | {:.1e} | {:.2} ({:.3}) | {:.2} ({:.3})",
                own.laws,
                own.coulomb,
                own.softness,
                self.departure(until),
                ratios[0].0,
                ratios[0].1,
                ratios[1].0,
                ratios[1].1,
            )
        };
        stages.into_iter().map(row).collect()
    }

    /// Changes of the log that have none of ours, told beside the nearest.
    fn other_changes(&self, log: &Log) -> Anything<Vec<String>> {
        let same = matching(&self.theirs, &self.ours);
        let rate = Natural::of(log).rate;
        let mut rows = Vec::new();
        for change in self.theirs.iter().enumerate().filter(|(i, _)| !same.contains(i)).map(|(_, c)| c) {
            let k = self.until(change.t + 0.5 * (self.t[1] - self.t[0])) - 1;
            let slip = log.contact(change.palm + 1)?.slip;
            let slope = (slip[k] - slip[k - 1]) / (self.t[k] - self.t[k - 1]);
            let shift = self.own[k].softness * rate * self.growths[k][1] / slope.abs();
            let told = |o: &log::Change| format!("{:.3} | {:.0}", o.t, (o.t - change.t) * 1e3);
            let ours = nearest(change, &self.ours).map_or_else(|| "none | -".to_owned(), told);
            rows.push(format!(
                "{:.3} | {} | {} | {ours} | {:.1} | {}",
                change.t,
                change.palm + 1,
                ["off", "slides", "sticks"][usize::from(change.mode.min(2))],
                shift * 1e3,
                told_after_rebound(change, &self.restarts),
            ));
        }
        Ok(rows)
    }
}

fn simulate<S: SupportFunction>(
    log: &Log,
    scene: &ContactScene<S>,
    body: BodyState,
    seconds: f64,
    tolerance: f64,
) -> Anything<ContactSimulation> {
    let start = ContactStart { body, palms: Some(log.palm_coordinates(0)?), in_flight: true };
    Ok(scene.simulate(&start, SampleTimes { duration: seconds, rate: 1000.0 }, tolerance)?)
}
