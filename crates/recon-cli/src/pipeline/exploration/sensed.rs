//! Explorations by palms with noisy sensors: the motion is estimated after each motion of the palms.

use super::motions::{Motions, Told};
use super::plane::InPlane;
use super::rolling::{Ended, RADIANS, planner, why_short, written};
use super::settings::{Settings, goal_of};
use super::side::Side;
use super::state::{State, state_file};
use super::story::{Explored, proven, sentence};
use crate::cli::Until;
use crate::error::CliError;
use recon::exploration::planar::PlanarKnowledge;
use recon::exploration::rolling::{
    Hands, Look, RollEnd, RollTask, SensedEnd, SensedTask, Workspace, explore_sensed,
};
use recon::exploration::{Certificate, Knowledge, Spending};
use recon::observer::planar::PlaneOptions;
use recon_io::brief_to;

/// Turns `hands` until the goal is proven at the confidence of `settings`, and tells `watch` of each motion.
pub(crate) fn sensed(
    title: &str,
    until: &Until,
    settings: &Settings,
    (workspace, sensors, level): (Workspace, PlaneOptions, f64),
    hands: &mut dyn Hands,
    mut watch: impl FnMut(&str),
) -> Result<Explored, CliError> {
    let goal = goal_of::<InPlane>(until)?;
    let mut planner = planner(settings.planner, settings.seed)?;
    let roll = RollTask { radians: RADIANS, motions: settings.budget, ..RollTask::new(goal, workspace) };
    let task = SensedTask { roll, sensors, level };
    let (mut motions, mut last) = (Motions::default(), 0);
    let ended = explore_sensed(&mut *planner, hands, &task, |step, look| {
        motions.take(&Told::sensed(step), look.map(|look| &look.proven));
        last = step.motion;
        watch(&format!("{} {} of {}", goal.kind(), brief_to(3, step.progress), goal.value()));
    })?;
    let nothing = PlanarKnowledge::exact();
    let known = ended.look.as_ref().map_or(&nothing, |look| &look.proven);
    let none = || Certificate::of(&nothing, goal, Some(Spending::Budget(settings.budget + 1)));
    let certificate = ended.certificate.unwrap_or_else(none);
    let why = ended.short.as_ref().map(|short| match short {
        SensedEnd::Rolling(end) => why_short(end),
        SensedEnd::Stopped(why) => format!("the palms cannot go on ({why})"),
        SensedEnd::Doubted { doubt } => {
            format!("the estimate of the motion is not to be relied on any more ({doubt})")
        }
    });
    let statement = sentence(&proven(&certificate, "contacts"), why.as_deref());
    let mut files = Vec::new();
    if let Some(Look { planned_on, track, .. }) = &ended.look {
        // All contacts are in the estimate; these stand for them, and are what the next motion is planned on.
        files.push(InPlane::contacts_file(planned_on)?);
        files.push(state_file(&State::in_motion(track, last, &workspace)));
    }
    let not_found = match &ended.short {
        Some(SensedEnd::Rolling(RollEnd::NotFound { directions })) => directions.as_slice(),
        _ => &[],
    };
    let reached = ended.short.is_none() && known.proves(&goal);
    let end = Ended { title, goal, statement, reached, not_found, certificate: &certificate };
    written(&end, settings, known, motions, files)
}
