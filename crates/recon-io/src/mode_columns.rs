//! Columns of contact modes: the same in every table of a motion.

use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::ContactOdds;
use std::fmt::Write as _;

/// Names of the columns of contact modes of `palms` palms, a comma before each: `mode_i` (0 off, 1 slides, 2 sticks), and where they are told the
/// probabilities to slide and to stick, `p_slide_i` and `p_stick_i`.
#[must_use]
pub fn mode_columns(palms: usize, odds: bool) -> String {
    let modes = (1..=palms).map(|i| format!(",mode_{i}"));
    let told = (1..=if odds { palms } else { 0 }).map(|i| format!(",p_slide_{i},p_stick_{i}"));
    modes.chain(told).collect()
}

/// Appends the cells of these columns.
pub fn push_modes(row: &mut String, modes: &[ContactMode], odds: Option<&[ContactOdds]>) {
    for mode in modes {
        let _ = write!(row, ",{}", mode.number());
    }
    for probability in odds.unwrap_or_default().iter().flat_map(probabilities) {
        // Digits of a probability are written as people read them: there are six at most.
        let _ = write!(row, ",{probability}");
    }
}

/// To slide and to stick, to a millionth: more of the digits are chance.
#[must_use]
pub fn probabilities(of: &ContactOdds) -> [f64; 2] {
    [of.slide, of.stick].map(|probability| (1e6 * probability).round() / 1e6)
}
