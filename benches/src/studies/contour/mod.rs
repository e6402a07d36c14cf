//! Outlines that are not convex, followed by round fingers that are smaller or larger than their hollows.
//!
//! Usage: `contour [BODIES [FIRST]]`: bodies for each range of radii (40) and the first of their seeds. Prints docs/contour.md.

use exploration::contour::{
    HullBounds, SimulatedFinger, SmoothOutline, TraceEnd, Traced, Tracing, Waved, trace,
};
use exploration::{Heading, Source};
use recon::shape_bounds::planar::Direction;
use std::f64::consts::{PI, TAU};

type Failure = Box<dyn std::error::Error>;

/// Seeds of the bodies; those of the tests are three fixed bodies.
const FIRST_SEED: u64 = 870_000;
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
/// Standard deviation of normals, rad, and the deviations of a turn that are taken for noise.
const NORMAL: f64 = 2e-3;
const DEVIATIONS: f64 = 5.0;

/// What came of one range.
#[derive(Default)]
struct Tally {
    runs: usize,
    closed: usize,
    felt: usize,
    jumped: usize,
    other: usize,
    sound: usize,
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
    for (title, normal) in [("Exact contacts", 0.0), ("Normals off by 2 mrad", NORMAL)] {
        println!("## {title}\n");
        println!(
            "| finger over hollow | runs | once round | all felt | a jump in each hollow | anything else | hollows wider than a jump says | hull between its bounds | touches, mean | largest error of the area, % | of the radius told, % |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|");
        for (k, range) in RANGES.into_iter().enumerate() {
            let mut tally = Tally::default();
            for body in 0..each {
                one(&mut tally, first + each * k as u64 + body, range, normal)?;
            }
            println!("| {} to {} | {} |", range[0], range[1], tally.cells(normal == 0.0));
        }
        println!();
    }
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

impl Tally {
    fn cells(&self, exact: bool) -> String {
        let told = |share: f64| if share > 0.0 { format!("{:.2}", 100.0 * share) } else { "-".to_owned() };
        let Self { runs, closed, felt, jumped, other, sound, wrong, .. } = self;
        let sound = if exact { sound.to_string() } else { "-".to_owned() };
        let touches = self.touches as f64 / (*runs).max(1) as f64;
        let [area, radius] = [self.area, self.told].map(told);
        format!(
            "{runs} | {closed} | {felt} | {jumped} | {other} | {wrong} | {sound} | {touches:.0} | {area} | {radius}"
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

fn one(tally: &mut Tally, seed: u64, [low, high]: [f64; 2], normal: f64) -> Result<(), Failure> {
    let mut source = Source::new(seed);
    let (body, hollow) = body(&mut source);
    let radius = hollow * source.between(low, high);
    let mut finger = SimulatedFinger::new(body, radius)?.with_noise(0.0, normal, seed);
    let doubt = DEVIATIONS * normal * 2f64.sqrt();
    let tracing = Tracing { step: STEP, least: LEAST, turn: TURN, doubt, touches: 20_000 };
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
    tally.sound += usize::from(normal == 0.0 && sound(&found, &body));
    Ok(())
}

/// Whether the support function of the body is between those of the bounds of its hull, at 24 directions.
fn sound(found: &Traced, body: &Waved) -> bool {
    let Some(bounds) = HullBounds::of(found) else { return false };
    Direction::spread(24).into_iter().all(|u| {
        let point = |k: u32| body.at(TAU * f64::from(k) / 20_000.0).point.dot(u.get());
        let h = (0..20_000).map(point).fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = bounds.support(u);
        // The farthest of these points is short of the support function by some 1e-8.
        low <= h + 1e-7 && h <= high
    })
}
