//! How far the poses of an estimated motion may be off, all of them together.
//!
//! Errors of a motion come from a dozen numbers and the noise of the forces. They are common to all contacts and alike from
//! one instant to the next, and what all poses share of them is a rigid displacement of the body's axes, which have to stand
//! somewhere: relative to it the poses are known better than each alone. The joint distribution is drawn from.

use super::turns::{exponential, logarithm};
use crate::random::Normal;
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Cholesky, SMatrix, SVector};

/// Draws of the joint error: one in twenty is then known to some 1 %, and the rank that is taken holds for any number of them.
pub(crate) const DRAWS: usize = 500;
/// What covariances are raised by, relative to the largest: next to nothing, but they can be inverted.
const RIDGE: f64 = 1e-9;

/// A rigid displacement that is uncertain: a turn about the origin (rotation vector, rad), then a shift (m).
pub(super) type Displacement = SVector<f64, 6>;

/// A pose: position of the centre of mass, and orientation, body to world.
pub(crate) type Pose = (DVec3, DQuat);

/// Covariance of a small rigid displacement of the body's axes: `x` goes to `x + theta x x + d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoseCovariance {
    /// Of the turn `theta`, rad^2.
    pub rotation: DMat3,
    /// Of the shift `d`, m^2.
    pub translation: DMat3,
    /// `E[theta d']`, rad m.
    pub cross: DMat3,
}

impl PoseCovariance {
    fn of(m: &SMatrix<f64, 6, 6>) -> Self {
        let block = |row: usize, column: usize| {
            DMat3::from_cols_array_2d(&std::array::from_fn(|j| {
                std::array::from_fn(|i| m[(row + i, column + j)])
            }))
        };
        Self { rotation: block(0, 0), translation: block(3, 3), cross: block(0, 3) }
    }
}

/// The axes that errors of poses are told in, and so the axes in which bounds hold that are made with them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PoseAxes {
    /// The body's own: principal axes about the centre of mass.
    Principal,
    /// Those in which the estimated poses are right on the average over the motion.
    MeanPose,
}

/// Covariances of the errors of estimated poses in body axes.
///
/// A point that stands at `x` in the body stands at `x + theta x x + d` as estimated, and so with normals. What all poses share,
/// the mean of `(theta, d)` over the motion, moves the whole shape: it is taken out ([`PoseAxes::MeanPose`]) unless it is
/// next to nothing.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseErrors {
    nodes: Vec<usize>,
    covariances: Vec<SMatrix<f64, 6, 6>>,
    shared: SMatrix<f64, 6, 6>,
    axes: PoseAxes,
    /// For each draw the largest error of all nodes in its own deviations, ascending.
    largest: Vec<f64>,
}

impl PoseErrors {
    /// Covariance at a sample.
    #[must_use]
    pub fn covariance(&self, sample: usize) -> PoseCovariance {
        PoseCovariance::of(&self.interpolated(sample))
    }

    fn interpolated(&self, sample: usize) -> SMatrix<f64, 6, 6> {
        let after = self.nodes.partition_point(|&node| node < sample);
        let (Some(&to), Some(last)) = (self.nodes.get(after), self.covariances.last()) else {
            return self.covariances.last().copied().unwrap_or_else(SMatrix::zeros);
        };
        if after == 0 || to == sample {
            return *self.covariances.get(after).unwrap_or(last);
        }
        let from = self.nodes[after - 1];
        // An error on the way is a mean of those at both ends, and a deviation is convex.
        let share = (sample - from) as f64 / (to - from) as f64;
        self.covariances[after - 1] * (1.0 - share) + self.covariances[after] * share
    }

    /// The axes that the errors are told in.
    #[must_use]
    pub fn axes(&self) -> PoseAxes {
        self.axes
    }

    /// Covariance of what all poses share: how far the axes of the bounds may stand from the body's own.
    #[must_use]
    pub fn shared(&self) -> PoseCovariance {
        PoseCovariance::of(&self.shared)
    }

    /// The number of deviations within which the errors of all poses lie together with the stated confidence: `e' S^-1 e` is
    /// below its square at every sample. Infinite for a confidence that the draws do not reach.
    #[must_use]
    pub fn deviations(&self, confidence: f64) -> f64 {
        // As in split conformal inference: the rank that one more draw stays below with that confidence.
        let rank = ((self.largest.len() + 1) as f64 * confidence).ceil() as usize;
        rank.checked_sub(1).and_then(|k| self.largest.get(k)).copied().unwrap_or(f64::INFINITY)
    }

