//! `recon check`: results hold as they were written, and no longer once they are changed.

use crate::common::{Scratch, scene, scratch_with_log_of};
use std::fs;

#[test]
fn results_of_every_command_hold_until_they_are_changed() {
    // At 100 Hz two contacts contradict the limit on the curvature by 2e-8 m, as the error of the motion lets them.
    let scratch = scratch_with_log_of("check", &scene().replace("sample_rate = 100.0", "sample_rate = 50.0"));
    scratch.write("flat.csv", "x,y,nx,ny\n1,0,1,0\n-1,0,-1,0\n0,1,0,1\n0,-1,0,-1\n");
    for (arguments, folder) in [
        (
            &["reconstruct", "log.csv", "--scene", "scene.toml", "--export", "mjcf,urdf", "-o", "out"][..],
            "out",
        ),
        (&["bounds", "out/contact_curves.csv", "--fit", "ellipsoid", "-o", "bounds"], "bounds"),
        (&["bounds", "out/contact_curves.csv", "--rho-max", "7", "-o", "sharp"], "sharp"),
        (&["bounds", "flat.csv", "-o", "flat"], "flat"),
        (&["bounds", "flat.csv", "--rho-max", "2", "--rho-min", "0.5", "-o", "round"], "round"),
    ] {
        let run = scratch.run(arguments);
        assert_eq!(run.code, Some(0), "{arguments:?}: {}{}", run.stdout, run.stderr);
        let run = scratch.run(&["check", folder]);
        assert_eq!(run.code, Some(0), "{folder}: {}", run.stderr);
        assert!(run.stdout.contains("holds") && run.stdout.contains("files as written"), "{}", run.stdout);
    }
    let run = scratch.run(&["check", "out", "--json"]);
    let value: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
    assert!(value["holds"].as_array().unwrap().len() > 4, "{value}");

    // One byte of a corner of the lower bound: the file and what it says are both named.
    let path = scratch.path().join("out/lower_bound.ply");
    let mut bytes = fs::read(&path).unwrap();
    let header = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
    bytes[header + 6] ^= 0x18;
    fs::write(&path, bytes).unwrap();
    fs::remove_file(scratch.path().join("out/motion.csv")).unwrap();
    let run = scratch.run(&["check", "out"]);
    assert_eq!(run.code, Some(3), "{}", run.stdout);
    for words in ["do not hold", "lower_bound.ply was changed", "motion.csv is missing", "stated are"] {
        assert!(run.stderr.contains(words), "`{words}` is not in {}", run.stderr);
    }
    let run = scratch.run(&["check", "."]);
    assert_eq!(run.code, Some(3));
    assert!(run.stderr.contains("no manifest.json"), "{}", run.stderr);
}

#[test]
fn contradictory_contacts_are_not_bounds_in_silence() {
    let scratch = Scratch::new("contradiction");
    // The faces of a cube, and a point far outside of two of them.
    let cube = "x,y,z,nx,ny,nz\n0.5,0,0,1,0,0\n-0.5,0,0,-1,0,0\n0,0.5,0,0,1,0\n0,-0.5,0,0,-1,0\n0,0,0.5,0,0,1\n0,0,-0.5,0,0,-1\n";
    scratch.write("cube.csv", &format!("{cube}3,3,0,1,0,0\n"));
    let run = scratch.run(&["bounds", "cube.csv", "-o", "out"]);
    assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
    assert!(run.stderr.contains("beyond the tangent plane"), "{}", run.stderr);
    assert!(!scratch.path().join("out").exists());
}
