//! How likely one contact's force ratio and slip are in each mode.
//!
//! The outputs are the same in all modes, or their odds would depend on units: the normal force, the ratio `rho = f_t / f_n` as a
//! vector (2), the slip (2, in shares of the natural speed). `r = |rho|`; along `u = f_t / |f_t|` the slip against the friction
//! is `su = -sh . u`, across it is `sx`. Each density below integrates to one over its outputs.

use super::normal::{log_below, log_density};
use std::f64::consts::{PI, TAU};

/// Deviation of the slip of a contact that sticks, in shares of the natural speed: what creep and rocking leave.
pub(super) const CREEP: f64 = 1e-3;
/// Deviation of the slip of palm and body that do not touch, in shares of the natural speed.
const FREE: f64 = 0.5;

/// A ratio of friction to normal force.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ratio {
    /// Its size.
    pub(super) size: f64,
    /// Deviation of the size: `sqrt(1 + r^2)` times that of a component of the force over the normal force, for both are noisy.
    pub(super) deviation: f64,
}

/// A slip, with its covariance: along (against the friction), across, and both.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slip {
    pub(super) along: f64,
    pub(super) across: f64,
    pub(super) variance_along: f64,
    pub(super) variance_across: f64,
    pub(super) covariance: f64,
}

impl Ratio {
    /// `rho` may have any direction with the same density: 1 over the circle. A ratio of zero has none; its density is that
    /// of a thousandth of a deviation, and falls out of the odds of slide against stick.
    pub(super) fn log_direction(&self) -> f64 {
        -(TAU * self.size.max(1e-3 * self.deviation)).ln()
    }

    /// Log-density of `rho` where the ratio truly is `expected`, give or take `spread` (a variance).
    pub(super) fn log_at(&self, expected: f64, spread: f64) -> f64 {
        log_density(self.size - expected, self.deviation.powi(2) + spread) + self.log_direction()
    }

    /// Log-density of `rho` where the ratio is anywhere in the disc of radius `friction` with the same density. Noise blurs the
    /// disc's edge; the normaliser is exact.
    #[cfg_attr(
        not(test),
        expect(dead_code, reason = "the form without memory is the oracle's: chains replace it")
    )]
    pub(super) fn log_in_disc(&self, friction: f64) -> f64 {
        let variance = self.deviation.powi(2);
        log_below((friction - self.size) / self.deviation) - (PI * (friction.powi(2) + variance)).ln()
    }

    /// Log-density of `rho` where only noise of the deviation `noise` (of an unloaded sensor, over the normal force) is read.
    pub(super) fn log_off(&self, noise: f64) -> f64 {
        let variance = noise.powi(2);
        -(TAU * variance).ln() - 0.5 * self.size.powi(2) / variance
    }
}

impl Slip {
    /// Log-density where the contact slides at `speed`, give or take `spread` (a variance). The friction says which way, with
    /// the noise `turn` (rad) of its direction.
    pub(super) fn log_sliding(&self, speed: f64, spread: f64, turn: f64) -> f64 {
        let sideways = (turn * speed).powi(2);
        self.log_centred(self.along - speed, self.variance_along + spread, self.variance_across + sideways)
    }

    /// Log-density where the contact sticks.
    pub(super) fn log_sticking(&self) -> f64 {
        let creep = CREEP.powi(2);
        self.log_centred(self.along, self.variance_along + creep, self.variance_across + creep)
    }

    /// Log-density where the contact does not move at all.
    pub(super) fn log_still(&self) -> f64 {
        self.log_centred(self.along, self.variance_along, self.variance_across)
    }

    /// Log-density where nothing touches.
    pub(super) fn log_off(&self) -> f64 {
        let free = FREE.powi(2);
        self.log_centred(self.along, self.variance_along + free, self.variance_across + free)
    }

    fn log_centred(&self, along: f64, variance_along: f64, variance_across: f64) -> f64 {
        // First across, then along given across.
        let slope = self.covariance / variance_across;
        let left = variance_along - slope * self.covariance;
        log_density(self.across, variance_across) + log_density(along - slope * self.across, left)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RATIO: Ratio = Ratio { size: 0.29, deviation: 0.0209 };
    const SLIP: Slip =
        Slip { along: 0.008, across: 0.001, variance_along: 1e-5, variance_across: 2e-5, covariance: 0.0 };

    /// The numbers of `densities` in `tests/data/modes.json` of the workspace, which another implementation computed.
    #[test]
    fn the_densities_of_another_implementation() {
        let stick = RATIO.log_in_disc(0.3) + SLIP.log_sticking();
        assert!((stick - 7.201_869_470_44).abs() < 1e-10, "{stick}");
        let slide = RATIO.log_at(0.3, 0.0) + SLIP.log_sliding(0.01, 0.0, RATIO.deviation / RATIO.size);
        assert!((slide - 11.325_887_152_1).abs() < 1e-10, "{slide}");
    }

    /// Over the plane of ratios in polar coordinates, by the midpoint rule.
    fn over_ratios(density: impl Fn(Ratio) -> f64) -> f64 {
        let step = 1e-4;
        let at = |k: u32| step * (f64::from(k) + 0.5);
        (0..20_000).map(|k| density(Ratio { size: at(k), deviation: 0.0209 }) * TAU * at(k) * step).sum()
    }

    #[test]
    fn each_density_of_a_ratio_integrates_to_one() {
        for friction in [0.2, 0.8] {
            assert!((over_ratios(|r| r.log_at(friction, 0.0).exp()) - 1.0).abs() < 1e-9);
            assert!((over_ratios(|r| r.log_at(friction, 1e-4).exp()) - 1.0).abs() < 1e-8);
            assert!((over_ratios(|r| r.log_in_disc(friction).exp()) - 1.0).abs() < 1e-6);
        }
        assert!((over_ratios(|r| r.log_off(0.1).exp()) - 1.0).abs() < 1e-6);
    }

    #[test]
    fn each_density_of_a_slip_integrates_to_one() {
        let noise =
            Slip { along: 0.0, across: 0.0, variance_along: 1e-5, variance_across: 3e-5, covariance: 1e-5 };
        let over = |half: f64, density: &dyn Fn(Slip) -> f64| {
            let step = half / 300.0;
            let points = || (-300..=300).map(|k| step * f64::from(k));
            let line = |along| points().map(move |across| Slip { along, across, ..noise });
            points().flat_map(line).map(|slip| density(slip).exp() * step * step).sum::<f64>()
        };
        assert!((over(0.1, &|s| s.log_sticking()) - 1.0).abs() < 1e-9);
        assert!((over(0.1, &|s| s.log_sliding(0.03, 1e-5, 0.1)) - 1.0).abs() < 1e-9);
        assert!((over(4.0, &|s| s.log_off()) - 1.0).abs() < 1e-9);
    }
}
