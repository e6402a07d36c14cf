//! Rolling between palms: against the dynamics, what is proven, what is refused.

mod against_dynamics;
mod bad_input;
mod closed_loop;
mod sensed;

use exploration::generators::{Family, Outline, outline};
use exploration::rolling::{RollingBody, SimulatedPalms, Workspace};
use glam::DVec2;
use shape_bounds::exact_hull::planar::Direction;

/// What a test draws: a decisive few, or all where `RECON_TESTS=all` asks for it.
pub(crate) fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|v| v == "all") { all } else { few }
}

/// A generator's body of uniform density.
pub(crate) struct Body {
    pub(crate) outline: Outline,
    pub(crate) centre: DVec2,
}

impl RollingBody for Body {
    fn farthest(&self, theta: f64) -> DVec2 {
        (self.outline)(Direction::from_angle(theta))
    }

    fn centre(&self) -> DVec2 {
        self.centre
    }
}

pub(crate) fn body(family: Family, seed: u64) -> Body {
    let outline = outline(family, seed);
    let ring: Vec<DVec2> = (0..720)
        .map(|k| outline(Direction::from_angle(f64::from(k) * std::f64::consts::TAU / 720.0)))
        .collect();
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        area += a.perp_dot(*b);
        moment += (*a + *b) * a.perp_dot(*b);
    }
    Body { outline, centre: moment / (3.0 * area) }
}

/// Bodies of the generators are some 1.5 m wide.
pub(crate) const SIZE: f64 = 1.5;

pub(crate) fn palms(family: Family, seed: u64) -> SimulatedPalms<Body> {
    SimulatedPalms::new(body(family, seed), Workspace::for_size(SIZE).length, [0.7, 2.4], 0.3).unwrap()
}
