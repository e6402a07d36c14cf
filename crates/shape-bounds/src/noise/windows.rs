//! Averages over runs of neighbouring contacts.
//!
//! A convex body that satisfies many linear inequalities satisfies their mean, and it contains the mean of its points.
//! Means over longer runs carry less noise but cut the corner of the curve; taking runs of all lengths and intersecting
//! (or joining) what each proves leaves the choice to the data.

use super::model::NoisyContact;
use super::pose::PlaneNoise;
use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// The longest run, in contacts: beyond, the noise left is below a tenth and the loss on a curve large.
pub(super) const LONGEST: usize = 128;

/// The mean of a run of contacts.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Its first contact, counted over all curves.
    pub(super) first: usize,
    /// Mean point.
    pub(super) point: DVec3,
    /// Length of the mean normal, at most 1.
    pub(super) shrink: f64,
    /// Direction of the mean normal.
    pub(super) normal: Direction,
    /// Mean of `n_k . (x_k - point)`: where the mean of the inequalities puts its plane.
    pub(super) offset: f64,
    /// Covariance of the mean point from independent noise.
    pub(super) covariance: DMat3,
    /// Standard deviation of the plane's offset at `point`, from independent noise.
    pub(super) offset_sd: f64,
    /// Standard deviation per axis of the mean normal, from independent noise.
    pub(super) normal_sd: f64,
    /// The largest standard deviation of a single normal.
    pub(super) single_normal_sd: f64,
    /// No less than the covariance of the mean point by errors of the poses, however they are correlated.
    pub(super) pose_of_point: DMat3,
    /// The same of the plane, at any place.
    pub(super) pose_of_plane: PlaneNoise,
    /// The largest variance of a turn of the poses.
    pub(super) turning: f64,
}

/// Windows of each length up to the `longest` over `curves`, one list for each length.
pub(super) fn windows(curves: &[Vec<NoisyContact>], longest: usize) -> Vec<Vec<Window>> {
    let longest = curves.iter().map(Vec::len).max().unwrap_or(0).min(longest);
    let mut lists = Vec::new();
    let mut length = 1;
    while length <= longest {
        let stride = (length / 2).max(1);
        let mut list = Vec::new();
        let mut before = 0;
        for curve in curves {
            let mut start = 0;
            while start + length <= curve.len() {
                list.extend(Window::mean(before + start, &curve[start..start + length]));
                start += stride;
            }
            before += curve.len();
        }
        lists.push(list);
        length *= 2;
    }
    lists
}

impl Window {
    /// The mean of `run`, which begins at contact `first`; `None` if there are none or their normals cancel.
    pub(super) fn mean(first: usize, run: &[NoisyContact]) -> Option<Self> {
        if run.is_empty() {
            return None;
        }
        let weight = 1.0 / run.len() as f64;
        let mean = |of: &dyn Fn(&NoisyContact) -> f64| run.iter().map(of).sum::<f64>() * weight;
        let point = run.iter().map(|c| c.contact.point).sum::<DVec3>() * weight;
        let normal = run.iter().map(|c| c.contact.normal.get()).sum::<DVec3>() * weight;
        let direction = Direction::new(normal).ok()?;
        let point_variance = mean(&|c| {
            let n = c.contact.normal.get();
            // Rounding may leave less than nothing where a palm feels nothing along its normal.
            n.dot(c.noise.point * n).max(0.0)
        });
        // Errors of the normals turn the planes about their own contacts, not about the mean point.
        let turning = mean(&|c| c.noise.normal.powi(2) * c.contact.point.distance_squared(point));
        let covariance =
            run.iter().map(|c| c.noise.point).fold(DMat3::ZERO, |sum, m| sum + m) * (weight * weight);
        Some(Self {
            first,
            point,
            shrink: normal.length(),
            normal: direction,
            offset: mean(&|c| c.contact.normal.get().dot(c.contact.point - point)),
            covariance,
            offset_sd: ((point_variance + turning) * weight).max(0.0).sqrt(),
            normal_sd: (mean(&|c| c.noise.normal.powi(2)) * weight).sqrt(),
            single_normal_sd: run.iter().map(|c| c.noise.normal).fold(0.0, f64::max),
            pose_of_point: run
                .iter()
                .fold(DMat3::ZERO, |sum, c| sum + c.noise.pose.at(c.contact.point) * weight),
            pose_of_plane: PlaneNoise::mean(
                run.iter().map(|c| c.noise.pose.along(c.contact.normal.get())),
                weight,
            ),
            turning: run.iter().map(|c| c.noise.pose.turning()).fold(0.0, f64::max),
        })
    }

    /// What turns of the poses of as many deviations (`poses`) do beyond first order to points within `reach` of the mean one.
    pub(super) fn pose_second_order(&self, poses: f64, reach: f64) -> f64 {
        0.5 * poses * poses * self.turning * (self.point.length() + reach)
    }
}
