//! What becomes of the state when the mode changes.

use super::gaussian::Gaussian;
use nalgebra::{DMatrix, SMatrix, SVector};

/// Where a state lands that switches from one mode into another: `x_to = state + map (x_from - mean) + noise`.
///
/// What both modes have is copied. What the new mode lacks is dropped: no row of `map` looks at it. What it has in addition is
/// drawn from a stated prior: a zero row of `map`, the mean in `state`, the variance in `noise`; state the spread physically,
/// as a wider one makes the mode be found later, and a narrower one makes it be missed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing<const FROM: usize, const TO: usize> {
    /// Mean after the switch.
    pub state: SVector<f64, TO>,
    /// Derivative of it with respect to the state before.
    pub map: SMatrix<f64, TO, FROM>,
    /// Covariance of what the switch itself adds.
    pub noise: SMatrix<f64, TO, TO>,
}

/// Map of states between two modes; [`jump`] makes one of a function.
pub trait Jump<I>: Send {
    /// States before and after.
    fn sizes(&self) -> (usize, usize);

    /// Mean and covariance after a switch before the interval of `input`.
    fn land(&self, from: &Gaussian, input: &I, to: &mut Gaussian);

    /// Derivative of the mean after with respect to that before: what smoothing needs.
    fn map(&self, from: &Gaussian, input: &I) -> DMatrix<f64>;
}

struct StateJump<F, const FROM: usize, const TO: usize>(F);

/// A jump by a function of the state before the switch and of the input of the interval that follows it.
pub fn jump<I, const FROM: usize, const TO: usize>(
    land: impl Fn(&SVector<f64, FROM>, &I) -> Landing<FROM, TO> + Send + 'static,
) -> Box<dyn Jump<I>> {
    Box::new(StateJump::<_, FROM, TO>(land))
}

impl<I, F, const FROM: usize, const TO: usize> Jump<I> for StateJump<F, FROM, TO>
where
    F: Fn(&SVector<f64, FROM>, &I) -> Landing<FROM, TO> + Send,
{
    fn sizes(&self) -> (usize, usize) {
        (FROM, TO)
    }

    fn land(&self, from: &Gaussian, input: &I, to: &mut Gaussian) {
        let (x, p) = from.read::<FROM>();
        let Landing { state, map, noise } = (self.0)(&x, input);
        to.write(&state, &(map * p * map.transpose() + noise));
    }

    fn map(&self, from: &Gaussian, input: &I) -> DMatrix<f64> {
        let map = (self.0)(&from.read::<FROM>().0, input).map;
        DMatrix::from_column_slice(TO, FROM, map.as_slice())
    }
}
