//! Logs and scenes of palms of any shape that are three planes through a point, without friction.

use crate::common::{Scratch, Table, scene, scratch_reconstructed, scratch_with_log};
use glam::DVec3;
use recon::object_dynamics::{ContactLog, ForceChannel, RecordedMotion};
use recon_io::{read_log, write_contact_log};
use recon_tests::few_or_all;
use serde_json::Value;

const PALM: &str = "\n[[palm]]\nkind = \"flat\"\n";

/// A folder with a log of three palms in version 2, away from the origin by `p_WM`, and a scene that goes with it.
fn scratch(test: &str, p_WM: DVec3) -> Scratch {
    let scratch = scratch_with_log(test);
    let log = ContactLog::try_from(&read_log(scratch.path().join("log.csv")).unwrap()).unwrap();
    let mut records = log.records();
    for record in &mut records {
        if let RecordedMotion::Fixed(pose) = &mut record.motion {
            pose.p_WP += p_WM;
        }
        if let recon::object_dynamics::ContactPoints::World(points) = &mut record.contacts {
            points.iter_mut().flatten().for_each(|p| *p += p_WM);
        }
    }
    let mut truth = log.truth().unwrap().to_vec();
    truth.iter_mut().for_each(|state| state.p_WCm += p_WM);
    let moved = ContactLog::new(log.times().to_vec(), records, Some(truth)).unwrap();
    let mut text = Vec::new();
    write_contact_log(&moved, &mut text).unwrap();
    scratch.write("any.csv", std::str::from_utf8(&text).unwrap());
    let known = scene().split("[simulation]").next().unwrap().to_owned();
    scratch.write("any.toml", &(known + &PALM.repeat(3)));
    scratch
}

fn reconstruct(scratch: &Scratch, log: &str, scene: &str, folder: &str) -> (Option<i32>, String, Value) {
    let run = scratch.run(&["reconstruct", log, "--scene", scene, "-o", folder, "--json"]);
    (run.code, run.stderr, serde_json::from_str(&run.stdout).unwrap_or_default())
}

#[test]
fn three_planes_are_estimated_in_either_version_and_anywhere() {
    let p_WM = DVec3::new(0.3, -0.2, 0.1);
    let scratch = scratch("any-palms", p_WM);
    let (made, _) = scratch_reconstructed("any-palms-one", false);
    let one: Value = serde_json::from_str(&made.read("out/summary.json")).unwrap();
    let (code, errors, two) = reconstruct(&scratch, "any.csv", "any.toml", "two");
    assert_eq!(code, Some(0), "{errors}");
    for key in ["position_m", "angular_velocity_rad_per_s"] {
        let [a, b] = [&one, &two].map(|summary| summary["largest_error"][key].as_f64().unwrap());
        assert!((a - b).abs() < 1e-9, "{key}: {a} {b}");
    }
    // Positions are the world's, wherever the palms meet.
    let first = |text: &str| {
        let table = Table::parse(text);
        let row = &table.rows[0];
        DVec3::from_array(["cmx", "cmy", "cmz"].map(|name| row[table.column(name)].parse().unwrap()))
    };
    let [here, there] =
        [made.read("out/motion.csv"), scratch.read("two/motion.csv")].map(|text| first(&text));
    assert!((there - here - p_WM).length() < 1e-9, "{here} {there}");
    assert!(!two["warnings"].to_string().contains("meet in"), "{}", two["warnings"]);
}

/// The scene of Fig. 5 with its palms as planes that may stand anywhere, sampled at 100 Hz.
fn planes() -> String {
    let known = scene().split("[simulation]").next().unwrap().to_owned();
    let plane = |n: &str| {
        format!(
            "[[palm]]\nkind = \"flat\"\nfriction = 0.0\npose = {{ position = [0.0, 0.0, 0.0], normal = {n} }}\n"
        )
    };
    let normals = ["[0.0, 0.866025404, 0.5]", "[-0.75, -0.433012702, 0.5]", "[0.75, -0.433012702, 0.5]"];
    known
        + &normals.map(plane).concat()
        + "[simulation]\nduration = 2.1\nsample_rate = 100.0\nposition = [0.0, -0.24804843, 4.035183758]\n\
           velocity = [-0.508133446, 0.0, 0.0]\nangular_velocity = [0.0, 0.3, 0.3]\n\
           shape = { kind = \"ellipsoid\", semi_axes = [2.5, 2.0, 1.0] }\n"
}

