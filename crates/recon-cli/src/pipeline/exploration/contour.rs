//! Outlines that a round finger follows once round.

use super::finger::{but, places, sure};
use super::settings::{Noise, add_noise, noise_of};
use super::story::Explored;
use crate::cli::GoalArgs;
use crate::error::{CliError, Outcome as Exit};
use crate::pipeline::exploration::contour_page::page;
use crate::pipeline::exploration::side::Drawn;
use crate::pipeline::folder::Extra;
use glam::DVec2;
use recon::exploration::contour::{
    Bridge, HullBounds, Margins, SimulatedFinger, TraceEnd, Traced, Tracing, trace,
};
use recon::shape_bounds::exact_hull::planar::{ConvexPolygon, Direction};
use recon_io::{AnyOutline, SummaryOf, brief_to, write_contour_report};
use serde_json::{Value, json};
use std::fmt::Write;

/// How an outline is followed.
pub(crate) struct Following {
    pub(crate) tracing: Tracing,
    pub(crate) margins: Margins,
    pub(crate) noise: Noise,
    pub(crate) seed: u64,
}

/// Touches at most, with those that the finger goes back from.
const READINGS: u32 = 20_000;
/// Steps to half of the extent, and what the hull's upper bound may be off by for their sake, as a share of it.
const STEPS: f64 = 50.0;
const BULGE: f64 = 1e-3;
/// The least step over the step, and the turn from touch to touch, rad; of a finger that is large beside the outline less, so that it notices jumps over this
/// share of it.
const LEAST: f64 = 1.0 / 256.0;
const TURN: f64 = 0.1;
const NOTICED: f64 = 0.05;

impl Following {
    /// Of an outline of half the extent `size` and a finger of `radius`, both in m.
    pub(crate) fn new(
        args: &GoalArgs,
        step: Option<f64>,
        [size, radius]: [f64; 2],
    ) -> Result<Self, CliError> {
        // The path of the finger bulges by step^2 / (8 radius) at most.
        let step = step.unwrap_or_else(|| (size / STEPS).min((8.0 * BULGE * radius * size).sqrt()));
        let readings = args.budget.unwrap_or(READINGS) as usize;
        let noise = noise_of(args);
        let margins = match noise {
            Some((deviations, level)) => Margins::of_noise(deviations, level, readings)?,
            None => Margins::EXACT,
        };
        let doubt = margins.of_turn();
        let turn = TURN.min(NOTICED * size / radius);
        let tracing = Tracing { step, least: LEAST * step, turn, doubt, readings };
        Ok(Self { tracing, margins, noise, seed: args.seed.unwrap_or(1) })
    }

    fn figures(&self, radius: f64) -> Value {
        let Tracing { step, least, turn, readings, .. } = self.tracing;
        let mut figures = json!({
            "finger_m": radius,
            "step_m": step,
            "least_step_m": least,
            "turn_rad": turn,
            "budget": readings,
            "seed": self.seed,
        });
        add_noise(self.noise, &mut figures);
        figures
    }
}

/// What is known of an outline that was followed.
pub(super) struct Known {
    pub(super) traced: Traced,
    /// Corners of the bounds of the hull; none of what was not followed to its end, or where noise leaves nothing.
    pub(super) lower: Vec<DVec2>,
    pub(super) upper: Vec<DVec2>,
    /// What their support functions differ by, m, over the direction in degrees.
    pub(super) apart: Vec<[f64; 2]>,
    /// The smallest mean radius of a hollow that was felt, m.
    pub(super) least_hollow: Option<f64>,
}

/// Directions along which the bounds are told apart.
const DIRECTIONS: usize = 180;

impl Known {
    fn new(traced: Traced, following: &Following) -> Self {
        let bounds = HullBounds::of(&traced, following.margins);
        let [lower, upper] = match bounds {
            Some(bounds) => [bounds.lower(), bounds.upper()],
            None => [Vec::new(), Vec::new()],
        };
        let apart = bounds.map_or_else(Vec::new, |bounds| {
            let one = |k: usize| {
                let degrees = 360.0 * k as f64 / DIRECTIONS as f64;
                let (low, high) = bounds.support(Direction::from_angle(degrees.to_radians()));
                [degrees, high - low]
            };
            (0..DIRECTIONS).map(one).collect()
        });
        let least_hollow = traced.least_hollow(following.tracing.doubt);
        Self { traced, lower, upper, apart, least_hollow }
    }

    /// Areas of both bounds, m^2; infinite where there is no upper one.
    pub(super) fn areas(&self) -> [f64; 2] {
        let area = |corners: &Vec<DVec2>| ConvexPolygon::new(corners.clone()).area();
        let upper = if self.upper.is_empty() { f64::INFINITY } else { area(&self.upper) };
        [if self.lower.is_empty() { 0.0 } else { area(&self.lower) }, upper]
    }

    /// Touches of the outline: of one that was followed round the last is past the first, and left out.
    pub(super) fn ring(&self) -> usize {
        self.traced.touches.len() - usize::from(self.is_closed())
    }

    /// Half of the largest extent of the touches along the axes, m.
    pub(super) fn size(&self) -> f64 {
        let points = self.traced.touches.iter().map(|t| t.point);
        let (low, high) =
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        0.5 * (high - low).max_element()
    }

    pub(super) fn is_closed(&self) -> bool {
        self.traced.end == TraceEnd::Closed
    }

    /// Both contacts of a jump.
    pub(super) fn ends(&self, bridge: &Bridge) -> [[f64; 2]; 2] {
        [0, 1].map(|k| self.traced.touches[bridge.after + k].point.to_array())
    }
}

