//! A smooth surface that approximates the object, beside its bounds.

use super::bounds::own;
use crate::cli::SurfaceAs;
use crate::error::CliError;
use recon::shape_bounds::ContactSample;
use recon::shape_bounds::approximation::{PrincipalSurface, SplineSurface};
use recon::shape_bounds::concave::HermiteSurface;
use recon_io::TriangleMesh;
use serde_json::{Value, json};

/// Contacts that a surface is made of, at most: the equations of a Hermite surface are dense; more contacts than these do not make a
/// finer lattice of a spline, and take time.
const THROUGH: usize = 400;
const ALL: usize = 4000;
/// Cells of a Hermite surface's mesh along the longest side, and parts of an edge of the octahedron that becomes a spline's.
const CELLS: usize = 48;
const PARTS: usize = 32;

/// A surface, what is told of it, and what the reader must know.
pub(crate) struct Smooth {
    pub(crate) mesh: TriangleMesh,
    pub(crate) about: Value,
    pub(crate) warning: Option<&'static str>,
}

/// The surface of a kind from contacts, whose points have this noise (m) if it is stated.
pub(crate) fn smooth_surface(
    contacts: &[ContactSample],
    kind: SurfaceAs,
    noise: Option<f64>,
) -> Result<Smooth, CliError> {
    let spread = |most: usize| -> Vec<ContactSample> {
        let count = contacts.len().min(most);
        (0..count).map(|k| contacts[k * contacts.len() / count]).collect()
    };
    let (mesh, mut about) = match kind {
        SurfaceAs::Hermite => {
            let some = spread(THROUGH);
            let mesh = HermiteSurface::through(&some)?.mesh(CELLS);
            (mesh, json!({ "kind": "hermite", "contacts": some.len() }))
        }
        SurfaceAs::Spline => {
            let some = spread(ALL);
            let surface = SplineSurface::through(&some)?;
            let about = json!({ "kind": "spline", "contacts": some.len(), "residual_m": surface.residual() });
            (surface.mesh(PARTS), about)
        }
        SurfaceAs::Principal => {
            let points: Vec<_> = spread(ALL).iter().map(|c| c.point).collect();
            let found = PrincipalSurface::of(&points, noise.filter(|sd| *sd > 0.0))?;
            let about = json!({
                "kind": "principal",
                "contacts": points.len(),
                "residual_m": found.scatter(),
                "parameters": found.freedom(),
                "bias_m": found.bias(),
                "has_converged": found.has_converged(),
            });
            (found.surface().mesh(PARTS), about)
        }
    };
    let mesh = own(mesh)?;
    about["is_closed"] = json!(mesh.is_closed());
    let warning = match (mesh.is_closed(), about["has_converged"].as_bool()) {
        (false, _) => {
            Some("The smooth surface is open: between the contacts it leaves the space around them.")
        }
        (_, Some(false)) => Some("The principal surface has not settled: take it for a rough one."),
        _ => None,
    };
    Ok(Smooth { mesh, about, warning })
}
