//! What the user has is there after every command: inputs, notes, links, pipes and devices.

use crate::common::{Run, Scratch, scene, scratch_with_log};
use std::fs;

/// Runs a command that must be refused with code 5 and `words`, leaving every file of the folders as it was.
fn refused(scratch: &Scratch, folders: &[&str], arguments: &[&str], words: &[&str]) {
    let before = contents(scratch, folders);
    let Run { code, stdout, stderr } = scratch.run(arguments);
    assert_eq!(code, Some(5), "{arguments:?}\n{stdout}{stderr}");
    for word in words {
        assert!(stderr.contains(word), "{arguments:?}: `{word}` is not in\n{stderr}");
    }
    assert_eq!(contents(scratch, folders), before, "{arguments:?}");
}

fn contents(scratch: &Scratch, folders: &[&str]) -> Vec<(String, Vec<u8>)> {
    let entries = folders.iter().flat_map(|folder| fs::read_dir(scratch.path().join(folder)).unwrap());
    let mut all: Vec<_> = entries
        .map(|e| e.unwrap().path())
        .map(|path| (path.display().to_string(), fs::read(&path).unwrap_or_default()))
        .collect();
    all.sort();
    all
}

const CUBE: &str =
    "x,y,z,nx,ny,nz\n1,0,0,1,0,0\n-1,0,0,-1,0,0\n0,1,0,0,1,0\n0,-1,0,0,-1,0\n0,0,1,0,0,1\n0,0,-1,0,0,-1\n";

#[test]
fn no_command_writes_over_its_input() {
    let scratch = scratch_with_log("own-input");
    fs::create_dir(scratch.path().join("d")).unwrap();
    for (from, to) in [("log.csv", "d/log.csv"), ("scene.toml", "d/scene.toml")] {
        fs::copy(scratch.path().join(from), scratch.path().join(to)).unwrap();
    }
    scratch.write("d/summary.json", "{}").write("d/cube.csv", CUBE);
    let planar = "t,phi1,phi2,s1,s2\n0,0.7,1.5,1,1\n1,0.7,1.5,1,1\n";
    scratch.write("d/planar.csv", planar).write("d/flat.csv", "x,y,nx,ny\n1,0,1,0\n");
    let reconstruct = ["reconstruct", "d/log.csv", "--scene", "d/scene.toml", "-o", "d"];
    let elsewhere = ["reconstruct", "log.csv", "--scene", "d/scene.toml", "-o", "d/../d/"];
    for (arguments, input) in [
        (reconstruct.to_vec(), "d/log.csv"),
        (elsewhere.to_vec(), "d/scene.toml"),
        ([&reconstruct[..], &["--without-forces"]].concat(), "d/log.csv"),
        (vec!["bounds", "d/cube.csv", "-o", "d"], "d/cube.csv"),
        (vec!["bounds", "d/flat.csv", "-o", "."], "d/flat.csv"),
        (vec!["planar", "d/planar.csv", "--contact-noise", "1e-3", "-o", "d"], "d/planar.csv"),
    ] {
        for force in [None, Some("--force")] {
            let arguments: Vec<&str> = arguments.iter().copied().chain(force).collect();
            refused(&scratch, &[".", "d"], &arguments, &[input, "lies in the folder", "name another folder"]);
        }
    }
    for arguments in [
        &["simulate", "scene.toml", "-o", "scene.toml"][..],
        &["follow", "log.csv", "--scene", "scene.toml", "-o", "log.csv"],
        &["follow", "log.csv", "--scene", "scene.toml", "-o", "d/../scene.toml"],
    ] {
        refused(&scratch, &[".", "d"], arguments, &["is the input", "name another file"]);
    }
}

#[test]
fn notes_in_a_folder_of_results_stay() {
    let scratch = Scratch::new("notes");
    scratch.write("cube.csv", CUBE).write("flat.csv", "x,y,nx,ny\n1,0,1,0\n-1,0,-1,0\n0,1,0,1\n0,-1,0,-1\n");
    for input in ["cube.csv", "flat.csv"] {
        let bounds = ["bounds", input, "-o", "out"];
        assert_eq!(scratch.run(&bounds).code, Some(0));
        assert_eq!(scratch.run(&bounds).code, Some(0), "its own files are replaced");
        scratch.write("out/notes.txt", "years");
        refused(&scratch, &["out"], &bounds, &["out holds", "notes.txt", "--force"]);
        assert_eq!(scratch.run(&[&bounds[..], &["--force"]].concat()).code, Some(0));
        assert_eq!(scratch.read("out/notes.txt"), "years");
        scratch.write("out/summary.json", "mine");
        refused(&scratch, &["out"], &bounds, &["summary.json (changed since it was written)"]);
        refused(
            &scratch,
            &["out"],
            &[&bounds[..], &["--force"]].concat(),
            &["summary.json was not written by recon"],
        );
        fs::remove_dir_all(scratch.path().join("out")).unwrap();
    }
    // A folder as recon wrote it before it kept manifests.
    fs::create_dir(scratch.path().join("earlier")).unwrap();
    scratch.write("earlier/summary.json", "{}").write("earlier/log.csv", "");
    for arguments in [&["demo", "-o", "earlier"][..], &["planar", "-o", "earlier"]] {
        refused(
            &scratch,
            &["earlier"],
            arguments,
            &["summary.json (without the manifest.json", "name another folder"],
        );
    }
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_pipes_and_devices_written_to() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let scratch = Scratch::new("special");
    let path = |name: &str| scratch.path().join(name);
    scratch.write("scene.toml", &scene()).write("real.csv", "old");
    symlink("real.csv", path("link.csv")).unwrap();
    symlink("/dev/null", path("null")).unwrap();
    symlink("/dev/stdout", path("out")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
    let reader = {
        let pipe = path("pipe");
        std::thread::spawn(move || fs::read_to_string(pipe).unwrap())
    };
    for target in ["link.csv", "pipe", "null"] {
        let run = scratch.run(&["simulate", "scene.toml", "-o", target]);
        assert_eq!(run.code, Some(0), "{target}: {}", run.stderr);
    }
    let log = scratch.read("real.csv");
    assert!(log.starts_with("t,") && reader.join().unwrap() == log);
    assert_eq!(scratch.run(&["simulate", "scene.toml", "-o", "out"]).stdout, log);
    let kind = |name: &str| fs::symlink_metadata(path(name)).unwrap().file_type();
    assert!(kind("link.csv").is_symlink() && kind("null").is_symlink() && kind("pipe").is_fifo());
    assert_eq!(scratch.names(), ["link.csv", "null", "out", "pipe", "real.csv", "scene.toml"]);
}
