//! The whole command by length of log: `recon reconstruct` from a file to a folder of results with its report, as a process of its own.

mod process;

use super::{Chart, Drawn};
use crate::{Axis, Budget, Method, Outcome, Point, WorkPrecision, load};
use process::{Used, used};
use std::path::{Path, PathBuf};
use std::process::Command;

pub(super) const CHART: Chart = Chart {
    name: "command",
    about: "the whole command by length of log: time, processor time, memory",
    draw,
};

/// Rows of a log at 1 kHz, of a chart that is kept and of a smoke test.
const ROWS: [&[u32]; 2] = [&[1000, 3000, 10_000, 30_000, 100_000], &[1000]];
/// The command runs so often that it takes so many seconds, and once at least.
const PATIENCE: f64 = 1.0;
const MOST_RUNS: u32 = 10;

/// A rounder body than the paper's Fig. 5, which leaves its palms after 29 s; at 1 kHz. What is known of it and of the noise comes in between.
const GRAVITY: &str = "gravity = 9.81\n";
const OBJECT: &str = "[object]\nmass = 1.0\nprincipal_moments = [1.312, 1.762, 2.05]\n";
const SENSORS: &str = "[sensors]\ncontact_std = 2.5e-3\nforce_std = 0.065\n";
const SIMULATION: &str = "[simulation]\nsample_rate = 1000.0\norientation = [1.0, 0.0, 0.0, 0.0]\nangular_velocity = [0.0, 0.3, 0.3]
shape = { kind = \"ellipsoid\", semi_axes = [2.5, 2.0, 1.6] }
palms = [{ azimuth_deg = 270.0, slope_deg = 60.0 }, { azimuth_deg = 30.0, slope_deg = 60.0 }, { azimuth_deg = 150.0, slope_deg = 60.0 }]\n";

/// What is told: name, whether the body is known, whether the noise is stated.
const TOLD: [(&str, bool, bool); 4] = [
    ("known body, noise stated", true, true),
    ("known body, noise not stated", true, false),
    ("unknown body, noise stated", false, true),
    ("unknown body, noise not stated", false, false),
];

fn draw(budget: Budget) -> Drawn {
    let folder = std::env::temp_dir().join(format!("recon-command-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let drawn = measured(&folder, budget.of(ROWS)).map(diagrams);
    let _ = std::fs::remove_dir_all(&folder);
    drawn
}

/// Of each way to be told, at each number of rows.
type Measured = Vec<(&'static str, Vec<(u32, Result<Used, String>)>)>;

fn measured(folder: &Path, rows: &[u32]) -> Result<Measured, Box<dyn std::error::Error + Send + Sync>> {
    let recon = recon()?;
    let mut all: Measured = TOLD.iter().map(|(name, ..)| (*name, Vec::new())).collect();
    for &count in rows {
        let made = folder.join("made.toml");
        let duration = f64::from(count - 1) * 1e-3;
        std::fs::write(&made, format!("{GRAVITY}{OBJECT}{SENSORS}{SIMULATION}duration = {duration}\n"))?;
        let log = folder.join("log.csv");
        used(Command::new(&recon).arg("simulate").arg(&made).arg("-o").arg(&log).args([
            "--tolerance",
            "1e-10",
            "-q",
        ]))?;
        let made = std::fs::read_to_string(&log)?.lines().count() - 1;
        if made != count as usize {
            return Err(format!("contact is lost after {made} of {count} rows").into());
        }
        for ((_, known, stated), (_, of)) in TOLD.iter().zip(&mut all) {
            let scene = folder.join("scene.toml");
            let [object, sensors] =
                [(known, OBJECT), (stated, SENSORS)].map(|(is, text)| if *is { text } else { "" });
            std::fs::write(&scene, format!("{GRAVITY}{object}{sensors}"))?;
            let run = || {
                let mut command = Command::new(&recon);
                command
                    .arg("reconstruct")
                    .arg(&log)
                    .arg("--scene")
                    .arg(&scene)
                    .arg("-o")
                    .arg(folder.join("out"));
                if !known {
                    command.arg("--identify");
                }
                used(command.arg("-q"))
            };
            of.push((count, mean(run)));
        }
    }
    Ok(all)
}

/// Means over runs, the most of the memory.
fn mean(run: impl Fn() -> Result<Used, String>) -> Result<Used, String> {
    let mut all = run()?;
    let mut runs = 1;
    while all.wall < PATIENCE && runs < MOST_RUNS {
        let next = run()?;
        all = Used {
            wall: all.wall + next.wall,
            processor: all.processor + next.processor,
            megabytes: all.megabytes.max(next.megabytes),
        };
        runs += 1;
    }
    let count = f64::from(runs);
    Ok(Used { wall: all.wall / count, processor: all.processor / count, ..all })
}

fn diagrams(all: Measured) -> Vec<crate::Diagram> {
    type Of = fn(&Used) -> f64;
    let of: [(&str, &str, &str, &str, Of); 3] = [
        ("command-wall", "The whole command: time by length of log", "wall time", "s", |used| used.wall),
        (
            "command-processor",
            "The whole command: processor time by length of log",
            "processor time, all threads",
            "s",
            |used| used.processor,
        ),
        ("command-memory", "The whole command: memory by length of log", "most memory", "MB", |used| {
            used.megabytes
        }),
    ];
    let chart = |(name, title, what, unit, value): (&str, &str, &str, &str, Of)| {
        let methods = all.iter().map(|(name, points)| {
            points.iter().fold(Method::new(*name), |method, (rows, used)| {
                let outcome = match used {
                    Ok(used) => {
                        Outcome::Measured { error: f64::from(*rows), cost: value(used), least_cost: None }
                    }
                    Err(reason) => Outcome::Failed { reason: reason.clone() },
                };
                method.with(Point { setting: rows.to_string(), outcome })
            })
        });
        WorkPrecision::new(name, title)
            .subtitle(format!("recon reconstruct from log.csv to the folder with report.html; ellipsoid of 2.5, 2 and 1.6 m on three planes, at 1 kHz, noise of 0.1 % and 1 %{}", load()))
            .axes(Axis::log("rows of the log", "1"), Axis::log(what, unit))
            .methods(methods)
            .into()
    };
    of.into_iter().map(chart).collect()
}

/// The command beside this program.
fn recon() -> Result<PathBuf, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let path = own.with_file_name(format!("recon{}", std::env::consts::EXE_SUFFIX));
    match path.is_file() {
        true => Ok(path),
        false => Err(format!(
            "there is no {}: build it by cargo build --release --package recon-touch-cli",
            path.display()
        )),
    }
}
