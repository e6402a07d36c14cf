use super::contour::zero_surface;
use super::error::SurfaceError;
use crate::sample::ContactSample;
use exact_hull::TriangleMesh;
use glam::{DMat3, DVec3};
use nalgebra::{DMatrix, DVector};

/// The equations are dense, four for each contact: at this number they take some seconds and 100 MB.
const MOST: usize = 1000;
const LEAST: usize = 4;
/// Contacts nearer than this, relative to the size, are one place.
const COINCIDENT: f64 = 1e-9;
/// By how much the box of a mesh is wider than that of the contacts on each side, relative to their size.
const AROUND: f64 = 0.15;
/// Steps along a ray, and of Newton's method.
const RAY_STEPS: usize = 200;
const NEWTON_STEPS: usize = 60;

/// The smooth surface through contact points with the contact normals: the zeros of
/// `f(y) = sum_j (a_j phi(y - x_j) - b_j . grad phi(y - x_j)) + c + d . y` with `phi = |y|^3`, which has `f(x_k) = 0` and
/// `grad f(x_k) = n_k` (Hermite radial basis functions: Macedo, Gois and Velho, "Hermite radial basis functions implicits",
/// 2011). Of all functions that do so it has the least bending energy, and it needs no mesh and no convexity.
///
/// An interpolant, not a bound: between contacts it errs with the fourth power of their spacing on a smooth body that is
/// covered, and it may do anything far from them. Noise is interpolated as well.
#[derive(Clone, Debug)]
pub struct HermiteSurface {
    points: Vec<DVec3>,
    weights: Vec<(f64, DVec3)>,
    constant: f64,
    slope: DVec3,
    centre: DVec3,
    size: f64,
}

/// `phi`, its gradient and its Hessian at `r`.
fn kernel(r: DVec3) -> (f64, DVec3, DMat3) {
    let length = r.length();
    if length == 0.0 {
        return (0.0, DVec3::ZERO, DMat3::ZERO);
    }
    let outer = DMat3::from_cols(r * r.x, r * r.y, r * r.z);
    let hessian = (DMat3::from_diagonal(DVec3::splat(length)) + outer * (1.0 / length)) * 3.0;
    (length.powi(3), r * (3.0 * length), hessian)
}

impl HermiteSurface {
    /// The surface through `contacts`, in time O(n^3).
    ///
    /// # Errors
    /// [`SurfaceError`] for fewer than 4 or more than 1000 contacts, values that are not finite, contacts at one place, and
    /// equations that cannot be solved.
    pub fn through(contacts: &[ContactSample]) -> Result<Self, SurfaceError> {
        let count = contacts.len();
        if !(LEAST..=MOST).contains(&count) {
            return Err(SurfaceError::Count { found: count, least: LEAST, most: MOST });
        }
        if let Some(index) = contacts.iter().position(|c| !c.point.is_finite()) {
            return Err(SurfaceError::NotFinite { index });
        }
        let centre = contacts.iter().map(|c| c.point).sum::<DVec3>() / count as f64;
        let size = contacts.iter().map(|c| c.point.distance(centre)).fold(0.0, f64::max);
        for first in 0..count {
            for second in first + 1..count {
                let distance = contacts[first].point.distance(contacts[second].point);
                if distance <= COINCIDENT * size {
                    return Err(SurfaceError::Coincident { first, second, distance });
                }
            }
        }
        // In units of the size about the centre, so that the conditioning is that of the places.
        let points: Vec<DVec3> = contacts.iter().map(|c| (c.point - centre) / size).collect();
        let (matrix, right) = equations(&points, contacts);
        let solution = matrix.lu().solve(&right).filter(|x| x.iter().all(|v| v.is_finite()));
        let solution = solution.ok_or(SurfaceError::Singular)?;
        let three = |i: usize| DVec3::new(solution[i], solution[i + 1], solution[i + 2]);
        Ok(Self {
            weights: (0..count).map(|j| (solution[4 * j], three(4 * j + 1))).collect(),
            constant: solution[4 * count],
            slope: three(4 * count + 1),
            points,
            centre,
            size,
        })
    }

