//! Prescribed motions of a pair of palms.

use contact_kinematics::planar::{PairRates, PalmPair, PalmPairError, PalmPairState};

/// A prescribed motion of both palms.
pub trait PairMotion {
    /// Angles, rates and accelerations at time `t` (s).
    ///
    /// # Errors
    /// [`PalmPairError`] where the motion closes or flattens the wedge.
    fn at(&self, t: f64) -> Result<PalmPairState, PalmPairError>;
}

/// Palms that turn at constant rates: `phi_i(t) = angles_i + rates_i t`, palm 2 against palm 1 (the paper's Fig. 3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ConstantRates {
    /// `phi1`, `phi2` at time zero, rad.
    pub angles: [f64; 2],
    /// Rates of `phi1` and `phi2`, rad/s.
    pub rates: [f64; 2],
}

impl PairMotion for ConstantRates {
    fn at(&self, t: f64) -> Result<PalmPairState, PalmPairError> {
        let pair = PalmPair::new(self.angles[0] + self.rates[0] * t, self.angles[1] + self.rates[1] * t)?;
        let rates = [self.rates[0], self.rates[0] + self.rates[1]];
        Ok(PalmPairState { pair, motion: PairRates { rates, accelerations: [0.0; 2] } })
    }
}

/// Palms that swing: `phi_i(t) = centre_i + amplitude_i sin(frequency_i t + phase_i)`, palm 2 against palm 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HarmonicPalms {
    /// Mean `phi1`, `phi2`, rad.
    pub centres: [f64; 2],
    /// Amplitudes, rad.
    pub amplitudes: [f64; 2],
    /// Angular frequencies, rad/s.
    pub frequencies: [f64; 2],
    /// Phases, rad.
    pub phases: [f64; 2],
}

impl PairMotion for HarmonicPalms {
    fn at(&self, t: f64) -> Result<PalmPairState, PalmPairError> {
        let swing = |i: usize| {
            let (sin, cos) = (self.frequencies[i] * t + self.phases[i]).sin_cos();
            let (a, w) = (self.amplitudes[i], self.frequencies[i]);
            [self.centres[i] + a * sin, a * w * cos, -a * w * w * sin]
        };
        let ([p1, w1, a1], [p2, w2, a2]) = (swing(0), swing(1));
        let motion = PairRates { rates: [w1, w1 + w2], accelerations: [a1, a1 + a2] };
        Ok(PalmPairState { pair: PalmPair::new(p1, p2)?, motion })
    }
}

impl<M: PairMotion + ?Sized> PairMotion for &M {
    fn at(&self, t: f64) -> Result<PalmPairState, PalmPairError> {
        (**self).at(t)
    }
}
