//! What holds for every input, whatever its kind: laws that relate one result to another, tried on points and planes of all kinds.

mod halfspaces;
mod hull;

use proptest::test_runner::{Config, RngSeed};

/// So many cases, the same ones each time: a failure stays until it is mended.
fn cases(count: u32) -> Config {
    Config {
        cases: crate::few_or_all(count, 20 * count),
        failure_persistence: None,
        rng_seed: RngSeed::Fixed(19),
        ..Config::default()
    }
}
