//! What was touched, why, and what is proven.

use super::Side;
use super::page::{Course, page};
use super::settings::{Settings, words_of};
use super::side::{AnyFinger, Drawn};
use crate::error::{CliError, Outcome as Exit};
use crate::pipeline::folder::Extra;
use recon::exploration::{
    Certificate, Goal, Heading, Knowledge, Limits, Outcome, PlanError, Planner, Proposal, Shortfall,
    Situation, Step, Task, explore, least_touches, touches_predicted,
};
use recon_io::{SummaryOf, TouchRow, brief_to, write_exploration_report};
use serde_json::{Value, json};

/// An exploration that has ended.
pub(crate) struct Explored {
    pub(crate) figures: Value,
    pub(crate) text: String,
    pub(crate) files: Vec<Extra>,
    pub(crate) drawn: Drawn,
    pub(crate) exit: Exit,
}

type HeadingOf<S> = <<S as Side>::Known as Knowledge>::Heading;

/// Explores with `finger`, and tells `watch` of each touch. `width` is the largest mean width that the object may have, in m, if known.
pub(crate) fn explored<S: Side>(
    title: &str,
    goal: Goal<HeadingOf<S>>,
    settings: &Settings,
    width: Option<f64>,
    finger: &mut AnyFinger<'_, S>,
    mut watch: impl FnMut(usize, &str),
) -> Result<Explored, CliError> {
    let mut known = S::nothing(settings)?;
    let mut planner = S::planner(settings)?;
    let task = Task { spending: settings.spending(), width, ..Task::new(goal, settings.budget) };
    let mut course = Course::default();
    let mut before = f64::INFINITY;
    let ended = explore(&mut known, &mut *planner, finger, &task, |step, known| {
        course.pictures.push(S::pictures(known, Some(&step.proposal.along.coordinates())));
        course.way += step.turned;
        course.rows.push(row::<S>(step, before));
        course.sizes.push([step.lower, step.upper]);
        before = step.progress;
        watch(step.touch, &forecast(S::DIMENSION, step, &goal));
    })?;
    let next = next_proposal::<S>(&known, &goal, &mut *S::planner(settings)?).ok();
    let certificate = ended.certificate();
    let (statement, exit) = statement::<S>(&ended);
    let mut figures = SummaryOf::Exploration.named(json!({
        "input": title,
        "dimension": S::DIMENSION,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "settings": settings.figures(),
        "proof": proof(certificate, ended.is_reached()),
        "bounds": S::bounds(&known),
        "way_rad": course.way,
        "touches": course.rows.iter().map(touch_figures).collect::<Vec<_>>(),
        "warnings": [],
    }));
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    if let Goal::Gap(gap) = goal {
        figures["least_touches_of_an_ellipsoid"] = least_touches(S::DIMENSION, gap).into();
    }
    if let Some(next) = &next {
        figures["next"] = action::<S>(next);
    }
    let text = format!(
        "{statement}\n  touches                {}\n  way                    {} rad\n",
        certificate.touches,
        brief_to(3, course.way)
    );
    let drawn = S::drawn(&known)?;
    let mut files = vec![S::contacts_file(&known)?];
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    write_exploration_report(
        &page::<S>(title, &known, &ended, &statement, course, next.as_ref()),
        &mut report,
    )
    .map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    Ok(Explored { figures, text, files, drawn, exit })
}

fn row<S: Side>(step: &Step<S::Known>, before: f64) -> TouchRow {
    let [point, _] = S::contact(&step.contact);
    // The score of a gap is a volume; as a share of the upper bound it is a gap again.
    let share = |expected: f64| if step.upper.is_finite() { expected / step.upper } else { expected };
    TouchRow {
        touch: Some(step.touch),
        why: step.proposal.reason.words().to_owned(),
        along: step.proposal.along.coordinates(),
        point: Some(point),
        turned: step.turned,
        expected: step.proposal.expected.map(share).filter(|e| e.is_finite()),
        gained: Some(before - step.progress).filter(|g| g.is_finite()),
        progress: Some(step.progress).filter(|p| p.is_finite()),
    }
}

/// Where it stands, and when it will be done.
fn forecast<K: Knowledge>(dimension: usize, step: &Step<K>, goal: &Goal<K::Heading>) -> String {
    let now = brief_to(3, step.progress);
    match goal {
        Goal::Gap(gap) if step.progress < 0.9 => {
            let touches = touches_predicted(dimension, step.touch, step.progress, *gap).ceil();
            format!("{} {now} of {gap}, about {touches} touches in all", goal.kind())
        }
        _ => format!("{} {now} of {}", goal.kind(), goal.value()),
    }
}

fn touch_figures(row: &TouchRow) -> Value {
    let mut figures = json!({ "touch": row.touch, "why": row.why, "along": row.along, "point_m": row.point });
    for (key, value) in [("expected", row.expected), ("gained", row.gained), ("left", row.progress)] {
        if let Some(value) = value {
            figures[key] = value.into();
        }
    }
    figures
}

