//! The most probable motion: states, constants and data adjusted together, over all nodes of a log.

use super::state_space::{NodeInput, ThreePalmModel, Touch, set_adjusted_arms};
use crate::core::{BatchOptions, BatchSolution, ObserverError, Sample, Start, Status, solve_batch_along};
use nalgebra::SVector;

/// Linearisations at most, in each of the two passes.
pub(super) const ITERATIONS: usize = 15;
/// Length of a step at which the iteration has settled, in relative contact noise.
pub(super) const STEP_TOLERANCE: f64 = 0.01;
/// Longest step of the state at the start, in natural sizes: over more of them nothing is linear. With 0.3 a start that wrong
/// force gains had led astray did not arrive in time.
const LONGEST_STEP: f64 = 1.0;
/// Deviation, in natural units, of the turning rates in the first pass: the start is not better known.
pub(super) const FIRST_SLIDE: f64 = 0.1;
/// Root mean square residual, in deviations, from which a pass that did not settle leads nowhere.
const HOPELESS: f64 = 10.0;
/// Passes: each takes from the one before what derivatives and weights must not take from noisy data.
pub(super) const PASSES: usize = 3;
/// Those that tell motions apart.
pub(super) const FIRST_PASS: usize = 1;

/// A motion and how probable it is.
pub(super) struct MostProbable<const N: usize> {
    pub(super) solution: BatchSolution<N>,
    /// Minus twice the logarithm of the probability mass about the motion, up to a constant that all motions of a log share
    /// (Laplace's approximation). Chi-squared alone does not compare motions: noise counts for less in one that leaves it
    /// more room, so that wrong minima with a smaller chi-squared than the truth are common in short logs.
    pub(super) improbability: f64,
    /// What chi-squared lacks of its expectation, since turning rates are uncertain: more of them in one motion than in another.
    pub(super) shortfall: f64,
}

/// Gauss-Newton on the whole motion, relinearised at the adjusted data: Gauss-Helmert estimation in linear time.
///
/// In two passes: the noise of a contact condition depends on how fast the body turns against the palm, and its
/// expectation on how well that is known. The second pass takes it from the first.
pub(super) fn most_probable<const N: usize>(
    model: &ThreePalmModel<N>,
    inputs: &[NodeInput],
    states: &[SVector<f64, N>],
    prior: &Start<N>,
    reach: f64,
    passes: usize,
) -> Result<MostProbable<N>, ObserverError> {
    let t: Vec<f64> = inputs
        .iter()
        .scan(0.0, |t, input| {
            *t += input.duration;
            Some(*t)
        })
        .collect();
    let rate = model.natural_rate();
    let mut samples: Vec<Sample<NodeInput, 3>> = inputs
        .iter()
        // The contact condition is zero, and the model gives it in standard deviations.
        .map(|&input| Sample { input, measured: SVector::zeros(), information: SVector::repeat(1.0) })
        .collect();
    set_slides(&mut samples, |_, _| [(FIRST_SLIDE * rate).powi(2); 3]);
    let options = BatchOptions {
        iterations: ITERATIONS,
        step_tolerance: STEP_TOLERANCE * model.relative_noise(),
        damping: 0.0,
        longest_step: LONGEST_STEP,
    };
    let mut found = solve_batch_along(model, &samples, prior, states, &options)?;
    let mut iterations = found.iterations;
    for _ in 1..passes {
        let lost = found.report.status == Status::Moving && found.report.residual > HOPELESS;
        if lost || found.report.status == Status::Diverged {
            return Ok(MostProbable { solution: found, improbability: f64::INFINITY, shortfall: 0.0 });
        }
        set_slides(&mut samples, |k, touch| {
            model.slide_variances(&found.states[k], &found.covariances[k], touch)
        });
        for (sample, states) in samples.iter_mut().skip(1).zip(found.states.windows(2)) {
            sample.input.correction = model.missing_impulse(&states[0], &states[1], &sample.input);
        }
        let adjusted: Vec<_> =
            samples.iter().zip(&found.states).map(|(s, x)| model.adjusted_arms(x, &s.input.here)).collect();
        set_adjusted_arms(samples.iter_mut().map(|s| &mut s.input), &t, &adjusted, reach);
        found = solve_batch_along(model, &samples, prior, &found.states, &options)?;
        iterations += found.iterations;
    }
    let sum = |of_node: &dyn Fn(&SVector<f64, N>, &Touch) -> f64| -> f64 {
        samples.iter().zip(&found.states).map(|(s, x)| of_node(x, &s.input.here)).sum()
    };
    let of_outputs = sum(&|x, touch| model.log_variances(x, touch));
    let shortfall = sum(&|x, touch| model.shortfall(x, touch));
    let improbability = found.chi_squared + found.prior_cost + found.log_determinant + of_outputs;
    Ok(MostProbable { solution: BatchSolution { iterations, ..found }, improbability, shortfall })
}

fn set_slides(samples: &mut [Sample<NodeInput, 3>], slide: impl Fn(usize, &Touch) -> [f64; 3]) {
    for k in 0..samples.len() {
        let variance = slide(k, &samples[k].input.here);
        samples[k].input.here.slide_variance = variance;
        if let Some(next) = samples.get_mut(k + 1) {
            next.input.from.slide_variance = variance;
        }
    }
    if let [first, ..] = samples {
        first.input.from.slide_variance = first.input.here.slide_variance;
    }
}
