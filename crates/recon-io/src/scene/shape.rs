use super::{BoxedShape, Shape, Simulation};
use recon::contact_kinematics::{
    Ellipsoid, MinkowskiSum, Monomial, PolynomialSupport, RoundedPolytope, ShapeError, Sphere,
    SupportFunction, Translated,
};

impl Simulation {
    /// The body, about its centre of mass.
    ///
    /// # Errors
    /// [`ShapeError`] where the numbers make no smooth convex body.
    pub fn body(&self) -> Result<BoxedShape, ShapeError> {
        fn at<S: SupportFunction + Send + Sync + 'static>(body: S, simulation: &Simulation) -> BoxedShape {
            Box::new(Translated { body, offset: simulation.offset })
        }
        Ok(match &self.shape {
            Shape::Sphere { radius } => at(Sphere::new(*radius)?, self),
            Shape::Ellipsoid { semi_axes } => at(Ellipsoid::new(*semi_axes)?, self),
            // A ball of no radius adds nothing, and is no sphere.
            Shape::EllipsoidPlusBall { semi_axes, radius } if *radius == 0.0 => {
                at(Ellipsoid::new(*semi_axes)?, self)
            }
            Shape::EllipsoidPlusBall { semi_axes, radius } => {
                at(MinkowskiSum(Ellipsoid::new(*semi_axes)?, Sphere::new(*radius)?), self)
            }
            Shape::Polytope { corners, radius, sharpness } => {
                at(RoundedPolytope::new(corners.clone(), *radius, *sharpness)?, self)
            }
            Shape::Polynomial { terms } => {
                let term = |&(coefficient, powers): &(f64, [u8; 3])| Monomial {
                    powers: powers.map(u32::from),
                    coefficient,
                };
                at(PolynomialSupport::new(terms.iter().map(term).collect())?, self)
            }
        })
    }
}
