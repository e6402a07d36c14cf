//! Models for simulators: the identified object (MJCF and URDF with mass, inertia, shape and bounds), and whole scenes (MJCF).

mod error;
mod mjcf;
mod obj;
mod scene;
mod surface;
mod urdf;
mod xml;

#[cfg(test)]
mod tests;

pub use error::ExportError;
pub use scene::SceneModel;

use crate::{MotionState, TriangleMesh};
use glam::{DMat3, DQuat, DVec3};
use recon::object_dynamics::MassProperties;
use std::io;

/// An identified object. Body axes `O`: origin in the centre of mass, axes as estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectModel {
    /// What it shall be called; files and elements are named after it.
    pub name: String,
    /// What a reader must know, one line each; written as comments.
    pub notes: Vec<String>,
    /// Mass and inertia tensor about the centre of mass in body axes.
    pub mass: MassProperties,
    /// How well they are known; none where they were given and not estimated.
    pub deviations: Option<MassDeviations>,
    /// The shape that collides.
    pub shape: ExportShape,
    /// Further surfaces in body axes, to be seen and not to collide, each with its name.
    pub seen: Vec<(String, TriangleMesh)>,
    /// Estimated motion at the first sample.
    pub start: Option<MotionState>,
}

/// Standard deviations of estimated mass properties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassDeviations {
    /// Of the mass, kg.
    pub mass: f64,
    /// Of the entries of the inertia tensor, kg m^2.
    pub inertia: DMat3,
}

/// The shape of an exported object, in body axes.
#[derive(Clone, Debug, PartialEq)]
pub enum ExportShape {
    /// An ellipsoid.
    Ellipsoid {
        /// Its centre from the centre of mass, m.
        centre: DVec3,
        /// Turns its axes into those of the body.
        orientation: DQuat,
        /// Semi-axes, m.
        semi_axes: DVec3,
    },
    /// A closed convex surface, named such that a reader knows which.
    Mesh {
        /// Such as "inner".
        name: String,
        /// Vertices in m.
        mesh: TriangleMesh,
    },
}

/// Formats of an exported object.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
#[non_exhaustive]
pub enum ExportFormat {
    /// MuJoCo's: `NAME.xml`. Holds ellipsoids as such.
    Mjcf,
    /// That of ROS: `NAME.urdf`. Ellipsoids become meshes, which lie inside of them by up to 0.11 % of their size.
    Urdf,
}

/// One file of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct ExportedFile {
    /// Its name, without folder.
    pub name: String,
    /// What it holds.
    pub contents: Vec<u8>,
}

impl ObjectModel {
    /// The files of the model in the given formats, meshes included; they belong into one folder, in which the models
    /// look for their meshes (Wavefront OBJ, m).
    ///
    /// Nothing is written here: a model that cannot be made leaves no file.
    ///
    /// # Errors
    /// [`ExportError`] names what the model lacks.
    pub fn files(&self, formats: &[ExportFormat]) -> Result<Vec<ExportedFile>, ExportError> {
        self.check()?;
        let mut files = Vec::new();
        let mut add = |name: String, write: &dyn Fn(&mut Vec<u8>) -> io::Result<()>| {
            let mut contents = Vec::new();
            // Writing to memory does not fail.
            if write(&mut contents).is_ok() {
                files.push(ExportedFile { name, contents });
            }
        };
        if formats.contains(&ExportFormat::Mjcf) {
            add(format!("{}.xml", self.name), &|to| mjcf::write(self, to));
        }
        if formats.contains(&ExportFormat::Urdf) {
            add(format!("{}.urdf", self.name), &|to| urdf::write(self, to));
        }
        if !files.is_empty() {
            for (name, mesh) in self.meshes(formats) {
                files.push(ExportedFile { name: self.mesh_file(&name), contents: obj::write(&mesh) });
            }
        }
        Ok(files)
    }

    fn check(&self) -> Result<(), ExportError> {
        let plain = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if self.name.is_empty() || !self.name.chars().all(plain) {
            return Err(ExportError::Name { name: self.name.clone() });
        }
        match &self.shape {
            ExportShape::Ellipsoid { centre, orientation, semi_axes } => {
                let bad = |v: &f64| !(*v > 0.0 && v.is_finite());
                if let Some(&value) = semi_axes.to_array().iter().find(|v| bad(v)) {
                    return Err(ExportError::SemiAxis { value });
                }
                if !centre.is_finite() || !orientation.is_finite() {
                    return Err(ExportError::Place { centre: *centre });
                }
            }
            ExportShape::Mesh { name, mesh } => surface::check(name, mesh)?,
        }
        self.seen.iter().try_for_each(|(name, mesh)| surface::check(name, mesh))
    }

    /// The meshes that the formats refer to, each once.
    fn meshes(&self, formats: &[ExportFormat]) -> Vec<(String, TriangleMesh)> {
        let mut all = self.seen.clone();
        match &self.shape {
            ExportShape::Mesh { name, mesh } => {
                if !all.iter().any(|(other, _)| other == name) {
                    all.push((name.clone(), mesh.clone()));
                }
            }
            ExportShape::Ellipsoid { centre, orientation, semi_axes } => {
                if formats.contains(&ExportFormat::Urdf) {
                    let mesh = surface::ellipsoid(*centre, *orientation, *semi_axes);
                    all.push((urdf::ELLIPSOID.to_owned(), mesh));
                }
            }
        }
        all
    }

    fn mesh_file(&self, mesh: &str) -> String {
        format!("{}_{mesh}.obj", self.name)
    }

    /// The upper triangle of the inertia tensor as URDF orders it: xx, xy, xz, yy, yz, zz.
    fn inertia(&self) -> [f64; 6] {
        upper(self.mass.inertia())
    }
}

/// xx, xy, xz, yy, yz, zz.
fn upper(tensor: DMat3) -> [f64; 6] {
    let DMat3 { x_axis: x, y_axis: y, z_axis: z } = tensor;
    [x.x, y.x, z.x, y.y, z.y, z.z]
}
