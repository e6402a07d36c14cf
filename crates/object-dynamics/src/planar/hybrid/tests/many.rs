//! Some hundred changes of modes, seeded: bodies thrown onto palms that move.

use super::*;
use crate::planar::ModeError;
use contact_kinematics::MotionLaw;
use contact_kinematics::planar::{FourierBody, MotionPart};

/// SplitMix64: numbers of the scenes, the same on every machine.
struct Draw(u64);

impl Draw {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * (z >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn swing(&mut self, amplitude: f64) -> MotionLaw {
        let phase = self.between(0.0, 6.0);
        MotionLaw::Sinusoid {
            mean: -amplitude * phase.sin(),
            amplitude,
            frequency: self.between(4.0, 12.0),
            phase,
        }
    }

    fn turning(&mut self, palm: ScenePalm, amplitude: f64) -> ScenePalm {
        let part = MotionPart::Turn { pivot: DVec2::ZERO, law: self.swing(amplitude) };
        let motion = SurfaceMotion { parts: vec![part], ..palm.motion };
        ScenePalm { motion, ..palm }
    }

    /// A body over a wedge of two lines, a cup, two fingertips and a floor, or in a box with two fingertips.
    fn scene(&mut self, kind: u64, largest_mu: f64) -> ContactScene<FourierBody> {
        let (a, b) = (self.between(-0.006, 0.006), self.between(-0.002, 0.002));
        let shape = FourierBody::new(&[0.05, 0.004, a, b], &[0.0, -0.003, 0.002, 0.0]).unwrap();
        let mut mu = || self.between(0.0, largest_mu);
        let palms = match kind {
            0 => {
                let (left, right) = (line(DVec2::ZERO, -0.6, mu()), line(DVec2::ZERO, 0.5, mu()));
                vec![self.turning(left, 0.15), self.turning(right, 0.15)]
            }
            1 => {
                let cup = immobile(PalmSurface::Cup { radius: 0.15 }, DVec2::new(0.0, 0.12), 0.0, mu());
                vec![self.turning(cup, 0.4)]
            }
            2 => {
                let tip = PalmSurface::Arc { radius: 0.015 };
                let tips = [-0.05, 0.05].map(|x| immobile(tip, DVec2::new(x, 0.0), 0.0, mu()));
                let floor = line(DVec2::new(0.0, -0.1), 0.0, mu());
                let [left, right] = tips.map(|tip| self.turning(tip, 0.2));
                vec![left, right, floor]
            }
            _ => {
                let tip = PalmSurface::Arc { radius: 0.02 };
                let floor = line(DVec2::new(0.0, 0.03), 0.1, mu());
                let walls =
                    [(-0.1, -1.2), (0.1, 1.3)].map(|(x, angle)| line(DVec2::new(x, 0.0), angle, mu()));
                let tips = [-0.03, 0.06].map(|x| immobile(tip, DVec2::new(x, 0.07), 0.0, mu()));
                let mut palms: Vec<_> = walls.into_iter().chain(tips).collect();
                for palm in &mut palms {
                    *palm = self.turning(palm.clone(), 0.1);
                }
                palms.push(floor);
                palms
            }
        };
        scene(shape, 0.4 * MASS * 0.05 * 0.05, palms)
    }
}

/// A body thrown into the scene of a seed.
fn thrown(seed: u64, largest_mu: f64) -> (ContactScene<FourierBody>, ContactStart) {
    let mut draw = Draw(seed);
    let scene = draw.scene(seed % 4, largest_mu);
    let state = BodyState {
        v_WCm: DVec2::new(draw.between(-0.3, 0.3), 0.0),
        omega0: draw.between(-10.0, 10.0),
        ..at(draw.between(-0.01, 0.01), if seed % 4 == 3 { 0.16 } else { 0.13 })
    };
    (scene, ContactStart { body: state, contacts: vec![] })
}

#[test]
fn hundreds_of_mode_changes_keep_gaps_cones_and_energy() {
    let (mut changes, mut blows) = (0, 0);
    for seed in 0..40 {
        let (scene, start) = thrown(seed, 0.6);
        let run = scene.simulate(&start, &times(1.0, 50), 1e-11).unwrap();
        changes += run.events.len();
        blows += run.events.iter().filter(|e| e.blow_work.is_some()).count();
        check_run(&scene, &run);
    }
    assert!(changes > 500 && blows > 250, "{changes} {blows}");
}

#[test]
fn what_rigid_bodies_do_not_decide_is_named_with_its_state() {
    let stop = |seed: u64, largest_mu: f64| {
        let (scene, start) = thrown(seed, largest_mu);
        match scene.simulate(&start, &times(1.0, 50), 1e-11) {
            Err(ContactSimulationError::Modes { t, body, source }) => (t, body.phi0, source),
            other => panic!("{other:?}"),
        }
    };
    // A rough wedge: the contact that sticks comes to the edge of its cone, and the body could as well leave the other palm.
    let (t, phi0, why) = stop(872, 0.6);
    assert!((t - 0.845).abs() < 1e-3 && (phi0 + 1.117).abs() < 1e-3);
    assert!(matches!(why, ModeError::Ambiguous { .. }), "{why}");
    // Jammed between a wall and a fingertip that close in on it.
    let (t, phi0, why) = stop(115, 0.6);
    assert!((t - 0.815).abs() < 1e-3 && (phi0 - 1.611).abs() < 1e-3);
    assert_eq!(why, ModeError::Inconsistent);
    // Sticking on one palm it slides on the other until no finite force does.
    let (t, _, why) = stop(100_056, 1.2);
    assert!((t - 0.332).abs() < 1e-3);
    assert!(matches!(why, ModeError::NotP { minor, .. } if minor < 1e-6), "{why}");
}
