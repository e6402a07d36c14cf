//! An object that a finger pushes slowly over a table: its friction with the table as an ellipsoidal limit surface (Goyal, Ruina,
//! Papadopoulos 1991; in the form of Lynch, Maekawa, Tanie 1992), Coulomb friction at the finger.

use super::closed_line::ClosedLine;
use super::log::{Push, PushLogError, PushPose, PushSample};
use glam::DVec2;
use thiserror::Error;

/// Steps of the motion from sample to sample: the finger moves by less than a hundredth of a millimetre in each.
const STEPS: u32 = 4;
/// Gap that is none, m: far below the way of a step, far above rounding.
const TOUCHES: f64 = 1e-9;

/// What is pushed, and with what.
#[derive(Clone, Debug, PartialEq)]
pub struct PushScene {
    /// Outline about the centre of mass.
    pub outline: ClosedLine,
    /// Radius of the finger, m.
    pub finger_radius: f64,
    /// Coefficient of friction between finger and object.
    pub friction: f64,
    /// Largest torque of the table's friction over its largest force, m.
    pub length: f64,
    /// Largest force of the table's friction, N.
    pub sliding_force: f64,
    /// How far the finger's tip gives way to a force, m/N.
    pub compliance: f64,
}

/// How the finger moves: along a line at constant speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushStroke {
    /// Where its centre is at first, m, world.
    pub from: DVec2,
    /// m/s, world.
    pub velocity: DVec2,
    /// Samples.
    pub samples: u32,
    /// Samples a second.
    pub rate: f64,
    /// How long it moves on after the last sample, s.
    pub moves_on: f64,
}

/// What the contact does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum PushMode {
    /// Finger and object do not touch, or the object does not move yet.
    Rest,
    /// The finger keeps to one point of the object.
    Stick,
    /// The finger slides to the left, as it looks towards the object: counter-clockwise from the inward normal.
    Left,
    /// The finger slides to the right.
    Right,
}

/// The truth at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PushStep {
    /// What the contact does.
    pub mode: PushMode,
    /// Where the object is.
    pub pose: PushPose,
}

/// Values that make no scene.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PushSceneError {
    /// One that must be positive and finite is not.
    #[error("{what} is {value}; it must be finite and above zero")]
    NotPositive {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// One that must not be negative is.
    #[error("{what} is {value}; it must be finite and not negative")]
    Negative {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// What was simulated makes no log, such as no push at all.
    #[error("the pushes make no log: {0}")]
    Log(#[from] PushLogError),
}

impl PushScene {
    /// Checks the values.
    ///
    /// # Errors
    /// [`PushSceneError`] names the value.
    pub fn check(&self) -> Result<(), PushSceneError> {
        for (what, value) in [
            ("the finger's radius", self.finger_radius),
            ("the table's friction length", self.length),
            ("the table's friction", self.sliding_force),
        ] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(PushSceneError::NotPositive { what, value });
            }
        }
        for (what, value) in [("friction", self.friction), ("compliance", self.compliance)] {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(PushSceneError::Negative { what, value });
            }
        }
        Ok(())
    }
}

/// Velocity and angular velocity, to a common factor, of an object that is pushed by a force through the point `r` from its centre
/// of mass: normal to the limit surface.
#[must_use]
pub fn limit_twist(force: DVec2, r: DVec2, length: f64) -> (DVec2, f64) {
    (force, r.perp_dot(force) / length.powi(2))
}

/// What the finger does to the object in an instant.
struct Instant {
    mode: PushMode,
    /// Unit vector of the force, world.
    direction: DVec2,
    /// Of the object.
    velocity: DVec2,
    spin: f64,
}

