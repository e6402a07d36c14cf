//! Outline, friction and modes from pushes: simulated ones of many shapes, on seeds for calibration and on others for proof, and real
//! ones where they are there.
//!
//! `cargo xtask study pushes RUNS CALIBRATION_SEED PROOF_SEED` writes docs/pushes-study.md and docs/charts/pushes.svg.

mod judge;
mod real;
mod shapes;

use judge::Tally;
use recon::object_dynamics::pushing::{ClosedLine, PushDisturbances, PushScene, simulate_pushes};
use recon::observer::pushes::estimate_pushes;
use recon_io::{FigureCurve, FigurePanel, write_figures};
use shapes::{Draw, SHAPES};
use std::error::Error;
use std::fmt::Write as _;

type Failure = Box<dyn Error>;

/// Pushes of a log.
const PUSHES: u32 = 50;
/// Runs of each shape.
const RUNS: u64 = 6;
const SEEDS: [(&str, u64); 2] = [("Calibration", 7000), ("Proof", 29000)];

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = super::words().map(|w| w.parse::<u64>());
    let runs = words.next().transpose()?.unwrap_or(RUNS);
    let seeds =
        [words.next().transpose()?.unwrap_or(SEEDS[0].1), words.next().transpose()?.unwrap_or(SEEDS[1].1)];
    let mut text = format!(
        "# Study of pushes\n\nMade by `cargo xtask study pushes {runs} {} {}`. What is estimated and how is in [pushes.md](pushes.md).\n\n\
         {runs} logs of {PUSHES} pushes for each shape; friction 0.2 to 0.7, finger 1 to 5 mm, the finger's clock ahead by up to 0.2 s, up to 0.2 s of way after \
         the last sample; disturbances as in `PushDisturbances::default()`. Times stated: one log on one core.\n\n![Friction and outlines](charts/pushes.svg)\n",
        seeds[0], seeds[1]
    );
    let mut panels = Vec::new();
    for ((name, _), seed) in SEEDS.iter().zip(seeds) {
        writeln!(text, "\n## {name}, seeds from {seed}\n\n{}", judge::HEAD)?;
        let mut all = Tally::default();
        for (k, shape) in SHAPES.iter().enumerate() {
            let mut tally = Tally::default();
            for run in 0..runs {
                one(shape, seed + 100 * k as u64 + run, &mut tally)?;
            }
            writeln!(text, "{}", tally.row(shape.name))?;
            all.merge(tally);
        }
        writeln!(text, "{}\n\n{}", all.row("all"), all.modes())?;
        panels = all.panels();
    }
    text += &real::text(&mut panels)?;
    let mut svg = Vec::new();
    write_figures(&panels, &mut svg)?;
    std::fs::write("docs/charts/pushes.svg", svg)?;
    print!("{text}");
    Ok(())
}

/// An outline that was told, and what it is compared with.
fn outline_panel(title: &str, told: &ClosedLine, truth: &ClosedLine) -> FigurePanel {
    let closed = |line: &ClosedLine| {
        let corners = line.corners().iter().chain(line.corners().first());
        corners.map(|p| (*p * 1e3).to_array()).collect()
    };
    let name = "told (dashed: true)".to_owned();
    let curve =
        FigureCurve { name, points: closed(told), reference: closed(truth), ..FigureCurve::default() };
    FigurePanel {
        title: title.to_owned(),
        axes: ["x in mm".to_owned(), "y in mm".to_owned()],
        equal: true,
        curves: vec![curve],
        ..FigurePanel::default()
    }
}

/// One simulated log.
fn one(shape: &shapes::Named, seed: u64, tally: &mut Tally) -> Result<(), Failure> {
    let mut draw = Draw::new(seed);
    let outline = shape.line(&mut draw)?;
    let size = (outline.area() / std::f64::consts::PI).sqrt();
    let scene = PushScene {
        finger_radius: draw.between(1e-3, 5e-3),
        friction: draw.between(0.2, 0.7),
        length: size * draw.between(0.5, 0.9),
        sliding_force: draw.between(1.0, 8.0),
        compliance: draw.between(0.2e-4, 1.5e-4),
        outline,
    };
    let noise = PushDisturbances {
        finger_ahead: draw.between(-0.2, 0.2),
        moves_on: draw.between(0.0, 0.2),
        ..PushDisturbances::default()
    };
    let made = simulate_pushes(&scene, &noise, PUSHES, seed)?;
    let clock = std::time::Instant::now();
    let told = estimate_pushes(&made.log, scene.finger_radius);
    tally.add(shape, &scene, &made, told, clock.elapsed().as_secs_f64());
    Ok(())
}
