//! Explorations by palms that turn: the object between them rolls.

use super::page::{in_turn, outline_panel, quantity};
use super::plane::{InPlane, lower, upper};
use super::settings::{Settings, goal_of, words_of};
use super::side::Side;
use super::story::{Explored, proof, proven};
use crate::cli::{PlannerAs, Until};
use crate::error::{CliError, Outcome as Exit};
use glam::DVec2;
use recon::exploration::Knowledge;
use recon::exploration::planar::PlanarKnowledge;
use recon::exploration::rolling::{
    InformationRate, LargestGap, NearestGap, PalmSweep, Palms, RandomTurns, RollEnd, RollOutcome,
    RollPlanner, RollStep, RollTask, Workspace, explore_rolling,
};
use recon::shape_bounds::planar::Direction;
use recon_io::{
    ExplorationPage, ExplorationWords, FigureCurve, FigurePanel, Level, SummaryOf, TouchRow, Verdict,
    brief_to, write_exploration_report,
};
use serde_json::{Value, json};

/// Motions ahead that are looked at.
const AHEAD: usize = 2;
/// Turns of both palms at most, rad.
const RADIANS: f64 = 60.0;

/// The planner that is asked for.
fn planner(asked: PlannerAs, seed: u64) -> Result<Box<dyn RollPlanner>, CliError> {
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

/// Turns `palms` until the goal is proven, and tells `watch` of each reading.
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
    let task = RollTask { radians: RADIANS, spending: settings.spending(), ..RollTask::new(goal, workspace) };
    let mut story = Story::default();
    let ended = explore_rolling(&mut known, &mut *planner, palms, &task, |step, known| {
        story.take(step, known);
        watch(&format!("{} {} of {}", goal.kind(), brief_to(3, step.progress), goal.value()));
    })?;
    let statement = statement(&ended);
    let mut figures = SummaryOf::Rolling.named(json!({
        "input": title,
        "goal": { "kind": goal.kind(), "value": goal.value(), "until": words_of(&goal) },
        "settings": settings.figures(),
        "proof": proof(ended.certificate(), matches!(ended, RollOutcome::Reached(_))),
        "bounds": InPlane::bounds(&known),
        "radians": story.radians,
        "seconds": story.seconds,
        "motions": story.motions.iter().map(Motion::figures).collect::<Vec<_>>(),
        "warnings": [],
    }));
    let exit = if matches!(ended, RollOutcome::Reached(_)) { Exit::Done } else { Exit::WithReservations };
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    if let RollOutcome::Short { end: RollEnd::NotFound { directions }, .. } = &ended {
        let named: Vec<_> = directions.iter().map(|n| n.get().to_array()).collect();
        figures["not_found"] = json!(named);
    }
    let text = format!(
        "{title}\n  {statement}\n  motions                {}\n  palms turned           {} rad, {} s\n",
        story.motions.len() - 1,
        brief_to(3, story.radians),
        brief_to(3, story.seconds)
    );
    let drawn = InPlane::drawn(&known)?;
    let mut files = vec![InPlane::contacts_file(&known)?];
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    let page = story.page(title, &known, &ended, statement, goal.value());
    write_exploration_report(&page, &mut report).map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    Ok(Explored { figures, text, files, drawn, exit })
}

/// What is proven, in a sentence, and why it is not more.
fn statement(ended: &RollOutcome) -> String {
    let told = proven(ended.certificate(), "contacts");
    match ended {
        RollOutcome::Reached(_) => told,
        RollOutcome::Short { end, .. } => match end {
            RollEnd::Budget => format!("{told}: all motions or contacts that were allowed for are made"),
            RollEnd::NotFound { directions } => {
                let first = directions.first().map_or(f64::NAN, |n| n.angle().to_degrees());
                format!(
                    "{told}: the planner found no motion that uncovers what is left, most of it at {} degrees on the object; that is no proof that \
                     there is none",
                    brief_to(3, first)
                )
            }
            RollEnd::Lost(why) => format!("{told}: the object was lost ({why})"),
        },
    }
}

/// One motion, from what was felt at the end of it.
struct Motion {
    last: RollStep,
    /// Turns of both palms, rad.
    turned: f64,
    gained: f64,
    /// Share of the upper bound that it was expected to bring.
    expected: Option<f64>,
    falls: usize,
}

/// The course of it.
#[derive(Default)]
struct Story {
    motions: Vec<Motion>,
    /// Radians of palm motion, gap and areas after each reading.
    course: Vec<[f64; 4]>,
    /// Pictures after each motion.
    pictures: Vec<Vec<FigurePanel>>,
    radians: f64,
    seconds: f64,
}

impl Story {
    fn take(&mut self, step: &RollStep, known: &PlanarKnowledge) {
        let measures = known.measures();
        let before = self.course.last().map_or(f64::INFINITY, |[_, progress, ..]| *progress);
        self.course.push([step.radians, step.progress, measures.lower, measures.upper]);
        let turned = step.radians - self.radians;
        (self.radians, self.seconds) = (step.radians, step.seconds);
        let pictures = pictures(known, Some(step));
        let gained = before - step.progress;
        match self.motions.last_mut().filter(|motion| motion.last.motion == step.motion) {
            Some(motion) => {
                motion.turned += turned;
                motion.gained += gained;
                motion.falls += usize::from(step.reading.fell);
                motion.last = *step;
                self.pictures.pop();
            }
            None => {
                let area = step.why.and_then(|(_, prediction)| Some(prediction?.gain));
                let expected = area.filter(|_| measures.upper.is_finite()).map(|area| area / measures.upper);
                let falls = usize::from(step.reading.fell);
                self.motions.push(Motion { last: *step, turned, gained, expected, falls });
            }
        }
        self.pictures.push(pictures);
    }

