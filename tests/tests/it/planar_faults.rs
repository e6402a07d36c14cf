//! What the estimate in the plane says of logs in which something is broken: contacts, clocks, sensors, what is known of the body.

use crate::planar_common::{errors, noise_level, options, scene, times};
use recon::object_dynamics::planar::*;
use recon::object_dynamics::{ChannelNoise, ContactNoise};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon::observer::faults::Constant;
use recon::observer::planar::*;
use recon::observer::reliability::{Reason, Reliability};
use recon_tests::few_or_all;

const CONTACT: f64 = 1e-4;
const FORCE: f64 = 0.004;

/// A second of S2 at 500 Hz with noise, changed sample by sample.
fn log(change: impl Fn(usize, &mut PlanarSample)) -> PlanarLog {
    drawn(5, change)
}

/// The same with other noise.
fn drawn(seed: u64, change: impl Fn(usize, &mut PlanarSample)) -> PlanarLog {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(500.0, 1.0), 1e-13).unwrap();
    let noisy = PlanarNoise { contact: CONTACT, force: FORCE, torque: 0.0 }.add_to(&run.log().unwrap(), seed);
    let mut samples = noisy.samples().to_vec();
    samples.iter_mut().enumerate().for_each(|(k, sample)| change(k, sample));
    PlanarLog::new(samples, noisy.truth().map(<[_]>::to_vec)).unwrap()
}

fn estimate(log: &PlanarLog, mass: f64, inertia: f64) -> PlaneEstimate {
    let (object, ..) = scene("S2_rotating_pair");
    let known = PlanarMass::new(object.mass.mass() * mass, object.mass.inertia() * inertia).unwrap();
    let told = options(noise_level(CONTACT, FORCE, 0.04), object.gravity, Some(known));
    estimate_plane(&log.contact_log([0.0; 2]).unwrap(), &told).unwrap()
}

#[test]
fn wrong_constants_are_noticed() {
    let good = estimate(&log(|_, _| {}), 1.0, 1.0);
    assert!(good.reliability.is_reliable(), "{:?}", good.reliability);
    let reasons = |made: PlaneEstimate| match made.reliability {
        Reliability::Unreliable(reasons) => reasons,
        Reliability::Reliable => Vec::new(),
    };
    // How many times the stated mass is that of the log.
    let named = reasons(estimate(&log(|_, _| {}), 1.02, 1.02));
    let mass =
        named.iter().find_map(|of| if let Reason::OtherBody { mass, .. } = of { Some(*mass) } else { None });
    assert!(mass.is_some_and(|mass| (mass * 1.02 - 1.0).abs() < 0.005), "{named:?}");
    let forces = |factors: [f64; 2], from: usize| {
        move |k: usize, sample: &mut PlanarSample| {
            if k >= from {
                sample.forces = sample.forces.map(|[a, b]| [a * factors[0], b * factors[1]]);
            }
        }
    };
    let bias = |_: usize, s: &mut PlanarSample| s.forces = s.forces.map(|[a, b]| [a + 0.04, b]);
    let wrong: [(&str, &dyn Fn() -> PlaneEstimate); 7] = [
        ("inertia 10 %", &|| estimate(&log(|_, _| {}), 1.0, 1.1)),
        ("a palm half a degree off", &|| {
            estimate(&log(|_, s| s.angles[1] += 0.5_f64.to_radians()), 1.0, 1.0)
        }),
        ("gain 2 %", &|| estimate(&log(forces([1.02, 1.0], 0)), 1.0, 1.0)),
        ("both gains 2 %", &|| estimate(&log(forces([1.02, 1.02], 0)), 1.0, 1.0)),
        ("bias of 2 % of the weight", &|| estimate(&log(bias), 1.0, 1.0)),
        ("gain 20 %", &|| estimate(&log(forces([1.2, 1.0], 0)), 1.0, 1.0)),
        ("gain 20 % from 0.6 s on", &|| estimate(&log(forces([1.2, 1.0], 300)), 1.0, 1.0)),
    ];
    for (name, made) in &wrong[..few_or_all(3, 7)] {
        let made = made();
        println!("{name}: {:?}", made.reliability);
        assert!(!made.reliability.is_reliable(), "{name}");
    }
}

