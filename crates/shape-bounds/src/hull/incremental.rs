//! A hull that grows with its points.

use super::build::Builder;
use super::facets::NONE;
use super::seed::{Seed, find_seed};
use super::{Hull, PointsError, SolidHull, scaling};
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
    Flat,
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
        Self { state: State::Flat, points: Vec::new() }
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
            State::Flat => {
                self.try_to_span();
                true
            }
        })
    }

    /// Whether `point` can be taken.
    pub(crate) fn check(&self, point: DVec3) -> Result<(), PointsError> {
        let index = self.points.len();
        if index + 1 >= NONE as usize {
            return Err(PointsError::TooMany { count: index + 1, limit: NONE as usize - 1 });
        }
        match scaling::exact_scale(&[point]) {
            Ok(1.0) => Ok(()),
            Ok(_) => {
                let size = point.abs();
                Err(PointsError::DynamicRange { smallest: size.min_element(), largest: size.max_element() })
            }
            Err(PointsError::NotFinite { point, .. }) => Err(PointsError::NotFinite { index, point }),
            Err(error) => Err(error),
        }
    }

    /// Starts growing as soon as the points span space.
    fn try_to_span(&mut self) {
        if self.points.len() < 4 {
            return;
        }
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
            State::Flat => Hull::of(&self.points),
            State::Solid(builder) => {
                let order: Vec<u32> = (0..self.points.len() as u32).collect();
                Ok(Hull::Solid(SolidHull::from_builder(builder, &order, 1.0)))
            }
        }
    }
}
