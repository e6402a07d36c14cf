//! Geoms of a palm in MuJoCo.

use crate::export::xml::numbers;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::PalmSurface;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Angle between the rings of boxes that make a cup, and between the boxes of a ring, rad.
const RINGS: u32 = 30;
const SPACING: f64 = FRAC_PI_2 / RINGS as f64;

/// Type, size and place of the geoms of a palm; `towards`: where the object is, from the palm's origin, palm axes.
pub(super) fn geoms(surface: PalmSurface, moves: bool, broad: f64, towards: DVec3) -> Vec<String> {
    let one = match surface {
        PalmSurface::Plane if !moves => "type=\"plane\" size=\"0 0 1\"".to_owned(),
        PalmSurface::Plane => {
            // Planes cannot move in MuJoCo: the top of a box.
            format!("type=\"box\" size=\"{}\" pos=\"{}\"", numbers(&[broad; 3]), numbers(&[0.0, 0.0, -broad]))
        }
        PalmSurface::Sphere { radius } => format!("type=\"sphere\" size=\"{}\"", numbers(&[radius])),
        PalmSurface::Cylinder { radius } => {
            format!("type=\"cylinder\" size=\"{}\" zaxis=\"1 0 0\"", numbers(&[radius, broad]))
        }
        PalmSurface::Cup { radius } => return cup(radius, towards),
    };
    vec![one]
}

/// Boxes tangent to a hollow sphere from outside, over the half of it that is nearest to the object.
///
/// A tangent plane lies outside of the sphere: no box reaches into it, and what touches is where the nearest box has its centre, or
/// out by the sagitta `radius (1 / cos a - 1)` at most, `a` being [`farthest`].
fn cup(radius: f64, towards: DVec3) -> Vec<String> {
    let turn = DQuat::from_rotation_arc(DVec3::Z, towards.try_normalize().unwrap_or(DVec3::NEG_Z));
    let half = radius * farthest().tan();
    let thickness = 0.1 * radius;
    let size = numbers(&[half, half, thickness]);
    let place = |u: DVec3| {
        let (p, u) = ((turn * u) * (radius + thickness), turn * u);
        format!(
            "type=\"box\" size=\"{size}\" pos=\"{}\" zaxis=\"{}\"",
            numbers(&p.to_array()),
            numbers(&u.to_array())
        )
    };
    centres().into_iter().map(place).collect()
}

/// Largest angle between a direction of the half sphere and the nearest centre of a box, rad: half a spacing along the meridian and
/// half a spacing along the ring.
pub(super) fn farthest() -> f64 {
    SPACING * 0.5_f64.sqrt()
}

/// Centres of the boxes over the half sphere about z: rings from the pole, with centres evenly along each.
fn centres() -> Vec<DVec3> {
    let ring = |k: u32| {
        let polar = f64::from(k) * SPACING;
        let count = (TAU * polar.sin() / SPACING).ceil().max(1.0);
        (0..count as u32).map(move |j| {
            let (sin, cos) = (TAU * f64::from(j) / count).sin_cos();
            DVec3::new(polar.sin() * cos, polar.sin() * sin, polar.cos())
        })
    };
    (0..=RINGS).flat_map(ring).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_of_the_half_sphere_is_near_to_a_box() {
        let centres = centres();
        let mut worst = 0.0_f64;
        for k in 0..6_000_u32 {
            // Evenly over the half sphere: heights and angles without a rational ratio.
            let (z, a) = ((f64::from(k) + 0.5) / 6_000.0, 2.399_963_229_728_653 * f64::from(k));
            let r = (1.0 - z * z).sqrt();
            let u = DVec3::new(r * a.cos(), r * a.sin(), z);
            let nearest = centres.iter().map(|c| c.dot(u)).fold(-1.0, f64::max);
            worst = worst.max(nearest.min(1.0).acos());
        }
        assert!(worst <= farthest() && worst > 0.9 * farthest(), "{worst} {}", farthest());
    }
}
