//! The last digits of a fit: residuals of every sample, derivatives of a few, and steps that follow curved valleys.

use crate::least_squares::{
    Fit, FitStatus, LARGEST_DAMPING, LEAST_DAMPING, LeastSquares, NormalEquations, RAISE, STILL_A_MINIMUM,
    decrement, lowered, nothing_to_gain, solve_shifted, undamped,
};
use nalgebra::{SMatrix, SVector};

/// Contact conditions along a track.
pub(super) trait Conditions<const P: usize>: LeastSquares<P> {
    /// Contact conditions at every sample, m/s; none where the model cannot be evaluated.
    fn conditions(&self, point: &Self::Point) -> Option<Vec<[f64; 3]>>;

    /// Their derivatives by the scaled unknowns.
    fn slopes(&self, point: &Self::Point) -> Option<Vec<[SVector<f64, P>; 3]>>;
}

/// Steps at most, with derivatives at some samples and at all.
const QUICK_STEPS: usize = 12;
const STEPS: usize = 200;
/// Share of the cost that a step must save not to be the last: less is rounding.
const WORTH_A_STEP: f64 = 1e-3;
/// Length of an undamped step, in natural sizes, at which to stop; and at which to stop if it saves nothing to speak of.
const STEP_TOLERANCE: f64 = 1e-11;
const SHORT: f64 = 1e-8;
/// Share of a step at which its curvature is measured (Transtrum and Sethna, 2012, section 4), shortest step for which it
/// is worth it, and its largest part in a step.
const PROBE: f64 = 0.1;
const CURVED: f64 = 1e-4;
const LARGEST_BEND: f64 = 0.75;

/// The fit of all samples: with derivatives at those of `thin` where that settles, as it does in all but the worst conditioned
/// logs, and else with derivatives at all of them.
pub(super) fn polish_all<const P: usize, C: Conditions<P>>(
    fine: &C,
    thin: &C,
    stride: usize,
    start: C::Point,
) -> Option<Fit<C::Point, P>> {
    let quick = polish(fine, thin, stride, start, QUICK_STEPS)?;
    match quick.status {
        FitStatus::Converged => Some(quick),
        _ => polish(fine, fine, 1, quick.point, STEPS),
    }
}

/// Minimises the residuals of all samples of `fine` from a point that is near, with derivatives at the samples of `thin`
/// alone, every `stride`-th: between them they are interpolated, and so is every combination of them, which leaves weak
/// directions their accuracy. Where the residuals vanish this is the least-squares point; elsewhere derivatives that are good
/// to a thousandth move it by a thousandth of its deviation.
///
/// Levenberg-Marquardt steps with geodesic acceleration (Transtrum, Machta and Sethna, 2011): weak directions are curved
/// valleys, along which straight steps are as short as the valley is narrow. None where the model cannot be evaluated.
pub(super) fn polish<const P: usize, C: Conditions<P>>(
    fine: &C,
    thin: &C,
    stride: usize,
    start: C::Point,
    steps: usize,
) -> Option<Fit<C::Point, P>> {
    let sampling = Interpolated { fine, thin, stride };
    let mut point = start;
    let mut here = sampling.linearise(&point)?;
    let mut damping = 0.0;
    for iterations in 1..=steps {
        let end = |point, normal, status, damping| Some(Fit { point, normal, status, iterations, damping });
        if nothing_to_gain(&here.normal) {
            return end(point, here.normal, FitStatus::Converged, damping);
        }
        let length = undamped(&here.normal).map_or(f64::INFINITY, |step| step.norm());
        let Some((moved, next, share)) = sampling.step(&point, &here, &mut damping) else {
            let promised = decrement(&here.normal);
            let minimum = length < SHORT || promised <= STILL_A_MINIMUM * here.normal.cost;
            let status = if minimum { FitStatus::Converged } else { FitStatus::Stalled };
            return end(point, here.normal, status, damping);
        };
        let saved = here.normal.cost - next.cost;
        point = moved;
        damping = if damping > LEAST_DAMPING { lowered(damping, share) } else { 0.0 };
        let minimum = length < SHORT && saved <= WORTH_A_STEP * here.normal.cost;
        if length < STEP_TOLERANCE || minimum {
            return end(point, here.normal, FitStatus::Converged, damping);
        }
        here = sampling.linearise_with(&point, next.residuals)?;
    }
    Some(Fit { point, normal: here.normal, status: FitStatus::OutOfIterations, iterations: steps, damping })
}

/// Residuals of all samples with derivatives at some.
struct Interpolated<'a, C> {
    fine: &'a C,
    thin: &'a C,
    stride: usize,
}

struct Linearisation<const P: usize> {
    normal: NormalEquations<P>,
    slopes: Vec<[SVector<f64, P>; 3]>,
    residuals: Vec<[f64; 3]>,
}

