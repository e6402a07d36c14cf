//! `recon follow` and `recon reconstruct --without-forces`: a noisy log from a file and from a pipe, and bad input.

use crate::common::{Scratch, Table};
use recon::object_dynamics::ContactLog;
use recon_io::{read_log, write_contact_log};
use std::fs::File;
use std::process::Stdio;

const SCENE: &str = r#"
gravity = 9.81
[object]
mass = 1.3
principal_moments = [2.665, 1.885, 1.3]
[sensors]
contact_std = 2.5e-3
force_std = 0.065
[simulation]
duration = 5.0
sample_rate = 100.0
orientation = [1.0, 0.0, 0.0, 0.0]
angular_velocity = [0.2, 0.3, -0.4]
shape = { kind = "ellipsoid", semi_axes = [1.0, 2.0, 2.5] }
palms = [
  { azimuth_deg = 6.0, slope_deg = 57.0 },
  { azimuth_deg = 126.0, slope_deg = 57.0 },
  { azimuth_deg = 246.0, slope_deg = 57.0 },
]
"#;

fn scratch(test: &str, duration: &str) -> (Scratch, Table) {
    let scratch = Scratch::new(test);
    scratch.write("scene.toml", &SCENE.replace("duration = 5.0", duration));
    let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let log = Table::parse(&scratch.read("log.csv"));
    (scratch, log)
}

/// The log without the columns that a test leaves out.
fn without(log: &Table, stem: &str) -> String {
    let kept: Vec<usize> = (0..log.header.len()).filter(|&k| !log.header[k].starts_with(stem)).collect();
    let pick = |row: &Vec<String>| kept.iter().map(|&k| row[k].clone()).collect::<Vec<_>>();
    Table { header: pick(&log.header), rows: log.rows.iter().map(pick).collect() }.text()
}

fn number(table: &Table, row: usize, column: &str) -> f64 {
    table.rows[row][table.column(column)].parse().unwrap()
}

