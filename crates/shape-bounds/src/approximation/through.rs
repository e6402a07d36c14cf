//! The spline through contacts with their tangent planes.

use super::error::ApproximationError;
use super::smoother::Smoother;
use super::star::{Frame, Star};
use nalgebra::SVector;

/// Least cosine between a contact's normal and the ray to it, both in round coordinates: at 0.02 the surface is seen at a degree.
const SEEN: f64 = 0.02;
/// Below this cosine another centre is looked for.
const STEEP: f64 = 0.1;

/// A spline in coordinates that are divided by a power of two.
#[derive(Clone, Debug)]
pub(crate) struct Spline<const D: usize> {
    pub(super) star: Star<D>,
    /// Metres per unit.
    pub(super) unit: f64,
    /// Root mean square distance of what it was made of, in m.
    pub(crate) residual: f64,
}

impl<const D: usize> Spline<D> {
    /// The spline through points with outward normals, in units, about the frame or, if that sees a contact along the surface, about
    /// the point that `kernel` gives: one on the inner side of all contacts, and in their hull.
    pub(crate) fn through(
        (frame, unit): (Frame<D>, f64),
        contacts: &[(SVector<f64, D>, SVector<f64, D>)],
        half: usize,
        kernel: impl FnOnce() -> Result<Option<SVector<f64, D>>, ApproximationError>,
    ) -> Result<Self, ApproximationError> {
        let own = steepest(&frame, contacts);
        let other = if own.1 < STEEP { kernel()? } else { None };
        let other = other.map(|centre| frame.clone().about(centre));
        let frame = other.filter(|other| steepest(other, contacts).1 > own.1).unwrap_or(frame);
        let star = through(frame, contacts, half)?;
        let squares: f64 = contacts.iter().map(|(point, _)| star.nearest(point).offset.powi(2)).sum();
        let residual = (squares / contacts.len() as f64).sqrt() * unit;
        Ok(Self { star, unit, residual })
    }

    /// Where it is seen from as a whole, in m.
    pub(crate) fn centre(&self) -> SVector<f64, D> {
        self.star.frame.centre * self.unit
    }

    /// Point (m) and normal that the centre sees along a direction of any length.
    pub(crate) fn seen(&self, direction: &SVector<f64, D>) -> (SVector<f64, D>, SVector<f64, D>) {
        let (point, normal) = self.star.at(&self.star.towards(direction));
        (point * self.unit, normal)
    }

    /// The point (m) in a direction of the round body, of unit length.
    pub(crate) fn at(&self, u: &SVector<f64, D>) -> SVector<f64, D> {
        self.star.at(u).0 * self.unit
    }

    /// Whether a point (m) is inside.
    pub(crate) fn contains(&self, point: &SVector<f64, D>) -> bool {
        self.star.beyond(&(point / self.unit)) <= 0.0
    }

    /// How far outside a point near it is, in m.
    pub(crate) fn distance(&self, point: &SVector<f64, D>) -> f64 {
        self.star.nearest(&(point / self.unit)).offset * self.unit
    }
}

/// The contact that is seen most nearly along its surface, and the cosine of its normal with the ray to it in round coordinates.
fn steepest<const D: usize>(
    frame: &Frame<D>,
    contacts: &[(SVector<f64, D>, SVector<f64, D>)],
) -> (usize, f64) {
    let cosines = contacts.iter().map(|(point, normal)| frame.normal(normal).dot(&frame.place(point).0));
    cosines.enumerate().fold((0, f64::INFINITY), |least, one| if one.1 >= least.1 { least } else { one })
}

/// The spline through points with outward normals, on a lattice of `half` cells from centre to sphere.
///
/// In round coordinates `y` the surface is `ln |y| = g(u)` with `u = y / |y|`; its normal is along `u - grad g`, so that a contact
/// with normal `n` fixes the value and the gradient of `g` in its direction: `grad g = u - n / (n . u)`.
fn through<const D: usize>(
    frame: Frame<D>,
    contacts: &[(SVector<f64, D>, SVector<f64, D>)],
    half: usize,
) -> Result<Star<D>, ApproximationError> {
    let (index, cosine) = steepest(&frame, contacts);
    if cosine.is_nan() || cosine < SEEN {
        return Err(ApproximationError::NotStarShaped { contacts: vec![index] });
    }
    let smoother = Smoother::<D>::new(half);
    let mut rows = Vec::with_capacity(D * contacts.len());
    for (point, normal) in contacts {
        let (u, value) = frame.place(point);
        let normal = frame.normal(normal);
        rows.push(smoother.value(&u, value, 1.0));
        let gradient = u - normal / normal.dot(&u);
        // A slope counts as much as what it makes of the value over one cell.
        for along in tangents(&u) {
            rows.push(smoother.slope(&u, &along, gradient.dot(&along), 1.0 / half as f64));
        }
    }
    let coefficients = smoother.through(&rows).ok_or(ApproximationError::Singular)?;
    Ok(Star { frame, smoother, coefficients })
}

/// Unit vectors that span the plane across `u`.
fn tangents<const D: usize>(u: &SVector<f64, D>) -> Vec<SVector<f64, D>> {
    // The axes but for that of the largest coordinate, made perpendicular to `u` and to each other.
    let mut basis = vec![*u];
    for axis in (0..D).filter(|axis| *axis != u.icamax()) {
        let mut along = SVector::<f64, D>::zeros();
        along[axis] = 1.0;
        for _ in 0..2 {
            basis.iter().for_each(|b| along -= b * b.dot(&along));
        }
        basis.push(along.normalize());
    }
    basis.split_off(1)
}
