//! Noise that lasts from one contact to the next, in the plane and in space: what it makes of a fit's residuals and of its covariance.
//!
//! The fit takes a part of such noise for shape, the more the longer it lasts, so that residuals are less alike than the noise was. With the whitened rows
//! `J = Q R` and noise of correlation `C`, that of a first-order autoregressive process, residuals have the covariance `M C M`, `M = 1 - Q Q'`, and
//! parameters `R^-1 Q' C Q R^-T`. The process is the one of whose residuals the lag-one correlation is expected to be what it is.

use super::NoiseLevel;
use super::levenberg::{Problem, Solution, Whitened};
use super::misfit::Misfit;
use nalgebra::DMatrix;

/// Standard deviations of a correlation of independent residuals that are taken for chance.
const CHANCE: f64 = 2.0;
/// Correlation from which on noise is not to be told from a constant.
const MOST_ALIKE: f64 = 0.999;
/// How well the correlation is to be explained, and the halvings that this may take.
const EXPLAINED: f64 = 1e-3;
const HALVINGS: usize = 20;

/// Noise as alike from contact to contact as residuals say.
#[derive(Clone, Debug)]
pub(crate) struct Lasting {
    /// Correlation of the noise of contacts that follow each other; 0 where chance explains that of the residuals.
    pub(crate) correlation: f64,
    /// What the sum of squared residuals is expected to be, in units of the noise.
    pub(crate) expected: f64,
    /// `Q' C Q`, nowhere less than of independent noise.
    pub(crate) spread: DMatrix<f64>,
    /// What deviations of parameters are wider by at most.
    pub(crate) widening: f64,
}

/// Sums over the contacts for noise of one correlation.
struct Expected {
    /// Of the products of residuals that follow each other, and of their squares.
    products: f64,
    squares: f64,
    spread: DMatrix<f64>,
}

/// Orthonormal columns and residuals of a fit, with so many rows to a contact.
struct Rows<'a> {
    q: &'a DMatrix<f64>,
    dimension: usize,
    /// `(Q' L Q + Q' L' Q) / 2` with `L` the shift by one contact.
    shifted: DMatrix<f64>,
}

impl Rows<'_> {
    fn expected(&self, correlation: f64) -> Expected {
        let (count, p) = (self.q.nrows() / self.dimension, self.q.ncols());
        let mut held = DMatrix::<f64>::zeros(self.dimension, p);
        let mut half = DMatrix::<f64>::zeros(p, p);
        // Sum of `tr Q' L C Q` and `tr Q' L' C Q`, of which the one leaves the last contact out and the other one the first.
        let (mut shifted, mut since_first) = (0.0, correlation);
        for k in 0..count {
            let own = self.q.rows(k * self.dimension, self.dimension);
            shifted += 2.0 * own.dot(&held);
            held *= correlation;
            held += own;
            half.gemm_tr(1.0, &own, &held, 1.0);
            let with_all_before = correlation * own.dot(&held);
            let with_first = since_first * own.dot(&self.q.rows(0, self.dimension));
            shifted += with_all_before - with_first + if k + 1 < count { with_all_before } else { 0.0 };
            since_first *= correlation;
        }
        // The diagonal of the correlation stands in both halves.
        let spread = &half + half.transpose() - DMatrix::identity(p, p);
        let all = self.q.nrows() as f64;
        let products = (all - self.dimension as f64) * correlation - shifted + self.shifted.dot(&spread);
        Expected { products, squares: all - spread.trace(), spread }
    }

    /// The least correlation of which nothing is missed any more, searched for from a first one on.
    fn explaining(&self, missed: impl Fn(&Expected) -> f64, first: f64) -> (f64, Expected) {
        let (mut least, mut most, mut correlation) = (0.0, MOST_ALIKE, first.clamp(0.0, MOST_ALIKE));
        let mut expected = self.expected(correlation);
        for _ in 0..HALVINGS {
            let missed = missed(&expected);
            if missed.abs() < EXPLAINED || most - least < EXPLAINED * (1.0 - least) {
                break;
            }
            if missed > 0.0 {
                least = correlation;
            } else {
                most = correlation;
            }
            // Halves what is left to one, where deviations follow it most.
            correlation = 1.0 - ((1.0 - least) * (1.0 - most)).sqrt();
            expected = self.expected(correlation);
        }
        (correlation, expected)
    }
}