#[test]
fn the_motion_is_followed_from_a_file_and_from_a_pipe() {
    let (scratch, log) = scratch("follow", "duration = 3.0");
    let args = ["follow", "log.csv", "--scene", "scene.toml", "-o", "motion.csv", "--report", "page.html"];
    let run = scratch.run(&args);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("the motion is known from "), "{}", run.stdout);
    let page = scratch.read("page.html");
    for part in ["The motion is known from ", "Centre of mass", "Turn since it was found", "class=\"shade\""]
    {
        assert!(page.contains(part), "{part}");
    }
    // What is read is not written over.
    let run = scratch.run(&["follow", "log.csv", "--scene", "scene.toml", "--report", "log.csv"]);
    assert_eq!(run.code, Some(5), "{}{}", run.stdout, run.stderr);
    // Nor what is written, whether it is there yet or not.
    let run = scratch.run(&["follow", "log.csv", "--scene", "scene.toml", "-o", "new", "--report", "./new"]);
    assert_eq!(run.code, Some(5), "{}{}", run.stdout, run.stderr);
    let table = scratch.read("motion.csv");
    let motion = Table::parse(&table);
    assert_eq!(motion.rows.len(), 31);
    assert_eq!(motion.rows[0][motion.column("stage")], "gathering");
    // Rows stand at multiples of 0.1 s, samples at those of 0.01 s.
    for (row, stage) in motion.rows.iter().map(|row| row[motion.column("stage")].as_str()).enumerate() {
        if stage != "tracking" {
            continue;
        }
        let sample = row * 10;
        assert_eq!(number(&motion, row, "t"), number(&log, sample, "t"));
        let error = |names: [&str; 3]| {
            let square = |name| (number(&motion, row, name) - number(&log, sample, name)).powi(2);
            names.map(square).iter().sum::<f64>().sqrt()
        };
        // Five deviations of three numbers together.
        assert!(error(["cmx", "cmy", "cmz"]) < 5.0 * number(&motion, row, "std_cm"), "row {row}");
        assert!(error(["vx", "vy", "vz"]) < 5.0 * number(&motion, row, "std_v"), "row {row}");
    }
    assert_eq!(motion.rows[30][motion.column("stage")], "tracking");

    let piped = |file: &str, options: &[&str]| {
        let pipe = File::open(scratch.path().join(file)).unwrap();
        let words = [&["follow", "-", "--scene", "scene.toml"], options].concat();
        let piped = scratch.command(&words).stdin(Stdio::from(pipe)).output().unwrap();
        (piped.status.code(), String::from_utf8(piped.stdout).unwrap())
    };
    let (code, lines) = piped("log.csv", &["--every", "0.5", "--json"]);
    assert_eq!(code, Some(0));
    let objects: Vec<serde_json::Value> =
        lines.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(objects.len(), 7);
    assert_eq!(objects[6]["stage"], "tracking");
    assert!(objects[0]["misfit"].is_null());
    // The same estimate, to the last digit: of the first second there is none.
    for (k, object) in objects.iter().enumerate() {
        let told = object["p_WCm_m"][0].as_f64().unwrap_or(f64::NAN);
        let row = number(&motion, 5 * k, "cmx");
        assert!(told == row || (told.is_nan() && row.is_nan()), "{object}");
    }
    // The table goes to standard output line for line as it goes to a file: its first second.
    let lines = |text: &str, most: usize| {
        text.lines().take(most).map(|line| line.to_owned() + "\n").collect::<String>()
    };
    scratch.write("begin.csv", &lines(&log.text(), 1 + 101));
    let (_, begin) = piped("begin.csv", &[]);
    assert_eq!(begin, lines(&table, 1 + 11));
    // What was followed before a row that is none is not lost.
    scratch.write("torn.csv", &(lines(&log.text(), 1 + 101) + "1.01,0.5\n"));
    let args = ["follow", "torn.csv", "--scene", "scene.toml", "-o", "kept.csv", "--report", "kept.html"];
    let torn = scratch.run(&args);
    assert_eq!(torn.code, Some(3), "{}", torn.stderr);
    assert!(scratch.read("kept.html").contains("<dd>100<small>"), "samples until then");
    assert!(torn.stderr.contains("until then is in kept.csv"), "{}", torn.stderr);
    // A sample is taken once it is seen that another one follows.
    assert_eq!(scratch.read("kept.csv"), lines(&table, 1 + 10));
}

/// As palms of any shape.
#[test]
fn the_motion_is_followed_on_any_palms() {
    let (scratch, _) = scratch("follow-any", "duration = 3.5");
    let log = ContactLog::try_from(&read_log(scratch.path().join("log.csv")).unwrap()).unwrap();
    let mut text = Vec::new();
    write_contact_log(&log, &mut text).unwrap();
    scratch.write("any.csv", std::str::from_utf8(&text).unwrap());
    let palm = "[[palm]]\nkind = \"flat\"\n";
    scratch.write("any.toml", &(SCENE.split("[simulation]").next().unwrap().to_owned() + &palm.repeat(3)));
    let followed = |log: &str, scene: &str| {
        let run = scratch.run(&["follow", log, "--scene", scene, "--identify", "-o", "motion.csv"]);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        Table::parse(&scratch.read("motion.csv"))
    };
    let (planes, any) = (followed("log.csv", "scene.toml"), followed("any.csv", "any.toml"));
    assert_eq!(planes.rows.len(), any.rows.len());
    for row in 30..planes.rows.len() {
        for column in ["cmx", "vz", "std_w", "mass"] {
            let [a, b] = [&planes, &any].map(|table| number(table, row, column));
            assert!((a - b).abs() < 1e-6, "row {row}, {column}: {a} {b}");
        }
    }
}

