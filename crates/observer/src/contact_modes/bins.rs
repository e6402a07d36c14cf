//! Bins of a line on which something walks, and what a step of the walk does to the probabilities in them.

use super::normal::integral_below;

/// Shares below which a step is not followed.
const LEAST: f64 = 1e-17;
/// Deviations of a step beyond which nothing lands.
const FAR: f64 = 9.0;

/// Bins that lie one beside the other, from zero on.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    pub(super) lower: Vec<f64>,
    pub(super) upper: Vec<f64>,
}

impl Bins {
    /// So many, with the edges `edge(k / count)`, which grow from zero.
    pub(super) fn new(count: usize, edge: impl Fn(f64) -> f64) -> Self {
        Self::between(&(0..=count).map(|k| edge(k as f64 / count as f64)).collect::<Vec<_>>())
    }

    /// With these edges, which grow from zero.
    pub(super) fn between(edges: &[f64]) -> Self {
        Self { lower: edges[..edges.len() - 1].to_vec(), upper: edges[1..].to_vec() }
    }

    pub(super) fn count(&self) -> usize {
        self.lower.len()
    }

    /// The last edge.
    fn end(&self) -> f64 {
        self.upper[self.count() - 1]
    }

    pub(super) fn middle(&self, bin: usize) -> f64 {
        0.5 * (self.lower[bin] + self.upper[bin])
    }

    /// Variance of a number that is anywhere in the bin.
    pub(super) fn variance(&self, bin: usize) -> f64 {
        (self.upper[bin] - self.lower[bin]).powi(2) / 12.0
    }

    /// Shares of a distribution, from how much of it lies below an edge.
    pub(super) fn shares(&self, below: impl Fn(f64) -> f64) -> Vec<f64> {
        let mut shares = vec![0.0; self.count()];
        self.put_shares(below, &mut shares);
        shares
    }

    /// The same into what is there.
    pub(super) fn put_shares(&self, below: impl Fn(f64) -> f64, shares: &mut [f64]) {
        let all = below(self.end()) - below(self.lower[0]);
        for (k, share) in shares.iter_mut().enumerate() {
            *share = (below(self.upper[k]) - below(self.lower[k])) / all;
        }
    }
}

/// What becomes of steps that leave the bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ends {
    /// Share of what steps under zero that comes back on this side of it, as far below as it went.
    pub(super) reflected: f64,
    /// Whether what steps over the last edge stays in the last bin.
    pub(super) stops: bool,
}

/// One step of a random walk on bins.
#[derive(Clone, Debug)]
pub(super) struct Walk {
    /// Of each bin the bins from the first to beyond the last that it steps to, and where their shares begin.
    rows: Vec<(usize, usize, usize)>,
    shares: Vec<f64>,
    /// Share of a bin that steps below zero and above the last edge.
    pub(super) under: Vec<f64>,
    pub(super) over: Vec<f64>,
    /// To work in.
    row: Vec<f64>,
}

impl Walk {
    /// Of no steps yet, on so many bins.
    pub(super) fn on(count: usize) -> Self {
        let [under, over] = [Vec::with_capacity(count), Vec::with_capacity(count)];
        Self { rows: Vec::with_capacity(count), shares: Vec::new(), under, over, row: vec![0.0; count] }
    }

    /// Makes room for steps of any size.
    pub(super) fn make_room(&mut self) {
        let count = self.row.len();
        self.shares.reserve(count * count - self.shares.len());
    }

    /// Normal steps of the deviation `step` from anywhere in a bin; allocates nothing where there is room.
    pub(super) fn set(&mut self, bins: &Bins, step: f64, ends: Ends) {
        self.rows.clear();
        self.shares.clear();
        self.under.clear();
        self.over.clear();
        for from in 0..bins.count() {
            self.row.fill(0.0);
            let [under, over] = fill(bins, step, from, ends, &mut self.row);
            let first = self.row.iter().position(|share| *share > LEAST).unwrap_or(0);
            let beyond = self.row.iter().rposition(|share| *share > LEAST).map_or(first, |last| last + 1);
            self.rows.push((first, beyond, self.shares.len()));
            self.shares.extend(&self.row[first..beyond]);
            self.under.push(under);
            self.over.push(over);
        }
    }