/// What is proven, in a sentence, and whether that is what was asked for.
fn statement<S: Side>(ended: &Outcome<HeadingOf<S>>) -> (String, Exit) {
    let told = proven(ended.certificate(), "touches");
    match ended {
        Outcome::Reached(_) => (sentence(&told, None), Exit::Done),
        Outcome::Short { shortfall, .. } => {
            let why = match shortfall {
                Shortfall::Budget => "all touches that were allowed for are made".to_owned(),
                Shortfall::NothingToGain | Shortfall::NotFound { .. } => {
                    "no touch narrows the bounds any more".to_owned()
                }
                Shortfall::Unreachable { directions } => {
                    format!("{} directions that would narrow the bounds are out of reach", directions.len())
                }
            };
            (sentence(&told, Some(&why)), Exit::WithReservations)
        }
    }
}

/// The verdict: what is proven, and why no more is.
pub(super) fn sentence(told: &str, why: Option<&str>) -> String {
    why.map_or_else(|| format!("{told}."), |why| format!("{told}: {why}."))
}

/// What a certificate says, made of so many `touches`.
pub(super) fn proven<H: Heading>(certificate: &Certificate<H>, made_of: &str) -> String {
    let Certificate { goal, proven, confidence, touches, .. } = certificate;
    let sure = match confidence {
        Some((level, _)) => format!(" at {} % confidence", 100.0 * level),
        None => " for exact contacts".to_owned(),
    };
    let what = match goal {
        Goal::Gap(_) => "The gap between the bounds",
        Goal::Hausdorff(_) => "The largest distance of the bounds in m",
        Goal::Width { .. } => "The difference of the bounds' widths in m",
    };
    let value = if proven.is_finite() {
        format!("at most {}", brief_to(4, *proven))
    } else {
        "not bounded".to_owned()
    };
    format!("{what} is {value}{sure} after {touches} {made_of}, and {} was asked for", goal.value())
}

pub(super) fn proof<H: Heading>(certificate: &Certificate<H>, reached: bool) -> Value {
    let mut proof = json!({ "reached": reached, "touches": certificate.touches });
    if certificate.proven.is_finite() {
        proof["at_most"] = certificate.proven.into();
    }
    if let Some((level, _)) = certificate.confidence {
        proof["confidence"] = level.into();
    }
    proof
}

/// The touch that would be next.
fn next_proposal<S: Side>(
    known: &S::Known,
    goal: &Goal<HeadingOf<S>>,
    planner: &mut dyn Planner<S::Known>,
) -> Result<Proposal<S::Known>, PlanError> {
    let here = S::contacts(known).last().map(S::normal);
    let limits = Limits::default();
    planner.next(&Situation { known, here, goal, limits: &limits })
}

/// A touch as a robot reads it.
fn action<S: Side>(proposal: &Proposal<S::Known>) -> Value {
    let mut action = json!({ "along": proposal.along.coordinates(), "why": proposal.reason.words() });
    if let Some([from, to]) = proposal.ray {
        action["ray"] = json!({ "from_m": S::point(from), "to_m": S::point(to) });
    }
    if let Some(expected) = proposal.expected {
        action["expected"] = expected.into();
    }
    action
}

/// Where to touch next after `contacts`, as `recon next` prints it.
pub(crate) fn next_touch<S: Side>(
    contacts: &[<S::Known as Knowledge>::Contact],
    goal: Goal<HeadingOf<S>>,
    settings: &Settings,
) -> Result<(Value, Exit), CliError> {
    goal.check().map_err(recon::exploration::ExploreError::Goal)?;
    let mut planner = S::planner(settings)?;
    let mut known = S::nothing(settings)?;
    for contact in contacts {
        known.insert(*contact).map_err(recon::exploration::ExploreError::Knowledge)?;
    }
    let certificate = Certificate::of(&known, goal, settings.spending());
    let done = known.proves(&goal);
    let mut told = json!({
        "done": done,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "touches": known.touches(),
    });
    if certificate.proven.is_finite() {
        told["at_most"] = certificate.proven.into();
    }
    if let Some((level, _)) = certificate.confidence {
        told["confidence"] = level.into();
    }
    if let Goal::Gap(gap) = goal
        && certificate.proven < 1.0
    {
        told["touches_predicted"] =
            (touches_predicted(S::DIMENSION, known.touches(), certificate.proven, gap).ceil() as u64).into();
    }
    if done {
        return Ok((told, Exit::Done));
    }
    match next_proposal::<S>(&known, &goal, &mut *planner) {
        Ok(proposal) => {
            told["action"] = action::<S>(&proposal);
            Ok((told, Exit::Done))
        }
        Err(error) => {
            told["why_none"] = error.to_string().into();
            Ok((told, Exit::WithReservations))
        }
    }
}
