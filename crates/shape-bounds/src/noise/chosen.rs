//! Means over all contacts of a corner or face, whichever palms made them and when.
//!
//! Every other contact says which contacts those are, and the mean is over the others, whose noise had no part in it. So margins need not
//! cover the choice, and hold for as many means as there are. Whether the contacts are indeed at one corner does not matter: the mean of
//! points of a convex body is in it, and the mean of half-spaces around it is one.

use super::model::{NoiseError, NoisyContact};
use super::windows::Window;
use crate::features::{FeatureOptions, Features};

/// Means over the contacts of corners, and over those of faces.
#[derive(Clone, Debug, Default)]
pub(super) struct ChosenWindows {
    pub(super) corners: Vec<Window>,
    pub(super) faces: Vec<Window>,
}

impl ChosenWindows {
    /// # Errors
    /// Those of [`Features::find`].
    pub(super) fn of(curves: &[Vec<NoisyContact>], options: &FeatureOptions) -> Result<Self, NoiseError> {
        let every_other = |curve: &Vec<NoisyContact>| curve.iter().step_by(2).copied().collect();
        let found = Features::find(&curves.iter().map(every_other).collect::<Vec<_>>(), options)?;
        let made = |runs: &[usize]| Window::mean(0, &between(curves, &found, runs));
        Ok(Self {
            corners: found.corners.iter().filter_map(|corner| made(&corner.runs)).collect(),
            faces: found.faces.iter().filter_map(|face| made(&face.runs)).collect(),
        })
    }
}

/// The contacts between those of `runs` that chose them.
fn between(curves: &[Vec<NoisyContact>], found: &Features, runs: &[usize]) -> Vec<NoisyContact> {
    let of_run = |run: &usize| {
        let run = found.runs.get(*run)?;
        let (first, last) = (2 * run.first, 2 * (run.first + run.count).saturating_sub(1));
        curves.get(run.curve)?.get(first..=last)
    };
    runs.iter().filter_map(of_run).flat_map(|contacts| contacts.iter().skip(1).step_by(2)).copied().collect()
}
