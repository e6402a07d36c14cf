//! Bodies whose distance along each direction is known, and contacts of them.

use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::shape_bounds::ContactSample;
use shape_bounds::generators::{Source, scattered_normals, traced_normals};

/// Distance from the origin along a unit vector, and its gradient in space as if the vector were free.
type Radius = fn(DVec3) -> (f64, DVec3);

/// A body that the origin sees as a whole, about 1 m in size.
pub(super) struct Body {
    pub(super) name: &'static str,
    pub(super) convex: bool,
    radius: Radius,
}

pub(super) const BODIES: [Body; 4] = [
    Body { name: "egg", convex: true, radius: egg },
    Body { name: "rounded box", convex: true, radius: rounded_box },
    Body { name: "waist", convex: false, radius: waist },
    Body { name: "six dents", convex: false, radius: dents },
];

fn egg(d: DVec3) -> (f64, DVec3) {
    (1.0 + 0.1 * d.z.powi(3) + 0.2 * d.x * d.y, DVec3::new(0.2 * d.y, 0.2 * d.x, 0.3 * d.z * d.z))
}

/// `(x / 1.2)^4 + y^4 + (z / 0.8)^4 = 1`: smooth, with faces that are nearly flat.
fn rounded_box(d: DVec3) -> (f64, DVec3) {
    let axes = DVec3::new(1.2, 1.0, 0.8);
    let scaled = d / axes;
    let sum = scaled.powf(4.0).element_sum();
    (sum.powf(-0.25), scaled * scaled * scaled / axes * -sum.powf(-1.25))
}

fn waist(d: DVec3) -> (f64, DVec3) {
    (0.65 + 0.7 * d.z * d.z, DVec3::Z * (1.4 * d.z))
}

/// Dents about the ends of the axes.
fn dents(d: DVec3) -> (f64, DVec3) {
    (1.3 - 0.6 * d.powf(4.0).element_sum(), d * d * d * -2.4)
}

impl Body {
    /// The contact that the origin sees along `d` of unit length.
    pub(super) fn seen(&self, d: DVec3) -> Result<ContactSample, super::Failure> {
        let (radius, gradient) = (self.radius)(d);
        let normal = Direction::new(d * radius - gradient.reject_from_normalized(d))?;
        Ok(ContactSample { point: d * radius, normal })
    }

    /// Contacts in random directions, or along three closed curves, with noise of the points per axis (m) and of the normals (rad)
    /// alike.
    pub(super) fn touched(
        &self,
        (count, traced): (usize, bool),
        noise: f64,
        seed: u64,
    ) -> Result<Vec<ContactSample>, super::Failure> {
        let mut s = Source::new(seed);
        let directions =
            if traced { traced_normals(count, &mut s) } else { scattered_normals(count, &mut s) };
        let one = |d: DVec3| {
            let exact = self.seen(d)?;
            let normal = exact.normal.get() + s.normal3() * noise;
            Ok(ContactSample { point: exact.point + s.normal3() * noise, normal: Direction::new(normal)? })
        };
        directions.into_iter().map(one).collect()
    }

    /// Distance of a point from the surface, in m: the nearest place is looked for from that on the ray.
    pub(super) fn distance(&self, x: DVec3) -> Result<f64, super::Failure> {
        let mut d = x.try_normalize().ok_or("the centre has no direction")?;
        let mut least = f64::INFINITY;
        for _ in 0..30 {
            let place = self.seen(d)?;
            let to = x - place.point;
            least = least.min(to.length());
            d = (place.point + to.reject_from_normalized(place.normal.get())).normalize();
        }
        Ok(least)
    }
}