    /// From draws of poses about the `estimated` ones at some samples (`nodes`), each read as a motion that may be the true one;
    /// `lasting` (m) is the deviation of what shifts contacts beside the motion, in any direction. `principal` says that the draws
    /// have the true principal axes. None where no draw is left that is a motion.
    pub(crate) fn from_draws(
        nodes: Vec<usize>,
        estimated: &[Pose],
        draws: impl Iterator<Item = Vec<Pose>>,
        lasting: f64,
        principal: bool,
    ) -> Option<Self> {
        let drawn: Vec<Vec<Pose>> = draws.map(|poses| errors_of(estimated, &poses)).collect();
        let count = drawn.len() as f64;
        if drawn.is_empty() || nodes.is_empty() {
            return None;
        }
        let means: Vec<Pose> = drawn.iter().map(|errors| mean(errors)).collect();
        let shared: SMatrix<f64, 6, 6> =
            means.iter().map(|m| displacement(*m)).map(|g| g * g.transpose()).sum();
        let shared = shared / count;
        let turn = (0..3).map(|i| shared[(i, i)]).sum::<f64>().sqrt();
        let axes = if principal && turn < NEXT_TO_NO_TURN { PoseAxes::Principal } else { PoseAxes::MeanPose };
        let mut random = Normal::seeded(LASTING_SEED);
        let mut relative = |(errors, mean): (&Vec<Pose>, &Pose)| -> Vec<Displacement> {
            let (shift, turn) =
                if axes == PoseAxes::MeanPose { *mean } else { (DVec3::ZERO, DQuat::IDENTITY) };
            let back = turn.inverse();
            let left = errors.iter().map(|(s, q)| displacement((back * (*s - shift), back * *q)));
            left.map(|mut error| {
                (3..6).for_each(|i| error[i] += lasting * random.draw());
                error
            })
            .collect()
        };
        let all: Vec<Vec<Displacement>> = drawn.iter().zip(&means).map(&mut relative).collect();
        let covariances: Vec<_> = (0..nodes.len())
            .map(|k| {
                let sum: SMatrix<f64, 6, 6> =
                    all.iter().map(|errors| errors[k] * errors[k].transpose()).sum();
                raised(sum / count)
            })
            .collect();
        let roots: Vec<_> = covariances.iter().map(|c| Cholesky::new(*c)).collect::<Option<_>>()?;
        let mut largest: Vec<f64> = all
            .iter()
            .map(|errors| {
                let squares = errors.iter().zip(&roots).map(|(e, root)| e.dot(&root.solve(e)));
                squares.fold(0.0, f64::max).sqrt()
            })
            .collect();
        largest.sort_unstable_by(f64::total_cmp);
        Some(Self { nodes, covariances, shared, axes, largest })
    }
}

/// Turn that all poses share, rad (all axes together), below which it costs next to nothing to tell errors in the body's own axes: less
/// than three thousandths of the size at three deviations.
const NEXT_TO_NO_TURN: f64 = 1e-3;

/// Seed of what lasting errors are drawn from.
const LASTING_SEED: u64 = 0x1a57;

/// What takes points from body axes as estimated to true ones, at each node: `x = R' (p^ + R^ x^ - p)`.
fn errors_of(estimated: &[Pose], drawn: &[Pose]) -> Vec<Pose> {
    let error = |((p_hat, R_hat), (p, R)): (&Pose, &Pose)| {
        (R.inverse() * (*p_hat - *p), (R.inverse() * *R_hat).normalize())
    };
    estimated.iter().zip(drawn).map(error).collect()
}

/// The mean of errors at all nodes; of the rotations about the first, what a second round would change is of third order.
fn mean(errors: &[Pose]) -> Pose {
    let count = errors.len().max(1) as f64;
    let first = errors.first().map_or(DQuat::IDENTITY, |(_, turn)| *turn);
    let about = errors.iter().map(|(_, turn)| logarithm(first.inverse() * *turn)).sum::<DVec3>() / count;
    let shift = errors.iter().map(|(shift, _)| *shift).sum::<DVec3>() / count;
    (shift, (first * exponential(about)).normalize())
}

/// The displacement that such an error undoes.
fn displacement((shift, turn): Pose) -> Displacement {
    let (theta, d) = (-logarithm(turn), -shift);
    Displacement::from([theta.x, theta.y, theta.z, d.x, d.y, d.z])
}

