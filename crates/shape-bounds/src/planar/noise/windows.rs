//! Averages over runs of neighbouring contacts.

use super::NoisyContact;
use exact_hull::planar::Direction;
use glam::{DMat2, DVec2};

/// The longest run, in contacts: beyond, the noise left is below a tenth and the loss on a curve large.
const LONGEST: usize = 128;

/// The mean of a run of contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Mean point.
    pub(super) point: DVec2,
    /// Length of the mean normal, at most 1.
    pub(super) shrink: f64,
    /// Direction of the mean normal.
    pub(super) normal: Direction,
    /// Mean of `n_k . (x_k - point)`: where the mean of the inequalities puts its line.
    pub(super) offset: f64,
    /// Covariance of the mean point from independent noise.
    pub(super) covariance: DMat2,
    /// Standard deviation of the line's offset at `point`, from independent noise.
    pub(super) offset_sd: f64,
    /// Standard deviation per axis of the mean normal, from independent noise.
    pub(super) normal_sd: f64,
    /// The largest standard deviation of a single normal.
    pub(super) single_normal_sd: f64,
    /// Mean standard deviations of the pose.
    pub(super) pose_translation: f64,
    pub(super) pose_rotation: f64,
    /// The largest standard deviation of a rotation.
    pub(super) most_rotation: f64,
    /// Mean of the rotations' deviations times the distances of the contacts from the mean point.
    pub(super) pose_spread: f64,
    /// Mean distance of the contacts from the body's origin, m.
    pub(super) arm: f64,
    /// Mean of the rotations' deviations times how far the contacts are from where the lines are nearest to the body's origin: a turn moves
    /// a line by as much at its contact.
    pub(super) pose_turning: f64,
}

/// Windows of each length over `curves`, one list for each length.
pub(super) fn windows(curves: &[Vec<NoisyContact>]) -> Vec<Vec<Window>> {
    let longest = curves.iter().map(Vec::len).max().unwrap_or(0).min(LONGEST);
    let mut lists = Vec::new();
    let mut length = 1;
    while length <= longest {
        let stride = (length / 2).max(1);
        let runs = curves.iter().flat_map(|curve| curve.windows(length).step_by(stride));
        lists.push(runs.filter_map(Window::mean).collect());
        length *= 2;
    }
    lists
}

impl Window {
    /// The mean of `run`; `None` if its normals cancel.
    fn mean(run: &[NoisyContact]) -> Option<Self> {
        let weight = 1.0 / run.len() as f64;
        let mean = |of: &dyn Fn(&NoisyContact) -> f64| run.iter().map(of).sum::<f64>() * weight;
        let point = run.iter().map(|c| c.contact.point).sum::<DVec2>() * weight;
        let normal = run.iter().map(|c| c.contact.normal.get()).sum::<DVec2>() * weight;
        let direction = Direction::new(normal).ok()?;
        let point_variance = mean(&|c| {
            let n = c.contact.normal.get();
            n.dot(c.noise.point * n)
        });
        // Errors of the normals turn the lines about their own contacts, not about the mean point.
        let turning = mean(&|c| c.noise.normal.powi(2) * c.contact.point.distance_squared(point));
        let turned = |c: &NoisyContact, arm: f64| c.noise.pose_rotation * arm;
        let spread = |c: &NoisyContact| turned(c, c.contact.point.distance(point));
        let covariance =
            run.iter().map(|c| c.noise.point).fold(DMat2::ZERO, |sum, m| sum + m) * (weight * weight);
        Some(Self {
            point,
            shrink: normal.length(),
            normal: direction,
            offset: mean(&|c| c.contact.normal.get().dot(c.contact.point - point)),
            covariance,
            // Noise along the line alone may come out below zero across it.
            offset_sd: ((point_variance + turning) * weight).max(0.0).sqrt(),
            normal_sd: (mean(&|c| c.noise.normal.powi(2)) * weight).sqrt(),
            single_normal_sd: run.iter().map(|c| c.noise.normal).fold(0.0, f64::max),
            pose_translation: mean(&|c| c.noise.pose_translation),
            pose_rotation: mean(&|c| c.noise.pose_rotation),
            most_rotation: run.iter().map(|c| c.noise.pose_rotation).fold(0.0, f64::max),
            pose_spread: mean(&spread),
            arm: mean(&|c| c.contact.point.length()),
            pose_turning: mean(&|c| {
                let foot = c.contact.normal.get().perp_dot(c.contact.point).abs();
                turned(c, foot) + spread(c)
            }),
        })
    }
}
