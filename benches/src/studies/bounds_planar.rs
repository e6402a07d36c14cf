//! Bounds in the plane and of concave bodies: time, soundness and what they give away.
//!
//! Usage: `bounds_planar [RUNS]` (1000 by default). Prints the table `docs/charts/bounds/planar.csv` and
//! writes `docs/charts/bounds/concave.csv`.

use cpu_time::ThreadTime;
use glam::{DVec2, DVec3};
use recon::contact_kinematics::Direction as Direction3;
use recon::contact_kinematics::planar::{Ellipse, RadiusBounds, RadiusFunction};
use shape_bounds::concave::{AlphaShape, HermiteSurface};
use shape_bounds::exact_hull::planar::{Direction, Hull, Intersection};
use shape_bounds::generators::{AXES, Source};
use shape_bounds::planar::curvature::CurvatureBounds;
use shape_bounds::planar::noise::{ContactNoise, NoisyContact};
use shape_bounds::planar::{ContactSample, IncrementalBounds, ShapeBounds};
use std::f64::consts::{PI, TAU};
use std::fmt::Write as _;

type Failure = Box<dyn std::error::Error>;

pub(crate) fn main() -> Result<(), Failure> {
    let runs: u64 = crate::words().next().map_or(Ok(1000), |a| a.parse())?;
    std::fs::create_dir_all("docs/charts/bounds")?;
    let mut csv = String::from("what,n,value\n");
    timing(&mut csv)?;
    gains(&mut csv)?;
    noise(runs, &mut csv)?;
    print!("{csv}");
    let mut csv = String::from("what,n,value\n");
    concave(runs, &mut csv)?;
    alpha(&mut csv)?;
    surface(&mut csv)?;
    std::fs::write("docs/charts/bounds/concave.csv", csv)?;
    Ok(())
}

fn body() -> Result<Ellipse, Failure> {
    Ok(Ellipse::new(2.0, 1.0, DVec2::new(0.2, 0.1))?)
}

fn contacts(angles: impl IntoIterator<Item = f64>) -> Result<Vec<ContactSample>, Failure> {
    let body = body()?;
    let contact =
        |angle: f64| ContactSample { point: body.point(angle), normal: Direction::from_angle(angle) };
    Ok(angles.into_iter().map(contact).collect())
}

/// Thread time in ms, the fastest of three.
fn fastest<T>(mut work: impl FnMut() -> Result<T, Failure>) -> Result<f64, Failure> {
    let mut best = f64::INFINITY;
    for _ in 0..3 {
        let start = ThreadTime::now();
        std::hint::black_box(work()?);
        best = best.min(start.elapsed().as_secs_f64() * 1e3);
    }
    Ok(best)
}

fn timing(csv: &mut String) -> Result<(), Failure> {
    for n in [1_000, 10_000, 100_000, 1_000_000] {
        let mut s = Source::new(n as u64);
        let samples = contacts((0..n).map(|_| s.between(0.0, TAU)))?;
        let points: Vec<DVec2> = samples.iter().map(|c| c.point).collect();
        let planes: Vec<_> = samples.iter().map(ContactSample::half_plane).collect();
        let hull = fastest(|| Ok(Hull::of(&points)?))?;
        let region = fastest(|| Ok(Intersection::of(&planes)?))?;
        writeln!(csv, "hull ms,{n},{hull:.3}\nhalf-planes ms,{n},{region:.3}")?;
        if n <= 10_000 {
            let start = ThreadTime::now();
            let mut bounds = IncrementalBounds::new();
            for c in &samples {
                bounds.insert(c)?;
            }
            writeln!(
                csv,
                "incremental us per contact,{n},{:.2}",
                start.elapsed().as_secs_f64() * 1e6 / n as f64
            )?;
        }
        if n <= 100_000 {
            let radii = RadiusBounds { min: 0.5, max: 4.0 };
            let discs = fastest(|| Ok(CurvatureBounds::from_contacts(&samples, radii)?))?;
            writeln!(csv, "discs ms,{n},{discs:.3}")?;
        }
    }
    Ok(())
}

