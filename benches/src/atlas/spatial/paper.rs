//! The paper's own integration of (35) to (37).

use super::super::judged::Ran;
use super::super::{Failure, Method, Way};
use super::scene::{Motion, Spec};
use glam::{DQuat, DVec3};
use recon::observer::three_palms::Track;
use recon::observer::three_palms::paper_method::{
    PaperMethod, PaperStart, PredictorCorrector, integrate_paper_system,
};
use recon_tests::Random;

/// Growth of an error of the start beyond which an open-loop integration is not to be believed: it leaves 1e-9 of data printed to 12 digits
/// at 1e-6.
const LARGEST_AMPLIFICATION: f64 = 1e6;
/// Largest mean defect of the acceleration constraint (24), natural accelerations, and largest gap of prediction and correction.
const LARGEST_DEFECT: f64 = 1e-2;
/// Share of a natural time's way at such an acceleration that counts as an error of the start. With 0.03 one of 1,884 runs was wrong in silence, seeds
/// 20000 to 20011.
const SHARE: f64 = 0.1;
/// What the centre of mass may be off by, in sizes.
const RIGHT: f64 = 1e-2;

pub(in super::super) const METHOD: Method = Method {
    name: "the paper's integration",
    about: "(35) to (37) by Adams' method from the exact start, contacts without noise but where noise is the way, without deviations of its own: \
            doubted where errors of the start grow beyond 1e6, where what is left of (24) is beyond a hundredth of gravity, or where stated errors of the \
            start or a tenth of what (24) leaves grow beyond what is right; right: centre of mass within a hundredth of the size",
    ways: {
        use Way::*;
        &[
            Parallel, Flat, Steep, Sphere, Revolution, Pole, Relative, Force, Slow, Start, Noise, Bias, Gain,
            Delay, Taxels, Outliers, Gap, Rate, Palm, Shaking, Long, Size,
        ]
    },
    seeds: 30,
    every: 1,
    run,
};

fn run(way: Way, strength: f64, seed: u64) -> Result<Ran, Failure> {
    let of = Spec::of(way, strength);
    let noise = if way == Way::Noise { of.noise } else { [0.0; 2] };
    let rate = if way == Way::Rate { of.rate } else { 50.0 };
    let lasts = if way == Way::Long { of.lasts } else { 5.0 };
    let motion = Motion::drawn(Spec { noise, rate, lasts, ..of }, seed)?;
    let (log, _) = motion.log()?;
    let scene = &motion.scene.scene;
    let track = match Track::new(&log, scene.gravity(), None) {
        Ok(track) => track,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let now = &motion.simulation.instants[0];
    let mut random = Random::new(seed);
    let wrong = if way == Way::Start { strength } else { 0.0 };
    let mut off = |unit: f64| random.vector(-1.0, 1.0) * (wrong * unit);
    let radii = DVec3::from_array(now.touch.contacts.map(|c| c.jet.value)) + off(of.size);
    let start = PaperStart {
        radii: radii.to_array(),
        R_WO: DQuat::from_scaled_axis(off(1.0)) * now.R_WO,
        w_WO: now.w_WO + off(of.natural().recip()),
    };
    let method = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
    let found = match integrate_paper_system(&track, scene.mass(), &start, method) {
        Ok(found) => found,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let pairs = found.motion.iter().zip(log.samples());
    let errors = pairs.filter_map(|(m, s)| Some(m.p_WCm.distance(motion.at(s.t)?.touch.p_WCm)));
    let off = errors.fold(0.0, super::worse) / of.size / RIGHT;
    let grown = found.amplification();
    let defect = found.constraint_defect / scene.gravity().length();
    let expected = grown * wrong.max(SHARE * defect);
    let doubt = if let Some(t) = found.diverged_at {
        Some(format!("diverged at {t} s"))
    } else if grown.is_nan() || grown > LARGEST_AMPLIFICATION {
        Some(format!("errors of the start grow {grown:.0e}-fold"))
    } else if defect.is_nan() || defect > LARGEST_DEFECT {
        Some(format!("(24) is off by {defect:.0e} of gravity"))
    } else if expected > RIGHT {
        Some(format!("errors grow to {expected:.0e} of the size"))
    } else {
        None
    };
    Ok(Ran::Found { off, doubt })
}
