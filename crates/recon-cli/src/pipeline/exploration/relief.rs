//! Bodies in space that a round finger comes down on.

use super::finger::{but, places, sure};
use super::groups::groups;
use super::relief_files::files;
use super::relief_page::page;
use super::settings::{Noise, add_noise, noise_of};
use super::side::Drawn;
use super::story::Explored;
use crate::cli::GoalArgs;
use crate::error::{CliError, Outcome as Exit};
use crate::pipeline::bounds::{LOWER, UPPER, own};
use recon::contact_kinematics::{Direction, in_parts};
use recon::exploration::Heading;
use recon::exploration::contour::Margins;
use recon::exploration::relief::{
    Bridge, Line, Probing, ProbingError, ProbingFinger, Relief, ReliefBounds, ReliefEnd, SimulatedFinger,
    StuckFinger, Touch, WavedBody, probe,
};
use recon::shape_bounds::exact_hull::{HalfSpace, Intersection, Polyhedron, SolidHull};
use recon_io::{SummaryOf, SurfaceScene, brief_to, write_contour_report};
use serde_json::{Value, json};

/// How a finger comes down on a body.
pub(crate) struct Descending {
    pub(crate) probing: Probing,
    pub(crate) noise: Noise,
    seed: u64,
}

/// Directions that the finger comes from, and lines at most.
const DIRECTIONS: usize = 16;
const READINGS: u32 = 100_000;
/// Lines are apart by this share of the size, or of the finger's radius where that is less; the least spacing over it; and the turn from line to line, rad.
const SPACING: f64 = 0.06;
const NARROW: f64 = 0.7;
const LEAST: f64 = 1.0 / 256.0;
const TURN: f64 = 0.2;
/// The body is taken to be within so much more than it is.
const REACH: f64 = 1.05;
/// Half-spaces of the upper bound of the hull.
const HALF_SPACES: usize = 200;
/// Lines after which it is said how many there were.
const SAID: usize = 500;

impl Descending {
    /// On a surface, with a finger of `radius` m.
    pub(crate) fn new(
        args: &GoalArgs,
        step: Option<f64>,
        scene: &SurfaceScene,
        radius: f64,
    ) -> Result<Self, CliError> {
        let spacing = step.unwrap_or_else(|| (SPACING * scene.surface.size).min(NARROW * radius));
        let readings = args.budget.unwrap_or(READINGS) as usize;
        let noise = noise_of(args);
        let margins = match noise {
            Some((deviations, level)) => Margins::of_noise_in_space(deviations, level, readings)?,
            None => Margins::EXACT,
        };
        let directions = <Direction as Heading>::spread(DIRECTIONS);
        let (least, reach) = (LEAST * spacing, REACH * scene.reach());
        let probing = Probing { directions, reach, spacing, least, turn: TURN, margins, readings };
        Ok(Self { probing, noise, seed: args.seed.unwrap_or(1) })
    }

    fn figures(&self, radius: f64) -> Value {
        let Probing { reach, spacing, least, turn, readings, ref directions, .. } = self.probing;
        let mut figures = json!({
            "finger_m": radius,
            "reach_m": reach,
            "directions": directions.len(),
            "spacing_m": spacing,
            "least_spacing_m": least,
            "turn_rad": turn,
            "budget": readings,
            "seed": self.seed,
        });
        add_noise(self.noise, &mut figures);
        figures
    }
}

/// A finger that says how many lines it came down.
struct Counted<F, S> {
    finger: F,
    lines: usize,
    say: S,
}

impl<F: ProbingFinger, S: Fn(&str)> ProbingFinger for Counted<F, S> {
    type Error = F::Error;

    fn radius(&self) -> f64 {
        self.finger.radius()
    }

    fn approach(&mut self, line: &Line) -> Result<Option<Touch>, F::Error> {
        self.lines += 1;
        if self.lines.is_multiple_of(SAID) {
            (self.say)(&format!("coming down: line {}", self.lines));
        }
        self.finger.approach(line)
    }
}

