//! Approximations of a body from its contacts, which are no bounds: splines through them and principal surfaces of noisy ones.
//!
//! Both describe the body by its distance from a centre along each direction (it is *star-shaped*, convex or not), after an affine
//! map that makes its hull round, as a spline of three axes restricted to the sphere. A contact fixes the value and, by its normal,
//! the slopes there, which are linear conditions: no patches are to be sewn together, and the surface is twice continuously
//! differentiable everywhere, across the curves as well. [`SplineSurface`] meets them with the least energy;
//! [`PrincipalSurface`] smooths points whose normals it does not need, by as much as they ask for. In the plane the same are
//! [`crate::planar::approximation::SplineCurve`] and [`crate::planar::approximation::PrincipalCurve`].
//!
//! Not by patches between the curves: where curves cross, end or leave wide gaps is as the motion happened to go, so there is no net of
//! four-sided patches to fill. Not by the support function, whose splines are convex bodies alone.
//!
//! ```
//! use glam::DVec3;
//! use shape_bounds::ContactSample;
//! use shape_bounds::approximation::SplineSurface;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! // An ellipsoid, touched where its normals point to the corners, edges and faces of a cube.
//! let axes = DVec3::new(2.0, 1.5, 1.0);
//! let normals = (0..27).filter(|k| *k != 13).map(|k| DVec3::new((k % 3) as f64, (k / 3 % 3) as f64, (k / 9) as f64) - DVec3::ONE);
//! let contact = |n: DVec3| (axes * axes * n / (axes * n).length(), n.normalize());
//! let contacts = ContactSample::from_raw(normals.map(contact))?;
//! let surface = SplineSurface::through(&contacts)?;
//! // Where it was not touched:
//! let direction = DVec3::new(1.0, 0.4, 0.3);
//! let exact = direction / (direction / axes).length();
//! assert!((surface.point(direction) - exact).length() < 0.01);
//! assert!(surface.residual() < 1e-9);
//! # Ok(())
//! # }
//! ```

mod basis;
mod envelope;
mod error;
mod lattice;
#[cfg(test)]
mod laws;
mod mesh;
pub(crate) mod principal;
mod smoother;
pub(crate) mod star;
mod surface;
#[cfg(test)]
mod tests;
pub(crate) mod through;

pub use error::ApproximationError;
pub use surface::{PrincipalSurface, SplineSurface};

/// The power of two next to the largest coordinate: what is divided by it has the same digits, and squares in range.
pub(crate) fn unit(coordinates: impl Iterator<Item = f64>) -> f64 {
    let largest = coordinates.map(f64::abs).fold(f64::MIN_POSITIVE, f64::max);
    2_f64.powi(largest.log2().floor() as i32)
}

/// Refuses too few points, and those that are not finite.
pub(crate) fn check(
    are_finite: impl ExactSizeIterator<Item = bool>,
    least: usize,
) -> Result<(), ApproximationError> {
    let found = are_finite.len();
    if found < least {
        return Err(ApproximationError::TooFew { found, least });
    }
    match { are_finite }.position(|is_finite| !is_finite) {
        Some(index) => Err(ApproximationError::NotFinite { index }),
        None => Ok(()),
    }
}

/// Cells from the centre to the sphere, within limits, where these are to be so many to a spacing of the contacts on it.
pub(crate) fn cells(each: f64, spacing: f64, [least, most]: [usize; 2]) -> usize {
    ((each / spacing).round() as usize).clamp(least, most)
}
