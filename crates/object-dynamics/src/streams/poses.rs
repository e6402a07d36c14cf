use super::TrackError;
use super::track::{check_times, left_out, place};
use contact_kinematics::SurfacePose;

/// Poses at strictly increasing times: between them positions are linear, and turns steady about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTrack {
    times: Vec<f64>,
    poses: Vec<SurfacePose>,
}

/// By how much a pose is off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TurnAndShift {
    /// Distance, m.
    pub shift: f64,
    /// Angle, rad.
    pub turn: f64,
}

impl PoseTrack {
    /// From poses at their times in s.
    ///
    /// # Errors
    /// [`TrackError`] names the reading.
    pub fn new(times: Vec<f64>, poses: Vec<SurfacePose>) -> Result<Self, TrackError> {
        check_times(&times, poses.len())?;
        let finite = |pose: &SurfacePose| pose.p_WP.is_finite() && pose.R_WP.is_finite();
        match poses.iter().position(|pose| !finite(pose)) {
            Some(index) => Err(TrackError::NotFinite { index }),
            None => Ok(Self { times, poses }),
        }
    }

    /// Times of the poses, s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The poses.
    #[must_use]
    pub fn poses(&self) -> &[SurfacePose] {
        &self.poses
    }

    /// The pose at `t` (s); none outside of the readings, and none between two that are more than `longest` (s) apart.
    #[must_use]
    pub fn at(&self, t: f64, longest: f64) -> Option<SurfacePose> {
        let (k, share) = place(&self.times, t, longest)?;
        if share == 0.0 {
            return Some(self.poses[k]);
        }
        Some(between(&self.poses[k], &self.poses[k + 1], share))
    }

    /// By how much a pose halfway between two readings is off, at most; as [`Track::interpolation_error`](super::Track::interpolation_error).
    #[must_use]
    pub fn interpolation_error(&self, longest: f64) -> Option<TurnAndShift> {
        let middle = |[a, _, c]: [usize; 3], share: f64| between(&self.poses[a], &self.poses[c], share);
        let shift = left_out(&self.times, longest, |at, share| {
            middle(at, share).p_WP.distance(self.poses[at[1]].p_WP)
        })?;
        let turn = left_out(&self.times, longest, |at, share| {
            // By the vector part: the arc cosine of what is nearly 1 has half the digits.
            let turn = middle(at, share).R_WP.inverse() * self.poses[at[1]].R_WP;
            2.0 * turn.xyz().length().min(1.0).asin()
        })?;
        Some(TurnAndShift { shift, turn })
    }
}

fn between(a: &SurfacePose, b: &SurfacePose, share: f64) -> SurfacePose {
    // Of neighbours on a smooth path the chord's middle is the arc's, and stays so where the angle is rounding.
    SurfacePose { p_WP: a.p_WP.lerp(b.p_WP, share), R_WP: a.R_WP.slerp(b.R_WP, share).normalize() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};

    /// Of a turn `a = t^2` and a shift `x = t^2` over steps of `h` the middle is off by `h^2 / 4`, and it is stated so.
    #[test]
    fn the_stated_error_is_that_of_the_middle() {
        let h = 0.01;
        let times: Vec<f64> = (0..20).map(|k| f64::from(k) * h).collect();
        let pose = |t: f64| SurfacePose { p_WP: t * t * DVec3::Y, R_WP: DQuat::from_rotation_x(t * t) };
        let track = PoseTrack::new(times.clone(), times.iter().map(|t| pose(*t)).collect()).unwrap();
        let TurnAndShift { shift, turn } = track.interpolation_error(2.0 * h).unwrap();
        assert!((shift - h * h / 4.0).abs() < 1e-15 && (turn - h * h / 4.0).abs() < 1e-14, "{shift} {turn}");
        let t = 7.5 * h;
        let (found, truth) = (track.at(t, h * 1.01).unwrap(), pose(t));
        assert!((found.p_WP.distance(truth.p_WP) - h * h / 4.0).abs() < 1e-15);
        assert!((found.R_WP.angle_between(truth.R_WP) - h * h / 4.0).abs() < 1e-8);
        assert_eq!(track.at(times[3], 0.0), Some(pose(times[3])));
        assert_eq!(track.at(t, 0.5 * h), None);
    }

    /// A quaternion and its opposite are one orientation.
    #[test]
    fn a_change_of_sign_is_no_turn() {
        let at_rest = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::from_rotation_z(0.3) };
        let opposite = SurfacePose { R_WP: -at_rest.R_WP, ..at_rest };
        let track = PoseTrack::new(vec![0.0, 1.0, 2.0], vec![at_rest, opposite, at_rest]).unwrap();
        let middle = track.at(0.5, 2.0).unwrap().R_WP;
        assert!(middle.dot(at_rest.R_WP).abs() > 1.0 - 1e-15);
        assert!(track.interpolation_error(2.0).unwrap().turn < 1e-15);
    }
}
