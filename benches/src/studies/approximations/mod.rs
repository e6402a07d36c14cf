//! Approximations of bodies from contacts: hull, alpha shape, Hermite surface, spline, principal surface, by number of contacts and noise.
//!
//! `cargo xtask study approximations RUNS SEED` writes docs/approximations.md and docs/charts/approximations.svg.

mod bodies;
mod methods;

use crate::rows;
use bodies::{BODIES, Body};
use methods::{ALL, Errors, Method, errors};
use recon_io::{FigureCurve, FigurePanel, write_figures};
use std::fmt::Write as _;

type Failure = Box<dyn std::error::Error>;

const RUNS: u64 = 3;
/// The first seed. The lattices and the energy were settled on contacts spread evenly, and on seeds 1 and 2 of traced ones.
const SEED: u64 = 190_000;
const COUNTS: [usize; 5] = [25, 50, 100, 200, 400];
/// Contacts beside noise, m and rad.
const NOISY: usize = 200;
const NOISE: [f64; 4] = [1e-4, 1e-3, 1e-2, 3e-2];

/// A table: what is varied, whether contacts are traced, and the methods.
struct Table {
    title: &'static str,
    traced: bool,
    settings: Vec<(String, usize, f64)>,
    methods: Vec<Method>,
}

fn tables() -> [Table; 3] {
    let counts = || COUNTS.map(|count| (count.to_string(), count, 0.0)).to_vec();
    let without_noise = || ALL.into_iter().filter(|m| !matches!(m, Method::Stated)).collect::<Vec<Method>>();
    [
        Table {
            title: "Exact contacts in random directions",
            traced: false,
            settings: counts(),
            methods: without_noise(),
        },
        Table {
            title: "Exact contacts along three closed curves",
            traced: true,
            settings: counts(),
            methods: without_noise(),
        },
        Table {
            title: "200 noisy contacts in random directions",
            traced: false,
            settings: NOISE.map(|noise| (format!("{noise:e}"), NOISY, noise)).to_vec(),
            methods: ALL.to_vec(),
        },
    ]
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = super::words().map(|w| w.parse::<u64>());
    let runs = words.next().transpose()?.unwrap_or(RUNS);
    let seed = words.next().transpose()?.unwrap_or(SEED);
    let mut text = include_str!("intro.md")
        .replace("{runs}", &runs.to_string())
        .replace("{seed}", &seed.to_string())
        .replace("{last}", &(seed + runs - 1).to_string());
    let mut panels = Vec::new();
    for table in tables() {
        writeln!(text, "\n## {}\n", table.title)?;
        let names: Vec<&str> = table.methods.iter().map(|m| m.name()).collect();
        let first = if table.settings[0].2 > 0.0 { "noise, m and rad" } else { "contacts" };
        writeln!(text, "| body | {first} | {} |", names.join(" | "))?;
        writeln!(text, "|{}", "---|".repeat(names.len() + 2))?;
        for body in &BODIES {
            let mut curves: Vec<FigureCurve> = (table.methods.iter())
                .map(|m| FigureCurve { name: m.short().to_owned(), ..FigureCurve::default() })
                .collect();
            for (label, count, noise) in &table.settings {
                let row = rows::row(|| row(body, &table, (*count, *noise), (runs, seed)))?;
                let Some(row) = row else { continue };
                let setting = if *noise > 0.0 { *noise } else { *count as f64 };
                let mut cells = Vec::new();
                for ([refused, rms, largest, ms], curve) in row.iter().zip(&mut curves) {
                    cells.push(cell([*refused, *rms, *largest, *ms], runs));
                    if rms.is_finite() {
                        curve.points.push([setting.log10(), rms.log10()]);
                    }
                }
                writeln!(text, "| {} | {label} | {} |", body.name, cells.join(" | "))?;
            }
            panels.push(FigurePanel {
                title: format!("{}: {}", body.name, table.title.to_lowercase()),
                axes: [format!("log10 of {first}"), "log10 of rms error, m".to_owned()],
                // As many as there are colours: where noise is stated the surface is about that where it is not.
                curves: curves.into_iter().filter(|c| !c.points.is_empty()).take(5).collect(),
                ..FigurePanel::default()
            });
        }
    }
    if !rows::is_part() {
        let mut svg = Vec::new();
        write_figures(&panels, &mut svg)?;
        std::fs::write("docs/charts/approximations.svg", svg)?;
    }
    text += include_str!("outro.md");
    print!("{text}");
    Ok(())
}

/// Of each method: how often it refused, and the medians of its errors (m) and of its time (ms).
fn row(
    body: &Body,
    table: &Table,
    (count, noise): (usize, f64),
    (runs, seed): (u64, u64),
) -> Result<Vec<[f64; 4]>, Failure> {
    let mut found: Vec<Vec<Errors>> = vec![Vec::new(); table.methods.len()];
    for run in 0..runs {
        let contacts = body.touched((count, table.traced), noise, seed + run)?;
        for (method, found) in table.methods.iter().zip(&mut found) {
            if *method != Method::Hull || body.convex {
                found.extend(errors(*method, body, &contacts, noise)?);
            }
        }
    }
    let median = |errors: &[Errors], of: fn(&Errors) -> f64| {
        let mut all: Vec<f64> = errors.iter().map(of).collect();
        all.sort_by(f64::total_cmp);
        all.get(all.len() / 2).copied().unwrap_or(f64::NAN)
    };
    let of = |e: &Vec<Errors>| {
        let refused = (runs as usize - e.len()) as f64;
        [refused, median(e, |e| e.rms), median(e, |e| e.largest), median(e, |e| e.ms)]
    };
    Ok(found.iter().map(of).collect())
}

fn cell([refused, rms, largest, ms]: [f64; 4], runs: u64) -> String {
    if rms.is_nan() {
        return String::new();
    }
    let left = if refused > 0.0 { format!(", {refused} of {runs} refused") } else { String::new() };
    let mm = |m: f64| {
        let mm = 1e3 * m;
        match mm {
            0.0..0.1 => format!("{mm:.3}"),
            0.1..10.0 => format!("{mm:.2}"),
            _ => format!("{mm:.0}"),
        }
    };
    format!("{}; {} ({ms:.0} ms){left}", mm(rms), mm(largest))
}