impl Lasting {
    /// Of independent noise.
    fn none(equations: usize, parameters: usize) -> Self {
        let expected = equations.saturating_sub(parameters) as f64;
        Self { correlation: 0.0, expected, spread: DMatrix::identity(parameters, parameters), widening: 1.0 }
    }

    /// By whitened rows, which the triangle `root` makes orthonormal, and what the fit leaves of them: as long as explains how alike residuals are, and
    /// how small those of stated noise.
    fn of(whitened: &Whitened, root: &DMatrix<f64>, level: NoiseLevel) -> Self {
        let Whitened { dimension, rows, residuals } = whitened;
        let dimension = *dimension;
        let none = Self::none(rows.nrows(), rows.ncols());
        let squares: f64 = residuals.iter().map(|r| r * r).sum();
        let products: f64 = residuals.iter().zip(residuals.iter().skip(dimension)).map(|(a, b)| a * b).sum();
        let alike = products / squares;
        let chance = CHANCE / (residuals.len() as f64).sqrt();
        let small =
            level == NoiseLevel::Stated && squares < none.expected - CHANCE * (2.0 * none.expected).sqrt();
        // Of independent noise residuals are less alike than not at all, by no more than the share of the equations that parameters take.
        let may_be_alike = alike > chance - rows.ncols() as f64 / rows.nrows() as f64;
        if !(squares > 0.0 && (small || may_be_alike)) {
            return none;
        }
        let Some(q) = root.transpose().solve_lower_triangular(&rows.transpose()).map(|q| q.transpose())
        else {
            return none;
        };
        let last = q.nrows() - dimension;
        let once = q.rows(0, last).tr_mul(&q.rows(dimension, last));
        let own = Rows { q: &q, dimension, shifted: (&once + once.transpose()) * 0.5 };
        let ratio = |expected: &Expected| expected.products / expected.squares.max(f64::MIN_POSITIVE);
        let is_alike = may_be_alike && alike - ratio(&own.expected(0.0)) > chance;
        // As alike as noise may be of which chance made residuals look less so.
        let by_likeness =
            is_alike.then(|| own.explaining(|expected| alike + chance - ratio(expected), alike));
        let by_size = small.then(|| own.explaining(|expected| 1.0 - squares / expected.squares, 0.5));
        let longest = by_likeness.into_iter().chain(by_size).max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((correlation, Expected { squares: expected, spread, .. })) = longest else { return none };
        if !(expected > 0.0 && spread.iter().all(|v| v.is_finite())) {
            return none;
        }
        // What differs from contact to contact is known better where noise does not, if it is such noise: that is not counted on.
        let mut axes = spread.symmetric_eigen();
        axes.eigenvalues.apply(|own| *own = own.max(1.0));
        let widening = axes.eigenvalues.max().sqrt();
        Self { correlation, expected, spread: axes.recompose(), widening }
    }

    /// What stated standard deviations are to be multiplied by. Stated ones are no smaller than what residuals of noise that lasts so long ask for, of
    /// which a fit leaves little.
    fn noise_factor(&self, level: NoiseLevel, misfit: &Misfit) -> f64 {
        let factor = (misfit.chi_squared / (self.expected + misfit.held as f64).max(1e-3)).sqrt();
        match level {
            NoiseLevel::Stated => factor.max(1.0),
            NoiseLevel::Estimated => factor,
        }
    }
}

/// How far the parameters of a fit may be off.
pub(crate) struct Deviations {
    pub(crate) covariance: DMatrix<f64>,
    /// Common factor of the noise's standard deviations.
    pub(crate) noise_factor: f64,
    /// Correlation of the noise of contacts that follow each other.
    pub(crate) correlation: f64,
    /// By how much deviations are larger than those of independent noise as stated, at most.
    pub(crate) widening: f64,
}

