//! The format of ROS: one link.

use super::xml::{comment, head, numbers};
use super::{ExportShape, ObjectModel, upper};
use std::io::{self, Write};

/// Name of the mesh that stands for an ellipsoid, which URDF does not know.
pub(super) const ELLIPSOID: &str = "ellipsoid";

pub(super) fn write(model: &ObjectModel, to: &mut dyn Write) -> io::Result<()> {
    let name = &model.name;
    writeln!(to, "<?xml version=\"1.0\"?>\n<robot name=\"{name}\">")?;
    head(&model.notes, to)?;
    if let Some(deviations) = &model.deviations {
        let inertia = numbers(&upper(deviations.inertia));
        let text = format!(
            "Standard deviations: mass {}, inertia (ixx ixy ixz iyy iyz izz) {inertia}",
            numbers(&[deviations.mass])
        );
        writeln!(to, "{}", comment(&text))?;
    }
    let mesh = match &model.shape {
        ExportShape::Ellipsoid { .. } => ELLIPSOID,
        ExportShape::Mesh { name, .. } => name,
    };
    let file = model.mesh_file(mesh);
    let [xx, xy, xz, yy, yz, zz] = model.inertia().map(|v| numbers(&[v]));
    let mass = numbers(&[model.mass.mass()]);
    writeln!(to, "<link name=\"{name}\">\n  <inertial>\n    <origin xyz=\"0 0 0\" rpy=\"0 0 0\"/>")?;
    writeln!(to, "    <mass value=\"{mass}\"/>")?;
    writeln!(
        to,
        "    <inertia ixx=\"{xx}\" ixy=\"{xy}\" ixz=\"{xz}\" iyy=\"{yy}\" iyz=\"{yz}\" izz=\"{zz}\"/>\n  </inertial>"
    )?;
    for kind in ["visual", "collision"] {
        writeln!(to, "  <{kind}>\n    <geometry><mesh filename=\"{file}\"/></geometry>\n  </{kind}>")?;
    }
    writeln!(to, "</link>\n</robot>")
}
