//! Cold start on random scenes without noise: how many come out right from no guess, and how long they take; with mass and
//! inertia known, and with nothing known.
//!
//! Usage: `cold_start [SCENES]` (200 by default). Prints tables in Markdown.

use cpu_time::ThreadTime;
use glam::DQuat;
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    ContactLog, InitialMotion, MassProperties, SampleTimes, SensorLog, Simulation, ThreePalmScene,
};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon::observer::reliability::{Reason, Reliability};
use recon_tests::Random;
use std::collections::BTreeMap;

/// Error of the centre of mass that counts as right, m, and of the mass, relative.
const RIGHT: f64 = 1e-6;

type Failure = Box<dyn std::error::Error>;

/// Milliseconds, the error of an estimate, and why it is not relied on.
type Run = (f64, Option<f64>, Option<String>);

/// What became of the scenes.
#[derive(Default)]
struct Tally {
    right: usize,
    silent: usize,
    /// Why estimates that are wrong say that they are not to be relied on.
    reasons: BTreeMap<String, usize>,
    /// Right, and yet not relied on.
    doubted: usize,
    times: Vec<f64>,
}

impl Tally {
    fn add(&mut self, run: Option<Run>) {
        let Some((milliseconds, error, doubt)) = run else { return };
        self.times.push(milliseconds);
        let right = error.is_some_and(|error| error < RIGHT);
        self.right += usize::from(right);
        match doubt {
            Some(_) if right => self.doubted += 1,
            Some(why) => *self.reasons.entry(why).or_default() += 1,
            None => self.silent += usize::from(!right),
        }
    }

    fn row(&mut self, name: &str) -> String {
        self.times.sort_by(f64::total_cmp);
        let last = self.times.len() as f64 - 1.0;
        let share = |p: f64| self.times.get((last * p) as usize).copied().unwrap_or(f64::NAN);
        let (median, most, slowest) = (share(0.5), share(0.9), share(1.0));
        let reported: usize = self.reasons.values().sum();
        format!(
            "| {name} | {} | {} | {} | {reported} | {} | {median:.0} | {most:.0} | {slowest:.0} |",
            self.times.len(),
            self.right,
            self.doubted,
            self.silent
        )
    }
}

fn kind(reason: &Reason) -> &'static str {
    match reason {
        Reason::NotConverged { .. } => "the fit did not settle",
        Reason::Still { .. } => "hardly turns",
        Reason::Ambiguous { .. } => "another motion as good",
        Reason::Unconfirmed => "not confirmed without the stated body",
        Reason::TooShort { .. } => "too short for its noise",
        Reason::TooSparse { .. } => "samples too far apart",
        Reason::Fault(_) => "a constant of the sensors is not as stated",
        Reason::OtherBody { .. } => "another body than was stated",
        Reason::Inconsistent { .. } => "data and motion disagree",
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    let scenes: usize = crate::words().next().map_or(Ok(200), |a| a.parse())?;
    let mut random = Random::new(1);
    let mut tallies = [Tally::default(), Tally::default()];
    let mut count = 0;
    while count < scenes {
        let Some((scene, simulation, log)) = scene(&mut random)? else { continue };
        count += 1;
        let (mass, gravity) = (*scene.mass(), scene.gravity().length());
        for (tally, body) in tallies.iter_mut().zip([Some(mass), None]) {
            tally.add(crate::rows::row(|| -> Result<Run, Failure> {
                let clock = ThreadTime::now();
                let found = contacts(&log, body, gravity);
                let milliseconds = 1e3 * clock.elapsed().as_secs_f64();
                let Ok(found) = found else { return Ok((milliseconds, None, Some("singular".to_owned()))) };
                let of_mass = (found.mass / mass.mass() - 1.0).abs();
                let pairs = found.states.iter().zip(&simulation.instants);
                let error = pairs.map(|(s, now)| s.p_WCm.distance(now.touch.p_WCm)).fold(of_mass, f64::max);
                let doubt = match &found.reliability {
                    Reliability::Unreliable(reasons) => Some(reasons.first().map_or("no reason", kind)),
                    _ => None,
                };
                Ok((milliseconds, Some(error), doubt.map(str::to_owned)))
            })?);
        }
    }
    println!("# Cold start on random scenes\n\nMade by `cargo xtask study cold_start {scenes}`.\n");
    println!(
        "Ellipsoids of semi-axes 1 to 2.5 m on three palms, spin up to 1.4 rad/s, 1 to 4 s at 1 kHz without noise. Right: \
         centre of mass within {RIGHT:e} m over the whole log, and mass within {RIGHT:e} of itself. \
         Times are thread time.\n"
    );
    println!(
        "| mass and inertia | scenes | right | right but doubted | wrong and reported | wrong in silence | median ms | 90 % ms | slowest ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    let names = ["known", "unknown"];
    for (name, tally) in names.into_iter().zip(&mut tallies) {
        println!("{}", tally.row(name));
    }
    for (name, tally) in names.into_iter().zip(&tallies) {
        if !tally.reasons.is_empty() {
            println!("\nReasons reported with {name} mass and inertia:");
        }
        for (reason, count) in &tally.reasons {
            println!("- {count}: {reason}");
        }
    }
    Ok(())
}

/// The estimate of which nothing is said but that there is no friction.
fn contacts(log: &SensorLog, body: Option<MassProperties>, gravity: f64) -> Result<ContactEstimate, Failure> {
    let log = ContactLog::try_from(log)?;
    let noise = ContactNoiseLevel::guessed(&log, gravity, None).ok_or("no two palms are touched at once")?;
    let options = ContactOptions { friction: Some(0.0), body, ..ContactOptions::new(noise, gravity) };
    Ok(estimate_contacts(&log, None, &options)?)
}

/// A random scene with its motion and log; none if it loses contact within a second.
fn scene(random: &mut Random) -> Result<Option<(ThreePalmScene<Ellipsoid>, Simulation, SensorLog)>, Failure> {
    let axes = random.vector(1.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(random.within(0.5, 2.5), axes)?;
    let mut palms = Vec::with_capacity(3);
    for k in 0..3 {
        let azimuth = f64::from(k) * std::f64::consts::TAU / 3.0 + random.within(-0.3, 0.3);
        palms.push(Palm::fixed(azimuth, random.within(0.8, 1.2))?);
    }
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, [palms[0], palms[1], palms[2]], 9.81)?;
    let start = InitialMotion {
        R_WO: DQuat::from_scaled_axis(random.vector(-3.0, 3.0)),
        w_WO: random.vector(-0.8, 0.8),
    };
    let times = SampleTimes { duration: 4.0, rate: 1000.0 };
    let Ok(simulation) = scene.simulate(start, times, Tolerance::uniform(1e-13)) else { return Ok(None) };
    if simulation.instants.len() < 1000 {
        return Ok(None);
    }
    let log = simulation.sensor_log(&scene)?.split_truth().0;
    Ok(Some((scene, simulation, log)))
}
