//! A surface that is seen from its centre as a whole: its distance along each direction as a spline on the sphere.

use super::error::ApproximationError;
use super::smoother::Smoother;
use nalgebra::{DMatrix, SMatrix, SVector};

/// Moments over the ends of the largest, below which the points are flat.
const FLAT: f64 = 1e-12;
/// Steps to the nearest place of a surface, and how near to it the last has to be, in sizes.
const STEPS: usize = 60;
const NEAR: f64 = 1e-12;

/// Where a body is, how large and how long along which axes: the affine map that makes it round.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Frame<const D: usize> {
    /// In m.
    pub(super) centre: SVector<f64, D>,
    /// Symmetric; in 1/m.
    to_round: SMatrix<f64, D, D>,
    /// Its inverse, in m.
    from_round: SMatrix<f64, D, D>,
}

impl<const D: usize> Frame<D> {
    /// From the centre and the second moments about it (m^2) of a body that is to have those of the unit ball.
    ///
    /// The root of the moments turns with the body, so that the frame has no preferred directions.
    fn new(centre: SVector<f64, D>, moments: &SMatrix<f64, D, D>) -> Result<Self, ApproximationError> {
        let eigen = DMatrix::from_fn(D, D, |i, j| moments[(i, j)]).symmetric_eigen();
        let largest = eigen.eigenvalues.max();
        let above = eigen.eigenvalues.iter().filter(|v| **v > FLAT * largest).count();
        if above < D {
            return Err(ApproximationError::Flat { dimension: above });
        }
        // A ball of radius 1 has second moments of 1 / (D + 2) of its volume.
        let root = |power: f64| {
            let axes = &eigen.eigenvectors;
            let lengths = eigen.eigenvalues.map(|v| (v * (D as f64 + 2.0)).powf(0.5 * power));
            let whole = axes * DMatrix::from_diagonal(&lengths) * axes.transpose();
            SMatrix::from_fn(|i, j| 0.5 * (whole[(i, j)] + whole[(j, i)]))
        };
        Ok(Self { centre, to_round: root(-1.0), from_round: root(1.0) })
    }

    /// That of a hull about `centre`: its second moments, summed over the simplices from there to the facets, whose corners are relative
    /// to it and whose measures are any multiple of the volumes.
    pub(crate) fn of_hull(
        centre: SVector<f64, D>,
        facets: impl Iterator<Item = ([SVector<f64, D>; D], f64)>,
    ) -> Result<Self, ApproximationError> {
        let (mut moments, mut total) = (SMatrix::<f64, D, D>::zeros(), 0.0);
        for (corners, measure) in facets {
            let sum: SVector<f64, D> = corners.iter().sum();
            let squares: SMatrix<f64, D, D> = corners.iter().map(|c| c * c.transpose()).sum();
            moments += (squares + sum * sum.transpose()) * measure;
            total += measure;
        }
        let simplex = ((D + 1) * (D + 2)) as f64;
        Self::new(centre, &(moments / (total * simplex)))
    }

    /// The same axes about another centre.
    pub(super) fn about(self, centre: SVector<f64, D>) -> Self {
        Self { centre, ..self }
    }

    /// Direction, and logarithm of the distance, of a point in round coordinates.
    pub(super) fn place(&self, point: &SVector<f64, D>) -> (SVector<f64, D>, f64) {
        let y = self.to_round * (point - self.centre);
        let length = y.norm();
        (y / length, length.ln())
    }

    /// A normal in round coordinates.
    pub(super) fn normal(&self, normal: &SVector<f64, D>) -> SVector<f64, D> {
        (self.from_round * normal).normalize()
    }
}

/// Points made ready.
pub(crate) struct Prepared<const D: usize, H> {
    /// The frame of their hull, and the power of two that all is in units of (m).
    pub(crate) framed: (Frame<D>, f64),
    pub(crate) points: Vec<SVector<f64, D>>,
    pub(crate) hull: H,
}

/// The spline on its frame: `|y| = exp g(y / |y|)` in round coordinates.
#[derive(Clone, Debug)]
pub(super) struct Star<const D: usize> {
    pub(super) frame: Frame<D>,
    pub(super) smoother: Smoother<D>,
    pub(super) coefficients: Vec<f64>,
}

/// A place of a surface that is nearest to a point.
pub(super) struct Nearest<const D: usize> {
    /// Its direction in round coordinates.
    pub(super) u: SVector<f64, D>,
    /// How far the point is outside, in m.
    pub(super) offset: f64,
    /// How far the tangent plane is from the centre, in m.
    pub(super) height: f64,
}

impl<const D: usize> Star<D> {
    /// Logarithm of the distance in round coordinates, and its gradient along the sphere, at `u` of unit length.
    pub(super) fn jet(&self, u: &SVector<f64, D>) -> (f64, SVector<f64, D>) {
        let (mut value, mut gradient) = (0.0, SVector::zeros());
        self.smoother.lattice.each_at(u, |number, b, slope| {
            value += self.coefficients[number] * b;
            gradient += slope * self.coefficients[number];
        });
        (value, gradient - u * u.dot(&gradient))
    }

    /// Point and outward normal at `u` in round coordinates.
    pub(super) fn at(&self, u: &SVector<f64, D>) -> (SVector<f64, D>, SVector<f64, D>) {
        let (value, gradient) = self.jet(u);
        let point = self.frame.centre + self.frame.from_round * u * value.exp();
        (point, (self.frame.to_round * (u - gradient)).normalize())
    }

    /// The direction in round coordinates in which the centre sees along `direction`.
    pub(super) fn towards(&self, direction: &SVector<f64, D>) -> SVector<f64, D> {
        (self.frame.to_round * direction).normalize()
    }

    /// How far inside (below zero) or outside a point is along the ray from the centre, as the logarithm of a share.
    pub(super) fn beyond(&self, point: &SVector<f64, D>) -> f64 {
        let (u, distance) = self.frame.place(point);
        // The centre itself has no direction and is inside.
        if distance == f64::NEG_INFINITY { distance } else { distance - self.jet(&u).0 }
    }

    /// The place nearest to `x`, from that on the ray through it: the tangent plane's nearest point is seen along the next direction.
    pub(super) fn nearest(&self, x: &SVector<f64, D>) -> Nearest<D> {
        let mut u = self.frame.place(x).0;
        for _ in 0..STEPS {
            let (point, normal) = self.at(&u);
            let along = (x - point) - normal * normal.dot(&(x - point));
            let from_centre = point - self.frame.centre;
            if along.norm() <= NEAR * from_centre.norm() {
                break;
            }
            u = self.towards(&(from_centre + along));
        }
        let (point, normal) = self.at(&u);
        let height = normal.dot(&(point - self.frame.centre));
        Nearest { u, offset: normal.dot(&(x - point)), height }
    }
}
