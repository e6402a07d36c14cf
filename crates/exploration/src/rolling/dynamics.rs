//! What a body does between palms that do not wait for it: the equations of motion, with Coulomb friction.

use super::drawn::DrawnBody;
use super::workspace::{Workspace, pair};
use contact_kinematics::MotionLaw;
use contact_kinematics::planar::{
    MotionPart, PairRates, PalmPairState, PalmSurface, RadiusFunction, SurfaceMotion, SurfacePose,
};
use glam::DVec2;
use object_dynamics::ContactMode;
use object_dynamics::planar::{
    ContactInstant, ContactScene, ContactSceneError, PlanarMass, PlanarObject, ScenePalm,
};
use std::f64::consts::PI;

/// Mass and motion of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dynamics {
    /// Mass and moment of inertia.
    pub mass: PlanarMass,
    /// m/s^2, downwards.
    pub gravity: f64,
    /// Angular velocity of the body now, rad/s.
    pub omega: f64,
    /// Coefficient of friction of both palms, by which motions are predicted.
    pub friction: f64,
}

/// The fastest that a turn from rest to rest is, over its mean speed: the polynomial of degree 7.
const PEAK: f64 = 35.0 / 16.0;

/// Duration in s of a turn of the palms from rest to rest that is nowhere faster than they can be.
pub(super) fn lasts(workspace: &Workspace, from: [f64; 2], to: [f64; 2]) -> f64 {
    PEAK * workspace.seconds(from, to)
}

/// Two lines through the origin, the object above the first and, as it is turned, above the second; both turn from absolute angles `from` (rad)
/// to `to` within `duration` from `start` on (s).
pub(super) fn scene<S: RadiusFunction>(
    object: PlanarObject<S>,
    friction: f64,
    [from, to]: [[f64; 2]; 2],
    [start, duration]: [f64; 2],
) -> Result<ContactScene<S>, ContactSceneError> {
    let palm = |i: usize| {
        let law = MotionLaw::Ramp { height: to[i] - from[i], start, duration };
        let angle = from[i] - if i == 0 { 0.0 } else { PI };
        let motion = SurfaceMotion {
            pose: SurfacePose { p_WP: DVec2::ZERO, angle },
            parts: vec![MotionPart::Turn { pivot: DVec2::ZERO, law }],
        };
        ScenePalm { surface: PalmSurface::Line, motion, friction }
    };
    ContactScene::new(object, vec![palm(0), palm(1)])
}

/// The first contact that is not on its palm of `length` m: palm from 1, and distance from the hinge in m, negative behind it.
pub(super) fn off(instants: &[ContactInstant], length: f64) -> Option<(usize, f64)> {
    let one = |at: &ContactInstant, i: usize| {
        let along = DVec2::from_angle(at.palms[i].angle) * if i == 0 { 1.0 } else { -1.0 };
        let s = at.contacts[i].p_WC.dot(along);
        (at.modes[i] != ContactMode::Off && !(0.0..=length).contains(&s)).then_some((i + 1, s))
    };
    instants.iter().find_map(|at| (0..2).find_map(|i| one(at, i)))
}

/// Orientation in rad and angular velocity in rad/s.
pub(super) type Swing = (f64, f64);

/// Steps of the prediction in a natural time.
const STEPS: f64 = 12.0;
/// Every so many of them the contacts are felt.
const FELT: usize = 2;
/// Speed below which a contact that friction holds creeps, over what friction alone takes off in a step: faster than that steps would not be stable.
const CREEP: f64 = 1.0;

impl Dynamics {
    /// Where a body drawn is after a turn of the palms and the wait, and the directions (rad) that are felt of it; none if it is lost, or jams.
    ///
    /// By the equations of motion of a body that is held by two palms, one degree of freedom, in classical Runge-Kutta steps: where a palm would have to
    /// pull nothing is felt on it, and the short flight there is left out. Where friction holds a contact it creeps.
    pub(super) fn swung(
        &self,
        body: &DrawnBody,
        start: Swing,
        [from, to]: [[f64; 2]; 2],
        workspace: &Workspace,
    ) -> Option<(Swing, Vec<f64>)> {
        let object = PlanarObject { shape: body, mass: self.mass, gravity: self.gravity };
        let duration = lasts(workspace, from, to).max(1e-3);
        let ramp = |i: usize| MotionLaw::Ramp { height: to[i] - from[i], start: 0.0, duration };
        let laws = [ramp(0), ramp(1)];
        let palms = |t: f64| {
            let [a, b] = laws.map(|law| law.at(t));
            let pair = pair([from[0] + a[0], from[1] + b[0]])?;
            let motion = PairRates { rates: [a[1], b[1]], accelerations: [a[2], b[2]] };
            Some(PalmPairState { pair, motion })
        };
        let end = duration + workspace.settle;
        let natural = (0.5 * workspace.size / self.gravity).sqrt();
        let parts = (end * STEPS / natural).ceil().max(1.0) as usize;
        let h = end / parts as f64;
        let rubbing = [self.friction, CREEP * self.friction * self.gravity * h];
        let reaction = |at: &PalmPairState, y: DVec2| match self.friction > 0.0 {
            true => object.rubbing_reaction(at, y.x, y.y, rubbing),
            false => Some(object.reaction(at, y.x, y.y)),
        };
        let rate = |at: &PalmPairState, y: DVec2| Some(DVec2::new(y.y, reaction(at, y)?.alpha0));
        let (mut y, mut thetas) = (DVec2::new(start.0, start.1), Vec::new());
        for k in 0..parts {
            let t = k as f64 * h;
            let [begin, middle, end] = [palms(t)?, palms(t + 0.5 * h)?, palms(t + h)?];
            let now = reaction(&begin, y)?;
            if now.contact.s.iter().any(|s| !(0.0..=workspace.length).contains(s)) {
                return None;
            }
            if k % FELT == 0 {
                let felt = begin.pair.contact_directions(y.x);
                thetas.extend((0..2).filter(|i| now.forces[*i] > 0.0).map(|i| felt[i]));
            }
            let k1 = DVec2::new(y.y, now.alpha0);
            let k2 = rate(&middle, y + k1 * (0.5 * h))?;
            let k3 = rate(&middle, y + k2 * (0.5 * h))?;
            let k4 = rate(&end, y + k3 * h)?;
            y += (k1 + 2.0 * (k2 + k3) + k4) * (h / 6.0);
        }
        y.is_finite().then_some(((y.x, y.y), thetas))
    }
}