/// A covariance with a small part of its largest entries, by kind, on its diagonal.
fn raised(mut covariance: SMatrix<f64, 6, 6>) -> SMatrix<f64, 6, 6> {
    for block in [0, 3] {
        let largest = (block..block + 3).map(|i| covariance[(i, i)]).fold(0.0, f64::max);
        (block..block + 3).for_each(|i| covariance[(i, i)] += RIDGE * largest + f64::MIN_POSITIVE.sqrt());
    }
    covariance
}

/// A matrix `A` with `A A'` a covariance, of any rank: columns without variance of their own are zero.
pub(crate) fn root<const N: usize>(covariance: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let mut a = SMatrix::<f64, N, N>::zeros();
    for j in 0..N {
        let own = covariance[(j, j)] - (0..j).map(|k| a[(j, k)] * a[(j, k)]).sum::<f64>();
        if own.is_nan() || own <= ROUNDING * covariance[(j, j)] {
            continue;
        }
        a[(j, j)] = own.sqrt();
        for i in j + 1..N {
            let rest = covariance[(i, j)] - (0..j).map(|k| a[(i, k)] * a[(j, k)]).sum::<f64>();
            a[(i, j)] = rest / a[(j, j)];
        }
    }
    a
}

/// Share of a variance that is rounding.
const ROUNDING: f64 = 1e-12;

/// A vector of independent standard normals.
pub(crate) fn normals<const N: usize>(random: &mut Normal) -> SVector<f64, N> {
    SVector::from_fn(|_, _| random.draw())
}

/// Orientation turned by a small rotation vector in world axes.
pub(crate) fn turned(q: DQuat, theta: DVec3) -> DQuat {
    (exponential(theta) * q).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Poses along a turn about z, displaced in body axes by what all of them share and by what each has of its own.
    fn drawn(estimated: &[Pose], shared: f64, own: f64, principal: bool) -> PoseErrors {
        let mut random = Normal::seeded(3);
        let mut vector = |size: f64| DVec3::new(random.draw(), random.draw(), random.draw()) * size;
        let all: Vec<Vec<Pose>> = (0..DRAWS)
            .map(|_| {
                let (turn, shift) = (exponential(vector(shared)), vector(shared));
                let moved = |(p, q): &Pose| {
                    let (turn, shift) = (turn * exponential(vector(own)), shift + vector(own));
                    (*p + *q * shift, (*q * turn).normalize())
                };
                estimated.iter().map(moved).collect()
            })
            .collect();
        let nodes = (0..estimated.len()).map(|k| 10 * k).collect();
        PoseErrors::from_draws(nodes, estimated, all.into_iter(), 0.0, principal).unwrap()
    }

    #[test]
    fn what_all_poses_share_is_taken_out_unless_it_is_next_to_nothing() {
        let pose = |k: usize| (DVec3::new(0.1, 0.2, 0.3) * k as f64, DQuat::from_rotation_z(0.05 * k as f64));
        let estimated: Vec<Pose> = (0..40).map(pose).collect();
        let deviation = |m: DMat3| ((m.x_axis.x + m.y_axis.y + m.z_axis.z) / 3.0).sqrt();
        let large = drawn(&estimated, 0.05, 1e-4, true);
        assert_eq!(large.axes(), PoseAxes::MeanPose);
        for sample in [0, 7, 200, 390, 1000] {
            let left = deviation(large.covariance(sample).rotation);
            // A little of each is in the mean, and of two ends interpolated the mean variance stands.
            assert!((0.9e-4..1.1e-4).contains(&left), "{sample}: {left}");
        }
        assert!((0.045..0.055).contains(&deviation(large.shared().rotation)));
        assert_eq!(drawn(&estimated, 1e-4, 1e-5, true).axes(), PoseAxes::Principal);
        assert_eq!(drawn(&estimated, 1e-4, 1e-5, false).axes(), PoseAxes::MeanPose);
        // Forty independent poses of six numbers each: chi-squared of 6 at odds of 0.05 / 40 is 22.
        let c = large.deviations(0.95);
        assert!((4.4..5.0).contains(&c), "{c}");
        assert_eq!(large.deviations(0.9999), f64::INFINITY);
    }

    #[test]
    fn roots_of_covariances_of_any_rank_give_them_back() {
        let a = SMatrix::<f64, 4, 2>::new(1.0, 2.0, -1.0, 0.5, 0.0, 0.0, 3.0, -0.25);
        let covariance = a * a.transpose();
        let root = root(&covariance);
        assert!((root * root.transpose() - covariance).amax() < 1e-12);
    }
}
