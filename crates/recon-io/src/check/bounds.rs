//! Lower and upper bound against each other and against what is stated of them.

use super::figures::warns;
use super::{Fault, Found, rounding};
use crate::TriangleMesh;
use certificate::{Flaw, Outline, Solid, Surface};
use glam::DVec2;
use serde_json::Value;
use std::f64::consts::PI;

/// Contradictions above this share of the size are worth a warning.
const NOTABLE: f64 = 1e-6;

/// Dents up to this share of the reach are rounding: where planes meet at an angle of 1e-9 to 1e-3, as those of contacts
/// next to each other on a curve or on a flat side do, the corner of three is off by as much more than the planes are.
const DENTS: f64 = 1e-7;

/// Sums over the same surface, about other points and in another order, that may be off each by their rounding.
const SUMS: f64 = 4.0;
/// Sizes of bounds that are one, as where both limits on curvature are the same, differ by rounding: as a share of them.
const ALIKE: f64 = 1e-12;

/// How far the first of two closed surfaces stands out of the second, m: the largest distance of a corner outside, 0 where
/// all are inside, infinite out of what is no surface.
#[must_use]
pub fn stands_out(lower: &TriangleMesh, upper: &TriangleMesh) -> f64 {
    let Ok(upper) = upper.surface() else { return f64::INFINITY };
    Solid::new(&upper).farthest_outside(&lower.vertices).map_or(0.0, |(_, distance)| distance)
}

/// The same of two convex outlines, corners counter-clockwise.
#[must_use]
pub fn outline_stands_out(lower: &[DVec2], upper: &[DVec2]) -> f64 {
    let upper = Outline::new(upper.to_vec());
    upper.farthest_outside(lower, rounding(upper.reach())).map_or(0.0, |(_, distance)| distance)
}

/// A bound as it was read.
struct Bound {
    file: String,
    /// m^3 or m^2.
    size: f64,
    /// m^2 or m.
    boundary: f64,
    /// Largest coordinate, m, and the number of terms that `size` is a sum of.
    reach: f64,
    terms: usize,
    /// What rounding may make of `size` beside that.
    rounding: f64,
    not_convex: Option<Fault>,
}

impl Bound {
    fn of_surface(file: &str, surface: &Surface, drawn: f64) -> Self {
        let (size, reach) = (surface.size(), surface.reach());
        Self {
            file: file.to_owned(),
            size: size.volume,
            boundary: size.area,
            reach,
            terms: surface.triangles().len(),
            rounding: size.rounding,
            not_convex: surface.not_convex(drawn + DENTS * reach).map(|flaw| fault(file, flaw)),
        }
    }

    fn of_outline(file: &str, outline: &Outline, drawn: f64) -> Self {
        let ((size, boundary), reach) = (outline.size(), outline.reach());
        let not_convex = outline.not_convex(drawn + DENTS * reach).map(|flaw| fault(file, flaw));
        Self {
            file: file.to_owned(),
            size,
            boundary,
            reach,
            terms: outline.corners().len(),
            rounding: 0.0,
            not_convex,
        }
    }

    /// How far the size of the boundary as written may be from that of the bound, whose boundary is nowhere farther than
    /// `t` from it (Steiner), with a rounding in each term of the sum.
    fn tolerance(&self, drawn: f64, in_space: bool) -> f64 {
        let t = drawn + rounding(self.reach);
        let summed = self.terms as f64 * f64::EPSILON * self.boundary * self.reach;
        let curved =
            if in_space { 4.0 * PI * self.reach * t * t + 4.0 / 3.0 * PI * t.powi(3) } else { PI * t * t };
        t * self.boundary + curved + summed + SUMS * self.rounding
    }
}

fn fault(file: &str, flaw: Flaw) -> Fault {
    let file = file.to_owned();
    match flaw {
        Flaw::Open(edge) => Fault::Open { file, edge },
        Flaw::NotConvex(why) => Fault::NotConvex { file, why },
    }
}

