//! Surfaces in further formats.

use super::folder::Extra;
use crate::cli::MeshAs;
use crate::error::CliError;
use recon_io::{TriangleMesh, write_glb, write_stl};

/// Files of surfaces whose names end in `.ply`, in these formats. Surfaces without triangles have none.
pub(crate) fn meshes_as<'a>(
    surfaces: impl IntoIterator<Item = (&'a str, &'a TriangleMesh)>,
    formats: &[MeshAs],
) -> Result<Vec<Extra>, CliError> {
    let mut files = Vec::new();
    for (file, mesh) in surfaces.into_iter().filter(|(_, mesh)| !mesh.triangles.is_empty()) {
        let name = file.trim_end_matches(".ply");
        for format in formats {
            let mut bytes = Vec::new();
            let written = match format {
                MeshAs::Stl => write_stl(mesh, name, &mut bytes),
                MeshAs::Glb => write_glb(mesh, name, &mut bytes),
            };
            written.map_err(CliError::MeshFormat)?;
            files.push((format!("{name}.{}", format.ending()), bytes));
        }
    }
    Ok(files)
}
