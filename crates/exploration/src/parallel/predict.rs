//! What a stroke is expected to bring, over all bodies drawn.

use super::belief::DrawnBody;
use super::hold::{Hold, Stop, Stroke, steps};
use super::planner::ParallelView;
use crate::space::SpaceKnowledge;
use contact_kinematics::Direction;
use glam::DVec2;

/// What a stroke is expected to bring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// By how much the goal's quantity goes down, in its unit: mean over the bodies drawn.
    pub gain: f64,
    /// Share of the bodies that friction holds all the way.
    pub held: f64,
    /// How far the upper palm moves, m: mean over the bodies.
    pub way: f64,
}

/// Where each body is after some strokes, and which normals were felt of it.
#[derive(Clone)]
pub(super) struct Course {
    pub(super) holds: Vec<Hold>,
    felt: Vec<Vec<Direction>>,
    held: usize,
    way: f64,
}

/// Contacts are predicted in steps of so many rad at least.
const PREDICTED: f64 = 0.1;

impl Course {
    /// Before any stroke.
    pub(super) fn start(bodies: &[DrawnBody], hold: &Hold) -> Self {
        let count = bodies.len();
        Self { holds: vec![*hold; count], felt: vec![Vec::new(); count], held: count, way: 0.0 }
    }

    /// After another one.
    pub(super) fn then(&self, view: &ParallelView<'_>, bodies: &[DrawnBody], stroke: Stroke) -> Self {
        let mut next = self.clone();
        next.held = 0;
        let along = DVec2::from_angle(stroke.heading);
        let (parts, turn) = steps(stroke.turn, PREDICTED.max(view.spacing));
        for (k, body) in bodies.iter().enumerate() {
            let mut through = true;
            for _ in 0..parts {
                let hold = next.holds[k];
                let walled = view.walls.iter().any(|wall| wall.stops(&hold, along));
                let stepped = || hold.stepped(body, view.workspace, along, turn);
                match if walled { Err(Stop::Shear) } else { stepped() } {
                    Ok((hold, way)) => {
                        next.holds[k] = hold;
                        next.way += way / bodies.len() as f64;
                        next.feel(view, k);
                    }
                    Err(Stop::Shear) => {
                        through = false;
                        break;
                    }
                    Err(Stop::Pad) => break,
                }
            }
            next.held += usize::from(through);
        }
        next
    }

    /// Takes those contacts of body `k` that would be taken of the true one.
    fn feel(&mut self, view: &ParallelView<'_>, k: usize) {
        for n in self.holds[k].normals() {
            if unfelt(view.known, n, view.spacing) && apart(self.felt[k].iter().copied(), n, view.spacing) {
                self.felt[k].push(n);
            }
        }
    }

    /// What it brings.
    pub(super) fn prediction(&self, view: &ParallelView<'_>, bodies: &[DrawnBody]) -> Prediction {
        let count = bodies.len().max(1) as f64;
        let gains = bodies.iter().zip(&self.felt).map(|(body, felt)| body.gain(felt, view.goal));
        Prediction { gain: gains.sum::<f64>() / count, held: self.held as f64 / count, way: self.way }
    }
}

/// Whether a contact of this normal would be taken: none that is known is nearer than `spacing` (rad).
pub(super) fn unfelt(known: &SpaceKnowledge, normal: Direction, spacing: f64) -> bool {
    apart(known.contacts().iter().map(|c| c.normal), normal, spacing)
}

/// Whether a normal is no nearer than `spacing` (rad) to any of some.
fn apart(all: impl IntoIterator<Item = Direction>, normal: Direction, spacing: f64) -> bool {
    // By the chord: cheaper than the angle, and as good.
    let chord = 2.0 * (0.5 * spacing).sin();
    all.into_iter().all(|n| (n.get() - normal.get()).length_squared() >= chord * chord)
}