/// What limits on the curvature gain, at even spacing.
fn gains(csv: &mut String) -> Result<(), Failure> {
    for n in [6, 12, 24, 48] {
        let samples = contacts((0..n).map(|k| TAU * f64::from(k) / f64::from(n)))?;
        let plain = ShapeBounds::from_contacts(&samples)?;
        let curved = CurvatureBounds::from_contacts(&samples, RadiusBounds { min: 0.5, max: 4.0 })?;
        let gap = (plain.upper_area() - plain.lower_area()) / TAU;
        let tight = (curved.upper().area() - curved.lower().area()) / TAU;
        writeln!(csv, "gap over area,{n},{gap:.5}\ngap over area with curvature,{n},{tight:.5}")?;
    }
    Ok(())
}

/// Coverage and price of the bounds under noise.
fn noise(runs: u64, csv: &mut String) -> Result<(), Failure> {
    let body = body()?;
    for (confidence, level) in [(0.95, 1e-3), (0.99, 1e-3), (0.95, 3e-3)] {
        let (mut sound, mut ratios) = (0, Vec::new());
        for seed in 0..runs {
            let mut s = Source::new(seed);
            let count = 300;
            let exact = contacts((0..count).map(|k| TAU * f64::from(k) / f64::from(count)))?;
            let noisy = exact.iter().map(|c| {
                let point = c.point + DVec2::new(s.normal(), s.normal()) * (2.0 * level);
                let normal = Direction::from_angle(c.normal.angle() + s.normal() * level);
                NoisyContact {
                    contact: ContactSample { point, normal },
                    noise: ContactNoise::isotropic(2.0 * level, level),
                }
            });
            let bounds = ShapeBounds::from_noisy_curves(&[noisy.collect()], confidence)?;
            sound += u32::from((0..360).all(|k| {
                let angle = TAU * f64::from(k) / 360.0;
                let (low, high) = bounds.support(Direction::from_angle(angle));
                low <= body.jet(angle).r + 1e-9 && body.jet(angle).r <= high + 1e-9
            }));
            ratios.push((bounds.upper_area() - bounds.lower_area()) / TAU);
        }
        ratios.sort_by(f64::total_cmp);
        writeln!(csv, "sound runs of {runs} at {confidence} and {level:e},300,{sound}")?;
        writeln!(
            csv,
            "gap over area at {confidence} and {level:e} median,300,{:.5}",
            ratios[ratios.len() / 2]
        )?;
    }
    Ok(())
}

/// A body of revolution with a waist: the profile is at distance `1 + 0.35 cos 2 polar` from the centre.
fn waisted(polar: f64, around: f64) -> Result<shape_bounds::ContactSample, Failure> {
    let (r, slope) = (1.0 + 0.35 * (2.0 * polar).cos(), -0.7 * (2.0 * polar).sin());
    let (sin, cos) = polar.sin_cos();
    // Derivative of the profile (axis, radius) by the polar angle, turned outwards.
    let (axial, radial) = (slope * cos - r * sin, slope * sin + r * cos);
    let out = DVec3::new(around.cos(), around.sin(), 0.0);
    let normal = Direction3::new(out * -axial + DVec3::Z * radial)?;
    Ok(shape_bounds::ContactSample { point: out * (r * sin) + DVec3::Z * (r * cos), normal })
}

/// How often the half-spaces that are kept hold the whole body, and by how much they fail.
fn concave(runs: u64, csv: &mut String) -> Result<(), Failure> {
    let mut s = Source::new(1);
    let dense: Vec<DVec3> = (0..4000)
        .map(|_| Ok(waisted(s.between(0.0, PI), s.between(0.0, TAU))?.point))
        .collect::<Result<_, Failure>>()?;
    for n in [20, 50, 200, 1000] {
        let (mut kept, mut sound, mut worst) = (0.0, 0, 0.0_f64);
        let runs = if n == 1000 { runs / 10 } else { runs };
        for _ in 0..runs {
            let contacts: Vec<_> = (0..n)
                .map(|_| waisted((1.0 - 2.0 * s.unit()).acos(), s.between(0.0, TAU)))
                .collect::<Result<_, Failure>>()?;
            let (_, used) = shape_bounds::ShapeBounds::from_concave_contacts(&contacts)?;
            kept += used.len() as f64 / (n as f64 * runs as f64);
            let excess =
                |p: &DVec3| used.iter().map(|i| contacts[*i].half_space().excess(*p)).fold(0.0, f64::max);
            let most = dense.iter().map(excess).fold(0.0, f64::max);
            worst = worst.max(most);
            sound += u64::from(most < 1e-9);
        }
        writeln!(csv, "waisted body: share of contacts kept,{n},{kept:.3}")?;
        writeln!(
            csv,
            "waisted body: share of runs with all of it inside,{n},{:.3}",
            sound as f64 / runs as f64
        )?;
        writeln!(csv, "waisted body: largest excess m,{n},{worst:.4}")?;
    }
    Ok(())
}

