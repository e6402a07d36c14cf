use super::{FitError, FittedBody, ShapeFamily};
use contact_kinematics::{Direction, SupportFunction};
use glam::DVec3;
use nalgebra::{DMatrix, DVector};

/// How well a fitted shape explains its contacts, and how well they determine it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitStatistics {
    /// Sum of squared residuals in units of the stated noise; `degrees_of_freedom` is expected of a true model.
    pub chi_squared: f64,
    /// Equations (three for each contact, in the plane two) minus parameters that no constraint holds.
    pub degrees_of_freedom: usize,
    /// Root mean square of the residuals of the points, normals carried along, in m per axis.
    pub residual: f64,
    /// The contact that fits worst, and its squared residual in units of the noise (about 3 is expected).
    pub worst: (usize, f64),
    /// Estimated common factor of the noise's standard deviations; 1 where the stated noise is taken as it is, and no less than that of stated noise that lasts.
    pub noise_factor: f64,
    /// Correlation of the noise from one contact to the next that makes residuals as alike as they are: 0 where chance explains it, at most 0.999.
    /// The covariance is that of such noise.
    pub correlation: f64,
    /// Condition number of the least-squares problem in parameters relative to their natural sizes.
    pub condition: f64,
    /// Standard deviation of the least determined combination of parameters, relative to the size of the data.
    pub weakest_deviation: f64,
    /// Curvature constraints that hold the shape; with any, the covariance is that of the unconstrained fit.
    pub active_constraints: usize,
    /// Iterations until the fit was at rest.
    pub iterations: usize,
}

/// A shape fitted to contacts.
#[derive(Clone, Debug)]
pub struct ShapeFit {
    pub(super) family: ShapeFamily,
    pub(super) body: FittedBody,
    pub(super) parameters: DVector<f64>,
    pub(super) covariance: DMatrix<f64>,
    pub(super) statistics: FitStatistics,
    pub(super) information_criterion: f64,
    pub(super) names: Vec<String>,
    /// Why the contacts refute the shape, if they do.
    pub(super) refuted: Option<FitError>,
    /// Whether the residuals are rounding.
    pub(super) is_exact: bool,
}

impl ShapeFit {
    /// The family.
    #[must_use]
    pub fn family(&self) -> ShapeFamily {
        self.family
    }

    /// The shape; it is a support function like any other body.
    #[must_use]
    pub fn body(&self) -> &FittedBody {
        &self.body
    }

    /// The parameters, in the order of [`Self::names`].
    #[must_use]
    pub fn parameters(&self) -> &DVector<f64> {
        &self.parameters
    }

    /// What each parameter is called.
    #[must_use]
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Covariance of the parameters; of a superquadric's orientation, that of a small turn about the body's axes.
    ///
    /// It is the inverse of the Fisher information at the estimate, that is, the Cramer-Rao bound as the data see it.
    #[must_use]
    pub fn covariance(&self) -> &DMatrix<f64> {
        &self.covariance
    }

    /// Residuals and what the contacts determine.
    #[must_use]
    pub fn statistics(&self) -> &FitStatistics {
        &self.statistics
    }

    /// Bayesian information criterion, smaller is better: see [`ShapeFit::choose`].
    #[must_use]
    pub fn information_criterion(&self) -> f64 {
        self.information_criterion
    }

    /// Standard deviation of the support function `h(n)` in m: how uncertain the shape is in direction `n`.
    #[must_use]
    pub fn support_deviation(&self, n: Direction) -> f64 {
        let mut columns = vec![DVec3::ZERO; self.parameters.len()];
        let model = self.family.model();
        let Some(_) = model.and_then(|m| m.columns(&self.parameters, n, &mut columns)) else {
            return f64::INFINITY;
        };
        // h(n) = n . x(n), and n is held.
        let slope = DVector::from_iterator(columns.len(), columns.iter().map(|c| c.dot(n.get())));
        slope.dot(&(&self.covariance * &slope)).max(0.0).sqrt()
    }
}

impl SupportFunction for ShapeFit {
    fn jet(&self, n: Direction) -> contact_kinematics::SupportJet {
        self.body.jet(n)
    }
    fn value(&self, n: Direction) -> f64 {
        self.body.value(n)
    }
    fn curvature_radii(&self) -> contact_kinematics::CurvatureRadii {
        self.body.curvature_radii()
    }
}
