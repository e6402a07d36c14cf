//! Following an outline once round, and telling hollows from jumps.

use glam::DVec2;
use shape_bounds::exact_hull::planar::Direction;
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// A contact of the finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// In m.
    pub point: DVec2,
    /// Outward normal of the object.
    pub normal: Direction,
}

/// A round finger in touch with an outline.
pub trait ContourFinger {
    /// Why it cannot go on.
    type Error;

    /// Its radius, m.
    fn radius(&self) -> f64;

    /// Moves its centre along, keeping in touch, by `length` m: counter-clockwise round the object, back for a negative one.
    ///
    /// # Errors
    /// Those of the finger.
    fn advance(&mut self, length: f64) -> Result<Touch, Self::Error>;
}

/// How finely an outline is followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracing {
    /// Motion of the centre from touch to touch at most, m.
    pub step: f64,
    /// And at least: what turns the normal by more than `turn` over so little is a jump (or a corner).
    pub least: f64,
    /// The normal turns by so much from touch to touch at most, rad, unless over the least step.
    pub turn: f64,
    /// How far a measured turn may be off, rad: zero for exact normals, else [`super::Margins::of_turn`].
    pub doubt: f64,
    /// Touches at most, with those that the finger went back from.
    pub readings: usize,
}

impl Tracing {
    /// How wide what a finger of radius `q` (m) jumps over may be at most without being told, m: both sides are touched by one disc, whose normals there are
    /// apart by a turn that is not told from noise, and by what the outline turns outwards over the step, which the centre goes by round a corner.
    #[must_use]
    pub fn unseen(&self, q: f64) -> f64 {
        (self.turn + 2.0 * self.doubt).mul_add(q, self.step)
    }
}

/// Why nothing is followed.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum TraceError<E> {
    /// A setting that is none.
    #[error(
        "{what} is {value}; it must be positive and finite, the least step below the step, and the turn below pi"
    )]
    Setting {
        /// Which.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// The finger.
    #[error(transparent)]
    Finger(E),
}

/// Two contacts between which the finger does not get.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bridge {
    /// The touch before, by its place in [`Traced::touches`]; the next one is the touch after.
    pub after: usize,
    /// How far apart they are, m.
    pub mouth: f64,
    /// Either what is between was not felt, or it is a hollow with a mean radius of curvature of no more than this, m: the finger's and the resolution.
    pub radius_at_most: f64,
}

/// How following ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum TraceEnd {
    /// Once round.
    Closed,
    /// All touches that were allowed for are made.
    Budget,
}

/// An outline as it was followed.
#[derive(Clone, Debug, PartialEq)]
pub struct Traced {
    /// In order; where it is closed the last one is past the first.
    pub touches: Vec<Touch>,
    /// Motion of the centre to each touch from the one before, m; 0 of the first.
    pub ways: Vec<f64>,
    /// Jumps.
    pub bridges: Vec<Bridge>,
    /// How it ended.
    pub end: TraceEnd,
    /// Radius of the finger, m.
    pub radius: f64,
    /// Touches in all, with those that the finger went back from.
    pub readings: usize,
}

/// Follows an outline once round.
///
/// Where the normal turns by too much the finger goes back and on by half as much, down to the least step.
///
/// # Errors
/// [`TraceError`].
pub fn trace<F: ContourFinger>(finger: &mut F, tracing: &Tracing) -> Result<Traced, TraceError<F::Error>> {
    let Tracing { step, least, turn, doubt, readings } = *tracing;
    if !(doubt >= 0.0 && doubt.is_finite()) {
        return Err(TraceError::Setting { what: "doubt", value: doubt });
    }
    let settings = [("step", step), ("least step", least), ("turn", turn)];
    let range = |what: &str, value: f64| match what {
        "least step" => value <= step,
        "turn" => value < PI - doubt,
        _ => true,
    };
    for (what, value) in settings {
        if !(value > 0.0 && value.is_finite() && range(what, value)) {
            return Err(TraceError::Setting { what, value });
        }
    }
    let mut go = |length: f64| finger.advance(length).map_err(TraceError::Finger);
    let (mut last, mut length) = (go(0.0)?, step);
    let mut traced = Traced {
        touches: vec![last],
        ways: vec![0.0],
        bridges: Vec::new(),
        end: TraceEnd::Budget,
        radius: 0.0,
        readings: 1,
    };
    let mut turned_in_all = 0.0;
    while traced.readings < readings {
        let next = go(length)?;
        traced.readings += 1;
        let turned = signed(last.normal, next.normal);
        if turned.abs() > turn + doubt && length > least {
            go(-length)?;
            length = (0.5 * length).max(least);
            continue;
        }
        turned_in_all += turned;
        traced.jump(last, next, length, (turned, turn + doubt, doubt));
        traced.touches.push(next);
        traced.ways.push(length);
        // Past the first touch, where the outline bulges: by the turn of the normal, and by the place.
        if turned_in_all >= TAU + doubt && next.point.distance(traced.touches[0].point) <= 4.0 * step {
            traced.end = TraceEnd::Closed;
            break;
        }
        (last, length) = (next, (2.0 * length).min(step));
    }
    traced.radius = finger.radius();
    for bridge in &mut traced.bridges {
        bridge.radius_at_most += traced.radius;
    }
    Ok(traced)
}

impl Traced {
    /// A turn inwards over so little is a jump: the centre's motion over the turn is kept, the radius of the finger comes to it in the end.
    fn jump(&mut self, last: Touch, next: Touch, length: f64, (turned, most, doubt): (f64, f64, f64)) {
        if turned < -most {
            let after = self.touches.len() - 1;
            let mouth = last.point.distance(next.point);
            self.bridges.push(Bridge { after, mouth, radius_at_most: length / (-turned - doubt) });
        }
    }

    /// The smallest mean radius of curvature of a hollow between neighbouring touches that was felt all along, m: `q + L / a`. None without hollows that
    /// turn by more than `doubt` (rad).
    #[must_use]
    pub fn least_hollow(&self, doubt: f64) -> Option<f64> {
        let felt = (1..self.touches.len()).filter(|k| self.bridges.iter().all(|b| b.after + 1 != *k));
        let turn = |k: usize| signed(self.touches[k - 1].normal, self.touches[k].normal);
        let hollow = felt.map(|k| (k, -turn(k))).filter(|(_, a)| *a > doubt.max(1e-9));
        hollow.map(|(k, a)| self.radius + self.ways[k] / a).min_by(f64::total_cmp)
    }

    /// Area in m^2 within the touches, joined by straight lines; of what is closed without the last one, which is past the first.
    #[must_use]
    pub fn area(&self) -> f64 {
        let count = self.touches.len() - usize::from(self.end == TraceEnd::Closed);
        let ring = &self.touches[..count];
        let next = ring.iter().cycle().skip(1);
        0.5 * ring.iter().zip(next).map(|(a, b)| a.point.perp_dot(b.point)).sum::<f64>()
    }
}

/// Angle from one direction to another, in (-pi, pi].
fn signed(from: Direction, to: Direction) -> f64 {
    from.get().perp_dot(to.get()).atan2(from.get().dot(to.get()))
}