impl Deviations {
    /// At a solution; `None` where it leaves a combination of the parameters open.
    pub(crate) fn of<P: Problem>(
        problem: &P,
        solution: &Solution<P::Contact>,
        misfit: &Misfit,
        level: NoiseLevel,
    ) -> Option<Self> {
        let triangle = solution.system.root.triangle();
        let lasting = match misfit.is_exact() {
            true => Lasting::none(misfit.equations, misfit.parameters),
            false => Lasting::of(&problem.whitened(solution)?, &triangle, level),
        };
        let noise_factor = match lasting.correlation > 0.0 {
            true => lasting.noise_factor(level, misfit),
            false => misfit.noise_factor(level),
        };
        let back = solution.system.root.inverse()?;
        let covariance = (&back * &lasting.spread * back.transpose()) * noise_factor.powi(2);
        let widening = noise_factor * lasting.widening;
        let finite = covariance.iter().all(|v| v.is_finite());
        finite.then_some(Self { covariance, noise_factor, correlation: lasting.correlation, widening })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generators::Source;
    use nalgebra::DVector;

    /// Rows of a constant and a slope for two coordinates, and noise on them of so much correlation, with the true covariance of what is fitted.
    fn fitted(count: usize, correlation: f64, seed: u64) -> (Lasting, DVector<f64>, DMatrix<f64>) {
        let rows = DMatrix::from_fn(2 * count, 4, |i, j| match (i % 2 == j % 2, j / 2) {
            (false, _) => 0.0,
            (true, 0) => 1.0,
            _ => (i / 2) as f64 / count as f64 - 0.5,
        });
        let (mut source, mut held) = (Source::new(seed), [0.0; 2]);
        let mut noise = DVector::zeros(2 * count);
        for k in 0..count {
            let fresh = if k == 0 { 1.0 } else { f64::sqrt(1.0 - correlation * correlation) };
            held = held.map(|h| h * correlation + fresh * source.normal());
            (noise[2 * k], noise[2 * k + 1]) = (held[0], held[1]);
        }
        let root = (rows.tr_mul(&rows)).cholesky().unwrap().l().transpose();
        let found = rows.tr_mul(&rows).cholesky().unwrap().solve(&rows.tr_mul(&noise));
        let left = noise - &rows * &found;
        let lasting = Lasting::of(
            &Whitened { dimension: 2, rows, residuals: left.as_slice().to_vec() },
            &root,
            NoiseLevel::Stated,
        );
        let back = root.solve_upper_triangular(&DMatrix::identity(4, 4)).unwrap();
        let factor = f64::max(1.0, left.norm_squared() / lasting.expected);
        let covariance = &back * &lasting.spread * back.transpose() * factor;
        (lasting, found, covariance)
    }

    #[test]
    fn sums_are_those_of_the_matrices() {
        let (count, dimension) = (7, 2);
        let mut source = Source::new(3);
        let q = DMatrix::from_fn(count * dimension, 3, |_, _| source.normal()).qr().q();
        let shift =
            DMatrix::from_fn(count * dimension, count * dimension, |i, j| f64::from(u8::from(j == i + 2)));
        let symmetric = (&shift + shift.transpose()) * 0.5;
        let own = Rows { q: &q, dimension, shifted: q.tr_mul(&(&symmetric * &q)) };
        for by in [0.0, 0.4, 0.95_f64] {
            let c = DMatrix::from_fn(count * dimension, count * dimension, |i, j| {
                if i % 2 == j % 2 { by.powi((i as i32 / 2 - j as i32 / 2).abs()) } else { 0.0 }
            });
            let m = DMatrix::identity(count * dimension, count * dimension) - &q * q.transpose();
            let residuals = &m * &c * &m;
            let expected = own.expected(by);
            assert!((expected.squares - residuals.trace()).abs() < 1e-12);
            assert!((expected.products - (&symmetric * &residuals).trace()).abs() < 1e-12);
            assert!((expected.spread - q.tr_mul(&(&c * &q))).norm() < 1e-12);
        }
    }

    #[test]
    fn deviations_are_true_however_long_noise_lasts() {
        for (by, least) in [(0.0, 1.0), (0.6, 1.7), (0.9, 3.0), (0.99, 5.0)] {
            let (mut square, mut widest, runs) = (0.0, 0.0_f64, 200);
            for seed in 0..runs {
                let (lasting, found, covariance) = fitted(60, by, seed);
                square += found.dot(&covariance.cholesky().unwrap().solve(&found)) / (4 * runs) as f64;
                widest = widest.max(lasting.widening);
            }
            // What is learned of a correlation of 0.99 from 60 contacts is little: deviations are too small by a sixth there.

            println!("{by} {square} {widest}");
            assert!((0.1..1.6).contains(&square) && widest > least, "{by}: {square} {widest}");
        }
    }
}
