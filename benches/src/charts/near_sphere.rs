//! Failure sweep: a body that becomes a ball, whose orientation leaves no trace in the log.

use super::parallel_palms::judged;
use super::shared::{doubt, estimate, exact_log, noisy_estimate, start_in_deviations, warning};
use super::{Chart, Drawn};
use crate::{Axis, Budget, Subject, Sweep};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm};
use recon::object_dynamics::{InitialMotion, MassProperties, SensorNoise, ThreePalmScene};

pub(super) const CHART: Chart =
    Chart { name: "sweep-near-sphere", about: "object towards a sphere: right, reported or silent", draw };

/// Semi-axes 1, 1 + d, 1 + 2 d.
const DEPARTURES: [f64; 8] = [0.5, 0.2, 0.1, 0.05, 0.02, 1e-2, 1e-3, 1e-4];

fn draw(_: Budget) -> Drawn {
    let mut clean = Subject::new("from contacts, no noise");
    let mut noisy = Subject::new("from contacts, 0.1 % and 1 % noise");
    for d in DEPARTURES {
        let axes = DVec3::new(1.0, 1.0 + d, 1.0 + 2.0 * d);
        let palm = |azimuth: f64| Palm::fixed(azimuth.to_radians(), 60f64.to_radians());
        let palms = [palm(60.0)?, palm(180.0)?, palm(300.0)?];
        let mass = MassProperties::uniform_ellipsoid(1.0, axes)?;
        let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, palms, 9.81)?;
        let R_WO = DQuat::from_scaled_axis(DVec3::new(0.3, -0.2, 0.5));
        let start = InitialMotion { R_WO, w_WO: DVec3::new(0.2, 0.3, 0.5) };
        let (simulation, log) = exact_log(&scene, start, 3.0, 500.0)?;
        let now = &simulation.instants[0];
        clean = match estimate(&scene, &log) {
            Ok(found) => judged(clean, d, start_in_deviations(&found, now), warning(&found.reliability)),
            Err(error) => clean.refused(d, error),
        };
        let noise = SensorNoise { contact: 1e-3, force: 0.065, torque: 0.0 };
        for seed in 0..3 {
            noisy = match noisy_estimate(&scene, &log.with_noise(&noise, seed)?, &noise) {
                Ok(found) => judged(noisy, d, start_in_deviations(&found, now), doubt(&found)),
                Err(error) => noisy.refused(d, error),
            };
        }
    }
    let sweep = Sweep::new("sweep-near-sphere", "Object towards a sphere", 5.0)
        .subtitle("semi-axes 1, 1 + d, 1 + 2 d, 3 s at 500 Hz; largest error of the 12 unknowns (with noise of centre of mass, velocity and angular velocity) at the start in its own deviations; right: within 5")
        .axes(Axis::log("departure d from the sphere", "1"), Axis::log("largest error", "reported deviations"))
        .subject(clean)
        .subject(noisy);
    Ok(vec![sweep.into()])
}
