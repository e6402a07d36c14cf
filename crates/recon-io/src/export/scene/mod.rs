//! A whole scene for MuJoCo: the object in its first state, palms with their friction, springs and hinges.

mod palm;
mod principal;

#[cfg(test)]
mod tests;

use self::palm::{Joint, Palm};
use super::xml::{comment, numbers};
use super::{ExportError, ExportShape, ExportedFile, ObjectModel, mjcf, obj};
use crate::{MotionState, Scene, SceneErrorKind, Shape, TriangleMesh};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::ScenePalm;
use std::io::{self, Write};

/// Half the width of a flat palm that moves (planes cannot) and half the length of a cylinder, in sizes of the object.
const BROAD: f64 = 40.0;
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
