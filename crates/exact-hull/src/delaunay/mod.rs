//! Delaunay tetrahedra with exact predicates.
//!
//! Bowyer's and Watson's insertion, with a vertex at infinity in place of an enclosing simplex, in the hull's insertion
//! order. About 150 lines over `robust`, which the hull needs anyway, weigh less than a dependency on one of the young
//! crates of general dimension. Cospherical points need no perturbation: a tetrahedron is removed only if the new point is
//! strictly inside of its sphere, and where the point is in the plane of a face, both neighbours' spheres cut that plane in
//! one circle, so that no flat tetrahedron can arise.

#[cfg(test)]
mod tests;
mod tetrahedron;

pub use tetrahedron::{OUTSIDE, Tetrahedron};

use crate::hull::{Hull, PointsError, insertion_order};
use crate::predicates::{above, projection_axis};
use crate::scaled::ScaledPoints;
use glam::DVec3;
use std::collections::HashMap;
use thiserror::Error;

/// Why points have no Delaunay tetrahedra.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum DelaunayError {
    /// The points have no hull either, or leave the narrower range in which spheres are exact.
    #[error(transparent)]
    Points(#[from] PointsError),
    /// The points span no volume.
    #[error("the points span {dimension} dimensions; tetrahedra need 3")]
    Flat {
        /// Dimension of the hull of the points.
        dimension: usize,
    },
}

/// The Delaunay tetrahedra of `points`, with neighbours; those outside of the hull have the vertex at infinity, [`OUTSIDE`]. Of points
/// at one place one is a corner.
///
/// # Errors
/// [`DelaunayError`] for points that span no volume, a coordinate that is not finite, and coordinates whose sizes differ by more than
/// 2^356.
pub fn tetrahedra(points: &[DVec3]) -> Result<Vec<Tetrahedron>, DelaunayError> {
    let dimension = Hull::of(points)?.dimension();
    let order = insertion_order(points);
    // Spheres are exact in a narrower range than planes are.
    let given = ScaledPoints::for_spheres(points)?;
    let points = &*given.scaled();
    let Some(seed) = seed(points, &order).filter(|_| dimension == 3) else {
        return Err(DelaunayError::Flat { dimension });
    };
    let mut growing = Growing::start(points, seed);
    for i in order {
        growing.insert(i);
    }
    Ok(growing.finish())
}

struct Growing<'a> {
    points: &'a [DVec3],
    all: Vec<Tetrahedron>,
    alive: Vec<bool>,
    /// Where the last point went in.
    last: u32,
}

/// Four points that span space, as a positive tetrahedron.
fn seed(points: &[DVec3], order: &[u32]) -> Option<[u32; 4]> {
    let at = |i: u32| points[i as usize];
    let a = *order.first()?;
    let b = *order.iter().find(|i| at(**i) != at(a))?;
    let c = *order.iter().find(|i| projection_axis(at(a), at(b), at(**i)).is_some())?;
    let side = |d: u32| above(at(a), at(b), at(c), at(d));
    let d = *order.iter().find(|i| side(**i) != 0.0)?;
    Some(if side(d) > 0.0 { [a, b, c, d] } else { [b, a, c, d] })
}

impl<'a> Growing<'a> {
    fn start(points: &'a [DVec3], seed: [u32; 4]) -> Self {
        let first = Tetrahedron::new(seed);
        // Outside of each face, the facet with the vertex at infinity.
        let outer = |k: usize| {
            let [a, b, c] = first.face(k);
            Tetrahedron::new([a, b, c, OUTSIDE])
        };
        let mut own = Self {
            points,
            all: vec![first, outer(0), outer(1), outer(2), outer(3)],
            alive: vec![true; 5],
            last: 0,
        };
        let everything: Vec<u32> = (0..5).collect();
        own.link(&everything);
        own
    }