/// What is known of a body that a finger came down on.
pub(super) struct Known {
    pub(super) relief: Relief,
    /// Jumps that are next to each other as one place: the widest of each, and how many there are.
    pub(super) places: Vec<(Bridge, usize)>,
    /// Places of rims.
    pub(super) rims: usize,
    /// The body's volume at most, m^3; none where nothing was touched.
    pub(super) volume: Option<f64>,
    /// Bounds of its hull; none from below where contacts may be off.
    pub(super) lower: Option<SolidHull>,
    pub(super) upper: Option<Polyhedron>,
    /// What their support functions differ by at most along the directions that were looked at, m.
    pub(super) gap: f64,
}

impl Known {
    fn new(relief: Relief, spacing: f64) -> Result<Self, CliError> {
        let points = |k: &usize| relief.touches[*k].point;
        let near = spacing.max(relief.radius);
        let of_jumps =
            groups(&relief.bridges.iter().map(|b| b.touches.map(|k| points(&k))).collect::<Vec<_>>(), near);
        let widest = |of: &Vec<usize>| {
            let widest = of.iter().map(|k| relief.bridges[*k]).max_by(|a, b| a.mouth.total_cmp(&b.mouth));
            widest.map(|widest| (widest, of.len()))
        };
        let places = of_jumps.iter().filter_map(widest).collect();
        let rims = groups(&relief.rims.iter().map(|k| [points(k); 2]).collect::<Vec<_>>(), near).len();
        let mut known =
            Self { relief, places, rims, volume: None, lower: None, upper: None, gap: f64::INFINITY };
        if known.relief.touches.is_empty() {
            return Ok(known);
        }
        let bounds = ReliefBounds::of(&known.relief, spacing).map_err(CliError::ReliefBounds)?;
        known.volume = Some(bounds.volume_at_most());
        known.lower = bounds.hull();
        let along = <Direction as Heading>::spread(HALF_SPACES);
        let of = |some: &[Direction]| some.iter().map(|n| (*n, bounds.support(*n))).collect();
        let sides: Vec<_> = in_parts(&along, of);
        let all: Vec<HalfSpace> = sides.iter().map(half_space).collect();
        known.upper = Intersection::of(&all)?.bounded().cloned();
        known.gap = sides.iter().map(|(_, (low, high))| high - low).fold(0.0, f64::max);
        Ok(known)
    }
}

fn half_space((normal, (_, high)): &(Direction, (f64, f64))) -> HalfSpace {
    HalfSpace { point: normal.get() * *high, normal: *normal, margin: 0.0 }
}

/// Comes down on a body from several directions with a finger of `radius` m.
pub(crate) fn felt(
    title: &str,
    body: WavedBody,
    radius: f64,
    descending: &Descending,
    say: impl Fn(&str),
) -> Result<Explored, CliError> {
    let [point, normal] = descending.noise.map_or([0.0; 2], |(noise, _)| noise);
    let finger = SimulatedFinger::new(body, radius).map_err(CliError::DescendingFinger)?;
    let finger = finger.with_noise(point, normal, descending.seed);
    let probed: Result<Relief, ProbingError<StuckFinger>> =
        probe(&mut Counted { finger, lines: 0, say: &say }, &descending.probing);
    let relief = probed?;
    say("bounding");
    let known = Known::new(relief, descending.probing.spacing)?;
    let (statement, exit) = statement(&known, descending);
    let figures = figures(title, &known, descending, (&statement, exit));
    let drawn = drawn(&known)?;
    let mut files = files(&known.relief);
    files.extend(drawn.files()?);
    let mut report = Vec::new();
    write_contour_report(&page(title, &known, descending, (&statement, exit)), &mut report)
        .map_err(CliError::Page)?;
    files.push(("report.html".to_owned(), report));
    let text = format!(
        "{statement}\n  lines                  {}, of which {} met the body\n",
        known.relief.readings,
        known.relief.touches.len()
    );
    Ok(Explored { figures, text, files, drawn, exit })
}

