//! The motion sample by sample, in bounded memory and time, from no guess.

mod estimate;
mod front;
mod kind;
mod known;
mod pieces;
mod search;
mod settling;
mod stream;
mod tracker;
mod tracking;
mod unknown;

#[cfg(test)]
mod tests;

pub use estimate::{StreamBody, StreamError, StreamEstimate, StreamOptions, StreamStage};

use super::momentum::UNKNOWNS;
use super::unknown_body::{BODY_UNKNOWNS, STATES};
use known::Known;
use object_dynamics::Sample;
use stream::Stream;
use unknown::Unknown;

/// The motion of a body on three palms, sample by sample; mass and inertia are estimated along where they are not known.
///
/// Samples are gathered into blocks; a node of the state-space model stands for each. The cold start of the batch method
/// runs beside them, one Levenberg-Marquardt step a sample, on the data as they grow. The motion that it finds is adjusted
/// with states and noise together over all nodes so far, a few nodes a sample: chi-squared tells whether it explains them,
/// and the covariance what they leave open. While that is much, the motion waits for more data, and a motion is stated
/// only when it has foretold nodes that it was not fitted to. From there a windowed Gauss-Newton observer goes on, in which
/// each datum counts once; weights and derivatives are taken at adjusted data there too. From the latest node to the
/// newest sample the motion follows the measured forces, and the covariance their noise. Memory is bounded (some megabytes
/// while nothing is found), and so is the work of a sample; once a motion is followed nothing is allocated.
///
/// A palm that loses contact carries no force and gives no condition; the estimate goes on with what is left, and says
/// so.
pub struct MotionStream(Inner);

enum Inner {
    Known(Box<Stream<Known, UNKNOWNS, UNKNOWNS>>),
    Unknown(Box<Stream<Unknown, STATES, BODY_UNKNOWNS>>),
}

impl MotionStream {
    /// A stream that has seen no sample yet.
    ///
    /// # Errors
    /// [`StreamError::Option`] names the option that is not a usable number.
    pub fn new(options: StreamOptions) -> Result<Self, StreamError> {
        let StreamOptions { noise, gravity, .. } = options;
        let inner = match options.mass {
            Some(mass) => Inner::Known(Box::new(Stream::new(Known { mass, noise, gravity }, options)?)),
            None => Inner::Unknown(Box::new(Stream::new(Unknown { noise, gravity }, options)?)),
        };
        Ok(Self(inner))
    }

    /// Takes a sample and returns the motion at the sample before it: rates of palms come from differences. None for
    /// the very first one.
    ///
    /// # Errors
    /// [`StreamError::Sample`], [`StreamError::Time`] or [`StreamError::Reading`] for a sample that cannot be used (it is
    /// left out).
    pub fn push(&mut self, sample: &Sample) -> Result<Option<StreamEstimate>, StreamError> {
        match &mut self.0 {
            Inner::Known(stream) => stream.push(sample),
            Inner::Unknown(stream) => stream.push(sample),
        }
    }
}
