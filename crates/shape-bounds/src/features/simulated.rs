//! Bodies with corners and faces, touched by palms and fingertips, with the truth.

use super::FeatureKind;
use crate::distance::nearest;
use crate::generators::Source;
use crate::noise::{ContactNoise, NoisyContact};
use crate::sample::ContactSample;
use contact_kinematics::Direction;
use glam::DVec3;
use std::f64::consts::TAU;

/// Corners whose heights differ by less than this share of the size are on one face.
const LEVEL: f64 = 1e-9;

/// A body that is touched.
#[derive(Clone, Debug, PartialEq)]
pub enum TouchedBody {
    /// A polytope of these corners (m), with a ball of this radius (m) around it, which may be nothing.
    Polytope(Vec<DVec3>, f64),
    /// An ellipsoid of these semi-axes, m.
    Ellipsoid(DVec3),
}

/// How it is touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Touching {
    /// By a flat palm: the normal sweeps, and the contact stays at a corner or jumps to the next.
    Palm,
    /// By a fingertip whose centre goes around the body in a distance from it of up to this share of its size.
    Fingertip(f64),
}

/// Contacts with their noise, curve by curve, and what the body is like at each.
#[derive(Clone, Debug, Default)]
pub struct Touched {
    /// As measured.
    pub curves: Vec<Vec<NoisyContact>>,
    /// Without noise.
    pub exact: Vec<Vec<ContactSample>>,
    /// The truth.
    pub kinds: Vec<Vec<FeatureKind>>,
}

impl TouchedBody {
    /// A box about the origin with these half edges and rounding, m.
    #[must_use]
    pub fn cuboid(half: DVec3, rounding: f64) -> Self {
        let sign = |bit: u32| if bit == 0 { -1.0 } else { 1.0 };
        let corner = |k: u32| half * DVec3::new(sign(k & 1), sign(k & 2), sign(k & 4));
        Self::Polytope((0..8).map(corner).collect(), rounding)
    }

    /// A wedge: a right triangle in x and z, drawn out along y.
    #[must_use]
    pub fn wedge(length: f64, height: f64, half_width: f64) -> Self {
        let corner = |x: f64, y: f64, z: f64| {
            DVec3::new((x - 1.0 / 3.0) * length, y * half_width, (z - 1.0 / 3.0) * height)
        };
        let side = |y: f64| [corner(0.0, y, 0.0), corner(1.0, y, 0.0), corner(0.0, y, 1.0)];
        Self::Polytope([side(-1.0), side(1.0)].concat(), 0.0)
    }

    /// The largest distance of a point from the origin, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        match self {
            Self::Polytope(corners, rounding) => {
                corners.iter().map(|v| v.length()).fold(0.0, f64::max) + rounding
            }
            Self::Ellipsoid(axes) => axes.max_element(),
        }
    }

    /// Height of the body along `n`, m.
    #[must_use]
    pub fn support(&self, n: DVec3) -> f64 {
        match self {
            Self::Polytope(corners, rounding) => {
                corners.iter().map(|v| v.dot(n)).fold(f64::NEG_INFINITY, f64::max) + rounding * n.length()
            }
            Self::Ellipsoid(axes) => (*axes * n).length(),
        }
    }

    /// How far `point` is outside of the body at most, m; zero or less inside.
    #[must_use]
    pub fn outside(&self, point: DVec3) -> f64 {
        match self {
            Self::Polytope(corners, rounding) => nearest(point, &[], farthest(corners)).certified - rounding,
            Self::Ellipsoid(axes) => ((point / *axes).length() - 1.0) * axes.max_element(),
        }
    }

    fn by_palm(&self, n: DVec3) -> (ContactSample, FeatureKind) {
        let point = match self {
            Self::Polytope(corners, rounding) => farthest(corners)(n) + *rounding * n,
            Self::Ellipsoid(axes) => *axes * *axes * n / (*axes * n).length(),
        };
        (ContactSample { point, normal: Direction::new_unchecked(n) }, self.kind(n))
    }

    fn by_fingertip(&self, centre: DVec3) -> (ContactSample, FeatureKind) {
        let Self::Polytope(corners, rounding) = self else {
            return self.by_palm(centre.normalize_or(DVec3::X));
        };
        let near = nearest(centre, &[], farthest(corners));
        let n = near.direction;
        (
            ContactSample { point: near.point + *rounding * n, normal: Direction::new_unchecked(n) },
            self.kind(n),
        )
    }

    /// Rounded corners and edges are smooth.
    fn kind(&self, n: DVec3) -> FeatureKind {
        let Self::Polytope(corners, rounding) = self else { return FeatureKind::Smooth };
        let top = corners.iter().map(|v| v.dot(n)).fold(f64::NEG_INFINITY, f64::max);
        match corners.iter().filter(|v| v.dot(n) >= top - LEVEL.sqrt() * self.size()).count() {
            0..=2 if *rounding > 0.0 => FeatureKind::Smooth,
            0 | 1 => FeatureKind::Corner,
            2 => FeatureKind::Edge,
            _ => FeatureKind::Face,
        }
    }

    /// Touches it `samples` times along a curve for each of `how`, with noise of points (a share of the size) per axis and of normals about
    /// each tangent axis (as many rad).
    #[must_use]
    pub fn touched(&self, how: &[Touching], samples: usize, noise: f64, seed: u64) -> Touched {
        let mut source = Source::new(seed ^ 0xC0_41E5);
        let size = self.size();
        let stated = ContactNoise::isotropic(noise * size, noise);
        let mut all = Touched::default();
        for touching in how {
            let path = Path::new(&mut source);
            let (mut curve, mut exact, mut kinds) = (Vec::new(), Vec::new(), Vec::new());
            for k in 0..samples {
                let u = path.at(k as f64 / samples as f64);
                let (contact, kind) = match touching {
                    Touching::Palm => self.by_palm(u.normalize_or(DVec3::X)),
                    Touching::Fingertip(share) => {
                        let u = u.normalize_or(DVec3::X);
                        // Outside of the body whatever its form.
                        self.by_fingertip(u * size * (1.05 + share))
                    }
                };
                let (a, b) = contact.normal.tangent_basis();
                let turned = contact.normal.get() + (a * source.normal() + b * source.normal()) * noise;
                let measured = ContactSample {
                    point: contact.point + source.normal3() * (noise * size),
                    normal: Direction::new_unchecked(turned.normalize()),
                };
                curve.push(NoisyContact { contact: measured, noise: stated });
                exact.push(contact);
                kinds.push(kind);
            }
            all.curves.push(curve);
            all.exact.push(exact);
            all.kinds.push(kinds);
        }
        all
    }
}

/// The corner that is farthest along a direction.
fn farthest(corners: &[DVec3]) -> impl Fn(DVec3) -> DVec3 + '_ {
    |n| corners.iter().copied().fold(corners[0], |best, v| if v.dot(n) > best.dot(n) { v } else { best })
}

/// A smooth path of directions: sums of waves in each coordinate.
struct Path([[(f64, f64, f64); WAVES]; 3]);

const WAVES: usize = 3;
/// Waves over a path at most.
const FASTEST: f64 = 2.5;

impl Path {
    fn new(source: &mut Source) -> Self {
        Self(std::array::from_fn(|_| {
            std::array::from_fn(|_| (source.normal(), FASTEST * source.unit(), TAU * source.unit()))
        }))
    }

    fn at(&self, t: f64) -> DVec3 {
        DVec3::from_array(self.0.map(|waves| {
            waves.iter().map(|&(size, rate, phase)| size * (TAU * rate * t + phase).sin()).sum()
        }))
    }
}
