//! The page of an outline that a finger followed.

use super::contour::{Following, Known};
use super::page::in_turn;
use crate::error::Outcome as Exit;
use glam::DVec2;
use recon::shape_bounds::exact_hull::planar::{ConvexPolygon, Hull};
use recon_io::{ContourPage, Fact, FigureCurve, FigurePanel, JumpRow, Level, Verdict, brief_to};
use std::f64::consts::PI;

const CAPTION: &str = "Felt: the outline between touches, broken where the finger jumped. Circle: the finger. The hull of the outline is between its bounds. Area: within \
                       the touches so far, and of their hull. Curvature: mean of the outline between two touches, by the turn of the normal and the way of the finger, \
                       negative in hollows; dots: jumps, where nothing was felt, or a hollow more curved than that; the line: a hollow as round as the finger, which gets into nothing more curved. \
                       Room: what the support functions of the bounds of the hull differ by.";

const KICKER: &str = "An outline followed by a round finger: what it felt, and what that proves of the hull";
const ABOUT_JUMPS: &str = "What lies between the two contacts of a jump was not felt: the finger touches both sides at once. Or it was, and is a hollow \
                           whose mean radius of curvature is no more than the last column says. Nothing else is known of it but that the finger's own disc is free.";

/// Pictures of the finger on its way.
const PICTURES: usize = 40;
/// Points of the finger's circle.
const ROUND: usize = 48;

pub(super) fn page(
    title: &str,
    known: &Known,
    following: &Following,
    (statement, exit): (&str, Exit),
) -> ContourPage {
    let level = if exit == Exit::Done { Level::Good } else { Level::Caution };
    let jump = |b: &recon::exploration::contour::Bridge| JumpRow {
        after: b.after + 1,
        ends: known.ends(b).map(|end| end.to_vec()),
        mouth: b.mouth,
        radius_at_most: b.radius_at_most,
    };
    let count = known.traced.touches.len();
    let every = count.div_ceil(PICTURES).max(1);
    let on_the_way = (0..count).step_by(every).map(|k| vec![picture(known, k)]).collect();
    let mut panels = in_turn(vec![picture(known, count - 1)], on_the_way, "picture");
    panels.extend([areas(known), curvature(known), room(known)].into_iter().filter(|p| !p.curves.is_empty()));
    ContourPage {
        kicker: KICKER,
        title: title.to_owned(),
        verdict: Verdict { level, text: statement.to_owned() },
        facts: facts(known, following),
        panels,
        pictured: "Once round",
        caption: CAPTION.to_owned(),
        jumps: known.traced.bridges.iter().map(jump).collect(),
        about_jumps: ABOUT_JUMPS,
    }
}

fn facts(known: &Known, following: &Following) -> Vec<Fact> {
    let traced = &known.traced;
    let [lower, upper] = known.areas();
    let mut facts = vec![
        ("Finger", brief_to(3, traced.radius), "m"),
        ("Touches", known.ring().to_string(), ""),
        ("Way of the finger", brief_to(3, traced.ways.iter().sum()), "m"),
        ("Jumps", traced.bridges.len().to_string(), ""),
    ];
    if let Some(radius) = known.least_hollow {
        facts.push(("Narrowest hollow felt", brief_to(3, radius), "m"));
    }
    if upper.is_finite() {
        facts.push(("Area within touches", brief_to(4, traced.area()), "m²"));
        facts.push(("Hull, lower bound", brief_to(4, lower), "m²"));
        facts.push(("Hull, upper bound", brief_to(4, upper), "m²"));
        facts.push(("Gap of the hull", brief_to(3, 100.0 * (1.0 - lower / upper)), "%"));
    }
    if let Some((_, level)) = following.noise {
        facts.push(("Confidence", brief_to(4, 100.0 * level), "%"));
    }
    facts
}

fn curve(name: &str, points: Vec<[f64; 2]>) -> FigureCurve {
    FigureCurve { name: name.to_owned(), points, ..FigureCurve::default() }
}

