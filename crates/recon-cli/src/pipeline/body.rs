use crate::error::CliError;
use recon::contact_kinematics::{
    Ellipsoid, MinkowskiSum, Monomial, PolynomialSupport, Sphere, SupportFunction, Translated,
};
use recon_io::{Shape, Simulation};
use std::f64::consts::PI;

/// The body of a scene's simulation, about its centre of mass.
pub(crate) fn body(simulation: &Simulation) -> Result<Box<dyn SupportFunction>, CliError> {
    fn at<S: SupportFunction + 'static>(body: S, simulation: &Simulation) -> Box<dyn SupportFunction> {
        Box::new(Translated { body, offset: simulation.offset })
    }
    Ok(match &simulation.shape {
        Shape::Sphere { radius } => at(Sphere::new(*radius)?, simulation),
        Shape::Ellipsoid { semi_axes } => at(Ellipsoid::new(*semi_axes)?, simulation),
        // A ball of no radius adds nothing, and is no sphere.
        Shape::EllipsoidPlusBall { semi_axes, radius } if *radius == 0.0 => {
            at(Ellipsoid::new(*semi_axes)?, simulation)
        }
        Shape::EllipsoidPlusBall { semi_axes, radius } => {
            at(MinkowskiSum(Ellipsoid::new(*semi_axes)?, Sphere::new(*radius)?), simulation)
        }
        Shape::Polynomial { terms } => {
            let term = |&(coefficient, powers): &(f64, [u8; 3])| Monomial {
                powers: powers.map(u32::from),
                coefficient,
            };
            at(PolynomialSupport::new(terms.iter().map(term).collect())?, simulation)
        }
    })
}

/// Volume in m^3, for the shapes that have a closed form.
pub(crate) fn volume(shape: &Shape) -> Option<f64> {
    match shape {
        Shape::Sphere { radius } => Some(4.0 / 3.0 * PI * radius.powi(3)),
        Shape::Ellipsoid { semi_axes } => Some(4.0 / 3.0 * PI * semi_axes.element_product()),
        Shape::EllipsoidPlusBall { .. } | Shape::Polynomial { .. } => None,
    }
}
