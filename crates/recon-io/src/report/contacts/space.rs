//! A simulated motion in space, as its page shows it.

use super::moment::{Moment, Shown};
use super::picture::{ForceScale, Line, Picture, Pictures, axes_of_space};
use super::spans::mode_spans;
use super::view::View;
use glam::DVec3;
use recon::contact_kinematics::{PalmSurface, SupportFunction, SurfaceState};
use recon::object_dynamics::{ContactInstant, ContactMode, ContactScene, ContactSimulation};
use std::f64::consts::TAU;

/// Half the width of a flat palm, and half the length of a cylinder, in sizes of the object.
const BROAD: f64 = 1.15;
/// Half of the angle over which a cup is drawn, rad.
const CUP: f64 = 1.2;
const CAPTION: &str = "Seen obliquely from above, to one scale. Coloured dots are contacts, also those behind the object, in the colours of the modes below, arrows their forces; the other dot is the centre of mass, g gravity; lines on the object turn with it. Flat palms go on beyond what is drawn.";

/// What the page is made of.
pub(super) fn shown<S: SupportFunction>(scene: &ContactScene<S>, simulation: &ContactSimulation) -> Shown {
    let instants = &simulation.instants;
    let first = instants.first().map(|now| now.state.body.R_WO);
    let moment = |now: &ContactInstant| Moment {
        t: now.state.t,
        forces: now.forces.iter().zip(&now.contacts).map(|(force, contact)| force.dot(contact.n)).collect(),
        slips: (0..now.modes.len()).map(|i| slip(now, i)).collect(),
        energy: scene.energy(&now.state.body),
        works: [now.palm_work, now.friction_work, now.blow_work],
        turn: first.map_or(0.0, |first| first.angle_between(now.state.body.R_WO)),
    };
    // In sizes of the object.
    let scale = ForceScale::new(1.0, instants.iter().flat_map(|now| &now.forces).map(|force| force.length()));
    let planes = scene.palms().iter().zip(instants.first().into_iter().flat_map(|now| &now.palms));
    let view = View::onto(&normals(planes.map(|(palm, at)| (palm.surface, at))));
    Shown {
        caption: CAPTION,
        moments: instants.iter().map(moment).collect(),
        pictures: Pictures::of(instants, |now| picture(scene, now, (scale, &view))),
        spans: (0..scene.palms().len()).map(|palm| mode_spans(simulation, palm)).collect(),
        changes: simulation.events.len(),
    }
}

/// Speed of the object over the material of a palm that it touches, m/s; no number where it does not touch.
fn slip(now: &ContactInstant, palm: usize) -> f64 {
    match now.modes[palm] {
        ContactMode::Off => f64::NAN,
        // What rounding leaves of it is no slip.
        ContactMode::Stick => 0.0,
        ContactMode::Slide => now.contacts[palm].in_tangent(now.rates[palm].slip).length(),
    }
}

/// What is seen at an instant, from back to front.
fn picture<S: SupportFunction>(
    scene: &ContactScene<S>,
    now: &ContactInstant,
    (scale, view): (ForceScale, &View),
) -> Picture {
    let at = &now.state.body;
    let reach = reach(scene.body());
    let shown = scene.palms().iter().zip(&now.palms).zip(&now.contacts);
    let shown =
        shown.map(|((palm, at), contact)| ShownPalm { surface: palm.surface, at: *at, p_WC: contact.p_WC });
    let shown: Vec<ShownPalm> = shown.collect();
    let (mut lines, front) = palms(view, &shown, at.p_WCm, reach);
    lines.push(Line::new("object", view.outline(scene.body(), at)));
    lines.extend(view.meridians(scene.body(), at).into_iter().map(|points| Line::new("meridian", points)));
    lines.extend(front);
    lines.push(Line::centre(view.place(at.p_WCm)));
    for (i, mode) in now.modes.iter().enumerate().filter(|(_, mode)| **mode != ContactMode::Off) {
        let p_WC = view.place(now.contacts[i].p_WC);
        lines.push(Line::force(p_WC, view.place(now.forces[i]), scale.times(reach)));
        lines.push(Line::touch(*mode, p_WC));
    }
    Picture { t: now.state.t, lines, axes: axes_of_space(view) }
}

/// A palm as it is drawn.
pub(super) struct ShownPalm {
    pub(super) surface: PalmSurface,
    /// Its frame.
    pub(super) at: SurfaceState,
    /// The contact, or the point of the surface next to the object.
    pub(super) p_WC: DVec3,
}