    /// The bins that a bin steps to, and their shares.
    fn row(&self, from: usize) -> (usize, usize, &[f64]) {
        let (first, beyond, at) = self.rows[from];
        (first, beyond, &self.shares[at..at + beyond - first])
    }

    /// Adds what `probabilities` times `kept` become to `next`; what steps under and over is the caller's.
    pub(super) fn apply(&self, probabilities: &[f64], kept: f64, next: &mut [f64]) {
        for (from, probability) in probabilities.iter().enumerate() {
            let mass = kept * probability;
            let (first, beyond, shares) = self.row(from);
            for (to, share) in next[first..beyond].iter_mut().zip(shares) {
                *to += mass * share;
            }
        }
    }

    /// Puts into `worth` what each bin is worth before a step of which the bins after it are worth `after`, `kept` times: the
    /// transpose of [`Self::apply`].
    pub(super) fn worth(&self, after: &[f64], kept: f64, worth: &mut [f64]) {
        for (from, worth) in worth.iter_mut().enumerate() {
            let (first, beyond, shares) = self.row(from);
            let each = shares.iter().zip(&after[first..beyond]);
            *worth = kept * each.map(|(share, after)| share * after).sum::<f64>();
        }
    }
}

/// Shares of a bin that step to each bin; what steps under zero and over the last edge.
fn fill(bins: &Bins, step: f64, from: usize, ends: Ends, row: &mut [f64]) -> [f64; 2] {
    let (a, b) = (bins.lower[from], bins.upper[from]);
    // Probability to land below an edge, averaged over the bin.
    let mean = |x: f64, y: f64| (integral_below(x / step) - integral_below(y / step)) * step / (b - a);
    let below = |edge: f64| mean(edge - a, edge - b).clamp(0.0, 1.0);
    let under = below(bins.lower[0]);
    let mut over = 1.0 - below(bins.end());
    let far = FAR * step;
    let mut to_lower = under;
    let near = bins.upper.partition_point(|upper| *upper < a - far)
        ..bins.lower.partition_point(|lower| *lower <= b + far);
    for to in near {
        let to_upper = below(bins.upper[to]);
        row[to] = (to_upper - to_lower).max(0.0);
        to_lower = to_upper;
    }
    // Steps to the mirrored bin: those beyond its mirrored edges.
    let (mut back, mut left) = (0.0, under);
    for to in 0..row.len() {
        if left <= LEAST {
            break;
        }
        let beyond = mean(-bins.upper[to] - a, -bins.upper[to] - b).max(0.0);
        let mirrored = ends.reflected * (left - beyond).max(0.0);
        left = beyond;
        back += mirrored;
        row[to] += mirrored;
    }
    // Some step so far that they come out at the other end.
    over += (ends.reflected * under - back).max(0.0);
    if ends.stops {
        row[row.len() - 1] += over;
        over = 0.0;
    }
    [under * (1.0 - ends.reflected), over]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stepped(bins: &Bins, step: f64, ends: Ends) -> Walk {
        let mut walk = Walk::on(bins.count());
        walk.set(bins, step, ends);
        walk
    }

    #[test]
    fn nothing_is_lost_and_a_step_has_its_variance() {
        let bins = Bins::new(40, |x| x);
        let open = Ends { reflected: 0.0, stops: false };
        for step in [0.003, 0.02, 0.3, 30.0] {
            for ends in [open, Ends { reflected: 0.5, stops: true }, Ends { reflected: 1.0, stops: false }] {
                let walk = stepped(&bins, step, ends);
                let sum = |i: usize| walk.row(i).2.iter().sum::<f64>() + walk.under[i] + walk.over[i];
                assert!((0..40).all(|i| (sum(i) - 1.0).abs() < 1e-12), "{step} {ends:?}");
                assert!(!ends.stops || walk.over.iter().all(|over| *over == 0.0));
            }
        }
        let walk = stepped(&bins, 0.1, open);
        let mut next = [0.0; 40];
        let mut start = [0.0; 40];
        start[20] = 1.0;
        walk.apply(&start, 1.0, &mut next);
        let moved: f64 = (0..40).map(|k| next[k] * (bins.middle(k) - bins.middle(20)).powi(2)).sum();
        // Both ends of the step are blurred by half a bin.
        assert!((moved - 0.01 - 2.0 * bins.variance(20)).abs() < 1e-5, "{moved}");
    }
}
