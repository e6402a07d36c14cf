//! Bad input: each kind is a named error with its exit code, without a panic and without half-written output.

use crate::common::{Scratch, Table, scene, scratch_with_log, scratch_with_log_of};

/// Runs `recon` on what is in the folder and asserts that it is refused: by `code`, with all of `words`, and without
/// a trace in the folder.
fn refused(scratch: &Scratch, arguments: &[&str], code: i32, words: &[&str]) {
    let before = scratch.names();
    let run = scratch.run(arguments);
    assert_eq!(run.code, Some(code), "{arguments:?}\n{}{}", run.stdout, run.stderr);
    assert!(run.stderr.starts_with("recon: "), "{}", run.stderr);
    assert!(!run.stderr.contains("panicked"), "{}", run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "`{word}` is not in\n{}", run.stderr);
    }
    assert_eq!(run.stdout, "");
    assert_eq!(scratch.names(), before, "something was written");
}

const RECONSTRUCT: [&str; 6] = ["reconstruct", "bad.csv", "--scene", "scene.toml", "-o", "out"];

#[test]
fn bad_logs_are_refused_by_line_and_column() {
    let scratch = scratch_with_log("logs");
    let good = scratch.read("log.csv");
    let spoilt = |spoil: &dyn Fn(&mut Table)| {
        let mut table = Table::parse(&good);
        spoil(&mut table);
        scratch.write("bad.csv", &table.text());
    };
    let check = |words: &[&str]| refused(&scratch, &RECONSTRUCT, 3, &[&["bad.csv"], words].concat());

    spoilt(&|t| t.header[2] = "s2 of palm 1".into());
    check(&["column `s2_1` is missing"]);
    spoilt(&|t| t.set(5, "t", "nan"));
    check(&["line 7, column `t` is NaN"]);
    spoilt(&|t| t.rows.swap(10, 11));
    check(&["line 13", "not above", "sort the log"]);
    spoilt(&|t| {
        for axis in ["nx", "ny", "nz"] {
            let from = t.column(&format!("{axis}_1"));
            for k in 0..t.rows.len() {
                let value = t.rows[k][from].clone();
                t.set(k, &format!("{axis}_2"), &value);
            }
        }
    });
    check(&["palms never span space", "turn the palms apart"]);
    spoilt(&|t| {
        for (column, value) in [("nx_3", 0.0), ("ny_3", 0.0), ("nz_3", 1.0)] {
            t.map(&[column], |_| value);
        }
    });
    check(&["line 2: palm 3", "vertical", "tilt the palm"]);
    spoilt(&|t| t.rows.truncate(1));
    check(&["1 sample(s)", "at least 2"]);
    scratch.write("bad.csv", "");
    check(&["is empty"]);
    spoilt(&|t| t.set(3, "s1_2", "1e300"));
    check(&["line 5", "s1 of palm 2", "check its unit"]);
    let normals: Vec<_> =
        ["nx", "ny", "nz"].iter().flat_map(|n| (1..=3).map(move |i| format!("{n}_{i}"))).collect();
    spoilt(&|t| normals.iter().for_each(|name| t.map(&[name], |n| -n)));
    refused(&scratch, &RECONSTRUCT, 3, &["lead away from the object", "turn them round"]);
    spoilt(&|t| t.set(3, "f_2", "strong"));
    check(&["line 5, column `f_2`: `strong` is not a number"]);
    spoilt(&|t| {
        for column in ["f_1", "f_2", "f_3"] {
            let place = t.column(column);
            t.header[place] = format!("{column} (not calibrated)");
        }
    });
    refused(&scratch, &RECONSTRUCT, 3, &["no contact force", "needs f_1, or tau_1"]);
}

