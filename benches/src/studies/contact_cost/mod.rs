//! Cost of simulated contacts beside MuJoCo, with the error that it buys: the paper's Fig. 5 with friction and without.
//!
//! Usage: `contact_cost [REPEATS] [FOLDER]` (5 runs of the peer; charts into `docs/charts`). Needs Python with MuJoCo for the
//! peer's rows, which are left out without. Prints a page in Markdown.

mod mujoco;

use glam::{DQuat, DVec3};
use mujoco::{Run, front};
use recon::object_dynamics::SampleTimes;
use recon_benches::fig5::{Fig5, Pose, largest_error};
use recon_benches::{Axis, Budget, Diagram, Method, Outcome, Study, WorkPrecision, machine_line};
use std::path::Path;

/// Of the log S1, which another solver of rigid contacts made.
const FRICTION: f64 = 0.05;
/// Its poses, every 0.1 s.
const LOG: &str = include_str!("../../../../tests/data/poses_S1.csv");
const EXACT: f64 = 1e-13;
const WAYS: &str = "\
MuJoCo in two ways, each at the best settings found for every step (`benches/peers/contacts_mujoco.py`): `constraints` are hard, as it is
commonly set up; the convex cone couples slip into their normal row, and a sliding contact hovers by as much as friction and
damping lift it. `springs` are as soft as it takes them (impedance 1e-4 or 1e-3): spring and damper, and friction that is
viscous up to Coulomb's bound.";
/// Error within which the costs are compared in a word.
const ASKED: f64 = 1e-6;

type Anything<T> = Result<T, Box<dyn std::error::Error>>;

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let repeats: usize = words.next().map_or(Ok(5), |word| word.parse())?;
    let folder = words.next().unwrap_or_else(|| "docs/charts".to_owned());
    println!("# Cost of contacts\n\nMade by `cargo xtask study contact_cost`.\n");
    println!(
        "The paper's Fig. 5: an ellipsoid of semi-axes 2.5, 2, 1 m, 1 kg, spins on three flat palms at 60 degrees. Errors are the \
         largest of position (m) and orientation (rad) at the samples. Costs are wall time per simulated second, the fastest of \
         many runs (MuJoCo: of {repeats}), one thread, all in one run on a shared machine ({}).",
        machine_line()
    );
    println!("\n{WAYS}");
    with_friction(repeats, Path::new(&folder))?;
    without_friction(repeats)?;
    Ok(())
}

fn with_friction(repeats: usize, folder: &Path) -> Anything<()> {
    let scene = Fig5::new(FRICTION, SampleTimes { duration: 1.0, rate: 10.0 })?;
    let exact = scene.general(EXACT)?;
    println!("\n## With friction {FRICTION}\n\n1 s, every 0.1 s, all contacts sliding.\n");
    println!(
        "Reference: our own at tolerance {EXACT:e}, which is {:.0e} from that at 1e-14, and {:.1e} from the log S1 (another solver \
         of rigid contacts, with friction smoothed over 0.1 ms).\n",
        largest_error(&scene.general(1e-14)?, &exact),
        largest_error(&log()?, &exact)
    );
    let ours = ours(&scene, &exact)?;
    table(&ours);
    let theirs = mujoco::measure(&scene, &exact, repeats)?;
    let mut chart =
        WorkPrecision::new("contact-cost", "An ellipsoid slides with friction: cost against error")
            .subtitle("pose error over 1 s of the paper's Fig. 5, friction 0.05; points: tolerance or step")
            .axes(Axis::log("pose error", "m, rad"), Axis::log("cost", "ms per simulated second"))
            .methods(ours.clone());
    if let Some((version, runs)) = &theirs {
        peer_table(version, runs, &ours);
        chart = chart.methods(curves(version, runs));
        if let Some(run) = cheapest_run(runs, ASKED) {
            chart = chart.goal("1/100 of MuJoCo", ASKED, run.ms / 100.0);
        }
    }
    Diagram::from(chart).save(folder)?;
    println!("\n![Cost against error](charts/contact-cost.svg)");
    Ok(())
}

fn without_friction(repeats: usize) -> Anything<()> {
    // As long as the paper's figure, on which minimal coordinates were measured before.
    let scene = Fig5::new(0.0, SampleTimes { duration: 4.2, rate: 5.0 })?;
    let exact = scene.minimal(1e-14)?;
    println!(
        "\n## Without friction\n\n4.2 s, every 0.2 s. Reference: minimal coordinates at tolerance 1e-14.\n"
    );
    let ours = ours(&scene, &exact)?;
    table(&ours);
    if let Some((version, runs)) = mujoco::measure(&scene, &exact, repeats)? {
        peer_table(&version, &runs, &ours);
    }
    Ok(())
}

