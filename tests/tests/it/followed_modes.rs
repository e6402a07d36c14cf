//! Contact modes in the stream: an excerpt of a log of MuJoCo followed from no guess, body and friction unknown.

use recon::contact_kinematics::PalmSurface;
use recon::object_dynamics::ContactMode;
use recon::observer::contacts::stream::{
    MotionStream, StreamEstimate, StreamOptions, StreamPalm, StreamStage,
};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions};
use recon_tests::contact_modes::{LoggedContacts, Sensed};
use recon_tests::few_or_all;
use std::sync::LazyLock;

/// Of contacts as a share of the mean semi-axis, of forces as a share of themselves.
const NOISE: [f64; 2] = [0.005, 0.02];
const AXES: [f64; 3] = [0.05, 0.04, 0.03];
const FRICTION: f64 = 0.3;
const RATE: f64 = 250.0;

/// With modes; what two tests look at.
static FIRST: LazyLock<Followed> = LazyLock::new(|| followed(true, 31, few_or_all(330, usize::MAX)));

type Followed = (Vec<Sensed>, Vec<StreamEstimate>);

fn followed(mode_odds: bool, seed: u64, most: usize) -> Followed {
    let path = format!("{}/data/followed_S2.csv", env!("CARGO_MANIFEST_DIR"));
    let log = LoggedContacts::parse(&std::fs::read_to_string(path).unwrap(), AXES);
    let length = AXES.iter().sum::<f64>() / 3.0;
    let [contact, force_share] = [NOISE[0] * length, NOISE[1]];
    let floor = 3e-5 * log.natural_speed();
    let noise = ContactNoiseLevel { contact, force_fixed: 0.0, force_share, impulse: None, floor };
    let contacts = ContactOptions { mode_odds, ..ContactOptions::new(noise, 9.81) };
    let palms = vec![StreamPalm { surface: PalmSurface::Plane, friction: None }; log.palms()];
    let mut stream = MotionStream::new(palms, StreamOptions { contacts, sample_rate: RATE }).unwrap();
    assert_eq!(stream.palms_with_modes(), if mode_odds { 3 } else { 0 });
    let mut samples = log.sensed(contact, force_share, seed);
    samples.truncate(most);
    let all = samples.iter().map(|sample| stream.push(sample.t, &sample.palms).unwrap()).collect();
    (samples, all)
}

#[test]
fn a_stream_tells_modes_and_friction_of_what_it_follows() {
    for &seed in few_or_all(&[31][..], &[31, 32, 33]) {
        let own = (seed != 31).then(|| followed(true, seed, usize::MAX));
        let (samples, all) = own.as_ref().unwrap_or_else(|| &*FIRST);
        let first = all.iter().position(|estimate| estimate.modes.is_some()).unwrap();
        assert_eq!(all[first].modes.is_some(), all[first].motion.is_some());
        assert!(all[..first].iter().all(|estimate| estimate.motion.is_none()), "modes come with a motion");
        assert!(all[first..].iter().all(|estimate| estimate.modes.is_some()));
        let (mut counts, mut right, mut decided, mut wrong) = ([0.0; 2], 0.0, 0.0, 0.0);
        for k in first.max(1)..samples.len() - 1 {
            let modes = all[k].modes.unwrap();
            // A sample nearer than 5 ms to a switch is one beside it.
            for i in (0..3).filter(|&i| (k - 1..=k + 1).all(|j| samples[j].truth[i] == samples[k].truth[i])) {
                let (of, slides) = (modes.odds[i], samples[k].truth[i] == ContactMode::Slide);
                assert!((of.off + of.slide + of.stick - 1.0).abs() < 1e-9 && of.off == 0.0, "{of:?}");
                counts[usize::from(slides)] += 1.0;
                let is = if slides { of.slide } else { of.stick };
                right += f64::from(is > 0.5);
                wrong += f64::from(is < 0.01);
                decided += f64::from(modes.decided[i] == samples[k].truth[i]);
            }
        }
        let count = counts[0] + counts[1];
        assert!(counts[0] > 100.0 && counts[1] > few_or_all(400.0, 500.0), "both modes count: {counts:?}");
        assert!(right > 0.97 * count && decided > 0.96 * count, "{seed}: {right} {decided} of {count}");
        assert!(wrong <= 0.002 * count, "{seed}: {wrong} of {count}");
        let last = all.last().unwrap();
        assert_eq!(last.stage, StreamStage::Tracking);
        let modes = last.modes.unwrap();
        for friction in &modes.frictions[..3] {
            // A step of the grid is 1.6 %.
            let of = friction.unwrap();
            assert!((of.coefficient - FRICTION).abs() < 0.016 * FRICTION, "{of:?}");
        }
        assert!(modes.doubts.iter().all(Option::is_none), "{:?}", modes.doubts);
        assert!(modes.decided[3..].iter().all(|mode| *mode == ContactMode::Off));
    }
}

/// Whoever asks for no modes gets the same motion and no modes.
#[test]
fn modes_change_nothing_of_the_motion() {
    let without = followed(false, 31, few_or_all(150, usize::MAX)).1;
    assert!(without.last().unwrap().motion.is_some());
    for (with, without) in FIRST.1.iter().zip(&without) {
        assert_eq!((with.motion, with.stage), (without.motion, without.stage));
        assert!(without.modes.is_none());
    }
}