    /// `f` and its gradient at `y`. Near the surface `f` is about the distance from it in m, positive outside.
    #[must_use]
    pub fn value(&self, y: DVec3) -> (f64, DVec3) {
        let y = (y - self.centre) / self.size;
        let mut value = self.constant + self.slope.dot(y);
        let mut gradient = self.slope;
        for (x, (a, b)) in self.points.iter().zip(&self.weights) {
            let (phi, first, second) = kernel(y - *x);
            value += a * phi - b.dot(first);
            gradient += first * *a - second * *b;
        }
        (value * self.size, gradient)
    }

    /// Distance in m along `direction` (unit) from `start`, at which the surface is left for good within `reach` (m): the
    /// outermost crossing from inside to outside. `None` if there is none.
    ///
    /// Crossings are looked for at 200 places along the ray; two that are nearer to each other can be missed.
    #[must_use]
    pub fn along_ray(&self, start: DVec3, direction: DVec3, reach: f64) -> Option<f64> {
        let at = |t: f64| self.value(start + direction * t).0;
        let step = reach / RAY_STEPS as f64;
        let mut outside = at(reach);
        for k in (0..RAY_STEPS).rev() {
            let (mut low, mut high) = (k as f64 * step, (k + 1) as f64 * step);
            let inside = at(low);
            if inside <= 0.0 && outside > 0.0 {
                for _ in 0..NEWTON_STEPS {
                    let middle = 0.5 * (low + high);
                    if at(middle) <= 0.0 { low = middle } else { high = middle }
                }
                return Some(0.5 * (low + high));
            }
            outside = inside;
        }
        None
    }

    /// Triangles of the surface in a box somewhat wider than the contacts, counter-clockwise seen from outside, on a
    /// lattice of `cells` (at least 2) along its longest side: off the surface by the square of the spacing.
    ///
    /// Far from contacts the surface may leave the box, and is open there.
    #[must_use]
    pub fn mesh(&self, cells: usize) -> TriangleMesh {
        let place = |p: &DVec3| *p * self.size + self.centre;
        let low = self.points.iter().map(place).fold(DVec3::INFINITY, DVec3::min);
        let high = self.points.iter().map(place).fold(DVec3::NEG_INFINITY, DVec3::max);
        let around = DVec3::splat(AROUND * self.size);
        zero_surface(low - around, high + around, cells.max(2), |y| self.value(y).0)
    }
}

/// `f(x_k) = 0` and `grad f(x_k) = n_k`, and the conditions that make the energy finite: symmetric.
fn equations(points: &[DVec3], contacts: &[ContactSample]) -> (DMatrix<f64>, DVector<f64>) {
    let count = points.len();
    let order = 4 * count + 4;
    let mut matrix = DMatrix::zeros(order, order);
    let mut right = DVector::zeros(order);
    for k in 0..count {
        for j in 0..count {
            let (phi, first, second) = kernel(points[k] - points[j]);
            matrix[(4 * k, 4 * j)] = phi;
            for i in 0..3 {
                matrix[(4 * k, 4 * j + 1 + i)] = -first[i];
                matrix[(4 * k + 1 + i, 4 * j)] = first[i];
                for l in 0..3 {
                    matrix[(4 * k + 1 + i, 4 * j + 1 + l)] = -second.col(l)[i];
                }
            }
        }
        let tail = 4 * count;
        matrix[(4 * k, tail)] = 1.0;
        matrix[(tail, 4 * k)] = 1.0;
        for i in 0..3 {
            matrix[(4 * k, tail + 1 + i)] = points[k][i];
            matrix[(tail + 1 + i, 4 * k)] = points[k][i];
            matrix[(4 * k + 1 + i, tail + 1 + i)] = 1.0;
            matrix[(tail + 1 + i, 4 * k + 1 + i)] = 1.0;
            right[4 * k + 1 + i] = contacts[k].normal.get()[i];
        }
    }
    (matrix, right)
}
