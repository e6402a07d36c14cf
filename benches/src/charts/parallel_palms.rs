//! Failure sweep: two palms that turn towards each other.

use super::shared::{centre_error, doubt, estimate, exact_log, noisy_estimate, start_in_deviations, warning};
use super::{Chart, Drawn};
use crate::{Axis, Budget, Subject, Sweep};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::{InitialMotion, MassProperties, SensorNoise, ThreePalmScene};
use recon::observer::{PaperMethod, PaperStart, PredictorCorrector, Track, integrate_paper_system};

pub(super) const CHART: Chart =
    Chart { name: "sweep-parallel-palms", about: "palms towards parallel: right, reported or silent", draw };

const ANGLES: [f64; 10] = [120.0, 90.0, 60.0, 40.0, 25.0, 15.0, 8.0, 4.0, 2.0, 1.0];
const NOISE: SensorNoise = SensorNoise { contact: 2.5e-3, force: 0.065, torque: 0.0 };
/// Growth of an error of the start beyond which an open-loop integration is not to be believed: it leaves 1e-9 of data
/// printed to 12 digits at 1e-6.
const LARGEST_AMPLIFICATION: f64 = 1e6;

fn draw(_: Budget) -> Drawn {
    let mut exact = Subject::new("from contacts, no guess");
    let mut paper = Subject::new("(35)-(37), Adams, exact start");
    let mut noisy = Subject::new("from contacts, 0.1 % and 1 % noise");
    for degrees in ANGLES {
        let (scene, start) = match scene(degrees) {
            Ok(scene) => scene,
            Err(error) => {
                let reason = error.to_string();
                exact = exact.refused(degrees, reason.clone());
                paper = paper.refused(degrees, reason.clone());
                noisy = noisy.refused(degrees, reason);
                continue;
            }
        };
        let (simulation, log) = match exact_log(&scene, start, 2.0, 1000.0) {
            Ok(run) => run,
            Err(error) => {
                exact = exact.refused(degrees, error.to_string());
                continue;
            }
        };
        exact = match estimate(&scene, &log) {
            Ok(found) => {
                judged(exact, degrees, centre_error(&found, &simulation), warning(&found.reliability))
            }
            Err(error) => exact.refused(degrees, error),
        };
        let track = Track::new(&log, scene.gravity(), None)?;
        let now = &simulation.instants[0];
        let given =
            PaperStart { radii: now.touch.contacts.map(|c| c.jet.value), R_WO: now.R_WO, w_WO: now.w_WO };
        let method = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
        paper = match integrate_paper_system(&track, scene.mass(), &given, method) {
            Ok(found) => {
                let pairs = found.motion.iter().zip(&simulation.instants);
                let error = pairs.map(|(m, now)| m.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max);
                let grown = found.amplification();
                let unstable = grown.is_nan() || grown > LARGEST_AMPLIFICATION || found.diverged_at.is_some();
                judged(
                    paper,
                    degrees,
                    error,
                    unstable.then(|| format!("errors of the start grow {grown:.0e}-fold")),
                )
            }
            Err(error) => paper.refused(degrees, error.to_string()),
        };
        for seed in 0..5 {
            noisy = match noisy_estimate(&scene, &log.with_noise(&NOISE, seed)?, &NOISE) {
                Ok(found) => judged(noisy, degrees, start_in_deviations(&found, now), doubt(&found)),
                Err(error) => noisy.refused(degrees, error),
            };
        }
    }
    let angle = || Axis::log("angle between the azimuths of palms 2 and 3", "degrees");
    let clean = Sweep::new("sweep-parallel-palms", "Palms towards parallel, no noise", 1e-6)
        .subtitle(
            "ellipsoid 1, 2, 2.5 on palms of slope 60 degrees, at most 2 s in contact; right: within 1e-6 m",
        )
        .axes(angle(), Axis::log("largest error of the centre of mass", "m"))
        .subject(exact)
        .subject(paper);
    let with_noise = Sweep::new("sweep-parallel-palms-noise", "Palms towards parallel, with noise", 5.0)
        .subtitle("largest error of centre of mass, velocity and angular velocity at the start in its own deviations, 5 seeds; right: within 5")
        .axes(angle(), Axis::log("largest error", "reported deviations"))
        .subject(noisy);
    Ok(vec![clean.into(), with_noise.into()])
}

pub(super) fn judged(subject: Subject, parameter: f64, error: f64, warning: Option<String>) -> Subject {
    match warning {
        None => subject.estimate(parameter, error),
        Some(warning) => subject.warned(parameter, error, warning),
    }
}

fn scene(
    degrees: f64,
) -> Result<(ThreePalmScene<Ellipsoid>, InitialMotion), Box<dyn std::error::Error + Send + Sync>> {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mut palms = Vec::with_capacity(3);
    for azimuth in [0.0, 180.0 - 0.5 * degrees, 180.0 + 0.5 * degrees] {
        palms.push(Palm::fixed(f64::to_radians(azimuth), 60f64.to_radians())?);
    }
    let palms = [palms[0], palms[1], palms[2]];
    let mass = MassProperties::uniform_ellipsoid(1.0, axes)?;
    let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, palms, 9.81)?;
    Ok((scene, InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.0, 0.1, 0.1) }))
}
