//! What a bank holds: hypotheses about the mode and the time of its last switch.

use super::gaussian::Gaussian;
use super::log_weights::log_sum;

/// One hypothesis: which mode it is and since when, how probable that is, and the state if it is so.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    pub(super) mode: usize,
    pub(super) since: usize,
    pub(super) log_weight: f64,
    /// Of the sample that is being taken in.
    pub(super) log_density: f64,
    /// Logarithms of the probabilities to go on to each mode.
    pub(super) log_row: Vec<f64>,
    pub(super) state: Gaussian,
    /// Probability of each mode at the latest samples if this hypothesis is true; a ring with one row a sample.
    pub(super) path: Vec<f64>,
}

impl Hypothesis {
    /// The mode.
    #[must_use]
    pub fn mode(&self) -> usize {
        self.mode
    }

    /// The sample of the last switch, counted from zero; zero also where there was none. Of hypotheses that were merged that of
    /// the heaviest; without meaning where they are merged before the update.
    #[must_use]
    pub fn since(&self) -> usize {
        self.since
    }

    /// Probability given all samples so far.
    #[must_use]
    pub fn probability(&self) -> f64 {
        self.log_weight.exp()
    }

    /// The state given this hypothesis and all samples so far.
    #[must_use]
    pub fn state(&self) -> &Gaussian {
        &self.state
    }
}

/// Room for hypotheses of each mode, made once.
#[derive(Clone)]
pub(super) struct Store {
    rooms: Vec<Vec<Hypothesis>>,
    /// How many of each mode's are in use: the first ones.
    used: Vec<usize>,
}

impl Store {
    /// Room for `room` hypotheses of each mode, whose `states` are given, with a path of so many samples.
    pub(super) fn new(states: &[usize], room: usize, path: usize) -> Self {
        let rooms = states.iter().enumerate().map(|(mode, &size)| {
            let empty = Hypothesis {
                mode,
                since: 0,
                log_weight: f64::NEG_INFINITY,
                log_density: 0.0,
                log_row: vec![0.0; states.len()],
                state: Gaussian::zeros(size),
                path: vec![0.0; path * states.len()],
            };
            vec![empty; room]
        });
        Self { rooms: rooms.collect(), used: vec![0; states.len()] }
    }

    pub(super) fn clear(&mut self) {
        self.used.fill(0);
    }

    /// The next unused hypothesis of a mode, with what was left in it.
    pub(super) fn add(&mut self, mode: usize) -> &mut Hypothesis {
        self.used[mode] += 1;
        &mut self.rooms[mode][self.used[mode] - 1]
    }

    pub(super) fn remove(&mut self, mode: usize, index: usize) {
        self.used[mode] -= 1;
        let last = self.used[mode];
        self.rooms[mode].swap(index, last);
    }

    pub(super) fn of(&self, mode: usize) -> &[Hypothesis] {
        &self.rooms[mode][..self.used[mode]]
    }

    pub(super) fn of_mut(&mut self, mode: usize) -> &mut [Hypothesis] {
        &mut self.rooms[mode][..self.used[mode]]
    }

    pub(super) fn all(&self) -> impl Iterator<Item = &Hypothesis> + Clone {
        self.rooms.iter().zip(&self.used).flat_map(|(room, &used)| &room[..used])
    }

    pub(super) fn all_mut(&mut self) -> impl Iterator<Item = &mut Hypothesis> {
        self.rooms.iter_mut().zip(&self.used).flat_map(|(room, &used)| &mut room[..used])
    }

    pub(super) fn count(&self) -> usize {
        self.used.iter().sum()
    }

    /// Divides all weights by their sum, and returns its logarithm; minus infinity, with the weights as they were, if there is
    /// none.
    pub(super) fn normalise(&mut self) -> f64 {
        let (largest, rest) = log_sum(self.all().map(|h| h.log_weight));
        if largest > f64::NEG_INFINITY {
            self.all_mut().for_each(|h| h.log_weight = h.log_weight - largest - rest);
        }
        largest + rest
    }

    /// Removes the lightest hypothesis, and the next, as long as `goes` says so of its probability and of that of all that are
    /// then gone; the last one stays. Returns what went; the others are normalised.
    pub(super) fn give_up(&mut self, goes: impl Fn(f64, f64) -> bool) -> f64 {
        let mut gone = 0.0;
        while let Some((mode, index)) = self.lightest(1) {
            let mass = self.of(mode)[index].probability();
            if self.count() == 1 || !goes(mass, gone + mass) {
                break;
            }
            gone += mass;
            self.remove(mode, index);
        }
        if gone > 0.0 {
            self.normalise();
        }
        gone
    }

    /// The lightest hypothesis, as mode and index, among modes that have at least so many.
    pub(super) fn lightest(&self, at_least: usize) -> Option<(usize, usize)> {
        let modes = (0..self.used.len()).filter(|m| self.used[*m] >= at_least);
        let each = modes.flat_map(|m| (0..self.used[m]).map(move |i| (m, i)));
        let weight = |(m, i): (usize, usize)| self.rooms[m][i].log_weight;
        each.min_by(|&a, &b| weight(a).total_cmp(&weight(b)))
    }

    /// The other hypothesis of a mode whose switch time is nearest to that of one; of two as near the heavier.
    pub(super) fn nearest(&self, mode: usize, index: usize) -> Option<usize> {
        let room = self.of(mode);
        let distance = |i: usize| room[i].since.abs_diff(room[index].since);
        (0..room.len()).filter(|i| *i != index).min_by(|&a, &b| {
            distance(a).cmp(&distance(b)).then(room[b].log_weight.total_cmp(&room[a].log_weight))
        })
    }
}
