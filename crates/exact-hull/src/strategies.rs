//! The inputs of [`crate::generators`] for property tests by proptest, biased to the nearly degenerate as they are.
//!
//! ```
//! use exact_hull::strategies::points;
//! use exact_hull::{Hull, HullCertificate};
//! use proptest::prelude::*;
//!
//! proptest!(ProptestConfig::with_cases(20), |(points in points(1..40))| {
//!     if let Hull::Solid(hull) = Hull::of(&points)? {
//!         prop_assert!(HullCertificate::of(&hull.mesh(), &points)?.holds());
//!     }
//! });
//! ```

use crate::HalfSpace;
use crate::generators::{InputKind, Source, curve_normals, ellipsoid_half_spaces};
use glam::{DMat3, DVec3};
use proptest::prelude::*;
use std::ops::Range;

/// Points of any kind, in a number within `count`. Shrinks to fewer points of the same kind.
pub fn points(count: Range<usize>) -> impl Strategy<Value = Vec<DVec3>> {
    (prop::sample::select(&InputKind::ALL[..]), count, any::<u64>())
        .prop_map(|(kind, count, seed)| kind.points(count, seed))
}

/// Half-spaces that touch an ellipsoid, in a number within `count`: all over it, or along three curves.
pub fn tangents(count: Range<usize>) -> impl Strategy<Value = Vec<HalfSpace>> {
    (any::<bool>(), count, any::<u64>()).prop_map(|(along_curves, count, seed)| {
        let mut s = Source::new(seed);
        let normals = if along_curves {
            curve_normals(count, &mut s)
        } else {
            (0..count).map(|_| s.direction()).collect()
        };
        ellipsoid_half_spaces(&normals)
    })
}

/// One of the 48 turns and reflections of a cube: the isometries that move points without rounding them.
pub fn exact_isometry() -> impl Strategy<Value = DMat3> {
    let order = prop::sample::select(&[[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]][..]);
    (order, any::<[bool; 3]>()).prop_map(|(order, flipped)| {
        let column = |k: usize| DVec3::AXES[order[k]] * if flipped[k] { -1.0 } else { 1.0 };
        DMat3::from_cols(column(0), column(1), column(2))
    })
}

/// An order of all of `values`.
pub fn shuffled<T: Clone>(values: &[T], seed: u64) -> Vec<T> {
    let mut s = Source::new(seed);
    let mut shuffled = values.to_vec();
    (1..shuffled.len()).for_each(|last| shuffled.swap(last, s.below(last + 1)));
    shuffled
}
