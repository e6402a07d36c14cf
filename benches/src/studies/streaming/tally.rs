//! What came of a stream over many scenes.

use nalgebra::SVector;
use recon::observer::contacts::stream::{StreamEstimate, StreamStage};
use recon_benches::streaming::Case;

/// Deviations beyond which a stated number is wrong without a warning.
const SILENT: f64 = 5.0;

#[derive(Default)]
pub(super) struct Tally {
    scenes: usize,
    /// Of each scene with a motion: natural times up to it, share of the samples since at which one is stated, mean squared error, largest
    /// one in deviations.
    firsts: Vec<f64>,
    available: Vec<f64>,
    means: Vec<f64>,
    worst: Vec<f64>,
    /// By what share moments are off at the last stated sample.
    moments: Vec<f64>,
    lost: usize,
}

impl Tally {
    /// Looks at the estimates after the time `from`, s.
    pub(super) fn take(&mut self, case: &Case, estimates: &[(usize, StreamEstimate)], from: f64) {
        self.scenes += 1;
        let estimates: Vec<_> = estimates.iter().filter(|(_, e)| e.t > from).collect();
        let known = |e: &StreamEstimate| e.stage == StreamStage::Tracking;
        let Some(first) = estimates.iter().position(|(_, e)| known(e)) else { return };
        let since = from.max(case.start());
        self.firsts.push((estimates[first].1.t - since) / case.natural);
        let after = &estimates[first..];
        let stated: Vec<_> = after.iter().filter(|(_, e)| known(e)).collect();
        self.available.push(stated.len() as f64 / after.len() as f64);
        self.lost += after.windows(2).filter(|pair| known(&pair[0].1) && !known(&pair[1].1)).count();
        let errors: Vec<[f64; 2]> = stated.iter().filter_map(|(k, e)| errors(case, *k, e)).collect();
        self.means.push(errors.iter().map(|e| e[0]).sum::<f64>() / errors.len().max(1) as f64);
        self.worst.push(errors.iter().map(|e| e[1]).fold(0.0, f64::max));
        let last = stated.last().and_then(|(_, e)| e.motion.as_ref());
        self.moments.extend(last.map(|motion| case.moments_off(&motion.body)));
    }

    pub(super) fn row(&mut self) -> String {
        let found = format!(" {} of {} |", self.firsts.len(), self.scenes);
        found + &self.after_gap()
    }

    pub(super) fn after_gap(&mut self) -> String {
        for of in [&mut self.firsts, &mut self.available, &mut self.means, &mut self.moments] {
            of.sort_by(f64::total_cmp);
        }
        let mean = |of: &[f64]| of.iter().sum::<f64>() / of.len().max(1) as f64;
        let at = |of: &[f64], p: f64| quantile(of, p);
        let silent = self.worst.iter().filter(|worst| **worst > SILENT).count();
        format!(
            " {:.2}, {:.2} | {:.4}, {:.3} | {} | {:.2}, {:.2} | {silent} of {} | {:.2} |",
            at(&self.firsts, 0.5),
            at(&self.firsts, 1.0),
            mean(&self.available),
            at(&self.available, 0.0),
            self.lost,
            mean(&self.means),
            at(&self.means, 1.0),
            self.worst.len(),
            100.0 * at(&self.moments, 0.5)
        )
    }
}

/// Mean of the normalised squares of nine errors, and the largest of them in its own deviation.
fn errors(case: &Case, k: usize, estimate: &StreamEstimate) -> Option<[f64; 2]> {
    let (found, truth) = (estimate.motion?, case.truth.get(k)?);
    let parts = [
        found.state.p_WCm - truth.touch.p_WCm,
        found.state.v_WCm - truth.rates.v_WCm,
        found.state.w_WO - truth.w_WO,
    ];
    let error = SVector::<f64, 9>::from_fn(|i, _| parts[i / 3][i % 3]);
    let covariance = found.covariance.fixed_view::<9, 9>(0, 0).into_owned();
    let largest = (0..9).map(|i| error[i].abs() / covariance[(i, i)].sqrt()).fold(0.0, f64::max);
    Some([error.dot(&covariance.cholesky()?.solve(&error)) / 9.0, largest])
}

pub(super) fn quantile(sorted: &[f64], p: f64) -> f64 {
    sorted.get(((sorted.len() as f64 - 1.0) * p) as usize).copied().unwrap_or(f64::NAN)
}
