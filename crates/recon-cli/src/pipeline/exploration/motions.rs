//! What is told of palms that turn, motion by motion.

use super::page::{in_turn, measured, outline_panel, quantity};
use super::plane::{InPlane, lower, upper};
use super::rolling::Ended;
use super::side::Side;
use glam::DVec2;
use recon::exploration::planar::PlanarKnowledge;
use recon::exploration::rolling::{Prediction, RollStep, SensedStep};
use recon::exploration::{Knowledge, Measures, Reason};
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::ContactSample;
use recon_io::{
    ExplorationPage, ExplorationWords, FigureCurve, FigurePanel, Level, TouchRow, Verdict, brief_to,
};
use serde_json::{Value, json};

/// Contacts that a picture shows at most, or somewhat more.
const SHOWN: usize = 150;

/// One motion, from what was felt at the end of it.
struct Motion {
    last: Told,
    /// Turns of both palms, rad.
    turned: f64,
    gained: f64,
    /// Share of the upper bound that it was expected to bring.
    expected: Option<f64>,
    falls: usize,
}

/// The course of it.
#[derive(Default)]
pub(super) struct Motions {
    motions: Vec<Motion>,
    /// Radians of palm motion, gap and areas after each reading.
    course: Vec<[f64; 4]>,
    /// Pictures after each motion.
    pictures: Vec<Vec<FigurePanel>>,
    pub(super) radians: f64,
    pub(super) seconds: f64,
}

/// What is told of a reading, or of a motion with all that was sensed of it.
#[derive(Clone, Debug)]
pub(super) struct Told {
    motion: usize,
    why: Option<(Reason, Option<Prediction>)>,
    palms: [f64; 2],
    /// Contacts on the palms, m from the hinge, and in the frame of the object.
    contacts: Option<([f64; 2], [ContactSample; 2])>,
    fell: bool,
    radians: f64,
    seconds: f64,
    progress: f64,
    doubt: Option<String>,
    deviations: Option<[f64; 2]>,
}

impl Told {
    pub(super) fn of(step: &RollStep) -> Self {
        let RollStep { motion, why, reading, radians, seconds, progress } = *step;
        let contacts = Some((reading.s, reading.contacts));
        let (palms, fell) = (reading.palms, reading.fell);
        Self { motion, why, palms, contacts, fell, radians, seconds, progress, doubt: None, deviations: None }
    }

    pub(super) fn sensed(step: &SensedStep) -> Self {
        let SensedStep { motion, why, palms, radians, seconds, doubt, progress, deviations } = step.clone();
        Self {
            motion,
            why,
            palms,
            contacts: None,
            fell: false,
            radians,
            seconds,
            progress,
            doubt,
            deviations,
        }
    }
}

impl Motions {
    /// After another one; nothing is known where an estimate is not relied on.
    pub(super) fn take(&mut self, step: &Told, known: Option<&PlanarKnowledge>) {
        let measures = known.map_or(Measures::NOTHING, Knowledge::measures);
        let before = self.course.last().map_or(f64::INFINITY, |[_, progress, ..]| *progress);
        self.course.push([step.radians, step.progress, measures.lower, measures.upper]);
        let turned = step.radians - self.radians;
        (self.radians, self.seconds) = (step.radians, step.seconds);
        let pictures = known.map(|known| pictures(known, Some(step)));
        let gained = before - step.progress;
        let same = |motion: &&mut Motion| motion.last.motion == step.motion;
        let going_on = match self.motions.last_mut().filter(same) {
            Some(motion) => {
                motion.turned += turned;
                motion.gained += gained;
                motion.falls += usize::from(step.fell);
                motion.last = step.clone();
                true
            }
            None => {
                let area = step.why.and_then(|(_, prediction)| Some(prediction?.gain));
                let expected = area.filter(|_| measures.upper.is_finite()).map(|area| area / measures.upper);
                let falls = usize::from(step.fell);
                self.motions.push(Motion { last: step.clone(), turned, gained, expected, falls });
                false
            }
        };
        if going_on {
            self.pictures.pop();
        }
        self.pictures.extend(pictures);
    }

    /// Motions, without the start.
    pub(super) fn count(&self) -> usize {
        self.motions.len().saturating_sub(1)
    }

    pub(super) fn figures(&self) -> Vec<Value> {
        self.motions.iter().map(Motion::figures).collect()
    }

