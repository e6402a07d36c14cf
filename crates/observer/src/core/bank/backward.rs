//! Modes and states after the fact, backward from what a bank recorded.

use super::bank::ModeState;
use super::error::BankError;
use super::gaussian::{Branch, Gaussian};
use super::log_weights::log_sum_exp;
use super::system::{Modes, check_sum};
use nalgebra::{DMatrix, DVector};

/// Modes and states at each sample given all samples, from `filtered`, what [`Bank::mode_states`](crate::bank::Bank::mode_states) said
/// after each one, and the `inputs` of the same samples.
///
/// Backward over each pair of modes with its jump, in the space of the later mode; what the future says is the smoothed
/// Gaussian divided by the predicted one, and nothing where that would take information away. With one mode it is the smoother
/// of Rauch, Tung and Striebel, and exact where the model is linear. With several it is **not reliable**: what a mode holds is
/// not one Gaussian (it was entered at different times). Where it was measured, probabilities beyond 0.99 were wrong twice as
/// often as those of exact paths (`docs/observer-banks.md`). For the modes use [`Bank::smoothed`](crate::bank::Bank::smoothed) with
/// eight hypotheses or more; this function adds states. States that are no vector space are treated as if they were one.
///
/// # Errors
/// [`BankError::Size`] for lists of unequal length or states that are not those of the modes; [`BankError::NotFinite`],
/// [`BankError::Sum`] and [`BankError::Value`] for what is no state and no probabilities; [`BankError::Covariance`] for a
/// covariance that is not positive definite; the errors of rates ([`Modes::with_rates`]).
pub fn smooth_backward<I>(
    modes: &Modes<I>,
    filtered: &[Vec<ModeState>],
    inputs: &[I],
) -> Result<Vec<Vec<ModeState>>, BankError> {
    if inputs.len() != filtered.len() {
        let (found, needed) = (inputs.len(), filtered.len());
        return Err(BankError::Size { what: "list of inputs", mode: 0, found, needed });
    }
    for (sample, states) in filtered.iter().enumerate() {
        check(modes, states, sample)?;
    }
    let mut smoothed = filtered.to_vec();
    for k in (1..filtered.len()).rev() {
        smoothed[k - 1] = step(modes, &filtered[k - 1], &inputs[k], &smoothed[k], k)?;
    }
    Ok(smoothed)
}

fn check<I>(modes: &Modes<I>, states: &[ModeState], sample: usize) -> Result<(), BankError> {
    if states.len() != modes.count() {
        let (found, needed) = (states.len(), modes.count());
        return Err(BankError::Size { what: "list of modes", mode: 0, found, needed });
    }
    for (mode, state) in states.iter().enumerate() {
        let needed = modes.member(mode).states();
        if !state.state.is_of_size(needed) {
            return Err(BankError::Size { what: "state", mode, found: state.state.mean.len(), needed });
        }
        if !state.state.is_finite() {
            return Err(BankError::NotFinite { what: "state", mode, sample });
        }
    }
    check_sum("mode probabilities", states.iter().map(|s| s.probability))
}

/// One mode before and the prediction of the mode after from it.
struct Pair {
    from: usize,
    log_weight: f64,
    predicted: Gaussian,
    /// Covariance of the state before and the predicted one.
    cross: DMatrix<f64>,
}

/// From the sample after to the one before.
fn step<I>(
    modes: &Modes<I>,
    before: &[ModeState],
    input: &I,
    after: &[ModeState],
    sample: usize,
) -> Result<Vec<ModeState>, BankError> {
    let mut log_rows = vec![vec![0.0; modes.count()]; modes.count()];
    let possible = before.iter().enumerate().filter(|(_, b)| b.probability > 0.0);
    for (from, b) in possible {
        modes.log_row(from, &b.state, input, &mut log_rows[from])?;
    }
    // Branches of each mode before, with their joint probability with a mode after.
    let mut branches: Vec<Vec<Branch>> = before.iter().map(|_| Vec::new()).collect();
    for (to, then) in after.iter().enumerate().filter(|(_, then)| then.probability > 0.0) {
        let mut pairs = predictions(modes, before, &log_rows, to, input);
        let total = log_sum_exp(pairs.iter().map(|p| p.log_weight));
        pairs.iter_mut().for_each(|p| p.log_weight -= total);
        let future =
            Future::new(modes, to, &pairs, &then.state).ok_or(BankError::Covariance { mode: to, sample })?;
        let told: Vec<(f64, Gaussian)> = pairs
            .iter()
            .map(|pair| future.tell(pair, &before[pair.from].state))
            .collect::<Option<_>>()
            .ok_or(BankError::Covariance { mode: to, sample })?;
        let of = |(pair, (log_odds, _)): (&Pair, &(f64, Gaussian))| pair.log_weight + log_odds;
        let total = log_sum_exp(pairs.iter().zip(&told).map(of));
        for (pair, (log_odds, gaussian)) in pairs.iter().zip(told) {
            let weight = then.probability * (pair.log_weight + log_odds - total).exp();
            branches[pair.from].push(Branch { weight, gaussian });
        }
    }
    Ok(branches.into_iter().enumerate().map(|(mode, of)| merged(modes, mode, of, &before[mode])).collect())
}

