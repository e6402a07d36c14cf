//! A whole scene for MuJoCo: the object in its first state, palms with their friction, springs and hinges.

use super::principal::principal;
use super::xml::{comment, numbers};
use super::{ExportError, ExportShape, ExportedFile, ObjectModel, mjcf, obj};
use crate::{MotionState, Scene, SceneErrorKind, Shape, TriangleMesh};
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{
    Direction, MotionLaw, MotionPart, PalmSurface, SupportFunction, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::{PalmDrive, ScenePalm};
use std::io::{self, Write};

/// Half the width of a flat palm that moves (planes cannot) and half the length of a cylinder, in sizes of the object.
const BROAD: f64 = 40.0;
/// Added to the inertia of joints that follow a prescribed motion, kg or kg m^2. They are set anew at every step, within which 10 N
/// change their rate by 2e-6 m/s. More would spoil the solver, whose tolerance is relative to the mean inertia.
const ARMATURE: f64 = 1e3;
/// Rows and columns of the net on which a shape is drawn that MuJoCo does not know.
const NET: (u32, u32) = (48, 96);

/// An object on palms of any shape.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneModel {
    /// The object, with its first state.
    pub object: ObjectModel,
    /// The palms.
    pub palms: Vec<ScenePalm>,
    /// Acceleration of free fall along -Z, m/s^2.
    pub gravity: f64,
}

impl SceneModel {
    /// The scene of a file that can be simulated, called `name`.
    ///
    /// # Errors
    /// Those of [`Scene::contact_scene`] and [`Scene::contact_start`].
    pub fn new(name: &str, scene: &Scene) -> Result<Self, SceneErrorKind> {
        let world = scene.contact_scene()?;
        let (start, _) = scene.contact_start()?;
        // A scene that can be simulated has one.
        let simulation = scene.simulation.as_ref();
        let ellipsoid = |semi_axes| {
            let centre = simulation.map_or(DVec3::ZERO, |simulation| simulation.offset);
            ExportShape::Ellipsoid { centre, orientation: DQuat::IDENTITY, semi_axes }
        };
        let shape = match simulation.map(|simulation| &simulation.shape) {
            Some(Shape::Sphere { radius }) => ellipsoid(DVec3::splat(*radius)),
            Some(Shape::Ellipsoid { semi_axes }) => ellipsoid(*semi_axes),
            _ => {
                let at = |n: DVec3| world.body().point(Direction::new_unchecked(n));
                ExportShape::Mesh { name: "shape".to_owned(), mesh: TriangleMesh::net(NET.0, NET.1, at) }
            }
        };
        let object = ObjectModel {
            name: name.to_owned(),
            notes: Vec::new(),
            mass: *world.mass(),
            deviations: None,
            shape,
            seen: Vec::new(),
            start: Some(MotionState::from(start.body)),
        };
        Ok(Self { object, palms: world.palms().to_vec(), gravity: scene.gravity })
    }

    /// The model `NAME.xml` and its meshes.
    ///
    /// Joints `palm_i_j` follow the `j`th part of the motion of palm `i`: whoever steps the model sets their position and rate,
    /// by the law whose numbers stand in the custom field of that name, and `qfrc_applied` to the armature times its
    /// acceleration. Springs are the slides `palm_i_x`, `_y`, `_z` along the principal axes of the stiffness. Motors are
    /// the hinges `palm_i_motor` with actuators.
    ///
    /// # Errors
    /// [`ExportError`] names the palm that MuJoCo does not know, such as a cup.
    pub fn files(&self) -> Result<Vec<ExportedFile>, ExportError> {
        self.object.check()?;
        let reach = match &self.object.shape {
            ExportShape::Ellipsoid { semi_axes, .. } => semi_axes.max_element(),
            ExportShape::Mesh { mesh, .. } => mesh.vertices.iter().map(|v| v.length()).fold(0.0, f64::max),
        };
        let palm = |(i, palm)| Palm::new(i + 1, palm, BROAD * reach);
        let palms = self.palms.iter().enumerate().map(palm).collect::<Result<Vec<_>, _>>()?;
        let mut contents = Vec::new();
        // Writing to memory does not fail.
        let _ = self.write(&palms, &mut contents);
        let mut files = vec![ExportedFile { name: format!("{}.xml", self.object.name), contents }];
        for (name, mesh) in self.object.meshes(&[]) {
            files.push(ExportedFile { name: self.object.mesh_file(&name), contents: obj::write(&mesh) });
        }
        Ok(files)
    }

