//! The inner loops whose instructions are counted: a count repeats where a time does not.
//!
//! A program that counts the instructions of a process (`perf`, `valgrind`) runs one of them twice, with few repeats and with more; what lies
//! between is the loop's own, and the start of the process and of the loop is in neither. `cargo xtask instructions` does that.

use crate::fig5::Fig5;
use crate::streaming::some;
use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{ContactLog, SampleTimes, SensorNoise, ThreePalmScene};
use recon::observer::bank::{Bank, BankOptions, Memory};
use recon::observer::contact_modes::{ContactFriction, ContactModes, ContactModesOptions};
use recon::observer::contacts::stream::PlaneReadings;
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon_tests::belt::{Entry, belt_velocity, modes, run, start};
use recon_tests::contact_modes::drawn;
use shape_bounds::exact_hull::{HalfSpace, Hull, Intersection};
use shape_bounds::generators::{InputKind, curve_contacts};
use std::hint::black_box;

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// An inner loop.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// Its name in the table and on the command line.
    pub name: &'static str,
    /// What one repeat is.
    pub about: &'static str,
    /// Few repeats and more.
    pub repeats: [usize; 2],
    run: fn(usize) -> Result<(), Failure>,
}

/// All of them.
pub const KERNELS: &[Kernel] = &[
    kernel(
        "right_hand_side",
        "forces and accelerations of a body on three planes",
        [10, 110],
        right_hand_side,
    ),
    kernel("simulate", "0.1 s of Fig. 5 in minimal coordinates, tolerance 1e-10", [5, 25], simulate),
    kernel(
        "simulate_friction",
        "0.1 s of Fig. 5 with friction through contact modes, tolerance 1e-10",
        [5, 25],
        friction,
    ),
    kernel(
        "estimate",
        "the motion of Fig. 5 from a noisy log of 1,500 samples, body known",
        [1, 2],
        estimate,
    ),
    kernel("stream_sample", "a sample of a stream before its first motion", [40, 120], stream),
    kernel("bank_sample", "a sample of a bank of two modes, eight hypotheses", [50, 450], bank),
    kernel("modes_sample", "a sample of a contact's modes, friction known", [50, 450], contact_modes),
    kernel("hull", "hull of 10,000 points on three curves", [1, 2], hull),
    kernel("half_spaces", "intersection of 10,000 half-spaces", [1, 2], half_spaces),
];

const fn kernel(
    name: &'static str,
    about: &'static str,
    repeats: [usize; 2],
    run: fn(usize) -> Result<(), Failure>,
) -> Kernel {
    Kernel { name, about, repeats, run }
}

/// Runs one so often: `name` as in [`KERNELS`].
///
/// # Errors
/// A name that is none, and what the loop refuses, in words.
pub fn repeat(name: &str, count: usize) -> Result<(), String> {
    let kernel = KERNELS.iter().find(|kernel| kernel.name == name);
    let kernel = kernel.ok_or_else(|| format!("no inner loop is called {name:?}"))?;
    (kernel.run)(count).map_err(|error| format!("{name}: {error}"))
}

/// All of them, one a line: name, few repeats, more, and what one repeat is, between tabs.
#[must_use]
pub fn listed() -> String {
    let line = |Kernel { name, about, repeats: [few, more], .. }: &Kernel| {
        format!("{name}\t{few}\t{more}\t{about}\n")
    };
    KERNELS.iter().map(line).collect()
}

fn scene() -> (ThreePalmScene<Ellipsoid>, recon::object_dynamics::InitialMotion) {
    recon_tests::fig5(9.81)
}

fn right_hand_side(count: usize) -> Result<(), Failure> {
    let (scene, start) = scene();
    for _ in 0..count {
        black_box(scene.instant(black_box(0.0), start.R_WO, start.w_WO)?);
    }
    Ok(())
}

/// So many tenths of a second.
fn times(count: usize) -> SampleTimes {
    SampleTimes { duration: 0.1 * count as f64, rate: 10.0 }
}

