//! Studies and charts in one binary, since each one more costs a link of everything: `study NAME ARGUMENTS..`.
//!
//! Studies of many runs are also made in parts, by as many machines as there are ([`rows`]).
//!
//! `cargo xtask study` and `cargo xtask chart` call it and know what each one writes.

mod approximations;
mod assumptions;
mod atlas;
mod bounds_corners;
mod bounds_curvature;
mod bounds_fuzz;
mod bounds_incremental;
mod bounds_noise;
mod bounds_noise_wrong;
mod bounds_planar;
mod bounds_planar_noise;
mod bounds_timing;
mod bounds_tosses;
mod chart;
mod cold_start;
mod contact_changes;
mod contact_cost;
mod contact_estimates;
mod contact_exports;
mod contact_logs;
mod contact_modes_estimated;
mod contact_modes_followed;
mod contact_wedging;
mod contour;
#[cfg(feature = "urdf")]
mod exported_objects;
mod least_model;
mod mode_bank;
mod mode_switches;
mod no_force;
mod nonsmooth;
mod palms;
mod parallel;
mod planar_contacts;
mod planar_estimates;
mod planar_estimates_friction;
mod planar_observability;
mod planar_tally;
mod pushes;
mod reaching;
mod relief;
mod result_bags;
mod rolling;
mod rolling_sensed;
mod shape_fits;
mod streaming;
mod three_palms_monte_carlo;
mod three_palms_timing;
mod tilting_palms;
mod whole_logs;

use recon_benches::instructions::{listed, repeat};
pub(crate) use recon_benches::rows;
pub(crate) use rows::words;
use rows::{Parts, RowsError};
use std::fmt::Display;
use std::process::ExitCode;

type Run = fn() -> Result<(), String>;

const OF_RUNS: Parts = Parts::OfRuns;
const TIMES: Parts = Parts::Whole("the times that it compares are of one machine");
const SHORT: Parts = Parts::Whole("it is done within minutes");
const DRAWN: Parts = Parts::Whole("its runs are drawn one after the other from one source of random numbers");

const STUDIES: &[(&str, Parts, Run)] = &[
    ("approximations", OF_RUNS, || in_words(approximations::main())),
    ("assumptions", OF_RUNS, || in_words(assumptions::main())),
    ("atlas", OF_RUNS, || in_words(atlas::main())),
    ("bounds_corners", OF_RUNS, || in_words(bounds_corners::main())),
    ("bounds_curvature", OF_RUNS, || in_words(bounds_curvature::main())),
    ("bounds_fuzz", OF_RUNS, || in_words(bounds_fuzz::main())),
    ("bounds_incremental", TIMES, || in_words(bounds_incremental::main())),
    ("bounds_noise", OF_RUNS, || in_words(bounds_noise::main())),
    ("bounds_noise_wrong", OF_RUNS, || in_words(bounds_noise_wrong::main())),
    ("bounds_planar", SHORT, || in_words(bounds_planar::main())),
    ("bounds_planar_noise", OF_RUNS, || in_words(bounds_planar_noise::main())),
    ("bounds_timing", TIMES, || in_words(bounds_timing::main())),
    ("bounds_tosses", SHORT, || in_words(bounds_tosses::main())),
    ("cold_start", OF_RUNS, || in_words(cold_start::main())),
    ("contact_changes", DRAWN, || in_words(contact_changes::main())),
    ("contact_estimates", SHORT, || in_words(contact_estimates::main())),
    ("contact_estimates_impulses", SHORT, || in_words(contact_estimates::impulses::main())),
    ("contact_estimates_random", OF_RUNS, || in_words(contact_estimates::random::main())),
    ("contact_cost", TIMES, || in_words(contact_cost::main())),
    ("contact_exports", SHORT, || in_words(contact_exports::main())),
    ("contact_logs", SHORT, || in_words(contact_logs::main())),
    ("contact_wedging", DRAWN, || in_words(contact_wedging::main())),
    ("contour", SHORT, || in_words(contour::main())),
    #[cfg(feature = "urdf")]
    ("exported_objects", SHORT, || in_words(exported_objects::main())),
    ("least_model", OF_RUNS, || in_words(least_model::main())),
    ("contact_modes_estimated", SHORT, || in_words(contact_modes_estimated::main())),
    ("contact_modes_followed", TIMES, || in_words(contact_modes_followed::main())),
    ("mode_bank", SHORT, || in_words(mode_bank::main())),
    ("mode_switches", SHORT, || in_words(mode_switches::main())),
    ("no_force", OF_RUNS, || in_words(no_force::main())),
    ("nonsmooth", OF_RUNS, || in_words(nonsmooth::main())),
    ("palms", OF_RUNS, || in_words(palms::main())),
    ("planar_contacts", OF_RUNS, || in_words(planar_contacts::main())),
    ("planar_estimates", OF_RUNS, || in_words(planar_estimates::main())),
    ("planar_estimates_friction", OF_RUNS, || in_words(planar_estimates_friction::main())),
    ("planar_observability", SHORT, || in_words(planar_observability::main())),
    ("pushes", SHORT, || in_words(pushes::main())),
    ("reaching", OF_RUNS, || in_words(reaching::main())),
    ("relief", OF_RUNS, || in_words(relief::main())),
    ("result_bags", SHORT, || in_words(result_bags::main())),
    ("parallel", OF_RUNS, || in_words(parallel::main())),
    ("rolling", OF_RUNS, || in_words(rolling::main())),
    ("rolling_sensed", OF_RUNS, || in_words(rolling_sensed::main())),
    ("shape_fits", OF_RUNS, || in_words(shape_fits::main())),
    ("streaming", OF_RUNS, || in_words(streaming::main())),
    ("tilting_palms", OF_RUNS, || in_words(tilting_palms::main())),
    ("whole_logs", OF_RUNS, || in_words(whole_logs::main())),
    ("three_palms_monte_carlo", OF_RUNS, || in_words(three_palms_monte_carlo::main())),
    ("three_palms_timing", TIMES, || in_words(three_palms_timing::main())),
];

fn main() -> ExitCode {
    let name = std::env::args().nth(1).unwrap_or_default();
    if name == "chart" {
        return chart::main();
    }
    if name == "inner_loop" {
        return inner_loop();
    }
    let Some((_, parts, run)) = STUDIES.iter().find(|(known, ..)| *known == name) else {
        eprintln!("no study is called {name:?}; there are:");
        STUDIES.iter().for_each(|(known, ..)| eprintln!("  {known}"));
        return ExitCode::from(2);
    };
    match in_words(rows::begin(*parts)).and_then(|()| run()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            eprintln!("{name}: {complaint}");
            ExitCode::FAILURE
        }
    }
}

/// Runs an inner loop so often, `inner_loop NAME COUNT`, for a program that counts instructions; without a name it lists them with their repeats.
fn inner_loop() -> ExitCode {
    let mut words = words();
    let (Some(name), count) = (words.next(), words.next().and_then(|count| count.parse().ok())) else {
        print!("{}", listed());
        return ExitCode::SUCCESS;
    };
    match repeat(&name, count.unwrap_or(1)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}

/// Prints a line of a table, one that is of this part.
pub(crate) fn print_line<E: From<RowsError>>(line: impl FnOnce() -> Result<String, E>) -> Result<(), E> {
    if let Some(line) = rows::row(line)? {
        println!("{line}");
    }
    Ok(())
}

fn in_words<E: Display>(ran: Result<(), E>) -> Result<(), String> {
    ran.map_err(|error| error.to_string())
}