#[test]
fn files_that_are_not_there_or_no_text_are_refused() {
    let scratch = scratch_with_log("missing");
    refused(&scratch, &RECONSTRUCT, 3, &["bad.csv: cannot be read"]);
    refused(&scratch, &["reconstruct", "log.csv", "--scene", "none.toml", "-o", "out"], 3, &["none.toml"]);
    refused(&scratch, &["reconstruct", "log.csv", "-o", "out"], 3, &["mass and inertia", "--scene"]);
    std::fs::write(scratch.path().join("bad.csv"), [0u8, 159, 146, 150, b'\n', 255]).unwrap();
    refused(&scratch, &RECONSTRUCT, 3, &["bad.csv", "UTF-8"]);
}

#[test]
fn bad_scenes_are_refused_by_key() {
    let scratch = scratch_with_log("scenes");
    let good = scene();
    let check = |from: &str, to: &str, words: &[&str]| {
        assert!(good.contains(from));
        scratch.write("bad.toml", &good.replacen(from, to, 1));
        let words = [&["bad.toml"], words].concat();
        refused(&scratch, &["reconstruct", "log.csv", "--scene", "bad.toml", "-o", "out"], 3, &words);
        refused(&scratch, &["simulate", "bad.toml", "-o", "new.csv"], 3, &words);
    };
    check("mass = 1.0", "mass = -1.0", &["`object.mass` is -1", "above zero"]);
    check("[1.0, 1.45, 2.05]", "[1.0, 1.45, 4.0]", &["triangle inequality"]);
    check("[1.0, 1.45, 2.05]", "[1.0, 1.45, -2.0]", &["not positive"]);
    check("mass = 1.0", "weight = 1.0", &["unknown field `weight`", "line"]);
    check("gravity = 9.81", "", &["missing field `gravity`"]);
    check("azimuth_deg = 30.0", "azimuth_deg = 270.0", &["sharing a line"]);
    check("slope_deg = 60.0", "slope_deg = 0.0", &["vertical"]);
}

#[test]
fn simulations_that_cannot_be_are_refused() {
    let scratch = Scratch::new("simulations");
    let check = |from: &str, to: &str, words: &[&str]| {
        assert!(scene().contains(from));
        scratch.write("bad.toml", &scene().replacen(from, to, 1));
        refused(&scratch, &["simulate", "bad.toml", "-o", "new.csv"], 3, words);
    };
    check("[0.0, 0.3, 0.3]", "[0.0, 30.0, 30.0]", &["would have to pull", "start slower"]);
    check(
        "kind = \"ellipsoid\", semi_axes = [2.5, 2.0, 1.0]",
        "kind = \"polynomial\", terms = [{ coefficient = 1.0, powers = [0, 0, 0] }, { coefficient = 2.0, powers = [4, 0, 0] }]",
        &["not certified convex"],
    );
    let bare = scene().split("[simulation]").next().unwrap().to_owned();
    scratch.write("bare.toml", &bare);
    refused(&scratch, &["simulate", "bare.toml", "-o", "new.csv"], 3, &["has no [simulation]"]);
}

#[test]
fn a_log_in_millimetres_is_named() {
    let scratch = scratch_with_log("millimetres");
    let mut table = Table::parse(&scratch.read("log.csv"));
    table.map(&["s1_1", "s2_1", "s1_2", "s2_2", "s1_3", "s2_3"], |s| 1000.0 * s);
    scratch.write("bad.csv", &table.text());
    let run = scratch.run(&RECONSTRUCT);
    let words = format!("{}{}", run.stdout, run.stderr);
    assert_eq!(run.code, Some(3), "{words}");
    for part in ["the log gives no motion", "are its lengths in millimetres?"] {
        assert!(words.contains(part), "no `{part}` in:\n{words}");
    }
}

#[test]
fn times_in_milliseconds_give_no_motion_and_a_hint() {
    // Before a search, which took seconds: over a thousand times the time forces and weight do to the velocity what no body has.
    let slow = scene().replace("sample_rate = 100.0", "sample_rate = 50.0");
    let scratch = scratch_with_log_of("milliseconds", &slow);
    let mut table = Table::parse(&scratch.read("log.csv"));
    table.map(&["t"], |t| 1000.0 * t);
    scratch.write("bad.csv", &table.text());
    refused(&scratch, &RECONSTRUCT, 3, &["the log gives no motion", "is its time in milliseconds"]);
}

