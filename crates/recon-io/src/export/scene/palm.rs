//! A palm of MuJoCo.

use super::geom::{farthest, geoms};
use super::joint::{Joint, Kind, along_parts, along_path, law, path};
use super::principal::principal;
use crate::export::ExportError;
use crate::export::xml::numbers;
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{PalmSurface, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{PalmCoordinates, PalmDrive, PalmSpring, PalmTorque, ScenePalm};
use std::io::{self, Write};

/// MuJoCo wants friction above zero, of contacts without friction as well.
const LEAST_FRICTION: f64 = 1e-5;

/// A palm as a body with joints, the outermost first.
pub(super) struct Palm {
    pub(super) name: String,
    pose: SurfacePose,
    surface: PalmSurface,
    /// Types, sizes and places of its geoms.
    geoms: Vec<String>,
    friction: f64,
    /// Of a palm that moves, kg.
    mass: Option<f64>,
    pub(super) joints: Vec<Joint>,
    /// The file with where joints are that follow a table of poses.
    pub(super) path: Option<Vec<u8>>,
}

/// What a palm is exported for: how broad planes are, where the object is, m, and the time step, s.
pub(super) struct About {
    pub(super) broad: f64,
    pub(super) object: DVec3,
    pub(super) step: f64,
}

impl Palm {
    pub(super) fn new(
        number: usize,
        palm: &ScenePalm,
        start: &PalmCoordinates,
        about: &About,
    ) -> Result<Self, ExportError> {
        let name = format!("palm_{number}");
        let (motion, mass, mut joints) = match &palm.drive {
            PalmDrive::Prescribed(motion) => (motion.clone(), None, Vec::new()),
            PalmDrive::Spring(spring) => {
                (spring.command.clone(), Some(spring.mass), springs(number, spring, start)?)
            }
            // All of the inertia is the joint's.
            PalmDrive::Torque(motor) => {
                let hinge = hinge(&name, motor, start);
                (SurfaceMotion::immobile(motor.pose), Some(1e-9 * motor.inertia), vec![hinge])
            }
        };
        let commanded = motion.at(0.0);
        // Springs are outside of the motion that they follow: their axes stay.
        let (pose, path) = match &motion {
            SurfaceMotion::Parts { pose, parts } => {
                joints.extend(along_parts(&name, parts));
                (*pose, None)
            }
            SurfaceMotion::Table(table) => {
                joints.extend(along_path(&name, table));
                (SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY }, Some(path(table, about.step)))
            }
        };
        let towards = commanded.R_WP.transpose() * (about.object - commanded.p_WP);
        let geoms = geoms(palm.surface, !joints.is_empty(), about.broad, towards);
        let mass = mass.or((!joints.is_empty()).then_some(1.0));
        Ok(Self { name, pose, geoms, surface: palm.surface, friction: palm.friction, mass, joints, path })
    }

    pub(super) fn write(&self, to: &mut dyn Write) -> io::Result<()> {
        let (name, q) = (&self.name, self.pose.R_WP);
        let (pos, quat) = (numbers(&self.pose.p_WP.to_array()), numbers(&[q.w, q.x, q.y, q.z]));
        let inertial = |mass: f64| {
            let (mass, inertia) = (numbers(&[mass]), numbers(&[1e-4 * mass; 3]));
            format!("    <inertial pos=\"0 0 0\" mass=\"{mass}\" diaginertia=\"{inertia}\"/>")
        };
        let (mount, joints) = self.joints.split_at(self.mounted());
        if let (Some(mass), false) = (self.mass, mount.is_empty()) {
            writeln!(to, "  <body name=\"{name}_mount\" gravcomp=\"1\">\n{}", inertial(1e-6 * mass))?;
            let world = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY };
            mount.iter().try_for_each(|joint| joint.write(&world, to))?;
        }
        writeln!(to, "  <body name=\"{name}\" pos=\"{pos}\" quat=\"{quat}\" gravcomp=\"1\">")?;
        if let Some(mass) = self.mass {
            writeln!(to, "{}", inertial(mass))?;
        }
        joints.iter().try_for_each(|joint| joint.write(&self.pose, to))?;
        for (k, geom) in self.geoms.iter().enumerate() {
            writeln!(
                to,
                "    <geom name=\"{}\" {geom} contype=\"0\" conaffinity=\"0\"/>",
                self.geom_name(k)
            )?;
        }
        writeln!(to, "  </body>{}", if mount.is_empty() { "" } else { "</body>" })
    }

    /// How many of the joints are those of a body around the palm's: springs, where the palm has more than the six that one may have.
    fn mounted(&self) -> usize {
        let rates: usize = self.joints.iter().map(|joint| joint.rate.len()).sum();
        if rates > 6 { 3 } else { 0 }
    }

    /// Which geoms touch the object, and how: `contact` are the attributes of all palms.
    pub(super) fn write_pairs(&self, object: &str, contact: &str, to: &mut dyn Write) -> io::Result<()> {
        let mu = numbers(&[self.friction.max(LEAST_FRICTION)]);
        let dimensions = if self.friction > 0.0 { 3 } else { 1 };
        (0..self.geoms.len()).try_for_each(|k| {
            let geom = self.geom_name(k);
            writeln!(
                to,
                "  <pair geom1=\"{geom}\" geom2=\"{object}\" condim=\"{dimensions}\" friction=\"{mu} {mu} 0.005 0.0001 0.0001\" \
                 {contact}/>"
            )
        })
    }

    /// What is to be said of a shape that MuJoCo does not know.
    pub(super) fn note(&self) -> Option<String> {
        let PalmSurface::Cup { radius } = self.surface else { return None };
        Some(format!(
            "{} is a cup, and MuJoCo has no hollow sphere: {} boxes tangent to it, over the half that is nearest to the object. What \
             touches them is {:.1e} m outside of it at most, and their normals are up to {:.1} degrees off.",
            self.name,
            self.geoms.len(),
            radius * (1.0 / farthest().cos() - 1.0),
            farthest().to_degrees()
        ))
    }

    fn geom_name(&self, k: usize) -> String {
        match self.geoms.len() {
            1 => self.name.clone(),
            _ => format!("{}_{}", self.name, k + 1),
        }
    }
}

