//! `recon reconstruct` on contacts with friction on any palms: from a simulated scene to a folder of results.

use crate::common::{Scratch, Table};
use crate::margins::out_of_truth;
use glam::{DQuat, DVec3};
use recon_tests::few_or_all;
use serde_json::Value;
use std::fs;

/// An ellipsoid that spins between three planes that rub.
const SPINNING: &str = r#"
gravity = 9.81
[object]
mass = 0.2
principal_moments = [1.0e-4, 1.36e-4, 1.64e-4]
[sensors]
contact_std = 4e-5
force_share = 0.004
[palms]
friction = 0.1
[[palm]]
kind = "flat"
pose = { position = [0.037818573637, 0.0, -0.030010972519], normal = [-0.783326909627, 0.0, 0.621609968271] }
[[palm]]
kind = "flat"
pose = { position = [-0.01322345916, 0.022903703116, -0.020986982389], normal = [0.391663454814, -0.678381003205, 0.621609968271] }
[[palm]]
kind = "flat"
pose = { position = [-0.014623591974, -0.025328804288, -0.023209136393], normal = [0.391663454814, 0.678381003205, 0.621609968271] }
[simulation]
duration = 0.4
sample_rate = 500.0
position = [0.0, 0.0, 0.0]
orientation = [0.9800665778412416, 0.08670640444138947, 0.17341280888277893, 0.043353202220694734]
velocity = [0.06497225576597229, 0.03903398224498278, 0.0015911973322760883]
angular_velocity = [3.0, -4.0, 8.0]
seed = 2
shape = { kind = "ellipsoid", semi_axes = [0.05, 0.04, 0.03] }
"#;

/// The same body thrown onto one plate that rubs.
const ONE_PLATE: &str = r#"
gravity = 9.81
[object]
mass = 0.2
principal_moments = [1.0e-4, 1.36e-4, 1.64e-4]
[sensors]
contact_std = 4e-5
force_share = 0.004
[[palm]]
kind = "flat"
friction = 0.2
pose = { position = [0.0, 0.0, 0.0] }
[simulation]
duration = 0.2
sample_rate = 500.0
position = [0.0, 0.0, 0.03]
velocity = [0.3, 0.1, 0.0]
angular_velocity = [0.0, 0.0, 5.0]
shape = { kind = "ellipsoid", semi_axes = [0.05, 0.04, 0.03] }
"#;

/// A folder with a scene and its log.
fn simulated(test: &str, scene: &str) -> Scratch {
    let scratch = Scratch::new(test);
    scratch.write("scene.toml", scene);
    let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv", "--tolerance", "1e-9"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    scratch
}

/// Checks that `recon reconstruct` refuses a log in these words and writes nothing.
fn refused(scratch: &Scratch, scene: &str, further: &[&str], (code, words): (i32, &[&str])) {
    scratch.write("known.toml", scene);
    let arguments = [&["reconstruct", "log.csv", "--scene", "known.toml", "-o", "out"], further].concat();
    let run = scratch.run(&arguments);
    assert_eq!(run.code, Some(code), "{}{}", run.stdout, run.stderr);
    for word in words {
        assert!(run.stderr.contains(word), "`{word}` is not in\n{}", run.stderr);
    }
    assert!(!scratch.path().join("out").exists());
}

/// A log without the columns whose names start so.
fn without_columns(log: &str, starts: &[char]) -> String {
    let mut table = Table::parse(log);
    let kept: Vec<usize> =
        (0..table.header.len()).filter(|&c| !table.header[c].starts_with(starts)).collect();
    let keep = |row: &[String]| kept.iter().map(|&c| row[c].clone()).collect::<Vec<_>>();
    table.rows = table.rows.iter().map(|row| keep(row)).collect();
    table.header = keep(&table.header);
    table.text()
}

fn vectors(table: &Table, stem: &str) -> Vec<DVec3> {
    let places = ["x", "y", "z"].map(|axis| table.column(&format!("{stem}{axis}")));
    table.rows.iter().map(|row| DVec3::from_array(places.map(|k| row[k].parse().unwrap()))).collect()
}

