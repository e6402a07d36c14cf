//! What a fit of the shape is worth.

use super::{Candidate, Problem, ShapeFit};
use crate::Status;
use crate::chance::excess;
use crate::core::direction_words;
use nalgebra::{DMatrix, SymmetricEigen};

impl Problem<'_> {
    /// Evidence about the best of `finals`. Others that explain the data as well widen the covariance: the linear one knows
    /// only its own valley.
    pub(super) fn finish(&self, finals: &[Candidate], iterations: usize) -> ShapeFit {
        let x = finals.first().map_or(&self.centre, |best| &best.1);
        let all = self.samples.len();
        let count = x.len();
        let normal = self.normal(x, all, self.options.contact_deviation);
        let (matrix, squares, motion, radii) = match normal {
            Some(n) => (n.matrix, n.squares, n.motion, n.radii),
            None => (DMatrix::zeros(count, count), f64::NAN, Vec::new(), Vec::new()),
        };
        let eigen = SymmetricEigen::new(matrix);
        let lowest = eigen.eigenvalues.imin();
        let inner = eigen.eigenvalues.map(|v| 1.0 / (1.0 + v.max(0.0)));
        let scaled = &eigen.eigenvectors * DMatrix::from_diagonal(&inner) * eigen.eigenvectors.transpose();
        let mut covariance =
            DMatrix::from_fn(count, count, |i, j| scaled[(i, j)] * self.deviations[i] * self.deviations[j]);
        for (_, rival) in finals.iter().skip(1) {
            let away = rival - x;
            covariance += &away * away.transpose();
        }
        // Some direction is free, and the search over many starts has then fitted noise along it (as a disc's turn rate to the
        // strongest ripple): nothing beyond the prior is claimed.
        if eigen.eigenvalues[lowest] < 1.0 {
            let away = &self.centre - x;
            covariance = DMatrix::from_diagonal(&self.deviations.component_mul(&self.deviations));
            covariance += &away * away.transpose();
        }
        let residual = (squares / (2 * all) as f64).sqrt();
        let excess = excess(squares, (2 * all).saturating_sub(count) as f64);
        let smallest_information = eigen.eigenvalues[lowest].max(0.0);
        let status = if !residual.is_finite() {
            Status::Diverged
        } else if smallest_information < 1.0 {
            Status::NotObservable
        } else if excess > ShapeFit::UNEXPLAINED {
            Status::Inconsistent
        } else {
            Status::Converged
        };
        let deviation = |j: usize| covariance[(j, j)].sqrt();
        let gyration = x[1].exp();
        let harmonics = |part: usize| (1..=self.options.order).map(move |k| 2 * k + part);
        let mut cosines = vec![x[2]];
        cosines.extend(harmonics(1).map(|j| x[j]));
        let mut sines = vec![0.0];
        sines.extend(harmonics(2).map(|j| x[j]));
        ShapeFit {
            cosines,
            sines,
            gyration_squared: (gyration, gyration * deviation(1)),
            omega0: (x[0], deviation(0)),
            motion,
            radii,
            residual,
            excess,
            status,
            smallest_information,
            direction: direction_words(eigen.eigenvectors.column(lowest).as_slice(), name),
            iterations,
            covariance,
        }
    }
}

fn name(j: usize) -> String {
    match j {
        0 => "angular velocity".to_owned(),
        1 => "log squared radius of gyration".to_owned(),
        2 => "mean radius".to_owned(),
        _ => format!("{} of harmonic {}", if j % 2 == 1 { "cosine" } else { "sine" }, (j - 1) / 2),
    }
}
