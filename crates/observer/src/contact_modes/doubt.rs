//! What is left of forces and slips where the modes are told, against the noise that was stated of them.
//!
//! Odds of modes are as good as the noise, the friction and the clock that they rest on: with a friction of 3 % too much, a bias of half a
//! deviation or noise of twice its level more than one sample in a hundred was told with 0.99 and wrong. Where a mode is told, what it
//! predicts is left with the stated noise: of no mean, of that size, new at each sample.

use super::classifier::ContactOdds;
use super::density::{CREEP, Ratio, Slip};
use super::late::{Brought, Late};
use super::reading::ContactReading;
use super::steps::Steps;
use std::fmt;

/// Probability above which a mode is told.
const TOLD: f64 = 0.9;
/// Probability that sliding must still have at a sample after one at which it was told.
const LIKELY: f64 = 0.5;
/// Deviations from what noise as stated leaves on average that count: of 1e4 contacts without fault one is doubted.
const SURE: f64 = 4.5;
/// Samples over which a contact that sticks and creeps is looked for, and the deviations of their mean that count: some thousand of samples have as
/// many means.
const RECENT: f64 = 100.0;
const CREPT: f64 = 5.5;
/// Mean in deviations, share of the variance beyond what was stated, and correlation from sample to sample that do no harm.
const MEAN: f64 = 0.2;
const SPREAD: f64 = 0.25;
const LASTS: f64 = 0.3;

/// What contradicts that forces and slips of a contact are as stated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactModesDoubt {
    /// Number from 0.
    pub contact: usize,
    /// What it is about.
    pub about: DoubtedReading,
    /// By how much: a mean in deviations, a root mean square in deviations, a correlation, or a time, s.
    pub by: f64,
    /// How sure, in deviations of what noise as stated would leave.
    pub score: f64,
}

/// What of a reading is not as stated.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum DoubtedReading {
    /// Where the contact slides its forces have another ratio than the stated friction, on average.
    Friction,
    /// Where it slides the ratio of its forces scatters by more than their noise.
    Forces,
    /// Where it slides errors of the ratio of its forces follow each other.
    LastingForces,
    /// Where it sticks its slip is more than its noise.
    Slips,
    /// Where it sticks it slips against its friction for a while.
    Creeps,
    /// Where it sticks errors of its slip follow each other.
    LastingSlips,
    /// Its forces and slips are likelier where forces are late by some time.
    LateForces,
}

impl DoubtedReading {
    /// In a word or two, for tables.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Friction => "friction",
            Self::Forces => "noise of forces",
            Self::LastingForces => "lasting errors of forces",
            Self::Slips => "noise of slips",
            Self::Creeps => "slips of a contact that sticks",
            Self::LastingSlips => "lasting errors of slips",
            Self::LateForces => "late forces",
        }
    }
}

impl fmt::Display for ContactModesDoubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (contact, by) = (self.contact + 1, self.by);
        match self.about {
            DoubtedReading::Friction => write!(
                f,
                "where contact {contact} slides the ratio of its forces is {by:.2} deviations off the friction on average: its coefficient is \
                 another one, or its forces have a bias or a wrong gain"
            ),
            DoubtedReading::Forces => write!(
                f,
                "where contact {contact} slides the ratio of its forces scatters {by:.2} times as much as was stated: forces are noisier, or late"
            ),
            DoubtedReading::LastingForces => write!(
                f,
                "where contact {contact} slides errors of its forces follow each other (correlation {by:.2} from sample to sample), and were \
                 taken for independent"
            ),
            DoubtedReading::Slips => write!(
                f,
                "where contact {contact} sticks its slip is {by:.2} times its deviation: slips are noisier than stated, forces are late, or the \
                 friction is lower"
            ),
            DoubtedReading::Creeps => write!(
                f,
                "where contact {contact} sticks it slips against its friction for a while, by {by:.2} deviations: its coefficient is lower than \
                 stated, or its forces have a bias or a wrong gain"
            ),
            DoubtedReading::LastingSlips => write!(
                f,
                "where contact {contact} sticks errors of its slip follow each other (correlation {by:.2} from sample to sample): state for \
                 how long they last"
            ),
            DoubtedReading::LateForces => write!(
                f,
                "forces of contact {contact} go better with its slips of about {:.0} ms before: they are late",
                1e3 * by
            ),
        }
    }
}

/// Sums of one kind of residual, in deviations.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    sum: f64,
    squares: f64,
    pairs: f64,
    lagged: f64,
    last: Option<f64>,
}

impl Sums {
    /// A residual, or that there is none at this sample.
    fn take(&mut self, residual: Option<f64>) {
        if let Some(residual) = residual {
            self.count += 1.0;
            self.sum += residual;
            self.squares += residual * residual;
            if let Some(last) = self.last {
                self.pairs += 1.0;
                self.lagged += last * residual;
            }
        }
        self.last = residual;
    }

    fn with(self, other: Self) -> Self {
        Self {
            count: self.count + other.count,
            sum: self.sum + other.sum,
            squares: self.squares + other.squares,
            pairs: self.pairs + other.pairs,
            lagged: self.lagged + other.lagged,
            last: None,
        }
    }