    fn page(
        self,
        title: &str,
        known: &PlanarKnowledge,
        ended: &RollOutcome,
        statement: String,
        asked: f64,
    ) -> ExplorationPage {
        let certificate = ended.certificate();
        let reached = matches!(ended, RollOutcome::Reached(_));
        let level = if reached { Level::Good } else { Level::Caution };
        let size = |v: f64| if v.is_finite() { brief_to(4, v) } else { "unbounded".to_owned() };
        let measures = known.measures();
        let falls: usize = self.motions.iter().map(|motion| motion.falls).sum();
        let facts = vec![
            ("Motions", (self.motions.len() - 1).to_string(), ""),
            ("Palms turned", brief_to(3, self.radians), "rad"),
            ("Time", brief_to(3, self.seconds), "s"),
            ("Falls", falls.to_string(), ""),
            ("Contacts taken", certificate.touches.to_string(), ""),
            ("Proven", size(certificate.proven), ""),
            ("Asked for", brief_to(4, asked), ""),
            ("Lower bound", size(measures.lower), InPlane::UNIT),
            ("Upper bound", size(measures.upper), InPlane::UNIT),
        ];
        let curve = |name: &str, k: usize| FigureCurve {
            name: name.to_owned(),
            points: self.course.iter().map(|of| [of[0], of[k]]).filter(|p| p[1].is_finite()).collect(),
            ..FigureCurve::default()
        };
        let asked = [0.0, self.radians].map(|x| [x, asked]).to_vec();
        let asked = FigureCurve { name: "asked for".to_owned(), points: asked, ..FigureCurve::default() };
        let panel = |title: &str, up: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["palms turned, rad".to_owned(), up.to_owned()],
            curves,
            ..FigurePanel::default()
        };
        let mut panels = vec![
            panel("What is left over palm motion", certificate.goal.kind(), vec![curve("proven", 1), asked]),
            panel("Bounds over palm motion", "size in m²", vec![curve("lower", 2), curve("upper", 3)]),
        ];
        let last = self.motions.last().map(|motion| motion.last);
        panels.extend(in_turn(pictures(known, last.as_ref()), self.pictures, "after motion"));
        ExplorationPage {
            words: ExplorationWords::MOTIONS,
            title: title.to_owned(),
            verdict: Verdict { level, text: statement },
            facts,
            progress: quantity(&certificate.goal).to_owned(),
            panels,
            caption: "The body lies between the bounds. Strokes: contacts with their outward normals; lines through two of them: the palms, as the \
                      body sees them."
                .to_owned(),
            touches: self.motions.iter().map(Motion::row).collect(),
        }
    }
}

impl Motion {
    fn why(&self) -> &'static str {
        self.last.why.map_or("felt at the start", |(reason, _)| reason.words())
    }

    fn row(&self) -> TouchRow {
        TouchRow {
            touch: Some(self.last.motion),
            why: self.why().to_owned(),
            along: self.last.reading.palms.to_vec(),
            point: Some(self.last.reading.s.to_vec()),
            turned: self.turned,
            expected: self.expected,
            gained: Some(self.gained).filter(|g| g.is_finite()),
            progress: Some(self.last.progress).filter(|p| p.is_finite()),
        }
    }

    fn figures(&self) -> Value {
        let RollStep { motion, reading, radians, seconds, progress, .. } = self.last;
        let mut figures = json!({
            "motion": motion,
            "why": self.why(),
            "palms_rad": reading.palms,
            "contacts_m": reading.s,
            "falls": self.falls,
            "radians": radians,
            "seconds": seconds,
        });
        let gained = Some(self.gained).filter(|g| g.is_finite());
        let left = Some(progress).filter(|p| p.is_finite());
        for (key, value) in [("expected", self.expected), ("gained", gained), ("left", left)] {
            if let Some(value) = value {
                figures[key] = value.into();
            }
        }
        figures
    }
}

/// The bounds with the contacts, and the palms as the body sees them.
fn pictures(known: &PlanarKnowledge, step: Option<&RollStep>) -> Vec<FigurePanel> {
    let flat = |corners: Vec<DVec2>| corners.iter().map(DVec2::to_array).collect::<Vec<_>>();
    let contacts = known.contacts().iter().map(|c| (c.point.to_array(), c.normal.get().to_array())).collect();
    let outlines = [flat(lower(known)), flat(upper(known))];
    let mut panel = outline_panel("Contacts and palms", ["x", "y"], outlines, contacts, None);
    let (low, high) = lower(known)
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    let half = 0.5 * (high - low).max_element();
    if let Some(step) = step.filter(|_| half.is_finite()) {
        let line = |(point, normal): (DVec2, &Direction)| {
            let along = normal.get().perp() * half;
            [(point - along).to_array(), (point + along).to_array(), [f64::NAN; 2]]
        };
        let contacts = step.reading.contacts;
        let points = contacts.iter().flat_map(|c| line((c.point, &c.normal))).collect();
        panel.curves.push(FigureCurve { name: "palms".to_owned(), points, ..FigureCurve::default() });
    }
    vec![panel]
}
