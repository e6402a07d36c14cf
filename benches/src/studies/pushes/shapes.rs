//! Outlines that are pushed.

use glam::DVec2;
use recon::object_dynamics::pushing::{ClosedLine, ClosedLineError};
use std::f64::consts::TAU;

/// Corners of the line that stands for a smooth outline.
const FINE: usize = 720;

/// A kind of outline, and its number of corners; none of a smooth one.
pub(super) struct Named {
    pub(super) name: &'static str,
    pub(super) corners: Option<usize>,
    /// Corners, or the radius at an angle, in units of 50 mm.
    made: Made,
}

enum Made {
    Corners(&'static [[f64; 2]]),
    Regular(usize),
    /// Semi-axes.
    Ellipse(f64, f64),
    /// `1 + a cos(k phi)`.
    Lobes(f64, f64),
}

pub(super) const SHAPES: [Named; 9] = [
    Named {
        name: "right triangle",
        corners: Some(3),
        made: Made::Corners(&[[-1.0, -1.0], [2.0, -1.0], [-1.0, 2.0]]),
    },
    Named {
        name: "flat triangle",
        corners: Some(3),
        made: Made::Corners(&[[-1.5, -0.6], [1.8, -0.6], [-0.3, 1.2]]),
    },
    Named {
        name: "rectangle",
        corners: Some(4),
        made: Made::Corners(&[[-1.2, -0.8], [1.2, -0.8], [1.2, 0.8], [-1.2, 0.8]]),
    },
    Named {
        name: "irregular pentagon",
        corners: Some(5),
        made: Made::Corners(&[[-1.0, -0.9], [0.9, -1.1], [1.4, 0.2], [0.1, 1.3], [-1.3, 0.4]]),
    },
    Named { name: "hexagon", corners: Some(6), made: Made::Regular(6) },
    Named { name: "ellipse 60 x 40 mm", corners: None, made: Made::Ellipse(1.2, 0.8) },
    Named { name: "ellipse 55 x 50 mm", corners: None, made: Made::Ellipse(1.1, 1.0) },
    Named { name: "three lobes", corners: None, made: Made::Lobes(0.08, 3.0) },
    Named { name: "butterfly (concave)", corners: None, made: Made::Lobes(0.3, 2.0) },
];

impl Named {
    /// In a size and about a centre that are drawn.
    pub(super) fn line(&self, draw: &mut Draw) -> Result<ClosedLine, ClosedLineError> {
        let unit = 0.05 * draw.between(0.7, 1.4);
        let around = |count: usize, at: &dyn Fn(f64) -> DVec2| -> Vec<DVec2> {
            (0..count).map(|j| at(TAU * j as f64 / count as f64)).collect()
        };
        let corners = match self.made {
            Made::Corners(corners) => corners.iter().map(|c| DVec2::from(*c)).collect(),
            Made::Regular(count) => around(count, &|phi| DVec2::from_angle(phi)),
            Made::Ellipse(a, b) => around(FINE, &|phi| DVec2::from_angle(phi) * DVec2::new(a, b)),
            Made::Lobes(a, k) => around(FINE, &|phi| DVec2::from_angle(phi) * (1.0 + a * (k * phi).cos())),
        };
        ClosedLine::new(corners.into_iter().map(|c| c * unit).collect())
    }
}

/// Numbers that a seed draws (SplitMix64).
pub(super) struct Draw(u64);

impl Draw {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    pub(super) fn between(&mut self, from: f64, to: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        from + (to - from) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}
