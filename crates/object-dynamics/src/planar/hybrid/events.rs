//! When a phase ends: the first zero of what its modes keep positive.

use super::error::FieldError;
use super::phase::Phase;
use super::state::{BodyState, LENGTH, Vector};
use crate::integrate::{DenseOutput, find_root};
use crate::planar::contacts::{CONSISTENT, PlanarMode, WEDGED};
use contact_kinematics::planar::RadiusFunction;

/// Points of each integration step at which signs are looked at. A force that dips below zero and comes back between
/// two of them is missed, a gap is not unless it dips twice; a step moves the body by less than its own size.
const CHECKS: u32 = 8;
/// Share of the normal force by which a sticking force may leave its cone before that counts: above rounding, and
/// well below the 1e-9 that a run is held to.
const CONE_SLACK: f64 = 1e-11;
/// Units of its rounding by which a gap may be negative before that counts.
const GAP_SLACK: f64 = 4.0;
/// Halvings by which a phase that begins on the edge of its end is followed back.
const HALVINGS: u32 = 30;

/// What has changed at a contact.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ContactEventKind {
    /// The body has come to touch the palm: a blow.
    Touches,
    /// The normal force of a sliding contact has fallen to zero.
    Lifts,
    /// Its slip has come to an end.
    SlipEnds,
    /// Its force has reached the edge of the friction cone.
    ConeLeft,
    /// No squeeze within the cones holds a body stuck on several palms any more, or the palms part.
    SqueezeEnds,
}

/// Why a phase ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// A change of modes; at which palm, from 0, where it is one's.
    Event(ContactEventKind, Option<usize>),
    /// The contacts wedge the body: its motion is no longer determined.
    Wedged,
}

/// A quantity that is positive while the modes hold; of gaps also the rate.
#[derive(Clone, Copy)]
struct Indicator {
    end: End,
    value: f64,
    rate: f64,
}

use ContactEventKind as Kind;

impl<S: RadiusFunction> Phase<'_, S> {
    /// First end of the phase within a step, up to `end`.
    pub(super) fn first_event(
        &self,
        dense: &DenseOutput<LENGTH>,
        end: f64,
    ) -> Result<Option<(f64, End)>, FieldError> {
        let start = dense.start();
        let (mut t_before, mut before) = (start, self.indicators(start, &dense.at(start))?);
        for check in 1..=CHECKS {
            let t = start + (end - start) * f64::from(check) / f64::from(CHECKS);
            let now = self.indicators(t, &dense.at(t))?;
            let mut first: Option<(f64, End)> = None;
            for (index, (a, b)) in before.iter().zip(&now).enumerate() {
                let Some(until) = self.below_zero(dense, index, (t_before, a), (t, b)) else { continue };
                let at = self.locate(dense, index, (t_before, a.value), until);
                if first.is_none_or(|(earliest, _)| at < earliest) {
                    first = Some((at, b.end));
                }
            }
            if first.is_some() {
                return Ok(first);
            }
            (t_before, before) = (t, now);
        }
        Ok(None)
    }

    /// A time up to `b` at which an indicator is below zero: the end, or where a gap is least in between.
    fn below_zero(
        &self,
        dense: &DenseOutput<LENGTH>,
        index: usize,
        a: (f64, &Indicator),
        b: (f64, &Indicator),
    ) -> Option<f64> {
        // A NaN counts as below.
        if b.1.value.is_nan() || b.1.value < 0.0 {
            return Some(b.0);
        }
        if !(a.1.rate < 0.0 && b.1.rate > 0.0) {
            return None;
        }
        let rate = |t: f64| self.indicator(dense, index, t).map_or(f64::NAN, |i| i.rate);
        let least = find_root(rate, a.0, b.0, f64::EPSILON * b.0.abs()).ok()?;
        self.indicator(dense, index, least).filter(|i| i.value < 0.0).map(|_| least)
    }

    /// The zero between `a`, with its value, and `until`, from its far side.
    fn locate(&self, dense: &DenseOutput<LENGTH>, index: usize, a: (f64, f64), until: f64) -> f64 {
        let value = |t: f64| self.indicator(dense, index, t).map_or(f64::NAN, |i| i.value);
        let rounding = f64::EPSILON * until.abs();
        let (mut from, mut until) = (a.0, until);
        if a.1 <= 0.0 {
            // It begins at zero: it has risen first, or it ends where it begins.
            for _ in 0..HALVINGS {
                let middle = a.0 + 0.5 * (until - a.0);
                if value(middle) > 0.0 {
                    from = middle;
                    break;
                }
                until = middle;
            }
            if from == a.0 {
                return a.0;
            }
        }
        let root = find_root(value, from, until, rounding).unwrap_or(from);
        // A force that jumps, as where a rounded polygon passes from a corner to an edge, is asked for beyond its
        // jump.
        let mut step = rounding;
        while value(root + step) > 0.0 && root + step < until {
            step *= 2.0;
        }
        (root + 2.0 * step).min(until)
    }

    fn indicator(&self, dense: &DenseOutput<LENGTH>, index: usize, t: f64) -> Option<Indicator> {
        self.indicators(t, &dense.at(t)).ok()?.get(index).copied()
    }

    /// All indicators, always in the same order.
    fn indicators(&self, t: f64, y: &Vector) -> Result<Vec<Indicator>, FieldError> {
        let state = BodyState::of(y);
        let mut all = Vec::new();
        let mut push = |end, value| all.push(Indicator { end, value, rate: 0.0 });
        let event = |kind, palm| End::Event(kind, Some(palm));
        let reading = self.reading(t, &state)?;
        let response = &reading.response;
        for (((touch, rates), mode), [normal, along]) in
            reading.touches.iter().zip(&reading.modes).zip(&response.forces)
        {
            let (palm, mu) = (touch.palm, self.tracker.friction(touch.palm));
            // Where forces are not unique, those of one contact tell nothing.
            let told = |value: f64| if response.redundant { f64::INFINITY } else { value };
            match *mode {
                PlanarMode::Off => {}
                PlanarMode::Slide { sense } => {
                    push(event(Kind::Lifts, palm), told(*normal));
                    if sense != 0.0 {
                        push(event(Kind::SlipEnds, palm), sense * touch.contact.t.dot(rates.slip));
                    }
                }
                PlanarMode::Stick => {
                    let limit = (mu + CONE_SLACK) * normal;
                    push(event(Kind::ConeLeft, palm), told(limit - along));
                    push(event(Kind::ConeLeft, palm), told(limit + along));
                }
            }
        }
        let holds = !response.redundant || reading.problem.margin(&reading.modes, response) >= -CONSISTENT;
        push(End::Event(Kind::SqueezeEnds, None), if holds { 1.0 } else { -1.0 });
        push(End::Wedged, reading.smallest_minor() - WEDGED);
        for (palm, _) in self.modes.iter().enumerate().filter(|(_, mode)| **mode == PlanarMode::Off) {
            let [gap, rate] = self.tracker.gap(palm, t, &state)?;
            let value = gap + GAP_SLACK * self.tracker.gap_rounding(palm, t, &state);
            all.push(Indicator { end: event(Kind::Touches, palm), value, rate });
        }
        Ok(all)
    }
}
