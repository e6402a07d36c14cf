//! A palm of MuJoCo.

use super::principal::principal;
use crate::export::ExportError;
use crate::export::xml::numbers;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{MotionLaw, MotionPart, PalmSurface, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{PalmDrive, ScenePalm};
use std::io::{self, Write};

/// Added to the inertia of joints that follow a prescribed motion, kg or kg m^2. They are set anew at every step, within which 10 N
/// change their rate by 2e-6 m/s. More would spoil the solver, whose tolerance is relative to the mean inertia.
const ARMATURE: f64 = 1e3;
/// A palm as a body with joints, the outermost first.
pub(super) struct Palm {
    name: String,
    pose: SurfacePose,
    /// Type, size and place of its geom.
    geom: String,
    friction: f64,
    /// Of a palm that moves, kg.
    mass: Option<f64>,
    pub(super) joints: Vec<Joint>,
}

/// A joint of a palm; axis and pivot in world axes, while all joints are at zero.
pub(super) struct Joint {
    pub(super) name: String,
    turns: bool,
    axis: DVec3,
    pivot: DVec3,
    stiffness: f64,
    damping: f64,
    armature: f64,
    /// Position and rate at the start.
    pub(super) start: [f64; 2],
    /// Kind and numbers of what it follows.
    pub(super) law: Option<(&'static str, Vec<f64>)>,
    /// Torque at the start.
    pub(super) motor: Option<f64>,
}

impl Palm {
    pub(super) fn new(number: usize, palm: &ScenePalm, broad: f64) -> Result<Self, ExportError> {
        let name = format!("palm_{number}");
        let table = ExportError::PoseTable { palm: number };
        let (pose, mass, joints) = match &palm.drive {
            PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts }) => {
                (*pose, (!parts.is_empty()).then_some(1.0), followed(&name, parts))
            }
            PalmDrive::Spring(spring) => {
                let SurfaceMotion::Parts { pose, parts } = &spring.command else { return Err(table) };
                let (axes, stiffness) = principal(spring.stiffness);
                let damping = axes.transpose() * spring.damping * axes;
                let diagonal = DVec3::new(damping.x_axis.x, damping.y_axis.y, damping.z_axis.z);
                let coupled = (damping - DMat3::from_diagonal(diagonal)).abs();
                let largest = coupled.to_cols_array().into_iter().fold(0.0, f64::max);
                if largest > 1e-9 * diagonal.abs().max_element() {
                    return Err(ExportError::Damping { palm: number, coupling: largest });
                }
                let slide = |k: usize| Joint {
                    stiffness: stiffness[k],
                    damping: diagonal[k],
                    ..Joint::new(format!("{name}_{}", ["x", "y", "z"][k]), axes.col(k))
                };
                // Springs are outside of the motion that they follow: their axes stay.
                let joints = (0..3).map(slide).chain(followed(&name, parts)).collect();
                (*pose, Some(spring.mass), joints)
            }
            PalmDrive::Torque(motor) => {
                let hinge = Joint {
                    turns: true,
                    pivot: motor.pivot,
                    armature: motor.inertia,
                    start: [motor.angle, motor.rate],
                    law: Some(law(&motor.torque)),
                    motor: Some(motor.torque.at(0.0)[0]),
                    ..Joint::new(format!("{name}_motor"), motor.axis.get())
                };
                // All of the inertia is the joint's.
                (motor.pose, Some(1e-9 * motor.inertia), vec![hinge])
            }
            PalmDrive::Prescribed(SurfaceMotion::Table(_)) => return Err(table),
        };
        let geom = geom(palm.surface, !joints.is_empty(), broad).ok_or(ExportError::Cup { palm: number })?;
        Ok(Self { name, pose, geom, friction: palm.friction, mass, joints })
    }

    pub(super) fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        let (name, q) = (&self.name, self.pose.R_WP);
        let (pos, quat) = (numbers(&self.pose.p_WP.to_array()), numbers(&[q.w, q.x, q.y, q.z]));
        writeln!(to, "  <body name=\"{name}\" pos=\"{pos}\" quat=\"{quat}\" gravcomp=\"1\">")?;
        if let Some(mass) = self.mass {
            let (mass, inertia) = (numbers(&[mass]), numbers(&[1e-4 * mass; 3]));
            writeln!(to, "    <inertial pos=\"0 0 0\" mass=\"{mass}\" diaginertia=\"{inertia}\"/>")?;
        }
        for joint in &self.joints {
            let axis = numbers(&(q.inverse() * joint.axis).to_array());
            let kind = match joint.turns {
                true => {
                    let pivot = q.inverse() * (joint.pivot - self.pose.p_WP);
                    format!("type=\"hinge\" pos=\"{}\"", numbers(&pivot.to_array()))
                }
                false => "type=\"slide\"".to_owned(),
            };
            let [stiffness, damping, armature] =
                [joint.stiffness, joint.damping, joint.armature].map(|v| numbers(&[v]));
            writeln!(
                to,
                "    <joint name=\"{}\" {kind} axis=\"{axis}\" stiffness=\"{stiffness}\" \
                 damping=\"{damping}\" armature=\"{armature}\"/>",
                joint.name
            )?;
        }
        // Palms do not touch each other, and their friction outweighs that of the object.
        writeln!(
            to,
            "    <geom name=\"{name}\" {} contype=\"0\" conaffinity=\"1\" condim=\"3\" priority=\"1\" \
             friction=\"{} 0.005 0.0001\" solref=\"0.001 1\" solimp=\"0.99 0.999 1e-6\"/>\n  </body>",
            self.geom,
            numbers(&[self.friction])
        )
    }
}