#[test]
fn a_log_without_forces_gives_the_ellipsoid() {
    let (scratch, log) = scratch("without-forces", "duration = 3.0");
    scratch.write("bare.csv", &without(&log, "f_"));
    let arguments = ["reconstruct", "bare.csv", "--scene", "scene.toml", "--without-forces"];
    let run = scratch.run(&arguments);
    // The ellipsoid without bounds: under noise it is not known how far the contacts are off.
    assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
    for words in ["moments over mass", " +- ", "  next                   forces"] {
        assert!(run.stdout.contains(words), "`{words}` is not in\n{}", run.stdout);
    }
    let figures: serde_json::Value = serde_json::from_str(&scratch.read("recon-out/summary.json")).unwrap();
    for (axis, expected) in [1.0, 2.0, 2.5].into_iter().enumerate() {
        let found = figures["semi_axes_m"][axis].as_f64().unwrap();
        // Means over 3 s, of 300 contacts noisy by 2.5e-3 m: 1.4e-4 m.
        assert!((found - expected).abs() < 1e-3, "{found} {expected}");
    }
    assert!(
        figures["bounds"].is_null() && figures["warnings"].to_string().contains("no bounds on the shape")
    );
    let page = scratch.read("recon-out/report.html");
    let moments = run.stdout.lines().find_map(|line| line.trim().strip_prefix("moments over mass")).unwrap();
    let told = moments.split_whitespace().next().unwrap();
    let tile = format!("<dt>Moment over mass, x</dt><dd>{told}<small class=\"deviation\">±");
    for part in [&tile[..], ">contacts</text>", ">centre</text>", "Product over mass, xy"] {
        assert!(page.contains(part), "{part}");
    }
    let motion = Table::parse(&scratch.read("recon-out/motion.csv"));
    assert!(motion.rows.len() > 30 && !scratch.path().join("recon-out/lower_bound.ply").exists());
    // Contacts noisy by 2.5e-3 m tell the place to that or better, and the turn from the second node on is not exact.
    for (column, most) in [("std_cmx", 2.5e-3), ("std_turnz", 2.5e-3)] {
        let deviation = number(&motion, 20, column);
        assert!(deviation > 0.0 && deviation < most, "{column} {deviation}");
    }
}

#[test]
fn bad_input_is_refused() {
    let (scratch, mut log) = scratch("follow-bad", "duration = 1.0");
    log.rows.truncate(40);
    scratch.write("log.csv", &log.text());
    scratch.write("bare.csv", &without(&log, "f_"));
    scratch.write("one.csv", &log.text().lines().take(2).collect::<Vec<_>>().join("\n"));
    scratch.write("none_yet.csv", &log.text().lines().take(1).collect::<String>());
    scratch.write("quiet.toml", &SCENE.replace("force_std = 0.065", ""));
    log.set(30, "t", "0.001");
    scratch.write("back.csv", &log.text());
    let follow = |log, scene| vec!["follow", log, "--scene", scene, "-o", "motion.csv"];
    let touch = |log, scene| vec!["reconstruct", log, "--scene", scene, "--without-forces"];
    for (arguments, code, words) in [
        (vec!["follow", "log.csv"], 3, "--scene"),
        (follow("log.csv", "quiet.toml"), 3, "--force-noise"),
        (follow("bare.csv", "scene.toml"), 3, "--without-forces"),
        (follow("one.csv", "scene.toml"), 3, "1 sample(s)"),
        (follow("none_yet.csv", "scene.toml"), 3, "0 sample(s)"),
        (follow("none.csv", "scene.toml"), 3, "none.csv"),
        (vec!["follow", "log.csv", "--scene", "scene.toml", "--rate", "0"], 2, "positive"),
        (vec!["reconstruct", "log.csv", "--without-forces"], 3, "--scene"),
        (touch("log.csv", "scene.toml"), 3, "at least"),
        ([touch("log.csv", "scene.toml"), vec!["--identify"]].concat(), 2, "--identify"),
    ] {
        let run = scratch.run(&arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains(words), "{arguments:?}: {}", run.stderr);
        assert!(!scratch.path().join("motion.csv").exists() && !scratch.path().join("recon-out").exists());
    }
    // What was followed before time runs back is kept.
    let run = scratch.run(&follow("back.csv", "scene.toml"));
    assert!(run.code == Some(3) && run.stderr.contains("line 32"), "{}", run.stderr);
    assert_eq!(Table::parse(&scratch.read("motion.csv")).rows.len(), 3);
    // Forty samples are no motion, and the table says so.
    let run = scratch.run(&follow("log.csv", "scene.toml"));
    assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("no motion"), "{}", run.stdout);
}
