//! Bounds from contacts with noise and from poses above a plane.

use crate::common::Scratch;
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fmt::Write;

/// Deterministic numbers that look like noise: within 1 of zero, mean square 1/2.
fn wobble(k: usize) -> f64 {
    (k as f64 * 78.233).sin()
}

/// Contacts of a curve.
const EACH: usize = 150;

/// Contacts along three great-circle-like curves of normals on the unit sphere, off by up to `noise`; contact 41 of curve 2
/// is off by `wrong`.
fn sphere_contacts(noise: f64, wrong: f64) -> String {
    let mut text = String::from("curve,x,y,z,nx,ny,nz\n");
    for k in 0..3 * EACH {
        let (curve, turn) = (k / EACH, TAU * (k % EACH) as f64 / EACH as f64);
        let (s, c) = turn.sin_cos();
        let lift = 0.4 * (2.0 * turn).sin();
        let n = [[c, s, lift], [lift, c, s], [s, lift, c]][curve];
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let n = n.map(|x| x / length);
        let off = |i: usize| noise * wobble(3 * k + i) + if k == EACH + 40 && i == 0 { wrong } else { 0.0 };
        let x: Vec<String> = (0..3).map(|i| (n[i] + off(i)).to_string()).collect();
        writeln!(text, "{},{},{},{},{}", curve + 1, x.join(","), n[0], n[1], n[2]).unwrap();
    }
    text
}

