//! Scenes whose motion needs no more than orientation and angular velocity.

use super::simulation::{Least, Pose, least_tolerance};
use super::{Accuracy, Alternative, Choice, Decision, Evidence, Model, Question};
use contact_kinematics::planar::RadiusFunction;
use contact_kinematics::{Palm, PalmSurface, SupportFunction};
use glam::DVec3;
use object_dynamics::integrate::Tolerance;
use object_dynamics::{
    BodyState, ContactScene, ContactSimulationError, ContactStart, End, InitialMotion, PalmDrive,
    SampleTimes, ThreePalmScene,
};
use std::f64::consts::FRAC_PI_2;

/// Unit vectors along x, y, z and back: enough for the mean radius of a body to within what its shape leaves open.
const AXES: [DVec3; 3] = [DVec3::X, DVec3::Y, DVec3::Z];
/// A body that is off three planes, or moves against them along their normals, by more than this share of its size (or of its natural speed) at the
/// start does not touch them.
const TOUCHES: f64 = 1e-9;

/// A motion as near as was wanted.
#[derive(Clone, Debug)]
pub struct LeastMotion {
    /// States at the sample times.
    pub states: Vec<BodyState>,
    /// Tolerance of the integration.
    pub tolerance: f64,
    /// Why it was chosen.
    pub choice: Choice,
}

/// Natural size of a body: the mean of its half widths along three axes, m.
#[must_use]
pub fn body_size<S: SupportFunction>(body: &S) -> f64 {
    let half = |axis: DVec3| {
        let along = |n: DVec3| contact_kinematics::Direction::new(n).map_or(0.0, |n| body.value(n));
        0.5 * (along(axis) + along(-axis))
    };
    AXES.iter().map(|axis| half(*axis)).sum::<f64>() / 3.0
}

/// The same of an outline in the plane, m.
#[must_use]
pub fn outline_size<S: RadiusFunction>(outline: &S) -> f64 {
    (0..4).map(|quarter| outline.jet(f64::from(quarter) * FRAC_PI_2).r).sum::<f64>() / 4.0
}

/// The motion of a scene at the sample times, to within `wanted` of the natural size: in minimal coordinates where the palms are three planes
/// without friction that stand still and are touched throughout, else through contact modes; to the loosest tolerance whose
/// error estimate is below it.
///
/// # Errors
/// Those of the simulation through contact modes.
pub fn least_motion<S: SupportFunction + Clone>(
    scene: &ContactScene<S>,
    start: &ContactStart,
    times: SampleTimes,
    wanted: Accuracy,
) -> Result<LeastMotion, ContactSimulationError> {
    let size = body_size(scene.body());
    let refused = match minimal(scene, start).map(|of| of.run(times, wanted, size)) {
        Some(Ok(found)) => return Ok(found),
        refused => refused.and_then(Result::err),
    };
    let run = |tolerance: f64| scene.simulate(start, times, tolerance);
    let poses = |run: &object_dynamics::ContactSimulation| -> Vec<Pose> {
        run.instants.iter().map(|now| Pose::from(now.state.body)).collect()
    };
    let Least { run, tolerance, mut choice } = least_tolerance(wanted, size, run, poses)?;
    let seconds = choice.seconds;
    let other = Alternative {
        model: Model::MinimalCoordinates,
        chosen: false,
        seconds: refused,
        accuracy: None,
        evidence: if refused.is_some() { Evidence::Refused } else { Evidence::Impossible },
    };
    let modes = Alternative {
        model: Model::ContactModes,
        chosen: true,
        seconds: Some(seconds),
        accuracy: Some(choice.reached),
        evidence: Evidence::Run,
    };
    choice.seconds += refused.unwrap_or_default();
    choice.decisions.insert(0, Decision { question: Question::Integrator, alternatives: vec![other, modes] });
    Ok(LeastMotion { states: run.instants.iter().map(|now| now.state.body).collect(), tolerance, choice })
}

impl From<BodyState> for Pose {
    fn from(state: BodyState) -> Self {
        Self { p_WCm: state.p_WCm, R_WO: state.R_WO }
    }
}

