//! The outline as a picture: how sure each part is, where it was touched, how the forces stood.

use crate::number::on_scale;
use glam::DVec2;
use recon::object_dynamics::pushing::PushMode;
use recon::observer::pushes::{OutlineCorner, OutlinePoint, PushInstant, PushResult, PushesEstimate};
use std::fmt::Write as _;

const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 540.0;
/// Room around the outline, for forces and names.
const ROOM: f64 = 64.0;
/// Length of a force, px.
const FORCE: f64 = 24.0;
/// Bands below this half width, px, are drawn wider by a factor that the caption tells.
const LEAST_BAND: f64 = 4.0;
/// Length of the arrow to where a push tells most, px.
const NEXT: f64 = 40.0;
/// From a corner's ellipse to its name, px.
const LABEL: f64 = 12.0;
/// Half of the longest name, px.
const NAME: f64 = 132.0;
/// Ways to a touch, as a share of the way around, beyond which the outline is inferred.
const FELT: f64 = 0.01;

/// From the object's frame to the picture.
struct Frame {
    middle: DVec2,
    scale: f64,
}

impl Frame {
    /// Holds the outline and, drawn wider by `factor`, the ellipses about its corners.
    fn new(told: &PushesEstimate, factor: f64) -> Self {
        let corners = told.outline.line.corners().iter().copied();
        let ends =
            |corner: &OutlineCorner| [-1.0, 1.0].map(|side| corner.point + side * factor * reach(corner));
        let points: Vec<DVec2> = corners.chain(told.outline.corners.iter().flat_map(ends)).collect();
        let low = points.iter().fold(DVec2::INFINITY, |low, p| low.min(*p));
        let high = points.iter().fold(DVec2::NEG_INFINITY, |high, p| high.max(*p));
        let size = (high - low).max(DVec2::splat(f64::MIN_POSITIVE));
        let scale = ((WIDTH - 2.0 * ROOM) / size.x).min((HEIGHT - 2.0 * ROOM) / size.y);
        Self { middle: 0.5 * (low + high), scale }
    }

    fn place(&self, p: DVec2) -> DVec2 {
        let [x, y] = ((p - self.middle) * self.scale).to_array();
        DVec2::new(0.5 * WIDTH + x, 0.5 * HEIGHT - y)
    }

    fn written(&self, p: DVec2) -> String {
        let p = self.place(p);
        format!("{},{}", on_scale(p.x, 100.0, 3), on_scale(p.y, 100.0, 3))
    }

    fn line(&self, points: impl Iterator<Item = DVec2>) -> String {
        points.map(|p| self.written(p)).collect::<Vec<_>>().join(" ")
    }
}

/// From the middle of a corner's ellipse to its sides, m. Chi-squared of two degrees of freedom: 5.99 once in twenty.
fn reach(corner: &OutlineCorner) -> DVec2 {
    let of = |i: usize| (5.99 * corner.covariance[(i, i)].max(0.0)).sqrt();
    DVec2::new(of(0), of(1))
}

/// The picture, and what it shows in words.
pub(super) fn drawn(told: &PushesEstimate) -> (String, String) {
    let outline = &told.outline;
    let widest = outline.points.iter().fold(0.0, |most: f64, p| most.max(2.0 * p.deviation));
    let factor = if widest * Frame::new(told, 1.0).scale >= LEAST_BAND { 1.0 } else { 10.0 };
    let frame = Frame::new(told, factor);
    let mut out = format!("<svg class=\"outline\" viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\">\n");
    let corners = outline.line.corners();
    let around = frame.line(corners.iter().copied());
    let _ = writeln!(out, "<polygon class=\"object\" points=\"{around}\"/>");
    band(told, factor, &frame, &mut out);
    let _ = writeln!(out, "<polygon class=\"open\" points=\"{around}\"/>");
    let length = outline.line.edges().map(|(a, b)| a.distance(b)).sum::<f64>();
    let felt: Vec<_> = outline.points.iter().map(|p| (p.point, p.to_touch <= FELT * length)).collect();
    for piece in felt.split(|(_, felt)| !felt).filter(|piece| piece.len() > 1) {
        let points = frame.line(piece.iter().map(|(p, _)| *p));
        let _ = writeln!(out, "<polyline class=\"felt\" points=\"{points}\"/>");
    }
    told.pushes.iter().for_each(|push| draw_push(push, told, &frame, &mut out));
    outline.corners.iter().for_each(|corner| draw_corner(corner, factor, &frame, &mut out));
    outline.next_push().iter().for_each(|at| draw_next(at, &frame, &mut out));
    draw_scale(length, &frame, &mut out);
    out += "</svg>\n";
    let wider = if factor > 1.0 { ", drawn ten times as wide as it is" } else { "" };
    let corners = if outline.corners.is_empty() {
        ""
    } else {
        " Ellipses about corners hold 95 %, to the same scale as the band."
    };
    let caption = format!(
        "Object's frame. Blue: twice the standard deviation to either side{wider}.{corners} Solid line: touched; dotted: inferred. Each push has a dot where \
         the finger first touched and one where it last did, with the force on the object there, in the colour of the mode. The large arrow: a push there tells most."
    );
    (out, caption)
}

