//! A hull that grows with its points.

use super::build::Builder;
use super::facets::MOST_POINTS;
use super::seed::{Seed, find_seed};
use super::{Hull, PointsError, SolidHull};
use crate::predicates::{above, projection_axis};
use crate::scaled::is_exact_unscaled;
use glam::DVec3;

/// A hull to which points are added one by one without starting over. A point costs the walk to it, O(sqrt n) facets from
/// afar and few from near, and the facets that it replaces: few for scattered points, a whole fan at the end of a curve that
/// is being traced.
///
/// Decided by the same exact predicates as [`Hull::of`]: after each point the hull is that of all points so far.
pub struct IncrementalHull {
    /// Until the points span space there is nothing to grow.
    state: State,
    points: Vec<DVec3>,
}

enum State {
    /// Up to three of the points, that span what all of them do.
    Flat(Vec<usize>),
    Solid(Box<Builder>),
}

impl Default for IncrementalHull {
    fn default() -> Self {
        Self::new()
    }
}

impl IncrementalHull {
    /// A hull of no points.
    #[must_use]
    pub fn new() -> Self {
        Self { state: State::Flat(Vec::new()), points: Vec::new() }
    }

    /// Adds a point; true if the hull grew (always while the points do not span space).
    ///
    /// # Errors
    /// [`PointsError::NotFinite`], [`PointsError::TooMany`], and [`PointsError::DynamicRange`] for coordinates beyond what
    /// exact predicates take unscaled (non-zero sizes from 2^-300 to 2^330); the hull stays as it was.
    pub fn insert(&mut self, point: DVec3) -> Result<bool, PointsError> {
        self.check(point)?;
        self.points.push(point);
        Ok(match &mut self.state {
            State::Solid(builder) => builder.push(point),
            State::Flat(basis) => {
                if extends(&self.points, basis) {
                    self.start_growing();
                }
                true
            }
        })
    }

    /// Whether `point` can be taken.
    ///
    /// # Errors
    /// Those of [`Self::insert`].
    pub fn check(&self, point: DVec3) -> Result<(), PointsError> {
        let index = self.points.len();
        if index >= MOST_POINTS {
            return Err(PointsError::TooMany { count: index + 1, limit: MOST_POINTS });
        }
        if !point.is_finite() {
            return Err(PointsError::NotFinite { index, point });
        }
        if !is_exact_unscaled(point) {
            let size = point.abs();
            return Err(PointsError::DynamicRange {
                smallest: size.min_element(),
                largest: size.max_element(),
            });
        }
        Ok(())
    }

    /// Starts growing now that the points span space.
    fn start_growing(&mut self) {
        let Seed::Space(corners) = find_seed(&self.points) else { return };
        let mut builder = Builder::from_simplex(self.points.clone(), corners.map(|c| c as u32));
        for p in 0..self.points.len() as u32 {
            builder.insert(p);
        }
        self.state = State::Solid(Box::new(builder));
    }

    /// All points so far.
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The hull of the points so far, in time O(n).
    ///
    /// # Errors
    /// [`PointsError::Empty`] before the first point.
    pub fn hull(&self) -> Result<Hull, PointsError> {
        match &self.state {
            State::Flat(_) => Hull::of(&self.points),
            State::Solid(builder) => {
                let order: Vec<u32> = (0..self.points.len() as u32).collect();
                Ok(Hull::Solid(SolidHull::from_builder(builder, &order, 1.0)))
            }
        }
    }
}

/// Takes the last point into the basis if it adds a dimension, in constant time; true once all of them are spanned.
fn extends(points: &[DVec3], basis: &mut Vec<usize>) -> bool {
    let Some(last) = points.len().checked_sub(1) else { return false };
    let p = points[last];
    let adds = match basis[..] {
        [] => true,
        [a] => points[a] != p,
        [a, b] => projection_axis(points[a], points[b], p).is_some(),
        [a, b, c, ..] => return above(points[a], points[b], points[c], p) != 0.0,
    };
    if adds {
        basis.push(last);
    }
    false
}
