use super::tableau::{A, C, D, E3, E5};
use contact_kinematics::is_stopped;
use thiserror::Error;

/// Safety factor and step-ratio limits of the step controller (Hairer, Norsett, Wanner, section II.4).
const SAFETY: f64 = 0.9;
const SMALLEST_RATIO: f64 = 1.0 / 3.0;
const LARGEST_RATIO: f64 = 6.0;
/// A step below this many units of rounding of `t` cannot advance time.
const SMALLEST_STEP_ULPS: f64 = 10.0;
/// Relative tolerances below this are rounding noise.
const SMALLEST_RELATIVE: f64 = 2.0 * f64::EPSILON;

/// Local error allowed in a step: `absolute + relative |y|` for every component, root mean square over them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Relative part, dimensionless.
    pub relative: f64,
    /// Absolute part, in the units of the state.
    pub absolute: f64,
}

impl Tolerance {
    /// The same number for both parts, for states that are of order one.
    #[must_use]
    pub fn uniform(value: f64) -> Self {
        Self { relative: value, absolute: value }
    }

    fn scale(&self, size: f64) -> f64 {
        self.absolute + self.relative * size
    }

    /// Euclidean norm of `v` in units of the tolerance at state `y`.
    fn norm<const N: usize>(&self, v: &[f64; N], y: &[f64; N]) -> f64 {
        let sum: f64 = v.iter().zip(y).map(|(v, y)| (v / self.scale(y.abs())).powi(2)).sum();
        sum.sqrt()
    }
}

/// Why an integration cannot go on. `E` is the error of the field itself.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum IntegrationError<E> {
    /// The tolerance cannot be met in double precision, or is not a positive number.
    #[error(
        "tolerance (relative {relative:e}, absolute {absolute:e}) is out of range; relative must be at least {SMALLEST_RELATIVE:e}, absolute positive"
    )]
    Tolerance {
        /// As given.
        relative: f64,
        /// As given.
        absolute: f64,
    },
    /// The field could not be evaluated.
    #[error("at t = {t} s: {source}")]
    Field {
        /// Time in s.
        t: f64,
        /// Why.
        source: E,
    },
    /// The state or its rate became NaN or infinite, and smaller steps did not help.
    #[error("state is no longer finite after t = {t} s")]
    NotFinite {
        /// Last good time in s.
        t: f64,
    },
    /// The caller wanted no more of it.
    #[error("stopped at t = {t} s")]
    Stopped {
        /// Last good time in s.
        t: f64,
    },
    /// The step shrank to nothing: a singularity, or a tolerance below rounding.
    #[error(
        "step size fell to {step:e} s at t = {t} s; the field is singular there or the tolerance too small"
    )]
    StepTooSmall {
        /// Last good time in s.
        t: f64,
        /// The step that was refused, in s.
        step: f64,
    },
}

/// Work done so far.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Evaluations of the field.
    pub evaluations: usize,
    /// Steps accepted.
    pub accepted: usize,
    /// Steps rejected and repeated with a smaller size.
    pub rejected: usize,
}

/// Adaptive explicit Runge-Kutta method of order 8 by Dormand and Prince, with 5th- and 3rd-order error estimates.
///
/// No allocation. Time runs forward. Between two calls of [`Self::step`] the state stands at [`Self::time`].
pub struct Dop853<const N: usize, F> {
    field: F,
    tolerance: Tolerance,
    shares: [f64; N],
    t: f64,
    y: [f64; N],
    /// Stages of the last step; `k[0]` of the next step is `k[12]` of the last.
    k: [[f64; N]; 13],
    rate: [f64; N],
    next_step: f64,
    last: Option<LastStep<N>>,
    statistics: Statistics,
}

#[derive(Clone, Copy)]
struct LastStep<const N: usize> {
    t: f64,
    h: f64,
    y: [f64; N],
}

/// The solution inside of one accepted step, a polynomial of degree 7.
#[derive(Clone, Copy, Debug)]
pub struct DenseOutput<const N: usize> {
    t: f64,
    h: f64,
    y: [f64; N],
    coefficients: [[f64; N]; 7],
}

