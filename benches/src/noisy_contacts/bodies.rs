//! Bodies that are touched, and whether they lie between bounds.

use glam::{DQuat, DVec3};
use shape_bounds::exact_hull::Hull;
use shape_bounds::generators::{AXES, Source};
use shape_bounds::noise::CertainBounds;
use std::f64::consts::TAU;

/// What a vertex or a plane may be off by rounding, m, on bodies about 1 m in size.
const ROUNDING: f64 = 1e-12;
/// Bisections of the ray after which a number has no further digits.
const BISECTIONS: usize = 60;
/// Where a ray from the middle is surely outside, m: no body is that large.
const BEYOND: f64 = 10.0;
/// Steps to the normal at which a point is farthest outside of an egg, and the share of the way that each goes.
const STEPS: usize = 60;
const SHARE: f64 = 0.3;

/// A body about the origin; lengths in m.
#[derive(Clone, Copy, Debug)]
pub enum Body {
    /// With these semi-axes.
    Ellipsoid(DVec3),
    /// Support function `|axes n| + bulge n_z^3`.
    Egg {
        /// Of the ellipsoid, m.
        axes: DVec3,
        /// Of the third axis' cube, m.
        bulge: f64,
    },
    /// A box with a ball around it: flat faces, edges and corners of one radius.
    RoundedBox {
        /// Half of the edges of the box, m.
        half: DVec3,
        /// Of the ball, m.
        radius: f64,
    },
}

impl Body {
    /// A third each ellipsoids (every other one that of the paper's Fig. 5), eggs and rounded boxes.
    #[must_use]
    pub fn random(seed: u64, s: &mut Source) -> Self {
        match seed % 3 {
            0 if s.unit() < 0.5 => Self::Ellipsoid(AXES),
            0 => Self::Ellipsoid(lengths(0.8, 2.0, s)),
            1 => Self::Egg { axes: lengths(1.0, 1.5, s), bulge: s.between(0.03, 0.08) },
            _ => Self::RoundedBox { half: lengths(0.3, 0.9, s), radius: s.between(0.2, 0.6) },
        }
    }

    /// Largest semi-axis, or distance from the middle to a corner: what noise is relative to, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        match *self {
            Self::Ellipsoid(axes) | Self::Egg { axes, .. } => axes.max_element(),
            Self::RoundedBox { half, radius } => half.length() + radius,
        }
    }

    /// Exact points and normals on three closed curves, `count / 3` on each.
    #[must_use]
    pub fn curves(&self, count: usize, s: &mut Source) -> Vec<Vec<(DVec3, DVec3)>> {
        (0..3).map(|_| self.curve(count / 3, s.rotation(), s.unit() * TAU)).collect()
    }

    fn curve(&self, count: usize, turn: DQuat, phase: f64) -> Vec<(DVec3, DVec3)> {
        let contact = |k: usize| {
            let t = k as f64 / count as f64 * TAU;
            let along = DVec3::new(t.cos(), t.sin(), 0.6 * (2.0 * t + phase).sin());
            self.contact((turn * along).normalize())
        };
        (0..count).map(contact).collect()
    }

    /// Point and normal: of an ellipsoid or an egg where the normal is `d`, of a box where the ray along `d` leaves it, since
    /// nearly all normals belong to its corners.
    #[must_use]
    pub fn contact(&self, d: DVec3) -> (DVec3, DVec3) {
        match *self {
            Self::Ellipsoid(axes) => (with_normal(axes, 0.0, d), d),
            Self::Egg { axes, bulge } => (with_normal(axes, bulge, d), d),
            Self::RoundedBox { half, radius } => on_ray(half, radius, d),
        }
    }

    /// How far it reaches along a unit vector, m.
    #[must_use]
    pub fn support(&self, n: DVec3) -> f64 {
        match *self {
            Self::Ellipsoid(axes) => (axes * n).length(),
            Self::Egg { axes, bulge } => (axes * n).length() + bulge * n.z.powi(3),
            Self::RoundedBox { half, radius } => half.dot(n.abs()) + radius,
        }
    }

    /// By how much a point is outside, m, no more than it is; negative inside.
    fn outside(&self, point: DVec3) -> f64 {
        match *self {
            Self::Ellipsoid(axes) => ((point / axes).length() - 1.0) * axes.min_element(),
            Self::RoundedBox { half, radius } => beyond(half, point).length() - radius,
            Self::Egg { axes, bulge } => {
                let towards = |n: DVec3, _| (n + (point - with_normal(axes, bulge, n)) * SHARE).normalize();
                let n = (0..STEPS).fold(point.normalize(), towards);
                n.dot(point) - self.support(n)
            }
        }
    }

    /// Whether the body lies between the bounds; one that is left out says nothing that could be wrong.
    #[must_use]
    pub fn is_between(&self, bounds: &CertainBounds) -> bool {
        let lower = bounds.lower.as_ref().and_then(Hull::solid);
        let holds_lower = lower.is_none_or(|s| s.vertices().iter().all(|v| self.outside(*v) <= ROUNDING));
        let upper = bounds.upper.as_ref().map(|u| u.face_half_spaces());
        let holds_upper = upper.is_none_or(|faces| {
            faces.iter().all(|h| {
                let n = h.normal.get();
                self.support(n) <= n.dot(h.point) + h.margin + ROUNDING
            })
        });
        holds_lower && holds_upper
    }
}

fn lengths(low: f64, high: f64, s: &mut Source) -> DVec3 {
    DVec3::new(s.between(low, high), s.between(low, high), s.between(low, high))
}

/// Point of an ellipsoid (no bulge) or egg with normal `n`: the gradient of its support function.
fn with_normal(axes: DVec3, bulge: f64, n: DVec3) -> DVec3 {
    axes * axes * n / (axes * n).length() + bulge * (DVec3::Z * 3.0 * n.z * n.z - n * 2.0 * n.z.powi(3))
}

/// From the nearest point of the box to `point`.
fn beyond(half: DVec3, point: DVec3) -> DVec3 {
    point - point.clamp(-half, half)
}

fn on_ray(half: DVec3, radius: f64, d: DVec3) -> (DVec3, DVec3) {
    let (mut inside, mut outside) = (0.0, BEYOND);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (inside + outside);
        let is_inside = beyond(half, d * middle).length() < radius;
        *(if is_inside { &mut inside } else { &mut outside }) = middle;
    }
    let point = d * outside;
    (point, beyond(half, point).normalize())
}