    /// Mean, and how sure it is not zero.
    fn mean(&self) -> [f64; 2] {
        [self.sum / self.count.max(1.0), self.sum / self.count.max(1.0).sqrt()]
    }

    /// Root mean square, and how sure it is above one.
    fn spread(&self) -> [f64; 2] {
        let count = self.count.max(1.0);
        [(self.squares / count).sqrt(), (self.squares - self.count) / (2.0 * count).sqrt()]
    }

    /// Correlation from one to the next, and how sure it is not zero; of errors that are smaller than stated as a share of those stated.
    fn lasting(&self) -> [f64; 2] {
        let variance = (self.squares / self.count.max(1.0)).max(1.0);
        let correlation = self.lagged / self.pairs.max(1.0) / variance;
        [correlation, correlation * self.pairs.sqrt()]
    }
}

/// What a sample brought, and what was told of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Told<'a> {
    pub(super) odds: ContactOdds,
    /// Where it is known.
    pub(super) friction: Option<f64>,
    /// Against and across the friction, in natural units.
    pub(super) slip: Option<Slip>,
    pub(super) brought: Brought<'a>,
}

/// Residuals of one contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Left {
    sliding: Sums,
    sticking: [Sums; 2],
    /// Probability to slide at the sample before.
    before: f64,
    /// Mean slip against the friction while it sticks, of the last samples, and its largest with its score.
    creeps: f64,
    crept: [f64; 2],
    /// Where the friction is known.
    late: Option<Late>,
}

impl Left {
    /// Nothing yet.
    pub(super) fn new(late: Option<Late>) -> Self {
        Self { late, ..Self::default() }
    }

    /// Takes what a sample leaves. `steps` are those of the friction where it is known.
    pub(super) fn take(&mut self, told: &Told, steps: Option<&Steps>) {
        let Told { odds, friction, slip, brought } = told;
        // Noise in two directions makes a ratio larger on average (Rice): by a third of a deviation where the friction is 1.5 of it.
        let off_friction = |(ratio, friction): (Ratio, f64)| {
            (ratio.size - friction.hypot(ratio.deviation)) / ratio.deviation
        };
        // A ratio that happens to be low speaks for sticking: were only its own sample asked, those that count would be high on average.
        let slides = self.before > TOLD && odds.slide > LIKELY;
        self.before = odds.slide;
        let ratio = brought.reading.and_then(ContactReading::ratio).filter(|_| slides);
        self.sliding.take(ratio.zip(*friction).map(off_friction));
        let slip = slip.filter(|_| odds.stick > TOLD);
        let in_deviations = |slip: f64, variance: f64| slip / (variance + CREEP * CREEP).sqrt();
        let along = slip.map(|slip| in_deviations(slip.along, slip.variance_along));
        along.iter().for_each(|along| self.creep(*along));
        self.sticking[0].take(along);
        self.sticking[1].take(slip.map(|slip| in_deviations(slip.across, slip.variance_across)));
        if let Some((late, steps)) = self.late.as_mut().zip(steps) {
            late.take(steps, brought);
        }
    }

    /// A slip against the friction while it sticks, in deviations.
    fn creep(&mut self, along: f64) {
        self.creeps += (along - self.creeps) / RECENT;
        // Of independent errors of one deviation.
        let score = self.creeps * (2.0 * RECENT - 1.0).sqrt();
        if score > self.crept[1] {
            self.crept = [self.creeps, score];
        }
    }

    /// What contradicts it most, if anything does. `slips_last`: errors of slips are stated to; then they scatter as ever few do.
    pub(super) fn doubt(&self, contact: usize, slips_last: bool) -> Option<ContactModesDoubt> {
        let sticking = self.sticking[0].with(self.sticking[1]);
        let harm = |[by, score]: [f64; 2], harmless: f64| {
            (by.abs() > harmless && score.abs() > SURE).then_some([by, score])
        };
        let wide = (1.0 + SPREAD).sqrt();
        let found = [
            (DoubtedReading::Friction, harm(self.sliding.mean(), MEAN)),
            (DoubtedReading::Forces, harm(self.sliding.spread(), wide)),
            (DoubtedReading::LastingForces, harm(self.sliding.lasting(), LASTS)),
            (DoubtedReading::Slips, harm(sticking.spread(), wide)),
            (DoubtedReading::Creeps, Some(self.crept).filter(|[_, score]| *score > CREPT)),
            (DoubtedReading::LastingSlips, harm(sticking.lasting(), LASTS)),
        ];
        let of_slips = |about: DoubtedReading| {
            matches!(about, DoubtedReading::Slips | DoubtedReading::Creeps | DoubtedReading::LastingSlips)
        };
        let found = found.into_iter().filter(|(about, _)| !(slips_last && of_slips(*about)));
        // Odds as the deviations of a number that is as far off.
        let late = self.late.as_ref().and_then(Late::sure).map(|[lag, odds]| [lag, (2.0 * odds).sqrt()]);
        let told = found.chain([(DoubtedReading::LateForces, late)]).filter_map(|(about, harm)| {
            harm.map(|[by, score]| ContactModesDoubt { contact, about, by, score })
        });
        told.max_by(|a, b| a.score.abs().total_cmp(&b.score.abs()))
    }
}
