//! All samples at once, a few of them at a time: the batch solution for a caller that must not be kept waiting.

use super::model::{Model, Sample};
use super::newton::{NewtonObserver, NewtonOptions};
use super::report::ScaledInformation;
use super::window::{Start, Window};
use nalgebra::{SMatrix, SVector};
use std::collections::VecDeque;

/// Gauss-Newton over all samples of a stretch with process noise, in portions of bounded work.
pub(crate) struct Smoother<Mo: Model<N, M>, const N: usize, const M: usize> {
    model: Mo,
    scales: SVector<f64, N>,
    damping: f64,
    samples: VecDeque<Sample<Mo::Input, M>>,
    window: Window<N, M>,
    phase: Phase<N>,
    information: Option<ScaledInformation<N>>,
    /// Covariance at the node that was carried to last.
    covariance: SMatrix<f64, N, N>,
}

enum Phase<const N: usize> {
    Linearise(usize),
    Eliminate(usize),
    Apply(usize, SVector<f64, N>),
    Carry(usize),
}

/// What a portion of work has brought to an end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Portion {
    /// Nothing yet.
    Going,
    /// A Gauss-Newton step over all samples; its largest part in natural units. NaN where it is no number.
    Stepped(f64),
    /// The covariances of all samples.
    Carried,
}

impl<Mo: Model<N, M>, const N: usize, const M: usize> Smoother<Mo, N, M> {
    /// Without samples, with room for some; `damping` as in [`NewtonOptions`].
    pub(crate) fn new(model: Mo, start: &Start<N>, damping: f64, room: usize) -> Self {
        Self {
            scales: model.scales(),
            damping,
            samples: VecDeque::with_capacity(room),
            window: Window::new(start, room),
            model,
            phase: Phase::Linearise(0),
            information: None,
            covariance: SMatrix::zeros(),
        }
    }

    /// Appends a sample, its state by the flow, and begins anew with the linearisation.
    pub(crate) fn append(&mut self, sample: Sample<Mo::Input, M>) {
        self.window.append(&self.model, &sample.input);
        self.samples.push_back(sample);
        self.phase = Phase::Linearise(0);
    }

    pub(crate) fn len(&self) -> usize {
        self.samples.len()
    }

    pub(crate) fn model(&self) -> &Mo {
        &self.model
    }

    /// Shows every sample but the first, to be changed, with the states before it and at it.
    pub(crate) fn amend(
        &mut self,
        mut change: impl FnMut(&Mo, &SVector<f64, N>, &SVector<f64, N>, &mut Sample<Mo::Input, M>),
    ) {
        for (k, sample) in self.samples.iter_mut().enumerate().skip(1) {
            change(&self.model, self.window.state(k - 1), self.window.state(k), sample);
        }
    }

    /// The samples, to be changed.
    pub(crate) fn samples_mut(&mut self) -> impl Iterator<Item = &mut Sample<Mo::Input, M>> {
        self.samples.iter_mut()
    }

    /// Squared residuals of outputs and process noise in units of their deviations, and the outputs' number.
    pub(crate) fn chi_squared(&self) -> (f64, usize) {
        (self.window.data_cost() + self.window.noise_cost(), self.window.channels())
    }

    /// Covariance at the last sample, once all are carried to.
    pub(crate) fn last_covariance(&self) -> &SMatrix<f64, N, N> {
        &self.covariance
    }

    /// Goes on for as many samples. After [`Self::carry`] the covariances follow; each is shown with its sample and state.
    pub(crate) fn work(
        &mut self,
        portion: usize,
        mut seen: impl FnMut(&Mo, &Sample<Mo::Input, M>, &SVector<f64, N>, &SMatrix<f64, N, N>),
    ) -> Portion {
        let last = self.samples.len().saturating_sub(1);
        for _ in 0..portion {
            match &mut self.phase {
                Phase::Linearise(k) => {
                    let Some(sample) = self.samples.get(*k) else { return Portion::Going };
                    self.window.linearise_node(&self.model, *k, sample);
                    self.phase = if *k == last { Phase::Eliminate(last) } else { Phase::Linearise(*k + 1) };
                }
                Phase::Eliminate(k) => {
                    self.window.eliminate_node(*k);
                    if *k > 0 {
                        self.phase = Phase::Eliminate(*k - 1);
                        continue;
                    }
                    let information = self.window.information(&self.scales);
                    let step = self.window.step(&self.model, &information, self.damping);
                    self.information = Some(information);
                    self.phase = Phase::Apply(0, step);
                }
                Phase::Apply(k, step) => {
                    self.window.apply_node(&self.model, *k, step);
                    if *k < last {
                        *k += 1;
                        continue;
                    }
                    let size = step.component_div(&self.scales);
                    let finite = self.window.is_finite() && size.iter().all(|v| v.is_finite());
                    self.phase = Phase::Linearise(0);
                    return Portion::Stepped(if finite { size.amax() } else { f64::NAN });
                }
                Phase::Carry(k) => {
                    let first = || self.information.as_ref().map(ScaledInformation::covariance);
                    self.covariance = match *k {
                        0 => first().unwrap_or_else(SMatrix::zeros),
                        k => self.window.next_covariance(k, &self.covariance),
                    };
                    if let Some(sample) = self.samples.get(*k) {
                        seen(&self.model, sample, self.window.state(*k), &self.covariance);
                    }
                    if *k < last {
                        *k += 1;
                        continue;
                    }
                    self.phase = Phase::Linearise(0);
                    return Portion::Carried;
                }
            }
        }
        Portion::Going
    }

    /// The covariances come next, as of the latest linearisation.
    pub(crate) fn carry(&mut self) {
        self.phase = Phase::Carry(0);
    }

    /// Drops the first sample; what it said is kept in that share.
    pub(crate) fn drop_first(&mut self, keep: f64) {
        self.window.drop_first(&self.model, keep);
        self.samples.pop_front();
    }

    /// An observer that goes on from here; none where `options` are not usable or more samples are left than its window
    /// holds.
    pub(crate) fn into_observer(self, options: NewtonOptions) -> Option<NewtonObserver<Mo, N, M>> {
        (self.samples.len() <= options.window)
            .then(|| NewtonObserver::going_on(self.model, options, self.samples, self.window))
            .flatten()
    }
}