/// Follows an outline once round with a finger of `radius` m.
pub(crate) fn followed(
    title: &str,
    outline: AnyOutline,
    radius: f64,
    following: &Following,
) -> Result<Explored, CliError> {
    let mut finger = SimulatedFinger::new(outline, radius).map_err(CliError::Finger)?;
    if let Some(([point, normal], _)) = following.noise {
        finger = finger.with_noise(point, normal, following.seed);
    }
    let known = Known::new(trace(&mut finger, &following.tracing)?, following);
    let (statement, exit) = statement(&known, following);
    let figures = figures(title, &known, following, (&statement, exit));
    let drawn = drawn(&known);
    let mut files = vec![touches_file(&known.traced), jumps_file(&known)];
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    write_contour_report(&page(title, &known, following, (&statement, exit)), &mut report)
        .map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    let way: f64 = known.traced.ways.iter().sum();
    let text = format!(
        "{statement}\n  touches                {}\n  way of the finger      {} m\n",
        known.ring(),
        brief_to(3, way)
    );
    Ok(Explored { figures, text, files, drawn, exit })
}

fn figures(title: &str, known: &Known, following: &Following, (statement, exit): (&str, Exit)) -> Value {
    let traced = &known.traced;
    let jump = |bridge: &Bridge| {
        let [from, to] = known.ends(bridge);
        json!({
            "after": bridge.after + 1,
            "from_m": from,
            "to_m": to,
            "mouth_m": bridge.mouth,
            "radius_at_most_m": bridge.radius_at_most,
        })
    };
    let [lower, upper] = known.areas();
    let mut figures = SummaryOf::Contour.named(json!({
        "input": title,
        "settings": following.figures(traced.radius),
        "closed": known.is_closed(),
        "touches": known.ring(),
        "readings": traced.readings,
        "unseen_m": following.tracing.unseen(traced.radius),
        "way_m": traced.ways.iter().sum::<f64>(),
        "jumps": traced.bridges.iter().map(jump).collect::<Vec<_>>(),
        "warnings": [],
    }));
    if let Some(radius) = known.least_hollow {
        figures["least_hollow_m"] = radius.into();
    }
    if upper.is_finite() {
        let gap = known.apart.iter().map(|[_, gap]| *gap).fold(0.0, f64::max);
        figures["area_within_touches_m2"] = traced.area().into();
        figures["bounds"] = json!({
            "lower_area_m2": lower,
            "upper_area_m2": upper,
            "lower_over_upper": lower / upper,
            "largest_gap_m": gap,
        });
    }
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    figures
}

/// What was felt, in a sentence, and whether that is all of it.
fn statement(known: &Known, following: &Following) -> (String, Exit) {
    let traced = &known.traced;
    if !known.is_closed() {
        let why = "it was not followed once round within the touches that were allowed for: nothing is proven of it";
        return (format!("After {} touches {why}.", traced.readings), Exit::WithReservations);
    }
    let [lower, upper] = known.areas();
    let sure = sure(following.noise);
    let hull = format!("The hull has an area of {} to {} m^2 {sure}", brief_to(4, lower), brief_to(4, upper));
    let unseen = following.tracing.unseen(traced.radius);
    let but = but(unseen);
    if traced.bridges.is_empty() && unseen > known.size() {
        return (format!("{hull}; nothing is said of hollows: {but}."), Exit::WithReservations);
    }
    let told = match (traced.bridges.len(), known.least_hollow) {
        (0, Some(radius)) => {
            format!(
                "the finger felt its way without a jump, the narrowest hollow with a mean radius of {} m; {but}",
                brief_to(3, radius)
            )
        }
        (0, None) => format!("the finger felt its way without a jump and found no hollow; {but}"),
        (jumps, _) => {
            let widest = traced.bridges.iter().map(|b| b.mouth).fold(0.0, f64::max);
            format!(
                "the finger jumped at {} that it does not get into, {} m wide at most: what is between was not felt; {but}",
                places(jumps),
                brief_to(3, widest)
            )
        }
    };
    let exit = if traced.bridges.is_empty() { Exit::Done } else { Exit::WithReservations };
    (format!("{hull}; {told}."), exit)
}

fn drawn(known: &Known) -> Drawn {
    let named = [("lower_bound.csv", &known.lower), ("upper_bound.csv", &known.upper)];
    let there = named.into_iter().filter(|(_, corners)| !corners.is_empty());
    Drawn { outlines: there.map(|(name, corners)| (name, corners.clone())).collect(), ..Drawn::default() }
}

/// All touches in order; of one that was followed round the last is past the first.
fn touches_file(traced: &Traced) -> Extra {
    let mut text = String::from("touch,x,y,nx,ny,way\n");
    for (k, (touch, way)) in traced.touches.iter().zip(&traced.ways).enumerate() {
        let (p, n) = (touch.point, touch.normal.get());
        let _ = writeln!(text, "{},{:?},{:?},{:?},{:?},{way:?}", k + 1, p.x, p.y, n.x, n.y);
    }
    ("contour.csv".to_owned(), text.into_bytes())
}

fn jumps_file(known: &Known) -> Extra {
    let mut text = String::from("after,x1,y1,x2,y2,mouth,radius_at_most\n");
    for bridge in &known.traced.bridges {
        let [[a, b], [c, d]] = known.ends(bridge);
        let Bridge { after, mouth, radius_at_most } = bridge;
        let _ = writeln!(text, "{},{a:?},{b:?},{c:?},{d:?},{mouth:?},{radius_at_most:?}", after + 1);
    }
    ("jumps.csv".to_owned(), text.into_bytes())
}