    pub(super) fn page(self, end: &Ended<'_>, known: &PlanarKnowledge) -> ExplorationPage {
        let (certificate, asked) = (end.certificate, end.goal.value());
        let level = if end.reached { Level::Good } else { Level::Caution };
        let measures = known.measures();
        let falls: usize = self.motions.iter().map(|motion| motion.falls).sum();
        // Of what is estimated contacts are told by the bounds alone, and falls are motions like others.
        let felt = self.motions.iter().any(|motion| motion.last.contacts.is_some());
        let mut facts = vec![
            ("Motions", self.count().to_string(), ""),
            ("Palms turned", brief_to(3, self.radians), "rad"),
            ("Time", brief_to(3, self.seconds), "s"),
            ("Contacts taken", certificate.touches.to_string(), ""),
            measured("Proven", certificate.proven, ""),
            ("Asked for", brief_to(4, asked), ""),
            measured("Lower bound", measures.lower, InPlane::UNIT),
            measured("Upper bound", measures.upper, InPlane::UNIT),
        ];
        if felt {
            facts.insert(3, ("Falls", falls.to_string(), ""));
        } else if let Some([place, turn]) =
            self.motions.iter().rev().find_map(|motion| motion.last.deviations)
        {
            facts.push((
                "Object known to",
                format!("{} m, {}", brief_to(2, place), brief_to(2, turn)),
                "rad",
            ));
        }
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
        let last = self.motions.last().map(|motion| &motion.last);
        panels.extend(in_turn(pictures(known, last), self.pictures, "after motion"));
        ExplorationPage {
            words: ExplorationWords::MOTIONS,
            title: end.title.to_owned(),
            verdict: Verdict { level, text: end.statement.clone() },
            facts,
            progress: quantity(&certificate.goal).to_owned(),
            panels,
            caption: caption(felt),
            touches: self.motions.iter().map(Motion::row).collect(),
        }
    }
}

/// What the panels show.
fn caption(felt: bool) -> String {
    let palms =
        if felt { "; lines through two of them: the palms, as the body sees them" } else { ", some of them" };
    format!("The body lies between the bounds. Strokes: contacts with their outward normals{palms}.")
}

impl Motion {
    fn why(&self) -> &'static str {
        self.last.why.map_or("felt at the start", |(reason, _)| reason.words())
    }

    fn row(&self) -> TouchRow {
        TouchRow {
            touch: Some(self.last.motion),
            why: self.why().to_owned(),
            along: self.last.palms.to_vec(),
            point: self.last.contacts.map(|(s, _)| s.to_vec()),
            turned: self.turned,
            expected: self.expected,
            gained: Some(self.gained).filter(|g| g.is_finite()),
            progress: Some(self.last.progress).filter(|p| p.is_finite()),
        }
    }

    fn figures(&self) -> Value {
        let Told { motion, palms, contacts, radians, seconds, progress, doubt, deviations, .. } = &self.last;
        let mut figures = json!({
            "motion": motion,
            "why": self.why(),
            "palms_rad": palms,
            "radians": radians,
            "seconds": seconds,
        });
        if let Some((s, _)) = contacts {
            figures["contacts_m"] = json!(s);
            figures["falls"] = self.falls.into();
        }
        if let Some(doubt) = doubt {
            figures["not_relied_on"] = doubt.as_str().into();
        }
        if let Some([place, turn]) = deviations {
            figures["std_place_m"] = (*place).into();
            figures["std_turn_rad"] = (*turn).into();
        }
        let gained = Some(self.gained).filter(|g| g.is_finite());
        let left = Some(*progress).filter(|p| p.is_finite());
        for (key, value) in [("expected", self.expected), ("gained", gained), ("left", left)] {
            if let Some(value) = value {
                figures[key] = value.into();
            }
        }
        figures
    }
}

/// The bounds with the contacts, and the palms as the body sees them.
fn pictures(known: &PlanarKnowledge, step: Option<&Told>) -> Vec<FigurePanel> {
    let flat = |corners: Vec<DVec2>| corners.iter().map(DVec2::to_array).collect::<Vec<_>>();
    let every = known.contacts().len().div_ceil(SHOWN).max(1);
    let shown = known.contacts().iter().step_by(every);
    let contacts = shown.map(|c| (c.point.to_array(), c.normal.get().to_array())).collect();
    let outlines = [flat(lower(known)), flat(upper(known))];
    let mut panel = outline_panel("Contacts", ["x", "y"], outlines, contacts, None);
    let (low, high) = lower(known)
        .iter()
        .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(*p), high.max(*p)));
    let half = 0.5 * (high - low).max_element();
    if let Some((_, felt)) = step.and_then(|step| step.contacts).filter(|_| half.is_finite()) {
        let line = |(point, normal): (DVec2, &Direction)| {
            let along = normal.get().perp() * half;
            [(point - along).to_array(), (point + along).to_array(), [f64::NAN; 2]]
        };
        let points = felt.iter().flat_map(|c| line((c.point, &c.normal))).collect();
        panel.title += " and palms";
        panel.curves.push(FigureCurve { name: "palms".to_owned(), points, ..FigureCurve::default() });
    }
    vec![panel]
}
