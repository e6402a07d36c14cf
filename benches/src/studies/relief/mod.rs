//! Bodies in space that are not convex, touched by round fingers that are smaller or larger than their hollows.
//!
//! Usage: `relief [BODIES [FIRST]]`: bodies for each range of radii (8) and the first of their seeds. Prints docs/relief.md.

use exploration::contour::Margins;
use exploration::relief::{
    ImplicitSurface, Probing, Relief, ReliefBounds, ReliefEnd, SimulatedFinger, Wave, WavedBody, probe,
};
use exploration::{Heading, Source};
use glam::DVec3;
use recon::shape_bounds::exact_hull::Direction;
use recon_benches::rows::{is_part, rows_in_threads};

type Failure = Box<dyn std::error::Error + Send + Sync>;

/// Seeds of the bodies; settings were chosen on those from 1000 to 1010.
const FIRST_SEED: u64 = 890_000;
/// Radius of the finger over the least radius of the hollows.
const RANGES: [[f64; 2]; 8] = [
    [0.25, 0.5],
    [0.5, 0.8],
    [0.8, 0.95],
    [0.95, 0.999],
    [1.001, 1.05],
    [1.05, 1.25],
    [1.25, 2.0],
    [2.0, 4.0],
];
const DIRECTIONS: usize = 16;
/// Lines are so far apart over the size, or 0.7 of the finger's radius where that is less.
const SPACING: f64 = 0.06;
const NARROW: f64 = 0.7;
/// The least spacing over the spacing.
const LEAST: f64 = 1.0 / 256.0;
const TURN: f64 = 0.2;
/// Least radii of the hollows that are drawn, over the size.
const HOLLOWS: std::ops::Range<f64> = 0.2..1.5;
/// Standard deviations of points per axis over the size and of normals about each axis, rad, and the confidence.
const NOISE: [f64; 2] = [1e-3, 2e-3];
const LEVEL: f64 = 0.95;
const READINGS: usize = 400_000;
/// Points of a surface that bounds are held against.
const POINTS: usize = 100_000;

/// What came of one body: whether all lines were tried, all was felt, each hollow jumped at, a rim left, and the bounds held; jumps whose hollow is wider
/// than they say, and lines.
type Counts = [usize; 7];
/// The width between the hull's bounds over that of the body; its volume's bound over the body's, less 1; of what was felt the error of the least radius that is told,
/// of jumps of the radius that is told over the finger's.
type Shares = [f64; 3];
type Row = (Counts, Shares);

pub(crate) fn main() -> Result<(), Failure> {
    let each: u64 = crate::words().next().map_or(Ok(8), |a| a.parse())?;
    let first: u64 = crate::words().nth(1).map_or(Ok(FIRST_SEED), |a| a.parse())?;
    println!("{}", include_str!("intro.md").trim_end());
    println!("\nMade by `cargo xtask study relief {each} {first}`.\n");
    let noisy = "Points off by 0.1 % of the size, normals by 2 mrad, at 95 %";
    for (title, noise) in [("Exact contacts", None), (noisy, Some(NOISE))] {
        println!("## {title}\n");
        println!(
            "| finger over hollow | runs | all lines | all felt | a jump in each hollow | a rim | hollows wider than a jump says | body within, hull between its bounds | gap of the hull, %, mean | volume over the body's, %, mean | least | lines, mean | largest error of the radius told, % |"
        );
        println!("|---|---|---|---|---|---|---|---|---|---|---|---|---|");
        for (k, range) in RANGES.into_iter().enumerate() {
            let start = first + each * k as u64;
            let seeds: Vec<u64> = (start..start + each).collect();
            let rows: Vec<Row> = rows_in_threads(&seeds, |seed| one(*seed, range, noise))?;
            if !is_part() {
                println!("| {} to {} | {} |", range[0], range[1], cells(&rows));
            }
        }
        println!();
    }
    println!("{}", include_str!("outro.md").trim_end());
    Ok(())
}

/// Counts in all, means and extremes.
fn cells(rows: &[Row]) -> String {
    let runs = rows.len();
    let count = |k: usize| rows.iter().map(|(counts, _)| counts[k]).sum::<usize>();
    let mean = |k: usize| 100.0 * rows.iter().map(|(_, shares)| shares[k]).sum::<f64>() / runs.max(1) as f64;
    let extreme = |k: usize, start: f64, of: fn(f64, f64) -> f64| {
        100.0 * rows.iter().map(|(_, shares)| shares[k]).fold(start, of)
    };
    let [done, felt, jumped, rims, sound, wrong, readings] = [0, 1, 2, 3, 4, 5, 6].map(count);
    format!(
        "{runs} | {done} | {felt} | {jumped} | {rims} | {wrong} | {sound} | {:.2} | {:.2} | {:.2} | {:.0} | {:.1}",
        mean(0),
        mean(1),
        extreme(1, f64::INFINITY, f64::min),
        readings as f64 / runs.max(1) as f64,
        extreme(2, 0.0, f64::max)
    )
}

/// A body, the bottoms of its hollows (of a groove eight of them once round), and their least radius, m.
struct Drawn {
    body: WavedBody,
    bottoms: Vec<DVec3>,
    hollow: f64,
}

