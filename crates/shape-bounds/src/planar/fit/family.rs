//! The families of outlines, each as a radius function with the derivatives of its points by its parameters.

use super::OutlineFamily;
use contact_kinematics::planar::{Circle, FourierBody, RadiusBounds, RadiusFunction, RadiusJet, ShapeError};
use glam::{DMat2, DVec2};
use nalgebra::DVector;

/// A family of radius functions by parameters, all in m.
pub(super) trait Model {
    /// Number of parameters.
    fn count(&self) -> usize;

    /// The body, convex or not; `None` where the parameters are none.
    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn RadiusFunction>>;

    /// Derivative of the point with normal direction `angle` by each parameter.
    fn columns(&self, theta: &DVector<f64>, angle: f64, columns: &mut [DVec2]) -> Option<()>;

    /// What a parameter is called.
    fn name(&self, parameter: usize) -> String;

    /// Parameters of the disc with this centre and radius.
    fn circle(&self, centre: DVec2, radius: f64) -> DVector<f64>;
}

pub(super) fn model(family: OutlineFamily) -> Box<dyn Model> {
    match family {
        OutlineFamily::Circle => Box::new(Waves { order: 1, disc: true }),
        OutlineFamily::Ellipse => Box::new(Ellipses),
        OutlineFamily::Fourier { order } => Box::new(Waves { order: order.max(1), disc: false }),
    }
}

/// A fitted outline.
#[derive(Clone, Debug, PartialEq)]
pub enum FittedOutline {
    /// A disc.
    Circle(Circle),
    /// An ellipse.
    Ellipse(TurnedEllipse),
    /// Waves, proved convex.
    Fourier(FourierBody),
}

impl FittedOutline {
    fn radius_function(&self) -> &dyn RadiusFunction {
        match self {
            Self::Circle(body) => body,
            Self::Ellipse(body) => body,
            Self::Fourier(body) => body,
        }
    }
}

impl RadiusFunction for FittedOutline {
    fn jet(&self, theta: f64) -> RadiusJet {
        self.radius_function().jet(theta)
    }
    fn radius_bounds(&self) -> RadiusBounds {
        self.radius_function().radius_bounds()
    }
}

pub(super) fn outline(family: OutlineFamily, theta: &DVector<f64>) -> Result<FittedOutline, ShapeError> {
    Ok(match family {
        OutlineFamily::Circle => {
            FittedOutline::Circle(Circle::new(theta[2], DVec2::new(theta[0], theta[1]))?)
        }
        OutlineFamily::Ellipse => FittedOutline::Ellipse(Ellipses::of(theta)?),
        OutlineFamily::Fourier { .. } => {
            let (cosines, sines) = coefficients(theta);
            FittedOutline::Fourier(FourierBody::new(&cosines, &sines)?)
        }
    })
}

/// Cosine and sine coefficients by order, of `a_0, a_1, b_1, ...`.
fn coefficients(theta: &DVector<f64>) -> (Vec<f64>, Vec<f64>) {
    let orders = theta.len().div_ceil(2);
    let cosine = |k: usize| if k == 0 { theta[0] } else { theta[2 * k - 1] };
    let sine = |k: usize| if k == 0 { 0.0 } else { theta[2 * k] };
    ((0..orders).map(cosine).collect(), (0..orders).map(sine).collect())
}

/// Waves up to an order; as a disc with the parameters centre and radius.
struct Waves {
    order: usize,
    disc: bool,
}

/// A sum of waves that need not be convex.
pub(super) struct AnyWaves {
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl AnyWaves {
    pub(super) fn of(theta: &DVector<f64>) -> Self {
        let (cosines, sines) = coefficients(theta);
        Self { cosines, sines }
    }
}

impl RadiusFunction for AnyWaves {
    fn jet(&self, theta: f64) -> RadiusJet {
        let mut jet = RadiusJet { r: self.cosines[0], d: 0.0, rho: self.cosines[0] };
        for (k, (a, b)) in self.cosines.iter().zip(&self.sines).enumerate().skip(1) {
            let order = k as f64;
            let (sin, cos) = (order * theta).sin_cos();
            let wave = a * cos + b * sin;
            jet.r += wave;
            jet.d += order * (a * sin - b * cos);
            jet.rho += (1.0 - order * order) * wave;
        }
        jet
    }