/// Simulation through contact modes, and minimal coordinates where there is no friction.
fn ours(scene: &Fig5, exact: &[Pose]) -> Anything<Vec<Method>> {
    let mut study = Study::new();
    for exponent in 3..=12 {
        let (tolerance, setting) = (10f64.powi(-exponent), format!("1e-{exponent}"));
        let error = |poses: &Vec<Pose>| largest_error(poses, exact);
        study.fallible_case(
            "any palms, through modes",
            setting.clone(),
            move || scene.general(tolerance),
            error,
        );
        if scene.friction == 0.0 {
            study.fallible_case("minimal coordinates", setting, move || scene.minimal(tolerance), error);
        }
    }
    Ok(study.measure(Budget::thorough(), scene.duration()))
}

fn table(methods: &[Method]) {
    println!("| ours | tolerance | error | ms per s, fastest | median |\n|---|---|---|---|---|");
    for method in methods {
        for point in method.points() {
            match &point.outcome {
                Outcome::Measured { error, cost, least_cost } => {
                    let least = least_cost.unwrap_or(*cost);
                    println!(
                        "| {} | {} | {error:.1e} | {least:.3} | {cost:.3} |",
                        method.name(),
                        point.setting
                    );
                }
                Outcome::Failed { reason } => {
                    println!("| {} | {} | {reason} | | |", method.name(), point.setting)
                }
            }
        }
    }
}

/// What the peer does at its best settings, beside the cheapest of ours that is as near.
fn peer_table(version: &str, runs: &[Run], ours: &[Method]) {
    println!(
        "\nMuJoCo {version}, settings that no other beats in error and cost; beside each the cheapest of ours that is as near:\n"
    );
    println!("| MuJoCo | step | error | ms per s | ours, ms per s | times ours | settings |");
    println!("|---|---|---|---|---|---|---|");
    for run in front(runs) {
        let ours = cheapest(ours, run.error);
        println!(
            "| {}, {} | {} | {:.1e} | {:.1} | {ours:.3} | {:.0} | {} |",
            run.way,
            run.integrator,
            run.step_name(),
            run.error,
            run.ms,
            run.ms / ours,
            run.settings
        );
    }
    if let Some(run) = cheapest_run(runs, ASKED) {
        let ours = cheapest(ours, ASKED);
        println!(
            "\nWithin {ASKED:e}: MuJoCo {:.1} ms per simulated second, ours {ours:.3}, {:.0} times less.",
            run.ms,
            run.ms / ours
        );
    }
    let hard = |run: &&Run| run.way == "constraints";
    let nearest = runs.iter().filter(hard).map(|run| run.error).fold(f64::INFINITY, f64::min);
    println!(
        "\nHard constraints, as MuJoCo is commonly set up, come to {nearest:.1e} at best at any of the steps and settings tried. The \
         shortest step is {:.2} ms.",
        runs.iter().map(|run| 1e3 * run.step).fold(f64::INFINITY, f64::min)
    );
}

/// The cheapest run within an error.
fn cheapest_run(runs: &[Run], within: f64) -> Option<&Run> {
    runs.iter().filter(|run| run.error <= within).min_by(|a, b| a.ms.total_cmp(&b.ms))
}

fn cheapest(methods: &[Method], within: f64) -> f64 {
    let cost = |outcome: &Outcome| match outcome {
        Outcome::Measured { error, cost, least_cost } if *error <= within => least_cost.unwrap_or(*cost),
        _ => f64::INFINITY,
    };
    let points = methods.iter().flat_map(Method::points);
    points.map(|point| cost(&point.outcome)).fold(f64::INFINITY, f64::min)
}

/// A curve for each way and integrator.
fn curves(version: &str, runs: &[Run]) -> Vec<Method> {
    let mut curves: Vec<Method> = Vec::new();
    for run in runs {
        let name = format!("MuJoCo {version}, {}, {}", run.way, run.integrator);
        let at = curves.iter().position(|curve| curve.name() == name).unwrap_or_else(|| {
            curves.push(Method::new(name));
            curves.len() - 1
        });
        curves[at] = curves[at].clone().point(run.step_name(), run.error, run.ms);
    }
    curves
}

/// The poses of the log S1.
fn log() -> Anything<Vec<Pose>> {
    let row = |line: &str| -> Anything<Pose> {
        let v: Vec<f64> = line.split(',').map(str::parse).collect::<Result<_, _>>()?;
        let [_, x, y, z, qw, qx, qy, qz] = v[..] else { return Err(format!("not a pose: {line}").into()) };
        Ok((DVec3::new(x, y, z), DQuat::from_xyzw(qx, qy, qz, qw)))
    };
    LOG.lines().skip(1).map(row).collect()
}