fn alpha(csv: &mut String) -> Result<(), Failure> {
    // A torus of radii 1 and 0.3; and the body with the waist, by Simpson's rule over pi r^2 dz.
    let torus = 2.0 * PI * PI * 0.09;
    let steps = 20_000;
    let waist: f64 = (0..steps)
        .map(|k| {
            let polar = PI * (f64::from(k) + 0.5) / f64::from(steps);
            let r = 1.0 + 0.35 * (2.0 * polar).cos();
            2.0 * PI / 3.0 * r.powi(3) * polar.sin() * PI / f64::from(steps)
        })
        .sum();
    for n in [1_000, 10_000, 100_000] {
        let mut s = Source::new(4);
        let ring: Vec<DVec3> = (0..n)
            .map(|_| {
                let (u, v) = (s.between(0.0, TAU), s.between(0.0, TAU));
                let out = DVec3::new(u.cos(), u.sin(), 0.0);
                out * (1.0 + 0.3 * v.cos()) + DVec3::Z * (0.3 * v.sin())
            })
            .collect();
        let start = ThreadTime::now();
        let shape = AlphaShape::of(&ring)?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        writeln!(csv, "torus: alpha volume over true,{n},{:.4}", shape.volume(0.34)? / torus)?;
        writeln!(csv, "torus: hull volume over true,{n},{:.4}", shape.volume(f64::INFINITY)? / torus)?;
        writeln!(csv, "torus: ms,{n},{ms:.1}")?;
        let body: Vec<DVec3> = (0..n)
            .map(|_| Ok(waisted((1.0 - 2.0 * s.unit()).acos(), s.between(0.0, TAU))?.point))
            .collect::<Result<_, Failure>>()?;
        let shape = AlphaShape::of(&body)?;
        let radius = shape.connecting_radius();
        writeln!(csv, "waisted body: connecting radius,{n},{radius:.4}")?;
        writeln!(
            csv,
            "waisted body: volume at that radius over true,{n},{:.4}",
            shape.volume(radius)? / waist
        )?;
        writeln!(csv, "waisted body: hull volume over true,{n},{:.4}", shape.volume(f64::INFINITY)? / waist)?;
    }
    Ok(())
}

/// Error of the Hermite surface on the ellipsoid, along rays from its centre, and its time.
fn surface(csv: &mut String) -> Result<(), Failure> {
    for n in [40, 80, 160, 320] {
        let contacts: Vec<_> = (0..n)
            .map(|i| {
                let z = 1.0 - (2.0 * f64::from(i) + 1.0) / f64::from(n);
                let (sin, cos) = (PI * (3.0 - 5f64.sqrt()) * f64::from(i)).sin_cos();
                let across = (1.0 - z * z).sqrt();
                let p = DVec3::new(across * cos, across * sin, z);
                Ok(shape_bounds::ContactSample { point: p * AXES, normal: Direction3::new(p / AXES)? })
            })
            .collect::<Result<_, Failure>>()?;
        let start = ThreadTime::now();
        let surface = HermiteSurface::through(&contacts)?;
        let ms = start.elapsed().as_secs_f64() * 1e3;
        let mut s = Source::new(7);
        let (mut square, mut largest) = (0.0, 0.0_f64);
        for _ in 0..200 {
            let d = s.direction();
            let truth = 1.0 / (d / AXES).length();
            let error = surface.along_ray(DVec3::ZERO, d, 4.0).ok_or("no crossing")? - truth;
            square += error * error / 200.0;
            largest = largest.max(error.abs());
        }
        writeln!(csv, "ellipsoid: surface rms error m,{n},{:.2e}", square.sqrt())?;
        writeln!(
            csv,
            "ellipsoid: surface largest error m,{n},{largest:.2e}\nellipsoid: surface ms,{n},{ms:.1}"
        )?;
    }
    Ok(())
}