    /// Not asked for in a fit: a sum of the largest that each wave can do.
    fn radius_bounds(&self) -> RadiusBounds {
        let waves = self.cosines.iter().zip(&self.sines).enumerate().skip(1);
        let swing: f64 = waves.map(|(k, (a, b))| ((k * k - 1) as f64) * a.hypot(*b)).sum();
        RadiusBounds { min: self.cosines[0] - swing, max: self.cosines[0] + swing }
    }
}

impl Model for Waves {
    fn count(&self) -> usize {
        2 * self.order + 1
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn RadiusFunction>> {
        let (cosines, sines) =
            if self.disc { (vec![theta[2], theta[0]], vec![0.0, theta[1]]) } else { coefficients(theta) };
        Some(Box::new(AnyWaves { cosines, sines }))
    }

    fn columns(&self, _theta: &DVector<f64>, angle: f64, columns: &mut [DVec2]) -> Option<()> {
        let n = DVec2::from_angle(angle);
        if self.disc {
            columns.copy_from_slice(&[DVec2::X, DVec2::Y, n]);
            return Some(());
        }
        // x = r n + r' n'.
        columns[0] = n;
        for k in 1..=self.order {
            let order = k as f64;
            let (sin, cos) = (order * angle).sin_cos();
            columns[2 * k - 1] = n * cos - n.perp() * (order * sin);
            columns[2 * k] = n * sin + n.perp() * (order * cos);
        }
        Some(())
    }

    fn name(&self, parameter: usize) -> String {
        if self.disc {
            return ["centre x", "centre y", "radius"][parameter].to_owned();
        }
        let order = parameter.div_ceil(2);
        format!("{} wave {order}", if parameter == 0 || parameter % 2 == 1 { "cosine" } else { "sine" })
    }

    fn circle(&self, centre: DVec2, radius: f64) -> DVector<f64> {
        let mut theta = DVector::zeros(self.count());
        let place = if self.disc { [2, 0, 1] } else { [0, 1, 2] };
        for (place, value) in place.into_iter().zip([radius, centre.x, centre.y]) {
            theta[place] = value;
        }
        theta
    }
}

/// An ellipse with any centre and axes: `r = c . n + sqrt(n' A n)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TurnedEllipse {
    centre: DVec2,
    matrix: DMat2,
    semi_axes: DVec2,
    angle: f64,
}

impl TurnedEllipse {
    /// From the centre (m) and the symmetric matrix `A` (m^2), of which the entries `xx`, `xy` and `yy` are taken.
    ///
    /// # Errors
    /// [`ShapeError::Length`] unless both semi-axes are positive and finite.
    pub fn new(centre: DVec2, [xx, xy, yy]: [f64; 3]) -> Result<Self, ShapeError> {
        let (mean, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let squares = DVec2::new(mean + half, mean - half);
        // Below this share of the larger, the smaller eigenvalue is rounding.
        if !(squares.y > 1e-14 * squares.x && squares.is_finite()) {
            return Err(ShapeError::Length { what: "smaller semi-axis squared", value: squares.y });
        }
        if !centre.is_finite() {
            return Err(ShapeError::Length { what: "centre", value: centre.length() });
        }
        Ok(Self {
            centre,
            matrix: DMat2::from_cols(DVec2::new(xx, xy), DVec2::new(xy, yy)),
            semi_axes: DVec2::new(squares.x.sqrt(), squares.y.sqrt()),
            angle: 0.5 * (2.0 * xy).atan2(xx - yy),
        })
    }

    /// Centre in m.
    #[must_use]
    pub fn centre(&self) -> DVec2 {
        self.centre
    }

    /// Semi-axes in m, the longer first.
    #[must_use]
    pub fn semi_axes(&self) -> DVec2 {
        self.semi_axes
    }

    /// Angle of the longer axis from x, in rad.
    #[must_use]
    pub fn angle(&self) -> f64 {
        self.angle
    }
}

impl RadiusFunction for TurnedEllipse {
    fn jet(&self, theta: f64) -> RadiusJet {
        let n = DVec2::from_angle(theta);
        let scaled = self.matrix * n;
        // At least the smaller semi-axis, which the constructor keeps above zero.
        let own = scaled.dot(n).sqrt();
        let point = scaled / own + self.centre;
        RadiusJet {
            r: own + self.centre.dot(n),
            d: -point.dot(n.perp()),
            rho: (self.semi_axes.element_product() / own).powi(2) / own,
        }
    }

    fn radius_bounds(&self) -> RadiusBounds {
        let DVec2 { x: long, y: short } = self.semi_axes;
        RadiusBounds { min: short * short / long, max: long * long / short }
    }
}

/// Centre and the lower triangle of `A = L L'`: `xx`, `yx`, `yy`.
struct Ellipses;

impl Ellipses {
    fn of(theta: &DVector<f64>) -> Result<TurnedEllipse, ShapeError> {
        let (a, b, c) = (theta[2], theta[3], theta[4]);
        TurnedEllipse::new(DVec2::new(theta[0], theta[1]), [a * a, a * b, b * b + c * c])
    }
}

impl Model for Ellipses {
    fn count(&self) -> usize {
        5
    }

    fn body(&self, theta: &DVector<f64>) -> Option<Box<dyn RadiusFunction>> {
        Some(Box::new(Self::of(theta).ok()?))
    }

    fn columns(&self, theta: &DVector<f64>, angle: f64, columns: &mut [DVec2]) -> Option<()> {
        let n = DVec2::from_angle(angle);
        let l = DMat2::from_cols(DVec2::new(theta[2], theta[3]), DVec2::new(0.0, theta[4]));
        let inner = l.transpose() * n;
        let value = inner.length();
        if value.is_nan() || value <= 1e-9 * (theta[2].abs() + theta[3].abs() + theta[4].abs()) {
            return None;
        }
        let unit = inner / value;
        columns[..2].copy_from_slice(&DVec2::AXES);
        for (k, (row, column)) in [(0, 0), (1, 0), (1, 1)].into_iter().enumerate() {
            let turned = l.col(column) * n[row] - l * unit * (n[row] * unit[column]);
            columns[2 + k] = DVec2::AXES[row] * unit[column] + turned / value;
        }
        Some(())
    }

    fn name(&self, parameter: usize) -> String {
        ["centre x", "centre y", "axes xx", "axes yx", "axes yy"][parameter].to_owned()
    }

    fn circle(&self, centre: DVec2, radius: f64) -> DVector<f64> {
        DVector::from_column_slice(&[centre.x, centre.y, radius, 0.0, radius])
    }
}
