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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::least_squares::LevenbergMarquardt;
    use nalgebra::Vector2;

    /// `y = a sin x` in a valley that is `narrow` wide, with the minimum at `(1, a sin 1)`: three residuals a sample, of which
    /// the samples weigh the valley's walls differently.
    struct Valley {
        samples: usize,
        narrow: f64,
    }

    impl Valley {
        fn wall(&self, k: usize) -> f64 {
            (1.0 + 0.5 * (k as f64 / self.samples as f64).sin()) / self.narrow
        }
    }

    impl LeastSquares<2> for Valley {
        type Point = Vector2<f64>;

        fn linearise(&self, point: &Vector2<f64>) -> Option<NormalEquations<2>> {
            let mut normal = NormalEquations::default();
            for (e, rows) in self.conditions(point)?.iter().zip(self.slopes(point)?) {
                for i in 0..3 {
                    normal.add(&rows[i], e[i]);
                }
            }
            Some(normal)
        }

        fn cost(&self, point: &Vector2<f64>) -> Option<f64> {
            Some(cost(&self.conditions(point)?))
        }

        fn retract(&self, point: &Vector2<f64>, step: &Vector2<f64>) -> Vector2<f64> {
            point + step
        }
    }

    impl Conditions<2> for Valley {
        fn conditions(&self, point: &Vector2<f64>) -> Option<Vec<[f64; 3]>> {
            let off = point.y - 3.0 * point.x.sin();
            Some((0..self.samples).map(|k| [self.wall(k) * off, point.x - 1.0, 0.0]).collect())
        }

        fn slopes(&self, point: &Vector2<f64>) -> Option<Vec<[Vector2<f64>; 3]>> {
            let one = |k: usize| {
                let wall = self.wall(k);
                [Vector2::new(-3.0 * point.x.cos() * wall, wall), Vector2::x(), Vector2::zeros()]
            };
            Some((0..self.samples).map(one).collect())
        }
    }

    /// Bent steps need a fraction of the straight ones, whose length the width of the valley sets.
    #[test]
    fn a_curved_valley_is_followed_to_its_end() {
        let valley = Valley { samples: 40, narrow: 1e-3 };
        let start = Vector2::new(-1.5, 3.0 * f64::sin(-1.5));
        let bent = polish(&valley, &valley, 1, start, 200).unwrap();
        assert_eq!(bent.status, FitStatus::Converged);
        assert!((bent.point - Vector2::new(1.0, 3.0 * 1f64.sin())).norm() < 1e-9, "{}", bent.point);
        let straight =
            LevenbergMarquardt { iterations: 10_000, damping: 1e-9, ..LevenbergMarquardt::default() };
        let straight = straight.fit(&valley, start);
        assert!(3 * bent.iterations < straight.iterations, "{} {}", bent.iterations, straight.iterations);
    }

    /// Derivatives at every 13th sample lead to the same point, in a log whose samples they do not divide.
    #[test]
    fn few_derivatives_lead_to_the_same_point() {
        let (fine, thin) = (Valley { samples: 400, narrow: 0.1 }, Valley { samples: 31, narrow: 0.1 });
        let found = polish(&fine, &thin, 13, Vector2::new(0.8, 2.0), 20).unwrap();
        assert_eq!(found.status, FitStatus::Converged);
        assert!((found.point - Vector2::new(1.0, 3.0 * 1f64.sin())).norm() < 1e-10, "{}", found.point);
    }
}