fn figures(title: &str, known: &Known, descending: &Descending, (statement, exit): (&str, Exit)) -> Value {
    let relief = &known.relief;
    let place = |(bridge, count): &(Bridge, usize)| {
        let [from, to] = bridge.touches.map(|k| relief.touches[k].point.to_array());
        json!({
            "jumps": count,
            "from_m": from,
            "to_m": to,
            "mouth_m": bridge.mouth,
            "radius_at_most_m": bridge.radius_at_most,
        })
    };
    let mut figures = SummaryOf::Relief.named(json!({
        "input": title,
        "settings": descending.figures(relief.radius),
        "all_lines": relief.end == ReliefEnd::Done,
        "all_felt": relief.is_felt(),
        "touches": relief.touches.len(),
        "readings": relief.readings,
        "unseen_m": descending.probing.unseen(relief.radius),
        "jumps": relief.bridges.len(),
        "jumped_at": known.places.iter().map(place).collect::<Vec<_>>(),
        "rims": relief.rims.len(),
        "warnings": [],
    }));
    if let Some(radius) = relief.least_hollow {
        figures["least_hollow_m"] = radius.into();
    }
    if let Some(volume) = known.volume {
        figures["volume_at_most_m3"] = volume.into();
    }
    if let Some(upper) = &known.upper {
        let (lower, upper) = (known.lower.as_ref().map_or(0.0, SolidHull::volume), upper.volume());
        figures["bounds"] = json!({
            "lower_volume_m3": lower,
            "upper_volume_m3": upper,
            "lower_over_upper": lower / upper,
            "largest_gap_m": known.gap,
        });
    }
    if exit == Exit::WithReservations {
        figures["warnings"] = json!([statement]);
    }
    figures
}

/// What was felt, in a sentence, and whether that is all of it.
fn statement(known: &Known, descending: &Descending) -> (String, Exit) {
    let relief = &known.relief;
    let Some(volume) = known.volume else {
        return (format!("None of {} lines met the body.", relief.readings), Exit::WithReservations);
    };
    let sure = sure(descending.noise);
    let size = format!("The body has a volume of {} m^3 at most {sure}", brief_to(4, volume));
    let unseen = descending.probing.unseen(relief.radius);
    let but = but(unseen);
    if relief.end != ReliefEnd::Done {
        let why = "the lines that were allowed for are used up, and what is beyond them nobody felt";
        return (format!("{size}; {why}."), Exit::WithReservations);
    }
    let mut told = Vec::new();
    if !known.places.is_empty() {
        let widest = known.places.iter().map(|(b, _)| b.mouth).fold(0.0, f64::max);
        let of = if known.places.len() == 1 { "" } else { " at most" };
        told.push(format!(
            "the finger jumped at {} that it does not get into, {} m wide from line to line{of}: what is between was not felt",
            places(known.places.len()),
            brief_to(3, widest)
        ));
    }
    if known.rims > 0 {
        told.push(format!("at {} no direction sees how the surface goes on", places(known.rims)));
    }
    if told.is_empty() {
        told.push(match relief.least_hollow {
            Some(radius) => format!(
                "all of its surface was felt, the narrowest hollow with a mean radius of {} m",
                brief_to(3, radius)
            ),
            None => "all of its surface was felt, and no hollow".to_owned(),
        });
    }
    let exit = if relief.is_felt() { Exit::Done } else { Exit::WithReservations };
    (format!("{size}; {}; {but}.", told.join("; ")), exit)
}

fn drawn(known: &Known) -> Result<Drawn, CliError> {
    let lower = known.lower.as_ref().map(|hull| Ok::<_, CliError>((LOWER, own(hull.mesh())?)));
    let upper = known.upper.as_ref().map(|hull| Ok((UPPER, own(hull.mesh())?)));
    let surfaces = lower.into_iter().chain(upper).collect::<Result<_, _>>()?;
    Ok(Drawn { surfaces, ..Drawn::default() })
}
