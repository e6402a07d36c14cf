use super::ellipsoid::outer;
use super::{CurvatureRadii, ShapeError, SupportFunction, SupportJet, principal_radii};
use crate::Direction;
use glam::{DMat3, DVec3};
use std::sync::OnceLock;

/// Highest degree accepted: at degree 32 the curvature bounds below take about a second.
const LARGEST_DEGREE: u32 = 32;
/// Grid spacings times degree in [`PolynomialSupport::curvature_radii`], tried in turn: the slack is half the square of
/// these, as a share of the largest radius.
const SPACINGS_TIMES_DEGREE: [f64; 3] = [0.25, 0.1, 0.05];
/// Slack, as a share of the smallest radius, with which a coarser grid will do.
const ENOUGH: f64 = 0.05;

/// One term `coefficient n_x^i n_y^j n_z^k` of a polynomial on the unit sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monomial {
    /// Powers of `n_x`, `n_y`, `n_z`.
    pub powers: [u32; 3],
    /// Coefficient in m.
    pub coefficient: f64,
}

/// A support function that is a polynomial in the components of the unit normal.
///
/// Each term of degree `d` is extended 1-homogeneously as `p(u) |u|^(1-d)`. On its own it need not be convex; in a sum
/// with a body of large enough radii of curvature it is, see [`crate::check_convex`].
#[derive(Clone, Debug)]
pub struct PolynomialSupport {
    terms: Vec<Monomial>,
    degree: u32,
    /// Found by a scan, once.
    radii: OnceLock<CurvatureRadii>,
}

impl PartialEq for PolynomialSupport {
    fn eq(&self, other: &Self) -> bool {
        self.terms == other.terms
    }
}

impl PolynomialSupport {
    /// From its terms.
    ///
    /// # Errors
    /// [`ShapeError::Coefficient`] for a coefficient that is not finite, [`ShapeError::Degree`] for a degree above 32.
    pub fn new(terms: Vec<Monomial>) -> Result<Self, ShapeError> {
        let mut degree = 0;
        for (index, term) in terms.iter().enumerate() {
            if !term.coefficient.is_finite() {
                return Err(ShapeError::Coefficient { index, value: term.coefficient });
            }
            let total = term.powers.iter().fold(0u32, |sum, &p| sum.saturating_add(p));
            if total > LARGEST_DEGREE {
                return Err(ShapeError::Degree { index, degree: total, limit: LARGEST_DEGREE });
            }
            degree = degree.max(total);
        }
        Ok(Self { terms, degree, radii: OnceLock::new() })
    }

    /// An egg about the Z axis: `h = radius + stretch n_z^2 + taper n_z^3`, lengths in m.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn egg(radius: f64, stretch: f64, taper: f64) -> Result<Self, ShapeError> {
        let term = |power, coefficient| Monomial { powers: [0, 0, power], coefficient };
        Self::new(vec![term(0, radius), term(2, stretch), term(3, taper)])
    }

    /// From real orthonormal spherical harmonics: `coefficients[l][l + m]` in m multiplies `Y_lm`, `m = -l..=l`
    /// (`m < 0`: sine terms).
    ///
    /// # Errors
    /// [`ShapeError::HarmonicCount`] unless row `l` has `2 l + 1` entries, and those of [`Self::new`].
    pub fn from_harmonics(coefficients: &[Vec<f64>]) -> Result<Self, ShapeError> {
        let mut terms = Vec::new();
        for (l, row) in coefficients.iter().enumerate() {
            if row.len() != 2 * l + 1 {
                return Err(ShapeError::HarmonicCount { degree: l, expected: 2 * l + 1, found: row.len() });
            }
            for (index, &coefficient) in row.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                super::harmonic::push_harmonic(&mut terms, l, index, coefficient);
            }
        }
        // Harmonics share monomials: each is evaluated once. The sort is stable, so sums have a fixed order.
        terms.sort_by_key(|term| term.powers);
        terms.dedup_by(|later, first| {
            let same = later.powers == first.powers;
            if same {
                first.coefficient += later.coefficient;
            }
            same
        });
        Self::new(terms)
    }

    /// Its terms.
    #[must_use]
    pub fn terms(&self) -> &[Monomial] {
        &self.terms
    }

    /// Degree of the polynomial.
    #[must_use]
    pub fn degree(&self) -> u32 {
        self.degree
    }
}

impl SupportFunction for PolynomialSupport {
    fn jet(&self, n: Direction) -> SupportJet {
        let n = n.get();
        let mut powers = [DVec3::ONE; LARGEST_DEGREE as usize + 1];
        for i in 1..=self.degree as usize {
            powers[i] = powers[i - 1] * n;
        }
        let (mut value, mut point, mut hessian) = (0.0, DVec3::ZERO, DMat3::ZERO);
        let mut isotropic = 0.0;
        let mut radial = DVec3::ZERO;
        let mut along = 0.0;
        for term in &self.terms {
            let (p, gradient, second) = monomial(term, &powers);
            let degree = f64::from(term.powers.iter().sum::<u32>());
            // |u|^k with k = 1 - d: gradient k u, Hessian k 1 + k (k - 2) u u' at |u| = 1.
            let k = 1.0 - degree;
            value += p;
            point += gradient + n * (k * p);
            hessian += second;
            isotropic += k * p;
            radial += gradient * k;
            along += k * (k - 2.0) * p;
        }
        hessian += DMat3::from_diagonal(DVec3::splat(isotropic));
        hessian += outer(n, radial) + outer(radial, n) + outer(n, n) * along;
        SupportJet { value, point, hessian }
    }

