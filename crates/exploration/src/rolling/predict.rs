//! What a motion of the palms is expected to bring, over all bodies drawn.

use super::balance::{Balance, FALL, settle_roughly};
use super::belief::Belief;
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
    /// Orientations; none of a body that was lost.
    pub(super) phis: Vec<Option<f64>>,
    thetas: Vec<Vec<f64>>,
    falls: usize,
    moving: f64,
    radians: f64,
}

impl Course {
    /// Before any motion.
    pub(super) fn start(belief: &Belief, track: &Track) -> Self {
        let phis = belief.phis.iter().map(|phi| Some(*phi)).collect();
        let thetas = vec![Vec::new(); belief.bodies.len()];
        Self { palms: track.palms, phis, thetas, falls: 0, moving: 0.0, radians: 0.0 }
    }

    /// After another straight motion.
    pub(super) fn then(&self, belief: &Belief, workspace: &Workspace, to: [f64; 2]) -> Self {
        let mut next = self.clone();
        for (k, body) in belief.bodies.iter().enumerate() {
            for palms in along(self.palms, to, PREDICTED) {
                let Some(phi) = next.phis[k] else { break };
                let rest = pair(palms).and_then(|pair| Some((settle_roughly(body, &pair, phi)?, pair)));
                next.phis[k] = None;
                if let Some((rest, pair)) = rest {
                    let balance = Balance::at(body, &pair, rest.phi);
                    if balance.s.iter().all(|s| *s <= workspace.length) {
                        next.phis[k] = Some(rest.phi);
                        next.thetas[k].extend(balance.thetas);
                        next.falls += usize::from(rest.turned > FALL);
                    }
                }
            }
        }
        next.palms = to;
        next.moving += workspace.seconds(self.palms, to);
        next.radians += radians(self.palms, to);
        next
    }

    /// What it brings.
    pub(super) fn prediction(&self, belief: &Belief, workspace: &Workspace) -> Prediction {
        let count = belief.bodies.len().max(1) as f64;
        let of = |(body, thetas): (_, &Vec<f64>)| removed(&belief.cells, belief.spacing, body, thetas);
        let gain = belief.bodies.iter().zip(&self.thetas).map(of).sum::<f64>() / count;
        let lost = self.phis.iter().filter(|phi| phi.is_none()).count() as f64 / count;
        let falls = self.falls as f64 / count;
        let seconds = self.moving + falls * workspace.settle;
        Prediction { gain, lost, falls, seconds, radians: self.radians }
    }
}
