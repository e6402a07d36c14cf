mod build;
mod motor;
#[cfg(feature = "noise")]
mod noise;
mod simulated;
mod three_planes;
mod twice;

use super::*;
use contact_kinematics::{PalmSurface, SurfacePose};
use glam::{DQuat, DVec3};

/// Times of `samples` samples at 1 kHz, s.
fn times(samples: usize) -> Vec<f64> {
    (0..samples).map(|k| k as f64 / 1000.0).collect()
}

/// An immobile palm of this shape, touched in one point of its surface all the time.
fn palm(surface: PalmSurface, p_P: DVec3, samples: usize) -> PalmRecord {
    let pose = SurfacePose { p_WP: DVec3::new(0.3, -0.2, 0.1), R_WP: DQuat::from_rotation_x(0.7) };
    PalmRecord {
        surface,
        friction: None,
        motion: RecordedMotion::Fixed(pose),
        contacts: ContactPoints::Palm(vec![Some(p_P); samples]),
        force: ForceChannel::Missing,
        impulse: ForceChannel::Missing,
        torque: None,
        hinge: None,
        truth: None,
        largest_offset: 1e-3,
    }
}