impl<const N: usize, F, E> Dop853<N, F>
where
    F: FnMut(f64, &[f64; N]) -> Result<[f64; N], E>,
{
    /// Starts at `(t, y)` for `dy/dt = field(t, y)`.
    ///
    /// # Errors
    /// [`IntegrationError::Tolerance`], and [`IntegrationError::Field`] when the field fails at the start.
    pub fn new(mut field: F, t: f64, y: [f64; N], tolerance: Tolerance) -> Result<Self, IntegrationError<E>> {
        let Tolerance { relative, absolute } = tolerance;
        let usable = (SMALLEST_RELATIVE..1.0).contains(&relative) && absolute > 0.0 && absolute.is_finite();
        if !usable {
            return Err(IntegrationError::Tolerance { relative, absolute });
        }
        let rate = field(t, &y).map_err(|source| IntegrationError::Field { t, source })?;
        if !(t.is_finite() && finite(&y) && finite(&rate)) {
            return Err(IntegrationError::NotFinite { t });
        }
        let statistics = Statistics { evaluations: 1, ..Statistics::default() };
        let k = [[0.0; N]; 13];
        let shares = [1.0; N];
        let mut solver =
            Self { field, tolerance, shares, t, y, k, rate, next_step: 0.0, last: None, statistics };
        solver.next_step = solver.starting_step()?;
        Ok(solver)
    }

    /// Advances by one accepted step, never past `t_limit`. `project` may pull the new state back onto an invariant
    /// (a unit quaternion, say) before its rate is computed.
    ///
    /// # Errors
    /// [`IntegrationError`]; the state stays at the last accepted step.
    pub fn step(
        &mut self,
        t_limit: f64,
        project: impl FnOnce(&mut [f64; N]),
    ) -> Result<(), IntegrationError<E>> {
        self.step_onto(t_limit, |_, y| project(y))
    }

    /// As [`Self::step`], onto an invariant that changes with time: `project` is told the time of the new state.
    ///
    /// # Errors
    /// As [`Self::step`].
    pub fn step_onto(
        &mut self,
        t_limit: f64,
        project: impl FnOnce(f64, &mut [f64; N]),
    ) -> Result<(), IntegrationError<E>> {
        let mut limit_ratio = LARGEST_RATIO;
        loop {
            if is_stopped() {
                return Err(IntegrationError::Stopped { t: self.t });
            }
            let remaining = t_limit - self.t;
            // A last step that is a hair too short or too long is stretched to end on the limit exactly.
            let ends = self.next_step * 1.01 >= remaining;
            let h = if ends { remaining } else { self.next_step };
            let smallest = SMALLEST_STEP_ULPS * f64::EPSILON * self.t.abs().max(t_limit.abs());
            if h.is_nan() || h <= smallest && !(ends && h > 0.0) {
                return Err(IntegrationError::StepTooSmall { t: self.t, step: h });
            }
            let (mut end, error) = self.attempt(h)?;
            if !(error.is_finite() && finite(&end)) {
                self.statistics.rejected += 1;
                self.next_step = h * SMALLEST_RATIO;
                limit_ratio = 1.0;
                if self.next_step <= smallest {
                    return Err(IntegrationError::NotFinite { t: self.t });
                }
                continue;
            }
            let ratio = (SAFETY * error.powf(-0.125)).clamp(SMALLEST_RATIO, limit_ratio);
            if error > 1.0 {
                self.statistics.rejected += 1;
                self.next_step = h * ratio.min(SAFETY);
                limit_ratio = 1.0;
                continue;
            }
            let t = if ends { t_limit } else { self.t + h };
            project(t, &mut end);
            let rate = self.evaluate(t, &end)?;
            self.k[12] = rate;
            self.last = Some(LastStep { t: self.t, h, y: self.y });
            self.statistics.accepted += 1;
            (self.t, self.y, self.rate) = (t, end, rate);
            // A step cut short by the limit says nothing against the size planned for the next one.
            let proposal = h * ratio;
            self.next_step = if ends { proposal.max(self.next_step) } else { proposal };
            return Ok(());
        }
    }

    /// Dense output of the last accepted step, at the price of three evaluations; none before the first step.
    ///
    /// # Errors
    /// [`IntegrationError::Field`].
    pub fn dense(&mut self) -> Result<Option<DenseOutput<N>>, IntegrationError<E>> {
        let Some(LastStep { t, h, y }) = self.last else { return Ok(None) };
        let mut k = [[0.0; N]; 16];
        k[..13].copy_from_slice(&self.k);
        for stage in 13..16 {
            let point = combine(&y, h, &k, A[stage]);
            k[stage] = self.evaluate(t + C[stage] * h, &point)?;
        }
        let mut coefficients = [[0.0; N]; 7];
        for i in 0..N {
            let delta = self.y[i] - y[i];
            coefficients[0][i] = delta;
            coefficients[1][i] = h * k[0][i] - delta;
            coefficients[2][i] = 2.0 * delta - h * (k[12][i] + k[0][i]);
        }
        for (row, coefficient) in D.iter().zip(&mut coefficients[3..]) {
            *coefficient = combine(&[0.0; N], h, &k, row);
        }
        Ok(Some(DenseOutput { t, h, y, coefficients }))
    }

    /// Shares of the tolerance that the components are held to in the steps to come; all of it before.
    pub fn set_shares(&mut self, shares: [f64; N]) {
        self.shares = shares;
    }

    /// Present time in s.
    pub fn time(&self) -> f64 {
        self.t
    }

    /// Present state.
    pub fn state(&self) -> &[f64; N] {
        &self.y
    }

    /// Work done so far.
    pub fn statistics(&self) -> Statistics {
        self.statistics
    }

    fn evaluate(&mut self, t: f64, y: &[f64; N]) -> Result<[f64; N], IntegrationError<E>> {
        self.statistics.evaluations += 1;
        (self.field)(t, y).map_err(|source| IntegrationError::Field { t, source })
    }

    /// One trial step of size `h`: its end and its error in units of the tolerance.
    fn attempt(&mut self, h: f64) -> Result<([f64; N], f64), IntegrationError<E>> {
        self.k[0] = self.rate;
        // Written out stage by stage so that the compiler sees each coefficient as a constant.
        macro_rules! stages {
            ($($s:literal)+) => {$(
                let point = combine(&self.y, h, &self.k, A[$s]);
                self.k[$s] = self.evaluate(self.t + C[$s] * h, &point)?;
            )+};
        }
        stages!(1 2 3 4 5 6 7 8 9 10 11);
        let end = combine(&self.y, h, &self.k, A[12]);
        let (error5, error3) = (combine(&[0.0; N], 1.0, &self.k, &E5), combine(&[0.0; N], 1.0, &self.k, &E3));
        let (mut sum5, mut sum3) = (0.0, 0.0);
        for i in 0..N {
            let scale = self.shares[i] * self.tolerance.scale(self.y[i].abs().max(end[i].abs()));
            sum5 += (error5[i] / scale).powi(2);
            sum3 += (error3[i] / scale).powi(2);
        }
        let denominator = sum5 + 0.01 * sum3;
        let size = f64::from(u32::try_from(N).unwrap_or(u32::MAX));
        let error = if denominator > 0.0 { h.abs() * sum5 / (denominator * size).sqrt() } else { 0.0 };
        Ok((end, error))
    }

    /// First step after Hairer, Norsett, Wanner, section II.4: an explicit Euler step measures the second derivative.
    fn starting_step(&mut self) -> Result<f64, IntegrationError<E>> {
        let (y, rate) = (self.y, self.rate);
        let tolerance = self.tolerance;
        let (size, slope) = (tolerance.norm(&y, &y), tolerance.norm(&rate, &y));
        let first = if size < 1e-10 || slope < 1e-10 { 1e-6 } else { 0.01 * size / slope };
        let probe: [f64; N] = std::array::from_fn(|i| y[i] + first * rate[i]);
        let probe_rate = self.evaluate(self.t + first, &probe)?;
        let change: [f64; N] = std::array::from_fn(|i| probe_rate[i] - rate[i]);
        let largest = slope.max(tolerance.norm(&change, &y) / first);
        let second = if largest <= 1e-15 { (first * 1e-3).max(1e-6) } else { (0.01 / largest).powf(0.125) };
        Ok((100.0 * first).min(second))
    }
}

