//! How often modes were right, and how far their probabilities are to be believed.

use recon::object_dynamics::ContactMode;
use std::fmt::Write as _;

pub(crate) const HEAD: &str = "| log | runs, relied on | samples | right | at all samples | by the ratio alone | above 0.99 | of all: above 0.99 and wrong (worst run) | Brier | friction: largest error, in its deviations |\n|---|---|---|---|---|---|---|---|---|---|";
/// Probability above which a mode is said with confidence.
const CONFIDENT: f64 = 0.99;
/// Edges of the bins of the probability to slide.
const EDGES: [f64; 9] = [0.0, 0.01, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0 + 1e-12];
const BINS: usize = EDGES.len() - 1;
/// Draws of the bootstrap.
const DRAWS: usize = 2000;

/// Samples, sum of what was said, sum of what is true.
type Bin = [f64; 3];

/// One log with one noise. Shares are over samples away from switches, but where it is said.
pub(crate) struct Run {
    pub(crate) name: String,
    pub(crate) relied_on: bool,
    pub(crate) samples: f64,
    pub(crate) right: f64,
    all: [f64; 2],
    by_ratio: f64,
    pub(crate) confident: f64,
    pub(crate) wrong: f64,
    pub(crate) brier: f64,
    pub(crate) bins: [Bin; BINS],
    /// Largest error of a friction, and the largest in its deviations.
    pub(crate) friction: Option<[f64; 2]>,
}

impl Run {
    pub(crate) fn new(name: &str, relied_on: bool) -> Self {
        Self {
            name: name.to_owned(),
            relied_on,
            samples: 0.0,
            right: 0.0,
            all: [0.0; 2],
            by_ratio: 0.0,
            confident: 0.0,
            wrong: 0.0,
            brier: 0.0,
            bins: [[0.0; 3]; BINS],
            friction: None,
        }
    }

    /// A contact at a sample, and whether a switch is near.
    pub(crate) fn add(&mut self, truth: ContactMode, by_ratio: ContactMode, odds: [f64; 3], near: bool) {
        let most = (0..3).fold(0, |best, m| if odds[m] > odds[best] { m } else { best });
        let right = ContactMode::ALL[most] == truth;
        self.all[0] += 1.0;
        self.all[1] += f64::from(right);
        if near {
            return;
        }
        let is = |mode: ContactMode| f64::from(mode == truth);
        self.samples += 1.0;
        self.right += f64::from(right);
        self.by_ratio += is(by_ratio);
        self.confident += f64::from(odds[most] > CONFIDENT);
        self.wrong += f64::from(odds[most] > CONFIDENT && !right);
        let square = |(mode, p): (ContactMode, f64)| (p - is(mode)).powi(2);
        self.brier += 0.5 * ContactMode::ALL.into_iter().zip(odds).map(square).sum::<f64>();
        let slides = odds[1];
        let bin = EDGES.partition_point(|edge| *edge <= slides).clamp(1, BINS) - 1;
        for (sum, new) in self.bins[bin].iter_mut().zip([1.0, slides, is(ContactMode::Slide)]) {
            *sum += new;
        }
    }

    pub(crate) fn friction(&mut self, found: f64, deviation: f64, truth: f64) {
        let error = (found - truth).abs();
        let [worst, in_deviations] = self.friction.unwrap_or_default();
        self.friction = Some([worst.max(error), in_deviations.max(error / deviation)]);
    }
}

pub(crate) fn row(name: &str, runs: &[&Run]) -> String {
    let sum = |of: fn(&Run) -> f64| runs.iter().map(|run| of(run)).sum::<f64>();
    let samples = sum(|run| run.samples).max(1.0);
    let share = |of: fn(&Run) -> f64| sum(of) / samples;
    let worst = runs.iter().map(|run| run.wrong / run.samples.max(1.0)).fold(0.0, f64::max);
    let largest = |i: usize| runs.iter().filter_map(|run| run.friction).map(|of| of[i]).fold(0.0, f64::max);
    format!(
        "| {name} | {}, {} | {samples} | {:.4} | {:.4} | {:.4} | {:.3} | {:.5} ({worst:.5}) | {:.4} | {:.4}, {:.1} |",
        runs.len(),
        runs.iter().filter(|run| run.relied_on).count(),
        share(|run| run.right),
        sum(|run| run.all[1]) / sum(|run| run.all[0]).max(1.0),
        share(|run| run.by_ratio),
        share(|run| run.confident),
        share(|run| run.wrong),
        share(|run| run.brier),
        largest(0),
        largest(1),
    )
}

/// What was said and what is true in each bin, with the 95 % of a bootstrap of runs, and the mean error weighted by samples.
pub(crate) fn reliability(runs: &[&Run]) -> String {
    let mut out = String::from(
        "| probability to slide | share of samples | said | true | true less said, 95 % |\n|---|---|---|---|---|\n",
    );
    let every: Vec<usize> = (0..runs.len()).collect();
    let whole = pooled(runs, &every);
    let mut chance = Chance(1);
    let draws: Vec<[Bin; BINS]> = (0..DRAWS)
        .map(|_| {
            let drawn: Vec<usize> = every.iter().map(|_| chance.below(runs.len())).collect();
            pooled(runs, &drawn)
        })
        .collect();
    let samples: f64 = whole.iter().map(|bin| bin[0]).sum();
    for (i, bin) in whole.iter().enumerate().filter(|(_, bin)| bin[0] > 0.0) {
        let mut differences: Vec<f64> = draws.iter().filter_map(|draw| difference(&draw[i])).collect();
        differences.sort_by(f64::total_cmp);
        let at = |share: f64| differences[((differences.len() - 1) as f64 * share).round() as usize];
        let [low, high] = [EDGES[i], EDGES[i + 1].min(1.0)];
        let _ = writeln!(
            out,
            "| {low} to {high} | {:.3} | {:.3} | {:.3} | {:+.3} ({:+.3} to {:+.3}) |",
            bin[0] / samples,
            bin[1] / bin[0],
            bin[2] / bin[0],
            difference(bin).unwrap_or_default(),
            at(0.025),
            at(0.975),
        );
    }
    let error: f64 = whole.iter().map(|bin| (bin[2] - bin[1]).abs()).sum::<f64>() / samples.max(1.0);
    let _ = writeln!(out, "\n{samples} samples; mean error weighted by samples {error:.4}.");
    out
}

fn difference(bin: &Bin) -> Option<f64> {
    (bin[0] > 0.0).then(|| (bin[2] - bin[1]) / bin[0])
}

fn pooled(runs: &[&Run], drawn: &[usize]) -> [Bin; BINS] {
    let mut sums = [[0.0; 3]; BINS];
    for bins in drawn.iter().map(|&i| &runs[i].bins) {
        for (sum, bin) in sums.iter_mut().zip(bins) {
            sum.iter_mut().zip(bin).for_each(|(sum, new)| *sum += new);
        }
    }
    sums
}

/// Splitmix64: the same draws everywhere.
struct Chance(u64);

impl Chance {
    fn below(&mut self, count: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % count.max(1) as u64) as usize
    }
}
