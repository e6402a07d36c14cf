//! Products of vectors that `glam` lacks.

use glam::{DMat3, DVec3};

/// `a b'`.
pub(crate) fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}
