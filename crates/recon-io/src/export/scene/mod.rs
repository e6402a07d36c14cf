//! A whole scene for MuJoCo: the object in its first state, palms with their friction, springs and hinges.

mod geom;
mod joint;
mod palm;
mod principal;

#[cfg(test)]
mod tests;

use self::joint::Joint;
use self::palm::{About, Palm};
use super::xml::{comment, numbers};
use super::{ExportError, ExportShape, ExportedFile, ObjectModel, mjcf, obj};
use crate::{MotionState, Scene, SceneErrorKind, Shape, TriangleMesh};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::object_dynamics::{ContactSimulationError, MOST_PALMS, PalmCoordinates, SampleTimes, ScenePalm};
use std::io::{self, Write};

/// Half the width of a flat palm that moves (planes cannot) and half the length of a cylinder, in sizes of the object.
const BROAD: f64 = 40.0;
/// Rows and columns of the net on which a shape is drawn that MuJoCo does not know.
const NET: (u32, u32) = (48, 96);

/// Time step, s.
const STEP: f64 = 2e-4;
/// Stiffness of contacts as a rate squared, 1/s^2: 1.5 in units of the time step (Runge-Kutta steps are stable up to about 7).
const STIFFNESS: f64 = 1.5 / (STEP * STEP);
/// Share of critical damping.
const DAMPING: f64 = 0.5;
/// Soft contacts: springs and dampers. Hard ones couple slip into their normal row, and what slides hovers (`contact-cost.md`).
const IMPEDANCE: f64 = 0.01;
/// Damping of slip, 1/s, and how much harder its rows are than normal ones: what sticks creeps next to nothing.
const SLIP_DAMPING: f64 = 100.0;
const IMPRATIO: f64 = 1e6;

/// Tolerance with which the first state is found.
const START_TOLERANCE: f64 = 1e-8;

/// What is said of contacts in the file.
const CONTACTS: &str = "Contacts are springs and dampers, friction a damper of slip up to Coulomb's bound; their numbers go with the \
                        time step: solref with its inverse square and inverse.";

/// An object on palms of any shape.
#[derive(Clone, Debug, PartialEq)]
pub struct SceneModel {
    /// The object, with its first state.
    pub object: ObjectModel,
    /// The palms.
    pub palms: Vec<ScenePalm>,
    /// Where those that give way are at the start.
    pub start: [PalmCoordinates; MOST_PALMS],
    /// Acceleration of free fall along -Z, m/s^2.
    pub gravity: f64,
}

/// Whether object and palms cannot be where they are said to be.
fn is_of_the_start(error: &ContactSimulationError) -> bool {
    use ContactSimulationError as Error;
    matches!(
        error,
        Error::Start(_)
            | Error::Penetration { .. }
            | Error::NotInContact { .. }
            | Error::PalmsOverlap { .. }
            | Error::PalmsCoincide { .. }
            | Error::Contact { .. }
    )
}

