//! Sums over contacts from which the moments of any run of them follow at once.

use crate::matrix::outer;
use crate::noise::NoisyContact;
use glam::{DMat3, DVec3};

/// Noise below this share of the size, or so many rad, is taken to be so large: sums over a curve carry about as many digits.
const FLOOR: f64 = 1e-6;

/// Origin and length in which points are counted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    pub(super) centre: DVec3,
    /// The largest distance of a contact from the mean of all, m.
    pub(super) size: f64,
}

impl Units {
    pub(super) fn of(curves: &[Vec<NoisyContact>]) -> Self {
        let points = || curves.iter().flatten().map(|c| c.contact.point);
        let centre = points().sum::<DVec3>() / points().count().max(1) as f64;
        let size = points().map(|p| p.distance(centre)).fold(0.0, f64::max);
        Self { centre, size: if size > 0.0 { size } else { 1.0 } }
    }
}

/// Moments of a run: means are of points (in sizes from the centre) and normals, scatters about them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moments {
    pub(super) count: f64,
    pub(super) normal: DVec3,
    pub(super) points: DMat3,
    pub(super) normals: DMat3,
    /// Of points (columns: normals).
    pub(super) both: DMat3,
    /// Variance of a point along a tangent, in squared sizes, and of a normal, rad^2; what poses add does not average out.
    pub(super) point_variance: f64,
    pub(super) normal_variance: f64,
}

#[derive(Clone, Copy, Debug, Default)]
struct Row {
    p: DVec3,
    n: DVec3,
    pp: DMat3,
    nn: DMat3,
    pn: DMat3,
    own: [f64; 2],
    pose: [f64; 2],
}

/// Sums over the first contacts of a curve, from none to all.
#[derive(Clone, Debug)]
pub(super) struct Sums(Vec<Row>);

impl Sums {
    pub(super) fn new(curve: &[NoisyContact], units: &Units) -> Self {
        let mut sum = Row { pp: DMat3::ZERO, nn: DMat3::ZERO, pn: DMat3::ZERO, ..Row::default() };
        let mut rows = vec![sum];
        for contact in curve {
            let n = contact.contact.normal.get();
            let p = (contact.contact.point - units.centre) / units.size;
            sum.p += p;
            sum.n += n;
            sum.pp += outer(p, p);
            sum.nn += outer(n, n);
            sum.pn += outer(p, n);
            let (own, pose) = Self::of_one(contact);
            let square = units.size * units.size;
            sum.own[0] += own[0] / square;
            sum.own[1] += own[1];
            sum.pose[0] += pose[0] / square;
            sum.pose[1] += pose[1];
            rows.push(sum);
        }
        Self(rows)
    }

    /// Variances of a contact's point along a tangent (m^2) and of its normal about one (rad^2): its own, and by its pose.
    fn of_one(contact: &NoisyContact) -> ([f64; 2], [f64; 2]) {
        let n = contact.contact.normal.get();
        let trace = |m: DMat3| m.x_axis.x + m.y_axis.y + m.z_axis.z;
        let tangent = |m: DMat3| 0.5 * (trace(m) - n.dot(m * n)).max(0.0);
        let pose = &contact.noise.pose;
        let own = [tangent(contact.noise.point), contact.noise.normal.powi(2)];
        // A turn about the normal leaves it.
        (own, [tangent(pose.at(contact.contact.point)), tangent(pose.rotation)])
    }

    /// All of that together, where the body is of this size, m.
    pub(super) fn variances(contact: &NoisyContact, size: f64) -> [f64; 2] {
        let (own, pose) = Self::of_one(contact);
        [(own[0] + pose[0]).max((FLOOR * size).powi(2)), (own[1] + pose[1]).max(FLOOR * FLOOR)]
    }

    /// How many contacts there are.
    pub(super) fn len(&self) -> usize {
        self.0.len() - 1
    }

    /// Moments of the contacts from `first` to before `end`, at least one.
    pub(super) fn of(&self, first: usize, end: usize) -> Moments {
        let (a, b) = (&self.0[first], &self.0[end]);
        let count = (end - first) as f64;
        let (p, n) = ((b.p - a.p) / count, (b.n - a.n) / count);
        let about = |all: DMat3, x: DVec3, y: DVec3| all - outer(x, y) * count;
        // What is alike in all does not average out: it counts as often as there are contacts.
        let variance =
            |k: usize| ((b.own[k] - a.own[k]) / count + (b.pose[k] - a.pose[k]).max(0.0)).max(FLOOR * FLOOR);
        Moments {
            count,
            normal: n,
            points: about(b.pp - a.pp, p, p),
            normals: about(b.nn - a.nn, n, n),
            both: about(b.pn - a.pn, p, n),
            point_variance: variance(0),
            normal_variance: variance(1),
        }
    }
}