fn turns(table: &Table) -> Vec<DQuat> {
    let (v, w) = (vectors(table, "q"), table.column("qw"));
    let scalar = |row: &Vec<String>| row[w].parse().unwrap();
    v.iter().zip(&table.rows).map(|(v, row)| DQuat::from_xyzw(v.x, v.y, v.z, scalar(row))).collect()
}

#[test]
fn a_motion_with_friction_is_estimated_to_within_what_is_said() {
    let scratch = simulated("friction", SPINNING);
    let told = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"]);
    assert_eq!(told.code, Some(0), "{}{}", told.stdout, told.stderr);
    let said: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    let mut expected =
        ["contact_curves.csv", "manifest.json", "motion.csv", "report.html", "summary.json"].to_vec();
    for (key, file) in [("lower_volume_m3", "lower_bound.ply"), ("upper_volume_m3", "upper_bound.ply")] {
        if said["bounds"][key].as_f64().is_some_and(|volume| volume > 0.0) {
            expected.push(file);
        }
    }
    expected.sort_unstable();
    let mut names: Vec<_> = std::fs::read_dir(scratch.path().join("out"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert_eq!(names, expected);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));

    let (log, motion) =
        (Table::parse(&scratch.read("log.csv")), Table::parse(&scratch.read("out/motion.csv")));
    assert_eq!(motion.rows.len(), log.rows.len());
    let last = "mode_1,mode_2,mode_3,p_slide_1,p_stick_1,p_slide_2,p_stick_2,p_slide_3,p_stick_3,relied_on";
    assert!(motion.header.join(",").ends_with(last), "{:?}", motion.header);
    let relied = motion.column("relied_on");
    assert!(motion.rows.iter().all(|row| row[relied] == "1"));
    let mean = |errors: Vec<DVec3>, deviations: &str| {
        let squares = errors.iter().zip(vectors(&motion, deviations)).map(|(e, s)| (*e / s).length_squared());
        squares.sum::<f64>() / (3 * errors.len()) as f64
    };
    // Errors of neighbouring samples are alike: there are a few independent numbers in each mean.
    for (stem, deviations) in [("cm", "std_cm"), ("v", "std_v"), ("w", "std_w")] {
        let pairs = vectors(&log, stem).into_iter().zip(vectors(&motion, stem));
        let mean = mean(pairs.map(|(truth, found)| found - truth).collect(), deviations);
        assert!((0.1..4.0).contains(&mean), "{stem}: {mean}");
    }
    let (truth, found) = (turns(&log), turns(&motion));
    let error = |(truth_k, found_k): (&DQuat, &DQuat)| {
        (*found_k * found[0].inverse() * (*truth_k * truth[0].inverse()).inverse()).to_scaled_axis()
    };
    let turn = mean(truth.iter().zip(&found).map(error).collect(), "std_turn");
    assert!((0.1..4.0).contains(&turn), "turn: {turn}");

    // The scene states the body: what is left to find of it is how its axes lie, up to half turns.
    assert!((said["mass_kg"].as_f64().unwrap() - 0.2).abs() < 1e-3 && said["std_mass_kg"].is_null());
    let deviations = DVec3::from_array([0, 1, 2].map(|i| said["std_axes_rad"][i].as_f64().unwrap()));
    let half = |v: DVec3| DQuat::from_xyzw(v.x, v.y, v.z, 0.0);
    let turned = [DQuat::IDENTITY, half(DVec3::X), half(DVec3::Y), half(DVec3::Z)].map(|same| {
        let turn = found[0] * (truth[0] * same).inverse();
        if turn.w < 0.0 { -turn } else { turn }.to_scaled_axis()
    });
    let axes = turned.into_iter().min_by(|a, b| a.length().total_cmp(&b.length())).unwrap();
    assert!((axes / deviations).length() < 5.0 && deviations.max_element() < 1.0, "{axes} {deviations}");
    let why = said["note"].as_str().unwrap();
    assert!(why.contains("Friction is felt on palm"), "{why}");
    let shares = said["mode_shares"][0].as_object().unwrap();
    let sum: f64 = ["off", "slides", "sticks"].iter().map(|mode| shares[*mode].as_f64().unwrap()).sum();
    assert!((sum - 1.0).abs() < 1e-12);
    // All three slide, and tell what they rub with: the grid's step is 1.6 %.
    let friction = said["friction"].as_array().unwrap();
    let near = |of: &Value| (of["coefficient"].as_f64().unwrap() - 0.1).abs() < 1.6e-3;
    assert!(friction.len() == 3 && friction.iter().all(near), "{friction:?}");
    assert!(said["unsure_mode_samples"].as_u64().unwrap() < 20, "{}", said["unsure_mode_samples"]);
    // For a person.
    for word in
        ["relied on at 100 %", "contacts of any palms", "as stated", "palm 3: off 0.000 s", "report.html"]
    {
        assert!(told.stdout.contains(word), "`{word}` is not in\n{}", told.stdout);
    }
}

