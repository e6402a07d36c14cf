//! What crosses crates: reference solutions, logs of other simulators, failures that must be told.
//!
//! One binary: each one more costs a link of everything.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod contact_logs;
mod contact_modes;
mod contacts_oracle;
mod estimate_motion;
mod exported_scenes;
mod failure_cases;
mod failures_unknown_body;
mod followed_modes;
mod logs_of_other_simulators;
mod mode_bank;
mod mode_bank_on_a_belt;
mod noisy;
mod paper_method;
mod planar_basin;
mod planar_branches;
mod planar_common;
mod planar_dynamic;
mod planar_failures;
mod planar_faults;
mod planar_oracles;
mod planar_quasistatic;
mod planar_shape_fit;
#[expect(clippy::unit_arg, reason = "as README.md has it in ten lines")]
mod readme;
mod sensor_constants;
mod several_motions;
mod simulation_oracle;
mod unknown_body;