    fn value(&self, n: Direction) -> f64 {
        let powers = |term: &Monomial| (0..3).map(|i| power(n.get()[i], term.powers[i])).product::<f64>();
        self.terms.iter().map(|term| term.coefficient * powers(term)).sum()
    }

    /// A certificate, not a sample: along any great circle, in a direction carried along in parallel, the normal
    /// curvature radius is a trigonometric polynomial of at most the degree `k` of `h`, so by Bernstein's inequality its
    /// second derivative is at most `k^2 M`, with `M` the largest absolute radius. At the place and in the direction
    /// where it is extreme its slope vanishes, so a grid that leaves no normal further than `delta` away errs by at most
    /// `(delta k)^2 M / 2`, and `M` itself is at most its grid value over `1 - (delta k)^2 / 2`.
    fn curvature_radii(&self) -> CurvatureRadii {
        *self.radii.get_or_init(|| {
            let mut radii = CurvatureRadii { min: f64::NEG_INFINITY, max: f64::INFINITY };
            for spacing in SPACINGS_TIMES_DEGREE {
                let (min, max, slack) = self.radii_on_grid(spacing);
                radii = CurvatureRadii { min: min - slack, max: max + slack };
                if slack <= ENOUGH * min.abs() {
                    break;
                }
            }
            radii
        })
    }
}

impl PolynomialSupport {
    /// Smallest and largest radius on a grid whose spacing times the degree is at most `spacing`, and the slack.
    fn radii_on_grid(&self, spacing: f64) -> (f64, f64, f64) {
        let degree = f64::from(self.degree.max(1));
        // Cube faces with `cells`^2 cells each: the half diagonal of a cell, sqrt(2) / cells, bounds the angle.
        let cells = (2f64.sqrt() * degree / spacing).ceil() as u32;
        let (mut min, mut max) = (f64::INFINITY, f64::NEG_INFINITY);
        for face in 0..6 {
            for i in 0..cells {
                for j in 0..cells {
                    let n = cube_direction(face, i, j, cells);
                    let [small, large] = principal_radii(self.jet(n).hessian, n);
                    (min, max) = (min.min(small), max.max(large));
                }
            }
        }
        let share = 0.5 * (2f64.sqrt() / f64::from(cells) * degree).powi(2);
        (min, max, share * min.abs().max(max.abs()) / (1.0 - share))
    }
}

/// Centre of cell `(i, j)` of a cube face, projected onto the unit sphere.
fn cube_direction(face: usize, i: u32, j: u32, cells: u32) -> Direction {
    let centre = |k: u32| (2.0 * f64::from(k) + 1.0) / f64::from(cells) - 1.0;
    let mut v = [0.0; 3];
    v[face / 2] = if face.is_multiple_of(2) { 1.0 } else { -1.0 };
    v[(face / 2 + 1) % 3] = centre(i);
    v[(face / 2 + 2) % 3] = centre(j);
    Direction::new_unchecked(DVec3::from_array(v).normalize())
}

/// Integer power, with `0^0 = 1`.
fn power(x: f64, exponent: u32) -> f64 {
    x.powi(i32::try_from(exponent).unwrap_or(i32::MAX))
}

/// Value, gradient and Hessian of one term as a plain polynomial, from the powers of the components of the normal.
fn monomial(term: &Monomial, powers: &[DVec3]) -> (f64, DVec3, DMat3) {
    // Per axis: n^p, p n^(p-1), p (p-1) n^(p-2).
    let axis = |i: usize| {
        let p = term.powers[i] as usize;
        let q = p as f64;
        let first = if p > 0 { q * powers[p - 1][i] } else { 0.0 };
        let second = if p > 1 { q * (q - 1.0) * powers[p - 2][i] } else { 0.0 };
        [powers[p][i], first, second]
    };
    let (a, b, c) = (axis(0), axis(1), axis(2));
    let k = term.coefficient;
    let gradient = DVec3::new(a[1] * b[0] * c[0], a[0] * b[1] * c[0], a[0] * b[0] * c[1]);
    let (xy, xz, yz) = (a[1] * b[1] * c[0], a[1] * b[0] * c[1], a[0] * b[1] * c[1]);
    let hessian = DMat3::from_cols(
        DVec3::new(a[2] * b[0] * c[0], xy, xz),
        DVec3::new(xy, a[0] * b[2] * c[0], yz),
        DVec3::new(xz, yz, a[0] * b[0] * c[2]),
    );
    (k * a[0] * b[0] * c[0], k * gradient, k * hessian)
}
