//! Contacts in the plane as contacts in the plane `z = 0` of space, where their noise is judged.

use super::model::{ContactNoise, NoisyContact};
use crate::noise as spatial;
use crate::sample;
use contact_kinematics::Direction;
use glam::{DMat2, DMat3, DVec3};

/// A curve in the plane `z = 0`.
pub(super) fn lifted(curve: &[NoisyContact]) -> Vec<spatial::NoisyContact> {
    curve.iter().map(lifted_one).collect()
}

/// A curve with the noise that it has in space; that of the pose is kept.
pub(super) fn lowered(curve: &[NoisyContact], in_space: &[spatial::NoisyContact]) -> Vec<NoisyContact> {
    let one = |(own, raised): (&NoisyContact, &spatial::NoisyContact)| {
        let spatial::ContactNoise { point, normal, .. } = raised.noise;
        let point = DMat2::from_cols(point.x_axis.truncate(), point.y_axis.truncate());
        NoisyContact { contact: own.contact, noise: ContactNoise { point, normal, ..own.noise } }
    };
    curve.iter().zip(in_space).map(one).collect()
}

/// Errors of a pose that stays in the plane.
fn in_plane(translation: f64, rotation: f64) -> spatial::PoseNoise {
    spatial::PoseNoise {
        rotation: DMat3::from_diagonal(DVec3::new(0.0, 0.0, rotation * rotation)),
        translation: DMat3::from_diagonal(DVec3::new(
            translation * translation,
            translation * translation,
            0.0,
        )),
        cross: DMat3::ZERO,
    }
}

fn lifted_one(NoisyContact { contact, noise }: &NoisyContact) -> spatial::NoisyContact {
    let [xx, xy, yx, yy] = noise.point.to_cols_array();
    let point = DMat3::from_cols(DVec3::new(xx, xy, 0.0), DVec3::new(yx, yy, 0.0), DVec3::ZERO);
    spatial::NoisyContact {
        contact: sample::ContactSample {
            point: contact.point.extend(0.0),
            normal: Direction::new_unchecked(contact.normal.get().extend(0.0)),
        },
        noise: spatial::ContactNoise {
            point,
            normal: noise.normal,
            pose: in_plane(noise.pose_translation, noise.pose_rotation),
        },
    }
}
