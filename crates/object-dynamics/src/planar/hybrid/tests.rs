//! Oracles: closed forms of discs, a quadrature, order of convergence, balance of energy.

use super::*;
use crate::planar::{ContactScene, PlanarMass, PlanarMode, PlanarObject, ScenePalm};
use contact_kinematics::planar::{Circle, Ellipse, PalmSurface, RadiusFunction, SurfaceMotion, SurfacePose};
use glam::DVec2;

const G: f64 = 9.81;

fn line(p: DVec2, angle: f64, friction: f64) -> ScenePalm {
    let motion = SurfaceMotion::immobile(SurfacePose::new(p, angle).unwrap());
    ScenePalm { surface: PalmSurface::Line, motion, friction }
}

fn scene<S: RadiusFunction>(shape: S, inertia: f64, palms: Vec<ScenePalm>) -> ContactScene<S> {
    let mass = PlanarMass::new(0.3, inertia).unwrap();
    ContactScene::new(PlanarObject { shape, mass, gravity: G }, palms).unwrap()
}

fn times(end: f64, count: u32) -> Vec<f64> {
    (0..=count).map(|k| end * f64::from(k) / f64::from(count)).collect()
}

/// A uniform disc of radius 0.05 m on a line at `slope`.
fn disc_on_incline(slope: f64, mu: f64) -> ContactScene<Circle> {
    let disc = Circle::new(0.05, DVec2::ZERO).unwrap();
    scene(disc, 0.5 * 0.3 * 0.05 * 0.05, vec![line(DVec2::ZERO, slope, mu)])
}

#[test]
fn a_disc_rolls_or_slides_down_an_incline_as_in_closed_form() {
    let slope: f64 = 0.4;
    for (mu, a) in [(0.5, 2.0 / 3.0 * G * slope.sin()), (0.1, G * (slope.sin() - 0.1 * slope.cos()))] {
        let scene = disc_on_incline(slope, mu);
        let guess = BodyState { p_WCm: DVec2::new(0.0, 0.06), ..BodyState::default() };
        let state = scene.place(0.0, guess, &[0]).unwrap();
        let run =
            scene.simulate(&ContactStart { state, contacts: vec![0] }, &times(10.0, 100), 1e-12).unwrap();
        assert_eq!(run.events.len(), 1);
        for s in &run.samples {
            let down = (state.p_WCm - s.state.p_WCm).dot(DVec2::from_angle(slope));
            let expected = 0.5 * a * s.t * s.t;
            assert!((down - expected).abs() < 1e-10 * (1.0 + expected), "{mu} {}: {down} {expected}", s.t);
            assert!(s.contacts[0].gap.abs() < 1e-13);
        }
        assert!(run.energy_drift() < 1e-12, "{:e}", run.energy_drift());
    }
}
