//! Seeded bodies and contacts.

use super::Failure;
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{
    Direction, MinkowskiSum, PolynomialSupport, Sphere, SupportFunction, Translated,
};
use shape_bounds::ContactSample;
use shape_bounds::fit::{ShapeFamily, SkewEllipsoid, Superquadric};
use shape_bounds::generators::{Source, scattered_normals, traced_normals};
use shape_bounds::noise::{ContactNoise, NoisyContact};

/// Seeded bodies, one new for each run, all about 1 m in size.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Truth {
    Sphere,
    Ellipsoid,
    Superquadric,
    Harmonics,
    RoundedBox,
}

impl Truth {
    pub(super) const ALL: [(Self, &'static str, Option<ShapeFamily>); 5] = [
        (Self::Sphere, "ball", Some(ShapeFamily::Sphere)),
        (Self::Ellipsoid, "ellipsoid, axes 0.5 to 2", Some(ShapeFamily::Ellipsoid)),
        (Self::Superquadric, "superquadric, exponents 0.8, 1.25", Some(ShapeFamily::Superquadric)),
        (Self::Harmonics, "harmonics to degree 4", Some(ShapeFamily::Harmonics { degree: 4 })),
        (Self::RoundedBox, "superquadric 0.4 plus ball of 0.3", None),
    ];

    pub(super) fn body(self, s: &mut Source) -> Result<Box<dyn SupportFunction>, Failure> {
        let turn = DMat3::from_quat(s.rotation());
        Ok(match self {
            Self::Sphere => {
                Box::new(Translated { body: Sphere::new(s.between(0.5, 2.0))?, offset: s.normal3() })
            }
            Self::Ellipsoid => {
                let axes = DVec3::new(s.between(0.5, 2.0), s.between(0.5, 2.0), s.between(0.5, 2.0));
                let matrix = turn * DMat3::from_diagonal(axes * axes) * turn.transpose();
                Box::new(SkewEllipsoid::new(s.normal3(), matrix)?)
            }
            Self::Superquadric => {
                let axes = DVec3::new(1.0, 0.8, 1.4);
                Box::new(Superquadric::new(s.normal3() * 0.2, axes, s.rotation(), [0.8, 1.25])?)
            }
            // Drawn again until it is convex.
            Self::Harmonics => loop {
                let mut rows = vec![vec![3.5], vec![0.1, -0.1, 0.05]];
                for l in 2..=4usize {
                    rows.push((0..=2 * l).map(|_| s.normal() * 0.25 / (l * l) as f64).collect());
                }
                let body = PolynomialSupport::from_harmonics(&rows)?;
                if body.curvature_radii().min > 0.1 {
                    break Box::new(body);
                }
            },
            Self::RoundedBox => {
                let core =
                    Superquadric::new(DVec3::ZERO, DVec3::new(0.8, 0.6, 1.0), s.rotation(), [0.4, 0.4])?;
                Box::new(MinkowskiSum(core, Sphere::new(0.3)?))
            }
        })
    }
}

/// Contacts with points off by `noise` (m per axis) and normals by as much (rad per tangent axis).
pub(super) fn measured(
    body: &dyn SupportFunction,
    normals: &[DVec3],
    noise: f64,
    s: &mut Source,
) -> Result<Vec<NoisyContact>, Failure> {
    normals
        .iter()
        .map(|n| {
            let n = Direction::new(*n)?;
            let (a, b) = n.tangent_basis();
            let normal = Direction::new(n.get() + (a * s.normal() + b * s.normal()) * noise)?;
            let contact = ContactSample { point: body.point(n) + s.normal3() * noise, normal };
            Ok(NoisyContact { contact, noise: ContactNoise::isotropic(noise, noise) })
        })
        .collect()
}

/// Normals scattered over the sphere, or along three closed curves as three palms trace them.
pub(super) fn normals(count: usize, curves: bool, s: &mut Source) -> Vec<DVec3> {
    if curves { traced_normals(count, s) } else { scattered_normals(count, s) }
}

/// Exact contacts, with a small noise stated.
pub(super) fn exact(body: &dyn SupportFunction, normals: &[DVec3]) -> Result<Vec<NoisyContact>, Failure> {
    let mut contacts = measured(body, normals, 0.0, &mut Source::new(0))?;
    contacts.iter_mut().for_each(|c| c.noise = ContactNoise::isotropic(1e-3, 1e-3));
    Ok(contacts)
}
