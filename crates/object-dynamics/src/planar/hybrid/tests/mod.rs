//! Scenes of the tests, and what every run must keep.

mod bad_input;
mod discs;
mod ladder;
mod many;
mod moving;

use super::*;
use crate::planar::{ContactScene, PlanarMass, PlanarMode, PlanarObject, ScenePalm};
use contact_kinematics::planar::{PalmSurface, RadiusFunction, SurfaceMotion, SurfacePose};
use glam::DVec2;

const G: f64 = 9.81;
const MASS: f64 = 0.3;

fn immobile(surface: PalmSurface, p: DVec2, angle: f64, friction: f64) -> ScenePalm {
    ScenePalm { surface, motion: SurfaceMotion::immobile(SurfacePose::new(p, angle).unwrap()), friction }
}

fn line(p: DVec2, angle: f64, friction: f64) -> ScenePalm {
    immobile(PalmSurface::Line, p, angle, friction)
}

fn scene<S: RadiusFunction>(shape: S, inertia: f64, palms: Vec<ScenePalm>) -> ContactScene<S> {
    let mass = PlanarMass::new(MASS, inertia).unwrap();
    ContactScene::new(PlanarObject { shape, mass, gravity: G }, palms).unwrap()
}

fn times(end: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|k| end * f64::from(k) / f64::from(count)).collect()
}

fn at(x: f64, y: f64) -> BodyState {
    BodyState { p_WCm: DVec2::new(x, y), ..BodyState::default() }
}

/// What a run promises at every sample: no gap or cone violated beyond 1e-9 (of the size 0.05 m, of the weight or the largest
/// force), friction against the slip, no creep, and energy but for the works.
fn check_run<S: RadiusFunction>(scene: &ContactScene<S>, run: &ContactRun) {
    for s in &run.samples {
        let force = s.contacts.iter().map(|c| c.force.length()).fold(MASS * G, f64::max);
        for (contact, palm) in s.contacts.iter().zip(scene.palms()) {
            assert!(contact.gap > -1e-9 * 0.05, "gap {:e} at {}", contact.gap, s.t);
            let Some(p_WC) = contact.p_WC else {
                assert_eq!(contact.force, DVec2::ZERO);
                continue;
            };
            assert!(contact.gap.abs() < 1e-9 * 0.05, "gap {:e} at {}", contact.gap, s.t);
            let to_palm = contact.palm.to_palm(p_WC);
            let n = match palm.surface {
                PalmSurface::Line => DVec2::from_angle(contact.palm.angle).perp(),
                PalmSurface::Arc { .. } => DVec2::from_angle(contact.palm.angle).rotate(to_palm.normalize()),
                PalmSurface::Cup { .. } => -DVec2::from_angle(contact.palm.angle).rotate(to_palm.normalize()),
            };
            let (normal, along) = (n.dot(contact.force), -n.perp().dot(contact.force));
            assert!(normal > -1e-9 * force, "normal force {normal:e} at {}", s.t);
            assert!(
                along.abs() <= palm.friction * normal + 1e-9 * force,
                "cone at {}: {along} {normal}",
                s.t
            );
            match contact.mode {
                PlanarMode::Off => unreachable!("an open contact has no point"),
                PlanarMode::Stick => {
                    assert!(contact.slip.abs() < 1e-14, "creep {:e} at {}", contact.slip, s.t)
                }
                PlanarMode::Slide { .. } => {
                    assert!(along * contact.slip <= 1e-12, "friction pushes at {}", s.t)
                }
            }
        }
        // A share of 1e-11, the coarsest tolerance of these runs, of energies of 0.1 J.
        assert!(s.friction_work <= 1e-12 && s.blow_work <= 1e-12, "{s:?}");
    }
    assert!(run.energy_drift() < 1e-10, "energy drifts by {:e}", run.energy_drift());
}
