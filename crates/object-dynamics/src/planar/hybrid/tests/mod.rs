//! Scenes of the tests, and what every run must keep.

mod bad_input;
mod discs;
mod hinged;
mod ladder;
mod many;
mod moving;

use super::*;
use crate::ContactMode;
use crate::planar::{ContactScene, PlanarMass, PlanarObject, ScenePalm};
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
/// force), friction against the slip, no creep, and energy but for the works to 1e-10.
fn check_run<S: RadiusFunction>(scene: &ContactScene<S>, run: &ContactSimulation) {
    for s in &run.instants {
        let force = s.forces.iter().map(|f| f.length()).fold(MASS * G, f64::max);
        for (i, palm) in scene.palms().iter().enumerate() {
            let contact = &s.contacts[i];
            assert!(contact.gap > -1e-9 * 0.05, "gap {:e} at {}", contact.gap, s.t);
            if s.modes[i] == ContactMode::Off {
                assert_eq!(s.forces[i], DVec2::ZERO);
                continue;
            }
            assert!(contact.gap.abs() < 1e-9 * 0.05, "gap {:e} at {}", contact.gap, s.t);
            // The palm's own normal where the contact is.
            let to_palm = s.palms[i].to_palm(contact.p_WC);
            let own = match palm.surface {
                PalmSurface::Line => DVec2::Y,
                PalmSurface::Arc { .. } => to_palm.normalize(),
                PalmSurface::Cup { .. } => -to_palm.normalize(),
            };
            let n = DVec2::from_angle(s.palms[i].angle).rotate(own);
            let (normal, along) = (n.dot(s.forces[i]), -n.perp().dot(s.forces[i]));
            let slip = -n.perp().dot(s.slip(i));
            assert!(normal > -1e-9 * force, "normal force {normal:e} at {}", s.t);
            assert!(
                along.abs() <= palm.friction * normal + 1e-9 * force,
                "cone at {}: {along} {normal}",
                s.t
            );
            if s.modes[i] == ContactMode::Stick {
                assert!(slip.abs() < 1e-14, "creep {slip:e} at {}", s.t);
            } else {
                assert!(along * slip <= 1e-12, "friction pushes at {}", s.t);
            }
        }
        // A share of 1e-11, the coarsest tolerance of these runs, of energies of 0.1 J.
        assert!(s.friction_work <= 1e-12 && s.blow_work <= 1e-12, "{s:?}");
    }
    check_balances(scene, run);
}

/// Energy against works, and momentum against impulses.
fn check_balances<S: RadiusFunction>(scene: &ContactScene<S>, run: &ContactSimulation) {
    let energies = run.instants.iter().map(|s| scene.energy(&s.body));
    let largest = energies.fold(f64::MIN_POSITIVE, |m, e| m.max(e.abs()));
    let balance = |s: &ContactInstant| scene.energy(&s.body) - s.palm_work - s.friction_work - s.blow_work;
    let momentum = |s: &ContactInstant| {
        s.body.v_WCm * MASS - s.impulses.iter().sum::<DVec2>() + DVec2::new(0.0, MASS * G * s.t)
    };
    let first = &run.instants[0];
    for s in &run.instants {
        let drift = (balance(s) - balance(first)) / largest;
        assert!(drift.abs() < 1e-10, "energy drifts by {drift:e} at {}", s.t);
        let off = (momentum(s) - momentum(first)).length() / (MASS * (1.0 + G * s.t));
        assert!(off < 1e-10, "momentum is {off:e} off at {}", s.t);
    }
}
