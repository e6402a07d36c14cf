//! Studies and charts in one binary, since each one more costs a link of everything: `study NAME ARGUMENTS..`.
//!
//! Studies of many runs are also made in parts, by as many machines as there are ([`rows`]).
//!
//! `cargo xtask study` and `cargo xtask chart` call it and know what each one writes.

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
mod contact_wedging;
mod contour;
mod exported_objects;
mod least_model;
mod mode_bank;
mod mode_switches;
mod no_force;
mod nonsmooth;
mod palms;
mod planar_contacts;
mod planar_estimates;
mod planar_estimates_friction;
mod planar_observability;
mod planar_tally;
mod pushes;
mod reaching;
mod result_bags;
mod rolling;
mod rolling_sensed;
mod shape_fits;
mod streaming;
mod three_palms_monte_carlo;
mod three_palms_timing;
mod tilting_palms;
mod whole_logs;

pub(crate) use recon_benches::rows;
pub(crate) use rows::words;
use std::fmt::Display;
use std::process::ExitCode;

type Run = fn() -> Result<(), String>;

const STUDIES: &[(&str, Run)] = &[
    ("assumptions", || in_words(assumptions::main())),
    ("atlas", || in_words(atlas::main())),
    ("bounds_corners", || in_words(bounds_corners::main())),
    ("bounds_curvature", || in_words(bounds_curvature::main())),
    ("bounds_fuzz", || in_words(bounds_fuzz::main())),
    ("bounds_incremental", || in_words(bounds_incremental::main())),
    ("bounds_noise", || in_words(bounds_noise::main())),
    ("bounds_noise_wrong", || in_words(bounds_noise_wrong::main())),
    ("bounds_planar", || in_words(bounds_planar::main())),
    ("bounds_planar_noise", || in_words(bounds_planar_noise::main())),
    ("bounds_timing", || in_words(bounds_timing::main())),
    ("bounds_tosses", || in_words(bounds_tosses::main())),
    ("cold_start", || in_words(cold_start::main())),
    ("contact_changes", || in_words(contact_changes::main())),
    ("contact_estimates", || in_words(contact_estimates::main())),
    ("contact_estimates_impulses", || in_words(contact_estimates::impulses::main())),
    ("contact_estimates_random", || in_words(contact_estimates::random::main())),
    ("contact_cost", || in_words(contact_cost::main())),
    ("contact_exports", || in_words(contact_exports::main())),
    ("contact_logs", || in_words(contact_logs::main())),
    ("contact_wedging", || in_words(contact_wedging::main())),
    ("contour", || in_words(contour::main())),
    ("exported_objects", || in_words(exported_objects::main())),
    ("least_model", || in_words(least_model::main())),
    ("contact_modes_estimated", || in_words(contact_modes_estimated::main())),
    ("mode_bank", || in_words(mode_bank::main())),
    ("mode_switches", || in_words(mode_switches::main())),
    ("no_force", || in_words(no_force::main())),
    ("nonsmooth", || in_words(nonsmooth::main())),
    ("palms", || in_words(palms::main())),
    ("planar_contacts", || in_words(planar_contacts::main())),
    ("planar_estimates", || in_words(planar_estimates::main())),
    ("planar_estimates_friction", || in_words(planar_estimates_friction::main())),
    ("planar_observability", || in_words(planar_observability::main())),
    ("pushes", || in_words(pushes::main())),
    ("reaching", || in_words(reaching::main())),
    ("result_bags", || in_words(result_bags::main())),
    ("rolling", || in_words(rolling::main())),
    ("rolling_sensed", || in_words(rolling_sensed::main())),
    ("shape_fits", || in_words(shape_fits::main())),
    ("streaming", || in_words(streaming::main())),
    ("tilting_palms", || in_words(tilting_palms::main())),
    ("whole_logs", || in_words(whole_logs::main())),
    ("three_palms_monte_carlo", || in_words(three_palms_monte_carlo::main())),
    ("three_palms_timing", || in_words(three_palms_timing::main())),
];

/// Those whose runs may be made in parts ([`rows`]).
const OF_RUNS: &[&str] = &[
    "assumptions",
    "atlas",
    "bounds_noise",
    "bounds_noise_wrong",
    "bounds_planar_noise",
    "cold_start",
    "contact_estimates_random",
    "no_force",
    "palms",
    "planar_estimates",
    "planar_estimates_friction",
    "rolling_sensed",
    "three_palms_monte_carlo",
    "tilting_palms",
    "whole_logs",
];

fn main() -> ExitCode {
    let name = std::env::args().nth(1).unwrap_or_default();
    if name == "chart" {
        return chart::main();
    }
    let Some((_, run)) = STUDIES.iter().find(|(known, _)| *known == name) else {
        eprintln!("no study is called {name:?}; there are:");
        STUDIES.iter().for_each(|(known, _)| eprintln!("  {known}"));
        return ExitCode::from(2);
    };
    match in_words(rows::begin(OF_RUNS)).and_then(|()| run()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            eprintln!("{name}: {complaint}");
            ExitCode::FAILURE
        }
    }
}

fn in_words<E: Display>(ran: Result<(), E>) -> Result<(), String> {
    ran.map_err(|error| error.to_string())
}