    /// Makes neighbours of those of `fresh` that share a face.
    fn link(&mut self, fresh: &[u32]) {
        let mut open: HashMap<[u32; 3], (u32, usize)> = HashMap::new();
        for &t in fresh {
            for k in 0..4 {
                if self.all[t as usize].neighbours[k] != OUTSIDE {
                    continue;
                }
                let mut key = self.all[t as usize].face(k);
                key.sort_unstable();
                match open.remove(&key) {
                    Some((other, at)) => {
                        self.all[t as usize].neighbours[k] = other;
                        self.all[other as usize].neighbours[at] = t;
                    }
                    None => {
                        open.insert(key, (t, k));
                    }
                }
            }
        }
    }

    /// A tetrahedron that the point is in, or a facet of the hull that it is strictly above. The walk ends because the
    /// tetrahedra are Delaunay's (Edelsbrunner 1990).
    fn locate(&self, p: DVec3) -> u32 {
        let mut at = self.last;
        if self.all[at as usize].is_outside() {
            at = self.all[at as usize].neighbours[3];
        }
        loop {
            let own = &self.all[at as usize];
            if own.is_outside() {
                return at;
            }
            match (0..4).find(|k| own.beyond(self.points, *k, p) > 0.0) {
                Some(k) => at = own.neighbours[k],
                None => return at,
            }
        }
    }

    /// Whether the point is strictly inside of the sphere; of a facet, whether it is above, or in its plane and inside of
    /// its circle, which the sphere of the tetrahedron behind decides.
    fn conflicts(&self, t: u32, p: DVec3) -> bool {
        let own = &self.all[t as usize];
        if !own.is_outside() {
            return own.sphere_holds(self.points, p);
        }
        let [a, b, c, _] = own.corners;
        let side = above(self.points[a as usize], self.points[b as usize], self.points[c as usize], p);
        side > 0.0 || side == 0.0 && self.all[own.neighbours[3] as usize].sphere_holds(self.points, p)
    }

    fn insert(&mut self, i: u32) {
        let p = self.points[i as usize];
        let start = self.locate(p);
        if self.all[start as usize].corners.iter().any(|c| *c != OUTSIDE && self.points[*c as usize] == p) {
            return;
        }
        let mut cavity = vec![start];
        self.alive[start as usize] = false;
        let mut next = 0;
        let mut rim: Vec<(u32, usize)> = Vec::new();
        while let Some(&t) = cavity.get(next) {
            next += 1;
            for k in 0..4 {
                let other = self.all[t as usize].neighbours[k];
                if !self.alive[other as usize] {
                    continue;
                }
                if self.conflicts(other, p) {
                    self.alive[other as usize] = false;
                    cavity.push(other);
                } else {
                    rim.push((t, k));
                }
            }
        }
        // A tetrahedron may be met from one side before it joins the cavity from another.
        rim.retain(|(t, k)| self.alive[self.all[*t as usize].neighbours[*k] as usize]);
        let mut fresh = Vec::with_capacity(rim.len());
        for (t, k) in rim {
            let behind = self.all[t as usize].neighbours[k];
            let [x, y, z] = self.all[t as usize].face(k);
            let mut own = Tetrahedron::new([x, z, y, i]);
            let name = self.all.len() as u32;
            let facing = own.corners.iter().position(|c| *c == i);
            let back = self.all[behind as usize].neighbours.iter().position(|n| *n == t);
            if let (Some(facing), Some(back)) = (facing, back) {
                own.neighbours[facing] = behind;
                self.all[behind as usize].neighbours[back] = name;
            }
            self.all.push(own);
            self.alive.push(true);
            fresh.push(name);
        }
        self.link(&fresh);
        self.last = fresh.first().copied().unwrap_or(self.last);
    }

    /// The living, renumbered.
    fn finish(self) -> Vec<Tetrahedron> {
        let mut names = vec![OUTSIDE; self.all.len()];
        let mut count = 0;
        for (t, alive) in self.alive.iter().enumerate() {
            if *alive {
                names[t] = count;
                count += 1;
            }
        }
        let renamed = |t: &Tetrahedron| Tetrahedron {
            corners: t.corners,
            neighbours: t.neighbours.map(|n| names[n as usize]),
        };
        self.all.iter().zip(&self.alive).filter(|(_, alive)| **alive).map(|(t, _)| renamed(t)).collect()
    }
}