/// Its score is standard normal where contacts are on time, and tells a delay to first order where they are not: of 2 and 4 ms, on a body whose natural time is 64.
#[test]
fn late_contacts_are_told_from_those_on_time() {
    let of = |seed: u64, late: usize| {
        let told = drawn(seed, |_, _| {});
        let (samples, truth) = (told.samples(), told.truth().unwrap());
        let late_ones = samples[late..].iter().zip(samples);
        let late_ones = late_ones.map(|(now, then)| PlanarSample { contacts: then.contacts, ..*now });
        let log = PlanarLog::new(late_ones.collect(), Some(truth[late..].to_vec())).unwrap();
        let made = estimate(&log, 1.0, 1.0);
        *made.suspects.iter().find(|suspect| suspect.fault == Constant::ContactDelay).unwrap()
    };
    let runs = few_or_all(4, 20);
    let scores: Vec<f64> = (0..runs).map(|seed| of(300 + seed, 0).score()).collect();
    let mean = scores.iter().map(|score| score * score).sum::<f64>() / runs as f64;
    // Chi-squared of four or of twenty is below or above that once in a thousand each.
    let (least, most) = few_or_all((0.023, 4.61), (0.29, 2.28));
    assert!((least..most).contains(&mean), "{scores:?}");
    for &(late, seed) in few_or_all(&[(1, 307)][..], &[(1, 307), (2, 308)]) {
        let (suspect, value) = (of(seed, late), late as f64 / 500.0);
        assert!((suspect.value - value).abs() < 0.2 * value + 4.0 * suspect.deviation, "{suspect}, {value}");
        assert!(suspect.score() > 4.75, "{suspect}, {value}: not noticed");
    }
}

/// A known body's moment of inertia is told with its value to the deviation that the moment of an unknown body has, which is another fit of the same log.
#[test]
fn a_wrong_moment_of_inertia_is_told_as_well_as_an_unknown_one() {
    let told = log(|_, _| {});
    let (object, ..) = scene("S2_rotating_pair");
    let free = options(noise_level(CONTACT, FORCE, 0.04), object.gravity, None);
    let free = estimate_plane(&told.contact_log([0.0; 2]).unwrap(), &free).unwrap();
    let of =
        |made: &PlaneEstimate, fault: Constant| *made.suspects.iter().find(|of| of.fault == fault).unwrap();
    let moment = Constant::Moment { axis: 2 };
    let known = of(&estimate(&told, 1.0, 1.0), moment);
    let unknown = free.inertia.1 / object.mass.inertia();
    assert!((known.deviation / unknown - 1.0).abs() < 0.1, "{known}, unknown {unknown}");
    // Stated too large by three deviations it is doubted, and by how much is told.
    let off = 3.0 * known.deviation;
    let wrong = of(&estimate(&told, 1.0, 1.0 + off), moment);
    let moved = known.value - wrong.value;
    assert!((moved / off - 1.0).abs() < 0.1, "{known}, {wrong}, {off}");
    assert!(wrong.tolerated > 0.0 && wrong.tolerated < known.deviation, "{wrong:?}");
    assert!(
        free.suspects.iter().all(|of| !of.fault.is_of_body()),
        "of a body that is not known there is nothing to suspect"
    );
}

/// An offset of one contact shifts the centre of mass along, and nothing contradicts it: the data cannot tell, and say so.
#[test]
fn a_contact_offset_is_hardly_observable() {
    let made = estimate(&log(|_, _| {}), 1.0, 1.0);
    let offsets = made.suspects.iter().filter(|s| s.fault.to_string().starts_with("offset"));
    for suspect in offsets.clone() {
        println!("{suspect}");
        assert!(suspect.deviation > 5.0 * CONTACT, "{suspect}");
    }
    assert_eq!(offsets.count(), 2);
}