/// The table of `recon follow` has the columns of modes that `motion.csv` has, and what is doubted; body known, its friction not told.
#[test]
fn modes_are_followed_with_the_motion() {
    let scratch = simulated("friction_followed", &SPINNING.replace("duration = 0.4", "duration = 0.7"));
    scratch
        .write("known.toml", &SPINNING.split("[simulation]").next().unwrap().replace("friction = 0.1", ""));
    let words = ["follow", "log.csv", "--scene", "known.toml", "--every", "0"];
    let run = scratch.run(&[&words[..], &["-o", "followed.csv"]].concat());
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let (log, followed) =
        (Table::parse(&scratch.read("log.csv")), Table::parse(&scratch.read("followed.csv")));
    let last = "std_mass,mode_1,mode_2,mode_3,p_slide_1,p_stick_1,p_slide_2,p_stick_2,p_slide_3,p_stick_3,doubt_1,doubt_2,doubt_3";
    assert!(followed.header.join(",").ends_with(last), "{:?}", followed.header);
    let number =
        |table: &Table, k: usize, name: &str| table.rows[k][table.column(name)].parse::<f64>().unwrap();
    let told = |k: &usize| number(&followed, *k, "mode_1").is_finite();
    let first = (0..followed.rows.len()).find(told).expect("modes are told");
    assert!(first > 100 && number(&followed, first - 1, "p_slide_2").is_nan(), "{first}");
    let (mut all, mut right) = (0.0, 0.0);
    for k in first..followed.rows.len() {
        for palm in 1..=3 {
            let of = |name: &str| number(&followed, k, &format!("{name}_{palm}"));
            let (slide, stick) = (of("p_slide"), of("p_stick"));
            assert!((0.0..=1.0).contains(&slide) && (slide + stick - 1.0).abs() < 2e-6, "{slide} {stick}");
            all += 1.0;
            right += f64::from(of("mode") == number(&log, k, &format!("mode_{palm}")));
            assert_eq!(followed.rows[k][followed.column(&format!("doubt_{palm}"))], "none");
        }
    }
    assert!(right > 0.95 * all, "{right} of {all}");
    let run = scratch.run(&[&words[..], &["--json"]].concat());
    let objects: Vec<Value> = run.stdout.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(objects[0]["modes"].is_null());
    let end = objects.last().unwrap()["modes"].as_array().unwrap();
    assert_eq!((end.len(), &end[2]["palm"], &end[0]["doubt"]), (3, &Value::from(3), &Value::Null));
    assert_eq!(end[1]["p_slide"].as_f64(), Some(number(&followed, followed.rows.len() - 1, "p_slide_2")));
}