#[test]
fn bad_contacts_are_refused() {
    let scratch = Scratch::new("contacts");
    let check = |text: &str, words: &[&str]| {
        scratch.write("contacts.csv", text);
        refused(&scratch, &["bounds", "contacts.csv", "-o", "out"], 3, words);
    };
    check("", &["contacts.csv", "holds no rows"]);
    check("x,y,z,nx,ny\n", &["column `nz` is missing"]);
    check("x,y,z,nx,ny,nz\n1,0,0,1,0,up\n", &["line 2, column `nz`", "`up`"]);
    check("x,y,z,nx,ny,nz\n1,0,0,3,0,0\n", &["line 2", "length 3"]);
    check("x,y,z,nx,ny,nz\n1,0,0,1,0,0\n", &["at least 4"]);
    // Two half-spaces that face away from each other.
    let apart = "1,0,0,-1,0,0\n-1,0,0,1,0,0\n0,1,0,0,1,0\n0,-1,0,0,-1,0\n0,0,1,0,0,1\n0,0,-1,0,0,-1\n";
    check(&format!("x,y,z,nx,ny,nz\n{apart}"), &["beyond the tangent plane"]);
}

#[test]
fn folders_that_cannot_be_written_are_named_and_nothing_is_lost() {
    let scratch = scratch_with_log("folders");
    let reconstruct = |target: &str, words: &[&str]| {
        refused(&scratch, &["reconstruct", "log.csv", "--scene", "scene.toml", "-o", target], 5, words);
    };
    reconstruct("log.csv/out", &["log.csv"]);
    reconstruct("log.csv", &["log.csv exists and is no folder", "name another folder"]);
    if cfg!(target_os = "linux") {
        // Nobody, not even root, makes folders there.
        reconstruct("/proc/recon-out", &["/proc/recon-out"]);
        refused(&scratch, &["simulate", "scene.toml", "-o", "/proc/log.csv"], 5, &["/proc/log.csv"]);
    }
    std::fs::create_dir(scratch.path().join("thesis")).unwrap();
    scratch.write("thesis/years.tex", "of work");
    reconstruct("thesis", &["thesis holds", "not written by recon", "years.tex"]);
    assert_eq!(scratch.read("thesis/years.tex"), "of work");
}

#[test]
fn errors_are_json_where_a_program_asked() {
    let scratch = Scratch::new("json");
    let run = scratch.run(&["simulate", "none.toml", "-o", "log.csv", "--json"]);
    assert_eq!(run.code, Some(3));
    let error: serde_json::Value = serde_json::from_str(&run.stderr).unwrap();
    assert_eq!(error["error"], "the scene cannot be used");
    assert!(error["causes"][0].as_str().unwrap().contains("none.toml"));
    // Of a command line that is not understood too.
    for (arguments, word) in [
        (&["reconstruct", "--json"][..], "<LOG>"),
        (&["bounds", "a.csv", "--confidence", "2", "--json"], "between 0.5 and 1"),
        (&["--json", "no-such"], "no-such"),
    ] {
        let run = scratch.run(arguments);
        let error: serde_json::Value = serde_json::from_str(&run.stderr).unwrap();
        let told = error["error"].as_str().unwrap();
        assert!(run.code == Some(2) && told.contains(word) && !told.contains("--help"), "{told}");
    }
}

