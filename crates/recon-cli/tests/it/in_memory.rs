//! The pipeline without files gives what the command writes, to the last bit.

use crate::common::{
    Run, Scratch, Table, fig5, scratch_reconstructed, scratch_with_log, scratch_with_log_of,
};
use crate::interrupted::spinning_ball;
use recon_cli::{Bounded, FailureKind, Follower, Log, Reconstructed, Simulated, Watch, unless_stopped};
use recon_io::Scene;
use recon_tests::few_or_all;
use std::fs;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering::SeqCst};
use std::time::{Duration, Instant};

/// A table as names and columns.
fn columns(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
    let Table { header, rows } = Table::parse(text);
    let column = |i: usize| rows.iter().map(|row| row[i].parse().unwrap()).collect();
    let columns = (0..header.len()).map(column).collect();
    (header, columns)
}

fn slices(columns: &[Vec<f64>]) -> Vec<&[f64]> {
    columns.iter().map(Vec::as_slice).collect()
}

fn words(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

fn good(run: &Run) {
    assert!(matches!(run.code, Some(0 | 4)), "{}{}", run.stdout, run.stderr);
}

#[test]
fn columns_give_the_folder_that_the_command_writes() {
    let (scratch, _) = scratch_reconstructed("in_memory", true);
    let scene = Scene::read(scratch.path().join("scene.toml")).unwrap();
    let (names, values) = columns(&scratch.read("log.csv"));
    let simulated = Simulated::of(&scene, &[], false).unwrap();
    let mut written = Vec::new();
    simulated.log.write_to(&mut written).unwrap();
    assert_eq!(String::from_utf8(written).unwrap(), scratch.read("log.csv"));
    let options = [&["--identify"][..], &["--without-forces"], &[]];
    for &options in few_or_all(&options[..1], &options) {
        if options != ["--identify"] {
            let words = ["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"];
            good(&scratch.run(&[&words, options].concat()));
        }
        let log = Log::of_columns(&names, &slices(&values), &scene).unwrap();
        let made = Reconstructed::of(&log, &scene, &words(options), None).unwrap();
        made.write(&scratch.path().join("mine"), &words(&["--mesh=stl"])).unwrap();
        for file in ["motion.csv", "lower_bound.ply", "upper_bound.ply"] {
            let bytes = |folder: &str| fs::read(scratch.path().join(folder).join(file)).unwrap();
            assert_eq!(bytes("mine"), bytes("out"), "{file} with {options:?}");
        }
        assert_eq!(made.times().len(), made.motion().len());
        assert_eq!(made.body().is_some_and(|body| body.deviations.is_some()), options == ["--identify"]);
    }
}

#[test]
fn rows_give_the_table_that_the_command_writes() {
    // All of it: after half of the time no motion is found.
    let scratch = scratch_with_log_of("in_memory_rows", &fig5());
    let noise = ["--contact-noise=1e-6", "--force-noise=1e-4"];
    good(
        &scratch.run(
            &[&["follow", "log.csv", "--scene", "scene.toml", "--every", "0", "-o", "rows.csv"], &noise[..]]
                .concat(),
        ),
    );
    let (names, values) = columns(&scratch.read("log.csv"));
    let scene = Scene::read(scratch.path().join("scene.toml")).unwrap();
    let mut follower = Follower::new(&names, scene, &words(&noise)).unwrap();
    let mut text = Vec::new();
    // Planes that measure their normal force alone have no modes.
    recon_io::write_stream_header(0, &mut text).unwrap();
    let mut write = |rows: Vec<recon_io::StreamRow>| {
        rows.iter().for_each(|row| recon_io::write_stream_row(row, 0, &mut text).unwrap());
    };
    for k in 0..values[0].len() {
        write(follower.push(&values.iter().map(|column| column[k]).collect::<Vec<_>>()).unwrap());
    }
    write(follower.finish().unwrap());
    let text = String::from_utf8(text).unwrap();
    assert_eq!(text, scratch.read("rows.csv"));
    assert!(text.contains("tracking"), "a motion was found");
    assert_eq!(follower.left_out(), (0, None));
}

#[test]
fn contacts_give_the_bounds_that_the_command_writes() {
    let scratch = Scratch::new("in_memory_bounds");
    good(&scratch.run(&["init", "start"]));
    good(&scratch.run(&["bounds", "start/contacts.csv", "--fit", "ellipsoid", "-o", "out"]));
    let (names, values) = columns(&scratch.read("start/contacts.csv"));
    let made = Bounded::of_columns(&names, &slices(&values), &words(&["--fit=ellipsoid"])).unwrap();
    assert_eq!(format!("{:#}\n", made.summary()), scratch.read("out/summary.json"));
    made.write(&scratch.path().join("mine"), &[]).unwrap();
    let bytes = |folder: &str| fs::read(scratch.path().join(folder).join("fitted_shape.ply")).unwrap();
    assert_eq!(bytes("mine"), bytes("out"));
}

#[test]
fn failures_speak_of_rows_and_keywords() {
    let scratch = scratch_with_log("in_memory_failures");
    let scene = Scene::read(scratch.path().join("scene.toml")).unwrap();
    let (names, mut values) = columns(&scratch.read("log.csv"));
    let log = Log::of_columns(&names, &slices(&values), &scene).unwrap();
    let unknown = Scene::parse("gravity = 9.81").unwrap();
    let failure = Reconstructed::of(&log, &unknown, &[], None).err().unwrap();
    assert_eq!(failure.kind, FailureKind::Input);
    assert!(failure.message.contains("identify") && !failure.message.contains("--"), "{failure}");
    let failure = Reconstructed::of(&log, &scene, &words(&["--idntify"]), None).err().unwrap();
    assert_eq!(failure.kind, FailureKind::Option);
    let place = names.iter().position(|name| name == "f_2").unwrap();
    values[place][7] = f64::NAN;
    let failure = Log::of_columns(&names, &slices(&values), &scene).err().unwrap();
    assert!(failure.message.contains("row 7, column `f_2`"), "{failure}");
}

#[test]
fn an_estimate_is_stopped_within_its_first_step() {
    let scratch = scratch_with_log("in_memory_stopped");
    let scene = Scene::read(scratch.path().join("scene.toml")).unwrap();
    let log = Log::read(&scratch.path().join("log.csv"), &scene, None).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let (told, wanted) = (Arc::new(AtomicUsize::new(0)), Arc::clone(&stop));
    let counted = Arc::clone(&told);
    let watch: Watch = Box::new(move |_| {
        counted.fetch_add(1, SeqCst);
        wanted.store(true, SeqCst);
    });
    let failure = unless_stopped(&stop, || Reconstructed::of(&log, &scene, &[], Some(watch))).err().unwrap();
    assert_eq!((failure.kind, told.load(SeqCst)), (FailureKind::Interrupted, 1));
    assert!(failure.message.starts_with("stopped"), "{failure}");
}

#[test]
fn a_simulation_of_minutes_ends_as_soon_as_another_thread_wants_it() {
    // Some ten million turns of a ball.
    let scene = Scene::parse(&spinning_ball(1e5, 1.0, 1e3)).unwrap();
    let stop = Arc::new(AtomicBool::new(false));
    let setter = Arc::clone(&stop);
    let asked = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(100));
        setter.store(true, SeqCst);
        Instant::now()
    });
    let failure = unless_stopped(&stop, || Simulated::of(&scene, &[], false)).err().unwrap();
    let late = asked.join().unwrap().elapsed();
    assert_eq!(failure.kind, FailureKind::Interrupted);
    // A few milliseconds; on a busy machine more.
    assert!(late < Duration::from_secs(1), "{late:?}");
}