fn bounds(scratch: &Scratch, arguments: &[&str]) -> Value {
    let run = scratch.run(&[&["bounds", "--json"], arguments].concat());
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

fn volumes(summary: &Value) -> [f64; 2] {
    ["lower_volume_m3", "upper_volume_m3"].map(|name| summary["bounds"][name].as_f64().unwrap())
}

#[test]
fn noise_is_stated_or_estimated_and_a_wrong_contact_left_out() {
    let scratch = Scratch::new("noise");
    scratch.write("clean.csv", &sphere_contacts(0.0, 0.0)).write("noisy.csv", &sphere_contacts(1e-3, 0.2));
    let sphere = 4.0 / 3.0 * PI;
    let [exact_lower, exact_upper] = volumes(&bounds(&scratch, &["clean.csv"]));
    let stated =
        bounds(&scratch, &["noisy.csv", "--contact-noise", "1e-3", "--normal-noise", "1e-3", "-o", "out"]);
    let estimated = bounds(&scratch, &["noisy.csv", "--estimate-noise", "--confidence", "0.99"]);
    for summary in [&stated, &estimated] {
        let [lower, upper] = volumes(summary);
        assert!(lower < exact_lower && exact_lower < sphere, "{lower} {exact_lower}");
        assert!(sphere < exact_upper && exact_upper < upper, "{exact_upper} {upper}");
        let outliers = summary["about"]["outliers"].as_array().unwrap();
        assert!(outliers.iter().any(|o| o["curve"] == 2 && o["contact"] == 41), "{outliers:?}");
        assert!(summary["warnings"][0].as_str().unwrap().contains("contact 41 of curve 2"));
    }
    // The wobble has a mean square of half its square; differences along a curve show it within a factor.
    let level = estimated["about"]["noise"]["estimated"][0]["across_m"].as_f64().unwrap();
    assert!((0.5e-3..3e-3).contains(&level), "{level}");
    for name in ["lower_bound.ply", "upper_bound.ply", "summary.json"] {
        assert!(scratch.path().join("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn limits_on_the_curvature_tighten_the_bounds() {
    let scratch = Scratch::new("curvature");
    scratch.write("clean.csv", &sphere_contacts(0.0, 0.0)).write("noisy.csv", &sphere_contacts(1e-4, 0.2));
    let sphere = 4.0 / 3.0 * PI;
    let plain = volumes(&bounds(&scratch, &["clean.csv"]));
    // Where to touch next is said with its place.
    let said = scratch.run(&["bounds", "clean.csv"]).stdout;
    assert!(
        said.contains("  next                   touch it about (") && said.contains(" m apart"),
        "{said}"
    );
    let limits = ["--rho-min", "0.8", "--rho-max", "1.3"];
    let sharp = volumes(&bounds(&scratch, &[&["clean.csv", "-o", "out"], &limits[..]].concat()));
    assert!(plain[0] < sharp[0] && sharp[0] < sphere && sphere < sharp[1] && sharp[1] < plain[1]);
    for name in ["lower_bound.ply", "upper_bound.ply"] {
        assert!(scratch.path().join("out").join(name).is_file(), "{name}");
    }
    let noisy = volumes(&bounds(&scratch, &[&["noisy.csv", "--estimate-noise"], &limits[..]].concat()));
    assert!(noisy[0] < sphere && sphere < noisy[1], "{noisy:?}");
    let refused = |limits: &[&str], code: i32, words: &[&str]| {
        let run = scratch.run(&[&["bounds", "clean.csv"], limits].concat());
        assert_eq!(run.code, Some(code), "{}{}", run.stdout, run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{}", run.stderr);
    };
    refused(&["--rho-min", "2", "--rho-max", "1"], 3, &["from 2 m to 1 m", "below the largest"]);
    refused(&["--rho-min", "0.8", "--rho-max", "0.9"], 3, &["both contact", "from 0.8 m to 0.9 m"]);
    refused(&["--rho-min", "0.8"], 2, &["--rho-max"]);
}

/// Poses of a box of half sides `half` that falls and comes to rest on a face in each of many tosses, above the plane
/// z = 0.1.
fn tosses(half: [f64; 3]) -> String {
    let mut text = String::from("toss,frame,qw,qx,qy,qz,px,py,pz\n");
    for toss in 0..90_usize {
        let axis = [wobble(5 * toss), wobble(5 * toss + 1), wobble(5 * toss + 2)];
        let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
        // Tosses end on all six faces: a quarter or half turn about x or y.
        let (rest, about) = [(0.0, 0), (0.5, 0), (1.0, 0), (1.5, 0), (0.5, 1), (1.5, 1)][toss % 6];
        let (s0, c0) = (0.5 * PI * rest).sin_cos();
        let mut start = [c0, 0.0, 0.0, 0.0];
        start[1 + about] = s0;
        for frame in 0..40_usize {
            let angle = 1.4 * ((14.0 - frame as f64).max(0.0) / 14.0);
            let (s, c) = (0.5 * angle).sin_cos();
            let turn = [c, s * axis[0] / length, s * axis[1] / length, s * axis[2] / length];
            let q = product(turn, start);
            let lowest: f64 = down(q).iter().zip(half).map(|(d, h)| d.abs() * h).sum();
            let fall = 0.0005 * (144.0 - (frame as f64).min(12.0).powi(2));
            let z = 0.1 + lowest + fall + 1e-4 * wobble(toss * 40 + frame);
            writeln!(text, "{toss},{frame},{},{},{},{},0,0,{z}", q[0], q[1], q[2], q[3]).unwrap();
        }
    }
    text
}

fn product(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// The world's z in the body's frame: the last row of the rotation matrix.
fn down(q: [f64; 4]) -> [f64; 3] {
    let [w, x, y, z] = q;
    [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)]
}

#[test]
fn poses_above_a_plane_bound_the_body_from_both_sides() {
    let scratch = Scratch::new("poses");
    let half = [0.05, 0.04, 0.06];
    scratch.write("tosses.csv", &tosses(half));
    let summary = bounds(&scratch, &["tosses.csv", "--plane-height", "0.1", "-o", "out"]);
    let [lower, upper] = volumes(&summary);
    let volume = 8.0 * half.iter().product::<f64>();
    assert!(0.1 * volume < lower && lower < volume, "{lower} {volume}");
    assert!(volume < upper && upper < 1.3 * volume, "{upper} {volume}");
    let margin = |summary: &Value| summary["about"]["margin_m"].as_f64().unwrap();
    assert!(margin(&summary) < 3e-3);
    let tight = bounds(&scratch, &["tosses.csv", "--plane-height", "0.1", "--tight"]);
    assert!(volumes(&tight)[1] > volume && margin(&tight) != margin(&summary));
    // What it is not good for stands in the output.
    assert_eq!(tight["about"]["rule"], "tight");
    assert!(tight["about"]["not_good_for"].as_str().unwrap().contains("cut corners"));
    assert!(
        tight["warnings"].to_string().contains("--tight")
            && summary["warnings"].as_array().unwrap().is_empty()
    );
    let uncertain = bounds(&scratch, &["tosses.csv", "--plane-height", "0.1", "--height-deviation", "1e-4"]);
    assert!(margin(&uncertain) > margin(&summary) + 1.9e-4 && volumes(&uncertain)[1] > upper);
    for name in ["lower_bound.ply", "upper_bound.ply"] {
        assert!(scratch.path().join("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn contacts_of_no_convex_body_and_open_bodies_are_named() {
    let scratch = Scratch::new("contradiction");
    let mut cube = String::from("x,y,z,nx,ny,nz\n");
    for n in ["1,0,0", "-1,0,0", "0,1,0", "0,-1,0", "0,0,1", "0,0,-1"] {
        let point = n.replace('1', "0.5");
        writeln!(cube, "{point},{n}").unwrap();
    }
    scratch.write("wrong.csv", &format!("{cube}3,3,0,1,0,0\n"));
    let run = scratch.run(&["bounds", "wrong.csv", "-o", "out"]);
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
    assert!(
        run.stderr.contains("contact 6 (from 0) lies 2.5e0 m beyond the tangent plane"),
        "{}",
        run.stderr
    );
    assert!(!scratch.path().join("out").exists());
    // A tilted cylinder round its waist, with normals of six digits.
    let mut waist = String::from("x,y,z,nx,ny,nz\n");
    for k in 0..24 {
        let (s, c) = (TAU * f64::from(k) / 24.0).sin_cos();
        let n = [0.6 * c, s, 0.8 * c];
        let cap = if k % 2 == 0 { 0.1 } else { -0.1 };
        writeln!(
            waist,
            "{},{},{},{:.6},{:.6},{:.6}",
            n[0] - 0.8 * cap,
            n[1],
            n[2] + 0.6 * cap,
            n[0],
            n[1],
            n[2]
        )
        .unwrap();
    }
    scratch.write("waist.csv", &waist);
    let run = scratch.run(&["bounds", "waist.csv"]);
    assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
    assert!(
        run.stdout.contains("(0.80, 0.00, -0.60)") || run.stdout.contains("(-0.80, 0.00, 0.60)"),
        "{}",
        run.stdout
    );
}

#[test]
fn rounded_normals_are_noise() {
    let scratch = Scratch::new("rounded");
    let mut rounded = String::new();
    for (k, line) in sphere_contacts(0.0, 0.0).lines().enumerate() {
        let cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        let digits =
            |c: &String| if k == 0 { c.clone() } else { format!("{:.4}", c.parse::<f64>().unwrap()) };
        let normal: Vec<String> = cells[4..].iter().map(digits).collect();
        writeln!(rounded, "{},{}", cells[..4].join(","), normal.join(",")).unwrap();
    }
    scratch.write("rounded.csv", &rounded);
    let run = scratch.run(&["bounds", "rounded.csv"]);
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("normals are rounded"), "{}", run.stderr);
    scratch.write("exact.csv", &sphere_contacts(0.0, 0.0));
    let exact = volumes(&bounds(&scratch, &["exact.csv"]));
    let stated = ["rounded.csv", "--normal-noise", "1e-4", "--contact-noise", "1e-6", "-o", "out"];
    let [lower, upper] = volumes(&bounds(&scratch, &stated));
    assert!(lower < exact[0] && exact[1] < upper, "{lower} {upper} {exact:?}");
    assert!(lower > 0.97 * exact[0] && upper < 1.03 * exact[1], "{lower} {upper} {exact:?}");
    scratch.write("far.csv", &rounded.replacen("1.0000", "1.0020", 1));
    let run = scratch.run(&["bounds", "far.csv", "--estimate-noise"]);
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
}

#[test]
fn options_and_poses_that_do_not_go_together_are_refused() {
    let scratch = Scratch::new("options");
    let good = tosses([0.05, 0.04, 0.06]);
    scratch.write("tosses.csv", &good).write("clean.csv", &sphere_contacts(0.0, 0.0));
    let refused = |arguments: &[&str], code: i32, words: &[&str]| {
        let run = scratch.run(&[&["bounds", "-o", "out"], arguments].concat());
        assert_eq!(run.code, Some(code), "{}{}", run.stdout, run.stderr);
        assert!(words.iter().all(|word| run.stderr.contains(word)), "{}", run.stderr);
        assert!(!scratch.path().join("out").exists() && run.stdout.is_empty());
    };
    refused(&["clean.csv", "--run-height-deviation", "1e-3"], 2, &["--run-height-deviation", "poses"]);
    refused(&["tosses.csv", "--estimate-noise"], 2, &["--estimate-noise", "holds poses"]);
    refused(&["clean.csv", "--plane-height", "0.1"], 2, &["--plane-height", "holds contacts"]);
    refused(&["clean.csv", "--tight"], 2, &["--tight", "holds contacts"]);
    refused(&["clean.csv", "--confidence", "0.9"], 2, &["--confidence"]);
    refused(&["clean.csv", "--contact-noise", "1e-3"], 2, &["--normal-noise"]);
    refused(&["tosses.csv", "--confidence", "95"], 2, &["between 0.5 and 1"]);
    // With the plane above the body, only a margin of metres makes the poses agree.
    let run = scratch.run(&["bounds", "tosses.csv", "--plane-height", "1"]);
    assert_eq!(run.code, Some(4), "{}", run.stderr);
    assert!(run.stdout.contains("is the height of the plane right?"), "{}", run.stdout);
    scratch.write("bad.csv", &good.replacen("0,1,", "0,2,", 1));
    refused(&["bad.csv"], 3, &["line 3", "frame 2 follows frame 0"]);
    scratch.write("bad.csv", &good.lines().take(60).collect::<Vec<_>>().join("\n"));
    refused(&["bad.csv", "--plane-height", "0.1"], 3, &["the poses give no bounds"]);
    let inwards: String = sphere_contacts(0.0, 0.0)
        .lines()
        .enumerate()
        .map(|(k, line)| {
            let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
            if k > 0 {
                cells[4..].iter_mut().for_each(|c| *c = (-c.parse::<f64>().unwrap()).to_string());
            }
            cells.join(",") + "\n"
        })
        .collect();
    scratch.write("bad.csv", &inwards);
    refused(&["bad.csv"], 3, &["beyond the tangent plane of contact", "inwards"]);
    refused(&["bad.csv", "--contact-noise", "1e-3", "--normal-noise", "1e-3"], 3, &["point outwards"]);
}

/// Thirty contacts on each side of a box that stands askew, with normals that differ by `spread`.
fn box_contacts(spread: f64, case: usize) -> String {
    let q = [0.5, 0.5 * wobble(case), 0.5 * wobble(case + 7), 0.3];
    let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
    let q = q.map(|x| x / length);
    let half = [0.7, 0.4, 0.9];
    let turned = |v: [f64; 3]| {
        let by = product(q, [0.0, v[0], v[1], v[2]]);
        let back = product(by, [q[0], -q[1], -q[2], -q[3]]);
        [back[1] + 0.3, back[2] - 0.8, back[3] + 1.1]
    };
    let mut text = String::from("x,y,z,nx,ny,nz\n");
    for k in 0..180 {
        let (axis, side) = (k % 3, if k % 2 == 0 { 1.0 } else { -1.0 });
        let mut x = [0, 1, 2].map(|i| half[i] * wobble(7 * k + i + case));
        let mut n = [0.0; 3];
        (x[axis], n[axis]) = (side * half[axis], side);
        let n = [0, 1, 2].map(|i| turned(n)[i] - turned([0.0; 3])[i] + spread * wobble(11 * k + i));
        let length = n.iter().map(|x| x * x).sum::<f64>().sqrt();
        let [x, n] = [turned(x), n.map(|x| x / length)].map(|v| v.map(|x| x.to_string()).join(","));
        writeln!(text, "{x},{n}").unwrap();
    }
    text
}

/// Flat sides that are touched many times give planes that are one but for the last digits: where they meet is nowhere.
#[test]
fn flat_sides_touched_many_times_give_a_box() {
    let scratch = Scratch::new("flat");
    for (case, spread) in [0.0, 1e-16, 1e-14, 1e-12, 1e-10, 1e-8].into_iter().enumerate() {
        scratch.write("box.csv", &box_contacts(spread, case));
        // The command's own certificate finds folds in the surface.
        let [lower, upper] = volumes(&bounds(&scratch, &["box.csv", "-o", "out"]));
        let volume = 8.0 * 0.7 * 0.4 * 0.9;
        assert!(lower < volume && (upper / volume - 1.0).abs() < 1e-6, "{spread}: {lower} {upper}");
    }
}

/// Contacts of an ellipse, as rows.
fn ellipse(axes: [f64; 2], angles: impl Iterator<Item = f64>) -> String {
    let mut text = String::from("x,y,nx,ny\n");
    for angle in angles {
        let (s, c) = angle.sin_cos();
        let long = (axes[0] * c).hypot(axes[1] * s);
        let (x, y) = (axes[0] * axes[0] * c / long, axes[1] * axes[1] * s / long);
        writeln!(text, "{x:?},{y:?},{c:?},{s:?}").unwrap();
    }
    text
}

/// Corners of a file, m.
fn corners(scratch: &Scratch, file: &str) -> Vec<[f64; 2]> {
    let number = |word: &str| word.parse::<f64>().unwrap();
    let row = |line: &str| line.split_once(',').map(|(x, y)| [number(x), number(y)]).unwrap();
    scratch.read(file).lines().skip(1).map(row).collect()
}

/// Of a flat ellipse bounds are farthest apart between any two of a few hundred directions. Oracle: distances from corners to sides, one by one.
#[test]
fn the_largest_gap_in_the_plane_is_that_of_the_outlines() {
    let scratch = Scratch::new("largest-gap");
    let even = (0..200).map(|k| TAU * f64::from(k) / 200.0);
    scratch.write("flat.csv", &ellipse([1.0, 0.01], even));
    let made = bounds(&scratch, &["flat.csv", "-o", "out"]);
    let [lower, upper] = ["out/lower_bound.csv", "out/upper_bound.csv"].map(|file| corners(&scratch, file));
    let to_side = |p: [f64; 2], k: usize| {
        let (a, b) = (lower[k], lower[(k + 1) % lower.len()]);
        let along = [b[0] - a[0], b[1] - a[1]];
        let t = ((p[0] - a[0]) * along[0] + (p[1] - a[1]) * along[1]) / (along[0].powi(2) + along[1].powi(2));
        let t = t.clamp(0.0, 1.0);
        (a[0] + t * along[0] - p[0]).hypot(a[1] + t * along[1] - p[1])
    };
    let nearest = |p: &[f64; 2]| (0..lower.len()).map(|k| to_side(*p, k)).fold(f64::INFINITY, f64::min);
    let largest = upper.iter().map(nearest).fold(0.0, f64::max);
    let told = made["bounds"]["largest_gap_m"].as_f64().unwrap();
    assert!((told - largest).abs() < 1e-12, "{told} {largest}");
}

/// What is drawn of an upper bound of arcs is around it: a circle touched four times is in the outline.
#[test]
fn an_outline_of_arcs_is_around_the_body() {
    let scratch = Scratch::new("arcs");
    scratch.write("circle.csv", &ellipse([1.0, 1.0], (0..4).map(|k| TAU * f64::from(k) / 4.0)));
    for [min, max] in [["0", "1000"], ["0.01", "100"], ["0.9", "1.1"], ["1", "1"]] {
        bounds(&scratch, &["circle.csv", "--rho-min", min, "--rho-max", max, "-o", "out"]);
        let upper = corners(&scratch, "out/upper_bound.csv");
        let inside = (0..upper.len()).all(|k| {
            let ([ax, ay], [bx, by]) = (upper[k], upper[(k + 1) % upper.len()]);
            let length = (bx - ax).hypot(by - ay);
            // Corners where two arcs meet stand there twice.
            length < 1e-9 || (ax * by - ay * bx) / length > 1.0 - 1e-12
        });
        assert!(inside, "{min} {max}");
    }
}

#[test]
fn noisy_contacts_that_leave_a_side_open_have_a_lower_bound() {
    let scratch = Scratch::new("open-side");
    scratch.write("arc.csv", &ellipse([0.05, 0.03], (0..60).map(|k| 2.2 * f64::from(k) / 60.0)));
    let run = scratch.run(&[
        "bounds",
        "arc.csv",
        "--contact-noise",
        "1e-5",
        "--normal-noise",
        "1e-3",
        "--json",
        "-o",
        "out",
    ]);
    assert_eq!(run.code, Some(4), "{}", run.stderr);
    let made: Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(
        made["bounds"]["lower_area_m2"].as_f64().unwrap() > 5e-4 && made["bounds"]["largest_gap_m"].is_null()
    );
    assert!(made["warnings"].to_string().contains("no upper bound"), "{}", made["warnings"]);
    assert!(scratch.path().join("out/lower_bound.csv").exists());
}

/// Needles and slivers, whose areas and volumes are nothing beside the products that they are sums of, are written.
#[test]
fn contacts_next_to_each_other_have_bounds() {
    let scratch = Scratch::new("needles");
    scratch.write(
        "sliver.csv",
        "x,y,nx,ny\n\
         -12.166130180685025,23.428650069745395,-0.8475077670138065,-0.5307829922400221\n\
         -10.171403669681633,23.283508965629878,0.949915081368694,-0.31250814099525087\n\
         -10.171404213780782,23.283509604300935,0.668955806247576,0.7433021789875606\n\
         -12.166130116520614,23.42865030589795,-0.7124524694045697,0.7017203708310957\n\
         -12.16612886703247,23.42864887415232,-0.5935888569366237,-0.8047684567132787\n",
    );
    scratch.write(
        "needle.csv",
        "x,y,z,nx,ny,nz\n\
         -0.7407076378975705,0.34709162685860234,-0.06748717612603079,-0.20282979176902208,0.6792729781198983,0.7053001465809146\n\
         -0.8143956952388784,0.41120705569331195,-0.2420043596877809,0.11143385273602627,-0.2643704384657666,-0.9579617778021333\n\
         -0.7407031423197004,0.3470866173437883,-0.06748342176614507,0.48217831206335127,0.1814449155278871,0.8570774865814732\n\
         -0.8143943181609681,0.4112081995665039,-0.2420037742924498,0.5151355697347483,0.3174146517447558,-0.7961678740390193\n",
    );
    for file in ["sliver.csv", "needle.csv"] {
        let run = scratch.run(&["bounds", file, "-o", "out"]);
        assert!(matches!(run.code, Some(0 | 4)), "{file}: {:?} {}", run.code, run.stderr);
        assert_eq!(scratch.run(&["check", "out"]).code, Some(0), "{file}");
    }
}

#[test]
fn contacts_of_no_body_are_told_before_bounds_are_asked_for() {
    let scratch = Scratch::new("no-body");
    let good = ellipse([0.05, 0.03], (0..12).map(|k| TAU * f64::from(k) / 12.0));
    let flipped = good.replacen("1.0,0.0", "-1.0,0.0", 1);
    assert_ne!(good, flipped);
    scratch.write("good.csv", &good).write("flipped.csv", &flipped);
    scratch.write("one.csv", "x,y,nx,ny\n0.0,0.0,1.0,0.0\n");
    scratch.write("short.csv", "x,y,z\n0.0,0.0,1.0\n");
    let short = scratch.run(&["check-input", "short.csv"]);
    assert!(short.code == Some(3) && short.stderr.contains("column `nx` is missing"), "{}", short.stderr);
    scratch.run(&["bounds", "good.csv", "-o", "out"]);
    let next = scratch.run(&["next", "out", "--until", "gap=0.1"]);
    assert!(next.code == Some(3) && next.stderr.contains("holds no contacts.csv"), "{}", next.stderr);
    assert_eq!(scratch.run(&["check-input", "good.csv"]).code, Some(0));
    for file in ["flipped.csv", "one.csv"] {
        let run = scratch.run(&["check-input", file]);
        assert!(
            run.code == Some(4) && run.stdout.contains("No body has these contacts"),
            "{file} {}",
            run.stdout
        );
    }
}
