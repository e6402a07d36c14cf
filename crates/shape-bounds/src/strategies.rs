//! Contacts for property tests by proptest, beside the points and half-spaces of the kernel.

use crate::ContactSample;
use crate::generators::{curve_contacts, ellipsoid_contacts};
pub use exact_hull::strategies::{exact_isometry, points, shuffled, tangents};
use proptest::prelude::*;
use std::ops::Range;

/// Contacts on an ellipsoid, in a number within `count`: along three curves, or all over it.
pub fn contacts(count: Range<usize>) -> impl Strategy<Value = Vec<ContactSample>> {
    (any::<bool>(), count, any::<u64>()).prop_map(|(along_curves, count, seed)| {
        if along_curves { curve_contacts(count, seed) } else { ellipsoid_contacts(count, seed) }
    })
}
