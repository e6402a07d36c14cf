//! Curvature bounds: the chain of bounds on random bodies, what they gain on three curves, and what equal balls cost.
//!
//! Bounds: (a) hull, (d) rounded hull, (d+) ball hull, the body, (c+) rounded balls, (c) balls, (b) half-spaces.
//!
//! Usage: `bounds_curvature [BODIES]` (10,000 by default). Prints the table `docs/charts/bounds/curvature.csv` and
//! writes `docs/charts/bounds/curvature_timing.csv`.

use crate::rows;
use cpu_time::ThreadTime;
use glam::DVec3;
use recon::contact_kinematics::{CurvatureRadii, Direction};
use shape_bounds::curvature::{BallIntersection, CurvatureBounds, SharpBounds};
use shape_bounds::exact_hull::{HalfSpace, Intersection};
use shape_bounds::generators::{AXES, Source, curve_contacts};
use shape_bounds::{ContactSample, ShapeBounds};
use std::fmt::Write as _;

type Failure = Box<dyn std::error::Error>;

/// What rounding may take from an inclusion, relative to the size.
const ROUNDING: f64 = 1e-12;
const BALL: f64 = 4.0 / 3.0 * std::f64::consts::PI;

pub(crate) fn main() -> Result<(), Failure> {
    let bodies: u64 = crate::words().next().map_or(Ok(10_000), |a| a.parse())?;
    std::fs::create_dir_all("docs/charts/bounds")?;
    let (mut broken, mut skipped) = (0, 0);
    for seed in 0..bodies {
        let Some((ok, left_out)) = rows::row(|| chain_holds(seed))? else { continue };
        broken += usize::from(!ok);
        skipped += left_out;
    }
    println!("# {bodies} random bodies: {broken} broken chains, {skipped} balls left out");
    gains()?;
    if !rows::is_part() {
        std::fs::write("docs/charts/bounds/curvature_timing.csv", timing()?)?;
    }
    if broken > 0 { Err("a chain is broken".into()) } else { Ok(()) }
}

/// A random ellipsoid, touched at random places: (a) in (d) in body in (c) in (b), by support functions and volumes.
fn chain_holds(seed: u64) -> Result<(bool, usize), Failure> {
    let mut s = Source::new(seed + 40_000);
    let axes = DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0));
    let turn = s.rotation();
    let shift = s.normal3();
    let support = |n: DVec3| (axes * (turn.inverse() * n)).length() + shift.dot(n);
    let count = 8 + s.below(120);
    let contacts: Vec<ContactSample> = (0..count)
        .map(|_| {
            let n = s.direction();
            let m = turn.inverse() * n;
            let point = turn * (axes * axes * m / (axes * m).length()) + shift;
            Ok(ContactSample { point, normal: Direction::new(n)? })
        })
        .collect::<Result<_, Failure>>()?;
    let (low, high) = (axes.min_element(), axes.max_element());
    let radii = CurvatureRadii { min: low * low / high, max: high * high / low };
    let plain = ShapeBounds::from_contacts(&contacts)?;
    let tight = CurvatureBounds::from_contacts(&contacts, radii)?;
    let sharp = SharpBounds::from_contacts(&contacts, radii)?;
    let truth = BALL * axes.element_product();
    let volumes = [
        plain.lower_volume(),
        tight.lower().volume(),
        sharp.lower().volume(),
        truth,
        sharp.upper().volume(),
        tight.upper().volume(),
        plain.upper_volume(),
    ];
    let mut holds = volumes.windows(2).all(|w| w[0] <= w[1] * (1.0 + ROUNDING));
    for _ in 0..20 {
        let direction = s.direction();
        let n = Direction::new(direction)?;
        let ((a, b), (d, c), (e, f)) = (plain.support(n), tight.support(n), sharp.support(n));
        holds &= [a, d, e, support(direction), f, c, b].windows(2).all(|w| w[0] <= w[1] + ROUNDING * 4.0);
    }
    let skipped = tight.upper().skipped() + sharp.lower().skipped() + sharp.upper().core().skipped();
    Ok((holds, skipped))
}

/// Volumes relative to the truth on three curves of a thousand contacts, in all and each.
fn gains() -> Result<(), Failure> {
    println!(
        "contacts,seed,hull,rounded_hull,ball_hull,rounded_balls,balls,half_spaces,gap_ratio,sharp_gap_ratio"
    );
    let radii = CurvatureRadii { min: 0.4, max: 6.25 };
    let truth = BALL * AXES.element_product();
    for count in [1000, 3000] {
        let mut ratios = [Vec::new(), Vec::new()];
        for seed in 0..20 {
            let volumes = rows::row(|| -> Result<[f64; 6], Failure> {
                let contacts = curve_contacts(count, seed);
                let plain = ShapeBounds::from_contacts(&contacts)?;
                let tight = CurvatureBounds::from_contacts(&contacts, radii)?;
                let sharp = SharpBounds::from_contacts(&contacts, radii)?;
                Ok([
                    plain.lower_volume(),
                    plain.upper_volume(),
                    tight.upper().volume(),
                    tight.lower().volume(),
                    sharp.lower().volume(),
                    sharp.upper().volume(),
                ])
            })?;
            let Some([a, b, c, d, e, f]) = volumes.map(|all| all.map(|volume| volume / truth)) else {
                continue;
            };
            let both = [(c - d) / (b - a), (f - e) / (b - a)];
            println!(
                "{count},{seed},{a:.4},{d:.4},{e:.4},{f:.4},{c:.4},{b:.4},{:.4},{:.4}",
                both[0], both[1]
            );
            (0..2).for_each(|k| ratios[k].push(both[k]));
        }
        for (name, mut ratios) in ["(c)-(d)", "(c+)-(d+)"].into_iter().zip(ratios) {
            ratios.sort_unstable_by(f64::total_cmp);
            let [low, median, high] = [0, 10, 19].map(|k: usize| ratios.get(k).copied().unwrap_or(f64::NAN));
            println!("# {count} contacts, {name} to (b)-(a): {low:.3} to {high:.3}, median {median:.3}");
        }
    }
    Ok(())
}

/// Thread time in ms, the fastest of a few runs, of half-spaces and balls on the same contacts.
fn timing() -> Result<String, Failure> {
    let mut csv = String::from("n,half_spaces_ms,balls_ms,ratio,balls_left_out\n");
    for n in [1000, 10_000, 100_000, 1_000_000] {
        let contacts = curve_contacts(n, 1);
        let spaces: Vec<HalfSpace> = contacts.iter().map(ContactSample::half_space).collect();
        let mut best = [f64::INFINITY; 2];
        let mut left_out = 0;
        for _ in 0..4 {
            let start = ThreadTime::now();
            std::hint::black_box(Intersection::of(&spaces)?);
            best[0] = best[0].min(start.elapsed().as_secs_f64() * 1e3);
            let start = ThreadTime::now();
            left_out = std::hint::black_box(BallIntersection::through_contacts(&contacts, 6.25)?).skipped();
            best[1] = best[1].min(start.elapsed().as_secs_f64() * 1e3);
        }
        let line = format!("{n},{:.3},{:.3},{:.2},{left_out}", best[0], best[1], best[1] / best[0]);
        eprintln!("{line}");
        writeln!(csv, "{line}")?;
    }
    Ok(csv)
}