#[test]
fn mass_and_inertia_are_estimated_where_they_are_not_to_be_looked_at() {
    let scratch = simulated("friction_identify", SPINNING);
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out", "--identify"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let said: Value = serde_json::from_str(&scratch.read("out/summary.json")).unwrap();
    let [mass, deviation] = ["mass_kg", "std_mass_kg"].map(|key| said[key].as_f64().unwrap());
    assert!((mass - 0.2).abs() < 4.0 * deviation && deviation < 2e-3, "{mass} {deviation}");
    let told = &run.stdout;
    assert!(told.contains("mass  ") && !told.contains("as stated"), "{told}");
}

#[test]
fn a_stated_body_that_is_another_one_is_named() {
    let scratch = simulated("friction_other", SPINNING);
    scratch.write("scene.toml", &SPINNING.replace("mass = 0.2", "mass = 0.205"));
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"]);
    assert_eq!(run.code, Some(4), "{}{}", run.stdout, run.stderr);
    assert!(
        run.stdout.contains("the stated mass and inertia are not those of this object"),
        "{}",
        run.stdout
    );
}

/// Little friction, so that the body turns for long enough to be felt from all sides, and good sensors.
#[test]
fn the_body_is_between_its_bounds() {
    let scene = SPINNING
        .replace("friction = 0.1", "friction = 0.005")
        .replace("duration = 0.4", "duration = 0.8")
        .replace("sample_rate = 500.0", "sample_rate = 250.0")
        .replace("contact_std = 4e-5", "contact_std = 4e-6")
        .replace("force_share = 0.004", "force_share = 0.0004");
    let scratch = simulated("between", &scene);
    let run = scratch.run(&[
        "reconstruct",
        "log.csv",
        "--scene",
        "scene.toml",
        "-o",
        "out",
        "--identify",
        "--json",
    ]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    let axes = DVec3::new(0.05, 0.04, 0.03);
    let excess = out_of_truth(&scratch, &scratch.read("log.csv"), axes, &said).map(Option::unwrap);
    // The margins at contacts are some four deviations of the pose.
    assert!(excess.iter().all(|e| (-3e-4..=0.0).contains(e)), "{excess:?}");
    let volume = 4.0 / 3.0 * std::f64::consts::PI * axes.element_product();
    let shares =
        ["lower_volume_m3", "upper_volume_m3"].map(|key| said["bounds"][key].as_f64().unwrap() / volume);
    assert!(shares[0] > 0.3 && shares[1] < 5.0, "{shares:?}");
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
}

#[test]
fn contacts_of_one_palm_need_the_size_of_the_object() {
    let scratch = simulated("one-plate", ONE_PLATE);
    refused(&scratch, ONE_PLATE, &[], (3, &["object.size"]));
    let sized = ONE_PLATE.replace("mass = 0.2", "mass = 0.2\nsize = 0.04");
    scratch.write("sized.toml", &sized);
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "sized.toml", "-o", "out", "--json"]);
    // One plate may leave it open what the motion is: then that is said.
    assert!(matches!(run.code, Some(0 | 4)), "{}{}", run.stdout, run.stderr);
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(run.code == Some(0), said["verdict"]["level"] == "good", "{said}");
    if few_or_all(false, true) {
        fs::remove_dir_all(scratch.path().join("out")).unwrap();
        refused(&scratch, &sized, &["--export", "mjcf"], (3, &["no inner bound to export"]));
    }
}

#[test]
fn what_neither_estimator_can_do_is_refused_by_name() {
    let scratch = simulated("refused", ONE_PLATE);
    let sized = ONE_PLATE.replace("mass = 0.2", "mass = 0.2\nsize = 0.04");
    refused(&scratch, &sized, &["--without-forces"], (3, &["log.csv", "1 palm(s)"]));
    refused(&scratch, &sized.replace("gravity = 9.81", "gravity = 0.0"), &[], (3, &["gravity"]));
    // What a robot has whose palm feels no force.
    scratch.write("log.csv", &without_columns(&scratch.read("log.csv"), &['f', 'J']));
    refused(&scratch, &sized, &[], (3, &["log.csv", "palm 1", "fx_1", "Jx_1", "1 palm(s), not three"]));
}

