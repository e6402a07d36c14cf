//! Whether an estimate is to be relied on, by the evidence for it.

use super::cold_start::{EXPLAINED, NEXT_TO_NOTHING};
use super::estimate::WORTH_ADJUSTING;
use super::evidence::{Evidence, Reason, Reliability};
use super::momentum::Scales;
use crate::least_squares::FitStatus;

/// A direction of the unknowns known to worse than this share of its natural size makes the estimate unreliable: the
/// linearisation that its covariance comes from does not reach that far. An error of five deviations without another warning
/// was seen at 0.24 (two palms 30 degrees apart), none below 0.2.
pub(crate) const LARGEST_DEVIATION: f64 = 0.15;
/// The same of a plain least-squares fit, whose covariance is not widened by what is beyond first order.
const LARGEST_PLAIN_DEVIATION: f64 = 0.1;
/// Chi-squared over its degrees of freedom beyond which noise does not explain an estimate. With hundreds of degrees it
/// scatters by a few percent about 0.85 to 1; noise levels that are read off the data are good to 5 %.
pub(crate) const LARGEST_MISFIT: f64 = 1.4;

/// The verdict on what an estimate says of itself.
pub(super) fn judge(evidence: &Evidence, status: FitStatus, scales: &Scales) -> Reliability {
    let mut reasons = Vec::new();
    if status != FitStatus::Converged {
        reasons.push(Reason::NotConverged { iterations: evidence.iterations });
    }
    // NaN counts as unknown.
    if evidence.weakest.deviation.is_nan() || evidence.weakest.deviation > LARGEST_PLAIN_DEVIATION {
        reasons.push(Reason::Unobservable { direction: evidence.weakest });
    }
    if evidence.noise.contact > WORTH_ADJUSTING * scales.length {
        reasons.push(Reason::Noisy { contact: evidence.noise.contact });
    }
    // More than noise leaves, and more than the lasting errors of good data: what a wrong minimum leaves.
    let explained = (EXPLAINED * evidence.noise_explains).max(NEXT_TO_NOTHING * scales.velocity);
    if evidence.residual_rms.is_nan() || evidence.residual_rms > explained {
        reasons.push(Reason::Misfit { residual: evidence.residual_rms, explained: evidence.noise_explains });
    }
    if reasons.is_empty() { Reliability::Reliable } else { Reliability::Unreliable(reasons) }
}
