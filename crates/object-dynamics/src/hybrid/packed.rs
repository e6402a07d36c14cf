//! The state as the integrator sees it: numbers without units, so that one tolerance means the same for all of them.

use crate::BodyState;
use crate::contacts::{MOST_PALMS, PalmCoordinates, SceneState};
use glam::{DQuat, DVec3};

/// Body, works and impulses.
pub(super) const RIGID: usize = 15 + 3 * MOST_PALMS;
/// The same with coordinates of palms that give way.
pub(super) const YIELDING: usize = RIGID + 6 * MOST_PALMS;

/// What is integrated beside the motion.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Tallies {
    pub(super) friction_work: f64,
    pub(super) palm_work: f64,
    pub(super) impulses: [DVec3; MOST_PALMS],
}

/// Natural units of a scene (`contacts.md`): length, speed, rate, work and impulse.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) length: f64,
    pub(super) speed: f64,
    pub(super) rate: f64,
    pub(super) work: f64,
    pub(super) impulse: f64,
}

impl Units {
    /// From a body's size (m), mass (kg) and gravity (m/s^2); without gravity a second is the unit of time.
    pub(super) fn new(size: f64, mass: f64, gravity: f64) -> Self {
        let rate = if gravity > 0.0 { (gravity / size).sqrt() } else { 1.0 };
        let speed = rate * size;
        Self { length: size, speed, rate, work: mass * speed * speed, impulse: mass * speed }
    }

    pub(super) fn pack<const N: usize>(&self, state: &SceneState, tallies: &Tallies) -> [f64; N] {
        let mut y = [0.0; N];
        let body = &state.body;
        put(&mut y, 0, body.p_WCm / self.length);
        y[3..7].copy_from_slice(&[body.R_WO.w, body.R_WO.x, body.R_WO.y, body.R_WO.z]);
        put(&mut y, 7, body.v_WCm / self.speed);
        put(&mut y, 10, body.w_WO / self.rate);
        y[13] = tallies.friction_work / self.work;
        y[14] = tallies.palm_work / self.work;
        for (i, impulse) in tallies.impulses.iter().enumerate() {
            put(&mut y, 15 + 3 * i, *impulse / self.impulse);
        }
        if N == YIELDING {
            for (i, palm) in state.palms.iter().enumerate() {
                put(&mut y, RIGID + 6 * i, palm.position / self.length);
                put(&mut y, RIGID + 6 * i + 3, palm.velocity / self.speed);
            }
        }
        y
    }

    /// A number for each component: `share` for velocities, one for all else.
    pub(super) fn velocities<const N: usize>(&self, share: f64) -> [f64; N] {
        let palms = |k: usize| k >= RIGID && (k - RIGID) % 6 >= 3;
        std::array::from_fn(|k| if (7..13).contains(&k) || palms(k) { share } else { 1.0 })
    }

    pub(super) fn unpack<const N: usize>(&self, t: f64, y: &[f64; N]) -> (SceneState, Tallies) {
        let body = BodyState {
            p_WCm: get(y, 0) * self.length,
            R_WO: DQuat::from_xyzw(y[4], y[5], y[6], y[3]).normalize(),
            v_WCm: get(y, 7) * self.speed,
            w_WO: get(y, 10) * self.rate,
        };
        let mut palms = [PalmCoordinates::default(); MOST_PALMS];
        if N == YIELDING {
            for (i, palm) in palms.iter_mut().enumerate() {
                palm.position = get(y, RIGID + 6 * i) * self.length;
                palm.velocity = get(y, RIGID + 6 * i + 3) * self.speed;
            }
        }
        let tallies = Tallies {
            friction_work: y[13] * self.work,
            palm_work: y[14] * self.work,
            impulses: std::array::from_fn(|i| get(y, 15 + 3 * i) * self.impulse),
        };
        (SceneState { t, body, palms }, tallies)
    }
}

fn put(y: &mut [f64], at: usize, v: DVec3) {
    y[at..at + 3].copy_from_slice(&v.to_array());
}

fn get(y: &[f64], at: usize) -> DVec3 {
    DVec3::new(y[at], y[at + 1], y[at + 2])
}