impl SceneModel {
    /// The scene of a file that can be simulated, called `name`.
    ///
    /// # Errors
    /// Those of [`Scene::contact_scene`] and [`Scene::contact_start`], and of a start that `recon simulate` does not take.
    pub fn new(name: &str, scene: &Scene) -> Result<Self, SceneErrorKind> {
        let world = scene.contact_scene()?;
        let (start, _) = scene.contact_start()?;
        // Gaps of a state that is given to some digits are closed: stiff contacts would throw the object off.
        let times = SampleTimes { duration: STEP, rate: 1.0 / STEP };
        let state = match world.simulate(&start, times, START_TOLERANCE) {
            Ok(run) => run.instants.first().map(|now| now.state),
            Err(error) if is_of_the_start(&error) => return Err(SceneErrorKind::Start(Box::new(error))),
            // What rigid bodies leave open may still be tried with soft contacts.
            Err(_) => None,
        };
        let (body, palms) =
            state.map_or((start.body, world.palms_at_start()), |state| (state.body, state.palms));
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
            start: Some(MotionState::from(body)),
        };
        Ok(Self { object, palms: world.palms().to_vec(), start: palms, gravity: scene.gravity })
    }

    /// The model `NAME.xml` and its meshes.
    ///
    /// Joints `palm_i_j` follow the `j`th part of the motion of palm `i`: whoever steps the model sets their position and rate,
    /// by the law whose numbers stand in the custom field of that name, and `qfrc_applied` to the armature times its
    /// acceleration. Of a table of poses they are the slides `palm_i_path_x`, `_y`, `_z` and the ball `palm_i_path_turn`, which follow
    /// the file that the text `palm_i_path` names, a row for each time step. Springs are the slides `palm_i_x`, `_y`, `_z` along
    /// the principal axes of the stiffness. Motors are the hinges `palm_i_motor` with actuators. A cup is made of boxes.
    ///
    /// # Errors
    /// [`ExportError`] names the palm that MuJoCo does not know.
    pub fn files(&self) -> Result<Vec<ExportedFile>, ExportError> {
        self.object.check()?;
        let reach = match &self.object.shape {
            ExportShape::Ellipsoid { semi_axes, .. } => semi_axes.max_element(),
            ExportShape::Mesh { mesh, .. } => mesh.vertices.iter().map(|v| v.length()).fold(0.0, f64::max),
        };
        let object = self.object.start.as_ref().map_or(DVec3::ZERO, |start| start.p_WCm);
        let about = About { broad: BROAD * reach, object, step: STEP };
        let palm = |(i, (palm, start))| Palm::new(i + 1, palm, start, &about);
        let palms =
            self.palms.iter().zip(&self.start).enumerate().map(palm).collect::<Result<Vec<_>, _>>()?;
        let mut contents = Vec::new();
        // Writing to memory does not fail.
        let _ = self.write(&palms, &mut contents);
        let mut files = vec![ExportedFile { name: format!("{}.xml", self.object.name), contents }];
        for palm in palms {
            let name = self.path_file(&palm);
            files.extend(palm.path.map(|contents| ExportedFile { name, contents }));
        }
        for (name, mesh) in self.object.meshes(&[]) {
            files.push(ExportedFile { name: self.object.mesh_file(&name), contents: obj::write(&mesh) });
        }
        Ok(files)
    }

    fn write(&self, palms: &[Palm], to: &mut dyn Write) -> io::Result<()> {
        let joints = || palms.iter().flat_map(|palm| &palm.joints);
        mjcf::open(&self.object, to)?;
        palms.iter().filter_map(Palm::note).try_for_each(|note| writeln!(to, "{}", comment(&note)))?;
        writeln!(to, "{}", comment(CONTACTS))?;
        writeln!(
            to,
            "<option gravity=\"0 0 {}\" timestep=\"{}\" integrator=\"RK4\" cone=\"elliptic\" impratio=\"{}\" \
             solver=\"Newton\" tolerance=\"1e-14\" iterations=\"100\" \
             ccd_tolerance=\"1e-12\" ccd_iterations=\"100\"/>",
            numbers(&[-self.gravity]),
            numbers(&[STEP]),
            numbers(&[IMPRATIO])
        )?;
        writeln!(to, "<custom>")?;
        for joint in joints() {
            if let Some((kind, data)) = &joint.law {
                let (name, data) = (&joint.name, numbers(data));
                writeln!(to, "  <numeric name=\"{name}_{kind}\" data=\"{data}\"/>")?;
            }
        }
        for palm in palms.iter().filter(|palm| palm.path.is_some()) {
            writeln!(to, "  <text name=\"{}_path\" data=\"{}\"/>", palm.name, self.path_file(palm))?;
        }
        writeln!(to, "</custom>")?;
        mjcf::assets(&self.object, to)?;
        writeln!(to, "<worldbody>")?;
        mjcf::body(&self.object, to)?;
        palms.iter().try_for_each(|palm| palm.write(to))?;
        writeln!(to, "</worldbody>\n<contact>")?;
        let contact = format!(
            "solref=\"{}\" solreffriction=\"{}\" solimp=\"{}\"",
            numbers(&[-STIFFNESS, -2.0 * DAMPING * STIFFNESS.sqrt()]),
            numbers(&[-1.0, -SLIP_DAMPING]),
            numbers(&[IMPEDANCE, IMPEDANCE, 1e-3])
        );
        palms.iter().try_for_each(|palm| palm.write_pairs(&self.object.name, &contact, to))?;
        writeln!(to, "</contact>\n<actuator>")?;
        for joint in joints().filter(|joint| joint.motor.is_some()) {
            writeln!(to, "  <motor name=\"{0}\" joint=\"{0}\"/>", joint.name)?;
        }
        writeln!(to, "</actuator>\n<keyframe>")?;
        self.write_start(&joints().collect::<Vec<_>>(), to)?;
        writeln!(to, "</keyframe>\n</mujoco>")
    }

    fn path_file(&self, palm: &Palm) -> String {
        format!("{}_{}.csv", self.object.name, palm.name)
    }

    fn write_start(&self, joints: &[&Joint], to: &mut dyn Write) -> io::Result<()> {
        let Some(start) = &self.object.start else { return Ok(()) };
        let (p, q, v) = (start.p_WCm, start.R_WO, start.v_WCm);
        // MuJoCo has the angular velocity of a free joint in body axes.
        let w = q.inverse() * start.w_WO;
        let mut position = vec![p.x, p.y, p.z, q.w, q.x, q.y, q.z];
        let mut rates = vec![v.x, v.y, v.z, w.x, w.y, w.z];
        position.extend(joints.iter().flat_map(|joint| &joint.position));
        rates.extend(joints.iter().flat_map(|joint| &joint.rate));
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