/// What the scene does not state of the noise is taken from the readings.
#[test]
fn noise_that_is_not_stated_is_estimated() {
    let scene = SPINNING.replace("force_share", "impulse_share = 0.004\nforce_share");
    let scratch = simulated("unstated", &scene);
    let with_forces = scratch.read("log.csv");
    let (sensors, of_simulation) = scene.split_once("[sensors]").unwrap();
    let (_, rest) = of_simulation.split_once("[palms]").unwrap();
    scratch.write("silent.toml", &format!("{sensors}[palms]{rest}"));
    let logs = [(with_forces.clone(), "force"), (without_columns(&with_forces, &['f']), "impulse")];
    for (log, key) in &logs[..few_or_all(1, 2)] {
        scratch.write("log.csv", log);
        let run = scratch.run(&["reconstruct", "log.csv", "--scene", "silent.toml", "-o", "out", "--json"]);
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        let said: Value = serde_json::from_str(&run.stdout).unwrap();
        let noise = |key: &str| said["evidence"][format!("noise_{key}")]["value"].as_f64().unwrap();
        // The median of some thousand numbers is known to a few hundredths.
        assert!((noise("contact") / 4e-5 - 1.0).abs() < 0.1, "{said}");
        assert!((noise(&format!("{key}_share")) / 0.004 - 1.0).abs() < 0.2, "{said}");
        let error = said["largest_error"]["position_m"].as_f64().unwrap();
        assert!(error < 1e-3, "{error}");
    }
}

#[test]
fn impulses_alone_give_the_motion_too() {
    let scene = SPINNING.replace("force_share", "impulse_share = 0.004\nforce_share");
    let scratch = simulated("impulses", &scene);
    let with_forces = scratch.read("log.csv");
    scratch.write("log.csv", &without_columns(&with_forces, &['f']));
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out", "--json"]);
    assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
    let said: Value = serde_json::from_str(&run.stdout).unwrap();
    assert_eq!(said["evidence"]["noise_impulse_share"]["value"].as_f64(), Some(0.004));
    let error = said["largest_error"]["position_m"].as_f64().unwrap();
    assert!(error < 1e-3, "{error}");
    assert_eq!(scratch.run(&["check", "out"]).code, Some(0));
    // Beside forces they count where their noise is stated, and else it is said that they do not.
    if few_or_all(true, false) {
        return;
    }
    scratch.write("log.csv", &with_forces);
    scratch.write("silent.toml", SPINNING);
    let unread = scratch.run(&["reconstruct", "log.csv", "--scene", "silent.toml", "-o", "unread"]);
    assert!(unread.stdout.contains("impulses, which are not used"), "{}", unread.stdout);
}

/// Without friction three planes are those of the paper, whose estimator knows no impulses.
#[test]
fn three_frictionless_planes_with_impulses_alone_go_to_the_other_estimator() {
    let scene = include_str!("../../scenes/three-tilting-palms.toml")
        .replace("friction = 0.3", "friction = 0.0")
        .replace("duration = 4.4", "duration = 0.1");
    let scratch = simulated("three-impulses", &scene);
    scratch.write("log.csv", &without_columns(&scratch.read("log.csv"), &['f']));
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"]);
    assert!(
        run.stdout.contains("Palm 1 measures the impulse of its force and not the force"),
        "{}",
        run.stdout
    );
    // Along the normal alone they are not enough, and the message says what is.
    let mut table = Table::parse(&scratch.read("log.csv"));
    for i in 1..=3 {
        let place = table.column(&format!("Jz_{i}"));
        table.header[place] = format!("Jn_{i}");
        for axis in ["x", "y"] {
            let place = table.column(&format!("J{axis}_{i}"));
            table.header[place] = format!("other_{axis}_{i}");
        }
    }
    scratch.write("log.csv", &table.text());
    let run = scratch.run(&["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "normal"]);
    assert!(run.code == Some(3) && run.stderr.contains("Jx_1, Jy_1, Jz_1"), "{}", run.stderr);
}
