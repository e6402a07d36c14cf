//! What is said of a round finger in the plane and in space alike.

use super::settings::Noise;
use recon_io::brief_to;

/// How sure what is proven is.
pub(super) fn sure(noise: Noise) -> String {
    match noise {
        None => "for exact touches".to_owned(),
        Some((_, level)) => format!("at {} % confidence", 100.0 * level),
    }
}

/// What a finger may have missed, by how wide it is, m.
pub(super) fn but(unseen: f64) -> String {
    format!("what is narrower than {} m could have been jumped over without a trace", brief_to(2, unseen))
}

/// How many places.
pub(super) fn places(count: usize) -> String {
    if count == 1 { "one place".to_owned() } else { format!("{count} places") }
}
