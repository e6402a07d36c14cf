//! From a motion that a search has found to the most probable one on all data since, a few nodes a sample.
//!
//! The search minimises plain contact residuals: it tells one motion from another, but neither how well the data fit nor
//! how well they determine it, since noise of the forces ties the residuals of seconds together. Here states and noise are
//! adjusted together, as in the batch estimate: chi-squared says whether the motion explains the data, and the covariance
//! what they leave open.

use super::tracker::{MEMORY_OF_NODES, Tracker, WINDOW, sample};
use crate::core::{Model, Portion, Smoother, Start};
use crate::three_palms::state_space::{MOTION_STATES, NodeInput, ThreePalmModel, set_adjusted_arms};
use glam::DVec3;
use nalgebra::SVector;
use std::collections::VecDeque;

/// Length of a step at which the iteration has settled, in relative contact noise.
const STEP_TOLERANCE: f64 = 0.01;
/// Deviation, in natural units, of the turning rates in the first pass: the start is not better known.
const FIRST_SLIDE: f64 = 0.1;
/// Passes: each takes from the one before what derivatives and weights must not take from noisy data.
const PASSES: usize = 3;
/// Damping of a step: as a prior that knows the natural sizes, it keeps what is not observed from running away.
const DAMPING: f64 = 1.0;
/// Chi-squared over its degrees of freedom below which noise explains the data. Right motions leave 1 within a few
/// percent; the rest is room for noise that was stated too small.
const EXPLAINED: f64 = 1.6;
/// The same while weights and derivatives are those of noisy data.
const EXPLAINED_ROUGHLY: f64 = 4.0;
/// Standard deviations of the worst known state of the motion and of the worst known constant, in natural sizes, with
/// which a motion is taken: beyond them it is too curved a function of the data for a covariance. Constants, as logarithms
/// of moments, curve it more.
const LARGEST_DEVIATIONS: [f64; 2] = [0.1, 0.05];
/// Multiple of them beyond which the data are too few to be adjusted at all.
const VAGUE: f64 = 6.0;
/// Steps in a pass.
const MOST_STEPS: usize = 12;

/// How it stands with a motion that was found.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Settled {
    /// It is being worked on.
    Going,
    /// The data leave so much open that there is nothing to linearise about: the search shall go on with more of them.
    Vague,
    /// It leaves noise alone, but so may others: more data must tell.
    Open,
    /// It leaves more than noise.
    Refused,
    /// It leaves noise alone, and little room for another one; the tracker may begin.
    Taken,
}

/// A motion that settles.
pub(super) struct Settling<const N: usize> {
    smoother: Smoother<ThreePalmModel<N>, N, 3>,
    stage: Stage,
    /// Nodes of the data that were taken.
    taken: usize,
    /// Time of each, s.
    t: Vec<f64>,
    slides: Vec<[f64; 3]>,
    arms: Vec<[DVec3; 3]>,
    /// Seconds over which arms in derivatives are smoothed, to either side.
    reach: f64,
}

enum Stage {
    /// Takes the nodes that there are.
    Taking,
    /// Linearisations in this pass, and passes before it.
    Fitting {
        steps: usize,
        passes: usize,
    },
    Carrying {
        passes: usize,
    },
    Shortening,
}

impl<const N: usize> Settling<N> {
    pub(super) fn new(model: ThreePalmModel<N>, start: &Start<N>, reach: f64, room: usize) -> Self {
        Self {
            smoother: Smoother::new(model, start, DAMPING, room),
            stage: Stage::Taking,
            taken: 0,
            t: Vec::with_capacity(room),
            slides: Vec::with_capacity(room),
            arms: Vec::with_capacity(room),
            reach,
        }
    }

    /// Nodes of the data that it rests on.
    pub(super) fn taken(&self) -> usize {
        self.taken
    }

