//! Inputs of the state-space model from a track: a node for every few samples.

use super::input::{NodeInput, PalmTouch, Touch, Wrench};
use crate::three_palms::quadrature::running_integral_into;
use crate::three_palms::track::Track;
use glam::DVec3;
use nalgebra::{Matrix3, Vector3};
use std::ops::Range;

/// Integrals of one palm and their rates at every sample.
#[derive(Debug, Default)]
struct Series {
    rates: Vec<Wrench>,
    integrals: Vec<Wrench>,
}

impl Series {
    /// Of a track, in place of what there was.
    fn fill(&mut self, track: &Track, palm: usize) {
        let one = |(node, &t): (&crate::three_palms::track::Node, &f64)| {
            let n = node.palms[palm].frame.n;
            let unit = Wrench { impulse: n, first: n * t, torque: node.p_WC[palm].cross(n) };
            unit * node.forces[palm]
        };
        self.rates.clear();
        self.rates.extend(track.nodes.iter().zip(&track.t).map(one));
        running_integral_into(&track.t, &self.rates, Wrench::default(), &mut self.integrals);
    }

    /// Cubic Hermite interpolation between samples.
    fn at(&self, t: &[f64], time: f64) -> Wrench {
        let next = t.partition_point(|&t| t < time).clamp(1, t.len() - 1);
        let (a, b) = (next - 1, next);
        let h = t[b] - t[a];
        let s = (time - t[a]) / h;
        let (s2, s3) = (s * s, s * s * s);
        self.integrals[a] * (2.0 * s3 - 3.0 * s2 + 1.0)
            + self.rates[a] * (h * (s3 - 2.0 * s2 + s))
            + self.integrals[b] * (3.0 * s2 - 2.0 * s3)
            + self.rates[b] * (h * (s3 - s2))
    }
}

/// The samples of one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Block {
    /// First sample.
    pub(crate) start: usize,
    /// Samples before and after the one in the middle, where the node stands.
    pub(crate) reach: usize,
}

impl Block {
    /// Sample of the node.
    pub(crate) fn node(&self) -> usize {
        self.start + self.reach
    }

    fn samples(&self) -> Range<usize> {
        self.start..self.start + 2 * self.reach + 1
    }
}

/// Inputs of one node after the other, on buffers that are made once.
#[derive(Debug, Default)]
pub(crate) struct NodeInputs {
    series: [Series; 3],
}

impl NodeInputs {
    /// Input of the node of block `here`, with the block `from` before it; nothing is smoothed.
    pub(crate) fn after(&mut self, track: &Track, from: &Block, here: &Block) -> NodeInput {
        for (palm, series) in self.series.iter_mut().enumerate() {
            series.fill(track, palm);
        }
        let start = track.t[from.node()];
        let duration = track.t[here.node()] - start;
        let (from, here) = (touch(track, from), touch(track, here));
        let halves = halves(&track.t, &self.series, start, duration);
        NodeInput { duration, halves, correction: DVec3::ZERO, from, here }
    }

    /// Input of a first node, with nothing before it.
    pub(crate) fn first(track: &Track, here: &Block) -> NodeInput {
        let here = touch(track, here);
        let halves = [[Wrench::default(); 3]; 2];
        NodeInput { duration: 0.0, halves, correction: DVec3::ZERO, from: here, here }
    }
}

fn halves(t: &[f64], series: &[Series; 3], start: f64, duration: f64) -> [[Wrench; 3]; 2] {
    if duration <= 0.0 {
        return [[Wrench::default(); 3]; 2];
    }
    let half = 0.5 * duration;
    std::array::from_fn(|part| {
        let begin = start + part as f64 * half;
        std::array::from_fn(|i| {
            let (a, b) = (series[i].at(t, begin), series[i].at(t, begin + half));
            let change = b + a * -1.0;
            // The first moment about the start of the half.
            Wrench { first: change.first - change.impulse * begin, ..change }
        })
    })
}

