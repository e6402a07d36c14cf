//! Motion and its deviations at all samples of a log, from those at the nodes.

use super::body::Body;
use super::both::of_some;
use super::flow::Carried;
use super::noise::WrenchNoise;
use super::plane;
use super::problem::{Problem, Unknowns};
use super::record::Record;
use super::solve::Covariances;
use super::state::{MOTION, Motion, Tangent, Turn};
use crate::rigid::exponential;
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, Matrix6, SMatrix};

/// Standard deviations of centre of mass, velocity, angular velocity and turn.
pub(super) type Deviations = [DVec3; 4];

/// Motion and deviations at each sample of `log`, the nodes of `problem` among them, the first and the last too.
pub(super) fn at_all<const P: usize>(
    log: &Record,
    problem: &Problem,
    found: &Unknowns,
    covariances: &Covariances<P>,
) -> Vec<(Motion, Deviations)> {
    let own = problem.at_samples(found);
    let known = at_nodes(&own, &found.body, covariances);
    let mut all = along_links(
        log,
        problem,
        (&own, &found.body),
        |j| (own[j], known[j]),
        |link, j, k| link.at(log, k, [&known[j], &known[j + 1]]),
    );
    if problem.planar {
        all.iter_mut().for_each(|(_, deviations)| plane::flatten(deviations, log.across));
    }
    all
}

/// Deviations at all nodes, which have these motions.
pub(super) fn at_nodes<const P: usize>(
    motions: &[Motion],
    body: &Body,
    covariances: &Covariances<P>,
) -> Vec<Deviations> {
    motions.iter().enumerate().map(|(j, motion)| deviations(motion, body, j, covariances)).collect()
}

/// Covariances of the centre of mass and the turn at each sample, world axes: their diagonals are what [`at_all`] has as deviations.
pub(super) fn poses_at_all<const P: usize>(
    log: &Record,
    problem: &Problem,
    found: &Unknowns,
    covariances: &Covariances<P>,
) -> Vec<Matrix6<f64>> {
    const POSE: [usize; 6] = [0, 1, 2, 9, 10, 11];
    let own = problem.at_samples(found);
    let of = |j: usize| {
        let all = covariance(&own[j], &found.body, j, covariances);
        Matrix6::from_fn(|i, k| all[(POSE[i], POSE[k])])
    };
    let known: Vec<Matrix6<f64>> = (0..own.len()).map(of).collect();
    let all = along_links(
        log,
        problem,
        (&own, &found.body),
        |j| known[j],
        |link, j, k| link.pose(log, k, [&known[j], &known[j + 1]]),
    );
    // But for rounding they are symmetric.
    let even = |of: &Matrix6<f64>| 0.5 * (of + of.transpose());
    let flat = |of| if problem.planar { plane::flattened(&of, log.across) } else { of };
    all.iter().map(even).map(flat).collect()
}

/// Something at each sample of `log`, whose nodes have the motions `own`: at node `j`, and of the link after node `j` at the sample `k` inside.
fn along_links<T: Send>(
    log: &Record,
    problem: &Problem,
    (own, body): (&[Motion], &Body),
    at_node: impl Fn(usize) -> T + Sync,
    inside: impl Fn(&Link, usize, usize) -> T + Sync,
) -> Vec<T> {
    let nodes = problem.node_samples();
    let of = |some: &[usize]| {
        let sample = |j: usize| nodes.get(j).copied().unwrap_or(log.times.len());
        let room = some.first().zip(some.last()).map_or(0, |(first, last)| sample(last + 1) - sample(*first));
        let mut all = Vec::with_capacity(room);
        for &j in some {
            all.push(at_node(j));
            if let Some(&end) = nodes.get(j + 1) {
                let link = Link::new(log, problem, body, (j, [own[j], own[j + 1]]), nodes[j]..end);
                all.extend((nodes[j] + 1..end).map(|k| inside(&link, j, k)));
            }
        }
        all
    };
    of_some(log.times.len(), &(0..own.len()).collect::<Vec<_>>(), of)
}

/// Samples from one node to the next.
struct Link<'a> {
    body: &'a Body,
    samples: std::ops::Range<usize>,
    duration: f64,
    /// By what was measured, after each interval.
    carried: Vec<Motion>,
    /// What the next node's motion differs by, and by how much of that noise bent the motion: the other part is what steps from node to node
    /// miss of a moment that has a kink between them, as where a slip ends, and which those from sample to sample have.
    left: Tangent,
    bent: Tangent,
    /// Covariance of impulse and moment about the centre of mass that noise adds over the link.
    noise: Matrix6<f64>,
}

impl<'a> Link<'a> {
    /// From node `j` on, between the motions that the samples at its ends have.
    fn new(
        log: &Record,
        problem: &Problem,
        body: &'a Body,
        (j, [start, end]): (usize, [Motion; 2]),
        samples: std::ops::Range<usize>,
    ) -> Self {
        let mut carried = Carried::<0>::new(start, body);
        let stepped = problem.carried(problem.nodes[j], start, body, &[problem.nodes[j + 1]]);
        let (mut motions, mut noise) = (Vec::with_capacity(samples.len()), WrenchNoise::default());
        for k in samples.clone() {
            carried.step(&log.intervals[k], [&log.wrenches[k], &log.wrenches[k + 1]], body, problem.gravity);
            noise += log.intervals[k].noise;
            motions.push(carried.motion);
        }
        Self {
            body,
            duration: log.times[samples.end] - log.times[samples.start],
            left: end.from(&carried.motion),
            bent: end.from(&stepped[0]),
            noise: problem.about(&noise, carried.motion.p).white,
            carried: motions,
            samples,
        }
    }