/// A scene in minimal coordinates, whose palms pass through the origin of a frame that is only shifted.
struct Minimal<S> {
    scene: ThreePalmScene<S>,
    start: InitialMotion,
    /// Where the planes meet, m.
    apex: DVec3,
}

fn minimal<S: SupportFunction + Clone>(scene: &ContactScene<S>, start: &ContactStart) -> Option<Minimal<S>> {
    let palms = scene.palms();
    let still = |drive: &PalmDrive| matches!(drive, PalmDrive::Prescribed(motion) if motion.is_immobile());
    let simple = palms.len() == 3
        && !start.in_flight
        && palms
            .iter()
            .all(|palm| palm.surface == PalmSurface::Plane && palm.friction == 0.0 && still(&palm.drive));
    if !simple {
        return None;
    }
    let coordinates = scene.palms_at_start();
    let states = [0, 1, 2].map(|i| scene.palm_state(i, 0.0, &coordinates[i]));
    let normals = states.map(|state| state.R_WP.z_axis);
    let rows = glam::DMat3::from_cols(normals[0], normals[1], normals[2]).transpose();
    let offsets = DVec3::from_array([0, 1, 2].map(|i| normals[i].dot(states[i].p_WP)));
    let apex = rows.inverse() * offsets;
    let palm = |n: DVec3| Palm::fixed((-n.y).atan2(-n.x), n.x.hypot(n.y).atan2(n.z)).ok();
    let [Some(a), Some(b), Some(c)] = normals.map(palm) else { return None };
    let held =
        ThreePalmScene::new(scene.body().clone(), *scene.mass(), [a, b, c], -scene.gravity().z).ok()?;
    let BodyState { p_WCm, v_WCm, w_WO, R_WO } = start.body;
    let now = held.instant(0.0, R_WO.normalize(), w_WO).ok()?;
    let size = body_size(scene.body());
    let speed = (size * scene.gravity().length()).sqrt();
    let touches = (now.touch.p_WCm + apex).distance(p_WCm) < TOUCHES * size
        && now.rates.v_WCm.distance(v_WCm) < TOUCHES * speed;
    touches.then_some(Minimal { scene: held, start: InitialMotion { R_WO, w_WO }, apex })
}

impl<S: SupportFunction> Minimal<S> {
    /// The motion, or how long was tried in vain, s, where contact is lost.
    fn run(&self, times: SampleTimes, wanted: Accuracy, size: f64) -> Result<LeastMotion, f64> {
        let clock = std::time::Instant::now();
        let run = |tolerance: f64| {
            self.scene
                .simulate(self.start, times, Tolerance::uniform(tolerance))
                .map_err(|_| ())
                .and_then(|run| if run.end == End::Completed { Ok(run) } else { Err(()) })
        };
        let state = |now: &object_dynamics::Instant| BodyState {
            p_WCm: now.touch.p_WCm + self.apex,
            v_WCm: now.rates.v_WCm,
            w_WO: now.w_WO,
            R_WO: now.R_WO,
        };
        let poses = |run: &object_dynamics::Simulation| -> Vec<Pose> {
            run.instants.iter().map(|now| Pose::from(state(now))).collect()
        };
        let Ok(Least { run, tolerance, mut choice }) = least_tolerance(wanted, size, run, poses) else {
            return Err(clock.elapsed().as_secs_f64());
        };
        let minimal = Alternative {
            model: Model::MinimalCoordinates,
            chosen: true,
            seconds: Some(choice.seconds),
            accuracy: Some(choice.reached),
            evidence: Evidence::Run,
        };
        // Four times as dear at any tolerance (docs/contact-cost.md).
        let modes = Alternative {
            model: Model::ContactModes,
            chosen: false,
            seconds: Some(DEARER * choice.seconds),
            accuracy: Some(choice.reached),
            evidence: Evidence::Predicted,
        };
        choice
            .decisions
            .insert(0, Decision { question: Question::Integrator, alternatives: vec![minimal, modes] });
        Ok(LeastMotion { states: run.instants.iter().map(state).collect(), tolerance, choice })
    }
}

/// What a simulation through contact modes takes of three planes without friction, over one in minimal coordinates: 4.2 to 4.9 at tolerances of
/// 1e-3 to 1e-12 (docs/contact-cost.md).
const DEARER: f64 = 4.5;
