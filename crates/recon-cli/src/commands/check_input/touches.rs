//! What is understood of contacts or poses.

use super::{Readings, Understood};
use recon::shape_bounds::{BoundsError, ShapeBounds, planar};
use recon_io::{Touches, brief, brief_to};
use serde_json::json;

/// Normals of five digits or more pass for exact.
const EXACT_NORMALS: f64 = 1e-5;

const OF_THE_OBJECT: &str = "any one that is fixed to the object; normals point out of it";
const ABOVE_A_PLANE: &str = "body to world, z up, as unit quaternions and places of the body's origin";

pub(super) fn told(found: Touches) -> Understood {
    let (kind, frames, lengths, rounding, span) = match &found {
        Touches::Contacts { curves, rounding } => {
            let points = curves.iter().flatten().map(|contact| contact.point.to_array().to_vec());
            (
                "contacts in space",
                OF_THE_OBJECT,
                curves.iter().map(Vec::len).collect(),
                Some(*rounding),
                span(points),
            )
        }
        Touches::PlanarContacts { curves, rounding } => {
            let points = curves.iter().flatten().map(|contact| contact.point.to_array().to_vec());
            (
                "contacts in the plane",
                OF_THE_OBJECT,
                curves.iter().map(Vec::len).collect(),
                Some(*rounding),
                span(points),
            )
        }
        Touches::Poses(runs) => {
            let points = runs.iter().flatten().map(|pose| pose.p_WO.to_array().to_vec());
            (
                "poses above a plane",
                ABOVE_A_PLANE,
                runs.iter().map(Vec::len).collect::<Vec<_>>(),
                None,
                span(points),
            )
        }
    };
    let count = lengths.iter().sum::<usize>();
    let extents: Vec<String> = span.iter().map(|of| brief(*of)).collect();
    let mut lines = vec![
        ("kind".to_owned(), kind.to_owned()),
        (
            "units".to_owned(),
            format!("m, and {} of length 1", if rounding.is_some() { "normals" } else { "quaternions" }),
        ),
        ("frames".to_owned(), frames.to_owned()),
        ("rows".to_owned(), format!("{count} in {} curves or runs", lengths.len())),
        ("extent".to_owned(), format!("{} m along the axes", extents.join(" x "))),
    ];
    let mut warnings = Vec::new();
    if let Some(off) = rounding {
        lines.push(("lengths of normals".to_owned(), format!("off 1 by {} at most", brief_to(2, off))));
        if off > EXACT_NORMALS {
            warnings.push(
                "Normals are rounded too much for contacts that are taken as exact: state the noise, or let it be estimated \
                 (--estimate-noise)."
                    .to_owned(),
            );
        }
    }
    let widest = span.iter().fold(0.0, |a: f64, b| a.max(*b));
    if let Some((by, told)) = disagreement(&found) {
        match by {
            Some(by) if by < PLAINLY * widest => lines.push((
                "as exact contacts".to_owned(),
                format!("they contradict each other by {} m at least: take them for noisy", brief_to(2, by)),
            )),
            _ => warnings.push(format!("No body has these contacts: {told}.")),
        }
    }
    if span.iter().any(|of| *of > 100.0) {
        warnings.push(format!("The points are {} m apart: are they in metres?", brief(widest)));
    }
    let figures = json!({
        "kind": kind, "frames": frames, "rows": count, "curves": lengths, "extent_m": span, "normals_off_by": rounding,
    });
    Understood { lines, figures, warnings, readings: Readings::Touches(found) }
}

/// Contacts that contradict each other by more than this share of their extent are not so by noise.
const PLAINLY: f64 = 0.1;

/// Why contacts taken as exact are those of no body, and by how much (m) where one is beyond the tangent plane of another.
fn disagreement(found: &Touches) -> Option<(Option<f64>, String)> {
    match found {
        Touches::Contacts { curves, .. } => {
            let error = ShapeBounds::from_contacts(&curves.concat()).err()?;
            let by = if let BoundsError::Contradiction(of) = &error { Some(of.excess) } else { None };
            Some((by, error.to_string()))
        }
        Touches::PlanarContacts { curves, .. } => {
            let error = planar::ShapeBounds::from_contacts(&curves.concat()).err()?;
            let by = if let planar::BoundsError::Contradiction(of) = &error { Some(of.excess) } else { None };
            Some((by, error.to_string()))
        }
        Touches::Poses(_) => None,
    }
}

/// Extent of points along each axis.
fn span(points: impl Iterator<Item = Vec<f64>>) -> Vec<f64> {
    let mut ends: Vec<[f64; 2]> = Vec::new();
    for point in points {
        ends.resize(point.len(), [f64::INFINITY, f64::NEG_INFINITY]);
        for ([low, high], x) in ends.iter_mut().zip(point) {
            (*low, *high) = (low.min(x), high.max(x));
        }
    }
    ends.iter().map(|[low, high]| high - low).collect()
}
