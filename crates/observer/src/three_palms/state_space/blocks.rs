//! Inputs of the state-space model from a track: a node for every few samples.

use super::input::{NodeInput, PalmTouch, PalmWrench, Touch, Wrench};
use crate::three_palms::quadrature::running_integral;
use crate::three_palms::track::Track;
use glam::DVec3;
use std::ops::{Add, Mul, Range};

/// Running integrals for one palm at one time, with the first moment about the start of the track.
#[derive(Clone, Copy, Default)]
struct Running {
    force: Wrench,
    unit: Wrench,
}

impl Add for Running {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, unit: self.unit + other.unit }
    }
}

impl Mul<f64> for Running {
    type Output = Self;
    fn mul(self, factor: f64) -> Self {
        Self { force: self.force * factor, unit: self.unit * factor }
    }
}

/// Integrals of one palm and their rates at every sample.
struct Series<'a> {
    t: &'a [f64],
    rates: Vec<Running>,
    integrals: Vec<Running>,
}

impl<'a> Series<'a> {
    fn new(track: &'a Track, palm: usize) -> Self {
        let one = |(node, &t): (&crate::three_palms::track::Node, &f64)| {
            let n = node.palms[palm].frame.n;
            let unit = Wrench { impulse: n, first: n * t, torque: node.p_WC[palm].cross(n) };
            Running { force: unit * node.forces[palm], unit }
        };
        let rates: Vec<Running> = track.nodes.iter().zip(&track.t).map(one).collect();
        let integrals = running_integral(&track.t, &rates, Running::default());
        Self { t: &track.t, rates, integrals }
    }

    /// Cubic Hermite interpolation between samples.
    fn at(&self, time: f64) -> Running {
        let next = self.t.partition_point(|&t| t < time).clamp(1, self.t.len() - 1);
        let (a, b) = (next - 1, next);
        let h = self.t[b] - self.t[a];
        let s = (time - self.t[a]) / h;
        let (s2, s3) = (s * s, s * s * s);
        self.integrals[a] * (2.0 * s3 - 3.0 * s2 + 1.0)
            + self.rates[a] * (h * (s3 - 2.0 * s2 + s))
            + self.integrals[b] * (3.0 * s2 - 2.0 * s3)
            + self.rates[b] * (h * (s3 - s2))
    }
}

/// Nodes at every `stride`-th sample and at the last one, each with the samples that are nearest to it.
pub(crate) fn block_inputs(track: &Track, stride: usize) -> Vec<NodeInput> {
    let stride = stride.max(1);
    let last = track.len() - 1;
    let mut at: Vec<usize> = (0..last).step_by(stride).collect();
    // No interval of less than half a block at the end.
    if at.len() > 1 && at.last().is_some_and(|k| 2 * (last - k) < stride) {
        at.pop();
    }
    at.push(last);
    let middle = |k: usize| (at[k] + at[k + 1]).div_ceil(2);
    let touches: Vec<Touch> = (0..at.len())
        .map(|k| {
            let start = if k == 0 { 0 } else { middle(k - 1) };
            let end = if k + 1 == at.len() { last + 1 } else { middle(k) };
            touch(track, at[k], start..end)
        })
        .collect();
    let touches = with_rates(track, &at, touches);
    let series: [Series<'_>; 3] = std::array::from_fn(|palm| Series::new(track, palm));
    let spacing = track.duration() / last as f64;
    (0..at.len())
        .map(|k| {
            let (from, here) = (touches[k.saturating_sub(1)], touches[k]);
            let start = track.t[at[k.saturating_sub(1)]];
            let duration = track.t[at[k]] - start;
            NodeInput {
                duration,
                spacing,
                halves: halves(&series, start, duration, &from, &here),
                from,
                here,
            }
        })
        .collect()
}

fn halves(
    series: &[Series<'_>; 3],
    start: f64,
    duration: f64,
    from: &Touch,
    here: &Touch,
) -> [[PalmWrench; 3]; 2] {
    if duration <= 0.0 {
        return [[PalmWrench::default(); 3]; 2];
    }
    let half = 0.5 * duration;
    std::array::from_fn(|part| {
        let begin = start + part as f64 * half;
        std::array::from_fn(|i| {
            let (a, b) = (series[i].at(begin), series[i].at(begin + half));
            let change = b + a * -1.0;
            // The first moment about the start of the half.
            let moved = |w: Wrench| Wrench { first: w.first - w.impulse * begin, ..w };
            let rise = here.palms[i].force[0] - from.palms[i].force[0];
            let arm = 0.5 * (from.palms[i].arm[0] + here.palms[i].arm[0]);
            let size = 0.5 * rise.dot(from.palms[i].frame.n);
            let rate = Wrench { impulse: 0.5 * rise, first: rise * (0.25 * half), torque: -arm * size };
            PalmWrench { force: moved(change.force), unit: moved(change.unit), rate }
        })
    })
}

/// Means and moments over a block about the sample `at`.
fn touch(track: &Track, at: usize, block: Range<usize>) -> Touch {
    let share = 1.0 / block.len() as f64;
    let palms = std::array::from_fn(|i| {
        let palm = &track.nodes[at].palms[i];
        let zero = [DVec3::ZERO; 3];
        let mut sum = PalmTouch {
            frame: palm.frame,
            rate: palm.rate,
            normal: zero,
            arm: zero,
            lift: 0.0,
            force: [DVec3::ZERO; 2],
            torque: [DVec3::ZERO; 2],
        };
        for k in block.clone() {
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
        sum
    });
    Touch { palms, samples: block.len() as f64 }
}

/// Forces and torques at the nodes, and their rates, from the blocks' means.
fn with_rates(track: &Track, at: &[usize], touches: Vec<Touch>) -> Vec<Touch> {
    // Mean time of a block: the normal is a unit vector.
    let centre = |k: usize| {
        let palm = &touches[k].palms[0];
        track.t[at[k]] + palm.normal[1].dot(palm.normal[0])
    };
    let mut all = touches.clone();
    for (k, touch) in all.iter_mut().enumerate() {
        let (before, after) = (k.saturating_sub(1), (k + 1).min(at.len() - 1));
        let time = centre(after) - centre(before);
        if time > 0.0 {
            let late = centre(k) - track.t[at[k]];
            for (i, palm) in touch.palms.iter_mut().enumerate() {
                let (a, b) = (&touches[before].palms[i], &touches[after].palms[i]);
                palm.force[1] = (b.force[0] - a.force[0]) / time;
                palm.torque[1] = (b.torque[0] - a.torque[0]) / time;
                palm.force[0] -= palm.force[1] * late;
                palm.torque[0] -= palm.torque[1] * late;
            }
        }
    }
    all
}