/// Motion of the object where the finger, at `r` from the centre of mass, moves by `tip`: sticking if the cone allows that.
fn instant(scene: &PushScene, friction: f64, r: DVec2, inward: DVec2, tip: DVec2) -> Option<Instant> {
    let approach = inward.dot(tip);
    if approach <= 0.0 {
        return None;
    }
    let lever = r.perp();
    // What sticks moves as the finger: `(1 + w w' / c^2) f = v` with `w = z x r`, by Sherman and Morrison.
    let stuck = tip - lever * (lever.dot(tip) / (scene.length.powi(2) + r.length_squared()));
    let across = inward.perp();
    let (normal, tangential) = (stuck.dot(inward), stuck.dot(across));
    let (mode, push) = if normal > 0.0 && tangential.abs() <= friction * normal {
        (PushMode::Stick, stuck)
    } else {
        let side = tangential.signum();
        let edge = (inward + across * (side * friction)).normalize();
        let (v, w) = limit_twist(edge, r, scene.length);
        let moved = inward.dot(v + lever * w);
        if moved <= 0.0 {
            return None;
        }
        (if side > 0.0 { PushMode::Left } else { PushMode::Right }, edge * (approach / moved))
    };
    let (velocity, spin) = limit_twist(push, r, scene.length);
    Some(Instant { mode, direction: push.normalize_or_zero(), velocity, spin })
}

/// One push from a pose, without noise. `changes` gives at a time the factors of the coefficient of friction and of the table's friction.
///
/// # Errors
/// [`PushSceneError`] of the scene.
pub fn simulate_push(
    scene: &PushScene,
    number: u32,
    before: PushPose,
    stroke: &PushStroke,
    mut changes: impl FnMut(f64) -> [f64; 2],
) -> Result<(Push, Vec<PushStep>), PushSceneError> {
    scene.check()?;
    let (mut pose, mut commanded, mut tip) = (before, stroke.from, stroke.from);
    let (mut force, mut mode) = (DVec2::ZERO, PushMode::Rest);
    let (mut samples, mut steps) = (Vec::new(), Vec::new());
    let dt = 1.0 / (stroke.rate * f64::from(STEPS));
    let on = (stroke.moves_on * stroke.rate).round().max(0.0) as u32;
    for k in 0..stroke.samples + on {
        let t = f64::from(k) / stroke.rate;
        if k < stroke.samples {
            samples.push(PushSample { t, force, finger: commanded });
            steps.push(PushStep { mode, pose });
        }
        let factors = changes(t);
        for _ in 0..STEPS {
            commanded += stroke.velocity * dt;
            (force, mode) = advance(scene, factors, &mut pose, commanded, &mut tip, stroke.velocity);
        }
    }
    Ok((Push { number, before, after: pose, samples }, steps))
}

