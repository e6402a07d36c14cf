//! Support functions of the five families in closed form: smooth, with exact Hessians, cheap.

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{CurvatureRadii, Direction, SupportFunction, SupportJet, principal_radii};

/// A part of a support function, m.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Part {
    /// `sqrt(n' M n)`, M in m^2.
    Ellipsoid(DMat3),
    /// `c P_l(n . a)` with a unit axis, c in m: a wave on a ball.
    Wave { degree: usize, height: f64, axis: DVec3 },
    /// The norm of exponent `q` of three ellipsoids: a superquadric with the dual exponent, its creases rounded.
    Norm { parts: [DMat3; 3], exponent: f64 },
    /// `soft log sum exp(p . n / soft)`: the hull of points with its edges and faces bent. The radii are variances of the points across `n` over
    /// `soft`, and `soft` times an entropy: never negative.
    Hull { points: Vec<DVec3>, soft: f64 },
    /// A ball, radius in m.
    Ball(f64),
}

/// A sum of parts, in m, about a point of its own: `scale (sum) - shift . n`.
#[derive(Clone, Debug, PartialEq)]
pub struct PalmShape {
    pub(super) parts: Vec<Part>,
    pub(super) scale: f64,
    pub(super) shift: DVec3,
    pub(super) radii: CurvatureRadii,
}

/// `R diag(axes^2) R'`, with semi-axes in m.
pub(super) fn quadric(axes: DVec3, turn: DQuat) -> DMat3 {
    let R = DMat3::from_quat(turn);
    R * DMat3::from_diagonal(axes * axes) * R.transpose()
}

fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn across(n: DVec3) -> DMat3 {
    DMat3::IDENTITY - outer(n, n)
}

impl Part {
    fn jet(&self, n: DVec3) -> SupportJet {
        match self {
            Self::Ellipsoid(M) => ellipsoid(*M, n),
            Self::Wave { degree, height, axis } => wave(*degree, *height, *axis, n),
            Self::Norm { parts, exponent } => norm(parts.map(|M| ellipsoid(M, n)), *exponent),
            Self::Hull { points, soft } => hull(points, *soft, n),
            Self::Ball(radius) => {
                SupportJet { value: *radius, point: n * *radius, hessian: across(n) * *radius }
            }
        }
    }
}

fn ellipsoid(M: DMat3, n: DVec3) -> SupportJet {
    let image = M * n;
    let value = n.dot(image).sqrt();
    let point = image / value;
    SupportJet { value, point, hessian: (M - outer(point, point)) * (1.0 / value) }
}

fn wave(degree: usize, height: f64, axis: DVec3, n: DVec3) -> SupportJet {
    let x = n.dot(axis);
    let [value, slope, bend] = legendre(degree, x);
    let side = axis - n * x;
    let hessian = outer(side, side) * bend + across(n) * (value - slope * x);
    let value = value * height;
    SupportJet { value, point: n * value + side * (slope * height), hessian: hessian * height }
}

/// Legendre polynomial with its first two derivatives, by the recurrence of each.
fn legendre(degree: usize, x: f64) -> [f64; 3] {
    let (mut before, mut now) = ([0.0; 3], [1.0, 0.0, 0.0]);
    for l in 0..degree {
        let l = l as f64;
        let times = [x * now[0], now[0] + x * now[1], 2.0 * now[1] + x * now[2]];
        let next = std::array::from_fn(|k| ((2.0 * l + 1.0) * times[k] - l * before[k]) / (l + 1.0));
        (before, now) = (now, next);
    }
    now
}

fn norm(parts: [SupportJet; 3], q: f64) -> SupportJet {
    let largest = parts.iter().map(|p| p.value).fold(0.0, f64::max);
    let value = largest * parts.iter().map(|p| (p.value / largest).powf(q)).sum::<f64>().powf(1.0 / q);
    let (mut point, mut hessian) = (DVec3::ZERO, DMat3::ZERO);
    for part in &parts {
        let share = part.value / value;
        let weight = share.powf(q - 1.0);
        point += part.point * weight;
        let bend = (q - 1.0) * weight / (share * value);
        hessian += part.hessian * weight + outer(part.point, part.point) * bend;
    }
    hessian += outer(point, point) * ((1.0 - q) / value);
    SupportJet { value, point, hessian }
}

fn hull(points: &[DVec3], soft: f64, n: DVec3) -> SupportJet {
    let most = points.iter().map(|p| p.dot(n)).fold(f64::NEG_INFINITY, f64::max);
    let (mut sum, mut mean, mut second) = (0.0, DVec3::ZERO, DMat3::ZERO);
    for p in points {
        let weight = ((p.dot(n) - most) / soft).exp();
        sum += weight;
        mean += *p * weight;
        second += outer(*p, *p) * weight;
    }
    mean /= sum;
    let value = most + soft * sum.ln();
    let entropy = value - mean.dot(n);
    let spread = across(n) * (second * (1.0 / sum) - outer(mean, mean)) * across(n);
    let point = mean + n * entropy;
    SupportJet { value, point, hessian: spread * (1.0 / soft) + across(n) * entropy }
}

impl PalmShape {
    /// Smallest and largest principal radius at some directions, m.
    pub(super) fn radii_at(&self, lattice: &[Direction]) -> CurvatureRadii {
        let none = CurvatureRadii { min: f64::INFINITY, max: 0.0 };
        lattice.iter().fold(none, |all, u| {
            let [small, large] = principal_radii(self.jet(*u).hessian, *u);
            CurvatureRadii { min: all.min.min(small), max: all.max.max(large) }
        })
    }
}

impl SupportFunction for PalmShape {
    fn jet(&self, n: Direction) -> SupportJet {
        let none = SupportJet { value: 0.0, point: DVec3::ZERO, hessian: DMat3::ZERO };
        let sum = self.parts.iter().map(|part| part.jet(n.get())).fold(none, |a, b| SupportJet {
            value: a.value + b.value,
            point: a.point + b.point,
            hessian: a.hessian + b.hessian,
        });
        SupportJet {
            value: self.scale * sum.value - self.shift.dot(n.get()),
            point: self.scale * sum.point - self.shift,
            hessian: sum.hessian * self.scale,
        }
    }

    /// From a lattice, with a margin for what is between its directions.
    fn curvature_radii(&self) -> CurvatureRadii {
        self.radii
    }
}