/// The outline up to a touch, with the finger there.
fn picture(known: &Known, last: usize) -> FigurePanel {
    let traced = &known.traced;
    let jumps_before = |k: usize| traced.bridges.iter().any(|b| b.after + 1 == k);
    let mut felt = Vec::new();
    for (k, touch) in traced.touches[..=last].iter().enumerate() {
        if jumps_before(k) {
            felt.push([f64::NAN; 2]);
        }
        felt.push(touch.point.to_array());
    }
    let jumps = traced.bridges.iter().filter(|b| b.after < last);
    let jumps = jumps.flat_map(|b| {
        let [a, c] = known.ends(b);
        [a, c, [f64::NAN; 2]]
    });
    let here = &traced.touches[last];
    // Of a large finger the part that is nearest to the outline.
    let shown = PI * (known.size() / traced.radius).min(1.0);
    let centre = here.point + here.normal.get() * traced.radius;
    let round = |k: usize| {
        let angle = shown * (2.0 * k as f64 / ROUND as f64 - 1.0);
        (centre - DVec2::from_angle(angle).rotate(here.normal.get()) * traced.radius).to_array()
    };
    let hull = known.upper.iter().chain(known.upper.first()).map(DVec2::to_array).collect();
    let curves = [
        curve("felt", felt),
        curve("jumped over", jumps.collect()),
        curve("hull, upper bound", hull),
        curve("finger", (0..=ROUND).map(round).collect()),
    ];
    FigurePanel {
        title: "Where it was felt".to_owned(),
        axes: ["x in m".to_owned(), "y in m".to_owned()],
        equal: true,
        curves: curves.into_iter().filter(|c| !c.points.is_empty()).collect(),
        room: room_for_fingers(known),
        ..FigurePanel::default()
    }
}

/// Room for the finger all around, so that the picture does not move with it; a large one is cut off.
fn room_for_fingers(known: &Known) -> Vec<[f64; 2]> {
    let across = (2.0 * known.traced.radius).min(known.size());
    known.traced.touches.iter().map(|t| (t.point + t.normal.get() * across).to_array()).collect()
}

/// Areas within the touches so far and of their hull, and the upper bound.
fn areas(known: &Known) -> FigurePanel {
    let points: Vec<DVec2> = known.traced.touches[..known.ring()].iter().map(|t| t.point).collect();
    let every = points.len().div_ceil(10 * PICTURES).max(1);
    let counts = || (3..=points.len()).step_by(every).chain([points.len()]);
    let within = |n: usize| {
        let next = points[..n].iter().cycle().skip(1);
        0.5 * points[..n].iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
    };
    let hull = |n: usize| {
        let hull = Hull::of(&points[..n]).ok();
        hull.and_then(|hull| hull.polygon().map(|p| p.shape().area())).unwrap_or(0.0)
    };
    let so_far = |of: &dyn Fn(usize) -> f64| counts().map(|n| [n as f64, of(n)]).collect::<Vec<_>>();
    let mut curves = vec![curve("within", so_far(&within)), curve("hull of touches", so_far(&hull))];
    if !known.upper.is_empty() {
        let upper = ConvexPolygon::new(known.upper.clone()).area();
        curves.push(curve("upper bound", vec![[3.0, upper], [points.len() as f64, upper]]));
    }
    FigurePanel {
        title: "Area over touches".to_owned(),
        axes: ["touch".to_owned(), "area in m²".to_owned()],
        curves,
        ..FigurePanel::default()
    }
}

/// Mean curvature between touches over the way of the finger.
fn curvature(known: &Known) -> FigurePanel {
    let traced = &known.traced;
    let (mut points, mut jumps, mut way) = (Vec::new(), Vec::new(), 0.0);
    for k in 1..traced.touches.len() {
        let (from, to, moved) =
            (traced.touches[k - 1].normal.get(), traced.touches[k].normal.get(), traced.ways[k]);
        let turned = from.perp_dot(to).atan2(from.dot(to));
        // The outline's own length: what the centre moves by less what the finger turns by.
        let length = moved - traced.radius * turned;
        if let Some(bridge) = traced.bridges.iter().find(|b| b.after + 1 == k) {
            points.push([f64::NAN; 2]);
            jumps.push([way, -1.0 / bridge.radius_at_most]);
        } else if length > 0.0 {
            points.push([way + 0.5 * moved, turned / length]);
        }
        way += moved;
    }
    let finger = vec![[0.0, -1.0 / traced.radius], [way, -1.0 / traced.radius]];
    let jumps = FigureCurve { dots: true, ..curve("jumps", jumps) };
    let curves = [curve("outline", points), curve("finger", finger), jumps];
    FigurePanel {
        title: "Curvature along the way".to_owned(),
        axes: ["way of the finger in m".to_owned(), "curvature in 1/m".to_owned()],
        curves: curves.into_iter().filter(|c| !c.points.is_empty()).collect(),
        ..FigurePanel::default()
    }
}

/// What the bounds of the hull differ by, over the direction.
fn room(known: &Known) -> FigurePanel {
    let curves = if known.apart.is_empty() {
        Vec::new()
    } else {
        vec![curve("upper less lower", known.apart.clone())]
    };
    FigurePanel {
        title: "Room between the bounds of the hull".to_owned(),
        axes: ["direction in degrees".to_owned(), "support functions in m".to_owned()],
        curves,
        room: vec![[0.0; 2]],
        ..FigurePanel::default()
    }
}