impl Found {
    /// Checks the bounds that the summary speaks of, in space or in the plane.
    pub(super) fn check_bounds(&mut self) {
        let Some(summary) = self.summary.take() else { return };
        let stated = &summary["bounds"];
        let in_space = stated.get("lower_volume_m3").is_some();
        if in_space || stated.get("lower_area_m2").is_some() {
            self.check_stated(&summary, in_space);
        } else {
            let drawn =
                self.surfaces.keys().chain(self.outlines.keys()).find(|name| name.contains("_bound."));
            if let Some(file) = drawn.cloned() {
                self.faults.push(Fault::Unpaired { file });
            }
        }
        self.summary = Some(summary);
    }

    fn check_stated(&mut self, summary: &Value, in_space: bool) {
        let (unit, ending, size) =
            if in_space { ("m^3", "ply", "volume_m3") } else { ("m^2", "csv", "area_m2") };
        let key = if in_space { "mesh_tolerance_m" } else { "outline_tolerance_m" };
        let drawn = summary["about"][key].as_f64().unwrap_or(0.0);
        let mut sizes = Vec::new();
        for name in ["lower", "upper"] {
            let file = format!("{name}_bound.{ending}");
            let stated = summary["bounds"][format!("{name}_{size}")].as_f64();
            sizes.push(stated);
            let bound = if in_space {
                self.surfaces.get(&file).map(|surface| Bound::of_surface(&file, surface, drawn))
            } else {
                self.outlines.get(&file).map(|outline| Bound::of_outline(&file, outline, drawn))
            };
            match (bound, stated) {
                (None, None | Some(0.0)) => {}
                (Some(bound), Some(stated)) => {
                    self.check_size(&bound, stated, bound.tolerance(drawn, in_space), unit)
                }
                _ => self.faults.push(Fault::Unpaired { file }),
            }
        }
        if let [Some(lower), Some(upper)] = sizes[..]
            && lower > upper * (1.0 + ALIKE)
        {
            self.faults.push(Fault::Crossed { lower, upper });
        }
        self.check_inside(summary, &format!("lower_bound.{ending}"), &format!("upper_bound.{ending}"), drawn);
    }

    fn check_size(&mut self, bound: &Bound, stated: f64, tolerance: f64, unit: &'static str) {
        let Bound { file, size: found, .. } = bound;
        self.faults.extend(bound.not_convex.clone());
        if (found - stated).abs() <= tolerance {
            self.held.push(format!("{file}: closed, convex, {stated:.6e} {unit} as stated"));
        } else {
            let (file, found) = (file.clone(), *found);
            self.faults.push(Fault::Size { file, found, stated, tolerance, unit });
        }
    }

    fn check_inside(&mut self, summary: &Value, lower: &str, upper: &str, drawn: f64) {
        let (farthest, reach) =
            if let Some((lower, upper)) = self.surfaces.get(lower).zip(self.surfaces.get(upper)) {
                (Solid::new(upper).farthest_outside(lower.corners()), upper.reach())
            } else if let Some((lower, upper)) = self.outlines.get(lower).zip(self.outlines.get(upper)) {
                (upper.farthest_outside(lower.corners(), rounding(upper.reach())), upper.reach())
            } else {
                return;
            };
        let stated = summary["bounds"]["contradiction_m"].as_f64().unwrap_or(0.0);
        if stated > NOTABLE * reach && !warns(summary) {
            self.faults.push(Fault::Contradiction { distance: stated });
        }
        let allowed = stated + drawn + rounding(reach);
        match farthest {
            Some((corner, distance)) if distance > allowed => {
                self.faults.push(Fault::Outside { file: lower.to_owned(), corner, distance, allowed });
            }
            Some((_, distance)) => {
                self.held.push(format!("{lower} is inside {upper}, to {distance:.1e} m of {allowed:.1e} m"));
            }
            None => self.held.push(format!("{lower} is inside {upper}")),
        }
    }
}