/// Normals of those surfaces that are planes.
pub(super) fn normals<'a>(surfaces: impl Iterator<Item = (PalmSurface, &'a SurfaceState)>) -> Vec<DVec3> {
    let plane = |(surface, at): (PalmSurface, &SurfaceState)| {
        matches!(surface, PalmSurface::Plane).then_some(at.R_WP.z_axis)
    };
    surfaces.filter_map(plane).collect()
}

/// The palms about an object with its centre in `p_WCm` and of the size `reach`: those behind it, and those before it.
pub(super) fn palms(view: &View, shown: &[ShownPalm], p_WCm: DVec3, reach: f64) -> (Vec<Line>, Vec<Line>) {
    let before = |i: &usize| match shown[*i].surface {
        // Its front is turned away.
        PalmSurface::Plane => view.nearness(shown[*i].at.R_WP.z_axis) < 0.0,
        _ => view.nearness(shown[*i].p_WC) > view.nearness(p_WCm),
    };
    let (front, back): (Vec<usize>, Vec<usize>) = (0..shown.len()).partition(before);
    let line = |i: usize| palm(view, i, shown, p_WCm, reach);
    (back.into_iter().map(line).collect(), front.into_iter().map(|i| line(i).in_front()).collect())
}

/// The palm `i` (from 0) about an object with its centre in `p_WCm` and of the size `reach`.
fn palm(view: &View, i: usize, all: &[ShownPalm], p_WCm: DVec3, reach: f64) -> Line {
    let ShownPalm { surface, at, p_WC } = &all[i];
    let centre = at.p_WP;
    let points = match *surface {
        PalmSurface::Plane => {
            // Under the object, wherever the origin of the plane's frame is.
            let n = at.R_WP.z_axis;
            let foot = p_WCm - n * n.dot(p_WCm - centre);
            let [a, b] = level_axes(n).map(|axis| BROAD * reach * axis);
            let mut corners = [a + b, b - a, -a - b, a - b].map(|corner| foot + corner).to_vec();
            let others =
                all.iter().enumerate().filter(|(j, other)| *j != i && other.surface == PalmSurface::Plane);
            for (_, other) in others {
                corners = within(&corners, other.at.R_WP.z_axis, other.at.p_WP);
            }
            corners.extend(corners.first().copied());
            corners.into_iter().map(|corner| view.place(corner)).collect()
        }
        PalmSurface::Sphere { radius } => view.arc(centre, radius, [0.0, TAU]),
        PalmSurface::Cup { radius } => {
            let outwards = view.place(*p_WC - centre);
            let middle = outwards.y.atan2(outwards.x);
            view.arc(centre, radius, [middle - CUP, middle + CUP])
        }
        PalmSurface::Cylinder { radius } => {
            let along = at.R_WP.x_axis;
            let middle = centre + along * along.dot(p_WCm - centre);
            let half = view.place(BROAD * reach * along);
            let side = radius * half.perp().normalize_or(glam::DVec2::X);
            let m = view.place(middle);
            vec![m + half + side, m - half + side, m - half - side, m + half - side, m + half + side]
        }
    };
    Line::palm(i, matches!(surface, PalmSurface::Cup { .. }), points)
}

/// The part of a convex polygon on the side of a plane through `p` to which its normal `n` points (Sutherland and Hodgman, 1974).
fn within(corners: &[DVec3], n: DVec3, p: DVec3) -> Vec<DVec3> {
    let mut kept = Vec::new();
    for (k, &from) in corners.iter().enumerate() {
        let to = corners[(k + 1) % corners.len()];
        let [a, b] = [from, to].map(|corner| n.dot(corner - p));
        if a >= 0.0 {
            kept.push(from);
        }
        if (a < 0.0) != (b < 0.0) {
            kept.push(from + (to - from) * (a / (a - b)));
        }
    }
    kept
}

/// Axes of a plane with the normal `n`: a level one and one that rises.
fn level_axes(n: DVec3) -> [DVec3; 2] {
    let level = DVec3::Z.cross(n).try_normalize().unwrap_or(DVec3::X);
    [level, n.cross(level)]
}

/// Largest extent of a body from its centre of mass along its axes, m.
fn reach<S: SupportFunction>(body: &S) -> f64 {
    use recon::contact_kinematics::Direction;
    let axes = [Direction::X, Direction::Y, Direction::Z];
    axes.into_iter().flat_map(|u| [body.value(u), body.value(-u)]).fold(0.0, f64::max)
}
