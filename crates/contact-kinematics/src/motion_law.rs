//! A coordinate as a prescribed function of time.

/// A coordinate (an angle in rad, a displacement in m) as a function of time, with two exact derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MotionLaw {
    /// It does not change.
    Constant {
        /// Its value.
        value: f64,
    },
    /// `start + rate t`.
    Steady {
        /// Value at `t = 0`.
        start: f64,
        /// Rate, per s.
        rate: f64,
    },
    /// `mean + amplitude sin(frequency t + phase)`.
    Sinusoid {
        /// Mean value.
        mean: f64,
        /// Amplitude.
        amplitude: f64,
        /// Angular frequency in rad/s.
        frequency: f64,
        /// Phase in rad.
        phase: f64,
    },
    /// From zero to `height` between `start` and `start + duration`, at rest before and after: the polynomial of degree 7
    /// in time whose first three derivatives vanish at both ends.
    Ramp {
        /// Change.
        height: f64,
        /// When it begins, in s.
        start: f64,
        /// How long it lasts, in s; above zero.
        duration: f64,
    },
}

impl MotionLaw {
    /// Value, first and second derivative at time `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 3] {
        match *self {
            Self::Constant { value } => [value, 0.0, 0.0],
            Self::Steady { start, rate } => [rate.mul_add(t, start), rate, 0.0],
            Self::Sinusoid { mean, amplitude, frequency, phase } => {
                let (sin, cos) = frequency.mul_add(t, phase).sin_cos();
                let (a1, a2) = (amplitude * frequency, amplitude * frequency * frequency);
                [amplitude.mul_add(sin, mean), a1 * cos, -a2 * sin]
            }
            Self::Ramp { height, start, duration } => {
                let x = ((t - start) / duration).clamp(0.0, 1.0);
                let y = x * (1.0 - x);
                let value = x.powi(4) * (35.0 + x * (-84.0 + x * (70.0 - 20.0 * x)));
                let rate = 140.0 * y.powi(3) / duration;
                let acceleration = 420.0 * y * y * (1.0 - 2.0 * x) / (duration * duration);
                [height * value, height * rate, height * acceleration]
            }
        }
    }

    /// The first parameter that cannot be used, with its name and value: all are finite, a duration above zero.
    #[must_use]
    pub fn first_bad(&self) -> Option<(&'static str, f64)> {
        let parameters = match *self {
            Self::Constant { value } => vec![("value", value)],
            Self::Steady { start, rate } => vec![("start", start), ("rate", rate)],
            Self::Sinusoid { mean, amplitude, frequency, phase } => {
                vec![("mean", mean), ("amplitude", amplitude), ("frequency", frequency), ("phase", phase)]
            }
            Self::Ramp { height, start, duration } => {
                vec![("height", height), ("start", start), ("duration", duration)]
            }
        };
        let usable = |(what, v): &(&str, f64)| v.is_finite() && (*what != "duration" || *v > 0.0);
        parameters.into_iter().find(|parameter| !usable(parameter))
    }

    /// Whether it never changes.
    #[must_use]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant { .. })
    }

    /// How fast its changes change at `t`, rad/s: over a time that is short against the inverse it is nearly a polynomial of low degree.
    #[must_use]
    pub fn quickness(&self, t: f64) -> f64 {
        match *self {
            Self::Constant { .. } | Self::Steady { .. } => 0.0,
            Self::Sinusoid { frequency, .. } => frequency.abs(),
            // The fourth root of the largest fourth derivative, 840 heights.
            Self::Ramp { start, duration, .. } if (start..start + duration).contains(&t) => 5.4 / duration,
            Self::Ramp { .. } => 0.0,
        }
    }

    /// The same of an angle by which something turns: directions change with the angle, too.
    #[must_use]
    pub fn quickness_of_turn(&self, t: f64) -> f64 {
        self.quickness(t) + self.fastest(t)
    }

    /// The largest rate that it reaches about the time `t`: until the next joint.
    fn fastest(&self, t: f64) -> f64 {
        match *self {
            Self::Constant { .. } => 0.0,
            Self::Steady { rate, .. } => rate.abs(),
            Self::Sinusoid { amplitude, frequency, .. } => (amplitude * frequency).abs(),
            Self::Ramp { height, start, duration } if (start..start + duration).contains(&t) => {
                140.0 / 64.0 * height.abs() / duration
            }
            Self::Ramp { .. } => 0.0,
        }
    }

    /// Times at which a derivative of higher than the second order jumps: an integrator of high order stops there.
    #[must_use]
    pub fn joints(&self) -> Option<[f64; 2]> {
        match *self {
            Self::Ramp { start, duration, .. } => Some([start, start + duration]),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_match_differences() {
        let laws = [
            MotionLaw::Sinusoid { mean: 0.9, amplitude: 0.08, frequency: 1.7, phase: 0.3 },
            MotionLaw::Steady { start: 0.2, rate: -0.4 },
            MotionLaw::Ramp { height: 0.6, start: 0.4, duration: 0.8 },
        ];
        let h = 1e-5;
        for law in laws {
            for t in [0.45, 0.7, 1.19] {
                let ([_, rate, acceleration], before, after) = (law.at(t), law.at(t - h), law.at(t + h));
                assert!(((after[0] - before[0]) / (2.0 * h) - rate).abs() < 1e-8, "{law:?}");
                assert!(((after[1] - before[1]) / (2.0 * h) - acceleration).abs() < 1e-7, "{law:?}");
            }
        }
    }

    #[test]
    fn no_law_is_faster_than_its_fastest_rate() {
        let laws = [
            MotionLaw::Sinusoid { mean: 0.9, amplitude: -0.08, frequency: 1.7, phase: 0.3 },
            MotionLaw::Steady { start: 0.2, rate: -0.4 },
            MotionLaw::Ramp { height: -0.6, start: 0.0, duration: 4.0 },
        ];
        for law in laws {
            let rates = (0..=400).map(|k| law.at(0.01 * f64::from(k))[1].abs());
            let reached = rates.fold(0.0, f64::max) / law.fastest(1.0);
            assert!((0.999..=1.0 + 1e-12).contains(&reached), "{law:?}: {reached}");
        }
    }

    #[test]
    fn a_ramp_rests_before_and_after() {
        let law = MotionLaw::Ramp { height: 0.6, start: 0.4, duration: 0.8 };
        assert_eq!(law.at(0.3), [0.0; 3]);
        assert!((law.at(2.0)[0] - 0.6).abs() < 1e-15 && law.at(2.0)[1..] == [0.0, 0.0]);
        assert!((law.at(0.8)[0] - 0.3).abs() < 1e-15);
    }

    #[test]
    fn bad_parameters_are_named() {
        let bad = MotionLaw::Ramp { height: 1.0, start: 0.0, duration: 0.0 };
        assert_eq!(bad.first_bad(), Some(("duration", 0.0)));
        assert!(MotionLaw::Constant { value: f64::NAN }.first_bad().is_some());
    }
}
