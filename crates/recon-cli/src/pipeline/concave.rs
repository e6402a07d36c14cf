//! A body that need not be convex: bounds of its hull, and its alpha shape.

use super::bounds::{BoundsResult, meshes, own, unbounded};
use crate::error::CliError;
use recon::shape_bounds::concave::AlphaShape;
use recon::shape_bounds::{ContactSample, ShapeBounds};
use recon_io::{Bound, Bounds, brief_to};
use serde_json::{Value, json};

/// Bounds of the hull of a body, and its alpha shape, from exact contacts; the alpha shape for a radius, or for
/// the smallest that leaves it in one piece.
pub(crate) fn concave_bounds(
    contacts: &[ContactSample],
    radius: Option<f64>,
) -> Result<(BoundsResult, Value), CliError> {
    let (bounds, kept) = ShapeBounds::from_concave_contacts(contacts)?;
    let (lower, upper) = meshes(&bounds)?;
    let points: Vec<_> = contacts.iter().map(|c| c.point).collect();
    let alpha = AlphaShape::of(&points)?;
    let radius = radius.unwrap_or_else(|| alpha.connecting_radius());
    let warnings = vec![
        "The bounds are those of the object's hull. The upper one holds if the contacts that were kept lie on the hull's \
         boundary, which contacts alone cannot prove."
            .to_owned(),
        "alpha_shape.ply and smooth_surface.ply are approximations of the object, no bounds.".to_owned(),
    ];
    let volume = alpha.volume(radius)?;
    // Of no tetrahedra: zero of either sign.
    let empty = (volume <= 0.0).then(|| {
        format!(
            "No part of the object is in an alpha shape of the radius {} m: the contacts are farther apart; it takes {} m to leave it in one piece.",
            brief_to(3, radius),
            brief_to(3, alpha.connecting_radius())
        )
    });
    let about = json!({
        "noise": "none",
        "concave": {
            "contacts_kept_for_the_upper_bound": kept.len(),
            "alpha_radius_m": radius,
            "alpha_volume_m3": volume.max(0.0),
        },
    });
    let drawn = Bounds {
        lower: Bound { mesh: lower.clone().unwrap_or_default(), volume: bounds.lower_volume() },
        upper: upper.clone().map(|mesh| Bound { mesh, volume: bounds.upper_volume() }),
        largest_gap: bounds.largest_gap(),
    };
    let comment = "alpha shape, an approximation and no bound; metres";
    let others = vec![("alpha_shape.ply", comment, own(alpha.mesh(radius)?)?)];
    let warnings = warnings.into_iter().chain(unbounded(&bounds)).chain(empty).collect();
    Ok((
        BoundsResult { drawn, lower, upper, others, features: None, contradiction: 0.0, warnings }.compared(),
        about,
    ))
}
