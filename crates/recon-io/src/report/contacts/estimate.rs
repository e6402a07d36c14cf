//! A motion that was estimated from contacts of any palms, as its page shows it.

use super::super::encode::thin;
use super::super::{Bounds, Evidence, MotionState, PalmContact, Verdict};
use super::estimate_page::doubtful_spans;
use super::moment::Shown;
use super::picture::{Line, Picture, axes_of_space, per_newton};
use super::space::{ShownPalm, palm};
use super::view::View;
use crate::planar_figures::{FigureCurve, FigurePanel};
use glam::{DVec2, DVec3};
use recon::contact_kinematics::SurfaceState;
use recon::object_dynamics::{ContactLog, ContactMode, LoggedPalm};
use recon::observer::ContactEstimate;
use recon::shape_bounds::planar::Hull;

/// Points of a contact curve that are drawn at most.
const TRACED: usize = 400;
/// Half the height of bands of uncertainty in standard deviations: 95 % of a normal variable lie within.
pub(in crate::report) const BAND: f64 = 1.96;
const AXES: [&str; 3] = ["x", "y", "z"];

/// Everything that is told about a motion that was estimated from contacts of any palms.
#[derive(Clone, Debug)]
pub struct EstimateData {
    /// What was reconstructed, such as the name of the log.
    pub title: String,
    /// How far the result can be relied on.
    pub verdict: Verdict,
    /// Why the log was taken for one of any palms, in one sentence.
    pub note: String,
    /// What was sensed.
    pub log: ContactLog,
    /// Motion, mass, inertia and contact modes.
    pub estimate: ContactEstimate,
    /// Contacts on the object of each palm at each sample whose motion is relied on: its contact curve.
    pub curves: Vec<Vec<Option<PalmContact>>>,
    /// True motion in the body axes of the estimate.
    pub truth: Option<Vec<MotionState>>,
    /// Bounds on the shape, in body axes.
    pub bounds: Option<Bounds>,
    /// Corners, edges and faces; none where the object is smooth as far as it was touched.
    pub marks: Option<ShapeMarks>,
    /// What the numbers rest on.
    pub evidence: Vec<Evidence>,
    /// What the reader must know, in plain words.
    pub warnings: Vec<String>,
    /// What to do next, in plain words.
    pub next: String,
}

/// What the page shows of a body that is not smooth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMarks {
    /// Key figures: name, value, unit.
    pub facts: Vec<(&'static str, String, &'static str)>,
    /// Views of the contacts, marked by what they are on.
    pub panels: Vec<FigurePanel>,
}

impl EstimateData {
    /// Whether everything has an entry at each sample.
    pub(super) fn fits(&self) -> bool {
        let (count, found) = (self.log.times().len(), &self.estimate);
        let lengths = [found.states.len(), found.deviations.len(), found.modes.len(), found.relied_on.len()];
        let curves = self.curves.iter().map(Vec::len).chain(self.truth.iter().map(Vec::len));
        let curves = curves.chain(found.mode_odds.iter().map(|modes| modes.odds.len()));
        count > 1
            && self.curves.len() == self.log.palms().len()
            && lengths.into_iter().chain(curves).all(|length| length == count)
    }

    /// Largest distance of a contact from the centre of mass, m: of those relied on, if there are any.
    fn reach(&self) -> f64 {
        let largest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
        let relied = largest(&mut self.curves.iter().flatten().flatten().map(|c| c.p_OC.length()));
        if relied > 0.0 {
            return relied;
        }
        let states = self.estimate.states.iter().enumerate();
        largest(&mut states.flat_map(|(k, state)| {
            let touches = self.log.palms().iter().filter_map(move |palm| palm.touch(k));
            touches.map(|touch| touch.p_WC.distance(state.p_WCm))
        }))
    }

    /// Object and palms at a few instants.
    pub(super) fn pictures(&self) -> Vec<Picture> {
        let samples: Vec<usize> = (0..self.log.times().len()).collect();
        let (reach, view) = (self.reach(), View::oblique());
        let palms = self.log.palms();
        let forces = samples.iter().flat_map(|&k| palms.iter().filter_map(move |palm| palm.force(k)));
        let newton = per_newton(reach, forces.map(|force| force.vector.length()));
        Shown::instants(&samples).map(|k| self.picture(*k, reach, newton, &view)).collect()
    }

    /// What is seen at sample `k`, from back to front.
    fn picture(&self, k: usize, reach: f64, newton: f64, view: &View) -> Picture {
        let p_WCm = self.estimate.states[k].p_WCm;
        let shown: Vec<ShownPalm> = self.log.palms().iter().map(|palm| shown(palm, k, p_WCm)).collect();
        let before = |i: &usize| view.nearness(shown[*i].p_WC) > view.nearness(p_WCm);
        let (front, back): (Vec<usize>, Vec<usize>) = (0..shown.len()).partition(before);
        let drawn = |i: usize| palm(view, i, &shown[i], p_WCm, reach);
        let mut lines: Vec<Line> = back.into_iter().map(drawn).collect();
        lines.extend(self.object(k, view));
        lines.extend(front.into_iter().map(drawn));
        lines.push(Line::centre(view.place(p_WCm)));
        for palm in self.log.palms() {
            if let (Some(touch), Some(force)) = (palm.touch(k), palm.force(k)) {
                lines.push(Line::force(view.place(touch.p_WC), view.place(force.vector), newton));
            }
        }
        for (i, mode) in self.estimate.modes[k].iter().enumerate() {
            let touch = self.log.palms().get(i).and_then(|palm| palm.touch(k));
            if let Some(touch) = touch.filter(|_| *mode != ContactMode::Off) {
                lines.push(Line::touch(*mode, view.place(touch.p_WC)));
            }
        }
        Picture { t: self.log.times()[k], lines, axes: axes_of_space(view) }
    }

