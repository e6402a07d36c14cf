//! What contacts say of a planar body: hull, half-planes, and both tightened by limits on the curvature.

use super::{Chart, Drawn};
use crate::diagram::{Outlines, Stroke};
use crate::{Budget, Diagram};
use glam::DVec2;
use recon::contact_kinematics::planar::{FourierBody, RadiusBounds, RadiusFunction};
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::curvature::CurvatureBounds;
use recon::shape_bounds::planar::{ContactSample, ShapeBounds};
use std::f64::consts::TAU;

pub(super) const CHART: Chart =
    Chart { name: "planar-bounds", about: "a planar body between its bounds, from seven contacts", draw };

/// Normal directions of the contacts, in rad.
const CONTACTS: [f64; 7] = [0.2, 1.0, 1.9, 2.9, 3.8, 4.6, 5.6];
const STEPS: usize = 360;

fn draw(_: Budget) -> Drawn {
    let body = FourierBody::new(&[0.05, 0.0, 0.006, 0.002], &[0.0, 0.0, 0.0, 0.0012])?;
    let contact =
        |angle: &f64| ContactSample { point: body.point(*angle), normal: Direction::from_angle(*angle) };
    let contacts: Vec<ContactSample> = CONTACTS.iter().map(contact).collect();
    let own = body.radius_bounds();
    // What one may know beforehand: a margin of a tenth around the true limits.
    let radii = RadiusBounds { min: 0.9 * own.min, max: 1.1 * own.max };
    let plain = ShapeBounds::from_contacts(&contacts)?;
    let curved = CurvatureBounds::from_contacts(&contacts, radii)?;
    let lower = plain.lower().polygon().ok_or("contacts on a line")?.shape();
    let upper = plain.upper().bounded().ok_or("contacts on one side")?.shape();
    let gap = plain.largest_gap().ok_or("no gap")?;
    let truth = polygon_area(&outline(&body));
    let subtitle = format!(
        "areas over the true one: hull {:.3}, inner discs {:.3}, outer discs {:.3}, half-planes {:.3}; largest gap {:.1} mm",
        plain.lower_area() / truth,
        curved.lower().area() / truth,
        curved.upper().area() / truth,
        plain.upper_area() / truth,
        gap.distance * 1e3,
    );
    let pairs = |points: &[DVec2]| points.iter().map(|p| (p.x, p.y)).collect::<Vec<_>>();
    let outlines = Outlines::new("planar-bounds", "What seven contacts say of a planar body", subtitle)
        .outline("half-planes", pairs(upper.vertices()), Stroke::Line)
        .outline("outer discs", pairs(&disc_outline(&curved, radii.max)), Stroke::Line)
        .outline("inner discs", pairs(&grown(&curved)), Stroke::Line)
        .outline("hull", pairs(lower.vertices()), Stroke::Line)
        .outline("the body", pairs(&outline(&body)), Stroke::Ink)
        .outline("contacts", contacts.iter().map(|c| (c.point.x, c.point.y)).collect(), Stroke::Points);
    Ok(vec![Diagram::Outlines(outlines)])
}

fn angles() -> impl Iterator<Item = f64> {
    (0..STEPS).map(|k| TAU * k as f64 / STEPS as f64)
}

fn outline(body: &FourierBody) -> Vec<DVec2> {
    angles().map(|angle| body.point(angle)).collect()
}

fn polygon_area(points: &[DVec2]) -> f64 {
    let next = points.iter().cycle().skip(1);
    0.5 * points.iter().zip(next).map(|(a, b)| a.perp_dot(*b)).sum::<f64>()
}

/// Outline of the hull of the inner discs.
fn grown(bounds: &CurvatureBounds) -> Vec<DVec2> {
    let lower = bounds.lower();
    let corners = lower.core().polygon().map_or(&[][..], |p| p.shape().vertices());
    let farthest = |n: DVec2| corners.iter().copied().max_by(|a, b| a.dot(n).total_cmp(&b.dot(n)));
    angles()
        .filter_map(|angle| {
            let n = DVec2::from_angle(angle);
            Some(farthest(n)? + n * lower.radius())
        })
        .collect()
}

/// Outline of the intersection of the outer discs, whose sides are in order around it.
fn disc_outline(bounds: &CurvatureBounds, radius: f64) -> Vec<DVec2> {
    let sides = bounds.upper().sides().iter();
    sides
        .flat_map(|side| {
            let centre = side.from - DVec2::from_angle(side.start) * radius;
            (0..16).map(move |k| {
                centre + DVec2::from_angle(side.start + side.angle * f64::from(k) / 16.0) * radius
            })
        })
        .collect()
}
