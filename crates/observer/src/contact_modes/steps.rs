//! How modes, speeds of sliding and ratios of sticking change from one sample to the next.

use super::bins::{Bins, Walk};
use super::normal::below;

/// Bins of the speed of sliding, in shares of the natural speed, and of the ratio of sticking over the friction.
pub(super) const SPEEDS: usize = 36;
pub(super) const RATIOS: usize = 40;

/// Time steps within this share of each other are taken as one.
const SAME: f64 = 0.02;
/// The time that the numbers below are of, s.
const UNIT: f64 = 1e-3;
/// Deviation of a millisecond's change of the speed, in shares of the natural speed, and of the ratio over the friction.
const SPEED_STEP: f64 = 0.004;
const RATIO_STEP: f64 = 0.004 / 0.3;
/// Probability a millisecond that the ratio jumps anywhere in the disc, that sticking ends although the ratio is within the
/// cone (blows, errors of the friction), and that a contact comes or goes.
const RATIO_JUMP: f64 = 0.01;
const BREAK: f64 = 0.002;
const TOUCH: f64 = 0.002;
/// Share of the walks that come to rest which stick; the others slide on, back.
const CAPTURED: f64 = 0.5;
/// Share of sticking that begins near its cone, within some steps of the ratio.
const NEAR: f64 = 0.8;
const NEAR_STEPS: f64 = 3.0;
/// Deviation of the slip at touch-down, in shares of the natural speed.
const LANDING: f64 = 0.15;
/// Least probability of a switch: nothing is ever impossible for good.
const LEAST: f64 = 1e-12;

/// What happens in one time step, the same for every friction.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    pub(super) speeds: Bins<SPEEDS>,
    pub(super) ratios: Bins<RATIOS>,
    /// What steps under zero sticks from now on.
    pub(super) speed: Walk<SPEEDS>,
    /// What steps over one, the friction, slides from now on.
    pub(super) ratio: Walk<RATIOS>,
    /// Probabilities of a jump of the ratio, of the end of sticking, of touch and its loss.
    pub(super) jump: f64,
    pub(super) breaks: f64,
    pub(super) touch: f64,
    /// Speeds at the start of sliding, after sticking and after touch-down; ratios at the start of sticking, after sliding
    /// and anywhere.
    pub(super) starts: [f64; SPEEDS],
    pub(super) landing: [f64; SPEEDS],
    pub(super) stops: [f64; RATIOS],
    pub(super) disc: [f64; RATIOS],
    dt: f64,
}

impl Steps {
    /// For steps of this time, s, which is above zero.
    pub(super) fn new(dt: f64) -> Self {
        let speeds = Bins::new(|x| 1.2 * (0.006 * x + 0.994 * x.powi(3)));
        let ratios = Bins::new(|x| 1.0 - (1.0 - x).powf(1.7));
        let share = (dt / UNIT).sqrt();
        let (speed_step, ratio_step) = (SPEED_STEP * share, RATIO_STEP * share);
        let mut speed = Walk::new(&speeds, speed_step);
        speed.reflect(&speeds, speed_step, 1.0 - CAPTURED);
        speed.stop();
        let mut ratio = Walk::new(&ratios, ratio_step);
        ratio.reflect(&ratios, ratio_step, 1.0);
        let within = |a_unit: f64| (1.0 - (-rate_of(a_unit) * dt / UNIT).exp()).clamp(LEAST, 1.0 - LEAST);
        let disc = ratios.shares(|q| q * q);
        let near = ratios.shares(|q| ((q - 1.0) / (NEAR_STEPS * ratio_step)).exp());
        let stops = std::array::from_fn(|k| NEAR * near[k] + (1.0 - NEAR) * disc[k]);
        Self {
            starts: speeds.shares(|s| below(s / speed_step)),
            landing: speeds.shares(|s| below(s / LANDING)),
            jump: within(RATIO_JUMP),
            breaks: within(BREAK),
            touch: within(TOUCH),
            speeds,
            ratios,
            speed,
            ratio,
            stops,
            disc,
            dt,
        }
    }

    /// Made anew where the time step is another. Clocks jitter, and the walks are no better known than this.
    pub(super) fn follow(&mut self, dt: f64) {
        if (dt - self.dt).abs() > SAME * self.dt {
            *self = Self::new(dt);
        }
    }
}

/// Of events that happen with this probability in a unit of time.
fn rate_of(probability: f64) -> f64 {
    -(-probability).ln_1p()
}
