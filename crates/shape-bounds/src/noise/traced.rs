//! Curves of contacts as their noise is judged, in space and in the plane.

use super::model::NoisyContact;
use crate::median::{OF_NORMAL, median};
use glam::{DMat3, DVec3};

/// Fewest contacts of a curve that its noise is judged from.
pub(crate) const FEWEST: usize = 30;

/// Contacts in the order in which they were traced, in space, or in its plane `z = 0` as a space of two dimensions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Traced<'a> {
    pub(crate) contacts: &'a [NoisyContact],
    pub(crate) dimension: usize,
}

/// A part of the noise of a contact that has a level of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Part {
    Across,
    Along,
    Normal,
}

impl Part {
    pub(crate) const ALL: [Self; 3] = [Self::Across, Self::Along, Self::Normal];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Across => "point across the surface",
            Self::Along => "point along the surface",
            Self::Normal => "normal",
        }
    }

    pub(crate) fn value(self, c: &NoisyContact) -> DVec3 {
        if self == Self::Normal { c.contact.normal.get() } else { c.contact.point }
    }

    /// Components of a difference of values at a contact; how many there are.
    pub(crate) fn components(self, c: &NoisyContact, dimension: usize, v: DVec3) -> ([f64; 2], usize) {
        let n = c.contact.normal.get();
        match (self, dimension) {
            (Self::Across, _) => ([n.dot(v), 0.0], 1),
            (_, 2) => ([DVec3::Z.cross(n).dot(v), 0.0], 1),
            _ => {
                let (a, b) = n.any_orthonormal_pair();
                ([a.dot(v), b.dot(v)], 2)
            }
        }
    }

    /// The deviation as stated, m or rad; of two along the surface the root of their mean square.
    pub(crate) fn stated(self, c: &NoisyContact, dimension: usize) -> f64 {
        let (n, point) = (c.contact.normal.get(), c.noise.point);
        let across = n.dot(point * n);
        let all = point.x_axis.x + point.y_axis.y + point.z_axis.z;
        match self {
            Self::Across => across.max(0.0).sqrt(),
            Self::Along => ((all - across) / (dimension - 1) as f64).max(0.0).sqrt(),
            Self::Normal => c.noise.normal,
        }
    }

    /// Raises the noise of a contact to a deviation.
    pub(crate) fn raise(self, c: &mut NoisyContact, dimension: usize, level: f64) {
        let n = c.contact.normal.get();
        let outer = DMat3::from_cols(n * n.x, n * n.y, n * n.z);
        let missing = (level * level - self.stated(c, dimension).powi(2)).max(0.0);
        match self {
            Self::Normal => c.noise.normal = c.noise.normal.max(level),
            Self::Across => c.noise.point += outer * missing,
            Self::Along if dimension == 2 => {
                let t = DVec3::Z.cross(n);
                c.noise.point += DMat3::from_cols(t * t.x, t * t.y, t * t.z) * missing;
            }
            Self::Along => c.noise.point += (DMat3::IDENTITY - outer) * missing,
        }
    }
}

/// How contacts follow each other.
pub(super) struct Course {
    /// Median distance from their mean, and from one to the next, m.
    pub(super) size: f64,
    step: f64,
    /// Median angle from one to the next about that, or of their normals, if that is larger, rad.
    pub(super) turn: f64,
    /// Median change from one way between neighbours to the next, and that of the way over what the normal turns by, of their logarithms.
    changes: [f64; 2],
}

/// Ways that change by more than that (of their logarithms) from one to the next are not those of a motion that is read at even times, ...
const UNEVEN: f64 = 0.4;
/// ... of those beyond so many deviations of noise, ...
const SEEN: f64 = 3.0;
/// ... if normals turn with them: what is left is less than this share. Of ways that noise makes uneven they do not.
const ALIKE: f64 = 0.8;