/// At 100 Hz noise of the spin poses as information on it: this noise tells of an offset of half the size, at 4.8 deviations of it, and would
/// widen all rows by that.
#[test]
fn noise_tells_of_no_offset_as_large_as_the_body() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let force = 0.01 * object.mass.mass() * object.gravity;
    let run = simulate_prescribed(&object, &motion, start, &times(100.0, 1.0), 1e-13).unwrap();
    let log = PlanarNoise { contact: CONTACT, force, torque: 0.0 }.add_to(&run.log().unwrap(), 5510);
    let told = options(noise_level(CONTACT, force, 0.04), object.gravity, Some(object.mass));
    let made = estimate_plane(&log.contact_log([0.0; 2]).unwrap(), &told).unwrap();
    assert!(made.reliability.is_reliable(), "{:?}", made.reliability);
    assert!(made.relied_on.iter().all(|relied_on| *relied_on));
    let off = errors(&made, log.truth().unwrap());
    assert!(off.worst < 5.0, "{off:?}");
}

/// A gap of 50 ms, three quarters of a natural time, and a palm that is not felt for as long: what is relied on is right, and the motion goes on.
#[test]
fn gaps_and_lost_contacts_are_got_over() {
    let whole = log(|_, _| {});
    let gap = |k: usize| (250..275).contains(&k);
    let kept: Vec<usize> = (0..whole.samples().len()).filter(|&k| !gap(k)).collect();
    let samples = kept.iter().map(|&k| whole.samples()[k]).collect();
    let truth = kept.iter().map(|&k| whole.truth().unwrap()[k]).collect();
    let with_gap = PlanarLog::new(samples, Some(truth)).unwrap();
    let unfelt = log(|k, sample| {
        if gap(k) {
            sample.contacts[1] = None;
        }
    });
    for (name, log) in [("gap", with_gap), ("palm not felt", unfelt)] {
        let made = estimate(&log, 1.0, 1.0);
        let off = errors(&made, log.truth().unwrap());
        println!("{name}: {off:?} {:?}", made.reliability);
        assert!(off.worst < 5.0 || !made.reliability.is_reliable(), "{name}: {off:?}");
    }
}

/// A log in space of what moves in a plane, with noise across it too: that moves no centre of mass, and the plane's own place is known as well as is said.
#[test]
fn noise_across_the_plane_moves_nothing() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(250.0, 1.0), 1e-13).unwrap();
    let log = run.log().unwrap().contact_log([0.0; 2]).unwrap().in_space(&[Some(0.0); 2]).unwrap();
    let fixed = ChannelNoise { fixed: FORCE, share: 0.0 };
    let log = log
        .with_noise(&ContactNoise { contact: CONTACT, force: fixed, ..ContactNoise::default() }, 3)
        .unwrap();
    let (floor, size) = (3e-5 * (object.gravity * 0.04).sqrt(), 0.04);
    let noise =
        ContactNoiseLevel { contact: CONTACT, force_fixed: FORCE, force_share: 0.0, impulse: None, floor };
    let told =
        ContactOptions { planar: true, size: Some(size), ..ContactOptions::new(noise, object.gravity) };
    let found = estimate_contacts(&log, None, &told).unwrap();
    let across: Vec<f64> = found.states.iter().map(|state| state.p_WCm.y).collect();
    assert!(across.iter().all(|y| (y - across[0]).abs() < 1e-12), "{across:?}");
    // Of two contacts at each of 251 samples.
    let known = CONTACT / 502_f64.sqrt();
    let told = found.deviations[0][0].y;
    assert!(
        (told / known - 1.0).abs() < 0.15 && across[0].abs() < 4.0 * told,
        "{told} {known} {}",
        across[0]
    );
}

/// Noise that is left out is read off the log.
#[test]
fn noise_is_estimated() {
    let log = log(|_, _| {}).contact_log([0.0; 2]).unwrap();
    let noise = plane_noise(&log, &[Some(0.0); 2], 0.0).unwrap();
    println!("{noise:?}");
    assert!((noise.contact / CONTACT - 1.0).abs() < 0.1 && (noise.force_fixed / FORCE - 1.0).abs() < 0.2);
}
