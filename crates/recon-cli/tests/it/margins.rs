//! Bounds of reconstructed bodies against the truth that stands in the log.

use crate::common::{Scratch, Table, fig5};
use glam::{DQuat, DVec3};
use recon_tests::few_or_all;
use serde_json::Value;
use std::fs;

/// Numbers of some columns, row by row.
fn rows(table: &Table, columns: &[&str]) -> Vec<Vec<f64>> {
    let places: Vec<usize> = columns.iter().map(|name| table.column(name)).collect();
    table.rows.iter().map(|row| places.iter().map(|k| row[*k].parse().unwrap()).collect()).collect()
}

fn poses(table: &Table) -> Vec<(DVec3, DQuat)> {
    let pose =
        |r: Vec<f64>| (DVec3::new(r[0], r[1], r[2]), DQuat::from_xyzw(r[4], r[5], r[6], r[3]).normalize());
    rows(table, &["cmx", "cmy", "cmz", "qw", "qx", "qy", "qz"]).into_iter().map(pose).collect()
}

/// From the axes of the bounds to the body's own: the mean over the samples of what takes the estimated pose to the true one.
fn to_body(log: &Table, motion: &Table) -> (DVec3, DQuat) {
    let (truth, found) = (poses(log), poses(motion));
    let errors: Vec<(DVec3, DQuat)> = truth
        .iter()
        .zip(&found)
        .map(|((p, q), (p_hat, q_hat))| (q.inverse() * (*p_hat - *p), q.inverse() * *q_hat))
        .collect();
    let first = errors[0].1;
    let sum = errors.iter().fold([0.0; 4], |mut sum, (_, q)| {
        let sign = q.dot(first).signum();
        sum.iter_mut().zip(q.to_array()).for_each(|(s, x)| *s += sign * x);
        sum
    });
    let shift = errors.iter().map(|(s, _)| *s).sum::<DVec3>() / errors.len() as f64;
    (shift, DQuat::from_array(sum).normalize())
}

/// Vertices and triangles of a binary file of ours.
fn mesh(bytes: &[u8]) -> (Vec<DVec3>, Vec<[usize; 3]>) {
    let end = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    let header = std::str::from_utf8(&bytes[..end]).unwrap();
    let count = |what: &str| -> usize {
        let line = header.lines().find(|l| l.starts_with(what)).unwrap();
        line.rsplit(' ').next().unwrap().parse().unwrap()
    };
    let (corners, faces) = bytes[end..].split_at(24 * count("element vertex"));
    let number = |b: &[u8]| f64::from_le_bytes(b.try_into().unwrap());
    let corner = |b: &[u8]| DVec3::new(number(&b[..8]), number(&b[8..16]), number(&b[16..]));
    let index = |b: &[u8]| u32::from_le_bytes(b.try_into().unwrap()) as usize;
    (
        corners.chunks_exact(24).map(corner).collect(),
        faces.chunks_exact(13).map(|f| [index(&f[1..5]), index(&f[5..9]), index(&f[9..])]).collect(),
    )
}

/// How far the lower bound stands out of the true ellipsoid, and the ellipsoid out of the upper bound, m; negative inside. None
/// for a bound that there is not.
pub(crate) fn out_of_truth(scratch: &Scratch, log: &str, axes: DVec3, summary: &Value) -> [Option<f64>; 2] {
    let (mut log, motion) = (Table::parse(log), Table::parse(&scratch.read("out/motion.csv")));
    log.rows.truncate(motion.rows.len());
    let (shift, turn) = match summary["evidence"]["bounds_frame"]["value"].as_str().unwrap() {
        // Half turns about its axes leave the ellipsoid as it is.
        "principal" => (DVec3::ZERO, DQuat::IDENTITY),
        "mean pose" => to_body(&log, &motion),
        frame => panic!("{frame}"),
    };
    out_of_ellipsoid(scratch, axes, (shift, turn))
}