fn band(told: &PushesEstimate, factor: f64, frame: &Frame, out: &mut String) {
    let points = &told.outline.points;
    let n = points.len();
    for k in 0..n {
        let (a, b) = (&points[k], &points[(k + 1) % n]);
        // At a corner the normals part: each edge has its own band.
        if a.normal.dot(b.normal) < 0.8 {
            continue;
        }
        let off = |p: &OutlinePoint, side: f64| p.point + p.normal * (2.0 * side * factor * p.deviation);
        let corners = frame.line([off(a, 1.0), off(b, 1.0), off(b, -1.0), off(a, -1.0)].into_iter());
        let _ = writeln!(out, "<polygon class=\"band\" points=\"{corners}\"/>");
    }
}

/// The class of a mode in the page's style.
pub(super) fn class(mode: PushMode) -> &'static str {
    match mode {
        PushMode::Rest => "m0",
        PushMode::Stick => "m2",
        PushMode::Left => "m1",
        PushMode::Right => "mr",
    }
}

fn draw_push(push: &PushResult, told: &PushesEstimate, frame: &Frame, out: &mut String) {
    let (Some(first), Some(last)) = (push.instants.first(), push.instants.last()) else { return };
    let mut end = |at: DVec2, instant: &PushInstant| {
        let inward = -told.outline.line.nearest(at).normal;
        let force = (inward + inward.perp() * instant.ratio).normalize_or_zero();
        let from = at - force * (FORCE / frame.scale);
        let class = class(instant.mode());
        let _ = writeln!(
            out,
            "<polyline class=\"push {class}\" points=\"{}\"/>",
            frame.line([from, at].into_iter())
        );
        let place = frame.place(at);
        let _ = writeln!(
            out,
            "<circle class=\"dot {class}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\"><title>push {}</title></circle>",
            place.x, place.y, push.number
        );
    };
    end(push.ends[0], first);
    end(push.ends[1], last);
}

fn draw_corner(corner: &OutlineCorner, factor: f64, frame: &Frame, out: &mut String) {
    let eigen = corner.covariance.symmetric_eigen();
    let [a, b] = [0, 1].map(|i| (5.99 * eigen.eigenvalues[i].max(0.0)).sqrt() * factor * frame.scale);
    let (along, place) = (eigen.eigenvectors.column(0), frame.place(corner.point));
    let angle = -along[1].atan2(along[0]).to_degrees();
    let _ = writeln!(
        out,
        "<ellipse class=\"corner\" rx=\"{a:.1}\" ry=\"{b:.1}\" transform=\"translate({:.1} {:.1}) rotate({angle:.1})\"/>",
        place.x, place.y
    );
    // Above or below its ellipse, with room for the longest name in the letters of a narrow page.
    let side = if place.y < 0.5 * HEIGHT { -1.0 } else { 1.0 };
    let y =
        (place.y + side * (LABEL + factor * frame.scale * reach(corner).y)).clamp(20.0, HEIGHT - 6.0) + 4.0;
    let x = place.x.clamp(NAME, WIDTH - NAME);
    let [px, py] = corner.point.to_array().map(|v| v * 1e3);
    let _ = writeln!(
        out,
        "<text class=\"label\" x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"middle\">({px:.1}, {py:.1}) ± {:.1} mm</text>",
        corner.deviation() * 1e3
    );
}

/// An arrow to where a push tells most.
fn draw_next(at: &OutlinePoint, frame: &Frame, out: &mut String) {
    let inward = DVec2::new(-at.normal.x, at.normal.y);
    let tip = frame.place(at.point) - 3.0 * inward;
    let (tail, back) = (tip - NEXT * inward, tip - 10.0 * inward);
    let (left, right) = (back + 6.0 * inward.perp(), back - 6.0 * inward.perp());
    let _ = writeln!(
        out,
        "<path class=\"next\" d=\"M{:.1} {:.1} L{:.1} {:.1} M{:.1} {:.1} L{:.1} {:.1} L{:.1} {:.1}\"><title>push here next</title></path>",
        tail.x, tail.y, tip.x, tip.y, left.x, left.y, tip.x, tip.y, right.x, right.y
    );
}

/// A bar of a round length, and the origin.
fn draw_scale(length: f64, frame: &Frame, out: &mut String) {
    let bar = crate::planar_figures::round_step(0.04 * length);
    let (end, y) = (WIDTH - 96.0, 24.0);
    let x = end - bar * frame.scale;
    let _ =
        writeln!(out, "<path class=\"scale\" d=\"M{x:.1} {} v8 M{x:.1} {y} H{end:.1} m0 -4 v8\"/>", y - 4.0);
    let _ = writeln!(
        out,
        "<text x=\"{:.1}\" y=\"{}\">{} mm</text>",
        end + 8.0,
        y + 4.0,
        (bar * 1e4).round() / 10.0
    );
    let origin = frame.place(DVec2::ZERO);
    let _ = writeln!(
        out,
        "<path class=\"scale\" d=\"M{:.1} {:.1} h10 m-5 -5 v10\"><title>origin of the poses</title></path>",
        origin.x - 5.0,
        origin.y
    );
}
