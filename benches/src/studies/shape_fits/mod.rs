//! Shapes fitted to contacts: errors against the Cramer-Rao bound, consistency, choice of the family, refusals, time.
//!
//! Usage: `shape_fits [RUNS [SECTION]]` (200 runs and all sections by default). Writes the page to standard output.

mod accuracy;
mod bodies;
mod choice;
mod incremental;
mod minima;
mod outlines;

type Failure = Box<dyn std::error::Error>;

pub(crate) fn main() -> Result<(), Failure> {
    let runs: u64 = crate::words().next().map_or(Ok(200), |a| a.parse())?;
    println!("# Shapes fitted to contacts\n");
    println!(
        "`cargo xtask study shape_fits {runs}`: seeded runs, each with a new body, new contacts and new noise; points are off"
    );
    println!(
        "by the stated noise in m per axis, normals by as much in rad per tangent axis, on bodies about 1 m in size.\n"
    );
    type Section = (&'static str, fn(u64) -> Result<(), Failure>);
    let sections: [Section; 7] = [
        ("accuracy", accuracy::accuracy),
        ("choice", |runs| choice::choice(runs / 5)),
        ("times", |_| choice::times()),
        ("minima", |runs| minima::minima(10 * runs)),
        ("false_alarms", outlines::false_alarms),
        ("power", outlines::power),
        ("incremental", |_| incremental::incremental()),
    ];
    let only = crate::words().nth(1);
    for (name, section) in sections {
        if only.as_ref().is_none_or(|only| only == name) {
            section(runs)?;
        }
    }
    Ok(())
}
