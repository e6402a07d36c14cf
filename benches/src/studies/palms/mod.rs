//! Are spherical palms better? Flat, convex and concave palms with the same motions on the same bodies.
//!
//! Usage: `palms [EACH [FIRST [FRICTION]]]`: bodies of each family (10), the first of their seeds and the coefficient of friction (0). Prints
//! docs/palms.md and writes docs/charts/palms-*, which are of the seeds that it is called with.

mod charts;
mod row;
mod tables;

use recon_benches::palms::{MOTION, Motion, PalmKind, palm_body, palm_run};
use recon_benches::reaching::Bodies;
use row::Row;

type Failure = Box<dyn std::error::Error>;

/// Seeds of the bodies: nothing was chosen on them. Those of tuning are 150000 to 150009.
const FIRST_SEED: u64 = 151_000;

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(10), |a| a.parse())?;
    let first: u64 = crate::words().nth(1).map_or(Ok(FIRST_SEED), |a| a.parse())?;
    let friction: f64 = crate::words().nth(2).map_or(Ok(MOTION.friction), |a| a.parse())?;
    let motion = Motion { friction, ..MOTION };
    let mut all: [Vec<Row>; PalmKind::ALL.len()] = Default::default();
    for (family, seed) in (Bodies { first, each }).all() {
        let body = palm_body(family, seed)?;
        for (kind, rows) in PalmKind::ALL.into_iter().zip(&mut all) {
            let made = || -> Result<_, Failure> {
                Ok(Row::of(&palm_run(&body, kind, &motion, seed, true)?).cells())
            };
            rows.extend(crate::rows::row(made)?.map(Row::from_cells));
        }
    }
    let radians = palm_motion(&motion, first)?;
    let compared = tables::Compared { all, radians, seconds: motion.duration() };
    if friction == MOTION.friction {
        println!("{}", include_str!("intro.md").trim_end());
        println!("\nMade by `cargo xtask study palms {each} {first}`.\n");
    }
    tables::print(&compared);
    if friction == MOTION.friction {
        charts::draw(&compared, std::path::Path::new("docs/charts"))?;
        println!("{}", include_str!("outro.md").trim_end());
    }
    Ok(())
}

/// Radians that the three palms turn through; it differs by the seed of the body, and by nothing else: the mean over some.
fn palm_motion(motion: &Motion, first: u64) -> Result<f64, Failure> {
    const SOME: u64 = 20;
    let body = palm_body(exploration::generators::Family::Ellipsoid, first)?;
    let mut sum = 0.0;
    for seed in first..first + SOME {
        let (scene, _) = recon_benches::palms::held(&body, PalmKind::Flat, motion, seed)?;
        sum += recon_benches::palms::radians(&scene, motion.duration()) / SOME as f64;
    }
    Ok(sum)
}
