//! Whether an estimate is to be relied on, by the evidence for it.

use super::cold_start::{EXPLAINED, NEXT_TO_NOTHING};
use super::evidence::{Evidence, Reason, Reliability};
use super::momentum::Scales;
use crate::least_squares::FitStatus;

/// A direction of the unknowns known to worse than this share of its natural size makes the estimate unreliable: the
/// linearisation that its covariance comes from does not reach that far. An error of five deviations without another warning
/// was seen at 0.24 (two palms 30 degrees apart), none below 0.2.
pub(crate) const LARGEST_DEVIATION: f64 = 0.15;
/// The same where the covariance was not widened by what is beyond first order.
pub(super) const LARGEST_PLAIN_DEVIATION: f64 = 0.1;
/// Root mean square shift by pairs of as much noise again, in standard deviations, beyond which even the covariance that is
/// widened by it is not to be trusted: what is quadratic in the noise is then larger than what is linear, and what is beyond
/// both is not small. Shifts up to 1.9 were seen with errors that the widened covariance covers.
const LARGEST_BIAS: f64 = 2.0;
/// The same where the search has found other motions, of an estimate whose worst known direction has a deviation beyond the
/// second number, in natural sizes. In a thousand noisy runs all of finite shift were right that nothing else spoke against.
const BIAS_AMONG_OTHERS: f64 = 1.5;
const DEVIATION_AMONG_OTHERS: f64 = 0.06;
/// Logarithm of the odds against the next motion below which the log is taken to leave both open. By the letter a few would do,
/// but each motion feels noise of other directions, by which its corrections scatter: in 2560 noisy runs a wrong motion had 16.
const LEAST_LOG_ODDS: f64 = 20.0;
/// Chi-squared over its degrees of freedom beyond which noise does not explain an estimate. With hundreds of degrees it
/// scatters by a few percent about 0.85 to 1; noise levels that are read off the data are good to 5 %.
pub(crate) const LARGEST_MISFIT: f64 = 1.4;

/// The verdict on what an estimate says of itself.
pub(super) fn judge(
    evidence: &Evidence,
    status: FitStatus,
    scales: &Scales,
    largest_deviation: f64,
) -> Reliability {
    let mut reasons = Vec::new();
    if status != FitStatus::Converged {
        reasons.push(Reason::NotConverged { iterations: evidence.iterations });
    }
    // NaN counts as unknown.
    if evidence.weakest.deviation.is_nan() || evidence.weakest.deviation > largest_deviation {
        reasons.push(Reason::Unobservable { direction: evidence.weakest });
    }
    let among_others = evidence.log_odds.is_finite() && evidence.weakest.deviation > DEVIATION_AMONG_OTHERS;
    let largest_bias = if among_others { BIAS_AMONG_OTHERS } else { LARGEST_BIAS };
    if evidence.bias.is_nan() || evidence.bias > largest_bias {
        reasons.push(Reason::Biased { shift: evidence.bias });
    }
    if evidence.log_odds < LEAST_LOG_ODDS {
        reasons.push(Reason::Ambiguous { log_odds: evidence.log_odds });
    }
    // More than noise leaves, and more than the lasting errors of good data: what a wrong minimum leaves.
    let explained = (EXPLAINED * evidence.noise_explains).max(NEXT_TO_NOTHING * scales.velocity);
    if evidence.residual_rms.is_nan() || evidence.residual_rms > explained {
        reasons.push(Reason::Misfit { residual: evidence.residual_rms, explained: evidence.noise_explains });
    }
    if reasons.is_empty() { Reliability::Reliable } else { Reliability::Unreliable(reasons) }
}
