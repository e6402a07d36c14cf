//! The loosest tolerance whose error estimate is below the wanted accuracy.

use super::{Accuracy, Alternative, Choice, Decision, Evidence, Model, Question};
use glam::{DQuat, DVec3};
use std::time::Instant;

/// Tolerance of the first run as a share of the wanted accuracy: errors were 0.01 to 47 times the tolerance of a step.
const FIRST: f64 = 1.0 / 64.0;
/// The same of the run that it is compared with, and the loosest tolerance of such runs.
const LOOSE: f64 = 100.0 * FIRST;
const LOOSEST: f64 = 1e-2;
/// How many times nearer a run is at least than one of a hundred times its tolerance: order 8 makes it 100, where that one was lucky it was 5 to 10.
const NEARER: f64 = 10.0;
/// Error over the tolerance that is taken for granted where two runs agree by chance.
const GRANTED: f64 = 10.0;
/// Tightest tolerance: rounding of a step is a tenth of that.
const TIGHTEST: f64 = 1e-14;
/// Runs at most.
const ROUNDS: usize = 4;

/// Where a body is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Centre of mass, m.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
}

impl Pose {
    /// How far it is from another one, for a body of the natural size `size` (m): the larger one of the distance in sizes and the angle in rad.
    #[must_use]
    pub fn off(&self, other: &Self, size: f64) -> f64 {
        let turn = self.R_WO * other.R_WO.inverse();
        let angle = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length().atan2(turn.w.abs());
        (self.p_WCm.distance(other.p_WCm) / size).max(angle)
    }
}

/// A run that was chosen.
#[derive(Clone, Debug)]
pub struct Least<T> {
    /// The run.
    pub run: T,
    /// Its tolerance.
    pub tolerance: f64,
    /// Why it was chosen.
    pub choice: Choice,
}

/// Runs `run` at tolerances until its error estimate is below `wanted`, for a body of the natural size `size` (m): a first run at a 64th of it, and
/// one a hundred times looser, which its error is estimated from. Of the largest distance `d` of their poses the tighter run is off by a tenth at most;
/// where that, or ten times its tolerance, is more than is wanted, another run is made that is tighter by as much and compared with it.
///
/// # Errors
/// Those of `run` at the tolerances that count; a loose run that fails is left out.
pub fn least_tolerance<T, E>(
    wanted: Accuracy,
    size: f64,
    mut run: impl FnMut(f64) -> Result<T, E>,
    poses: impl Fn(&T) -> Vec<Pose>,
) -> Result<Least<T>, E> {
    let clock = Instant::now();
    let goal = wanted.get();
    let mut timed = |tolerance: f64| {
        let clock = Instant::now();
        run(tolerance).map(|made| (made, clock.elapsed().as_secs_f64()))
    };
    let loose = (goal * LOOSE).min(LOOSEST);
    let mut tried = Vec::new();
    let mut before = timed(loose).ok().map(|(made, seconds)| (poses(&made), loose, seconds));
    let (mut tolerance, mut rounds) = ((goal * FIRST).max(TIGHTEST), 1);
    loop {
        let (made, seconds) = timed(tolerance)?;
        let own = poses(&made);
        // Of one that failed, or ended elsewhere, nothing is known: as if it were off by a size.
        let apart = before.as_ref().map_or(1.0, |(other, ..)| apart(&own, other, size));
        tried.extend(before.map(|(_, tolerance, seconds)| Tried { tolerance, seconds, error: apart }));
        let error = (apart / NEARER).max(GRANTED * tolerance);
        if error <= goal || tolerance <= TIGHTEST || rounds == ROUNDS {
            tried.push(Tried { tolerance, seconds, error });
            let decisions = vec![decision(&tried)];
            let seconds = clock.elapsed().as_secs_f64();
            let choice = Choice { wanted, reached: error, is_reached: error <= goal, decisions, seconds };
            return Ok(Least { run: made, tolerance, choice });
        }
        before = Some((own, tolerance, seconds));
        (tolerance, rounds) =
            ((tolerance * (0.5 * goal / error).clamp(1e-4, 1e-2)).max(TIGHTEST), rounds + 1);
    }
}

/// A run, and what it is off by at most.
struct Tried {
    tolerance: f64,
    seconds: f64,
    error: f64,
}

/// Largest distance of poses at the same samples; a size where one of them has fewer.
fn apart(a: &[Pose], b: &[Pose], size: f64) -> f64 {
    if a.len() != b.len() {
        return 1.0;
    }
    a.iter()
        .zip(b)
        .map(|(a, b)| a.off(b, size))
        .fold(0.0, |most, off| if off > most || off.is_nan() { off } else { most })
}

/// Of runs, the last of which is chosen.
fn decision(tried: &[Tried]) -> Decision {
    let one = |(i, of): (usize, &Tried)| Alternative {
        model: Model::Tolerance(of.tolerance),
        chosen: i + 1 == tried.len(),
        seconds: Some(of.seconds),
        accuracy: Some(of.error),
        evidence: Evidence::Run,
    };
    let alternatives = tried.iter().enumerate().map(one).collect();
    Decision { question: Question::Tolerance, alternatives }
}