/// What every mode before predicts for mode `to`.
fn predictions<I>(
    modes: &Modes<I>,
    before: &[ModeState],
    log_rows: &[Vec<f64>],
    to: usize,
    input: &I,
) -> Vec<Pair> {
    let possible = before
        .iter()
        .enumerate()
        .filter(|(from, b)| b.probability > 0.0 && log_rows[*from][to] > f64::NEG_INFINITY);
    possible
        .map(|(from, b)| {
            let member = modes.member(to);
            let mut predicted = Gaussian::zeros(member.states());
            modes.land(from, to, &b.state, input, &mut predicted);
            let flow = member.transition(&predicted, input);
            let whole =
                modes.jump(from, to).map_or_else(|| flow.clone(), |jump| &flow * jump.map(&b.state, input));
            member.predict(&mut predicted, input);
            let cross = &b.state.covariance * whole.transpose();
            Pair { from, log_weight: b.probability.ln() + log_rows[from][to], predicted, cross }
        })
        .collect()
}

/// What the samples after say about the predicted state of one mode: a Gaussian in information form.
struct Future {
    information: DMatrix<f64>,
    vector: DVector<f64>,
}

impl Future {
    /// The smoothed Gaussian divided by the predicted one. None where a covariance cannot be inverted.
    fn new<I>(modes: &Modes<I>, to: usize, pairs: &[Pair], smoothed: &Gaussian) -> Option<Self> {
        let branches: Vec<Branch> = pairs
            .iter()
            .map(|p| Branch { weight: p.log_weight.exp(), gaussian: p.predicted.clone() })
            .collect();
        let mut predicted = Gaussian::zeros(smoothed.mean.len());
        modes.member(to).merge(&branches, &mut predicted);
        // In deviations of the predicted state, so that units do not matter to what is cut off below.
        let root = predicted.covariance.cholesky()?.unpack();
        let whitened = root.solve_lower_triangular(&smoothed.covariance)?.transpose();
        let mut eigen = root.solve_lower_triangular(&whitened)?.symmetric_eigen();
        // Smoothed mean along each eigenvector, and then what the future says of it: information, and that times the mean.
        let mut told = eigen.eigenvectors.transpose()
            * root.solve_lower_triangular(&(&smoothed.mean - &predicted.mean))?;
        for (value, told) in eigen.eigenvalues.iter_mut().zip(told.iter_mut()) {
            if *value <= 0.0 {
                return None;
            }
            // Where the future seems to take information away, moments were matched that are not Gaussian: it says nothing.
            *told = if *value < 1.0 { *told / *value } else { 0.0 };
            *value = (1.0 / *value - 1.0).max(0.0);
        }
        let back = root.transpose();
        let half = back.solve_upper_triangular(&eigen.eigenvectors)?;
        let information = &half * DMatrix::from_diagonal(&eigen.eigenvalues) * half.transpose();
        let vector = half * told + &information * predicted.mean;
        Some(Self { information, vector })
    }

    /// Logarithm of what the future adds to a pair's odds, and the state before given that pair and the future.
    fn tell(&self, pair: &Pair, before: &Gaussian) -> Option<(f64, Gaussian)> {
        let Pair { predicted: Gaussian { mean, covariance: p }, cross, .. } = pair;
        let b = DMatrix::identity(mean.len(), mean.len()) + p * &self.information;
        let lu = b.clone().lu();
        let surprise = &self.vector - &self.information * mean;
        let told_covariance = lu.solve(p)?;
        let quadratic = surprise.dot(&(&told_covariance * &surprise));
        let log_odds = -0.5 * lu.determinant().ln() + self.vector.dot(mean)
            - 0.5 * mean.dot(&(&self.information * mean))
            + 0.5 * quadratic;
        let gain = cross * inverse(p)?;
        let told_mean = lu.solve(&(mean + p * &self.vector))?;
        let covariance = &before.covariance + &gain * (told_covariance - p) * gain.transpose();
        let covariance = (&covariance + covariance.transpose()) * 0.5;
        Some((log_odds, Gaussian { mean: &before.mean + gain * (told_mean - mean), covariance }))
    }
}

fn inverse(covariance: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    covariance.clone().cholesky().map(|c| c.inverse())
}

/// One mode before, from its branches; as it was where none of them has any probability.
fn merged<I>(modes: &Modes<I>, mode: usize, mut branches: Vec<Branch>, filtered: &ModeState) -> ModeState {
    let probability: f64 = branches.iter().map(|b| b.weight).sum();
    let mut state = filtered.state.clone();
    if probability > 0.0 {
        branches.iter_mut().for_each(|b| b.weight /= probability);
        modes.member(mode).merge(&branches, &mut state);
    }
    ModeState { probability, state }
}
