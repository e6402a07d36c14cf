//! Contact modes from forces and slips with noise: drawn contacts, and logs of MuJoCo.
//!
//! Bands were set from the seeds beside them; what they rest on is in `docs/contact-modes.md`.

use recon::observer::contact_modes::{
    ContactFriction, ContactModes, ContactModesOptions, ContactReading, ContactSeen, DoubtedReading,
};
use recon_tests::contact_modes::{LoggedContacts, Score, SlipNoise, TWIST_CORRELATION, classify, drawn};
use recon_tests::few_or_all;
use std::path::Path;
use std::process::Command;

const UNKNOWN: ContactFriction = ContactFriction::Unknown { material: 0 };

fn run(
    log: &LoggedContacts,
    friction: ContactFriction,
    (slips, slip_errors_last): (SlipNoise, f64),
    seed: u64,
) -> (Score, ContactModes) {
    let options =
        ContactModesOptions { slip_errors_last, ..ContactModesOptions::new(log.natural_speed(), 0.01, 1.0) };
    let mut modes = ContactModes::new(&vec![friction; log.palms()], options).unwrap();
    let score = classify(&mut modes, &log.moments(slips, seed)).unwrap();
    (score, modes)
}

#[test]
fn a_drawn_contact_is_told_and_hardly_ever_wrong_with_confidence() {
    let mut all = [Score::default(), Score::default()];
    for seed in 100..104 {
        for (friction, all) in [0.3, 0.8].into_iter().zip(&mut all) {
            let options = ContactModesOptions::new(1.0, 0.01, 1.0);
            let mut modes = ContactModes::new(&[ContactFriction::Known(friction)], options).unwrap();
            let score = classify(&mut modes, &drawn(friction, 3000, seed)).unwrap();
            all.told.extend(score.told);
        }
    }
    for (score, least) in all.iter().zip([0.93, 0.965]) {
        let slides = score.told.iter().filter(|told| told.slides).count();
        assert!(slides > 2000 && score.told.len() - slides > 2000, "both modes count");
        assert!(score.right() > least, "{}", score.right());
        assert!(score.confident_and_wrong() < 0.002, "{}", score.confident_and_wrong());
    }
}

/// What of a drawn contact is doubted after each reading was changed so.
fn doubted(seed: u64, change: impl Fn(&mut ContactReading)) -> Option<DoubtedReading> {
    let mut moments = drawn(0.3, 1000, seed);
    for seen in moments.iter_mut().flat_map(|moment| &mut moment.seen) {
        if let ContactSeen::Read(reading) = seen {
            change(reading);
        }
    }
    let mut modes =
        ContactModes::new(&[ContactFriction::Known(0.3)], ContactModesOptions::new(1.0, 0.02, 1.0)).unwrap();
    classify(&mut modes, &moments).unwrap();
    modes.doubts().next().map(|doubt| doubt.about)
}

#[test]
fn readings_that_are_not_as_stated_are_doubted() {
    for seed in 110..114 {
        assert_eq!(doubted(seed, |_| ()), None);
        let gain = |reading: &mut ContactReading| reading.friction *= 1.05;
        assert_eq!(doubted(seed, gain), Some(DoubtedReading::Friction));
        let forces = |reading: &mut ContactReading| reading.force_deviation *= 0.6;
        assert_eq!(doubted(seed, forces), Some(DoubtedReading::Forces));
        let slips = |reading: &mut ContactReading| {
            reading.slip.as_mut().unwrap().covariance *= 0.4;
        };
        assert_eq!(doubted(seed, slips), Some(DoubtedReading::Slips));
    }
}

#[test]
fn the_friction_of_a_drawn_contact_is_learned() {
    let options = ContactModesOptions::new(1.0, 0.01, 1.0);
    for &(friction, seed) in few_or_all(&[(0.3, 200)][..], &[(0.3, 200), (0.8, 201)]) {
        let mut modes = ContactModes::new(&[UNKNOWN], options).unwrap();
        classify(&mut modes, &drawn(friction, 1500, seed)).unwrap();
        let learned = modes.friction(0).unwrap();
        assert!((learned.coefficient / friction - 1.0).abs() < 0.015, "{learned:?}");
        assert!((learned.coefficient - friction).abs() < 3.0 * learned.deviation, "{learned:?}");
    }
}

#[test]
fn excerpts_of_logs() {
    for (name, axes, friction) in [("S2", [0.05, 0.04, 0.03], 0.3), ("S4", [0.035, 0.03, 0.025], 0.8)] {
        let path = format!("{}/data/contacts_{name}.csv", env!("CARGO_MANIFEST_DIR"));
        let log = LoggedContacts::parse(&std::fs::read_to_string(path).unwrap(), axes);
        let (score, modes) = run(&log, ContactFriction::Known(friction), (SlipNoise::White, 0.0), 11);
        assert_eq!(modes.doubts().next(), None, "{name}");
        assert!(score.told.len() > 500, "{}", score.told.len());
        assert!(score.right() > 0.96, "{name} {}", score.right());
        assert!(score.confident_and_wrong() < 0.003, "{name} {}", score.confident_and_wrong());
    }
}

/// Against the shares that a prototype of the same chains had: right, by log.
#[test]
fn whole_logs_beside_the_repository() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/logs/contacts");
    let flat = [0.05, 0.04, 0.03];
    for (name, axes, friction, right) in [
        ("S2", flat, 0.3, 0.989),
        ("S3", [0.045, 0.035, 0.03], 0.5, 0.966),
        ("S4", [0.035, 0.03, 0.025], 0.8, 0.994),
        ("S6", [0.05, 0.04, 0.025], 0.2, 1.0),
        ("S7", [0.04, 0.035, 0.03], 0.3, 0.941),
        ("S8", flat, 0.3, 0.950),
    ] {
        let packed = folder.join(format!("{name}.csv.gz"));
        if !packed.exists() {
            eprintln!("skipped: {name}, for {} is not there", packed.display());
            continue;
        }
        let text = Command::new("gzip").arg("-dc").arg(&packed).output().unwrap();
        let log = LoggedContacts::parse(&String::from_utf8(text.stdout).unwrap(), axes);
        let known = ContactFriction::Known(friction);
        let (score, _) = run(&log, known, (SlipNoise::Correlated, TWIST_CORRELATION), 21);
        assert!((score.right() - right).abs() < 0.02, "{name} {} {right}", score.right());
        // Eight samples of one episode of S8 alone.
        assert!(score.confident_and_wrong() < 0.002, "{name} {}", score.confident_and_wrong());
    }
}
