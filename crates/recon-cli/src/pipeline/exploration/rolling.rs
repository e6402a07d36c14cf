//! Explorations by palms that turn: the object between them rolls.

use super::motions::{Motions, Told};
use super::plane::InPlane;
use super::settings::{Settings, goal_of, words_of};
use super::side::Side;
use super::state::{State, state_file};
use super::story::{Explored, proof, proven, sentence};
use crate::cli::{PlannerAs, Until};
use crate::error::{CliError, Outcome as Exit};
use crate::pipeline::folder::Extra;
use glam::DVec2;
use recon::exploration::planar::PlanarKnowledge;
use recon::exploration::rolling::{
    InformationRate, LargestGap, NearestGap, PalmSweep, Palms, Prediction, RandomTurns, RollEnd, RollError,
    RollOutcome, RollPlanner, RollProposal, RollTask, Track, View, Workspace, explore_rolling,
};
use recon::exploration::{Certificate, Goal, Knowledge};
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::ContactSample;
use recon_io::{SummaryOf, brief_to, write_exploration_report};
use serde_json::{Value, json};

/// Motions ahead that are looked at.
const AHEAD: usize = 2;
/// Turns of both palms at most, rad.
pub(super) const RADIANS: f64 = 60.0;

/// The planner that is asked for.
pub(super) fn planner(asked: PlannerAs, seed: u64) -> Result<Box<dyn RollPlanner>, CliError> {
    Ok(match asked {
        PlannerAs::PerSecond => Box::new(InformationRate::new(seed, AHEAD)),
        PlannerAs::PerRadian => Box::new(InformationRate::new(seed, AHEAD).per_radian()),
        PlannerAs::PathAware => Box::new(NearestGap::new(seed)),
        PlannerAs::Volume => Box::new(LargestGap::new(seed)),
        PlannerAs::Sweep => Box::new(PalmSweep::new()),
        PlannerAs::Random => Box::new(RandomTurns::new(seed)),
        PlannerAs::Hausdorff | PlannerAs::Gaussian => {
            return Err(asked.not_for("palms that turn", "per-second"));
        }
    })
}

/// Turns `palms` until the goal is proven, and tells `watch` of each reading. Contacts are exact, in the frame of the object.
pub(crate) fn rolled(
    title: &str,
    until: &Until,
    settings: &Settings,
    workspace: Workspace,
    palms: &mut dyn Palms,
    mut watch: impl FnMut(&str),
) -> Result<Explored, CliError> {
    let goal = goal_of::<InPlane>(until)?;
    let mut known = InPlane::nothing(settings)?;
    let mut planner = planner(settings.planner, settings.seed)?;
    let task = RollTask { radians: RADIANS, ..RollTask::new(goal, workspace) };
    let (mut motions, mut state) = (Motions::default(), None::<(Track, usize)>);
    let ended = explore_rolling(&mut known, &mut *planner, palms, &task, |step, known| {
        let track = match state.take() {
            Some((mut track, _)) => {
                track.follow(&step.reading);
                track
            }
            None => Track::new(&step.reading),
        };
        state = Some((track, step.motion));
        motions.take(&Told::of(step), Some(known));
        watch(&format!("{} {} of {}", goal.kind(), brief_to(3, step.progress), goal.value()));
    })?;
    let (level, certificate) = (ended.is_reached(), ended.certificate());
    let why = match &ended {
        RollOutcome::Reached(_) => None,
        RollOutcome::Short { end, .. } => Some(why_short(end)),
    };
    let statement = sentence(&proven(certificate, "contacts"), why.as_deref());
    let mut files = vec![InPlane::contacts_file(&known)?];
    if let Some((track, motion)) = state {
        let middle =
            known.contacts().iter().map(|c| c.point).sum::<DVec2>() / known.contacts().len().max(1) as f64;
        files.push(state_file(&State::at_rest(&track, motion, &workspace, middle)));
    }
    let not_found = match &ended {
        RollOutcome::Short { end: RollEnd::NotFound { directions }, .. } => directions.as_slice(),
        _ => &[],
    };
    let end = Ended { title, goal, statement, reached: level, not_found, certificate };
    written(&end, settings, &known, motions, files)
}

