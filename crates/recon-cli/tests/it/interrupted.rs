//! Interruption and readers that go away.

use crate::common::{Scratch, scene, wait_for};
use std::io::{BufRead, BufReader};
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

fn interrupt(child: &Child) {
    let sent = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(sent.success());
}

/// Whether a process has a handler for SIGINT, which is signal 2.
fn catches_interruptions(id: u32) -> bool {
    let Ok(status) = std::fs::read_to_string(format!("/proc/{id}/status")) else {
        // No such file system: then time must do.
        sleep(Duration::from_secs(2));
        return true;
    };
    let caught = status.lines().find_map(|l| l.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(caught.trim(), 16).unwrap() & 0b10 != 0
}

/// A ball that spins on its palms, for as long and as fast as is asked for.
pub(crate) fn spinning_ball(duration: f64, rate: f64, spin: f64) -> String {
    scene()
        .replace("[1.0, 1.45, 2.05]", "[0.4, 0.4, 0.4]")
        .replace("kind = \"ellipsoid\", semi_axes = [2.5, 2.0, 1.0]", "kind = \"sphere\", radius = 1.0")
        .replace("[0.0, 0.3, 0.3]", &format!("[0.0, 0.0, {spin:?}]"))
        .replace("duration = 2.1", &format!("duration = {duration:?}"))
        .replace("sample_rate = 100.0", &format!("sample_rate = {rate:?}"))
}

#[test]
fn interrupted_while_computing_leaves_nothing() {
    let scratch = Scratch::new("computing");
    // Some ten million turns: minutes of work.
    scratch.write("scene.toml", &spinning_ball(1e5, 1.0, 1e3));
    let mut child =
        scratch.command(&["simulate", "scene.toml", "-o", "log.csv"]).stderr(Stdio::piped()).spawn().unwrap();
    let id = child.id();
    assert!(wait_for(&mut child, || catches_interruptions(id)), "ended by itself");
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    let mut line = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut line).unwrap();
    assert!(line.contains("interrupted"), "{line}");
    assert_eq!(scratch.names(), ["scene.toml"]);
}

#[test]
fn interrupted_while_writing_leaves_nothing() {
    let scratch = Scratch::new("writing");
    scratch.write("scene.toml", &spinning_ball(50.0, 2000.0, 1.0)).write("log.csv", "an earlier log");
    let mut child = scratch
        .command(&["simulate", "scene.toml", "-o", "log.csv"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = wait_for(&mut child, || scratch.names().iter().any(|n| n.starts_with(".log.csv.partial")));
    assert!(begun, "the log was written before it could be interrupted");
    interrupt(&child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(scratch.names(), ["log.csv", "scene.toml"]);
    assert_eq!(scratch.read("log.csv"), "an earlier log");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let scratch = Scratch::new("pipe");
    scratch.write("scene.toml", &scene().replace("sample_rate = 100.0", "sample_rate = 5000.0"));
    let mut child = scratch
        .command(&["simulate", "scene.toml", "-o", "-"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut header = String::new();
    BufReader::new(child.stdout.take().unwrap()).read_line(&mut header).unwrap();
    assert!(header.starts_with("t,s1_1,"));
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
}

#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_named() {
    let scratch = Scratch::new("full");
    scratch.write("scene.toml", &scene());
    let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
    let output = scratch
        .command(&["simulate", "scene.toml", "-o", "-"])
        .stdout(full)
        .stderr(Stdio::piped())
        .output()
        .unwrap();
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(5), "{words}");
    assert!(words.contains("standard output cannot be written"), "{words}");
}
