//! The least deviations that what was sensed allows of a motion (Cramér-Rao), in the plane and in space: the line that no estimate crosses that is right on average.
//!
//! The shape is anything: at each sample contact points and forces are unknowns of their own beside what was read of them, and
//! what ties all samples together are Newton's and Euler's equations and that no contact opens. About the truth all of it is linear; least squares of linear
//! equations with normal noise attain the bound (Gorman and Hero 1990, for unknowns under constraints), and a Kalman filter is such least squares, whose
//! covariance after the last sample is the bound there. Nothing here is of the estimators: their nodes, windows and numbers are not known to this module.

pub mod plane;
pub mod space;

use nalgebra::{DMatrix, DVector};

/// Deviation of what nothing is known of beforehand, natural units: far beyond all that a log of use leaves open.
const UNKNOWN: f64 = 10.0;
/// Deviation of what is known, natural units.
const KNOWN: f64 = 1e-6;
/// Deviation of a condition by itself, natural speeds: against the rounding of a filter whose readings are exact.
const ROUNDING: f64 = 1e-7;

/// Length (m) and time (s) in which numbers are of the order of one.
#[derive(Clone, Copy, Debug)]
pub struct Scales {
    /// Size of the body, m.
    pub length: f64,
    /// Natural time, s.
    pub time: f64,
}

/// What is linear about the truth at a sample. `x` are the motion and the body's constants, `e` the errors of the readings at the sample.
trait Linear {
    /// Time, s.
    fn time(&self) -> f64;

    /// Derivatives of the rates of `x` by `x` and by `e`.
    fn rates(&self) -> [DMatrix<f64>; 2];

    /// Derivatives of the speeds at which contacts open, m/s, by `x` and by `e`.
    fn openings(&self) -> [DMatrix<f64>; 2];
}

/// Covariance of `x` at the last sample, from deviations of `x` before the first one and of the readings at each; `rounding` is of an opening, m/s.
/// None of fewer than two samples, and where the equations are singular in double precision.
fn covariance(
    samples: &[impl Linear],
    before: &DVector<f64>,
    read: &DVector<f64>,
    rounding: f64,
) -> Option<DMatrix<f64>> {
    let (own, count) = (before.len(), read.len());
    let mut deviations = DVector::zeros(own + count);
    deviations.rows_mut(0, own).copy_from(before);
    deviations.rows_mut(own, count).copy_from(read);
    let mut filter = Filter {
        read,
        variance: rounding * rounding,
        covariance: DMatrix::from_diagonal(&deviations.component_mul(&deviations)),
    };
    filter.condition(samples.first()?)?;
    for pair in samples.windows(2) {
        filter.carry([&pair[0], &pair[1]])?;
        filter.condition(&pair[1])?;
    }
    (samples.len() > 1).then(|| filter.covariance.view((0, 0), (own, own)).into_owned())
}

/// What the readings so far leave open of `x` and of the errors at the sample.
struct Filter<'a> {
    /// Deviations of the readings at a sample.
    read: &'a DVector<f64>,
    /// Variance of an opening by itself, (m/s)^2.
    variance: f64,
    covariance: DMatrix<f64>,
}

impl Filter<'_> {
    /// To the next sample, whose readings have errors of their own; rates change linearly in between.
    fn carry(&mut self, [before, after]: [&impl Linear; 2]) -> Option<()> {
        let count = self.read.len();
        let own = self.covariance.nrows() - count;
        let half = 0.5 * (after.time() - before.time());
        let ([by_own, by_read], [next_own, next_read]) = (before.rates(), after.rates());
        let one = DMatrix::identity(own, own);
        let implicit = (&one - next_own * half).try_inverse()?;
        let mut step = DMatrix::zeros(own + count, own + count);
        step.view_mut((0, 0), (own, own)).copy_from(&(&implicit * (one + by_own * half)));
        step.view_mut((0, own), (own, count)).copy_from(&(&implicit * by_read * half));
        let mut fresh = DMatrix::zeros(own + count, count);
        fresh.view_mut((0, 0), (own, count)).copy_from(&(implicit * next_read * half));
        fresh.view_mut((own, 0), (count, count)).fill_with_identity();
        let fresh = fresh * DMatrix::from_diagonal(self.read);
        self.covariance = &step * &self.covariance * step.transpose() + &fresh * fresh.transpose();
        Some(())
    }

    /// That no contact opens.
    fn condition(&mut self, now: &impl Linear) -> Option<()> {
        let [by_own, by_read] = now.openings();
        let (size, palms) = (self.covariance.nrows(), by_own.nrows());
        let mut rows = DMatrix::zeros(palms, size);
        rows.columns_mut(0, by_own.ncols()).copy_from(&by_own);
        rows.columns_mut(by_own.ncols(), by_read.ncols()).copy_from(&by_read);
        let across = &self.covariance * rows.transpose();
        let own = &rows * &across + DMatrix::identity(palms, palms) * self.variance;
        let gain = across * own.try_inverse()?;
        // Joseph's form stays symmetric and positive.
        let left = DMatrix::identity(size, size) - &gain * rows;
        self.covariance =
            &left * &self.covariance * left.transpose() + &gain * gain.transpose() * self.variance;
        Some(())
    }
}
