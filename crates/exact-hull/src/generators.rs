//! Seeded inputs of the kinds on which hull algorithms are known to fail.

use crate::HalfSpace;
use crate::random::random_bits;
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;
use unit_direction::Direction;

/// Semi-axes of the ellipsoid on which the curve kinds lie: that of Fig. 5 of Moll and Erdmann (WAFR 2002).
pub const AXES: DVec3 = DVec3::new(2.5, 2.0, 1.0);

/// Support function of the ellipsoid with semi-axes [`AXES`].
#[must_use]
pub fn ellipsoid_support(n: DVec3) -> f64 {
    (AXES * n).length()
}

/// The half-spaces that touch the ellipsoid with semi-axes [`AXES`] where its outward normals are `normals`, of unit length.
pub fn ellipsoid_half_spaces(normals: &[DVec3]) -> Vec<HalfSpace> {
    let one = |n: &DVec3| HalfSpace {
        point: ellipsoid_point(*n),
        normal: Direction::new_unchecked(*n),
        margin: 0.0,
    };
    normals.iter().map(one).collect()
}

/// A reproducible source of numbers.
#[derive(Clone, Debug)]
pub struct Source(u64);

impl Source {
    /// A source; the same seed gives the same numbers.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(random_bits(seed ^ 0x5EED))
    }

    /// 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        random_bits(self.0)
    }

    /// Uniform in [0, 1).
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Uniform between `low` and `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// A whole number from 0 to `count - 1`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.bits() % count.max(1) as u64) as usize
    }

    /// Standard normal (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        (-2.0 * (1.0 - self.unit()).ln()).sqrt() * (TAU * self.unit()).cos()
    }

    /// Three independent standard normals.
    pub fn normal3(&mut self) -> DVec3 {
        DVec3::new(self.normal(), self.normal(), self.normal())
    }

    /// Uniform on the unit sphere.
    pub fn direction(&mut self) -> DVec3 {
        loop {
            let v = self.normal3();
            if v.length_squared() > 1e-12 {
                return v.normalize();
            }
        }
    }

    /// Uniform over rotations.
    pub fn rotation(&mut self) -> DQuat {
        let [x, y, z, w] = [(); 4].map(|()| self.normal());
        DQuat::from_xyzw(x, y, z, w).normalize()
    }
}

/// A kind of point set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// Three smooth curves on an ellipsoid.
    Curves,
    /// Uniform on a sphere.
    Sphere,
    /// A grid of latitudes and longitudes: many cocircular points, poles repeated.
    Grid,
    /// Points on a sphere, each several times.
    Duplicates,
    /// Points on a sphere, each several times, apart by rounding.
    NearDuplicates,
    /// Small whole numbers.
    Lattice,
    /// On the faces of a cube.
    CubeFaces,
    /// In an axis-aligned plane.
    Planar,
    /// In a tilted plane, rounded.
    TiltedPlanar,
    /// An ellipsoid 2.5 : 2 : 1e-3.
    Thin3,
    /// An ellipsoid 2.5 : 2 : 1e-6.
    Thin6,
    /// An ellipsoid 2.5 : 2 : 1e-9, rotated.
    Thin9,
    /// One arc of 0.1 rad.
    Arc,
    /// Three arcs of 0.01 rad.
    ThreeArcs,
    /// Clusters of size 1e-8.
    Clusters,
    /// A sphere 1e8 away from the origin.
    Offset,
    /// Curves in micrometres' place: scaled by 1e-6.
    Small,
    /// Curves scaled by 1e6.
    Large,
    /// Three planar sections of an ellipsoid, axis-aligned.
    Sections,
    /// Three planar sections of an ellipsoid, rotated.
    TiltedSections,
    /// On a line, rounded.
    TiltedLine,
    /// On a line along an axis.
    Line,
    /// One point again and again.
    Point,
}

impl InputKind {
    /// All kinds.
    pub const ALL: [Self; 23] = [
        Self::Curves,
        Self::Sphere,
        Self::Grid,
        Self::Duplicates,
        Self::NearDuplicates,
        Self::Lattice,
        Self::CubeFaces,
        Self::Planar,
        Self::TiltedPlanar,
        Self::Thin3,
        Self::Thin6,
        Self::Thin9,
        Self::Arc,
        Self::ThreeArcs,
        Self::Clusters,
        Self::Offset,
        Self::Small,
        Self::Large,
        Self::Sections,
        Self::TiltedSections,
        Self::TiltedLine,
        Self::Line,
        Self::Point,
    ];

    /// The dimension that every set of this kind with enough points has, where that is certain.
    #[must_use]
    pub fn dimension(self) -> Option<usize> {
        match self {
            Self::Point => Some(0),
            Self::Line => Some(1),
            Self::Planar => Some(2),
            // Rounding decides.
            Self::TiltedPlanar | Self::TiltedLine | Self::Arc | Self::NearDuplicates | Self::Lattice => None,
            _ => Some(3),
        }
    }

    /// `count` points of this kind.
    #[must_use]
    pub fn points(self, count: usize, seed: u64) -> Vec<DVec3> {
        let mut s = Source::new(seed ^ (self as u64) << 32);
        let turn = s.rotation();
        match self {
            Self::Curves => curves(count, &mut s),
            Self::Small => curves(count, &mut s).into_iter().map(|p| p * 1e-6).collect(),
            Self::Large => curves(count, &mut s).into_iter().map(|p| p * 1e6).collect(),
            Self::Sphere => (0..count).map(|_| s.direction()).collect(),
            Self::Offset => (0..count).map(|_| s.direction() + DVec3::new(1e8, -1e8, 1e8)).collect(),
            Self::Grid => grid(count),
            Self::Duplicates | Self::NearDuplicates => {
                duplicates(count, self == Self::NearDuplicates, &mut s)
            }
            Self::Lattice => {
                let mut c = || s.below(7) as f64 - 3.0;
                (0..count).map(|_| DVec3::new(c(), c(), c())).collect()
            }
            Self::CubeFaces => (0..count).map(|_| cube_face(&mut s)).collect(),
            Self::Planar => (0..count).map(|_| disc(&mut s) + DVec3::Z * 0.7).collect(),
            Self::TiltedPlanar => (0..count).map(|_| turn * disc(&mut s) + DVec3::splat(0.3)).collect(),
            Self::Thin3 => (0..count).map(|_| s.direction() * DVec3::new(2.5, 2.0, 1e-3)).collect(),
            Self::Thin6 => (0..count).map(|_| s.direction() * DVec3::new(2.5, 2.0, 1e-6)).collect(),
            Self::Thin9 => (0..count).map(|_| turn * (s.direction() * DVec3::new(2.5, 2.0, 1e-9))).collect(),
            Self::Arc => arcs(count, 1, 0.1, &mut s),
            Self::ThreeArcs => arcs(count, 3, 0.01, &mut s),
            Self::Clusters => {
                let centres: Vec<DVec3> = (0..6).map(|_| s.direction()).collect();
                (0..count).map(|i| centres[i % 6] + s.normal3() * 1e-8).collect()
            }
            Self::Sections => sections(count, DQuat::IDENTITY),
            Self::TiltedSections => sections(count, turn),
            Self::Line => (0..count).map(|_| DVec3::new(s.normal(), 0.25, -3.0)).collect(),
            Self::TiltedLine => {
                let d = s.direction();
                (0..count).map(|_| d * s.normal() + DVec3::splat(0.1)).collect()
            }
            Self::Point => vec![s.direction(); count],
        }
    }
}

/// Points of three smooth closed curves on the ellipsoid, like those of contacts on three palms.
fn curves(count: usize, s: &mut Source) -> Vec<DVec3> {
    curve_normals(count, s).into_iter().map(ellipsoid_point).collect()
}

/// Outward normals of an ellipsoid along three smooth closed curves.
pub fn curve_normals(count: usize, s: &mut Source) -> Vec<DVec3> {
    let starts = [(); 3].map(|()| (s.rotation(), s.unit() * TAU));
    (0..count)
        .map(|i| {
            let (turn, phase) = starts[i % 3];
            let t = (i / 3) as f64 / (count.div_ceil(3)) as f64 * TAU;
            turn * DVec3::new(t.cos(), t.sin(), 0.6 * (2.0 * t + phase).sin()).normalize()
        })
        .collect()
}

/// The point with outward normal `n` of the ellipsoid with semi-axes [`AXES`].
#[must_use]
pub fn ellipsoid_point(n: DVec3) -> DVec3 {
    AXES * AXES * n / (AXES * n).length()
}

fn grid(count: usize) -> Vec<DVec3> {
    let side = (count as f64).sqrt().ceil() as usize;
    (0..count)
        .map(|i| {
            let latitude = std::f64::consts::PI * (i / side) as f64 / side as f64;
            let longitude = TAU * (i % side) as f64 / side as f64;
            DVec3::new(latitude.sin() * longitude.cos(), latitude.sin() * longitude.sin(), latitude.cos())
        })
        .collect()
}

fn duplicates(count: usize, jitter: bool, s: &mut Source) -> Vec<DVec3> {
    let distinct: Vec<DVec3> = (0..(count / 10).max(4)).map(|_| s.direction()).collect();
    (0..count)
        .map(|i| {
            let p = distinct[i % distinct.len()];
            if jitter { p + s.normal3() * 1e-15 } else { p }
        })
        .collect()
}

fn cube_face(s: &mut Source) -> DVec3 {
    let mut p = [(); 3].map(|()| s.between(-1.0, 1.0));
    p[s.below(3)] = if s.bits() & 1 == 0 { 1.0 } else { -1.0 };
    DVec3::from_array(p)
}

fn disc(s: &mut Source) -> DVec3 {
    let angle = s.unit() * TAU;
    DVec3::new(angle.cos(), angle.sin(), 0.0) * s.unit().sqrt()
}

fn arcs(count: usize, arcs: usize, angle: f64, s: &mut Source) -> Vec<DVec3> {
    let turns: Vec<DQuat> = (0..arcs).map(|_| s.rotation()).collect();
    (0..count)
        .map(|i| {
            let t = (i / arcs) as f64 / (count.div_ceil(arcs)) as f64 * angle;
            ellipsoid_point(turns[i % arcs] * DVec3::new(t.cos(), t.sin(), 0.3 * t).normalize())
        })
        .collect()
}

fn sections(count: usize, turn: DQuat) -> Vec<DVec3> {
    (0..count)
        .map(|i| {
            let t = (i / 3) as f64 / (count.div_ceil(3)) as f64 * TAU;
            let circle = match i % 3 {
                0 => DVec3::new(t.cos(), t.sin(), 0.0),
                1 => DVec3::new(0.0, t.cos(), t.sin()),
                _ => DVec3::new(t.sin(), 0.0, t.cos()),
            };
            turn * (AXES * circle)
        })
        .collect()
}
