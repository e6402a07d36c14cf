//! Against bags and numbers of another implementation (`tests/data/mcap`), whose provenance is in `tests/data/README.md`.

mod broken;
mod joined;
mod reference;

use super::{Bag, Topic};
use serde_json::Value;
use std::path::PathBuf;

/// A file of the reference.
pub(super) fn path(name: &str) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "..", "..", "tests", "data", "mcap", name].iter().collect()
}

pub(super) fn bag(name: &str) -> Bag {
    super::read_bag(path(name)).unwrap()
}

/// What the reference says of a file.
pub(super) fn expected(name: &str) -> Value {
    let text = std::fs::read_to_string(path("mcap.json")).unwrap();
    serde_json::from_str::<Value>(&text).unwrap()["files"][name].clone()
}

pub(super) fn topic<'a>(bag: &'a Bag, name: &str) -> &'a Topic {
    &bag.topics[name]
}