/// Residuals at a trial point.
struct Trial {
    cost: f64,
    residuals: Vec<[f64; 3]>,
}

impl<C> Interpolated<'_, C> {
    fn linearise<const P: usize>(&self, point: &C::Point) -> Option<Linearisation<P>>
    where
        C: Conditions<P>,
    {
        self.linearise_with(point, self.fine.conditions(point)?)
    }

    fn linearise_with<const P: usize>(
        &self,
        point: &C::Point,
        residuals: Vec<[f64; 3]>,
    ) -> Option<Linearisation<P>>
    where
        C: Conditions<P>,
    {
        let slopes = self.thin.slopes(point)?;
        let weights = self.gathered(&vec![[1.0; 3]; residuals.len()], slopes.len());
        let mut information = SMatrix::<f64, P, P>::zeros();
        for (rows, weight) in slopes.iter().zip(&weights) {
            for row in rows {
                information.ger(weight[0].max(0.0), row, row, 1.0);
            }
        }
        let gradient = self.back(&slopes, &residuals);
        let (cost, count) = (cost(&residuals), 3 * residuals.len());
        let normal = NormalEquations { information, gradient, cost, count };
        cost.is_finite().then_some(Linearisation { normal, slopes, residuals })
    }

    /// A step that lowers the cost, and the share of what the linear model promised; none where there is none.
    fn step<const P: usize>(
        &self,
        point: &C::Point,
        here: &Linearisation<P>,
        damping: &mut f64,
    ) -> Option<(C::Point, Trial, f64)>
    where
        C: Conditions<P>,
    {
        let Linearisation { normal, .. } = here;
        let mean = normal.information.trace() / P as f64;
        let mut raise = RAISE;
        while *damping < LARGEST_DAMPING {
            let shift = *damping * mean + normal.information.trace() * f64::EPSILON;
            let moved = solve_shifted(&normal.information, shift, &normal.gradient).and_then(|velocity| {
                let bend = self.bend(point, here, &velocity, shift)?;
                let promised = shift * velocity.norm_squared() - normal.gradient.dot(&velocity);
                Some((self.fine.retract(point, &(velocity + bend)), promised))
            });
            if let Some((moved, promised)) = moved
                && let Some(residuals) = self.fine.conditions(&moved)
            {
                let cost = cost(&residuals);
                if cost < normal.cost {
                    return Some((moved, Trial { cost, residuals }, (normal.cost - cost) / promised));
                }
            }
            *damping = (*damping * raise).max(LEAST_DAMPING);
            raise *= 2.0;
        }
        None
    }

    /// Half the geodesic acceleration of a step; none where the model is not to be trusted so far.
    fn bend<const P: usize>(
        &self,
        point: &C::Point,
        here: &Linearisation<P>,
        velocity: &SVector<f64, P>,
        shift: f64,
    ) -> Option<SVector<f64, P>>
    where
        C: Conditions<P>,
    {
        if velocity.norm() < CURVED {
            return Some(SVector::zeros());
        }
        let mut change = self.fine.conditions(&self.fine.retract(point, &(velocity * PROBE)))?;
        for (change, before) in change.iter_mut().flatten().zip(here.residuals.iter().flatten()) {
            *change = (*change - before) / PROBE;
        }
        let second = (self.back(&here.slopes, &change) - here.normal.information * velocity) * (2.0 / PROBE);
        let bend = solve_shifted(&here.normal.information, shift, &second)? * 0.5;
        (2.0 * bend.norm() <= LARGEST_BEND * velocity.norm()).then_some(bend)
    }

    /// `J' e`.
    fn back<const P: usize>(&self, slopes: &[[SVector<f64, P>; 3]], e: &[[f64; 3]]) -> SVector<f64, P> {
        let sums = self.gathered(e, slopes.len());
        let mut product = SVector::<f64, P>::zeros();
        for (row, sum) in slopes.iter().flatten().zip(sums.iter().flatten()) {
            product.axpy(*sum, row, 1.0);
        }
        product
    }

    /// Values at all samples, summed at the nodes with the weights of linear interpolation. The samples after the last node
    /// continue the line through the last two.
    fn gathered(&self, values: &[[f64; 3]], nodes: usize) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; nodes];
        for (k, value) in values.iter().enumerate() {
            let node = (k / self.stride).min(nodes.saturating_sub(2));
            let share = (k - node * self.stride) as f64 / self.stride as f64;
            for (place, weight) in [(node, 1.0 - share), (node + 1, share)] {
                if let Some(sum) = sums.get_mut(place) {
                    for i in 0..3 {
                        sum[i] += weight * value[i];
                    }
                }
            }
        }
        sums
    }
}

fn cost(residuals: &[[f64; 3]]) -> f64 {
    residuals.iter().flatten().map(|e| e * e).sum()
}
