//! Outlines that are not convex, followed by round fingers that are smaller or larger than their hollows.
//!
//! Usage: `contour [BODIES [FIRST]]`: bodies for each range of radii (40) and the first of their seeds. Prints docs/contour.md.

use exploration::contour::{
    HullBounds, Margins, SimulatedFinger, SmoothOutline, TraceEnd, Tracing, Waved, trace,
};
use exploration::{Heading, Source};
use recon::shape_bounds::exact_hull::planar::{ConvexPolygon, Direction};
use std::f64::consts::{PI, TAU};

type Failure = Box<dyn std::error::Error>;

/// Seeds of the bodies; those of the tests are three fixed bodies, those of a first run without noise of points 870000 to 870319.
const FIRST_SEED: u64 = 880_000;
/// Radius of the finger over that of the hollows.
const RANGES: [[f64; 2]; 8] = [
    [0.2, 0.5],
    [0.5, 0.8],
    [0.8, 0.95],
    [0.95, 0.999],
    [1.001, 1.05],
    [1.05, 1.25],
    [1.25, 2.0],
    [2.0, 4.0],
];
/// Touches at most so far apart over the size, and at least.
const STEP: f64 = 0.02;
const LEAST: f64 = STEP / 256.0;
const TURN: f64 = 0.1;
/// Standard deviations of points per axis over the size and of normals, rad, and the confidence at which bounds and jumps are told.
const NOISE: [f64; 2] = [1e-3, 2e-3];
const LEVEL: f64 = 0.95;
const READINGS: usize = 20_000;

/// What came of one range.
#[derive(Default)]
struct Tally {
    runs: usize,
    closed: usize,
    felt: usize,
    jumped: usize,
    other: usize,
    sound: usize,
    /// Sum of the gaps of the hull's bounds, as shares.
    gap: f64,
    touches: usize,
    /// Error of the area over the area.
    area: f64,
    /// Of what was felt: error of the least radius that is told; of jumps: the radius that is told over the finger's, less 1.
    told: f64,
    /// Jumps whose hollow is wider than they say.
    wrong: usize,
}

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(40), |a| a.parse())?;
    let first: u64 = crate::words().nth(1).map_or(Ok(FIRST_SEED), |a| a.parse())?;
    println!("{}", include_str!("intro.md").trim_end());
    println!("\nMade by `cargo xtask study contour {each} {first}`.\n");
    let noisy = "Points off by 0.1 % of the size, normals by 2 mrad, at 95 %";
    for (title, noise) in [("Exact contacts", None), (noisy, Some(NOISE))] {
        println!("## {title}\n");
        println!(
            "| finger over hollow | runs | once round | all felt | a jump in each hollow | anything else | hollows wider than a jump says | hull between its bounds | gap of the hull, %, mean | touches, mean | largest error of the area, % | of the radius told, % |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
        for (k, range) in RANGES.into_iter().enumerate() {
            let mut tally = Tally::default();
            for body in 0..each {
                one(&mut tally, first + each * k as u64 + body, range, noise)?;
            }
            println!("| {} to {} | {} |", range[0], range[1], tally.cells());
        }
        println!();
    }
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

impl Tally {
    fn cells(&self) -> String {
        let told = |share: f64| if share > 0.0 { format!("{:.2}", 100.0 * share) } else { "-".to_owned() };
        let Self { runs, closed, felt, jumped, other, sound, wrong, .. } = self;
        let mean = |sum: f64| sum / (*runs).max(1) as f64;
        let (touches, gap) = (mean(self.touches as f64), 100.0 * mean(self.gap));
        let [area, radius] = [self.area, self.told].map(told);
        format!(
            "{runs} | {closed} | {felt} | {jumped} | {other} | {wrong} | {sound} | {gap:.2} | {touches:.0} | {area} | {radius}"
        )
    }
}

/// A body with hollows of a tenth to twice its size.
fn body(source: &mut Source) -> (Waved, f64) {
    loop {
        let waves = 2 + (4.0 * source.unit()) as u32;
        let body = Waved { size: 1.0, depth: source.between(0.02, 0.6), waves };
        if let Some(hollow) = body.hollow().filter(|hollow| (0.1..2.0).contains(hollow)) {
            return (body, hollow);
        }
    }
}

fn one(tally: &mut Tally, seed: u64, [low, high]: [f64; 2], noise: Option<[f64; 2]>) -> Result<(), Failure> {
    let mut source = Source::new(seed);
    let (body, hollow) = body(&mut source);
    let radius = hollow * source.between(low, high);
    let margins = match noise {
        Some(deviations) => Margins::of_noise(deviations, LEVEL, READINGS)?,
        None => Margins::EXACT,
    };
    let [point, normal] = noise.unwrap_or_default();
    let mut finger = SimulatedFinger::new(body, radius)?.with_noise(point, normal, seed);
    let doubt = margins.of_turn();
    let tracing = Tracing { step: STEP, least: LEAST, turn: TURN, doubt, readings: READINGS };
    let found = trace(&mut finger, &tracing)?;
    tally.runs += 1;
    tally.closed += usize::from(found.end == TraceEnd::Closed);
    tally.touches += found.touches.len();
    if found.bridges.is_empty() {
        tally.felt += 1;
        let area = PI * (1.0 + 0.5 * body.depth * body.depth);
        tally.area = tally.area.max((found.area() / area - 1.0).abs());
        let told = found.least_hollow(doubt).map_or(0.0, |told| (told / hollow - 1.0).abs());
        tally.told = tally.told.max(told);
    } else if found.bridges.len() == body.waves as usize {
        tally.jumped += 1;
        tally.wrong += found.bridges.iter().filter(|b| b.radius_at_most < hollow).count();
        let above = found.bridges.iter().map(|b| (b.radius_at_most / radius - 1.0).abs());
        tally.told = tally.told.max(above.fold(0.0, f64::max));
    } else {
        tally.other += 1;
    }
    if let Some(bounds) = HullBounds::of(&found, margins) {
        tally.sound += usize::from(sound(&bounds, &body));
        let area = |corners| ConvexPolygon::new(corners).area();
        tally.gap += 1.0 - area(bounds.lower()) / area(bounds.upper());
    }
    Ok(())
}

/// Whether the support function of the body is between those of the bounds of its hull, at 24 directions.
fn sound(bounds: &HullBounds<'_>, body: &Waved) -> bool {
    Direction::spread(24).into_iter().all(|u| {
        let point = |k: u32| body.at(TAU * f64::from(k) / 20_000.0).point.dot(u.get());
        let h = (0..20_000).map(point).fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = bounds.support(u);
        // The farthest of these points is short of the support function by some 1e-8.
        low <= h + 1e-7 && h <= high
    })
}