    fn write(&self, palms: &[Palm], to: &mut dyn Write) -> io::Result<()> {
        let joints = || palms.iter().flat_map(|palm| &palm.joints);
        mjcf::open(&self.object, to)?;
        writeln!(to, "{}", comment("Contacts sink in by some 1e-6 m; stiffer ones need shorter steps."))?;
        writeln!(
            to,
            "<option gravity=\"0 0 {}\" timestep=\"0.0002\" integrator=\"implicitfast\" cone=\"elliptic\" \
             impratio=\"100\" tolerance=\"1e-14\" iterations=\"200\"/>",
            numbers(&[-self.gravity])
        )?;
        writeln!(to, "<custom>")?;
        for joint in joints() {
            if let Some((kind, data)) = &joint.law {
                let (name, data) = (&joint.name, numbers(data));
                writeln!(to, "  <numeric name=\"{name}_{kind}\" data=\"{data}\"/>")?;
            }
        }
        writeln!(to, "</custom>")?;
        mjcf::assets(&self.object, to)?;
        writeln!(to, "<worldbody>")?;
        mjcf::body(&self.object, to)?;
        palms.iter().try_for_each(|palm| palm.write(to))?;
        writeln!(to, "</worldbody>\n<actuator>")?;
        for joint in joints().filter(|joint| joint.motor.is_some()) {
            writeln!(to, "  <motor name=\"{0}\" joint=\"{0}\"/>", joint.name)?;
        }
        writeln!(to, "</actuator>\n<keyframe>")?;
        self.write_start(&joints().collect::<Vec<_>>(), to)?;
        writeln!(to, "</keyframe>\n</mujoco>")
    }

    fn write_start(&self, joints: &[&Joint], to: &mut dyn Write) -> io::Result<()> {
        let Some(start) = &self.object.start else { return Ok(()) };
        let (p, q, v) = (start.p_WCm, start.R_WO, start.v_WCm);
        // MuJoCo has the angular velocity of a free joint in body axes.
        let w = q.inverse() * start.w_WO;
        let mut position = vec![p.x, p.y, p.z, q.w, q.x, q.y, q.z];
        let mut rates = vec![v.x, v.y, v.z, w.x, w.y, w.z];
        position.extend(joints.iter().map(|joint| joint.start[0]));
        rates.extend(joints.iter().map(|joint| joint.start[1]));
        let control: Vec<f64> = joints.iter().filter_map(|joint| joint.motor).collect();
        writeln!(
            to,
            "  <key name=\"start\" qpos=\"{}\" qvel=\"{}\" ctrl=\"{}\"/>",
            numbers(&position),
            numbers(&rates),
            numbers(&control)
        )
    }
}

/// A palm as a body with joints, the outermost first.
struct Palm {
    name: String,
    pose: SurfacePose,
    /// Type, size and place of its geom.
    geom: String,
    friction: f64,
    /// Of a palm that moves, kg.
    mass: Option<f64>,
    joints: Vec<Joint>,
}

/// A joint of a palm; axis and pivot in world axes, while all joints are at zero.
struct Joint {
    name: String,
    turns: bool,
    axis: DVec3,
    pivot: DVec3,
    stiffness: f64,
    damping: f64,
    armature: f64,
    /// Position and rate at the start.
    start: [f64; 2],
    /// Kind and numbers of what it follows.
    law: Option<(&'static str, Vec<f64>)>,
    /// Torque at the start.
    motor: Option<f64>,
}

impl Palm {
    fn new(number: usize, palm: &ScenePalm, broad: f64) -> Result<Self, ExportError> {
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
        let geom = match palm.surface {
            PalmSurface::Plane if joints.is_empty() => "type=\"plane\" size=\"0 0 1\"".to_owned(),
            PalmSurface::Plane => {
                // Planes cannot move in MuJoCo: the top of a box.
                format!(
                    "type=\"box\" size=\"{}\" pos=\"{}\"",
                    numbers(&[broad; 3]),
                    numbers(&[0.0, 0.0, -broad])
                )
            }
            PalmSurface::Sphere { radius } => format!("type=\"sphere\" size=\"{}\"", numbers(&[radius])),
            PalmSurface::Cylinder { radius } => {
                format!("type=\"cylinder\" size=\"{}\" zaxis=\"1 0 0\"", numbers(&[radius, broad]))
            }
            PalmSurface::Cup { .. } => return Err(ExportError::Cup { palm: number }),
        };
        Ok(Self { name, pose, geom, friction: palm.friction, mass, joints })
    }

    fn write(&self, to: &mut dyn Write) -> io::Result<()> {
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
