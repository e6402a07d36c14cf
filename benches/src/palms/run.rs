//! One body on palms of one kind, from the start to the end of the motion.

use super::body::{PalmBody, SIZE};
use super::coverage::Coverage;
use super::gap::{GapOfContacts, contact_at};
use super::hold::{HoldError, Motion, PalmKind, held};
use super::told::{Told, told};
use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::{
    ContactInstant, ContactMode, ContactScene, ContactSimulation, ContactSimulationError, ContactStart,
    PalmDrive, SampleTimes,
};
use recon::shape_bounds::BoundsError;
use thiserror::Error;

/// Samples a second.
const RATE: f64 = 200.0;
/// Tolerance of the simulation.
const TOLERANCE: f64 = 1e-7;
/// A body is lost when its centre is farther than this from where it was at the start, in sizes.
pub const LOST: f64 = 3.0;
/// Times at which a run is looked at, evenly up to the end.
pub const LOOKS: usize = 10;

/// Seconds from the start that the estimator is given.
pub const ESTIMATED: f64 = 1.2;

/// How a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum End {
    /// The body was held to the end.
    Held,
    /// It left, after so many seconds.
    Lost(f64),
    /// The palms had no room for it, or the simulation was refused for another reason.
    Refused(String),
}

/// What a run brought.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmRun {
    /// How it ended.
    pub end: End,
    /// Share of the sphere of normals that was seen, and gap of the bounds, at each look; those after a loss are as at the loss.
    pub looks: [[f64; 2]; LOOKS],
    /// Mean number of palms touched, while held.
    pub touched: f64,
    /// Radians that the body turned through, while held.
    pub turned: f64,
    /// Gap with the balls of hollow palms at the end; none of others.
    pub in_balls: Option<f64>,
    /// What the estimator knows after [`ESTIMATED`] seconds; none unless the body was held so long.
    pub told: Option<Told>,
}

/// Why a run cannot be made.
#[derive(Debug, Error)]
pub enum PalmRunError {
    /// The scene.
    #[error(transparent)]
    Hold(#[from] HoldError),
    /// Exact contacts that contradict each other.
    #[error(transparent)]
    Bounds(#[from] BoundsError),
}

/// Radians of palm motion of a scene up to its end, all palms together.
#[must_use]
pub fn radians<S: recon::contact_kinematics::SupportFunction>(scene: &ContactScene<S>, duration: f64) -> f64 {
    const STEPS: usize = 4000;
    let step = duration / STEPS as f64;
    let rate = |t: f64| {
        let of = |palm: &recon::object_dynamics::ScenePalm| match &palm.drive {
            PalmDrive::Prescribed(motion) => motion.at(t).w_WP.length(),
            _ => 0.0,
        };
        scene.palms().iter().map(of).sum::<f64>()
    };
    (0..STEPS).map(|k| rate((k as f64 + 0.5) * step) * step).sum()
}

/// The run; the estimator is asked where `estimated`.
///
/// # Errors
/// [`PalmRunError`]; a simulation that is refused is a run that ended so.
pub fn palm_run(
    body: &PalmBody,
    kind: PalmKind,
    motion: &Motion,
    seed: u64,
    estimated: bool,
) -> Result<PalmRun, PalmRunError> {
    let (scene, start) = held(body, kind, motion, seed)?;
    let times = SampleTimes { duration: motion.duration(), rate: RATE };
    let run = match scene.simulate(&ContactStart::touching(start), times, TOLERANCE) {
        Ok(run) => run,
        Err(why) => return Ok(refused(&why)),
    };
    let away = |now: &ContactInstant| (now.state.body.p_WCm - start.p_WCm).length() > LOST * SIZE;
    let lost = run.instants.iter().position(away);
    let seen = &run.instants[..lost.unwrap_or(run.instants.len())];
    let (looks, known) = looked(body, kind, seen, run.instants.len())?;
    let hollow = matches!(kind, PalmKind::Concave(_));
    let is_touched = |mode: &&ContactMode| **mode != ContactMode::Off;
    let touches: usize = seen.iter().map(|now| now.modes.iter().filter(is_touched).count()).sum();
    let turn = |pair: &[ContactInstant]| pair[0].state.body.R_WO.angle_between(pair[1].state.body.R_WO);
    Ok(PalmRun {
        end: lost.map_or(End::Held, |k| End::Lost(k as f64 / RATE)),
        looks,
        touched: touches as f64 / seen.len().max(1) as f64,
        turned: seen.windows(2).map(turn).sum(),
        in_balls: if hollow { known.gap_in_balls(SIZE) } else { None },
        told: if estimated {
            first(&run, seen.len()).and_then(|run| told(&scene, &run, body, seed))
        } else {
            None
        },
    })
}

/// The first [`ESTIMATED`] seconds; none if the body was not held so long.
fn first(run: &ContactSimulation, held: usize) -> Option<ContactSimulation> {
    let samples = (ESTIMATED * RATE).round() as usize + 1;
    let instants = run.instants.get(..samples.min(held)).filter(|some| some.len() == samples)?;
    Some(ContactSimulation { instants: instants.to_vec(), events: Vec::new(), statistics: run.statistics })
}

fn refused(why: &ContactSimulationError) -> PalmRun {
    let reason = match why {
        ContactSimulationError::Modes { .. } => "jam",
        ContactSimulationError::PalmsOverlap { .. } => "palms overlap",
        ContactSimulationError::Contact { .. } => "contact not found",
        _ => "other",
    };
    let looks = [[f64::NAN; 2]; LOOKS];
    let end = End::Refused(reason.to_owned());
    PalmRun { end, looks, touched: f64::NAN, turned: f64::NAN, in_balls: None, told: None }
}

/// What was seen at each look of a run of so many samples in all, of which some are seen.
fn looked(
    body: &PalmBody,
    kind: PalmKind,
    seen: &[ContactInstant],
    all: usize,
) -> Result<([[f64; 2]; LOOKS], GapOfContacts), BoundsError> {
    let hollow = match kind.surface() {
        PalmSurface::Cup { radius } => radius,
        _ => f64::INFINITY,
    };
    let (mut coverage, mut known, mut looks) =
        (Coverage::default(), GapOfContacts::default(), [[0.0; 2]; LOOKS]);
    let mut from = 0;
    for (k, look) in looks.iter_mut().enumerate() {
        let to = ((k + 1) * all / LOOKS).min(seen.len());
        for now in &seen[from.min(to)..to] {
            for (contact, mode) in now.contacts.iter().zip(&now.modes) {
                if *mode != ContactMode::Off {
                    coverage.touch(contact.n_O);
                    known.touch(contact_at(&body.shape, contact.n_O), hollow)?;
                }
            }
        }
        from = to;
        *look = [coverage.share(), known.gap()];
    }
    Ok((looks, known))
}
