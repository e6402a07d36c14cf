//! Right contacts in the plane under noise, in the order in which they were traced and in none: do both bounds hold, and is any contact
//! called impossible?
//!
//! Usage: `bounds_planar_noise [RUNS] [SEED]` (1000 runs from seed 95000 by default). Writes `docs/bounds-planar-noise.md`.

use cpu_time::ThreadTime;
use glam::DVec2;
use recon::contact_kinematics::planar::{Ellipse, RadiusFunction};
use shape_bounds::exact_hull::planar::Direction;
use shape_bounds::generators::Source;
use shape_bounds::planar::noise::{ContactNoise, NoisyContact, with_noise_as_found, without_outliers};
use shape_bounds::planar::{ContactSample, ShapeBounds};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::fmt::Write as _;

type Failure = Box<dyn std::error::Error>;

/// Standard deviation of normals, rad, and of points over the size.
const LEVEL: f64 = 1e-3;
const CONFIDENCE: f64 = 0.95;
/// Directions in which bounds are compared with the body.
const DIRECTIONS: u32 = 360;

/// A body, touched evenly along its outline or by the normal.
#[derive(Clone, Copy)]
enum Body {
    Ellipse(Ellipse),
    /// Square of this half side, grown by a radius.
    RoundedSquare(f64, f64),
}

impl Body {
    /// Support function, m.
    fn support(&self, angle: f64) -> f64 {
        match self {
            Self::Ellipse(ellipse) => ellipse.jet(angle).r,
            Self::RoundedSquare(half, radius) => {
                let (sin, cos) = angle.sin_cos();
                half * (sin.abs() + cos.abs()) + radius
            }
        }
    }

    /// The contact at this part of the way around.
    fn contact(&self, way: f64) -> ContactSample {
        match self {
            Self::Ellipse(ellipse) => {
                let angle = TAU * way;
                ContactSample { point: ellipse.point(angle), normal: Direction::from_angle(angle) }
            }
            Self::RoundedSquare(half, radius) => {
                let (quarter, rest) = ((4.0 * way).floor(), (4.0 * way).fract());
                // From the middle of one side to that of the next.
                let s = rest * (2.0 * half + FRAC_PI_2 * radius);
                let angle = ((s - half) / radius).clamp(0.0, FRAC_PI_2);
                let past = (s - half - FRAC_PI_2 * radius).max(0.0);
                let corner = DVec2::new(half + 0.0, s.min(*half)) - DVec2::X * past;
                let point = corner + DVec2::from_angle(angle) * *radius;
                let turn = DVec2::from_angle(FRAC_PI_2 * quarter);
                let normal = Direction::from_angle(angle + FRAC_PI_2 * quarter);
                ContactSample { point: turn.rotate(point), normal }
            }
        }
    }
}

/// What was counted over all runs.
#[derive(Default)]
struct Counts {
    hold: u64,
    without: u64,
    runs_impossible: u64,
    impossible: usize,
    rough: usize,
    seconds: f64,
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut words = crate::words();
    let runs: u64 = words.next().map_or(Ok(1000), |a| a.parse())?;
    let first: u64 = words.next().map_or(Ok(95_000), |a| a.parse())?;
    let ellipse = Body::Ellipse(Ellipse::new(2.0, 1.0, DVec2::new(0.2, 0.1))?);
    let bodies = [
        ("ellipse 2 : 1", ellipse),
        ("square, corners of a fifth", Body::RoundedSquare(0.8, 0.2)),
        ("square, corners of a twentieth", Body::RoundedSquare(0.95, 0.05)),
    ];
    let mut text = format!(
        "# Right contacts in the plane under noise\n\nMade by `cargo xtask study bounds_planar_noise {runs} {first}`.\n\n\
         Noise of {LEVEL} of the size and {LEVEL} rad, stated; confidence {CONFIDENCE}; {runs} runs a row from seed {first} on. Called impossible: \
         contacts that \"cannot be right beside the others\". Not smooth: contacts \"not explained by a smooth curve\", an edge or an error.\n\n\
         | body | contacts | rows | both bounds hold | no bounds | runs with a contact called impossible | contacts called impossible | not smooth, a run | ms a run |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for (name, body) in bodies {
        for count in [100, 300, 1000] {
            for shuffled in [false, true] {
                let counts = counted(&body, count, shuffled, first..first + runs)?;
                writeln!(
                    text,
                    "| {name} | {count} | {} | {} | {} | {} | {} of {} | {:.2} | {:.1} |",
                    if shuffled { "in no order" } else { "as traced" },
                    counts.hold,
                    counts.without,
                    counts.runs_impossible,
                    counts.impossible,
                    runs * count as u64,
                    counts.rough as f64 / runs as f64,
                    1e3 * counts.seconds / runs as f64,
                )?;
            }
        }
    }
    print!("{text}");
    Ok(())
}

fn counted(
    body: &Body,
    count: usize,
    shuffled: bool,
    seeds: std::ops::Range<u64>,
) -> Result<Counts, Failure> {
    let mut counts = Counts::default();
    for seed in seeds {
        let run = crate::rows::row(|| -> Result<(f64, Option<bool>, [usize; 2]), Failure> {
            let curve = measured(body, count, shuffled, &mut Source::new(seed))?;
            let start = ThreadTime::now();
            let (noisy, _) = with_noise_as_found(&[curve]);
            let (kept, outliers) = without_outliers(&noisy, CONFIDENCE)?;
            let bounds = ShapeBounds::from_noisy_curves(&kept, CONFIDENCE);
            let seconds = start.elapsed().as_secs_f64();
            let impossible = outliers.iter().filter(|o| o.share > 0.0).count();
            Ok((seconds, bounds.ok().map(|b| holds(body, &b)), [impossible, outliers.len() - impossible]))
        })?;
        let Some((seconds, holds, [impossible, rough])) = run else { continue };
        counts.seconds += seconds;
        match holds {
            Some(holds) => counts.hold += u64::from(holds),
            None => counts.without += 1,
        }
        counts.runs_impossible += u64::from(impossible > 0);
        counts.impossible += impossible;
        counts.rough += rough;
    }
    Ok(counts)
}

fn measured(body: &Body, count: usize, shuffled: bool, s: &mut Source) -> Result<Vec<NoisyContact>, Failure> {
    let size = 2.0 * LEVEL;
    let start = s.unit();
    let mut curve: Vec<NoisyContact> = (0..count)
        .map(|k| {
            let exact = body.contact((start + k as f64 / count as f64).fract());
            let n = exact.normal.get();
            let contact = ContactSample {
                point: exact.point + DVec2::new(s.normal(), s.normal()) * size,
                normal: Direction::new(n + n.perp() * (LEVEL * s.normal()))?,
            };
            Ok(NoisyContact { contact, noise: ContactNoise::isotropic(size, LEVEL) })
        })
        .collect::<Result<_, Failure>>()?;
    if shuffled {
        for k in (1..count).rev() {
            curve.swap(k, (s.unit() * (k + 1) as f64) as usize);
        }
    }
    Ok(curve)
}

fn holds(body: &Body, bounds: &ShapeBounds) -> bool {
    (0..DIRECTIONS).all(|k| {
        let angle = TAU * f64::from(k) / f64::from(DIRECTIONS);
        let (low, high) = bounds.support(Direction::from_angle(angle));
        let truth = body.support(angle);
        low <= truth + 1e-9 && truth <= high + 1e-9
    })
}
