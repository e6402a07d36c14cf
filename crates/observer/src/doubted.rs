//! What constants of the sensors that may be wrong add to what is not known of motion and body.
//!
//! A constant that is not what it was taken for carries the estimate with it long before the data refute it. Hypotheses are averaged over: that
//! nothing is wrong, or one constant, by an unknown amount whose most probable variance `(s^2 - 1) / s^2` of its square the score `s` tells (MacKay's
//! evidence, as for an automatic relevance). Against nothing being wrong the odds of that are `exp((s^2 - 1) / 2) / |s|` times those beforehand.

use crate::faults::Suspect;

/// Odds beforehand that one of the constants of a log, whichever, is not what it was taken for.
const BEFOREHAND: f64 = 0.1;
/// Squared score beyond which nothing changes any more: such a constant is wrong.
pub(crate) const CERTAIN: f64 = 100.0;

/// What each constant may be off by, as the standard deviation of an error of its own in its unit: 0 of those that nothing speaks against.
pub(crate) fn errors(suspects: &[Suspect]) -> Vec<f64> {
    let scores: Vec<f64> = suspects.iter().map(Suspect::score).collect();
    let error = |(suspect, probability): (&Suspect, f64)| {
        if probability == 0.0 {
            return 0.0;
        }
        let sure = 1.0 - suspect.score().powi(-2);
        let mean = sure * suspect.value;
        (probability * (mean * mean + sure * suspect.deviation * suspect.deviation)).sqrt()
    };
    suspects.iter().zip(probabilities(&scores)).map(error).collect()
}

/// That each constant, by its score, is the one that is wrong.
fn probabilities(scores: &[f64]) -> Vec<f64> {
    let share = BEFOREHAND / scores.len().max(1) as f64;
    let odds = |s: &f64| {
        let square = (s * s).min(CERTAIN);
        if square > 1.0 { share * (0.5 * (square - 1.0)).exp() / square.sqrt() } else { 0.0 }
    };
    let odds: Vec<f64> = scores.iter().map(odds).collect();
    let all = 1.0 + odds.iter().sum::<f64>();
    odds.iter().map(|odds| odds / all).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What chance makes of ten constants hardly counts; four deviations of one do, and a score beyond all numbers is that of what is wrong.
    #[test]
    fn a_constant_is_doubted_by_the_odds_of_its_score() {
        let of_one = |s: f64| probabilities(&[&[s][..], &[0.5; 9]].concat());
        assert_eq!(of_one(1.0), vec![0.0; 10]);
        for (score, odds) in [(2.0, 0.01 * 1.5_f64.exp() / 2.0), (-4.0, 0.01 * 7.5_f64.exp() / 4.0)] {
            let probability = of_one(score)[0];
            assert!((probability / (1.0 - probability) / odds - 1.0).abs() < 1e-12, "{score}: {probability}");
        }
        for score in [12.0, 1e200, f64::INFINITY] {
            assert!((of_one(score)[0] - 1.0).abs() < 1e-9, "{score}");
        }
        // Of two that explain the same each has half.
        let alike = probabilities(&[6.0, -6.0]);
        assert!((alike[0] - 0.5).abs() < 1e-5 && alike[0] == alike[1], "{alike:?}");
        assert!(probabilities(&[]).is_empty());
    }
}
