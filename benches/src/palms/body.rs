//! Seeded bodies of five families that a simulation can carry: smooth, of one size, of uniform density.

use super::shape::{PalmShape, Part, quadric};
use exploration::generators::Family;
use exploration::{Heading, Source};
use glam::{DMat3, DVec3};
use recon::contact_kinematics::{CurvatureRadii, Direction, SupportFunction, principal_radii};
use recon::object_dynamics::{MassError, MassProperties};

/// Half of the mean width of every body, m.
pub const SIZE: f64 = 0.04;
/// Largest radius of curvature over the size: hollow palms are wider than that.
pub const FLATTEST: f64 = 3.2;
/// Ball that is a part of every body, over the scale of its family: the least radius of curvature.
const LEAST_BALL: f64 = 0.1;
/// How much edges and faces of hulls, and creases of superquadrics, are bent, over the scale of the family.
const SOFT: f64 = 0.25;
/// Directions over which a body is averaged.
const LATTICE: usize = 6000;
/// What lies between them is taken to be flatter and sharper by this share at most.
const BETWEEN: f64 = 0.02;
/// Density, kg/m^3.
const DENSITY: f64 = 1000.0;

/// A smooth convex body of uniform density.
#[derive(Clone, Debug)]
pub struct PalmBody {
    /// Support function about the centre of mass, m.
    pub shape: PalmShape,
    /// Mass and inertia in the axes of the body.
    pub mass: MassProperties,
    /// Volume, m^3.
    pub volume: f64,
    /// Radius of the ball that was added, over the size.
    pub ball: f64,
}

/// The body of a family and seed, with the least ball added that leaves no radius of curvature above [`FLATTEST`] sizes.
///
/// # Errors
/// [`MassError`], which such bodies do not have.
pub fn palm_body(family: Family, seed: u64) -> Result<PalmBody, MassError> {
    let mut parts = parts(family, seed);
    let lattice = Direction::spread(LATTICE);
    let raw = shape(parts.clone(), 1.0, DVec3::ZERO);
    let (mean, largest) = (mean(&raw, &lattice), raw.radii_at(&lattice).max * (1.0 + BETWEEN));
    let ball = LEAST_BALL.max((largest - FLATTEST * mean) / (FLATTEST - 1.0));
    parts.push(Part::Ball(ball));
    let scale = SIZE / (mean + ball);
    let (_, centre, _) = integrals(&shape(parts.clone(), scale, DVec3::ZERO), &lattice);
    let mut shape = shape(parts, scale, centre);
    let radii = shape.radii_at(&lattice);
    shape.radii = CurvatureRadii { min: radii.min * (1.0 - BETWEEN), max: radii.max * (1.0 + BETWEEN) };
    let (volume, _, second) = integrals(&shape, &lattice);
    let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
    let inertia = (DMat3::from_diagonal(DVec3::splat(trace)) - second) * DENSITY;
    let mass = MassProperties::new(DENSITY * volume, inertia)?;
    Ok(PalmBody { shape, mass, volume, ball: ball / (mean + ball) })
}

fn shape(parts: Vec<Part>, scale: f64, shift: DVec3) -> PalmShape {
    PalmShape { parts, scale, shift, radii: CurvatureRadii { min: f64::NAN, max: f64::NAN } }
}

/// The families of the generators, in closed form and without corners or flats.
fn parts(family: Family, seed: u64) -> Vec<Part> {
    let mut source = Source::new(seed.wrapping_mul(8).wrapping_add(family as u64));
    let s = &mut source;
    let axes = |s: &mut Source, most: f64| {
        // From the longest to the shortest axis `most` at most.
        DVec3::new(1.0, 1.0 / s.between(1.0, most), 1.0 / s.between(1.0, most)) * s.between(0.5, 1.0)
    };
    match family {
        Family::Ellipsoid => vec![Part::Ellipsoid(quadric(axes(s, 3.0), s.rotation()))],
        Family::Sum => {
            let count = if s.unit() < 0.5 { 2 } else { 3 };
            (0..count).map(|_| Part::Ellipsoid(quadric(axes(s, 4.0), s.rotation()))).collect()
        }
        Family::Egg => egg(s),
        Family::Superquadric => {
            let (semi, p, turn) = (axes(s, 2.0), s.between(1.4, 5.0), s.rotation());
            let one = |k: usize| quadric(DVec3::splat(SOFT) + DVec3::AXES[k] * semi[k], turn);
            vec![Part::Norm { parts: [0, 1, 2].map(one), exponent: p / (p - 1.0) }]
        }
        Family::Rounded => {
            let count = 5 + (10.0 * s.unit()) as usize;
            let points = (0..count).map(|_| s.direction().get() * s.between(0.5, 1.0)).collect();
            vec![Part::Hull { points, soft: SOFT }]
        }
    }
}

/// Waves of degree 2 to 5 on a ball, as high as leaves its least radius of curvature above 0.1.
fn egg(s: &mut Source) -> Vec<Part> {
    let waves: Vec<(usize, f64, DVec3)> =
        (2..=5).flat_map(|l| [l; 2]).map(|l| (l, s.normal() / (l * l) as f64, s.direction().get())).collect();
    let scaled = |by: f64| {
        let of =
            |&(degree, height, axis): &(usize, f64, DVec3)| Part::Wave { degree, height: by * height, axis };
        waves.iter().map(of).collect::<Vec<_>>()
    };
    let low = shape(scaled(1.0), 1.0, DVec3::ZERO).radii_at(&Direction::spread(LATTICE)).min;
    let mut all = scaled(s.between(0.5, 1.0) * 0.9 / -low);
    all.push(Part::Ball(1.0));
    all
}

fn mean(shape: &PalmShape, lattice: &[Direction]) -> f64 {
    lattice.iter().map(|u| shape.value(*u)).sum::<f64>() / lattice.len() as f64
}

/// Volume (m^3), centroid (m) and second moments (m^5) of a body, over its surface: an element has the area of the product of the
/// principal radii a steradian.
fn integrals(shape: &PalmShape, lattice: &[Direction]) -> (f64, DVec3, DMat3) {
    let (mut volume, mut first, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    let steradians = 4.0 * std::f64::consts::PI / lattice.len() as f64;
    for u in lattice {
        let jet = shape.jet(*u);
        let [small, large] = principal_radii(jet.hessian, *u);
        let (x, cone) = (jet.point, jet.value * small * large * steradians);
        volume += cone / 3.0;
        first += x * (cone / 4.0);
        second += DMat3::from_cols(x * x.x, x * x.y, x * x.z) * (cone / 5.0);
    }
    (volume, first / volume, second)
}
