//! A simulated motion in the plane, as its page shows it.

use super::moment::{Moment, Shown};
use super::picture::{ForceScale, Line, Picture, Pictures, axes_of_plane};
use super::spans::planar_mode_spans;
use glam::DVec2;
use recon::contact_kinematics::planar::{PalmSurface, RadiusFunction};
use recon::object_dynamics::ContactMode;
use recon::object_dynamics::planar::{ContactInstant, ContactScene, ContactSimulation};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Half the length of a line that is drawn, in sizes of the object.
const LONG: f64 = 1.5;
/// The same of an arc, which shows where the object goes.
const WIDE: f64 = 12.0;
/// Points of an outline.
const POINTS: u32 = 192;
const CAPTION: &str = "To one scale. Coloured dots are contacts, in the colours of the modes below, arrows their forces; the other dot is the centre of mass, g gravity; the cross on the object turns with it. Palms go on beyond what is drawn, but for circles.";

/// What the page is made of.
pub(super) fn shown<S: RadiusFunction>(scene: &ContactScene<S>, simulation: &ContactSimulation) -> Shown {
    let instants = &simulation.instants;
    let first = instants.first().map_or(0.0, |now| now.body.phi0);
    let moment = |now: &ContactInstant| Moment {
        t: now.t,
        forces: now.forces.iter().zip(&now.contacts).map(|(force, contact)| force.dot(contact.n)).collect(),
        slips: (0..now.modes.len()).map(|i| slip(now, i)).collect(),
        energy: energy(scene, now),
        works: [now.palm_work, now.friction_work, now.blow_work],
        turn: now.body.phi0 - first,
    };
    // In sizes of the object.
    let scale = ForceScale::new(1.0, instants.iter().flat_map(|now| &now.forces).map(|force| force.length()));
    Shown {
        caption: CAPTION,
        moments: instants.iter().map(moment).collect(),
        pictures: Pictures::of(instants, |now| picture(scene, now, scale)),
        spans: (0..scene.palms().len()).map(|palm| planar_mode_spans(simulation, palm)).collect(),
        changes: simulation.events.len(),
    }
}

/// Kinetic and potential energy, J.
fn energy<S: RadiusFunction>(scene: &ContactScene<S>, now: &ContactInstant) -> f64 {
    let (object, body) = (scene.object(), &now.body);
    let (mass, inertia) = (object.mass.mass(), object.mass.inertia());
    let kinetic = 0.5 * (mass * body.v_WCm.length_squared() + inertia * body.omega0.powi(2));
    kinetic + mass * object.gravity * body.p_WCm.y
}

/// Speed of the object over the material of a palm that it touches, m/s; no number where it does not touch.
fn slip(now: &ContactInstant, palm: usize) -> f64 {
    match now.modes[palm] {
        ContactMode::Off => f64::NAN,
        // What rounding leaves of it is no slip.
        ContactMode::Stick => 0.0,
        ContactMode::Slide => now.slip(palm).dot(now.contacts[palm].t).abs(),
    }
}

fn picture<S: RadiusFunction>(scene: &ContactScene<S>, now: &ContactInstant, scale: ForceScale) -> Picture {
    let (shape, body) = (&scene.object().shape, &now.body);
    let turn = DVec2::from_angle(body.phi0);
    let at = |theta: f64| body.p_WCm + turn.rotate(shape.point(theta));
    let outline: Vec<DVec2> = around(0.0, TAU).map(at).collect();
    let reach = outline.iter().map(|p| p.distance(body.p_WCm)).fold(0.0, f64::max);
    let surfaces = scene.palms().iter().map(|palm| palm.surface).enumerate();
    let drawn = |(i, surface): (usize, PalmSurface)| {
        let (state, contact) = (&now.palms[i], &now.contacts[i]);
        let at = PalmAt { p_WP: state.p_WP, angle: state.angle, p_WC: contact.p_WC };
        palm(surface, i, &at, body.p_WCm, reach)
    };
    let mut lines: Vec<Line> = surfaces.map(drawn).collect();
    lines.push(Line::new("object", outline));
    let across = |theta| Line::new("meridian", vec![at(theta), at(theta + PI)]);
    lines.extend([0.0, FRAC_PI_2].map(across));
    lines.push(Line::centre(body.p_WCm));
    let arrow = |i: usize| Line::force(now.contacts[i].p_WC, now.forces[i], scale.times(reach));
    lines.extend((0..now.forces.len()).filter(|i| now.modes[*i] != ContactMode::Off).map(arrow));
    let touching = now.modes.iter().zip(&now.contacts).filter(|(mode, _)| **mode != ContactMode::Off);
    lines.extend(touching.map(|(mode, contact)| Line::touch(*mode, contact.p_WC)));
    Picture { t: now.t, lines, axes: axes_of_plane() }
}

/// A palm at an instant: where its frame stands, and where it is touched or next to the object.
pub(super) struct PalmAt {
    pub(super) p_WP: DVec2,
    /// rad.
    pub(super) angle: f64,
    pub(super) p_WC: DVec2,
}

/// The palm `i` (from 0) under an object of the size `reach`, m.
pub(super) fn palm(surface: PalmSurface, i: usize, at: &PalmAt, p_WCm: DVec2, reach: f64) -> Line {
    let PalmAt { p_WP, angle, p_WC } = *at;
    // Of a large circle the part next to the contact, else all of it.
    let arc = |radius: f64| {
        let (half, middle) = (PI.min(WIDE * reach / radius), (p_WC - p_WP).to_angle());
        let at = |angle| p_WP + radius * DVec2::from_angle(angle);
        around(middle - half, middle + half).map(at).collect()
    };
    match surface {
        PalmSurface::Line => {
            // Under the object, wherever the origin of the line's frame is.
            let along = DVec2::from_angle(angle);
            let foot = p_WP + along * along.dot(p_WCm - p_WP);
            let half = LONG * reach * along;
            Line::palm(i, true, vec![foot - half, foot + half])
        }
        PalmSurface::Arc { radius } => Line::palm(i, WIDE * reach < PI * radius, arc(radius)),
        PalmSurface::Cup { radius } => Line::palm(i, true, arc(radius)),
    }
}

/// Angles from one to another.
fn around(from: f64, to: f64) -> impl Iterator<Item = f64> {
    (0..=POINTS).map(move |k| from + (to - from) * f64::from(k) / f64::from(POINTS))
}