/// The same of the bounds in the folder `out`, where `turn` and `shift` take their axes to the body's own.
fn out_of_ellipsoid(scratch: &Scratch, axes: DVec3, (shift, turn): (DVec3, DQuat)) -> [Option<f64>; 2] {
    let read = |name: &str| {
        let (corners, faces) = mesh(&fs::read(scratch.path().join("out").join(name)).ok()?);
        Some((corners.into_iter().map(|v| turn * v + shift).collect::<Vec<DVec3>>(), faces))
    };
    let lower = read("lower_bound.ply").map(|(corners, _)| {
        let out = |x: &DVec3| {
            let gauge = (*x / axes).length();
            // Along the normal of the ellipsoid through the point.
            (1.0 - 1.0 / gauge) * x.dot((*x / (axes * axes)).normalize())
        };
        corners.iter().map(out).fold(f64::NEG_INFINITY, f64::max)
    });
    let upper = read("upper_bound.ply").map(|(corners, faces)| {
        let out = |[a, b, c]: &[usize; 3]| {
            let n = (corners[*b] - corners[*a]).cross(corners[*c] - corners[*a]);
            // The normal of a sliver is rounding.
            let n = if n.length() > 1e-7 { n.normalize() } else { return f64::NEG_INFINITY };
            (n * axes).length() - n.dot(corners[*a])
        };
        faces.iter().map(out).fold(f64::NEG_INFINITY, f64::max)
    });
    [lower, upper]
}

fn reconstructed(scratch: &Scratch, log: &str) -> Value {
    let run = scratch.run(&["reconstruct", log, "--scene", "scene.toml", "-o", "out", "--json"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

/// Logs of MuJoCo and Drake have errors that last; the bounds stood out of the body by 2.8e-4 m when contacts alone had margins.
#[test]
fn bounds_hold_on_logs_of_other_simulators() {
    let logs = [
        ("mj_A_fig5", [2.5, 2.0, 1.0], [1.0, 1.45, 2.05], 9.81),
        ("mj_B_gentle", [2.5, 2.0, 1.0], [1.0, 1.45, 2.05], 1.0),
        ("dr_D_tilted", [1.8, 1.3, 0.9], [0.5, 0.81, 0.986], 9.81),
    ];
    for &(name, axes, moments, gravity) in few_or_all(&logs[..1], &logs) {
        let scratch = Scratch::new(name);
        let data = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/data/");
        let log = fs::read_to_string(format!("{data}{name}_thinned.csv")).unwrap();
        scratch.write("log.csv", &log).write(
            "scene.toml",
            &format!("gravity = {gravity}\n[object]\nmass = 1.0\nprincipal_moments = {moments:?}\n"),
        );
        let summary = reconstructed(&scratch, "log.csv");
        let excess = out_of_truth(&scratch, &log, DVec3::from_array(axes), &summary);
        assert!(excess.iter().flatten().all(|e| (-1e-2..=0.0).contains(e)), "{name}: {excess:?}");
        assert_eq!(summary["evidence"]["bounds_frame"]["value"], "principal");
    }
}

/// Noise of the sensors, and of the motion through them; body axes are known worse than the bounds are narrow.
#[test]
fn bounds_hold_under_noise_and_keep_most_of_the_volume() {
    let axes = DVec3::new(2.5, 2.0, 1.0);
    let scratch = Scratch::new("margins");
    let text = fig5().replace("sample_rate = 100.0", "sample_rate = 200.0");
    let mut free = [0.0; 2];
    for &(level, seed) in few_or_all(&[(0.0, 0), (1e-2, 3)][..], &[(0.0, 0), (1e-3, 1), (1e-2, 3)]) {
        let sensors = format!("\n[sensors]\ncontact_std = {}\nforce_std = {}\n", 2.5 * level, 9.81 * level);
        let seeded = text.replace("[simulation]", &format!("[simulation]\nseed = {seed}"));
        scratch.write("scene.toml", &if level > 0.0 { seeded + &sensors } else { seeded });
        assert_eq!(scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]).code, Some(0));
        let summary = reconstructed(&scratch, "log.csv");
        let volumes = ["lower_volume_m3", "upper_volume_m3"].map(|key| summary["bounds"][key].as_f64());
        let (lower, upper) = (volumes[0].unwrap(), volumes[1].unwrap_or(f64::INFINITY));
        let warned = summary["warnings"].to_string().contains("at 95 % confidence");
        assert_eq!(warned, level > 0.0, "{summary:#}");
        let excess = out_of_truth(&scratch, &scratch.read("log.csv"), axes, &summary);
        if level == 0.0 {
            free = [lower, upper];
            // What the quadrature of the forces between samples leaves.
            assert!(excess.iter().flatten().all(|e| (-1e-4..=0.0).contains(e)), "{excess:?}");
            continue;
        }
        assert!(excess.iter().flatten().all(|e| *e <= 0.0), "noise {level}: {excess:?}");
        let (least, most) = if level < 5e-3 { (0.9, 2.0) } else { (0.6, f64::INFINITY) };
        assert!(least * free[0] < lower && lower < free[0], "noise {level}: {lower} of {free:?}");
        assert!(free[1] < upper && upper <= most * free[1], "noise {level}: {upper} of {free:?}");
    }
}
