//! Logs that none of our code made: MuJoCo and Drake. Cold start, no guess; truth columns serve the comparison alone.
//!
//! Excerpts are in `data/`; the full logs are read where they lie beside the repository, and skipped aloud where not.

use glam::DVec3;
use recon::object_dynamics::{ContactLog, MassProperties, SensorLog};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon_tests::few_or_all;
use std::path::{Path, PathBuf};

const FIG5: DVec3 = DVec3::new(2.5, 2.0, 1.0);
const TILTED: DVec3 = DVec3::new(1.8, 1.3, 0.9);

struct Case {
    log: &'static str,
    axes: DVec3,
    gravity: f64,
    /// Largest errors allowed: centre of mass, m, and angular velocity, rad/s.
    allowed: (f64, f64),
}

const fn case(log: &'static str, axes: DVec3, gravity: f64, centre: f64, rate: f64) -> Case {
    Case { log, axes, gravity, allowed: (centre, rate) }
}

fn estimate(path: &Path, case: &Case) -> (SensorLog, ContactEstimate) {
    let log = recon_io::read_log(path).unwrap();
    let body = Some(MassProperties::uniform_ellipsoid(1.0, case.axes).unwrap());
    let contacts = ContactLog::try_from(&log.clone().split_truth().0).unwrap();
    let noise = ContactNoiseLevel::guessed(&contacts, case.gravity, None).unwrap();
    let options = ContactOptions { friction: Some(0.0), body, ..ContactOptions::new(noise, case.gravity) };
    let estimate = estimate_contacts(&contacts, None, &options).unwrap();
    (log, estimate)
}

fn check(path: &Path, case: &Case) {
    let (log, estimate) = estimate(path, case);
    let held = log.first_contact_loss().map_or(log.samples().len(), |(sample, _)| sample);
    let pairs = || estimate.states.iter().zip(log.truth().unwrap()).take(held);
    let centre = pairs().map(|(m, t)| m.p_WCm.distance(t.p_WCm)).fold(0.0, f64::max);
    let rate = pairs().map(|(m, t)| m.w_WO.distance(t.w_WO)).fold(0.0, f64::max);
    println!("{}: centre of mass {centre:.2e} m, angular velocity {rate:.2e} rad/s", case.log);
    assert!(centre < case.allowed.0 && rate < case.allowed.1, "{}: {centre:e} m, {rate:e} rad/s", case.log);
    assert!(estimate.reliability.is_reliable(), "{}: {:?}", case.log, estimate.reliability);
    assert_eq!(estimate.states.len(), log.samples().len(), "all of the log is used");
}

#[test]
fn excerpts_are_reconstructed() {
    let excerpts = [
        (case("mj_B_gentle", FIG5, 1.0, 2e-5, 5e-5), "mj_B_gentle_thinned.csv"),
        (case("dr_D_tilted", TILTED, 9.81, 3e-4, 1e-3), "dr_D_tilted_thinned.csv"),
        (case("mj_A_fig5", FIG5, 9.81, 2e-5, 5e-5), "mj_A_fig5_thinned.csv"),
    ];
    for (case, thinned) in &excerpts[..few_or_all(1, 3)] {
        check(&Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(thinned), case);
    }
}

#[test]
fn contact_loss_of_the_gentle_log_is_found() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/mj_B_gentle_thinned.csv");
    let log = recon_io::read_log(path).unwrap();
    let (sample, palm) = log.first_contact_loss().unwrap();
    // Palm 2 leaves at 1.25888 s; the first sample of the 250 Hz excerpt after that is at 1.26 s.
    assert_eq!(palm, 1);
    assert!((log.samples()[sample].t - 1.26).abs() < 1e-9, "{}", log.samples()[sample].t);
}

#[test]
fn full_logs_are_reconstructed() {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "..", "shared", "logs"].iter().collect();
    if !folder.is_dir() {
        println!("skipped: the full logs are not beside this repository");
        return;
    }
    for case in [
        case("mj_A_fig5", FIG5, 9.81, 2e-5, 5e-5),
        case("ex_A_fig5", FIG5, 9.81, 1e-9, 1e-9),
        case("dr_D_tilted", TILTED, 9.81, 3e-4, 1e-3),
        case("mj_B_gentle", FIG5, 1.0, 2e-5, 5e-5),
    ] {
        check(&folder.join(format!("{}.csv", case.log)), &case);
    }
}
