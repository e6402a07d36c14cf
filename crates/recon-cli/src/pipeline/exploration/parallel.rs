//! Explorations by two parallel palms with friction: the object between them rolls as the upper one moves.

use super::page::{in_turn, measured, quantity};
use super::parallel_state::{Placed, state_file};
use super::settings::{Settings, goal_of, words_of};
use super::side::Side;
use super::space::InSpace;
use super::story::{Explored, proof, proven, sentence};
use crate::cli::{PlannerAs, Until};
use crate::error::{CliError, Outcome as Exit};
use glam::{DMat3, DVec3};
use recon::contact_kinematics::Direction;
use recon::exploration::parallel::{
    LargestGap, NearestGap, ParallelError, ParallelPalms, ParallelPlanner, ParallelProposal, ParallelStep,
    ParallelTask, ParallelView, ParallelWorkspace, PathRate, RandomStrokes, RasterSweep, Stop,
    explore_parallel,
};
use recon::exploration::space::SpaceKnowledge;
use recon::exploration::{Goal, Knowledge, Outcome, Shortfall};
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::noise::ContactNoise;
use recon_io::{
    ExplorationPage, ExplorationWords, FigureCurve, FigurePanel, Level, SummaryOf, TouchRow, Verdict,
    brief_to, write_exploration_report,
};
use serde_json::{Value, json};

/// Strokes ahead that are looked at.
const AHEAD: usize = 2;

/// The planner that is asked for: at one speed the most per way is the most per second.
fn planner(asked: PlannerAs, seed: u64) -> Result<Box<dyn ParallelPlanner>, CliError> {
    Ok(match asked {
        PlannerAs::PerSecond | PlannerAs::PerRadian => Box::new(PathRate::new(seed, AHEAD)),
        PlannerAs::PathAware => Box::new(NearestGap::new(seed)),
        PlannerAs::Volume => Box::new(LargestGap::new(seed)),
        PlannerAs::Sweep => Box::new(RasterSweep::new()),
        PlannerAs::Random => Box::new(RandomStrokes::new(seed)),
        PlannerAs::Hausdorff | PlannerAs::Gaussian => {
            return Err(asked.not_for("a palm that moves", "per-second"));
        }
    })
}

/// A stroke, from what was felt at the end of it.
struct Made {
    last: ParallelStep,
    /// Way of the upper palm, m.
    way: f64,
    gained: f64,
}

/// The course of it.
#[derive(Default)]
struct Strokes {
    made: Vec<Made>,
    /// Way of the palm, progress and volumes after each reading.
    course: Vec<[f64; 4]>,
    pictures: Vec<Vec<FigurePanel>>,
}

impl Strokes {
    fn take(&mut self, step: &ParallelStep, known: &SpaceKnowledge) {
        let measures = known.measures();
        let [was, before] = self.course.last().map_or([0.0, f64::INFINITY], |of| [of[0], of[1]]);
        let (way, gained) = (step.way - was, before - step.progress);
        self.course.push([step.way, step.progress, measures.lower, measures.upper]);
        match self.made.last_mut().filter(|made| made.last.stroke == step.stroke) {
            Some(made) => {
                (made.way, made.gained) = (made.way + way, made.gained + gained);
                made.last = *step;
                self.pictures.pop();
            }
            None => self.made.push(Made { last: *step, way, gained }),
        }
        self.pictures.push(pictures(known));
    }

    fn way(&self) -> f64 {
        self.course.last().map_or(0.0, |of| of[0])
    }

    /// What no contact is off by more than, in axes of the object: deviations of points per axis (m) and of normals (rad); none of exact ones.
    fn noise(&self) -> Option<[f64; 2]> {
        let all =
            self.made.iter().filter_map(|made| Some((made.last.reading.contacts, made.last.reading.noise?)));
        let each = all.flat_map(|(contacts, noise)| [0, 1].map(|i| off(contacts[i].point, &noise[i])));
        each.reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
    }

    fn count(&self) -> usize {
        self.made.len().saturating_sub(1)
    }

    fn panels(&self, goal: &Goal<Direction>) -> Vec<FigurePanel> {
        let curve = |name: &str, k: usize| FigureCurve {
            name: name.to_owned(),
            points: self.course.iter().map(|of| [of[0], of[k]]).filter(|p| p[1].is_finite()).collect(),
            ..FigureCurve::default()
        };
        let asked = [0.0, self.way()].map(|x| [x, goal.value()]).to_vec();
        let asked = FigureCurve { name: "asked for".to_owned(), points: asked, ..FigureCurve::default() };
        let panel = |title: &str, up: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["way of the palm, m".to_owned(), up.to_owned()],
            curves,
            ..FigurePanel::default()
        };
        vec![
            panel("What is left over the way", goal.kind(), vec![curve("proven", 1), asked]),
            panel("Bounds over the way", "size in m³", vec![curve("lower", 2), curve("upper", 3)]),
        ]
    }
}