/// Slides along the principal axes of the stiffness.
fn springs(number: usize, spring: &PalmSpring, start: &PalmCoordinates) -> Result<Vec<Joint>, ExportError> {
    let (axes, stiffness) = principal(spring.stiffness);
    let damping = axes.transpose() * spring.damping * axes;
    let diagonal = DVec3::new(damping.x_axis.x, damping.y_axis.y, damping.z_axis.z);
    let coupled = (damping - DMat3::from_diagonal(diagonal)).abs();
    let largest = coupled.to_cols_array().into_iter().fold(0.0, f64::max);
    if largest > 1e-9 * diagonal.abs().max_element() {
        return Err(ExportError::Damping { palm: number, coupling: largest });
    }
    let command = spring.command.at(0.0);
    let (stretch, rate) = (start.position - command.p_WP, start.velocity - command.v_WP);
    let slide = |k: usize| {
        let axis = axes.col(k);
        let name = format!("palm_{number}_{}", ["x", "y", "z"][k]);
        let plain = Joint::new(name, axis, [axis.dot(stretch), axis.dot(rate)]);
        Joint { stiffness: stiffness[k], damping: diagonal[k], ..plain }
    };
    Ok((0..3).map(slide).collect())
}

fn hinge(palm: &str, motor: &PalmTorque, start: &PalmCoordinates) -> Joint {
    let start = [start.position.x, start.velocity.x];
    Joint {
        kind: Kind::Hinge,
        pivot: motor.pivot,
        armature: motor.inertia,
        law: Some(law(&motor.torque)),
        motor: Some(motor.torque.at(0.0)[0]),
        ..Joint::new(format!("{palm}_motor"), motor.axis.get(), start)
    }
}