impl<const N: usize> DenseOutput<N> {
    /// State at time `t` of the step; outside of the step it extrapolates.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; N] {
        let s = (t - self.t) / self.h;
        std::array::from_fn(|i| {
            let mut value = 0.0;
            for (level, coefficient) in self.coefficients.iter().enumerate().rev() {
                value = (value + coefficient[i]) * if level % 2 == 0 { s } else { 1.0 - s };
            }
            self.y[i] + value
        })
    }

    /// First time of the step.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.t
    }

    /// Last time of the step.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.t + self.h
    }
}

#[inline(always)]
fn combine<const N: usize, const S: usize>(
    y: &[f64; N],
    h: f64,
    k: &[[f64; N]; S],
    row: &[(usize, f64)],
) -> [f64; N] {
    let mut sum = [0.0; N];
    for &(stage, weight) in row {
        for i in 0..N {
            sum[i] += weight * k[stage][i];
        }
    }
    std::array::from_fn(|i| y[i] + h * sum[i])
}

fn finite<const N: usize>(y: &[f64; N]) -> bool {
    y.iter().all(|v| v.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    fn oscillator(_: f64, y: &[f64; 2]) -> Result<[f64; 2], Infallible> {
        Ok([y[1], -y[0]])
    }

    fn solve(tolerance: f64, t_end: f64) -> (f64, f64, Statistics) {
        let mut solver = Dop853::new(oscillator, 0.0, [0.0, 1.0], Tolerance::uniform(tolerance)).unwrap();
        let mut dense_error = 0.0_f64;
        while solver.time() < t_end {
            solver.step(t_end, |_| ()).unwrap();
            let dense = solver.dense().unwrap().unwrap();
            for k in 0..=10 {
                let t = dense.start() + (dense.end() - dense.start()) * f64::from(k) / 10.0;
                dense_error = dense_error.max((dense.at(t)[0] - t.sin()).abs());
            }
        }
        ((solver.state()[0] - t_end.sin()).abs(), dense_error, solver.statistics())
    }

    #[test]
    fn error_follows_the_tolerance_and_the_work_its_eighth_root() {
        let (coarse, _, work_coarse) = solve(1e-6, 20.0);
        let (fine, dense, work_fine) = solve(1e-12, 20.0);
        assert!(coarse < 1e-4 && fine < 1e-10 && dense < 1e-9, "{coarse:e} {fine:e} {dense:e}");
        // Six decades at order 8 cost 10^(6/8) = 5.6 times the steps.
        let ratio = work_fine.evaluations as f64 / work_coarse.evaluations as f64;
        assert!((3.5..8.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn steps_end_on_the_limit_exactly() {
        let mut solver = Dop853::new(oscillator, 0.0, [0.0, 1.0], Tolerance::uniform(1e-9)).unwrap();
        for limit in [0.1, 0.100_001, 2.0, 2.0 + 1e-12] {
            while solver.time() < limit {
                solver.step(limit, |_| ()).unwrap();
            }
            assert_eq!(solver.time(), limit);
        }
    }

    #[test]
    fn a_pole_ends_in_an_error_and_not_in_a_nan() {
        let mut solver = Dop853::new(
            |_, y: &[f64; 1]| Ok::<_, Infallible>([y[0] * y[0]]),
            0.0,
            [1.0],
            Tolerance::uniform(1e-10),
        )
        .unwrap();
        let end = loop {
            if let Err(error) = solver.step(2.0, |_| ()) {
                break error;
            }
        };
        assert!(matches!(end, IntegrationError::StepTooSmall { .. } | IntegrationError::NotFinite { .. }));
        assert!((solver.time() - 1.0).abs() < 1e-6);
    }

    #[test]
    fn bad_tolerances_and_failing_fields_are_errors() {
        for (relative, absolute) in [(0.0, 1e-9), (1e-9, 0.0), (f64::NAN, 1e-9), (1e-17, 1e-9)] {
            let result = Dop853::new(oscillator, 0.0, [0.0, 1.0], Tolerance { relative, absolute });
            assert!(matches!(result.err(), Some(IntegrationError::Tolerance { .. })));
        }
        let result = Dop853::new(|_, _: &[f64; 1]| Err("no"), 0.0, [0.0], Tolerance::uniform(1e-6));
        assert!(matches!(result.err(), Some(IntegrationError::Field { source: "no", .. })));
    }
}