/// Deviations of a contact at `point` with its pose, no less than along any axis.
fn off(point: DVec3, noise: &ContactNoise) -> [f64; 2] {
    let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
    let turn = trace(noise.pose.rotation);
    let place = trace(noise.point) + 2.0 * (trace(noise.pose.translation) + point.length_squared() * turn);
    [place.sqrt(), noise.normal.hypot(turn.sqrt())]
}

impl Made {
    fn why(&self) -> &'static str {
        self.last.why.map_or("felt at the start", |(reason, _)| reason.words())
    }

    fn expected(&self) -> Option<f64> {
        self.last.why.and_then(|(_, expected)| Some(expected?.gain))
    }

    fn stopped(&self) -> Option<&'static str> {
        self.last.reading.stop.map(|stop| match stop {
            Stop::Shear => "friction",
            Stop::Pad => "edge of a pad",
        })
    }

    /// Where the normal at the upper contact is then, body axes, and where on the pads it is touched.
    fn row(&self) -> TouchRow {
        let hold = self.last.reading.hold;
        let why = match self.stopped() {
            Some(by) => format!("{}; stopped by {by}", self.why()),
            None => self.why().to_owned(),
        };
        TouchRow {
            touch: Some(self.last.stroke),
            why,
            along: hold.normals()[0].get().to_array().to_vec(),
            point: Some(hold.pads.iter().flat_map(|pad| pad.to_array()).collect()),
            turned: self.way,
            expected: self.expected(),
            gained: Some(self.gained).filter(|g| g.is_finite()),
            progress: Some(self.last.progress).filter(|p| p.is_finite()),
        }
    }

    fn figures(&self) -> Value {
        let ParallelStep { stroke, reading, way, progress, .. } = &self.last;
        let mut figures = json!({
            "stroke": stroke,
            "why": self.why(),
            "up_normal": reading.hold.normals()[0].get().to_array(),
            "pads_m": reading.hold.pads.map(|pad| pad.to_array()),
            "way_m": way,
        });
        if let Some(by) = self.stopped() {
            figures["stopped_by"] = by.into();
        }
        let gained = Some(self.gained).filter(|g| g.is_finite());
        let left = Some(*progress).filter(|p| p.is_finite());
        for (key, value) in [("expected", self.expected()), ("gained", gained), ("left", left)] {
            if let Some(value) = value {
                figures[key] = value.into();
            }
        }
        figures
    }
}

/// The bounds with the contacts, seen along three axes; nothing while they are not closed.
fn pictures(known: &SpaceKnowledge) -> Vec<FigurePanel> {
    let closed = known.bounds().is_some_and(|bounds| bounds.upper().bounded().is_some());
    if closed { InSpace::pictures(known, None) } else { Vec::new() }
}

/// Moves the upper palm until the goal is proven, and tells `watch` of each reading. Contacts are in the frame of the object.
pub(crate) fn stroked(
    title: &str,
    until: &Until,
    settings: &Settings,
    workspace: ParallelWorkspace,
    palms: &mut dyn ParallelPalms,
    mut watch: impl FnMut(&str),
) -> Result<Explored, CliError> {
    let goal = goal_of::<InSpace>(until)?;
    let mut known = InSpace::nothing(settings)?;
    let mut planner = planner(settings.planner, settings.seed)?;
    let task = ParallelTask { spending: settings.spending(), ..ParallelTask::new(goal, workspace) };
    let mut strokes = Strokes::default();
    let ended = explore_parallel(&mut known, &mut *planner, palms, &task, |step, known| {
        strokes.take(step, known);
        watch(&format!("{} {} of {}", goal.kind(), brief_to(3, step.progress), goal.value()));
    })?;
    let certificate = ended.certificate();
    let why = match &ended {
        Outcome::Reached(_) => None,
        Outcome::Short { shortfall, .. } => Some(why_short(shortfall)),
    };
    let statement = sentence(&proven(certificate, "contacts"), why.as_deref());
    let mut figures = SummaryOf::Strokes.named(json!({
        "input": title,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "settings": settings.figures(),
        "friction": workspace.friction,
        "proof": proof(certificate, ended.is_reached()),
        "bounds": InSpace::bounds(&known),
        "way_m": strokes.way(),
        "strokes": strokes.made.iter().map(Made::figures).collect::<Vec<_>>(),
        "warnings": [],
    }));
    let exit = if ended.is_reached() { Exit::Done } else { Exit::WithReservations };
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    if let Outcome::Short { shortfall: Shortfall::NotFound { directions }, .. } = &ended {
        figures["not_found"] = json!(directions);
    }
    let text = format!(
        "{statement}\n  strokes                {}\n  way of the palm        {} m\n",
        strokes.count(),
        brief_to(3, strokes.way())
    );
    let drawn = InSpace::drawn(&known)?;
    let mut files = vec![InSpace::contacts_file(&known)?];
    if let Some(made) = strokes.made.last() {
        let (hold, stroke) = (made.last.reading.hold, made.last.stroke);
        let noise = strokes.noise();
        let walls = strokes.made.iter().filter_map(|made| made.last.wall).collect();
        files.push(state_file(&Placed { hold, workspace, stroke, noise, walls }));
    }
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    write_exploration_report(&page(title, &known, &ended, statement, strokes), &mut report)
        .map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    Ok(Explored { figures, text, files, drawn, exit })
}