/// Means and moments over a block.
fn touch(track: &Track, block: &Block) -> Touch {
    let (at, count) = (block.node(), block.samples().len() as f64);
    let share = 1.0 / count;
    let palms = std::array::from_fn(|i| {
        let palm = &track.nodes[at].palms[i];
        let zero = [DVec3::ZERO; 3];
        let mut sum = PalmTouch {
            frame: palm.frame,
            rate: palm.rate,
            normal: zero,
            arm: zero,
            smooth_arm: DVec3::ZERO,
            own_share: 1.0,
            lift: 0.0,
            force: [DVec3::ZERO; 2],
            torque: [DVec3::ZERO; 2],
        };
        for k in block.samples() {
            let (node, u) = (&track.nodes[k], track.t[k] - track.t[at]);
            let n = node.palms[i].frame.n;
            let arm = n.cross(node.p_WC[i]);
            for (power, weight) in [share, share * u, share * 0.5 * u * u].into_iter().enumerate() {
                sum.normal[power] += n * weight;
                sum.arm[power] += arm * weight;
            }
            sum.lift += node.lift[i] * share;
            sum.force[0] += n * (node.forces[i] * share);
            sum.torque[0] -= arm * (node.forces[i] * share);
        }
        sum.smooth_arm = sum.arm[0];
        sum
    });
    Touch {
        palms,
        samples: count,
        spacing: track.duration() / (track.len() - 1).max(1) as f64,
        slide_variance: [0.0; 3],
    }
}

/// Replaces the arms in derivatives by smoothed ones of contacts that an estimate has adjusted.
///
/// A derivative must not hold the noise that it is multiplied with: not that of its own condition, and, since noise of the
/// forces ties neighbouring conditions together, not that of its neighbours.
pub(crate) fn set_adjusted_arms<'a>(
    inputs: impl Iterator<Item = &'a mut NodeInput>,
    t: &[f64],
    adjusted: &[[DVec3; 3]],
    reach: f64,
) {
    let mut before: Option<[DVec3; 3]> = None;
    let mut inputs: Vec<&mut NodeInput> = inputs.collect();
    let samples: Vec<f64> = inputs.iter().map(|input| input.here.samples).collect();
    for (k, input) in inputs.iter_mut().enumerate() {
        let parabola = Parabola::new(t, &samples, k, reach);
        let arms: [DVec3; 3] = std::array::from_fn(|i| {
            parabola.as_ref().map_or(adjusted[k][i], |parabola| parabola.value(|j| adjusted[j][i]))
        });
        for (touch, arms) in [(&mut input.here, arms), (&mut input.from, before.unwrap_or(arms))] {
            for (palm, arm) in touch.palms.iter_mut().zip(arms) {
                (palm.smooth_arm, palm.own_share) = (arm, 0.0);
            }
        }
        before = Some(arms);
    }
}

/// Weights of a least-squares parabola through the nodes about one of them.
struct Parabola {
    start: usize,
    /// Weights of the value at the node.
    weights: Vec<f64>,
}

impl Parabola {
    /// None with fewer than four nodes in reach.
    fn new(t: &[f64], samples: &[f64], k: usize, reach: f64) -> Option<Self> {
        let from = |j: usize| (t[j] - t[k]) / reach;
        let start = (0..k).rev().take_while(|&j| from(j) >= -1.0).last().unwrap_or(k);
        let end = (k + 1..t.len()).take_while(|&j| from(j) <= 1.0).last().unwrap_or(k);
        let powers = |j: usize| Vector3::new(1.0, from(j), from(j) * from(j));
        let weigh = |j: usize| powers(j) * samples[j];
        let normal: Matrix3<f64> = (start..=end).map(|j| weigh(j) * powers(j).transpose()).sum();
        let inverse = (end >= start + 3).then(|| normal.try_inverse()).flatten()?;
        Some(Self { start, weights: (start..=end).map(|j| (inverse * weigh(j))[0]).collect() })
    }

    fn value(&self, part: impl Fn(usize) -> DVec3) -> DVec3 {
        self.weights.iter().zip(self.start..).map(|(w, j)| part(j) * *w).sum()
    }
}
