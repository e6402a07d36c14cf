//! Contacts in the plane that cannot be right beside the others.

use super::model::{NoiseError, NoisyContact};
use crate::noise as spatial;
use crate::noise::outliers::{Undecided, judged};
use crate::sample;
use contact_kinematics::Direction;
use glam::{DMat3, DVec3};

/// `curves`, each in the order in which it was traced, without the contacts that cannot be right, and these: the twin of
/// [`crate::without_outliers`], which says how, and judges the contacts as ones in the plane `z = 0` of space.
///
/// Its limits are those of three dimensions, which are wider than two would need: on the side of keeping a contact.
///
/// # Errors
/// [`NoiseError`] for an impossible confidence or noise, a point that is not finite, and when half of the contacts or more
/// would have to go, so that which are the outliers is not decided.
pub fn without_outliers(
    curves: &[Vec<NoisyContact>],
    confidence: f64,
) -> Result<(Vec<Vec<NoisyContact>>, Vec<spatial::Outlier>), NoiseError> {
    NoiseError::check_confidence(confidence)?;
    NoiseError::check_contacts(curves)?;
    let lifted: Vec<Vec<_>> = curves.iter().map(|curve| curve.iter().map(lifted).collect()).collect();
    let (_, outliers) = judged(&lifted, confidence)
        .map_err(|Undecided { outliers, contacts }| NoiseError::Undecided { outliers, contacts })?;
    let mut kept = curves.to_vec();
    for outlier in outliers.iter().rev() {
        // In the order of curve and place: from the end, places stay what they are.
        kept[outlier.curve].remove(outlier.index);
    }
    Ok((kept, outliers))
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

/// The contact in the plane `z = 0`.
fn lifted(NoisyContact { contact, noise }: &NoisyContact) -> spatial::NoisyContact {
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
