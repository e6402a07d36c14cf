use serde::Serialize;
use thiserror::Error;

/// Bounds of what may be asked for: beyond a tenth the size of the object means nothing, below 1e-12 is rounding.
const POSSIBLE: std::ops::RangeInclusive<f64> = 1e-12..=0.1;

/// How near to the true motion a result is to be.
///
/// Of a pose the error is the larger one of two numbers: the distance of the centre of mass from where it is, over the natural size `l` of the
/// object (its mean semi-axis, or the mean distance of its contacts from their mean), and the angle, rad, between its orientation and the true
/// one. Of a simulation the accuracy bounds the largest error at any sample; of a reconstruction it bounds, with a probability of 95 %, the root
/// mean square over the samples of either number, where the orientation is counted from the first sample.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
#[serde(transparent)]
pub struct Accuracy(f64);

/// What is no accuracy.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("the wanted accuracy is {value}; it must lie between {} and {} (sizes, rad)", POSSIBLE.start(), POSSIBLE.end())]
pub struct AccuracyError {
    /// As given.
    pub value: f64,
}

impl Accuracy {
    /// Of a number between 1e-12 and 0.1.
    ///
    /// # Errors
    /// [`AccuracyError`].
    pub fn new(value: f64) -> Result<Self, AccuracyError> {
        if POSSIBLE.contains(&value) { Ok(Self(value)) } else { Err(AccuracyError { value }) }
    }

    /// In sizes and rad.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}