fn simulate(count: usize) -> Result<(), Failure> {
    let (scene, start) = scene();
    black_box(scene.simulate(start, times(count), Tolerance::uniform(1e-10))?);
    Ok(())
}

fn friction(count: usize) -> Result<(), Failure> {
    let scene = Fig5::new(0.05, times(count)).map_err(|error| error.to_string())?;
    black_box(scene.general(1e-10)?);
    Ok(())
}

fn estimate(count: usize) -> Result<(), Failure> {
    let (scene, start) = scene();
    let times = SampleTimes { duration: 2.998, rate: 500.0 };
    let exact = scene.simulate(start, times, Tolerance::uniform(1e-10))?.sensor_log(&scene)?.split_truth().0;
    let noise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
    let log = ContactLog::try_from(&exact.with_noise(&noise, 1)?)?;
    let level = ContactNoiseLevel {
        contact: noise.contact,
        force_fixed: noise.force,
        force_share: 0.0,
        impulse: None,
        floor: 1e-4,
    };
    let options =
        ContactOptions { friction: Some(0.0), body: Some(*scene.mass()), ..ContactOptions::new(level, 9.81) };
    for _ in 0..count {
        black_box(estimate_contacts(&log, None, &options)?);
    }
    Ok(())
}

fn stream(count: usize) -> Result<(), Failure> {
    let cases = some(1, 61_000, 0.3, 200.0, [0.1, 1.0], [3.0, 16.0]).map_err(|error| error.to_string())?;
    let case = cases.first().ok_or("no body stands")?;
    let mut stream = case.stream(false).map_err(|error| error.to_string())?;
    let mut readings = PlaneReadings::new(None);
    for sample in case.samples.iter().take(count) {
        if let Some((t, sensed)) = readings.push(sample)? {
            black_box(stream.push(t, &sensed)?);
        }
    }
    Ok(())
}

fn bank(count: usize) -> Result<(), Failure> {
    let options = BankOptions { memory: Memory::Hypotheses(8), drop: 0.0, skip: 0.0, lag: 0 };
    let mut bank = Bank::new(modes(Entry::TRUE), &start(), options)?;
    for (k, (_, y)) in run(1, 500).into_iter().take(count).enumerate() {
        bank.push(&belt_velocity(k), &[Some(y)])?;
    }
    black_box(bank.probability(1));
    Ok(())
}

fn contact_modes(count: usize) -> Result<(), Failure> {
    let options = ContactModesOptions::new(1.0, 0.02, 1.0);
    let mut modes = ContactModes::new(&[ContactFriction::Known(0.3)], options)?;
    for moment in drawn(0.3, 500, 1).iter().take(count) {
        modes.push(moment.dt, &moment.seen)?;
    }
    black_box(modes.label(0));
    Ok(())
}

fn hull(count: usize) -> Result<(), Failure> {
    let points = InputKind::Curves.points(10_000, 1);
    for _ in 0..count {
        black_box(Hull::of(&points)?);
    }
    Ok(())
}

fn half_spaces(count: usize) -> Result<(), Failure> {
    let spaces: Vec<HalfSpace> = curve_contacts(10_000, 1).iter().map(|c| c.half_space()).collect();
    for _ in 0..count {
        black_box(Intersection::of(&spaces)?);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What the environment asks for, the list or `NAME=COUNT`, as `cargo xtask verify` does under a program that counts; else each one once.
    #[test]
    fn inner_loops_run() {
        match std::env::var("RECON_INNER_LOOP").ok().as_deref() {
            Some("list") => print!("\n{}", listed()),
            Some(asked) => {
                let (name, count) = asked.split_once('=').expect("NAME=COUNT");
                repeat(name, count.parse().expect("a number")).expect("it runs");
            }
            None => {
                KERNELS.iter().for_each(|kernel| repeat(kernel.name, 1).expect("it runs"));
                assert!(KERNELS.iter().all(|kernel| kernel.repeats[0] < kernel.repeats[1]));
                assert!(repeat("none of them", 1).is_err());
            }
        }
    }
}
