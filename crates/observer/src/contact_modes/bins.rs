//! Bins of a line on which something walks, and what a step of the walk does to the probabilities in them.

use super::normal::integral_below;

/// Shares below which a step is not followed.
const LEAST: f64 = 1e-17;

/// Bins that lie one beside the other, from zero on.
#[derive(Clone, Debug)]
pub(super) struct Bins<const N: usize> {
    pub(super) lower: [f64; N],
    pub(super) upper: [f64; N],
}

impl<const N: usize> Bins<N> {
    /// With the edges `edge(k / N)`, which grow from zero.
    pub(super) fn new(edge: impl Fn(f64) -> f64) -> Self {
        let at = |k: usize| edge(k as f64 / N as f64);
        Self { lower: std::array::from_fn(at), upper: std::array::from_fn(|k| at(k + 1)) }
    }

    pub(super) fn middle(&self, bin: usize) -> f64 {
        0.5 * (self.lower[bin] + self.upper[bin])
    }

    /// Variance of a number that is anywhere in the bin.
    pub(super) fn variance(&self, bin: usize) -> f64 {
        (self.upper[bin] - self.lower[bin]).powi(2) / 12.0
    }

    /// Shares of a distribution, from how much of it lies below an edge.
    pub(super) fn shares(&self, below: impl Fn(f64) -> f64) -> [f64; N] {
        let all = below(self.upper[N - 1]) - below(self.lower[0]);
        std::array::from_fn(|k| (below(self.upper[k]) - below(self.lower[k])) / all)
    }
}

/// One step of a random walk on bins.
#[derive(Clone, Debug)]
pub(super) struct Walk<const N: usize> {
    /// From (first) to (second) bin.
    shares: [[f64; N]; N],
    /// Where a row has shares at all: first and beyond the last.
    reach: [(usize, usize); N],
    /// Share of a bin that steps below zero and above the last edge.
    pub(super) under: [f64; N],
    pub(super) over: [f64; N],
}

impl<const N: usize> Walk<N> {
    /// Normal steps of the deviation `step` from anywhere in a bin.
    pub(super) fn new(bins: &Bins<N>, step: f64) -> Self {
        let mut walk = Self { shares: [[0.0; N]; N], reach: [(0, 0); N], under: [0.0; N], over: [0.0; N] };
        for from in 0..N {
            walk.fill(bins, step, from);
        }
        walk
    }

    fn fill(&mut self, bins: &Bins<N>, step: f64, from: usize) {
        let (a, b) = (bins.lower[from], bins.upper[from]);
        // Probability to land below an edge, averaged over the bin.
        let below = |edge: f64| {
            let mean =
                (integral_below((edge - a) / step) - integral_below((edge - b) / step)) * step / (b - a);
            mean.clamp(0.0, 1.0)
        };
        self.under[from] = below(bins.lower[0]);
        self.over[from] = 1.0 - below(bins.upper[N - 1]);
        let (mut first, mut beyond) = (N, 0);
        let mut to_lower = self.under[from];
        for to in 0..N {
            let to_upper = below(bins.upper[to]);
            let share = (to_upper - to_lower).max(0.0);
            to_lower = to_upper;
            self.shares[from][to] = share;
            if share > LEAST {
                first = first.min(to);
                beyond = to + 1;
            }
        }
        self.reach[from] = (first.min(beyond), beyond);
    }

    /// Adds what `probabilities` times `kept` become to `next`; what steps under and over is the caller's.
    pub(super) fn apply(&self, probabilities: &[f64; N], kept: f64, next: &mut [f64; N]) {
        for from in 0..N {
            let mass = kept * probabilities[from];
            let (first, beyond) = self.reach[from];
            for (to, share) in next[first..beyond].iter_mut().zip(&self.shares[from][first..beyond]) {
                *to += mass * share;
            }
        }
    }

    /// What steps under zero comes back on this side of it, as far below as it went.
    pub(super) fn reflect(&mut self, bins: &Bins<N>, step: f64, share: f64) {
        for from in 0..N {
            let (a, b) = (bins.lower[from], bins.upper[from]);
            // Steps to the mirrored bin: those beyond its mirrored edges.
            let below = |edge: f64| {
                ((integral_below((-edge - a) / step) - integral_below((-edge - b) / step)) * step / (b - a))
                    .max(0.0)
            };
            let (mut back, mut left) = (0.0, self.under[from]);
            for to in 0..N {
                if left <= LEAST {
                    break;
                }
                let beyond = below(bins.upper[to]);
                let mirrored = share * (left - beyond).max(0.0);
                left = beyond;
                if mirrored > LEAST {
                    back += mirrored;
                    self.shares[from][to] += mirrored;
                    let (first, beyond) = self.reach[from];
                    self.reach[from] = (first.min(to), beyond.max(to + 1));
                }
            }
            // Some step so far that they come out at the other end.
            self.over[from] += (share * self.under[from] - back).max(0.0);
            self.under[from] *= 1.0 - share;
        }
    }

    /// What steps over the last edge stays in the last bin.
    pub(super) fn stop(&mut self) {
        for from in 0..N {
            if self.over[from] > LEAST {
                self.shares[from][N - 1] += self.over[from];
                self.reach[from] = (self.reach[from].0.min(N - 1), N);
            }
            self.over[from] = 0.0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_lost_and_a_step_has_its_variance() {
        let bins = Bins::<40>::new(|x| x);
        for step in [0.003, 0.02, 0.3, 30.0] {
            let mut walk = Walk::new(&bins, step);
            let sums = |walk: &Walk<40>| -> Vec<f64> {
                (0..40).map(|i| walk.shares[i].iter().sum::<f64>() + walk.under[i] + walk.over[i]).collect()
            };
            assert!(sums(&walk).iter().all(|s| (s - 1.0).abs() < 1e-12), "{step}");
            walk.reflect(&bins, step, 0.5);
            walk.stop();
            assert!(sums(&walk).iter().all(|s| (s - 1.0).abs() < 1e-12), "{step} {:?}", sums(&walk));
            assert!(walk.over.iter().all(|o| *o == 0.0));
        }
        let walk = Walk::new(&bins, 0.1);
        let mut next = [0.0; 40];
        let mut start = [0.0; 40];
        start[20] = 1.0;
        walk.apply(&start, 1.0, &mut next);
        let moved: f64 = (0..40).map(|k| next[k] * (bins.middle(k) - bins.middle(20)).powi(2)).sum();
        // Both ends of the step are blurred by half a bin.
        assert!((moved - 0.01 - 2.0 * bins.variance(20)).abs() < 1e-5, "{moved}");
    }
}
