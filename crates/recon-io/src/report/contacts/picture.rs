//! Object and palms as they are at a few instants.

use super::view::View;
use crate::number::on_scale;
use glam::{DVec2, DVec3};
use recon::contact_kinematics::{PalmSurface, SupportFunction};
use recon::object_dynamics::{ContactInstant, ContactMode, ContactScene};
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Half the width of a flat palm, and half the length of a cylinder, in sizes of the object.
const BROAD: f64 = 1.15;
/// Half of the angle over which a cup is drawn, rad.
const CUP: f64 = 1.2;
/// Width of a picture, px.
const WIDTH: f64 = 290.0;
const MARGIN: f64 = 6.0;

/// A line of a picture, in m on the plane of view.
struct Line {
    class: String,
    points: Vec<DVec2>,
}

/// Pictures of instants beside each other, all to one scale, as SVG elements.
pub(super) fn pictures<S: SupportFunction>(scene: &ContactScene<S>, instants: &[&ContactInstant]) -> String {
    let drawn: Vec<Vec<Line>> = instants.iter().map(|now| lines(scene, now)).collect();
    let points = || drawn.iter().flatten().flat_map(|line| &line.points);
    let low = points().fold(DVec2::INFINITY, |low, p| low.min(*p));
    let high = points().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
    let scale = (WIDTH - 2.0 * MARGIN) / (high - low).x.max(f64::MIN_POSITIVE);
    let height = scale * (high - low).y + 2.0 * MARGIN;
    let place = |p: DVec2| {
        let at = [MARGIN + scale * (p.x - low.x), MARGIN + scale * (high.y - p.y)];
        at.map(|v| on_scale(v, 100.0, 3))
    };
    let mut out = String::new();
    for (now, lines) in instants.iter().zip(&drawn) {
        let _ = writeln!(
            out,
            "<figure class=\"instant\"><svg viewBox=\"0 0 {WIDTH} {}\" role=\"img\">",
            on_scale(height, 100.0, 3)
        );
        for line in lines {
            let places: Vec<String> =
                line.points.iter().map(|p| place(*p)).map(|[x, y]| format!("{x} {y}")).collect();
            // A line without length under a round cap is a dot.
            let _ = writeln!(out, "<path class=\"{}\" d=\"M{}\"/>", line.class, places.join(" L"));
        }
        let _ =
            writeln!(out, "</svg><figcaption>t = {} s</figcaption></figure>", on_scale(now.state.t, 1.0, 3));
    }
    out
}

/// What is seen at an instant, from back to front.
fn lines<S: SupportFunction>(scene: &ContactScene<S>, now: &ContactInstant) -> Vec<Line> {
    let (view, at) = (View::oblique(), &now.state.body);
    let reach = reach(scene.body());
    let before = |i: &usize| view.nearness(now.contacts[*i].p_WC) > view.nearness(at.p_WCm);
    let (front, back): (Vec<usize>, Vec<usize>) = (0..scene.palms().len()).partition(before);
    let palm = |i: usize| palm(&view, scene.palms()[i].surface, now, i, reach);
    let mut lines: Vec<Line> = back.into_iter().map(palm).collect();
    lines.push(Line { class: "object".to_owned(), points: view.outline(scene.body(), at) });
    let meridians = view.meridians(scene.body(), at).into_iter();
    lines.extend(meridians.map(|points| Line { class: "meridian".to_owned(), points }));
    lines.extend(front.into_iter().map(palm));
    for (i, mode) in now.modes.iter().enumerate().filter(|(_, mode)| **mode != ContactMode::Off) {
        let c = view.place(now.contacts[i].p_WC);
        lines.push(Line { class: format!("touch m{}", mode.number()), points: vec![c, c] });
    }
    lines
}

fn palm(view: &View, surface: PalmSurface, now: &ContactInstant, i: usize, reach: f64) -> Line {
    let (state, contact) = (&now.palms[i], &now.contacts[i]);
    let centre = state.p_WP;
    let points = match surface {
        PalmSurface::Plane => {
            // Under the object, wherever the origin of the plane's frame is.
            let n = state.R_WP.z_axis;
            let foot = now.state.body.p_WCm - n * n.dot(now.state.body.p_WCm - centre);
            let [a, b] = level_axes(n).map(|axis| BROAD * reach * axis);
            [a + b, b - a, -a - b, a - b, a + b].iter().map(|corner| view.place(foot + *corner)).collect()
        }
        PalmSurface::Sphere { radius } => view.arc(centre, radius, [0.0, TAU]),
        PalmSurface::Cup { radius } => {
            let outwards = view.place(contact.p_WC - centre);
            let middle = outwards.y.atan2(outwards.x);
            view.arc(centre, radius, [middle - CUP, middle + CUP])
        }
        PalmSurface::Cylinder { radius } => {
            let along = state.R_WP.x_axis;
            let middle = centre + along * along.dot(now.state.body.p_WCm - centre);
            let half = view.place(BROAD * reach * along);
            let side = radius * half.perp().normalize_or(DVec2::X);
            let m = view.place(middle);
            vec![m + half + side, m - half + side, m - half - side, m + half - side, m + half + side]
        }
    };
    let open = if matches!(surface, PalmSurface::Cup { .. }) { " open" } else { "" };
    Line { class: format!("palm p{}{open}", i + 1), points }
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
