//! Bodies that are not smooth: which contacts are told to be on corners, edges and faces, and whether bounds hold.
//!
//! `cargo xtask study nonsmooth RUNS SEED` writes docs/nonsmooth.md and docs/charts/nonsmooth.svg.

mod bodies;
mod picture;
mod rolled;
mod tally;

use crate::rows;
use bodies::BODIES;
use recon::shape_bounds::features::{FeatureOptions, Features};
use recon::shape_bounds::noise::CertainBounds;
use recon_io::write_figures;
use shape_bounds::generators::{Touched, TouchedBody, Touching};
use std::error::Error;
use std::fmt::Write as _;
use tally::{Judged, Tally};

type Failure = Box<dyn Error>;

/// How each body is touched: two flat palms, a fingertip close to it and one farther off.
const HOW: [Touching; 4] =
    [Touching::Palm, Touching::Palm, Touching::Fingertip(0.0), Touching::Fingertip(0.5)];
/// Contacts of each.
const CONTACTS: usize = 600;
const CONFIDENCE: f64 = 0.95;
const RUNS: u64 = 50;
const SEED: u64 = 141_000;
const NOISE: [f64; 2] = [1e-3, 1e-2];

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = super::words().map(|w| w.parse::<u64>());
    let runs = words.next().transpose()?.unwrap_or(RUNS);
    let seed = words.next().transpose()?.unwrap_or(SEED);
    let mut text = include_str!("intro.md")
        .replace("{runs}", &runs.to_string())
        .replace("{seed}", &seed.to_string())
        .replace("{contacts}", &CONTACTS.to_string());
    let mut told = String::from(tally::TOLD_HEAD);
    let mut bounded = String::from(tally::BOUNDS_HEAD);
    let mut panels = Vec::new();
    for (k, named) in BODIES.iter().enumerate() {
        for noise in NOISE {
            let of = |run: u64| {
                let body = named.body(seed + run);
                let touched = body.touched(&HOW, CONTACTS, noise, seed + 1000 * k as u64 + run);
                (body, touched)
            };
            if noise == NOISE[1] && k < 3 {
                let (body, touched) = of(0);
                let features = Features::find(&touched.curves, &FeatureOptions::default())?;
                panels.push(picture::panel(named.name, &body, &touched, &features));
            }
            let lines = rows::row(|| -> Result<[String; 2], Failure> {
                let mut tally = Tally::default();
                for (body, touched) in (0..runs).map(of) {
                    tally.add(judged(&body, &touched)?);
                }
                Ok([tally.told_row(named.name, noise), tally.bounds_row(named.name, noise)])
            })?;
            if let Some([of_told, of_bounds]) = lines {
                writeln!(told, "{of_told}")?;
                writeln!(bounded, "{of_bounds}")?;
            }
        }
    }
    let (rounding, panel) = bodies::rounding_table(runs, seed)?;
    panels.push(panel);
    writeln!(text, "\n## What is told\n\n{told}")?;
    writeln!(text, "## Bounds\n\n{bounded}")?;
    writeln!(text, "## How small a radius is told from a corner\n\n{rounding}")?;
    writeln!(text, "## Rolled between palms\n\n{}", rolled::text(runs.min(10), seed)?)?;
    if !rows::is_part() {
        let mut svg = Vec::new();
        write_figures(&panels, &mut svg)?;
        std::fs::write("docs/charts/nonsmooth.svg", svg)?;
    }
    print!("{text}");
    Ok(())
}

/// What is told of contacts, and the bounds without that and with it.
fn judged(body: &TouchedBody, touched: &Touched) -> Result<Judged, Failure> {
    let options = FeatureOptions::default();
    let clock = std::time::Instant::now();
    let features = Features::find(&touched.curves, &options)?;
    let seconds = clock.elapsed().as_secs_f64();
    let plain = CertainBounds::from_noisy_curves(&touched.curves, CONFIDENCE)?;
    let with = CertainBounds::from_features(&touched.curves, &options, CONFIDENCE)?;
    Ok(Judged::new(body, touched, &features, [plain, with], seconds))
}
