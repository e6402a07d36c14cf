//! Gauss-Newton on a stretch of samples: linearise forward, eliminate backward, step forward.

use super::model::{Model, Sample};
use super::node::{Link, Node, Prior};
use super::report::ScaledInformation;
use nalgebra::{SMatrix, SVector};
use std::collections::VecDeque;

/// Where an observer starts: a state, and how well it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start<const N: usize> {
    /// State at the first sample.
    pub state: SVector<f64, N>,
    /// Information (inverse covariance) of that state; zero for a mere guess, which then costs the estimate nothing.
    pub information: SMatrix<f64, N, N>,
}

impl<const N: usize> Start<N> {
    /// A guess: starts the iteration, but is no evidence.
    #[must_use]
    pub fn guess(state: SVector<f64, N>) -> Self {
        Self { state, information: SMatrix::zeros() }
    }

    /// A prior with independent standard deviations.
    #[must_use]
    pub fn prior(state: SVector<f64, N>, deviations: &SVector<f64, N>) -> Self {
        Self { state, information: SMatrix::from_diagonal(&deviations.map(|d| 1.0 / (d * d))) }
    }
}

/// Trajectory over the samples of a window, with room for a fixed number of them.
///
/// Minimises, over the states `x_k` and the process noise `w_k`,
/// `(x_0 - prior)' L_p (x_0 - prior) + sum w_k' Q_k^-1 w_k + sum |y_k - h(x_k)|^2_R^-1` with `x_k = flow(x_{k-1}) + w_k`.
/// The quadratic model is eliminated from the last sample to the first (a Riccati sweep), so the cost is linear in the
/// window's length and nothing larger than the state is ever inverted.
pub(super) struct Window<const N: usize, const M: usize> {
    nodes: VecDeque<Node<N, M>>,
    prior: Prior<N>,
    data_cost: f64,
    noise_cost: f64,
    channels: usize,
    /// Number of nodes, from the oldest on, that the last linearisation covered.
    linearised: usize,
    /// Information and vector that the node eliminated last hands to the one before it.
    carried: (SMatrix<f64, N, N>, SVector<f64, N>),
    /// Step of the node that was moved last.
    moved: SVector<f64, N>,
}

