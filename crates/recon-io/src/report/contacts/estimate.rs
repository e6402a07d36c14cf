//! A motion that was estimated from contacts of any palms, as its page shows it.

use super::super::page::Fact;
use super::super::{Bounds, Evidence, MotionState, PalmContact, TrueShape, Verdict};
use super::picture::{ForceScale, Line, Picture, Pictures, axes_of_space};
use super::space::{ShownPalm, normals, palms};
use super::view::View;
use crate::planar_figures::FigurePanel;
use glam::{DVec2, DVec3};
use recon::contact_kinematics::SurfaceState;
use recon::object_dynamics::{ContactLog, ContactMode, LoggedPalm};
use recon::observer::contacts::ContactEstimate;
use recon::shape_bounds::exact_hull::planar::Hull;

/// Points of a contact curve that are drawn at most.
const TRACED: usize = 200;

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
    /// The true shape, in body axes.
    pub true_shape: Option<TrueShape>,
    /// Key figures of corners, edges and faces, where the object is not smooth as far as it was touched.
    pub marks: Vec<Fact>,
    /// Views of the bounds, and of what is not smooth.
    pub shape: Vec<FigurePanel>,
    /// Noise of the forces: a fixed standard deviation in N, and one as a share of the force.
    pub force_noise: [f64; 2],
    /// What the numbers rest on.
    pub evidence: Vec<Evidence>,
    /// What was modelled and what was left out, where an accuracy was wanted.
    pub least_model: Vec<Evidence>,
    /// What the reader must know, in plain words.
    pub warnings: Vec<String>,
    /// What to do next, in plain words.
    pub next: String,
}

