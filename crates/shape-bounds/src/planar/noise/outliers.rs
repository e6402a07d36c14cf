//! Contacts in the plane that cannot be right beside the others.

use super::lift::lifted;
use super::model::{NoiseError, NoisyContact};
use crate::noise::Outlier;
use crate::noise::outliers::{Undecided, judged};

/// `curves`, each in the order in which it was traced, without the contacts that cannot be right, and these: the twin of
/// [`crate::noise::without_outliers`], which says how, and judges the contacts as ones in the plane `z = 0` of space.
///
/// Its limits are those of three dimensions, which are wider than two would need: on the side of keeping a contact.
///
/// # Errors
/// [`NoiseError`] for an impossible confidence or noise, a point that is not finite, and when half of the contacts or more
/// would have to go, so that which are the outliers is not decided.
pub fn without_outliers(
    curves: &[Vec<NoisyContact>],
    confidence: f64,
) -> Result<(Vec<Vec<NoisyContact>>, Vec<Outlier>), NoiseError> {
    NoiseError::check_confidence(confidence)?;
    NoiseError::check_contacts(curves)?;
    let in_space: Vec<_> = curves.iter().map(|curve| lifted(curve)).collect();
    let (_, outliers) = judged(&in_space, confidence, 2)
        .map_err(|Undecided { outliers, contacts }| NoiseError::Undecided { outliers, contacts })?;
    let mut kept = curves.to_vec();
    for outlier in outliers.iter().rev() {
        // In the order of curve and place: from the end, places stay what they are.
        kept[outlier.curve].remove(outlier.index);
    }
    Ok((kept, outliers))
}