/// How an exploration by palms ended.
pub(super) struct Ended<'a> {
    pub(super) title: &'a str,
    pub(super) goal: Goal<Direction>,
    pub(super) statement: String,
    pub(super) reached: bool,
    pub(super) not_found: &'a [Direction],
    pub(super) certificate: &'a Certificate<Direction>,
}

/// Everything that is written of it, beside `files`.
pub(super) fn written(
    end: &Ended<'_>,
    settings: &Settings,
    known: &PlanarKnowledge,
    motions: Motions,
    mut files: Vec<Extra>,
) -> Result<Explored, CliError> {
    let Ended { title, goal, statement, reached, not_found, certificate } = end;
    let mut figures = SummaryOf::Rolling.named(json!({
        "input": title,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(goal) },
        "settings": settings.figures(),
        "proof": proof(certificate, *reached),
        "bounds": InPlane::bounds(known),
        "radians": motions.radians,
        "seconds": motions.seconds,
        "motions": motions.figures(),
        "warnings": [],
    }));
    let exit = if *reached { Exit::Done } else { Exit::WithReservations };
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    if !not_found.is_empty() {
        let named: Vec<_> = not_found.iter().map(|n| n.get().to_array()).collect();
        figures["not_found"] = json!(named);
    }
    let text = format!(
        "{statement}\n  motions                {}\n  palms turned           {} rad, {} s\n",
        motions.count(),
        brief_to(3, motions.radians),
        brief_to(3, motions.seconds)
    );
    let drawn = InPlane::drawn(known)?;
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    let page = motions.page(end, known);
    write_exploration_report(&page, &mut report).map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    Ok(Explored { figures, text, files, drawn, exit })
}

/// Why it is not more that is proven.
pub(super) fn why_short(end: &RollEnd) -> String {
    match end {
        RollEnd::Budget => "all motions that were allowed for are made".to_owned(),
        RollEnd::NotFound { directions } => {
            let first = directions.first().map_or(f64::NAN, |n| n.angle().to_degrees());
            format!(
                "no motion of these palms uncovers what is left, most of it at {} degrees on the object: all that they can do was gone \
                 through, in steps of 0.3 rad",
                brief_to(3, first)
            )
        }
        RollEnd::Lost(why) => format!("the object was lost ({why})"),
    }
}

/// The next motion after `contacts` with palms and object as in `state`, as `recon next` prints it. `proven` is what an estimate has proven, which its
/// contacts alone do not.
pub(crate) fn next_motion(
    contacts: &[ContactSample],
    state: &State,
    goal: Goal<Direction>,
    settings: &Settings,
    proven: Option<f64>,
) -> Result<(Value, Exit), CliError> {
    goal.check().map_err(RollError::Goal)?;
    state.workspace.check().map_err(RollError::Workspace)?;
    let mut known = PlanarKnowledge::exact();
    for contact in contacts {
        known.insert(*contact).map_err(RollError::Knowledge)?;
    }
    let left = proven.unwrap_or_else(|| known.progress(&goal));
    let done = left <= goal.value();
    let mut told = json!({
        "done": done,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "contacts": known.touches(),
        "motions": state.motion,
    });
    if left.is_finite() {
        told["at_most"] = left.into();
    }
    if let Some((_, confidence)) = settings.sensors {
        told["confidence"] = confidence.into();
    }
    if done {
        return Ok((told, Exit::Done));
    }
    let task = RollTask::new(goal, state.workspace);
    let (workspace, goal) = (&task.workspace, &task.goal);
    let (risk, spacing, motion) = (task.risk, task.spacing, state.motion);
    let view = View { known: &known, track: &state.track, workspace, goal, risk, spacing, motion };
    match planner(settings.planner, settings.seed)?.next(&view) {
        Ok(RollProposal { legs, expected, reason }) => {
            let mut action = json!({ "palms_rad": legs, "why": reason.words() });
            if let Some(Prediction { gain, lost, seconds, radians, .. }) = expected {
                action["expected"] =
                    json!({ "area_m2": gain, "lost": lost, "seconds": seconds, "radians": radians });
            }
            told["action"] = action;
            Ok((told, Exit::Done))
        }
        Err(error) => {
            told["why_none"] = error.to_string().into();
            Ok((told, Exit::WithReservations))
        }
    }
}