#[test]
fn three_planes_are_simulated_through_modes_and_estimated_from_their_log() {
    let scratch = Scratch::new("planes");
    scratch.write("any.toml", &planes());
    let run = scratch.run(&["simulate", "any.toml", "-o", "any.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("no change of modes"), "{}", run.stdout);
    let (code, errors, summary) = reconstruct(&scratch, "any.csv", "any.toml", "out");
    assert_eq!(code, Some(0), "{errors}");
    // 6.6e-9 m and 4.7e-8 rad/s: what a step between readings so far apart is good to.
    for (key, most) in [("position_m", 2e-8), ("angular_velocity_rad_per_s", 1.5e-7)] {
        let error = summary["largest_error"][key].as_f64().unwrap();
        assert!(error < most, "{key}: {error}");
    }
    // The three fingertips and the table of another scene are not three planes.
    scratch.write("pick-up.toml", include_str!("../../scenes/pick-up.toml"));
    assert_eq!(
        scratch.run(&["simulate", "pick-up.toml", "-o", "four.csv", "--tolerance", "1e-6"]).code,
        Some(0)
    );
    let run =
        scratch.run(&["reconstruct", "four.csv", "--scene", "pick-up.toml", "-o", "no", "--without-forces"]);
    assert_eq!(run.code, Some(3), "{}", run.stdout);
    assert!(run.stderr.contains("four.csv") && run.stderr.contains("4 palm(s)"), "{}", run.stderr);
    assert!(!scratch.path().join("no").exists());
}

/// The same, each palm on a hinge along its horizontal axis, where a motor holds it.
fn motors() -> String {
    let mut scene = planes()
        .replace("velocity = [-0.508133446, 0.0, 0.0]", "velocity = [-0.508133446, 0.0, 0.0]\nseed = 3");
    for (normal, axis) in [
        ("[0.0, 0.866025404, 0.5] }", "[-1.0, 0.0, 0.0]"),
        // About the other direction: the torque counts the other way.
        ("[-0.75, -0.433012702, 0.5] }", "[-0.5, 0.866025404, 0.0]"),
        ("[0.75, -0.433012702, 0.5] }", "[0.5, 0.866025404, 0.0]"),
    ] {
        let value = if axis.starts_with("[-0.5") { -15.0 } else { 15.0 };
        let motor = format!(
            "motor = {{ pivot = [0.0, 0.0, 0.0], axis = {axis}, inertia = 10.0, law = {{ kind = \"constant\", value = {value} }} }}"
        );
        scene = scene.replace(normal, &format!("{normal}\n{motor}"));
    }
    scene.replace("duration = 2.1", "duration = 2.0")
}

#[test]
fn a_motion_is_estimated_from_torques_alone() {
    let scratch = Scratch::new("motors");
    scratch.write("any.toml", &motors());
    let run = scratch.run(&["simulate", "any.toml", "-o", "any.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(run.stdout.contains("no change of modes"), "{}", run.stdout);
    // What a robot without force sensors has.
    let mut table = Table::parse(&scratch.read("any.csv"));
    let kept: Vec<usize> =
        (0..table.header.len()).filter(|&c| !table.header[c].starts_with(['f', 'J'])).collect();
    let keep = |row: &[String]| kept.iter().map(|&c| row[c].clone()).collect::<Vec<_>>();
    table.rows = table.rows.iter().map(|row| keep(row)).collect();
    table.header = keep(&table.header);
    scratch.write("torques.csv", &table.text());
    let (code, errors, summary) = reconstruct(&scratch, "torques.csv", "any.toml", "out");
    assert_eq!(code, Some(0), "{errors}{}", summary["verdict"]);
    let largest = |key: &str| summary["largest_error"][key].as_f64().unwrap();
    // 8.9e-4 m and 5.6e-3 rad/s, about as it says, where the forces give 3.7e-8 and 2.6e-7: the palms' acceleration is taken from their rates, and
    // what is rough about forces that follow counts as noise.
    let [position, spin] = ["position_m", "angular_velocity_rad_per_s"].map(largest);
    assert!(position < 2e-3 && spin < 1e-2, "{position} {spin}");
    if few_or_all(true, false) {
        return;
    }
    scratch.write("light.toml", &scratch.read("any.toml").replace("inertia = 10.0", "inertia = 9.0"));
    let (code, errors, _) = reconstruct(&scratch, "torques.csv", "light.toml", "light-out");
    assert_eq!(code, Some(4), "the palms' inertia counts: {errors}");
}

#[test]
fn motors_are_as_noisy_as_the_scene_says() {
    let scratch = Scratch::new("motor-noise");
    // Of 603 readings: known to 2.9 %.
    scratch.write("noisy.toml", &(motors() + "[sensors]\ntorque_std = 0.2\n"));
    assert_eq!(scratch.run(&["simulate", "noisy.toml", "-o", "noisy.csv"]).code, Some(0));
    let noisy = Table::parse(&scratch.read("noisy.csv"));
    let squares = [("tau_1", 15.0), ("tau_2", -15.0), ("tau_3", 15.0)].map(|(column, mean)| {
        let place = noisy.column(column);
        noisy.rows.iter().map(|row| (row[place].parse::<f64>().unwrap() - mean).powi(2)).sum::<f64>()
    });
    let deviation = (squares.iter().sum::<f64>() / (3 * noisy.rows.len()) as f64).sqrt();
    assert!((deviation / 0.2 - 1.0).abs() < 0.12, "{deviation}");
}

#[test]
fn what_is_neither_three_planes_nor_has_all_forces_is_refused_by_name() {
    let scratch = scratch("neither", DVec3::ZERO);
    let refused = |arguments: &[&str], words: &[&str]| {
        let run = scratch.run(arguments);
        assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
        for word in words {
            assert!(run.stderr.contains(word), "`{word}` is not in\n{}", run.stderr);
        }
        assert!(!scratch.path().join("out").exists());
    };
    let known = scratch.read("any.toml");
    let reconstruct = ["reconstruct", "any.csv", "--scene", "bad.toml", "-o", "out"];
    scratch.write("bad.toml", &known.replacen("kind = \"flat\"", "kind = \"flat\"\nfriction = 0.3", 1));
    refused(&reconstruct, &["any.csv", "friction of palm 1 is stated as 0.3", "fx_1, fy_1 and fz_1"]);
    scratch.write("bad.toml", &known.replacen("kind = \"flat\"", "kind = \"cylinder\"\nradius = 1e-3", 1));
    refused(&reconstruct, &["palm 1 is not flat but a cylinder", "fx_1, fy_1 and fz_1"]);
    scratch.write("bad.toml", &(known.clone() + PALM));
    refused(&reconstruct, &["any.csv", "has 3 palm(s)", "the scene has 4"]);
    scratch.write("bad.toml", known.split("[[palm]]").next().unwrap());
    refused(&reconstruct, &["any.csv", "[[palm]] for each"]);
    // Forces that rub.
    let log = ContactLog::try_from(&read_log(scratch.path().join("log.csv")).unwrap()).unwrap();
    let mut records = log.records();
    for (record, palm) in records.iter_mut().zip(log.palms()) {
        let tilted = |k| {
            palm.touch(k).map_or(DVec3::ZERO, |touch| {
                let n = touch.n.get();
                palm.force(k).unwrap().vector.length() * (n + 0.1 * n.any_orthonormal_vector())
            })
        };
        record.force = ForceChannel::Three((0..log.times().len()).map(tilted).collect());
    }
    let mut text = Vec::new();
    write_contact_log(&ContactLog::new(log.times().to_vec(), records, None).unwrap(), &mut text).unwrap();
    scratch.write("any.csv", std::str::from_utf8(&text).unwrap());
    let rubbed = ["reconstruct", "any.csv", "--scene", "any.toml", "-o", "out"];
    let without = [&rubbed[..], &["--without-forces"]].concat();
    refused(&without, &["any.csv", "friction is felt on palm", "1.0e-1 of the normal force"]);
    // Friction that no motion explains, which takes a search in vain.
    if few_or_all(true, false) {
        return;
    }
    let run = scratch.run(&rubbed);
    assert!(run.code == Some(4) && run.stdout.contains("Do not rely on this result"), "{}", run.stdout);
}

/// Contacts that are told at taxels, where a tenth of their pitch is stated as noise: the motion is relied on, and margins of the bounds are those of what
/// is read.
#[test]
fn contacts_that_scatter_by_more_than_stated_are_survived_and_told() {
    let scratch = scratch_with_log("taxels");
    // A hundredth of the object's size.
    let pitch = 0.02;
    let table = scratch.read("log.csv");
    let mut lines = table.lines();
    let header: Vec<&str> = lines.next().unwrap().split(',').collect();
    let told = |line: &str| {
        let one = |(name, value): (&&str, &str)| match name.starts_with('s') {
            true => ((value.parse::<f64>().unwrap() / pitch).round() * pitch).to_string(),
            false => value.to_owned(),
        };
        header.iter().zip(line.split(',')).map(one).collect::<Vec<_>>().join(",")
    };
    let rows: Vec<String> = std::iter::once(header.join(",")).chain(lines.map(told)).collect();
    scratch.write("taxels.csv", &(rows.join("\n") + "\n"));
    let known = scene().split("[simulation]").next().unwrap().to_owned();
    let sensors = format!("\n[sensors]\ncontact_std = {}\nforce_std = 0.1\n", 0.1 * pitch);
    scratch.write("known.toml", &(known.split("[sensors]").next().unwrap().to_owned() + &sensors));
    let (code, errors, summary) = reconstruct(&scratch, "taxels.csv", "known.toml", "out");
    assert_eq!(code, Some(0), "{errors}");
    let verdict = summary["verdict"].to_string();
    assert!(verdict.contains("Contacts count as"), "{verdict}");
    // Margins of at least what rounding to taxels is off by.
    let warnings = summary["warnings"].to_string();
    let noise =
        warnings.split("noisy by ").nth(1).and_then(|rest| rest.split(' ').next()?.parse::<f64>().ok());
    assert!(noise.is_some_and(|noise| noise > pitch / 12.0_f64.sqrt()), "{warnings}");
}