impl Joint {
    fn new(name: String, axis: DVec3) -> Self {
        let none = [0.0; 2];
        Self {
            name,
            turns: false,
            axis,
            pivot: DVec3::ZERO,
            stiffness: 0.0,
            damping: 0.0,
            armature: 0.0,
            start: none,
            law: None,
            motor: None,
        }
    }
}

/// Type, size and place of a palm's geom; none of a cup.
fn geom(surface: PalmSurface, moves: bool, broad: f64) -> Option<String> {
    Some(match surface {
        PalmSurface::Plane if !moves => "type=\"plane\" size=\"0 0 1\"".to_owned(),
        PalmSurface::Plane => {
            // Planes cannot move in MuJoCo: the top of a box.
            format!("type=\"box\" size=\"{}\" pos=\"{}\"", numbers(&[broad; 3]), numbers(&[0.0, 0.0, -broad]))
        }
        PalmSurface::Sphere { radius } => format!("type=\"sphere\" size=\"{}\"", numbers(&[radius])),
        PalmSurface::Cylinder { radius } => {
            format!("type=\"cylinder\" size=\"{}\" zaxis=\"1 0 0\"", numbers(&[radius, broad]))
        }
        PalmSurface::Cup { .. } => return None,
    })
}

/// Joints that follow the parts of a motion: what moves last is outermost, so its axis is fixed in the world.
fn followed(palm: &str, parts: &[MotionPart]) -> Vec<Joint> {
    let joint = |(j, part): (usize, &MotionPart)| {
        let (turns, axis, pivot, motion) = match part {
            MotionPart::Shift { direction, law } => (false, direction.get(), DVec3::ZERO, law),
            MotionPart::Turn { pivot, axis, law } => (true, axis.get(), *pivot, law),
        };
        let [value, rate, _] = motion.at(0.0);
        let named = Joint::new(format!("{palm}_{}", j + 1), axis);
        Joint { turns, pivot, armature: ARMATURE, start: [value, rate], law: Some(law(motion)), ..named }
    };
    parts.iter().enumerate().rev().map(joint).collect()
}

/// Kind and numbers of a law, in the order in which scene files have them.
fn law(law: &MotionLaw) -> (&'static str, Vec<f64>) {
    match *law {
        MotionLaw::Constant { value } => ("constant", vec![value]),
        MotionLaw::Steady { start, rate } => ("steady", vec![start, rate]),
        MotionLaw::Sinusoid { mean, amplitude, frequency, phase } => {
            ("sinusoid", vec![mean, amplitude, frequency, phase])
        }
        MotionLaw::Ramp { height, start, duration } => ("ramp", vec![height, start, duration]),
    }
}
