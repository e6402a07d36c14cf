//! `recon planar`: the paper's Fig. 3 from nothing, its log without forces, and bad input.

use crate::common::{Scratch, Table};
use recon_tests::few_or_all;

/// Last row of a CSV table as numbers.
fn last_row(text: &str) -> Vec<f64> {
    text.lines().last().unwrap().split(',').map(|v| v.parse().unwrap()).collect()
}

#[test]
fn the_demo_and_its_log_without_forces_agree_with_the_truth() {
    let scratch = Scratch::new("planar");
    let run = scratch.run(&["planar"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    // Verdict first, what to do next last.
    assert!(run.stdout.starts_with("The fit settled, "), "{}", run.stdout);
    assert!(run.stdout.contains("  next                   touch more of the object"), "{}", run.stdout);
    let log = scratch.read("recon-planar/log.csv");
    let header: Vec<&str> = log.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|h| *h == name).unwrap();
    let truth = last_row(&log);
    let phi = truth[column("phi0")] - 5.85;
    let observed = last_row(&scratch.read("recon-planar/motion.csv"));
    // Columns t, x, y, phi0; the last one says whether the row is relied on.
    assert!((observed[3] - phi).abs() < 1e-8 && observed.last() == Some(&1.0), "{observed:?} {phi}");
    let figures = scratch.read("recon-planar/figures.svg");
    assert!(figures.contains("error in phi0") && !figures.contains("NaN"));
    let page = scratch.read("recon-planar/report.html");
    assert!(page.contains("Reliable") && page.contains("Lower bound") && !page.contains("NaN"));
    // The body of the demo: 2, 0.15, 0.225, 0.03 and 0, -0.1, 0.05, -0.04 are its coefficients; its area by `(r^2 - r'^2) / 2`.
    let squares = [(1.0, 0.15, -0.1), (2.0, 0.225, 0.05), (3.0, 0.03, -0.04)];
    let waves = squares.iter().map(|(k, a, b): &(f64, f64, f64)| (1.0 - k * k) * (a * a + b * b) / 2.0);
    let area = std::f64::consts::PI * (4.0 + waves.sum::<f64>());
    let summary: serde_json::Value =
        serde_json::from_str(&scratch.read("recon-planar/summary.json")).unwrap();
    let bounds = &summary["bounds"];
    let [lower, upper] = ["lower_area_m2", "upper_area_m2"].map(|key| bounds[key].as_f64().unwrap());
    assert!(lower < area && area < upper && lower > 0.5 * area, "{lower} {area} {upper}");
    for file in ["lower_bound.csv", "upper_bound.csv"] {
        assert!(scratch.read(&format!("recon-planar/{file}")).starts_with("x,y\n"));
    }
    assert_eq!(scratch.run(&["check", "recon-planar"]).code, Some(0));
    // The same with mass and inertia unknown, and by the way that logs of space go.
    let unknown = scratch.run(&["planar", "recon-planar/log.csv", "-o", "unknown"]);
    assert_eq!(unknown.code, Some(0), "{}{}", unknown.stdout, unknown.stderr);
    scratch.write("scene.toml", "plane = true\ngravity = 9.81\n");
    if few_or_all(false, true) {
        let arguments = ["reconstruct", "recon-planar/log.csv", "--scene", "scene.toml", "-o", "by-scene"];
        let run = scratch.run(&arguments);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        assert_eq!(scratch.read("unknown/motion.csv"), scratch.read("by-scene/motion.csv"));
    }

    // Contacts and palm angles alone; two radians of a body with three harmonics, fitted with three.
    let without: Vec<String> =
        log.lines().map(|l| l.split(',').take(5).collect::<Vec<_>>().join(",")).step_by(10).collect();
    let rows: Vec<&str> = without.iter().map(String::as_str).collect();
    scratch.write("bare.csv", &rows.join("\n"));
    let run = scratch.run(&["planar", "bare.csv", "--contact-noise", "1e-4", "--order", "3", "-o", "fit"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let fitted = last_row(&scratch.read("fit/motion.csv"));
    let close = log.lines().filter_map(|l| l.split(',').nth(column("phi0"))?.parse::<f64>().ok());
    let at_end = close.zip(0..).filter(|(_, k)| k % 10 == 9).last().unwrap().0 - 5.85;
    assert!((fitted[1] - at_end).abs() < 1e-2, "{fitted:?} {at_end}");
}

/// A palm that rubs, one that sticks and slips, a fingertip: simulated, and estimated from the log with nothing known of the body.
const RUBBED: &str = "plane = true
gravity = 9.81
[object]
mass = 0.2
inertia = 1.8e-4
[sensors]
contact_std = 1e-4
force_std = 0.01
[[palm]]
kind = \"line\"
friction = 0.3
pose = { position = [0.0, 0.0], angle_deg = 45.0 }
motion = [{ pivot = [0.0, 0.0], law = { kind = \"sinusoid\", amplitude = 0.3, frequency = 6.0 } }]
[[palm]]
kind = \"line\"
friction = 0.2
pose = { position = [0.0, 0.0], angle_deg = 315.0 }
motion = [{ pivot = [0.0, 0.0], law = { kind = \"sinusoid\", amplitude = 0.2, frequency = 4.0 } }]
[simulation]
duration = 2.0
sample_rate = 500.0
position = [0.0, 0.06]
touches = [1, 2]
shape = { kind = \"ellipse\", semi_axes = [0.05, 0.035] }
";

#[test]
fn palms_that_rub_are_estimated() {
    let scratch = Scratch::new("planar-rubbed");
    scratch.write("scene.toml", RUBBED);
    let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    // Whoever has a log needs no simulation, and no poses of palms.
    let known: String =
        RUBBED.split("[simulation]").next().unwrap().lines().fold(String::new(), |all, line| {
            let kept = !(line.starts_with("pose") || line.starts_with("motion"));
            if kept { all + line + "\n" } else { all }
        });
    scratch.write("known.toml", &known);
    for &arguments in
        few_or_all(&[&["--identify", "--covariance"][..]][..], &[&[], &["--identify", "--covariance"]])
    {
        let all = [&["reconstruct", "log.csv", "--scene", "known.toml", "-o", "out"], arguments].concat();
        let run = scratch.run(&all);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        let summary: serde_json::Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
        let number = |key: &str| summary[key].as_f64().unwrap();
        assert!((number("mass_kg") - 0.2).abs() < 0.001 && number("relied_on_share") > 0.99, "{summary}");
        assert!((number("inertia_kg_m2") - 1.8e-4).abs() < 1e-5, "{summary}");
        // Noise of the contacts is 0.1 mm.
        let errors = &summary["largest_error"];
        assert!(
            errors["position_m"].as_f64().unwrap() < 1e-4
                && errors["orientation_rad"].as_f64().unwrap() < 0.01
        );
    }
    modes_are_told(&scratch);
    covariances_are_told(&scratch);
    no_more_than_needed(&scratch);
    if few_or_all(true, false) {
        return;
    }
    // Forces that are said to be three times as good as they are.
    scratch.write("better.toml", &known.replace("force_std = 0.01", "force_std = 0.003"));
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "better.toml", "-o", "doubted"]);
    let summary: serde_json::Value = serde_json::from_str(&scratch.read("doubted/summary.json")).unwrap();
    let doubts = summary["mode_doubts"].as_array().unwrap();
    let of_forces = |doubt: &&serde_json::Value| doubt["about"] == "noise of forces";
    let doubt = doubts.iter().find(of_forces).unwrap_or_else(|| panic!("{summary}"));
    assert!(doubt["by"].as_f64().unwrap() > 1.5 && doubt["deviations"].as_f64().unwrap() > 4.5, "{doubt}");
    assert!(matches!(doubt["palm"].as_u64(), Some(1 | 2)));
    assert!(doubt["text"].as_str().unwrap().contains("forces are noisier, or late"), "{doubt}");
    assert!(run.stdout.contains("sure and wrong"), "{}", run.stdout);
}

/// A row beside each of the motion, with the squares of its deviations on the diagonal.
fn covariances_are_told(scratch: &Scratch) {
    let [motion, covariance] =
        ["motion", "covariance"].map(|name| Table::parse(&scratch.read(&format!("out/{name}.csv"))));
    assert_eq!(motion.rows.len(), covariance.rows.len());
    let number =
        |table: &Table, k: usize, name: &str| -> f64 { table.rows[k][table.column(name)].parse().unwrap() };
    for k in 0..motion.rows.len() {
        for name in ["x", "y", "phi0"] {
            let variance = number(&covariance, k, &format!("cov_{name}_{name}"));
            let std = number(&motion, k, &format!("std_{name}"));
            assert!((variance - std * std).abs() <= 1e-9 * variance, "{k} {name}: {variance} {std}");
        }
        let across = number(&covariance, k, "cov_x_phi0");
        let most = number(&motion, k, "std_x") * number(&motion, k, "std_phi0");
        assert!(across.abs() <= most * (1.0 + 1e-9), "{k}: {across} {most}");
    }
}

/// Columns of modes and their probabilities against the modes of the log, and what the summary says of them.
fn modes_are_told(scratch: &Scratch) {
    let (log, motion) =
        (Table::parse(&scratch.read("log.csv")), Table::parse(&scratch.read("out/motion.csv")));
    let last = "mode_1,mode_2,p_slide_1,p_stick_1,p_slide_2,p_stick_2,relied_on";
    assert!(motion.header.join(",").ends_with(last), "{:?}", motion.header);
    let number =
        |table: &Table, k: usize, name: &str| table.rows[k][table.column(name)].parse::<f64>().unwrap();
    // What the log's truth slips by at its contacts, which are off by 0.1 mm and so these by some tenths of mm/s; none where that leaves it open.
    let slides = |k: usize, palm: usize| {
        let at = |name: &str| number(&log, k, name);
        let of = |name: &str, k: usize| number(&log, k, &format!("{name}_{palm}"));
        let rate = (of("angle", k + 1) - of("angle", k - 1)) / (at("t") - number(&log, k - 1, "t")) / 2.0;
        let [x, y] = ["px", "py"].map(|name| of(name, k));
        let (omega, arm) = (at("omega0"), [x - at("cmx"), y - at("cmy")]);
        let slip = [at("vx") - omega * arm[1] + rate * y, at("vy") + omega * arm[0] - rate * x];
        match slip[0].hypot(slip[1]) {
            0.0..1.5e-3 => Some(false),
            6e-3.. => Some(true),
            _ => None,
        }
    };
    let (mut right, mut all, mut unsure) = (0.0, [0.0; 2], 0);
    for k in 0..motion.rows.len() {
        let mut open = false;
        for palm in 1..=2 {
            let of = |name: &str| number(&motion, k, &format!("{name}_{palm}"));
            let told = [1.0 - of("p_slide") - of("p_stick"), of("p_slide"), of("p_stick")];
            assert!(told.iter().all(|p| (-2e-6..=1.0).contains(p)), "{told:?}");
            let most = (0..3).fold(0, |most, mode| if told[mode] > told[most] { mode } else { most });
            assert_eq!(of("mode"), most as f64, "the mode is the most probable one");
            open |= told[most] < 0.99;
            let inside = k > 0 && k + 1 < motion.rows.len();
            if let Some(slides) = inside.then(|| slides(k, palm)).flatten() {
                all[usize::from(slides)] += 1.0;
                right += f64::from(slides == (most == 1));
            }
        }
        unsure += usize::from(open);
    }
    assert!(all[0] > 100.0 && all[1] > 100.0, "both modes count: {all:?}");
    assert!(right > 0.95 * all.iter().sum::<f64>(), "{right} of {all:?}");
    let summary: serde_json::Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    // Rounding to a millionth moves none over the border but by chance.
    assert!(summary["unsure_mode_samples"].as_u64().unwrap().abs_diff(unsure as u64) <= 1, "{unsure}");
    assert_eq!(summary["mode_doubts"], serde_json::json!([]));
    for learned in summary["friction"].as_array().unwrap() {
        let stated = [0.3, 0.2][learned["palm"].as_u64().unwrap() as usize - 1];
        let error = learned["coefficient"].as_f64().unwrap() / stated - 1.0;
        // A step of the grid is 1.6 %.
        assert!(error.abs() < 0.016, "{learned}");
    }
    assert!(!summary["friction"].as_array().unwrap().is_empty());
}

/// No more than an accuracy needs: at 500 Hz a body of 4 cm has 34 samples in a natural time, and mass and inertia need not be known.
fn no_more_than_needed(scratch: &Scratch) {
    let wanted =
        ["reconstruct", "log.csv", "--scene", "known.toml", "-o", "least", "--accuracy", "0.03", "--explain"];
    let run = scratch.run(&wanted);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("Mass and inertia:") && run.stderr.contains("* estimated"), "{}", run.stderr);
    let summary: serde_json::Value = serde_json::from_str(&scratch.read("least/summary.json")).unwrap();
    let least = &summary["least_model"];
    assert!(least["is_reached"] == true && summary["body_as_stated"] == false, "{summary}");
    // In sizes of about 4 cm.
    assert!(summary["largest_error"]["position_m"].as_f64().unwrap() < 0.03 * 0.04, "{summary}");
    assert!(scratch.read("least/report.html").contains("Mass and inertia"));
    for folder in ["out", "least"] {
        let run = scratch.run(&["check", folder]);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    }
}

#[test]
fn bad_input_is_refused() {
    let scratch = Scratch::new("planar-bad");
    scratch.write("flat.csv", "t,phi1,phi2,s1,s2\n0,0.7,1.5,1,1\n1,0.7,4,1,1\n");
    scratch.write("word.csv", "t,phi1,phi2,s1,s2\n0,0.7,1.5,one,1\n1,0.7,1.5,1,1\n");
    let rows = (0..20).map(|k| format!("{},45,90,2000,2100,1,1\n", 0.01 * f64::from(k)));
    let degrees: String = rows.collect();
    scratch.write("degrees.csv", &format!("t,phi1,phi2,s1,s2,f1,f2\n{degrees}"));
    let millimetres = degrees.replace(",45,90,", ",0.7,1.6,");
    scratch.write("millimetres.csv", &format!("t,phi1,phi2,s1,s2,f1,f2\n{millimetres}"));
    scratch.write("bare.csv", "t,phi1,phi2,s1,s2\n0,0.7,1.5,1,1\n1,0.7,1.5,1,1\n");
    let known = |file| vec!["planar", file, "--mass", "1", "--inertia", "1"];
    for (arguments, code, words) in [
        (known("degrees.csv"), 3, "radians"),
        (vec!["planar", "bare.csv"], 3, "--contact-noise"),
        (vec!["planar", "none.csv"], 3, "none.csv"),
        (vec!["planar", "flat.csv", "--contact-noise", "1e-3"], 3, "line 3"),
        (vec!["planar", "word.csv", "--contact-noise", "1e-3"], 3, "`one` is not a number"),
        (vec!["planar", "flat.csv", "--mass", "2"], 2, "--inertia"),
        (vec!["planar", "flat.csv", "--gravity", "nan"], 2, "positive"),
    ] {
        let run = scratch.run(&arguments);
        assert_eq!(run.code, Some(code), "{arguments:?}: {}{}", run.stdout, run.stderr);
        assert!(run.stderr.contains(words), "{arguments:?}: {}", run.stderr);
        assert!(!scratch.path().join("recon-planar").exists());
    }
    // Millimetres for metres are no error, and of readings that stand still no row tells a motion: both are said.
    let run = scratch.run(&known("millimetres.csv"));
    assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("relied on at 0 % of") && run.stdout.contains("m (lengths are in metres)"));
    assert!(run.stdout.contains("at none is it known so well that its deviations hold"));
}
