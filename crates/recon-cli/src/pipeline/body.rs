use recon_io::Shape;
use std::f64::consts::PI;

/// Volume in m^3, for the shapes that have a closed form.
pub(crate) fn volume(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Sphere { radius } => Some(4.0 / 3.0 * PI * radius.powi(3)),
        Shape::Ellipsoid { semi_axes } => Some(4.0 / 3.0 * PI * semi_axes.element_product()),
        Shape::EllipsoidPlusBall { .. } | Shape::Polytope { .. } | Shape::Polynomial { .. } => None,
    }
}
