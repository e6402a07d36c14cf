//! Corners, edges and faces of a body that is not smooth, from the contacts that it made.
//!
//! At a corner the contact stays at one body point while the normal sweeps; on an edge the point moves along a line about which
//! the normal turns; on a face the normal stays while the point moves or jumps. In each of two tangent directions the
//! ratio of both motions is a radius of curvature: zero, without end, or in between where the body is smooth.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::features::{FeatureKind, FeatureOptions, Features};
//! use shape_bounds::noise::{ContactNoise, NoisyContact};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // A palm turns about two opposite corners of a cube: the normal sweeps, and the contact stays but for noise of 0.1 mm.
//! let wave = |k: u32, of: f64| (of * f64::from(k)).sin();
//! let sweep = |side: f64| {
//!     let off = move |k| 1e-4 * DVec3::new(wave(k, 2.1), wave(k, 3.7), wave(k, 5.3));
//!     let normal = move |k| side * (DVec3::ONE + 0.6 * DVec3::new(wave(k, 0.31), wave(k, 0.47), wave(k, 0.23))).normalize();
//!     (0..40).map(move |k| (DVec3::splat(0.05 * side) + off(k), normal(k)))
//! };
//! let noise = ContactNoise::isotropic(1e-4, 1e-3);
//! let noisy = |contact| NoisyContact { contact, noise };
//! let curve = |side| Ok::<_, Box<dyn std::error::Error>>(ContactSample::from_raw(sweep(side))?.into_iter().map(noisy).collect());
//! let found = Features::find(&[curve(1.0)?, curve(-1.0)?], &FeatureOptions::default())?;
//! assert!(found.runs.iter().all(|run| run.kind == Some(FeatureKind::Corner)));
//! assert_eq!(found.corners.len(), 2);
//! assert!((found.corners[0].point - DVec3::splat(0.05)).length() < 1e-4);
//! # Ok(())
//! # }
//! ```

mod assign;
mod evidence;
mod found;
mod join;
mod moments;
mod pieces;
mod polyhedron;
mod segment;
#[cfg(any(test, feature = "generators"))]
pub(crate) mod simulated;
#[cfg(test)]
mod tests;

pub use found::{Corner, Edge, Face, FeatureKind, FeatureOptions, FeatureRun, Features};
pub use pieces::Pieces;
pub use polyhedron::FoundPolyhedron;

use crate::noise::{NoiseError, NoisyContact};
use contact_kinematics::at_once;
use std::ops::Range;

impl Features {
    /// What `curves` of contacts, each in the order in which it was traced, say of corners, edges and faces.
    ///
    /// Each curve is cut into runs of one kind, by dynamic programming over the evidence of each (see `evidence`); a run has a
    /// kind where the odds for it are those of `options` at least, else it is open. Runs at one corner, on one edge or face are joined
    /// across curves where noise explains what they differ by. A run that is open is at a known corner or face where its contacts are
    /// by those odds rather there than anywhere on the body.
    ///
    /// # Errors
    /// [`NoiseError`] for noise levels that are none, points that are not finite and odds that are not above 1.
    pub fn find(curves: &[Vec<NoisyContact>], options: &FeatureOptions) -> Result<Self, NoiseError> {
        NoiseError::check_contacts(curves)?;
        if !(options.odds > 1.0 && options.odds.is_finite()) {
            return Err(NoiseError::Odds(options.odds));
        }
        let units = moments::Units::of(curves);
        let of = |range: Range<usize>| {
            let of_curve = |curve: usize| {
                let runs = segment::runs(&moments::Sums::new(&curves[curve], &units), options);
                runs.into_iter().map(move |run| FeatureRun { curve, ..run })
            };
            range.flat_map(of_curve).collect::<Vec<_>>()
        };
        let half = half_of(curves);
        let (mut runs, second) = at_once(|| of(0..half), || of(half..curves.len()));
        runs.extend(second);
        let first = join::joined(curves, runs, units.size, options);
        let runs = assign::assigned(curves, &first, &units, options);
        Ok(join::joined(curves, runs, units.size, options))
    }
}

/// The curve before which about half of the contacts are.
fn half_of(curves: &[Vec<NoisyContact>]) -> usize {
    let all: usize = curves.iter().map(Vec::len).sum();
    let mut before = 0;
    let reached = |curve: &Vec<NoisyContact>| {
        before += curve.len();
        2 * before >= all
    };
    curves.iter().position(reached).unwrap_or(0)
}
