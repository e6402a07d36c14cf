//! Bounds on an outline from a motion that was estimated in the plane.

use super::plane::{PlanarBounds, noisy};
use crate::error::CliError;
use recon::exploration::rolling::noisy_curves;
use recon::object_dynamics::planar::ContactLog;
use recon::observer::planar::PlaneEstimate;
use serde_json::json;

/// Bounds that hold at `confidence` for the noise of the contacts (`contact_noise`, m) and for the errors of the poses, in the axes of the
/// body that are those of the world at the first sample. None where no sample is relied on.
///
/// A contact in body axes is off by the noise along the palm, which turns the normal of a curved one, and by the error of the pose:
/// its standard deviations, correlated in whatever way from sample to sample.
pub(super) fn motion_bounds(
    log: &ContactLog,
    estimate: &PlaneEstimate,
    contact_noise: f64,
    confidence: f64,
) -> Result<Option<PlanarBounds>, CliError> {
    let curves = noisy_curves(log, estimate, contact_noise);
    if curves.iter().all(Vec::is_empty) {
        return Ok(None);
    }
    let about = json!({ "confidence": confidence, "noise": "of the contacts and of the motion" });
    let mut made = noisy(&curves, confidence, about)?;
    made.points = curves.iter().flatten().map(|c| c.contact.point).collect();
    Ok(Some(made))
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::contact_kinematics::planar::{FourierBody, RadiusFunction};
    use recon::object_dynamics::planar::{
        ConstantRates, PlanarMass, PlanarNoise, PlanarObject, PlanarStart, simulate_prescribed,
    };
    use recon::observer::contacts::ContactNoiseLevel;
    use recon::observer::planar::{PlaneOptions, estimate_plane};

    #[test]
    fn bounds_hold_the_body_that_moved() {
        // Fig. 3's object, 4 cm, over one turn and a half.
        let shape = FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008]).unwrap();
        let mass = PlanarMass::from_gyration(0.2, 0.000_729).unwrap();
        let object = PlanarObject { shape, mass, gravity: 9.81 };
        let motion = ConstantRates { angles: [0.785, 1.571], rates: [0.2, 0.0] };
        let start = PlanarStart { phi0: 5.85, omega0: 6.0 };
        let times: Vec<f64> = (0..=350).map(|k| f64::from(k) * 4e-3).collect();
        let run = simulate_prescribed(&object, &motion, start, &times, 1e-12).unwrap();
        let force = 0.01 * 0.2 * 9.81;
        for seed in 0..6 {
            let noise = PlanarNoise { contact: 1e-4, force, torque: 0.0 };
            let log = noise.add_to(&run.log().unwrap(), seed).contact_log([0.0; 2]).unwrap();
            let noise = ContactNoiseLevel {
                contact: 1e-4,
                force_fixed: force,
                force_share: 0.0,
                impulse: None,
                floor: 2e-5,
            };
            let options = PlaneOptions {
                body: (seed % 2 == 0).then_some(mass),
                ..PlaneOptions::new(noise, 9.81, vec![Some(0.0); 2])
            };
            let estimate = estimate_plane(&log, &options).unwrap();
            let made = motion_bounds(&log, &estimate, 1e-4, 0.95).unwrap().unwrap();
            let [lower, upper] = &made.outlines;
            for k in 0..180 {
                let angle = f64::from(k).to_radians() * 2.0;
                let n = glam::DVec2::from_angle(angle);
                let support = |outline: &[glam::DVec2]| {
                    outline.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max)
                };
                // Axes of the body are those of the world at the first sample, where it has turned by phi0.
                let truth = object.shape.jet(angle - 5.85).r;
                assert!(support(lower) <= truth && truth <= support(upper), "seed {seed}, {k}");
            }
            assert!(made.areas[0] > 0.6 * made.areas[1], "seed {seed}: {:?}", made.areas);
        }
    }
}
