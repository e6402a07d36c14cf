//! Bodies tossed onto a table in MuJoCo and tracked with noise: do the bounds from their poses hold, and how tight are they?
//!
//! Usage: `bounds_tosses [SETS]` (3 sets of 100 tosses for each body and noise by default). Needs Python with MuJoCo.
//! Prints a table in Markdown.

use glam::DVec3;
use recon::shape_bounds::PoseBounds;
use recon_io::parse_poses;
use std::f64::consts::PI;
use std::process::Command;

const TOSSES: u32 = 100;

/// A convex body of `benches/peers/tosses.py`.
struct Body {
    name: &'static str,
    volume: f64,
    support: fn(DVec3) -> f64,
    contains: fn(DVec3) -> bool,
}

const BOX: DVec3 = DVec3::new(0.05, 0.04, 0.03);
const ELLIPSOID: DVec3 = DVec3::new(0.06, 0.05, 0.04);
/// Vertices of the tetrahedron: of the cube of this half side, every other one.
const TETRAHEDRON: f64 = 0.06;

const BODIES: [Body; 5] = [
    Body {
        name: "box",
        volume: 8.0 * 0.05 * 0.04 * 0.03,
        support: |n| BOX.dot(n.abs()),
        contains: |p| (p.abs() / BOX).max_element() <= 1.0,
    },
    Body {
        name: "ellipsoid",
        volume: 4.0 / 3.0 * PI * 0.06 * 0.05 * 0.04,
        support: |n| (ELLIPSOID * n).length(),
        contains: |p| (p / ELLIPSOID).length() <= 1.0,
    },
    Body {
        name: "capsule",
        volume: PI * 0.03 * 0.03 * (0.08 + 0.04),
        support: |n| 0.03 + 0.04 * n.z.abs(),
        contains: |p| p.distance(DVec3::Z * p.z.clamp(-0.04, 0.04)) <= 0.03,
    },
    Body {
        name: "cylinder",
        volume: PI * 0.04 * 0.04 * 0.1,
        support: |n| 0.04 * n.x.hypot(n.y) + 0.05 * n.z.abs(),
        contains: |p| p.x.hypot(p.y) <= 0.04 && p.z.abs() <= 0.05,
    },
    Body {
        name: "tetrahedron",
        volume: 8.0 / 3.0 * TETRAHEDRON * TETRAHEDRON * TETRAHEDRON,
        support: |n| corners().map(|c| c.dot(n)).into_iter().fold(f64::NEG_INFINITY, f64::max),
        // Each face is opposite to a corner c: its plane is -c . p = a^2.
        contains: |p| corners().iter().all(|c| -c.dot(p) <= TETRAHEDRON * TETRAHEDRON),
    },
];

fn corners() -> [DVec3; 4] {
    let a = TETRAHEDRON;
    [DVec3::new(a, a, a), DVec3::new(a, -a, -a), DVec3::new(-a, a, -a), DVec3::new(-a, -a, a)]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let sets: u64 = std::env::args().nth(1).map_or(Ok(3), |a| a.parse())?;
    println!("# Bounds from poses of tossed bodies\n");
    println!(
        "Made by `cargo xtask study bounds_tosses`: MuJoCo tosses a body, {TOSSES} times a set, 148 frames a second."
    );
    println!(
        "Upper and lower: sets in which the body lies in the upper bound and holds the lower one. Volumes and margins are medians over the {sets} sets.\n"
    );
    println!(
        "| body | noise | confidence | upper holds | lower holds | upper volume / true | lower volume / true | margin, mm |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for body in &BODIES {
        for (position, rotation) in [(2.5e-5, 3e-4), (2e-4, 2e-3)] {
            let runs: Vec<_> =
                (0..sets).map(|seed| toss(body, position, rotation, seed)).collect::<Result<_, _>>()?;
            for confidence in [0.95, 0.99] {
                let made: Vec<PoseBounds> = runs
                    .iter()
                    .map(|runs| PoseBounds::above_plane(runs, 0.0, confidence))
                    .collect::<Result<_, _>>()?;
                let upper = made.iter().filter(|b| holds(body, b)).count();
                let lower = made.iter().filter(|b| inside(body, b)).count();
                let of = |value: &dyn Fn(&PoseBounds) -> f64| median(made.iter().map(value).collect());
                println!(
                    "| {} | {:.3} mm, {:.1} mrad | {:.0} % | {upper} of {sets} | {lower} of {sets} | {:.3} | {:.3} | {:.2} |",
                    body.name,
                    position * 1e3,
                    rotation * 1e3,
                    confidence * 100.0,
                    of(&|b| b.upper.volume() / body.volume),
                    of(&|b| solid_volume(b) / body.volume),
                    of(&|b| b.margin * 1e3),
                );
            }
        }
    }
    Ok(())
}

/// Poses of one set of tosses, from MuJoCo.
fn toss(
    body: &Body,
    position: f64,
    rotation: f64,
    seed: u64,
) -> Result<Vec<Vec<recon::shape_bounds::BodyPose>>, Box<dyn std::error::Error>> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/tosses.py");
    let arguments = [TOSSES.to_string(), position.to_string(), rotation.to_string(), seed.to_string()];
    let output = Command::new("python3").args([script, body.name]).args(arguments).output()?;
    if !output.status.success() {
        return Err(format!(
            "{script} needs Python with MuJoCo: {}",
            String::from_utf8_lossy(&output.stderr)
        )
        .into());
    }
    Ok(parse_poses(&output.stdout[..])?)
}

fn holds(body: &Body, bounds: &PoseBounds) -> bool {
    bounds
        .upper
        .face_half_spaces()
        .iter()
        .all(|h| (body.support)(h.normal.get()) <= h.normal.get().dot(h.point) + h.margin)
}

fn inside(body: &Body, bounds: &PoseBounds) -> bool {
    let solid = bounds.lower.as_ref().and_then(|lower| lower.solid());
    solid.is_none_or(|solid| solid.vertices().iter().all(|v| (body.contains)(*v)))
}

fn solid_volume(bounds: &PoseBounds) -> f64 {
    bounds.lower.as_ref().and_then(|lower| lower.solid()).map_or(0.0, |solid| solid.volume())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_unstable_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}
