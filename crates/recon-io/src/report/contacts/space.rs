//! A simulated motion in space, as its page shows it.

use super::moment::{Moment, Shown};
use super::picture::{Line, Picture, axes_of_space, per_newton};
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
    let newton = per_newton(1.0, instants.iter().flat_map(|now| &now.forces).map(|force| force.length()));
    Shown {
        caption: CAPTION,
        moments: instants.iter().map(moment).collect(),
        pictures: Shown::instants(instants).map(|now| picture(scene, now, newton)).collect(),
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
fn picture<S: SupportFunction>(scene: &ContactScene<S>, now: &ContactInstant, newton: f64) -> Picture {
    let (view, at) = (View::oblique(), &now.state.body);
    let reach = reach(scene.body());
    let before = |i: &usize| view.nearness(now.contacts[*i].p_WC) > view.nearness(at.p_WCm);
    let (front, back): (Vec<usize>, Vec<usize>) = (0..scene.palms().len()).partition(before);
    let palm = |i: usize| {
        let (surface, at, p_WC) = (scene.palms()[i].surface, now.palms[i], now.contacts[i].p_WC);
        palm(&view, i, &ShownPalm { surface, at, p_WC }, now.state.body.p_WCm, reach)
    };
    let mut lines: Vec<Line> = back.into_iter().map(palm).collect();
    lines.push(Line::new("object", view.outline(scene.body(), at)));
    lines.extend(view.meridians(scene.body(), at).into_iter().map(|points| Line::new("meridian", points)));
    lines.extend(front.into_iter().map(palm));
    lines.push(Line::centre(view.place(at.p_WCm)));
    for (i, mode) in now.modes.iter().enumerate().filter(|(_, mode)| **mode != ContactMode::Off) {
        let p_WC = view.place(now.contacts[i].p_WC);
        lines.push(Line::force(p_WC, view.place(now.forces[i]), newton * reach));
        lines.push(Line::touch(*mode, p_WC));
    }
    Picture { t: now.state.t, lines, axes: axes_of_space(&view) }
}

/// A palm as it is drawn.
pub(super) struct ShownPalm {
    pub(super) surface: PalmSurface,
    /// Its frame.
    pub(super) at: SurfaceState,
    /// The contact, or the point of the surface next to the object.
    pub(super) p_WC: DVec3,
}

/// The palm `i` (from 0) about an object with its centre in `p_WCm` and of the size `reach`.
pub(super) fn palm(view: &View, i: usize, shown: &ShownPalm, p_WCm: DVec3, reach: f64) -> Line {
    let ShownPalm { surface, at, p_WC } = shown;
    let centre = at.p_WP;
    let points = match *surface {
        PalmSurface::Plane => {
            // Under the object, wherever the origin of the plane's frame is.
            let n = at.R_WP.z_axis;
            let foot = p_WCm - n * n.dot(p_WCm - centre);
            let [a, b] = level_axes(n).map(|axis| BROAD * reach * axis);
            [a + b, b - a, -a - b, a - b, a + b].iter().map(|corner| view.place(foot + *corner)).collect()
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
