//! Which form of margin, and which factors: the smallest that are enough for the calibration sets.

use super::body::Body;
use super::sets::{Set, Tosses};
use recon::shape_bounds::exact_hull::{HalfSpace, Intersection};
use recon::shape_bounds::poses::{BodyPose, CALIBRATED_RUNS, CONFIDENCES, PoseBounds, PoseError, PoseRule};

/// Tosses in a cut of a set.
const FEW: usize = 25;

/// A form of margin, without its factors.
pub(crate) struct Form {
    kink: f64,
    gap: f64,
    trusted: f64,
}

/// What a set says about a form.
pub(crate) struct Judged {
    calibrates: bool,
    tracker: u32,
    /// The smallest factor whose bound contains the body.
    enough: f64,
    /// The same for cuts of [`FEW`] tosses that bound anything.
    enough_of_few: Vec<f64>,
    level: f64,
    truth: f64,
    half_spaces: Vec<HalfSpace>,
}

impl Form {
    pub(crate) const ALL: [Self; 5] = [
        Self { kink: 0.25, gap: 0.25, trusted: 0.98 },
        Self { kink: 0.25, gap: 0.25, trusted: 0.9 },
        Self { kink: 0.125, gap: 0.0, trusted: 0.8 },
        Self { kink: 0.25, gap: 0.0, trusted: 0.8 },
        Self { kink: 0.5, gap: 0.0, trusted: 0.8 },
    ];

    pub(crate) fn judge(&self, set: &Set, tosses: &Tosses) -> Result<Judged, PoseError> {
        let (level, half_spaces) = self.bare(&tosses.runs)?;
        let enough =
            |level: f64, half_spaces: &[HalfSpace]| shortfall(&tosses.body, half_spaces).max(0.0) / level;
        let mut enough_of_few = Vec::new();
        for runs in tosses.runs.chunks_exact(FEW) {
            match self.bare(runs) {
                Ok((level, half_spaces)) => enough_of_few.push(enough(level, &half_spaces)),
                Err(PoseError::Open { .. } | PoseError::TooFewTouching { .. }) => {}
                Err(error) => return Err(error),
            }
        }
        Ok(Judged {
            calibrates: set.calibrates,
            tracker: set.tracker,
            enough: enough(level, &half_spaces),
            enough_of_few,
            level,
            truth: tosses.body.volume(),
            half_spaces,
        })
    }

    /// The level, and the half-spaces with their kinks but no margin.
    fn bare(&self, runs: &[Vec<BodyPose>]) -> Result<(f64, Vec<HalfSpace>), PoseError> {
        let Self { kink, gap, trusted } = *self;
        let rule = PoseRule { kink, gap, trusted, factors: [1.0, 1.0], scarcity: 0.0 };
        let made = PoseBounds::by_rule(runs, 0.0, CONFIDENCES[0], &rule)?;
        let bare = made.half_spaces.concat().iter().map(|h| moved(h, -made.margin)).collect();
        Ok((made.consistent_level, bare))
    }
}

pub(crate) fn moved(half_space: &HalfSpace, outwards: f64) -> HalfSpace {
    HalfSpace { margin: half_space.margin + outwards, ..*half_space }
}

/// How far the body reaches beyond its half-spaces, in m; negative if it stays inside.
pub(crate) fn shortfall(body: &Body, half_spaces: &[HalfSpace]) -> f64 {
    let beyond = |h: &HalfSpace| {
        let n = h.normal.get();
        body.support(n) - n.dot(h.point) - h.margin
    };
    half_spaces.iter().map(beyond).fold(f64::NEG_INFINITY, f64::max)
}

/// Volume of the intersection of half-spaces moved outwards; infinite where it has no end.
pub(crate) fn volume(half_spaces: &[HalfSpace], outwards: f64) -> f64 {
    let all: Vec<HalfSpace> = half_spaces.iter().map(|h| moved(h, outwards)).collect();
    match Intersection::of(&all) {
        Ok(Intersection::Bounded(polyhedron)) => polyhedron.volume(),
        Ok(Intersection::Unbounded(_)) => f64::INFINITY,
        Err(_) => f64::NAN,
    }
}

/// The `ceil((n + 1) confidence)`-th smallest of `n`: a further value of the same kind is at most as large with at least
/// that probability (split conformal inference). Infinite where `n` is too small to say.
pub(crate) fn conformal(values: impl Iterator<Item = f64>, confidence: f64) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let rank = ((sorted.len() + 1) as f64 * confidence).ceil() as usize;
    sorted.get(rank - 1).copied().unwrap_or(f64::INFINITY)
}

pub(crate) fn print(judged: &[Vec<Judged>]) {
    println!("## Forms of the margin\n");
    println!(
        "Factors: the smallest margin over level that contains the body in the stated share of the calibration sets, by \
         split conformal inference. Margin and volume of the upper bound over the true one are geometric means over the \
         calibration sets at 95 %; the smallest volume tells the form of the tight rule, the first is that of the default. Scarcity: the power of 100 / tosses by which factors must grow \
         to be enough for the same sets cut into fours. Held out: sets of the other \
         families that the factors hold for, with the first tracker and with the worse one.\n"
    );
    println!(
        "| kink | gap | share | factor 95 % | factor 99 % | scarcity | margin, mm | upper volume / true | held out 95 % | 99 % |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    for (form, sets) in Form::ALL.iter().zip(judged) {
        let calibrating = || sets.iter().filter(|j| j.calibrates);
        let [f95, f99] = CONFIDENCES.map(|c| conformal(calibrating().map(|j| j.enough), c));
        let few =
            CONFIDENCES.map(|c| conformal(calibrating().flat_map(|j| j.enough_of_few.iter().copied()), c));
        let steepest = (few[0] / f95).max(few[1] / f99).ln() / (CALIBRATED_RUNS as f64 / FEW as f64).ln();
        let scarcity = steepest.max(0.0);
        let held = |factor: f64| {
            let of = |tracker_is_first: bool| {
                let all =
                    || sets.iter().filter(move |j| !j.calibrates && (j.tracker == 1) == tracker_is_first);
                format!("{} of {}", all().filter(|j| j.enough <= factor).count(), all().count())
            };
            format!("{}, {}", of(true), of(false))
        };
        println!(
            "| {} | {} | {} | {f95:.2} | {f99:.2} | {scarcity:.2} | {:.2} | {:.3} | {} | {} |",
            form.kink,
            form.gap,
            form.trusted,
            1e3 * geometric(calibrating().map(|j| f95 * j.level)),
            geometric(calibrating().map(|j| volume(&j.half_spaces, f95 * j.level) / j.truth)),
            held(f95),
            held(f99)
        );
    }
    println!();
}

fn geometric(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), v| (sum + v.ln(), count + 1));
    (sum / f64::from(count)).exp()
}