    /// The silhouette of what the contacts span, and the contact curves where they are seen.
    fn object(&self, k: usize, view: &View) -> Vec<Line> {
        let state = &self.estimate.states[k];
        let placed = |contact: &PalmContact| view.place(state.p_WCm + state.R_WO * contact.p_OC);
        let seen = |contact: &PalmContact| view.nearness(state.R_WO * contact.normal) >= 0.0;
        let (mut all, mut traces): (Vec<DVec2>, Vec<Line>) = Default::default();
        for (i, curve) in self.curves.iter().enumerate() {
            let stride = curve.len().div_ceil(TRACED);
            let some: Vec<_> = curve.iter().step_by(stride).collect();
            all.extend(some.iter().filter_map(|contact| contact.as_ref()).map(placed));
            let gap = |contact: &&Option<PalmContact>| !contact.as_ref().is_some_and(seen);
            for piece in some.split(gap).filter(|piece| piece.len() > 1) {
                let points = piece.iter().filter_map(|contact| contact.as_ref()).map(placed).collect();
                traces.push(Line::new(&format!("trace p{}", i + 1), points));
            }
        }
        let hull = Hull::of(&all).ok();
        let outline = hull.as_ref().and_then(Hull::polygon).map(|polygon| {
            let corners = polygon.shape().vertices();
            Line::new("object", corners.iter().chain(corners.first()).copied().collect())
        });
        outline.into_iter().chain(traces).collect()
    }

    /// The panels of curves: estimates with their bands, truth dashed.
    pub(super) fn panels(&self) -> Vec<FigurePanel> {
        let kept = thin(self.log.times().len());
        let curves = |of: fn(&MotionState) -> DVec3, deviation: usize| -> Vec<FigureCurve> {
            let axis = |i: usize| {
                let at = |k: usize, state: &MotionState| [self.log.times()[k], of(state)[i]];
                let states = &self.estimate.states;
                FigureCurve {
                    name: AXES[i].to_owned(),
                    points: kept.iter().map(|&k| at(k, &states[k].into())).collect(),
                    half_heights: kept
                        .iter()
                        .map(|&k| BAND * self.estimate.deviations[k][deviation][i])
                        .collect(),
                    reference: self
                        .truth
                        .iter()
                        .flat_map(|truth| kept.iter().map(|&k| at(k, &truth[k])))
                        .collect(),
                    dots: false,
                }
            };
            (0..3).map(axis).collect()
        };
        let panel = |title: &str, unit: &str, curves| FigurePanel {
            title: title.to_owned(),
            axes: ["t in s".to_owned(), unit.to_owned()],
            curves,
            shaded: doubtful_spans(self.log.times(), &self.estimate.relied_on),
            ..FigurePanel::default()
        };
        let motion = [
            panel("Centre of mass", "m", curves(|s| s.p_WCm, 0)),
            panel("Velocity", "m/s", curves(|s| s.v_WCm, 1)),
            panel("Angular velocity", "rad/s", curves(|s| s.w_WO, 2)),
            panel("Turn since the start", "degrees", vec![self.turn(&kept)]),
            panel("Contact forces", "N", self.forces(&kept)),
        ];
        motion.into_iter().chain(self.marks.iter().flat_map(|marks| marks.panels.clone())).collect()
    }

    /// Size of the force of each palm; no number where it was not measured.
    fn forces(&self, kept: &[usize]) -> Vec<FigureCurve> {
        let size =
            |palm: &LoggedPalm, k: usize| palm.force(k).map_or(f64::NAN, |force| force.vector.length());
        let curve = |(i, palm): (usize, &LoggedPalm)| FigureCurve {
            name: format!("palm {}", i + 1),
            points: kept.iter().map(|&k| [self.log.times()[k], size(palm, k)]).collect(),
            ..FigureCurve::default()
        };
        self.log.palms().iter().enumerate().map(curve).collect()
    }

    /// Angle of the turn since the start; its band is that of the axis that is known worst.
    fn turn(&self, kept: &[usize]) -> FigureCurve {
        let times = self.log.times();
        let states = &self.estimate.states;
        let angle = |k: usize| states[0].R_WO.angle_between(states[k].R_WO).to_degrees();
        let wide = |k: usize| BAND * self.estimate.deviations[k][3].max_element().to_degrees();
        let truth = self.truth.iter().flat_map(|truth| {
            kept.iter().map(|&k| [times[k], truth[0].R_WO.angle_between(truth[k].R_WO).to_degrees()])
        });
        FigureCurve {
            name: "object".to_owned(),
            points: kept.iter().map(|&k| [times[k], angle(k)]).collect(),
            half_heights: kept.iter().map(|&k| wide(k)).collect(),
            reference: truth.collect(),
            dots: false,
        }
    }
}

fn shown(palm: &recon::object_dynamics::LoggedPalm, k: usize, p_WCm: DVec3) -> ShownPalm {
    let at: SurfaceState = palm.motion(k).pose.at_rest();
    let next = || palm.surface().nearest(at.to_palm(p_WCm)).map_or(at.p_WP, |point| at.to_world(point.p_P));
    let p_WC = palm.touch(k).map_or_else(next, |touch| touch.p_WC);
    ShownPalm { surface: palm.surface(), at, p_WC }
}