/// What the page shows of a body that is not smooth.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMarks {
    /// Key figures: name, value, unit.
    pub facts: Vec<Fact>,
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

    /// Where the object is at sample `k`: its centre of mass, and where no motion is relied on the mean of all contacts.
    fn about(&self, k: usize, unknown: Option<DVec3>) -> DVec3 {
        unknown.unwrap_or(self.estimate.states[k].p_WCm)
    }

    /// The mean of all contacts, world axes, where no motion is relied on.
    fn unknown(&self) -> Option<DVec3> {
        if self.estimate.relied_on.contains(&true) {
            return None;
        }
        let (sum, count) =
            self.touches().fold((DVec3::ZERO, 0.0), |(sum, count), (_, p_WC)| (sum + p_WC, count + 1.0));
        (count > 0.0).then(|| sum / count)
    }

    /// Samples and contacts there, world axes.
    fn touches(&self) -> impl Iterator<Item = (usize, DVec3)> {
        let of = |palm: &'_ LoggedPalm| {
            let touch = |k: usize| Some((k, palm.touch(k)?.p_WC));
            (0..self.log.times().len()).filter_map(touch).collect::<Vec<_>>()
        };
        self.log.palms().iter().flat_map(of)
    }

    /// Largest distance of a contact from where the object is, m: of those relied on, if there are any.
    fn reach(&self, unknown: Option<DVec3>) -> f64 {
        let largest = |lengths: &mut dyn Iterator<Item = f64>| lengths.fold(0.0, f64::max);
        let relied = largest(&mut self.curves.iter().flatten().flatten().map(|c| c.p_OC.length()));
        if relied > 0.0 {
            return relied;
        }
        largest(&mut self.touches().map(|(k, p_WC)| p_WC.distance(self.about(k, unknown))))
    }

    /// Object and palms at a few instants.
    pub(super) fn pictures(&self) -> Pictures {
        let samples: Vec<usize> = (0..self.log.times().len()).collect();
        let palms = self.log.palms();
        let first: Vec<_> =
            palms.iter().map(|palm| (palm.surface(), palm.motion(0).pose.at_rest())).collect();
        let view = View::onto(&normals(first.iter().map(|(surface, at)| (*surface, at))));
        let unknown = self.unknown();
        let reach = self.reach(unknown);
        let forces = samples.iter().flat_map(|&k| palms.iter().filter_map(move |palm| palm.force(k)));
        let scale = ForceScale::new(reach, forces.map(|force| force.vector.length()));
        Pictures::of(&samples, |k| self.picture(*k, unknown, (reach, scale), &view))
    }

    /// What is seen at sample `k`, from back to front.
    fn picture(
        &self,
        k: usize,
        unknown: Option<DVec3>,
        (reach, scale): (f64, ForceScale),
        view: &View,
    ) -> Picture {
        let about = self.about(k, unknown);
        let shown: Vec<ShownPalm> = self.log.palms().iter().map(|palm| shown(palm, k, about)).collect();
        let (mut lines, front) = palms(view, &shown, about, reach);
        lines.extend(self.paths(k, reach, view));
        let object = if unknown.is_none() { self.object(k, reach, view) } else { Vec::new() };
        lines.extend(object);
        lines.extend(front);
        lines.extend(unknown.is_none().then(|| Line::centre(view.place(about))));
        for palm in self.log.palms() {
            if let (Some(touch), Some(force)) = (palm.touch(k), palm.force(k)) {
                lines.push(Line::force(view.place(touch.p_WC), view.place(force.vector), scale));
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

    /// Where the palms were touched until sample `k`, moved with them.
    fn paths(&self, k: usize, reach: f64, view: &View) -> Vec<Line> {
        let stride = self.log.times().len().div_ceil(TRACED);
        let path = |(i, palm): (usize, &LoggedPalm)| {
            let now = palm.motion(k).pose.at_rest();
            let place = |j: usize| {
                let touch = palm.touch(j)?;
                Some(view.place(now.to_world(palm.motion(j).pose.at_rest().to_palm(touch.p_WC))))
            };
            Line::through(&format!("path p{}", i + 1), (0..=k).step_by(stride).map(place), reach)
        };
        self.log.palms().iter().enumerate().filter_map(path).collect()
    }

    /// The silhouette of what the contacts span, and the contact curves where they are seen.
    fn object(&self, k: usize, reach: f64, view: &View) -> Vec<Line> {
        let state = &self.estimate.states[k];
        let placed = |contact: &PalmContact| view.place(state.p_WCm + state.R_WO * contact.p_OC);
        let seen = |contact: &PalmContact| view.nearness(state.R_WO * contact.normal) >= 0.0;
        let (mut all, mut traces): (Vec<DVec2>, Vec<Line>) = Default::default();
        for (i, curve) in self.curves.iter().enumerate() {
            let stride = curve.len().div_ceil(TRACED);
            let some: Vec<_> = curve.iter().step_by(stride).collect();
            all.extend(some.iter().filter_map(|contact| contact.as_ref()).map(placed));
            let places = some.iter().map(|contact| contact.as_ref().filter(|c| seen(c)).map(placed));
            traces.extend(Line::through(&format!("trace p{}", i + 1), places, reach));
        }
        let shape = self.true_shape.iter().flat_map(|shape| &shape.mesh.vertices);
        let shape: Vec<DVec2> = shape.map(|p| view.place(state.p_WCm + state.R_WO * *p)).collect();
        outline("object", &all).into_iter().chain(traces).chain(outline("true", &shape)).collect()
    }
}

/// The line around points; none of points on a line.
pub(super) fn outline(class: &str, points: &[DVec2]) -> Option<Line> {
    let hull = Hull::of(points).ok()?;
    let corners = hull.polygon()?.shape().vertices();
    Some(Line::new(class, corners.iter().chain(corners.first()).copied().collect()))
}

fn shown(palm: &LoggedPalm, k: usize, about: DVec3) -> ShownPalm {
    let at: SurfaceState = palm.motion(k).pose.at_rest();
    let next = || palm.surface().nearest(at.to_palm(about)).map_or(at.p_WP, |point| at.to_world(point.p_P));
    let p_WC = palm.touch(k).map_or_else(next, |touch| touch.p_WC);
    ShownPalm { surface: palm.surface(), at, p_WC }
}
