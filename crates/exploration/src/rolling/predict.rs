//! What a motion of the palms is expected to bring, over all bodies drawn.

use super::balance::{Balance, FALL, settle_roughly};
use super::belief::Belief;
use super::drawn::DrawnBody;
use super::dynamics::{Swing, lasts};
use super::gain::removed;
use super::palms::PREDICTED;
use super::track::Track;
use super::workspace::{Workspace, along, pair, radians};

/// What a motion is expected to bring.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Area between the bounds that goes, in m^2: mean over the bodies drawn.
    pub gain: f64,
    /// Share of the bodies that leave a palm.
    pub lost: f64,
    /// Falls, mean over the bodies.
    pub falls: f64,
    /// Duration with the time after falls, in s.
    pub seconds: f64,
    /// Turns of both palms, in rad.
    pub radians: f64,
}

/// Where all bodies are after some motions, and what was felt of each.
#[derive(Clone, Debug)]
pub(super) struct Course {
    pub(super) palms: [f64; 2],
    /// Orientations and angular velocities; none of a body that was lost.
    pub(super) swings: Vec<Option<Swing>>,
    thetas: Vec<Vec<f64>>,
    falls: usize,
    moving: f64,
    radians: f64,
}

/// What became of one body: where it is unless it is lost, the directions (rad) that were felt of it, and its falls.
type Became = (Option<Swing>, Vec<f64>, usize);

impl Course {
    /// Before any motion.
    pub(super) fn start(belief: &Belief, track: &Track) -> Self {
        let swings = belief.swings.iter().map(|swing| Some(*swing)).collect();
        let thetas = vec![Vec::new(); belief.bodies.len()];
        Self { palms: track.palms, swings, thetas, falls: 0, moving: 0.0, radians: 0.0 }
    }

    /// After another straight motion.
    pub(super) fn then(&self, belief: &Belief, workspace: &Workspace, to: [f64; 2]) -> Self {
        let mut next = self.clone();
        for (k, body) in belief.bodies.iter().enumerate() {
            let Some(swing) = next.swings[k] else { continue };
            let (swing, thetas, falls) = match belief.dynamics {
                Some(dynamics) => match dynamics.swung(body, swing, [self.palms, to], workspace) {
                    Some((swing, thetas)) => (Some(swing), thetas, 0),
                    None => (None, Vec::new(), 0),
                },
                None => rested(body, swing.0, [self.palms, to], workspace),
            };
            next.swings[k] = swing;
            next.thetas[k].extend(thetas);
            next.falls += falls;
        }
        next.palms = to;
        next.moving += match belief.dynamics {
            Some(_) => lasts(workspace, self.palms, to) + workspace.settle,
            None => workspace.seconds(self.palms, to),
        };
        next.radians += radians(self.palms, to);
        next
    }

    /// What it brings.
    pub(super) fn prediction(&self, belief: &Belief, workspace: &Workspace) -> Prediction {
        let count = belief.bodies.len().max(1) as f64;
        let of = |(body, thetas): (_, &Vec<f64>)| removed(&belief.cells, belief.spacing, body, thetas);
        let gain = belief.bodies.iter().zip(&self.thetas).map(of).sum::<f64>() / count;
        let lost = self.swings.iter().filter(|swing| swing.is_none()).count() as f64 / count;
        let falls = self.falls as f64 / count;
        let seconds = self.moving + falls * workspace.settle;
        Prediction { gain, lost, falls, seconds, radians: self.radians }
    }
}

/// A body that follows its rests along a straight motion.
fn rested(body: &DrawnBody, mut phi: f64, [from, to]: [[f64; 2]; 2], workspace: &Workspace) -> Became {
    let (mut thetas, mut falls) = (Vec::new(), 0);
    for palms in along(from, to, PREDICTED) {
        let rest = pair(palms).and_then(|pair| Some((settle_roughly(body, &pair, phi)?, pair)));
        let Some((rest, pair)) = rest else { return (None, thetas, falls) };
        let balance = Balance::at(body, &pair, rest.phi);
        if balance.s.iter().any(|s| *s > workspace.length) {
            return (None, thetas, falls);
        }
        phi = rest.phi;
        thetas.extend(balance.thetas);
        falls += usize::from(rest.turned > FALL);
    }
    (Some((phi, 0.0)), thetas, falls)
}