#[test]
fn command_lines_that_are_not_understood_have_their_own_code() {
    let scratch = Scratch::new("usage");
    for arguments in
        [&["reconstrukt"][..], &["simulate", "a.toml"], &["simulate", "a", "-o", "b", "--tolerance", "0"]]
    {
        let run = scratch.run(arguments);
        assert_eq!(run.code, Some(2), "{arguments:?}");
        assert!(run.stderr.contains("Usage") || run.stderr.contains("between"), "{}", run.stderr);
    }
    // A number below zero is one that is refused, and no option that is not known.
    let below = scratch.run(&["bounds", "a.csv", "--contact-noise", "-1"]);
    assert!(below.code == Some(2) && below.stderr.contains("'-1'"), "{}", below.stderr);
    assert!(below.stderr.contains("it must be"), "{}", below.stderr);
    let help = scratch.run(&["--help"]);
    assert_eq!(help.code, Some(0));
    assert!(help.stdout.contains("Exit codes:") && help.stdout.contains("Examples:"));
}

#[test]
fn a_log_that_was_cut_off_within_a_number_is_refused() {
    let scratch = scratch_with_log("cut");
    let good = scratch.read("log.csv");
    // The last number without most of its digits, and without the end of its line alone.
    let start = good.trim_end().rfind(',').unwrap() + 1;
    scratch.write("bad.csv", &good[..start + 4]);
    let line = format!("({})", good.lines().count());
    refused(
        &scratch,
        &RECONSTRUCT,
        3,
        &["bad.csv", "last line", &line, "without a newline", "copy the file anew"],
    );
    let noise = ["--contact-noise", "1e-3", "--force-noise", "0.05"];
    let follow = [&["follow", "bad.csv", "--scene", "scene.toml", "-o", "followed.csv"][..], &noise].concat();
    let run = scratch.run(&follow);
    assert!(run.code == Some(3) && run.stderr.contains("without a newline"), "{:?} {}", run.code, run.stderr);
    scratch.write("whole.csv", good.trim_end());
    let whole = scratch.run(&["reconstruct", "whole.csv", "--scene", "scene.toml", "-o", "out"]);
    assert_eq!(whole.code, Some(0), "{}", whole.stderr);
    let curves = scratch.read("out/contact_curves.csv");
    let start = curves.trim_end().rfind(',').unwrap() + 1;
    scratch.write("curves.csv", &curves[..start + 3]);
    refused(&scratch, &["bounds", "curves.csv", "-o", "bounds"], 3, &["curves.csv", "without a newline"]);
}

#[test]
fn a_planar_log_of_contacts_is_told_by_every_command() {
    let scratch = Scratch::new("planar-contacts");
    scratch
        .write("scene.toml", "gravity = 9.81\n[[palm]]\nkind = \"flat\"\npose = { position = [0, 0, 0] }\n");
    scratch.write("bad.csv", "t,px_1,py_1,Px_1,Py_1,angle_1,fx_1,fy_1\n0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n");
    let told = ["planar log of version 2", "plane = true", "recon planar", "recon reconstruct"];
    refused(&scratch, &RECONSTRUCT, 3, &told);
    refused(&scratch, &["planar", "bad.csv", "-o", "out"], 3, &told);
    refused(&scratch, &["follow", "bad.csv", "--scene", "scene.toml", "-o", "f.csv"], 3, &["mass"]);
}

#[test]
fn scenes_that_are_possible_in_no_unit_are_refused_by_every_command() {
    let scratch = Scratch::new("impossible");
    let good = include_str!("../../scenes/three-tilting-palms.toml");
    for (from, to, words) in [
        ("mass = 0.2", "mass = 1e300", ["object.mass", "kg"]),
        ("mass = 0.2", "mass = 1e-300", ["object.mass", "kg"]),
        ("mass = 0.2", "mass = 2e-4", ["moments", "check the units"]),
        (
            "seed = 1",
            "angular_velocity = [0.0, 0.0, 3e5]\nseed = 1",
            ["simulation.angular_velocity", "rad/s"],
        ),
    ] {
        scratch.write("scene.toml", &good.replacen(from, to, 1));
        refused(&scratch, &["simulate", "scene.toml", "-o", "log.csv"], 3, &words);
        refused(&scratch, &["export", "scene.toml", "-o", "model"], 3, &words);
    }
}
