//! What a newcomer is given: files to begin from, formats, what was understood of an input, help.

use crate::common::{Scratch, Table, scratch_reconstructed, scratch_with_log};
use serde_json::Value;
use std::fs;

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|_| panic!("{text}"))
}

#[test]
fn every_command_that_init_names_runs_on_its_files() {
    let scratch = Scratch::new("init");
    let run = scratch.run(&["init", "start", "--json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let next = json(&run.stdout)["next"].as_array().unwrap().clone();
    assert_eq!(next.len(), 4);
    for line in &next {
        let words: Vec<&str> = line.as_str().unwrap().split(' ').collect();
        let told = scratch.run(&words[1..]);
        assert_eq!(told.code, Some(0), "{line}\n{}{}", told.stdout, told.stderr);
    }
    // The scene explains itself, and its log is that of the scene.
    assert!(scratch.read("start/scene.toml").matches('#').count() > 20);
    assert_eq!(scratch.read("start/log.csv"), scratch.read("log.csv"));
    assert_eq!(scratch.run(&["check", "start"]).code, Some(0));
}

#[test]
fn formats_name_every_column_that_is_written() {
    let (scratch, _) = scratch_reconstructed("formats", false);
    let formats = json(&scratch.run(&["formats", "--json"]).stdout);
    let columns = |name: &str| -> Vec<String> {
        let format = formats.as_array().unwrap().iter().find(|format| format["name"] == name).unwrap();
        let groups = format["columns"].as_array().unwrap();
        groups.iter().flat_map(|group| named(group["name"].as_str().unwrap())).collect()
    };
    let ran = |words: &[&str]| {
        let run = scratch.run(words);
        assert!(matches!(run.code, Some(0 | 4)), "{}", run.stderr);
    };
    let noise = ["--contact-noise", "1e-6", "--force-noise", "1e-4"];
    ran(&[&["follow", "log.csv", "--scene", "scene.toml", "-o", "rows.csv"], &noise[..]].concat());
    fs::create_dir(scratch.path().join("logs")).unwrap();
    scratch.write("logs/log.csv", &scratch.read("log.csv"));
    ran(&["batch", "logs", "--scene", "scene.toml", "-o", "many"]);
    for (file, format) in [
        ("log.csv", "log"),
        ("out/motion.csv", "motion"),
        ("out/contact_curves.csv", "contact-curves"),
        ("rows.csv", "following"),
        ("many/results.csv", "batch"),
    ] {
        let known = columns(format);
        for name in Table::parse(&scratch.read(file)).header {
            let stem = name.rsplit_once('_').filter(|(_, number)| number.parse::<u8>().is_ok());
            let general = stem.map_or(name.clone(), |(stem, _)| format!("{stem}_i"));
            assert!(known.contains(&general), "{file}: {name} is not in {known:?}");
        }
    }
    // One of them, for a person; and one that is none.
    let one = scratch.run(&["formats", "contacts"]);
    assert!(one.stdout.contains("nx, ny, nz") && !one.stdout.contains("phi1"), "{}", one.stdout);
    let none = scratch.run(&["formats", "cont"]);
    assert!(none.code == Some(2) && none.stderr.contains("contacts"), "{}", none.stderr);
}

/// `s1_i, s2_i` and `nx_i..nz_i` one by one.
fn named(group: &str) -> Vec<String> {
    let range = |part: &str| -> Vec<String> {
        let Some((from, to)) = part.split_once("..") else { return vec![part.to_owned()] };
        // The letter in which they differ runs through w, x, y, z.
        let place = from.bytes().zip(to.bytes()).position(|(a, b)| a != b).unwrap();
        let letter = |c: char| format!("{}{c}{}", &from[..place], &from[place + 1..]);
        let (first, last) = (from.as_bytes()[place] as char, to.as_bytes()[place] as char);
        ('w'..='z').filter(|c| (first..=last).contains(c)).map(letter).collect()
    };
    group.split(", ").flat_map(range).collect()
}

#[test]
fn what_is_understood_of_a_log_is_told() {
    let scratch = scratch_with_log("check_input");
    let mut table = Table::parse(&scratch.read("log.csv"));
    // A gap, and a palm without contact for a while.
    table.rows.drain(20..25);
    for row in 100..110 {
        for (column, value) in [("s1_2", "nan"), ("s2_2", "nan"), ("f_2", "0")] {
            table.set(row, column, value);
        }
    }
    scratch.write("gap.csv", &table.text());
    let run = scratch.run(&["check-input", "gap.csv", "--scene", "scene.toml", "--json"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let said = json(&run.stdout);
    assert_eq!((&said["version"], &said["samples"]), (&1.into(), &(table.rows.len()).into()));
    assert!((said["rate_hz"].as_f64().unwrap() - 100.0).abs() < 1e-6);
    let time = |row: usize| table.rows[row][0].parse::<f64>().unwrap();
    assert_eq!(said["gaps"], serde_json::json!([[time(19), time(20)]]));
    let spans = said["palms"][1]["touched_s"].as_array().unwrap();
    assert_eq!((spans.len(), &spans[0][1]), (2, &time(99).into()));
    assert_eq!(said["palms"][0]["force_axes"], "normal alone");
    // For a person, without a scene, and with units that do not go together.
    let told = scratch.run(&["check-input", "log.csv", "--scene", "scene.toml"]);
    for word in [
        "version 1",
        "units                  m, s, kg, N, rad: contacts of a sample are up to",
        "frames                 contacts in the frame of each palm",
        "100 samples a second",
        "palm 3",
        "estimated as",
        "roughness",
    ] {
        assert!(told.stdout.contains(word), "`{word}` is not in\n{}", told.stdout);
    }
    let lost = scratch.run(&["check-input", "log.csv"]);
    assert!(lost.code == Some(3) && lost.stderr.contains("--scene"), "{}", lost.stderr);
    let mut long = Table::parse(&scratch.read("log.csv"));
    long.map(&["s1_1", "s2_1", "s1_2", "s2_2", "s1_3", "s2_3"], |s| 1000.0 * s);
    scratch.write("long.csv", &long.text());
    let odd = scratch.run(&["check-input", "long.csv", "--scene", "scene.toml"]);
    assert!(odd.code == Some(4) && odd.stdout.contains("millimetres"), "{}", odd.stdout);
    // Of a palm that measures its force in every second row.
    let mut held = Table::parse(&scratch.read("log.csv"));
    let force = held.column("f_2");
    (1..held.rows.len()).step_by(2).for_each(|row| held.rows[row][force] = held.rows[row - 1][force].clone());
    scratch.write("held.csv", &held.text());
    let odd = scratch.run(&["check-input", "held.csv", "--scene", "scene.toml"]);
    let named = odd.stdout.contains("the forces of palm 2 repeat") && odd.stdout.contains("over 2.0 rows");
    assert!(odd.code == Some(4) && named && !odd.stdout.contains("palm 1 repeat"), "{}", odd.stdout);
    // Rows at which it says nothing new are left out of an estimate.
    let made = scratch.run(&["reconstruct", "held.csv", "--scene", "scene.toml", "-o", "of_held"]);
    assert!(matches!(made.code, Some(0 | 4)), "{}", made.stderr);
    assert_eq!(Table::parse(&scratch.read("of_held/motion.csv")).rows.len(), held.rows.len().div_ceil(2));
    let summary = scratch.read("of_held/summary.json");
    assert!(summary.contains("The forces of palm 2 repeat") && summary.contains("are left out"), "{summary}");
    // Of one whose force has noise, and freezes for thirty rows.
    let mut frozen = Table::parse(&scratch.read("log.csv"));
    for row in 0..frozen.rows.len() {
        let noisy = frozen.rows[row][force].parse::<f64>().unwrap() * (1.0 + 0.01 * (9e3 * row as f64).sin());
        frozen.rows[row][force] = noisy.to_string();
    }
    (61..91).for_each(|row| frozen.rows[row][force] = frozen.rows[60][force].clone());
    scratch.write("frozen.csv", &frozen.text());
    let odd = scratch.run(&["check-input", "frozen.csv", "--scene", "scene.toml"]);
    let named = odd.stdout.contains("the force of palm 2 repeats from") && odd.stdout.contains("30 samples");
    assert!(odd.code == Some(4) && named, "{}", odd.stdout);
}

#[test]
fn what_is_understood_of_a_log_in_the_plane_is_told() {
    let scratch = Scratch::new("check_planar");
    let run = scratch.run(&["planar", "-q"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    scratch.write("hinged.toml", "plane = true\ngravity = 9.81\n");
    let hinged = ["check-input", "recon-planar/log.csv", "--scene", "hinged.toml"];
    let told = scratch.run(&hinged);
    for word in [
        "planar sensor log, version 1: 2 palms",
        "from the hinge",
        "palm 2                 line",
        "1000 samples",
    ] {
        assert!(
            told.code == Some(0) && told.stdout.contains(word),
            "`{word}` is not in\n{}{}",
            told.stdout,
            told.stderr
        );
    }
    let said = json(&scratch.run(&[&hinged[..], &["--json"]].concat()).stdout);
    assert_eq!((&said["kind"], &said["samples"]), (&"planar log".into(), &1401.into()));
    // What is of the space alone is not left out in silence.
    for option in [
        &["--mcap"][..],
        &["--mesh", "stl"],
        &["--export", "urdf"],
        &["--without-forces"],
        &["-m", "map.toml"],
    ] {
        let words = ["reconstruct", "recon-planar/log.csv", "--scene", "hinged.toml", "-o", "out"];
        let run = scratch.run(&[&words, option].concat());
        assert!(
            run.code == Some(2) && run.stderr.contains("in the plane"),
            "{option:?}: {:?} {}",
            run.code,
            run.stderr
        );
        assert!(!scratch.path().join("out").exists());
    }
}

#[test]
fn what_is_understood_of_contacts_is_told() {
    let scratch = Scratch::new("check_contacts");
    scratch.write("contacts.csv", "x,y,z,nx,ny,nz\n1,0,0,1,0,0\n-1,0,0,-1,0,0\n0,2,0,0,0.9995,0\n");
    let run = scratch.run(&["check-input", "contacts.csv", "--json"]);
    let said = json(&run.stdout);
    assert_eq!((run.code, &said["rows"]), (Some(4), &3.into()), "{}", run.stderr);
    assert_eq!(said["extent_m"], serde_json::json!([2.0, 2.0, 0.0]));
    assert!((said["normals_off_by"].as_f64().unwrap() - 5e-4).abs() < 1e-12);
    assert!(said["warnings"][0].as_str().unwrap().contains("--estimate-noise"));
    scratch.write("contacts.csv", "x,y,z,nx,ny,nz\n1,0,0,1,0,much\n");
    let bad = scratch.run(&["check-input", "contacts.csv"]);
    assert!(bad.code == Some(3) && bad.stderr.contains("much"), "{}", bad.stderr);
}

#[test]
fn help_is_short_or_long_and_shells_and_manuals_know_all_commands() {
    let scratch = Scratch::new("help");
    let (short, long) = (scratch.run(&["-h"]).stdout, scratch.run(&["--help"]).stdout);
    assert!(short.len() < long.len() && !short.contains("Exit codes") && long.contains("Exit codes"));
    for command in ["bounds", "explore", "next"] {
        let [short, long] = ["-h", "--help"].map(|help| scratch.run(&[command, help]).stdout);
        assert!(!short.contains("Examples:") && long.contains("Examples:"), "{short}");
        assert!(2 * short.lines().count() < long.lines().count(), "{short}");
    }
    let page = scratch.run(&["man"]).stdout;
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let text = scratch.run(&["completions", shell]).stdout;
        for command in ["reconstruct", "check-input", "batch"] {
            assert!(text.contains(command), "{shell} does not know {command}");
            assert!(page.contains(&format!("RECON {}", command.to_uppercase())), "{command}");
        }
    }
    assert!(page.starts_with(".TH RECON 1"), "{}", &page[..200]);
    // Examples stand line by line, as in the help.
    assert!(
        page.contains("\n  recon next out\n") && page.matches(".nf").count() == page.matches(".fi\n").count()
    );
}

#[test]
fn quiet_leaves_errors_and_answers_that_stand_nowhere_else() {
    let scratch = scratch_with_log("quiet");
    let noise = ["--contact-noise", "1e-6", "--force-noise", "1e-4"];
    let words = [&["follow", "log.csv", "--scene", "scene.toml"], &noise[..]].concat();
    let (loud, quiet) = (scratch.run(&words), scratch.run(&[&words[..], &["--quiet"]].concat()));
    assert!(!loud.stderr.is_empty() && quiet.stderr.is_empty(), "{}", quiet.stderr);
    assert_eq!((loud.stdout, loud.code), (quiet.stdout, quiet.code));
    // What stands in files is not told of, unless a program asks.
    for words in [
        "init start",
        "simulate scene.toml -o again.csv",
        "bounds start/contacts.csv -o bounds",
        "check bounds",
    ] {
        let words: Vec<_> = words.split(' ').collect();
        let quiet = scratch.run(&[&words[..], &["-q"]].concat());
        let told = (quiet.code, quiet.stdout.as_str(), quiet.stderr.as_str());
        assert_eq!(told, (Some(0), "", ""), "{words:?}");
    }
    assert!(scratch.run(&["bounds", "start/contacts.csv", "-q"]).stdout.contains("lower bound"));
    assert!(scratch.run(&["check", "bounds", "-q", "--json"]).stdout.starts_with('{'));
    let wrong = scratch.run(&["-q", "check", "nowhere"]);
    assert!(wrong.code == Some(3) && !wrong.stderr.is_empty());
}

#[test]
fn the_console_answers_what_was_asked() {
    let (_, known) = scratch_reconstructed("answers-known", false);
    let (scratch, asked) = scratch_reconstructed("answers", true);
    let line = |text: &str, name: &str| -> String {
        let found = text.lines().find(|line| line.trim_start().starts_with(name));
        found.unwrap_or_else(|| panic!("{name} is not in\n{text}")).to_owned()
    };
    assert!(line(&known.stdout, "mass").contains("1 kg, as stated"));
    let summary = json(&scratch.read("out/summary.json"));
    let std = summary["evidence"]["std_mass"]["value"].as_f64().unwrap();
    let told = line(&asked.stdout, "mass");
    let value: f64 = told.split("+- ").nth(1).unwrap().trim_end_matches(" kg").parse().unwrap();
    assert!((value / std - 1.0).abs() < 0.05, "{told} for {std}");
    assert_eq!(line(&asked.stdout, "principal moments").matches("+-").count(), 3);
    for name in ["motion known to", "next"] {
        line(&known.stdout, name);
        line(&asked.stdout, name);
    }
    // The same number is the same on the page.
    let page = scratch.read("out/report.html");
    for (name, tile) in [
        ("lower bound", "Lower bound"),
        ("upper bound", "Upper bound"),
        ("lower / upper", "Lower / upper"),
        ("largest error: position", "Largest position error"),
        ("angular velocity", "Largest rate error"),
    ] {
        let told = line(&asked.stdout, name);
        let value = told.trim_start().strip_prefix(name).unwrap().split_whitespace().next().unwrap();
        assert!(page.contains(&format!("<dt>{tile}</dt><dd>{value}<small>")), "{told}");
    }
}

#[test]
fn bounds_are_written_as_stl_and_gltf_too() {
    let (scratch, _) = scratch_reconstructed("meshes", false);
    let bytes = |name: &str| fs::read(scratch.path().join("out").join(name)).unwrap();
    for bound in ["lower_bound", "upper_bound"] {
        let ply = bytes(&format!("{bound}.ply"));
        let header = String::from_utf8_lossy(&ply[..400]).into_owned();
        let faces = header.lines().find_map(|line| line.strip_prefix("element face ")).unwrap();
        let stl = bytes(&format!("{bound}.stl"));
        assert_eq!(stl.len(), 84 + 50 * faces.parse::<usize>().unwrap());
        assert!(bytes(&format!("{bound}.glb")).starts_with(b"glTF"));
    }
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let curves = ["bounds", "out/contact_curves.csv", "--fit", "ellipsoid", "--mesh", "glb", "-o", "bounds"];
    let run = scratch.run(&curves);
    assert!(matches!(run.code, Some(0 | 4)), "{}", run.stderr);
    assert!(scratch.path().join("bounds/lower_bound.glb").exists());
    scratch.write("plane.csv", "x,y,nx,ny\n1,0,1,0\n0,1,0,1\n-1,0,-1,0\n0,-1,0,-1\n");
    let plane = scratch.run(&["bounds", "plane.csv", "--mesh", "stl", "-o", "plane"]);
    assert!(plane.code == Some(2) && plane.stderr.contains("--mesh"), "{}", plane.stderr);
}

/// The page that is written of what is told has the same words, and pictures of the readings.
#[test]
fn what_is_told_of_an_input_is_a_page_too() {
    let scratch = Scratch::new("check-input-page");
    assert_eq!(scratch.run(&["init", "start"]).code, Some(0));
    let log = ["check-input", "start/log.csv", "--scene", "start/scene.toml", "--report", "log.html"];
    let run = scratch.run(&log);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let page = scratch.read("log.html");
    for says in [
        "Time from sample to sample",
        "Contacts from their mean",
        "noise of forces",
        "Nothing speaks against",
    ] {
        assert!(page.contains(says), "{says}");
    }
    assert!(!page.contains("src="));
    let contacts = ["check-input", "start/contacts.csv", "--report", "contacts.html"];
    assert_eq!(scratch.run(&contacts).code, Some(0));
    assert!(scratch.read("contacts.html").contains("Seen from above"));
    let onto_itself = ["check-input", "start/contacts.csv", "--report", "start/contacts.csv"];
    assert_eq!(scratch.run(&onto_itself).code, Some(5), "an input is not written over");
}
