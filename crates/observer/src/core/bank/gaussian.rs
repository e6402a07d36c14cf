//! Means and covariances whose size is known at run time only, since modes differ in it.

use nalgebra::{DMatrix, DVector, SMatrix, SVector};

/// Mean and covariance of a state.
#[derive(Clone, Debug, PartialEq)]
pub struct Gaussian {
    /// Mean.
    pub mean: DVector<f64>,
    /// Covariance, symmetric, of as many rows and columns as the mean has entries.
    pub covariance: DMatrix<f64>,
}

/// A Gaussian with its share in a mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch {
    /// Share; those of a mixture sum to one.
    pub weight: f64,
    /// Mean and covariance.
    pub gaussian: Gaussian,
}

impl Gaussian {
    /// From a mean and a covariance of a size known to the compiler.
    #[must_use]
    pub fn new<const N: usize>(mean: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) -> Self {
        Self {
            mean: DVector::from_column_slice(mean.as_slice()),
            covariance: DMatrix::from_column_slice(N, N, covariance.as_slice()),
        }
    }

    /// Zeros.
    pub(super) fn zeros(size: usize) -> Self {
        Self { mean: DVector::zeros(size), covariance: DMatrix::zeros(size, size) }
    }

    /// As values of a size known to the compiler; entries that there are not are NaN, which no estimate survives unnoticed.
    #[must_use]
    pub fn read<const N: usize>(&self) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let mean = SVector::from_fn(|i, _| self.mean.get(i).copied().unwrap_or(f64::NAN));
        let covariance = SMatrix::from_fn(|i, j| self.covariance.get((i, j)).copied().unwrap_or(f64::NAN));
        (mean, covariance)
    }

    /// Takes these values in place of its own; what has no room is left out.
    pub fn write<const N: usize>(&mut self, mean: &SVector<f64, N>, covariance: &SMatrix<f64, N, N>) {
        self.mean.iter_mut().zip(mean.iter()).for_each(|(own, new)| *own = *new);
        for i in 0..N {
            for j in 0..N {
                if let Some(own) = self.covariance.get_mut((i, j)) {
                    *own = covariance[(i, j)];
                }
            }
        }
    }

    /// Takes the values of one of the same size without making anything.
    pub(super) fn copy_from(&mut self, other: &Self) {
        self.mean.copy_from(&other.mean);
        self.covariance.copy_from(&other.covariance);
    }

    /// Whether an entry of the diagonal says that the covariance is none.
    pub(super) fn has_negative_variance(&self) -> bool {
        (0..self.mean.len()).any(|i| self.covariance[(i, i)] < 0.0)
    }

    /// Whether all entries are numbers.
    pub(super) fn is_finite(&self) -> bool {
        self.mean.iter().chain(self.covariance.iter()).all(|v| v.is_finite())
    }

    /// Whether mean and covariance are those of a state of this size.
    pub(super) fn is_of_size(&self, size: usize) -> bool {
        self.mean.len() == size && self.covariance.shape() == (size, size)
    }
}