/// A groove about an axis, or two hollows with different principal radii, turned anyhow.
fn drawn(source: &mut Source) -> Result<Drawn, Failure> {
    loop {
        let turned = source.rotation();
        let axis = |v: DVec3| Direction::new(turned * v);
        let [one, two] = [source.between(0.1, 0.45), source.between(0.05, 0.4)];
        let groove = source.unit() < 0.5;
        let first = Wave { axis: axis(DVec3::X)?, depth: one, waves: 2 };
        let second = Wave { axis: axis(DVec3::Y)?, depth: two, waves: 2 };
        let (waves, plane) = if groove { (vec![first], DVec3::X) } else { (vec![first, second], DVec3::Z) };
        let body = WavedBody { size: 1.0, waves };
        let round = |k: u32| {
            let (sin, cos) = (f64::from(k) * std::f64::consts::FRAC_PI_4).sin_cos();
            DVec3::new(0.0, cos, sin)
        };
        let bottoms: Vec<DVec3> = if groove { (0..8).map(round).collect() } else { vec![plane, -plane] };
        let bottoms: Vec<DVec3> = bottoms.into_iter().map(|u| turned * u).collect();
        if one + two > 0.75 || !groove && (one - two).abs() < 0.02 {
            continue;
        }
        let Some(hollow) = body.hollow(Direction::new(bottoms[0])?).filter(|r| HOLLOWS.contains(r)) else {
            continue;
        };
        // The bottom is to be the most hollow place there is.
        let least = |x: &DVec3| body.at(*x).curvatures().map_or(0.0, |k| k[0]);
        if body.points(5000).iter().map(least).fold(0.0, f64::min) > -(1.0 + 1e-3) / hollow {
            return Ok(Drawn { body, bottoms, hollow });
        }
    }
}

fn one(seed: u64, [low, high]: [f64; 2], noise: Option<[f64; 2]>) -> Result<Row, Failure> {
    let mut source = Source::new(seed);
    let Drawn { body, bottoms, hollow } = drawn(&mut source)?;
    let radius = hollow * source.between(low, high);
    let points = body.points(POINTS);
    let margins = match noise {
        Some(deviations) => Margins::of_noise_in_space(deviations, LEVEL, READINGS)?,
        None => Margins::EXACT,
    };
    let [point, normal] = noise.unwrap_or_default();
    let mut finger = SimulatedFinger::new(body.clone(), radius)?.with_noise(point, normal, seed);
    let spacing = SPACING.min(NARROW * radius);
    let probing = Probing {
        directions: Direction::spread(DIRECTIONS),
        reach: 1.05 * points.iter().map(|x| x.length()).fold(0.0, f64::max),
        spacing,
        least: LEAST * spacing,
        turn: TURN,
        margins,
        readings: READINGS,
    };
    let found = probe(&mut finger, &probing)?;
    let off = |told: f64, of: f64| (told / of - 1.0).abs();
    let felt = found.is_felt().then(|| found.least_hollow.map_or(1.0, |told| off(told, hollow)));
    let told =
        found.bridges.iter().map(|b| off(b.radius_at_most, radius)).fold(felt.unwrap_or(0.0), f64::max);
    let jumped = bottoms.iter().all(|b| jumps_at(&found, *b));
    let wrong = found.bridges.iter().filter(|b| b.radius_at_most < hollow).count();
    let bounds = ReliefBounds::of(&found, spacing)?;
    let over = bounds.volume_at_most() / body.volume(POINTS) - 1.0;
    let (sound, gap) = judged(&bounds, &points);
    let [done, felt, jumped, rims, sound] =
        [found.end == ReliefEnd::Done, felt.is_some(), jumped, !found.rims.is_empty(), sound]
            .map(usize::from);
    Ok(([done, felt, jumped, rims, sound, wrong, found.readings], [gap, over, told]))
}

/// Whether a jump is told whose middle is seen from the body's centre within 25 degrees of a bottom: those of a groove are 45 degrees apart.
fn jumps_at(found: &Relief, bottom: DVec3) -> bool {
    found.bridges.iter().any(|bridge| {
        let [a, b] = bridge.touches.map(|k| found.touches[k].point);
        let middle = a + b;
        middle.dot(bottom) > 0.9063 * middle.length()
    })
}

/// Whether points of the surface may be of the body and its support function is between the bounds at 24 directions; and what these are apart over the body's width, mean.
fn judged(bounds: &ReliefBounds, points: &[DVec3]) -> (bool, f64) {
    let mut sound = points.iter().step_by(50).all(|x| bounds.may_hold(*x));
    let (mut apart, mut width) = (0.0, 0.0);
    for u in Direction::spread(24) {
        let h = points.iter().map(|x| x.dot(u.get())).fold(f64::NEG_INFINITY, f64::max);
        let (low, high) = bounds.support(u);
        // The farthest of these points is short of the support function by some 1e-4.
        sound &= low <= h + 2e-4 && h <= high;
        apart += high - low;
        width += h;
    }
    (sound, apart / width)
}