    /// At a sample inside. White noise between two known motions bends the motion by a cubic on average; velocities have the variance of
    /// a Brownian bridge (how far the motion came tells hardly more of them, as that is not known better), places that of an integrated one.
    fn at(&self, log: &Record, k: usize, ends: [&Deviations; 2]) -> (Motion, Deviations) {
        let h = self.duration;
        let (s, before, turn) = self.place(log, k);
        let part = |of: &Tangent, i: usize| DVec3::new(of[i], of[i + 1], of[i + 2]);
        let (left, bent) = (&self.left, &self.bent);
        // Of a cubic that ends with a value and a slope; and the slope of that which noise bent, over the duration.
        let cubic = |value: DVec3, bent: DVec3, slope: DVec3| {
            let at = value * (s * s * (3.0 - 2.0 * s)) + slope * (h * s * s * (s - 1.0));
            let rate = bent * (6.0 * s * (1.0 - s) / h) + slope * (s * (3.0 * s - 2.0));
            (at, rate)
        };
        let inertia = self.body.inertia_along(turn.R);
        let (p, v) = cubic(part(left, 0), part(bent, 0), part(left, 3));
        let (turned, spin) = cubic(part(left, 9), part(bent, 9), turn.K * part(left, 6));
        let motion = Motion {
            p: before.p + p,
            v: before.v + v,
            L: before.L + inertia * spin,
            q: (exponential(turned) * before.q).normalize(),
        };
        (motion, self.deviations(s, turn.K, ends))
    }

    /// Share of the link that is behind a sample inside, and the motion by what was measured until then.
    fn place(&self, log: &Record, k: usize) -> (f64, &Motion, Turn) {
        let s = (log.times[k] - log.times[self.samples.start]) / self.duration;
        let before = &self.carried[k - self.samples.start - 1];
        (s, before, self.body.turn(before.q, before.L))
    }

    /// What of the link's noise is in a place inside, s^2.
    fn share_in_places(&self, s: f64) -> f64 {
        (s * (1.0 - s)).powi(3) * self.duration * self.duration / 3.0
    }

    /// Covariance of the pose at a sample inside, by the same bridges.
    fn pose(&self, log: &Record, k: usize, ends: [&Matrix6<f64>; 2]) -> Matrix6<f64> {
        let (s, _, turn) = self.place(log, k);
        let mut to = Matrix6::from_diagonal_element(self.body.inverse_mass());
        to.fixed_view_mut::<3, 3>(3, 3).copy_from(&Matrix3::from(turn.K));
        ends[0] * (1.0 - s) + ends[1] * s + to * self.noise * to.transpose() * self.share_in_places(s)
    }

    fn deviations(&self, s: f64, K: DMat3, ends: [&Deviations; 2]) -> Deviations {
        let m = self.body.inverse_mass();
        let part = |i: usize| Matrix3::from(self.noise.fixed_view::<3, 3>(i, i));
        let K = Matrix3::from(K);
        let noise = [part(0) * (m * m), K * part(3) * K.transpose()]
            .map(|of| DVec3::new(of[(0, 0)], of[(1, 1)], of[(2, 2)]));
        let (rate, place) = (s * (1.0 - s), self.share_in_places(s));
        let shares = [(noise[0], place), (noise[0], rate), (noise[1], rate), (noise[1], place)];
        std::array::from_fn(|i| {
            let (noise, share) = shares[i];
            let between = ends[0][i] * ends[0][i] * (1.0 - s) + ends[1][i] * ends[1][i] * s;
            (between + noise * share).map(f64::sqrt)
        })
    }
}

/// At node `j`.
pub(super) fn deviations<const P: usize>(
    motion: &Motion,
    body: &Body,
    j: usize,
    covariances: &Covariances<P>,
) -> Deviations {
    let covariance = covariance(motion, body, j, covariances);
    let deviation = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    std::array::from_fn(|k| DVec3::new(deviation(3 * k), deviation(3 * k + 1), deviation(3 * k + 2)))
}

/// Of the motion at node `j`, with the angular velocity in place of the angular momentum.
pub(super) fn covariance<const P: usize>(
    motion: &Motion,
    body: &Body,
    j: usize,
    covariances: &Covariances<P>,
) -> SMatrix<f64, MOTION, MOTION> {
    let (own, follows) = &covariances.motions[j];
    let (by_motion, by_body) = motion.spin_derivatives(body);
    let mut to = SMatrix::<f64, MOTION, MOTION>::identity();
    let mut through = SMatrix::<f64, MOTION, P>::zeros();
    to.fixed_view_mut::<3, MOTION>(6, 0).copy_from(&by_motion);
    if P > 0 {
        through.fixed_view_mut::<3, 6>(6, 1).copy_from(&by_body);
    }
    let by_constants = to * follows + through;
    let linear = to * own * to.transpose() + by_constants * covariances.body * by_constants.transpose();
    let beyond = covariances.beyond(j);
    let wider = SMatrix::from_diagonal(&Tangent::from_fn(|i, _| beyond[i / 3]));
    covariances.errors.iter().fold(wider * linear * wider, |sum, step| {
        let error = to * step.motions[j] + through * step.body;
        sum + error * error.transpose()
    })
}
