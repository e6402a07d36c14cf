use crate::bounds::{BoundsError, ShapeBounds, beyond};
use crate::sample::ContactSample;
use exact_hull::HalfSpace;
use exact_hull::Hull;
use glam::DVec3;

/// By how much a contact may lie outside of another's plane and still count as inside, relative to the size: rounding.
const ROUNDING: f64 = 1e-12;

impl ShapeBounds {
    /// Bounds of the convex hull of a body that may be concave, with the indices of the contacts whose half-spaces were used.
    ///
    /// The hull of the contact points is in the hull of the body, whatever its shape. A tangent plane bounds the body only
    /// where the contact is on the boundary of the body's hull. Contacts that have another contact point beyond their
    /// plane certainly are not, and are left out. The others *may* be: a part of the body that no palm has touched may still
    /// lie beyond. The upper bound is therefore sound if every contact that is kept lies on the hull of the body, and
    /// tends to the hull as contacts cover the body; it is not a proof from contacts alone, which cannot give one.
    ///
    /// # Errors
    /// Those of [`ShapeBounds::from_contacts`]; contradictions cannot occur but for rounding, since all points satisfy all
    /// half-spaces kept.
    pub fn from_concave_contacts(contacts: &[ContactSample]) -> Result<(Self, Vec<usize>), BoundsError> {
        Self::check(contacts)?;
        let points: Vec<DVec3> = contacts.iter().map(|c| c.point).collect();
        let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let hull = Hull::of(&points)?;
        let beyond = beyond(&hull, &points, contacts);
        let kept: Vec<usize> = (0..contacts.len()).filter(|i| beyond[*i].1 <= ROUNDING * size).collect();
        let half_spaces: Vec<HalfSpace> = kept.iter().map(|i| contacts[*i].half_space()).collect();
        Ok((Self::from_parts(&points, &half_spaces)?, kept))
    }
}