    /// Goes on for about `portion` nodes of the data.
    pub(super) fn work(&mut self, nodes: &VecDeque<(NodeInput, [bool; 3])>, portion: usize) -> Settled {
        match self.stage {
            Stage::Taking => {
                for (input, touching) in nodes.iter().skip(self.taken).take(portion) {
                    self.take(*input, *touching);
                }
                if self.taken >= nodes.len() {
                    self.stage = Stage::Fitting { steps: 0, passes: 0 };
                }
                Settled::Going
            }
            Stage::Fitting { steps, passes } => {
                let Portion::Stepped(size) = self.smoother.work(portion, |_, _, _, _| {}) else {
                    return Settled::Going;
                };
                if size.is_nan() {
                    return Settled::Refused;
                }
                let tolerance = STEP_TOLERANCE * self.smoother.model().relative_noise();
                if size > tolerance && steps + 1 < MOST_STEPS {
                    self.stage = Stage::Fitting { steps: steps + 1, passes };
                    return Settled::Going;
                }
                if self.misfit() > EXPLAINED_ROUGHLY {
                    return Settled::Refused;
                }
                if size > tolerance {
                    return Settled::Vague;
                }
                self.slides.clear();
                self.arms.clear();
                self.smoother.carry();
                self.stage = Stage::Carrying { passes: passes + 1 };
                Settled::Going
            }
            Stage::Carrying { passes } => self.carry(passes, portion),
            Stage::Shortening => {
                for _ in 0..portion {
                    if self.smoother.len() <= WINDOW {
                        return Settled::Taken;
                    }
                    self.smoother.drop_first(MEMORY_OF_NODES);
                }
                Settled::Going
            }
        }
    }

    /// The observer that follows the motion from here on.
    pub(super) fn into_tracker(self) -> Option<Tracker<N>> {
        Tracker::going_on(self.smoother)
    }

    /// Chi-squared over its degrees of freedom.
    pub(super) fn misfit(&self) -> f64 {
        let (chi_squared, channels) = self.smoother.chi_squared();
        chi_squared / channels.saturating_sub(N).max(1) as f64
    }

    fn take(&mut self, mut input: NodeInput, touching: [bool; 3]) {
        let rate = self.smoother.model().natural_rate();
        let slide = self.slides.last().copied().unwrap_or([(FIRST_SLIDE * rate).powi(2); 3]);
        (input.here.slide_variance, input.from.slide_variance) = (slide, slide);
        self.t.push(self.t.last().map_or(0.0, |t| t + input.duration));
        self.smoother.append(sample(input, &touching));
        self.taken += 1;
    }

    fn carry(&mut self, passes: usize, portion: usize) -> Settled {
        let (slides, arms) = (&mut self.slides, &mut self.arms);
        let carried = self.smoother.work(portion, |model, sample, x, covariance| {
            // What leaves the rates open beyond all bounds would leave the conditions without weight, and explain anything.
            let largest = (FIRST_SLIDE * model.natural_rate()).powi(2);
            slides.push(model.slide_variances(x, covariance, &sample.input.here).map(|v| v.min(largest)));
            arms.push(model.adjusted_arms(x, &sample.input.here));
        });
        if carried != Portion::Carried {
            return Settled::Going;
        }
        let deviation = self.deviation();
        if deviation > VAGUE {
            return Settled::Vague;
        }
        if passes < PASSES {
            self.adjust();
            self.stage = Stage::Fitting { steps: 0, passes };
            return Settled::Going;
        }
        if self.misfit() > EXPLAINED {
            Settled::Refused
        } else if deviation < 1.0 {
            self.stage = Stage::Shortening;
            Settled::Going
        } else {
            self.stage = Stage::Taking;
            Settled::Open
        }
    }

    /// Standard deviation of the worst known state at the last node, over what it may be.
    fn deviation(&self) -> f64 {
        let scales = self.smoother.model().scales();
        let deviations = self.smoother.last_covariance().diagonal().map(|v| v.max(0.0).sqrt());
        let largest = SVector::<f64, N>::from_fn(|i, _| LARGEST_DEVIATIONS[usize::from(i >= MOTION_STATES)]);
        deviations.component_div(&scales).component_div(&largest).amax()
    }

    /// Derivatives and weights get from this pass what they must not get from noisy data.
    fn adjust(&mut self) {
        let mut before = self.slides.first().copied();
        for (sample, &slide) in self.smoother.samples_mut().zip(&self.slides) {
            sample.input.from.slide_variance = before.unwrap_or(slide);
            sample.input.here.slide_variance = slide;
            before = Some(slide);
        }
        self.smoother.amend(|model, from, to, sample| {
            sample.input.correction = model.missing_impulse(from, to, &sample.input);
        });
        let inputs = self.smoother.samples_mut().map(|s| &mut s.input);
        set_adjusted_arms(inputs, &self.t, &self.arms, self.reach);
    }
}
