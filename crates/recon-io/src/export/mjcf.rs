//! MuJoCo's format: one free body that can be attached to any model.

use super::xml::{comment, head, numbers};
use super::{ExportShape, ObjectModel, upper};
use glam::DQuat;
use std::io::{self, Write};

pub(super) fn write(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    open(model, to)?;
    deviations(model, to)?;
    assets(model, to)?;
    writeln!(to, "<worldbody>")?;
    body(model, to)?;
    writeln!(to, "</worldbody>\n</mujoco>")
}

/// The first lines.
pub(super) fn open(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    writeln!(to, "<mujoco model=\"{}\">", model.name)?;
    head(&model.notes, to)
}

fn deviations(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    let (name, Some(deviations)) = (&model.name, &model.deviations) else { return Ok(()) };
    let [dxx, dxy, dxz, dyy, dyz, dzz] = upper(deviations.inertia);
    let (mass, inertia) = (numbers(&[deviations.mass]), numbers(&[dxx, dyy, dzz, dxy, dxz, dyz]));
    writeln!(to, "<custom>")?;
    writeln!(to, "  {}", comment("Standard deviations; those of the inertia in the order of fullinertia."))?;
    writeln!(to, "  <numeric name=\"{name}_mass_std\" data=\"{mass}\"/>")?;
    writeln!(to, "  <numeric name=\"{name}_inertia_std\" data=\"{inertia}\"/>\n</custom>")
}

/// The meshes that the object refers to.
pub(super) fn assets(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    let (name, meshes) = (&model.name, model.meshes(&[]));
    if meshes.is_empty() {
        return Ok(());
    }
    writeln!(to, "<asset>")?;
    for (mesh, _) in &meshes {
        let file = model.mesh_file(mesh);
        // The mass is the body's, whatever the mesh encloses.
        writeln!(to, "  <mesh name=\"{name}_{mesh}\" file=\"{file}\" inertia=\"convex\"/>")?;
    }
    writeln!(to, "</asset>")
}

/// The object as a free body.
pub(super) fn body(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    let (name, [xx, xy, xz, yy, yz, zz]) = (&model.name, model.inertia());
    write!(to, "  <body name=\"{name}\"")?;
    if let Some(start) = &model.start {
        let (pos, quat) = (numbers(&start.p_WCm.to_array()), quaternion(start.R_WO));
        write!(to, " pos=\"{pos}\" quat=\"{quat}\"")?;
    }
    writeln!(to, ">\n    <freejoint name=\"{name}\"/>")?;
    let (mass, inertia) = (numbers(&[model.mass.mass()]), numbers(&[xx, yy, zz, xy, xz, yz]));
    writeln!(to, "    <inertial pos=\"0 0 0\" mass=\"{mass}\" fullinertia=\"{inertia}\"/>")?;
    match &model.shape {
        ExportShape::Ellipsoid { centre, orientation, semi_axes } => {
            let (pos, quat) = (numbers(&centre.to_array()), quaternion(*orientation));
            let size = numbers(&semi_axes.to_array());
            writeln!(
                to,
                "    <geom name=\"{name}\" type=\"ellipsoid\" pos=\"{pos}\" quat=\"{quat}\" size=\"{size}\"/>"
            )?;
        }
        ExportShape::Mesh { name: mesh, .. } => {
            writeln!(to, "    <geom name=\"{name}\" type=\"mesh\" mesh=\"{name}_{mesh}\"/>")?;
        }
    }
    for (mesh, _) in &model.seen {
        writeln!(
            to,
            "    <geom name=\"{name}_{mesh}\" type=\"mesh\" mesh=\"{name}_{mesh}\" contype=\"0\" conaffinity=\"0\" \
             group=\"2\" rgba=\"0.5 0.5 0.5 0.3\"/>"
        )?;
    }
    writeln!(to, "  </body>")
}

/// w first.
fn quaternion(q: DQuat) -> String {
    numbers(&[q.w, q.x, q.y, q.z])
}
