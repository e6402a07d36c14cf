//! The log of a simulated motion.

use super::record::{ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion, TrueContact};
use super::{ContactLog, ContactLogError, PalmHinge};
use crate::{ContactInstant, ContactMode, ContactScene, ContactSimulation, PalmDrive};
use contact_kinematics::{SupportFunction, SurfacePose};
use glam::DQuat;

impl ContactLog {
    /// What sensors without noise would have recorded of a simulated motion: contact points, three axes of force and impulse,
    /// pose and twist of every palm, the torque of motors, and the truth.
    ///
    /// # Errors
    /// [`ContactLogError`]; that of a simulation of two samples or more does not happen.
    pub fn from_simulation<S: SupportFunction>(
        scene: &ContactScene<S>,
        simulation: &ContactSimulation,
    ) -> Result<Self, ContactLogError> {
        let instants = &simulation.instants;
        let times = instants.iter().map(|now| now.state.t).collect();
        let truth = instants.iter().map(|now| now.state.body).collect();
        let palm = |i: usize| record(scene, instants, i);
        Self::new(times, (0..scene.palms().len()).map(palm).collect(), Some(truth))
    }
}

fn record<S: SupportFunction>(scene: &ContactScene<S>, instants: &[ContactInstant], i: usize) -> PalmRecord {
    let palm = &scene.palms()[i];
    let motion = match &palm.drive {
        PalmDrive::Prescribed(motion) if motion.is_immobile() => RecordedMotion::Fixed(pose(&instants[0], i)),
        _ => RecordedMotion::Measured(instants.iter().map(|now| moving(now, i)).collect()),
    };
    let motor = match &palm.drive {
        PalmDrive::Torque(motor) => Some(motor),
        PalmDrive::Prescribed(_) | PalmDrive::Spring(_) => None,
    };
    let touched = |now: &ContactInstant| (now.modes[i] != ContactMode::Off).then(|| now.contacts[i].p_WC);
    PalmRecord {
        surface: palm.surface,
        friction: Some(palm.friction),
        motion,
        contacts: ContactPoints::World(instants.iter().map(touched).collect()),
        force: ForceChannel::Three(instants.iter().map(|now| now.forces[i]).collect()),
        impulse: ForceChannel::Three(instants.iter().map(|now| now.impulses[i]).collect()),
        torque: motor.map(|motor| instants.iter().map(|now| Some(motor.torque.at(now.state.t)[0])).collect()),
        hinge: motor.map(PalmHinge::from),
        truth: Some(instants.iter().map(|now| true_contact(now, i)).collect()),
        largest_offset: f64::INFINITY,
    }
}

fn pose(now: &ContactInstant, i: usize) -> SurfacePose {
    let palm = &now.palms[i];
    SurfacePose { p_WP: palm.p_WP, R_WP: DQuat::from_mat3(&palm.R_WP).normalize() }
}

fn moving(now: &ContactInstant, i: usize) -> MeasuredMotion {
    MeasuredMotion { pose: pose(now, i), v_WP: now.palms[i].v_WP, w_WP: now.palms[i].w_WP }
}

fn true_contact(now: &ContactInstant, i: usize) -> TrueContact {
    let (body, contact) = (&now.state.body, &now.contacts[i]);
    let material = now.palms[i].material_velocity(contact.p_WC);
    let slip = (body.v_WCm + body.w_WO.cross(contact.b_W) - material).reject_from_normalized(contact.n);
    TrueContact { mode: now.modes[i], gap: contact.gap, slip: slip.length() }
}