/// Moves the object by one small step of the finger.
fn advance(
    scene: &PushScene,
    [friction, resistance]: [f64; 2],
    pose: &mut PushPose,
    commanded: DVec2,
    tip: &mut DVec2,
    velocity: DVec2,
) -> (DVec2, PushMode) {
    let near = scene.outline.nearest(pose.to_object(*tip));
    if near.distance > scene.finger_radius + TOUCHES {
        *tip = commanded;
        return (DVec2::ZERO, PushMode::Rest);
    }
    let (r, inward) = (pose.turn(near.point), pose.turn(-near.normal));
    let Some(now) = instant(scene, scene.friction * friction, r, inward, velocity) else {
        *tip = commanded;
        return (DVec2::ZERO, PushMode::Rest);
    };
    // On the limit surface: `|f|^2 + (m / c)^2 = F^2`.
    let moment = r.perp_dot(now.direction) / scene.length;
    let size = scene.sliding_force * resistance / (1.0 + moment * moment).sqrt();
    let given = commanded.distance(*tip);
    if given < scene.compliance * size {
        // The finger bends until the object gives way.
        return (now.direction * (given / scene.compliance), PushMode::Rest);
    }
    let force = now.direction * size;
    let moved = commanded - force * scene.compliance - *tip;
    let share = moved.dot(velocity).max(0.0) / velocity.length_squared();
    *tip += moved;
    pose.p_WO += now.velocity * share;
    pose.theta += now.spin * share;
    // What first order leaves of a gap or an overlap is taken up along the normal.
    let near = scene.outline.nearest(pose.to_object(*tip));
    pose.p_WO += pose.turn(near.normal) * (near.distance - scene.finger_radius);
    (force, now.mode)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene(friction: f64) -> PushScene {
        let corners = [[-0.05, -0.05], [0.05, -0.05], [0.05, 0.05], [-0.05, 0.05]];
        PushScene {
            outline: ClosedLine::new(corners.map(DVec2::from).to_vec()).unwrap(),
            finger_radius: 0.002,
            friction,
            length: 0.04,
            sliding_force: 3.0,
            compliance: 1e-4,
        }
    }

    fn pushed(friction: f64, from: DVec2, velocity: DVec2) -> (Push, Vec<PushStep>) {
        let stroke = PushStroke { from, velocity, samples: 600, rate: 100.0, moves_on: 0.0 };
        simulate_push(&scene(friction), 0, PushPose::default(), &stroke, |_| [1.0; 2]).unwrap()
    }

    #[test]
    fn a_push_through_the_centre_does_not_turn() {
        let (push, _) = pushed(0.5, DVec2::new(-0.053, 0.0), DVec2::new(0.003, 0.0));
        // 18 mm of way, 1 mm of them to the face and 0.3 mm by which 3 N bend the finger.
        assert!(push.after.p_WO.distance(DVec2::new(0.0167, 0.0)) < 3e-5, "{:?}", push.after);
        assert!(push.after.theta.abs() < 1e-9);
        assert!((push.samples[599].force.x - 3.0).abs() < 1e-9);
    }

    #[test]
    fn a_contact_that_sticks_keeps_its_point_and_the_cone() {
        let (push, steps) = pushed(0.5, DVec2::new(-0.053, 0.01), DVec2::new(0.003, 0.0004));
        let stuck = steps.iter().position(|s| s.mode == PushMode::Stick).unwrap();
        let point = |k: usize| {
            let bend = push.samples[k].force * 1e-4;
            steps[k].pose.to_object(push.samples[k].finger - bend)
        };
        // The finger does not turn: it rolls on the face by its radius times the object's turn.
        let rolled = 0.002 * (steps[599].pose.theta - steps[stuck].pose.theta).abs();
        let moved = point(stuck).distance(point(599));
        assert!((moved - rolled).abs() < 3e-5, "{moved} {rolled}");
        for k in stuck..600 {
            let f = steps[k].pose.turn_back(push.samples[k].force);
            assert!(f.y.abs() <= 0.5 * f.x + 1e-3);
        }
    }

    #[test]
    fn sliding_is_on_the_edge_of_the_cone_and_goes_with_its_force() {
        let (push, steps) = pushed(0.2, DVec2::new(-0.053, 0.0), DVec2::new(0.002, 0.002));
        // Looking along x, y is to the left.
        assert!(steps[400].mode == PushMode::Left && steps[599].mode == PushMode::Left);
        let f = steps[400].pose.turn_back(push.samples[400].force);
        // The pose is that of the end of a step, whose turn is below 1e-4.
        assert!((f.y / f.x - 0.2).abs() < 2e-4, "{f}");
        let way = |k: usize| steps[k].pose.to_object(push.samples[k].finger).y;
        assert!(way(599) > way(400) + 1e-3);
    }

    #[test]
    fn a_scene_that_is_none_is_refused() {
        let wrong = PushScene { length: 0.0, ..scene(0.3) };
        let what = "the table's friction length";
        assert_eq!(wrong.check(), Err(PushSceneError::NotPositive { what, value: 0.0 }));
        let wrong = PushScene { friction: -0.1, ..scene(0.3) };
        assert_eq!(wrong.check(), Err(PushSceneError::Negative { what: "friction", value: -0.1 }));
    }
}