impl Traced<'_> {
    pub(super) fn course(&self) -> Course {
        let points = || self.contacts.iter().map(|c| c.contact.point);
        let mean = points().sum::<DVec3>() / self.contacts.len().max(1) as f64;
        let mut reach: Vec<f64> = points().map(|p| p.distance(mean)).collect();
        let pairs = || self.contacts.iter().zip(self.contacts.iter().skip(1));
        let mut steps: Vec<f64> = pairs().map(|(a, b)| a.contact.point.distance(b.contact.point)).collect();
        let angle = |(a, b): (&NoisyContact, &NoisyContact)| {
            a.contact.normal.get().angle_between(b.contact.normal.get())
        };
        let mut turns: Vec<f64> = pairs().map(angle).collect();
        let ln = |v: f64| v.max(f64::MIN_POSITIVE).ln();
        let radii: Vec<f64> = steps.iter().zip(&turns).map(|(step, turn)| ln(*step) - ln(*turn)).collect();
        let ways: Vec<f64> = steps.iter().map(|step| ln(*step)).collect();
        let noise =
            |part: Part| self.contacts.iter().map(|c| part.stated(c, self.dimension)).fold(0.0, f64::max);
        let [along, normal] = [Part::Along, Part::Normal].map(|part| SEEN * noise(part));
        let seen = |k: usize| steps[k] > along && turns[k] > normal;
        let changes = [ways, radii].map(|of| {
            let both = (1..of.len()).filter(|k| seen(k - 1) && seen(*k));
            median(&mut both.map(|k| (of[k] - of[k - 1]).abs()).collect::<Vec<_>>())
        });
        let (size, step) = (median(&mut reach), median(&mut steps));
        let turn = if size > 0.0 { (step / size).max(median(&mut turns)) } else { 0.0 };
        Course { size, step, turn, changes }
    }

    /// Whether neighbours may predict each other: contacts one after the other at even times. Of those in no order, neighbours are as far apart as any
    /// two, and their differences say nothing of noise.
    pub(super) fn is_followed(&self) -> bool {
        let Course { size, step, changes: [ways, radii], .. } = self.course();
        let spaced_unevenly = ways > UNEVEN && radii < ALIKE * ways;
        step < 0.5 * size && !spaced_unevenly
    }

    /// The deviation that differences of an order over contacts so far apart show, and its own relative deviation.
    pub(crate) fn deviation(&self, part: Part, order: usize, spacing: usize) -> (f64, f64) {
        let (weights, overlap) = binomials(order);
        let gain = weights.iter().map(|w| w * w).sum::<f64>().sqrt();
        let length = order * spacing;
        let mut sizes = Vec::new();
        for first in 0..self.contacts.len().saturating_sub(length) {
            let terms = weights.iter().enumerate();
            let difference: DVec3 =
                terms.map(|(k, w)| part.value(&self.contacts[first + k * spacing]) * *w).sum();
            let middle = &self.contacts[first + length / 2];
            let (components, count) = part.components(middle, self.dimension, difference);
            sizes.extend(components[..count].iter().map(|c| c.abs()));
        }
        let count = sizes.len().max(1) as f64;
        // The variance of a median of normal deviates is 1.36 / n of theirs; overlapping differences say less.
        (median(&mut sizes) / (OF_NORMAL * gain), (1.36 * overlap / count).sqrt())
    }

    /// Whether there are enough contacts, in order, for the noise to be judged.
    pub(crate) fn is_traced(&self) -> bool {
        self.contacts.len() >= FEWEST && self.is_followed()
    }
}

/// Weights of the difference of an order, and the sum of its squared autocorrelations.
fn binomials(order: usize) -> (Vec<f64>, f64) {
    let mut weights = vec![1.0];
    for _ in 0..order {
        let shifted = weights.iter().chain(&[0.0]);
        weights = shifted.zip(std::iter::once(&0.0).chain(&weights)).map(|(a, b)| a - b).collect();
    }
    let overlap = overlap(&weights);
    (weights, overlap)
}

/// The sum of the squared autocorrelations of a series that is made of independent values by these weights.
pub(super) fn overlap(weights: &[f64]) -> f64 {
    let at = |lag: usize| weights.iter().zip(&weights[lag..]).map(|(a, b)| a * b).sum::<f64>();
    1.0 + 2.0 * (1..weights.len()).map(|lag| (at(lag) / at(0)).powi(2)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn differences_have_their_binomials_and_overlaps() {
        assert_eq!(binomials(2).0, [1.0, -2.0, 1.0]);
        // C(4 d, 2 d) / C(2 d, d)^2.
        assert!((binomials(2).1 - 70.0 / 36.0).abs() < 1e-14);
        assert!((binomials(5).1 - 184_756.0 / (252.0 * 252.0)).abs() < 1e-13);
    }
}