fn page(
    title: &str,
    known: &SpaceKnowledge,
    ended: &Outcome<Direction>,
    statement: String,
    strokes: Strokes,
) -> ExplorationPage {
    let certificate = ended.certificate();
    let level = if ended.is_reached() { Level::Good } else { Level::Caution };
    let measures = known.measures();
    let stopped = strokes.made.iter().filter(|made| made.last.reading.stop.is_some()).count();
    let mut facts = vec![
        ("Strokes", strokes.count().to_string(), ""),
        ("Way of the palm", brief_to(3, strokes.way()), "m"),
        ("Stopped", stopped.to_string(), "strokes"),
        ("Contacts taken", certificate.touches.to_string(), ""),
        measured("Proven", certificate.proven, ""),
        ("Asked for", brief_to(4, certificate.goal.value()), ""),
        measured("Lower bound", measures.lower, InSpace::UNIT),
        measured("Upper bound", measures.upper, InSpace::UNIT),
    ];
    if let Some((level, _)) = certificate.confidence {
        facts.push(("Confidence", brief_to(4, 100.0 * level), "%"));
    }
    if let Some([place, turn]) = strokes.noise() {
        facts.push(("Contacts off by", brief_to(2, place), "m at most (1 deviation)"));
        facts.push(("Normals off by", brief_to(2, turn), "rad at most (1 deviation)"));
    }
    let touches = strokes.made.iter().map(Made::row).collect();
    let mut panels = strokes.panels(&certificate.goal);
    // What was seen before both bounds were closed has other pictures.
    let last = pictures(known);
    let alike = strokes.pictures.into_iter().filter(|pictures| pictures.len() == last.len()).collect();
    panels.extend(in_turn(last, alike, "after stroke"));
    ExplorationPage {
        words: ExplorationWords::STROKES,
        title: title.to_owned(),
        verdict: Verdict { level, text: statement },
        facts,
        progress: quantity(&certificate.goal).to_owned(),
        panels,
        caption: "The body lies between the bounds. Strokes: contacts with their outward normals.".to_owned(),
        touches,
    }
}

/// Why it is not more that is proven.
fn why_short(shortfall: &Shortfall) -> String {
    match shortfall {
        Shortfall::Budget => "all strokes or contacts that were allowed for are made".to_owned(),
        Shortfall::NotFound { directions } => {
            let first = directions.first().map_or_else(String::new, |n| {
                let n: Vec<String> = n.iter().map(|c| brief_to(2, *c)).collect();
                format!(", most of it along ({}) on the object", n.join(", "))
            });
            format!(
                "no stroke uncovers what is left{first}: all that the palms can do was gone through, in steps of 0.2 rad, and more friction lets more be reached"
            )
        }
        Shortfall::Unreachable { .. } | Shortfall::NothingToGain => {
            "no stroke narrows the bounds any more".to_owned()
        }
    }
}

/// The next stroke after `contacts` with the object as in `placed`, as `recon next` prints it; `stated` is what was proven of the goal before.
pub(crate) fn next_stroke(
    contacts: &[ContactSample],
    placed: &Placed,
    goal: Goal<Direction>,
    settings: &Settings,
    stated: f64,
) -> Result<(Value, Exit), CliError> {
    let mut settings = *settings;
    if let Some((noise, confidence)) = placed.noise.zip(settings.confidence) {
        settings.noise = Some((noise, confidence));
    }
    let settings = &settings;
    goal.check().map_err(ParallelError::Goal)?;
    placed.workspace.check().map_err(ParallelError::Workspace)?;
    let mut known = InSpace::nothing(settings)?;
    for contact in contacts {
        known.insert(*contact).map_err(ParallelError::Knowledge)?;
    }
    // What was proven stays so, with the noise that each contact had.
    let left = known.progress(&goal).min(stated);
    let done = left <= goal.value();
    let mut told = json!({
        "done": done,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "contacts": known.touches(),
        "strokes": placed.stroke,
    });
    if left.is_finite() {
        told["at_most"] = left.into();
    }
    if let Some((_, confidence)) = settings.noise {
        told["confidence"] = confidence.into();
    }
    if done {
        return Ok((told, Exit::Done));
    }
    let task = ParallelTask::new(goal, placed.workspace);
    let (workspace, goal, spacing) = (&task.workspace, &task.goal, task.spacing);
    let (hold, stroke) = (&placed.hold, placed.stroke);
    let walls = &placed.walls;
    let view = ParallelView { known: &known, hold, workspace, goal, walls, spacing, stroke, idle: 0 };
    match planner(settings.planner, settings.seed)?.next(&view) {
        Ok(ParallelProposal { stroke, expected, reason }) => {
            let mut action =
                json!({ "heading_rad": stroke.heading, "turn_rad": stroke.turn, "why": reason.words() });
            if let Some(p) = expected {
                action["expected"] = json!({ "gain": p.gain, "held": p.held, "way_m": p.way });
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