impl<const N: usize, const M: usize> Window<N, M> {
    pub(super) fn new(start: &Start<N>, capacity: usize) -> Self {
        let prior = Prior { at: start.state, information: start.information, vector: SVector::zeros() };
        Self {
            nodes: VecDeque::with_capacity(capacity),
            prior,
            data_cost: 0.0,
            noise_cost: 0.0,
            channels: 0,
            linearised: 0,
            carried: (SMatrix::zeros(), SVector::zeros()),
            moved: SVector::zeros(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.nodes.len()
    }

    /// Number of nodes, from the oldest on, that the last linearisation covered.
    pub(super) fn linearised(&self) -> usize {
        self.linearised
    }

    /// State at sample `k` of the window.
    pub(super) fn state(&self, k: usize) -> &SVector<f64, N> {
        &self.nodes[k].x
    }

    /// All states of the window, oldest first.
    pub(super) fn states(&self) -> impl Iterator<Item = &SVector<f64, N>> {
        self.nodes.iter().map(|node| &node.x)
    }

    /// Twice the cost at the point of the last linearisation, process noise apart.
    pub(super) fn cost<Mo: Model<N, M>>(&self, model: &Mo) -> f64 {
        self.data_cost + self.prior_cost(model)
    }

    /// Twice the cost of the prior at the point of the last linearisation.
    pub(super) fn prior_cost<Mo: Model<N, M>>(&self, model: &Mo) -> f64 {
        self.prior.cost(&model.difference(&self.nodes[0].at, &self.prior.at))
    }

    /// Twice the cost of the outputs at the point of the last linearisation.
    pub(super) fn data_cost(&self) -> f64 {
        self.data_cost
    }

    /// Twice the cost of the process noise that the last [`Self::apply`] found.
    pub(super) fn noise_cost(&self) -> f64 {
        self.noise_cost
    }

    /// Channels measured, as of the last linearisation.
    pub(super) fn channels(&self) -> usize {
        self.channels
    }

    /// Root mean square residual at the last linearisation, in units of the noise.
    pub(super) fn residual(&self) -> f64 {
        (self.data_cost / self.channels as f64).sqrt()
    }

    /// Whether every state is a number.
    pub(super) fn is_finite(&self) -> bool {
        self.nodes.iter().all(|node| node.x.iter().all(|v| v.is_finite()))
    }

    /// Appends a sample; its state follows from the last one by the flow.
    pub(super) fn append<Mo: Model<N, M>>(&mut self, model: &Mo, input: &Mo::Input) {
        let x = self.nodes.back().map_or(self.prior.at, |last| model.advance(&last.x, input));
        self.nodes.push_back(Node::new(x));
    }

    /// Nodes at the given states, in place of all that there were.
    pub(super) fn set_states(&mut self, states: &[SVector<f64, N>]) {
        self.nodes.clear();
        self.nodes.extend(states.iter().map(|&x| Node::new(x)));
    }

    /// Sets the first state and lets the flow fill in the others.
    pub(super) fn roll_out<'a, Mo: Model<N, M, Input: 'a>>(
        &mut self,
        model: &Mo,
        samples: impl Iterator<Item = &'a Sample<Mo::Input, M>>,
        first: SVector<f64, N>,
    ) {
        let mut x = first;
        for (k, (node, sample)) in self.nodes.iter_mut().zip(samples).enumerate() {
            if k > 0 {
                x = model.advance(&x, &sample.input);
            }
            node.x = x;
        }
    }

    /// Linearises about the present trajectory and eliminates backward.
    pub(super) fn linearise<'a, Mo: Model<N, M, Input: 'a>>(
        &mut self,
        model: &Mo,
        samples: impl Iterator<Item = &'a Sample<Mo::Input, M>>,
    ) {
        for (k, sample) in samples.take(self.nodes.len()).enumerate() {
            self.linearise_node(model, k, sample);
        }
        for k in (0..self.nodes.len()).rev() {
            self.eliminate_node(k);
        }
    }

    /// Linearises about the present state of node `k`: from the first node to the last.
    pub(super) fn linearise_node<Mo: Model<N, M>>(
        &mut self,
        model: &Mo,
        k: usize,
        sample: &Sample<Mo::Input, M>,
    ) {
        if k == 0 {
            (self.data_cost, self.channels) = (0.0, 0);
        }
        self.linearised = k + 1;
        let before = k.checked_sub(1).map(|k| self.nodes[k].x);
        let node = &mut self.nodes[k];
        let x = node.x;
        node.at = x;
        if let Some(previous) = before {
            let (end, transition) = model.flow(&previous, &sample.input);
            (node.defect, node.transition) = (model.difference(&end, &x), transition);
            node.noise = model.process_noise(&previous, &sample.input).map(|q| (SMatrix::identity(), q));
        }
        let (y, h) = model.output(&x, &sample.input);
        node.own_information = SMatrix::zeros();
        node.own_vector = SVector::zeros();
        for channel in 0..M {
            let weight = sample.information[channel];
            if weight > 0.0 {
                let residual = sample.measured[channel] - y[channel];
                let row = h.row(channel).transpose();
                node.own_information += row * row.transpose() * weight;
                node.own_vector += row * (weight * residual);
                self.data_cost += weight * residual * residual;
                self.channels += 1;
            }
        }
    }

    /// Cost-to-go of node `k` from that of the one after it: from the last node to the first.
    pub(super) fn eliminate_node(&mut self, k: usize) {
        if k + 1 >= self.nodes.len() {
            self.carried = (SMatrix::zeros(), SVector::zeros());
        }
        let node = &mut self.nodes[k];
        node.information = node.own_information + self.carried.0;
        node.vector = node.own_vector + self.carried.1;
        if k == 0 {
            return;
        }
        let (mut l, mut b) = (node.information, node.vector - node.information * node.defect);
        if let Some((gain, q)) = &mut node.noise {
            // Q and L are positive semidefinite, hence I + Q L has eigenvalues of at least one.
            let inverse = (SMatrix::identity() + *q * l).try_inverse();
            *gain = inverse.unwrap_or_else(SMatrix::identity);
            l *= *gain;
            b = gain.transpose() * b;
        }
        let back = node.transition.transpose();
        self.carried = (back * l * node.transition, back * b);
    }

    /// Information about the first state from the data and the prior, in natural units.
    pub(super) fn information(&self, scales: &SVector<f64, N>) -> ScaledInformation<N> {
        ScaledInformation::new(&(self.nodes[0].information + self.prior.information), scales)
    }

    /// Gauss-Newton step of the first state, damped by `damping` in natural units.
    pub(super) fn step<Mo: Model<N, M>>(
        &self,
        model: &Mo,
        information: &ScaledInformation<N>,
        damping: f64,
    ) -> SVector<f64, N> {
        let first = &self.nodes[0];
        let from_prior = model.difference(&first.at, &self.prior.at);
        information.solve(&(first.vector + self.prior.pull(&from_prior)), damping)
    }

    /// Applies a step of the first state to all states by the linear model, process noise at its best value.
    pub(super) fn apply<Mo: Model<N, M>>(&mut self, model: &Mo, step: SVector<f64, N>) {
        for k in 0..self.nodes.len() {
            self.apply_node(model, k, &step);
        }
    }

    /// Moves node `k`: from the first node, which takes the step, to the last.
    pub(super) fn apply_node<Mo: Model<N, M>>(&mut self, model: &Mo, k: usize, step: &SVector<f64, N>) {
        let node = &mut self.nodes[k];
        if k == 0 {
            (self.noise_cost, self.moved) = (0.0, *step);
        } else {
            let mut delta = node.transition * self.moved + node.defect;
            if let Some((gain, q)) = &node.noise {
                delta = gain * (delta + q * node.vector);
                // The noise is Q times the slope of the cost-to-go, and costs slope' Q slope.
                let slope = node.vector - node.information * delta;
                self.noise_cost += slope.dot(&(q * slope));
            }
            self.moved = delta;
        }
        node.x = model.retract(&node.at, &self.moved);
    }

    /// Carries the covariance of the first state to the last.
    pub(super) fn last_covariance(&self, first: SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
        let mut p = first;
        for node in self.nodes.iter().skip(1) {
            p = node.carried(&p);
        }
        p
    }

    /// Logarithm of the determinant of the information about all states, those of the process noise relative to what is
    /// known of it beforehand.
    pub(super) fn log_determinant(&self) -> f64 {
        let first = log_determinant(self.nodes[0].information + self.prior.information);
        // The gain is (I + Q L)^-1.
        let of_noise = |node: &Node<N, M>| node.noise.map_or(0.0, |(gain, _)| log_determinant(gain));
        first - self.nodes.iter().map(of_noise).sum::<f64>()
    }

    /// Covariances of all states, oldest first, from that of the first.
    pub(super) fn covariances(&self, first: SMatrix<f64, N, N>) -> Vec<SMatrix<f64, N, N>> {
        let mut p = first;
        let one = |(k, node): (usize, &Node<N, M>)| {
            if k > 0 {
                p = node.carried(&p);
            }
            p
        };
        self.nodes.iter().enumerate().map(one).collect()
    }

    /// How each deviation follows the one before, from the second node on.
    pub(super) fn links(&self) -> Vec<Link<N>> {
        self.nodes.iter().skip(1).map(Node::link).collect()
    }

    /// Drops the first sample. What it and the prior said is carried to the next one, weakened by `keep` (one: all of
    /// it, zero: none), as linearised last.
    pub(super) fn drop_first<Mo: Model<N, M>>(&mut self, model: &Mo, keep: f64) {
        let Some(first) = self.nodes.pop_front() else { return };
        self.linearised = self.linearised.saturating_sub(1);
        let Some(next) = self.nodes.front() else { return };
        let mut prior = Prior { at: next.at, information: SMatrix::zeros(), vector: SVector::zeros() };
        let backward = if keep > 0.0 { next.transition.try_inverse() } else { None };
        if let Some(backward) = backward {
            let known = self.prior.information + first.own_information;
            let mut information = backward.transpose() * known * backward;
            let mut vector = backward.transpose()
                * (first.own_vector + self.prior.pull(&model.difference(&first.at, &self.prior.at)));
            if let Some((_, q)) = &next.noise {
                let weaken = (SMatrix::identity() + information * q).try_inverse();
                let weaken = weaken.unwrap_or_else(SMatrix::identity);
                information = weaken * information;
                vector = weaken * vector;
            }
            prior.information = (information + information.transpose()) * (0.5 * keep);
            prior.vector = (vector + information * next.defect) * keep;
        }
        self.prior = prior;
    }
}

/// Logarithm of the absolute value of a determinant, by elimination with row pivots.
fn log_determinant<const N: usize>(mut a: SMatrix<f64, N, N>) -> f64 {
    let mut sum = 0.0;
    for k in 0..N {
        let pivot = (k..N).fold(k, |best, i| if a[(i, k)].abs() > a[(best, k)].abs() { i } else { best });
        a.swap_rows(k, pivot);
        sum += a[(k, k)].abs().ln();
        let row = a.row(k) / a[(k, k)];
        for i in k + 1..N {
            let factor = a[(i, k)];
            for j in k + 1..N {
                a[(i, j)] -= factor * row[j];
            }
        }
    }
    sum
}
