//! How far one configuration of two hinged palms is from another, seen from the body.
//!
//! A configuration is the hinge and the palms' angles in the frame of the body: the plane's case of [`crate::space::metric`], where
//! the proof stands. `d_i = sqrt(|p - p'|^2 + l^2 theta_i^2)`, with the hinge `p` and the angle `theta_i` in `[0, pi]` between the two
//! places of palm `i`; `D = max_i d_i`, as both palms move at once. A norm of metrics is a metric, and so is the maximum of two; an
//! angle between directions is one, on both sides invariant. `l` (half a mean width) turns angles into ways.

use super::balance::{Balance, Rest, RollingBody};
use super::workspace::pair;
use crate::space::metric::MetricError;
use glam::DVec2;
use std::f64::consts::TAU;

/// Where the palms are, in the frame of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PalmsInBody {
    /// The hinge in m.
    pub hinge: DVec2,
    /// Angles of the palms in rad; full turns do not count.
    pub angles: [f64; 2],
}

impl PalmsInBody {
    /// Of palms at absolute angles (rad), about a body at rest between them; none where they enclose no wedge.
    #[must_use]
    pub fn of<B: RollingBody>(body: &B, palms: [f64; 2], rest: &Rest) -> Option<Self> {
        let balance = Balance::at(body, &pair(palms)?, rest.phi);
        // The hinge is at -cm from the centre of mass in the world.
        let hinge = body.centre() - DVec2::from_angle(-rest.phi).rotate(balance.p_WCm);
        Some(Self { hinge, angles: palms.map(|p| p - rest.phi) })
    }
}

/// Distance of two configurations in m, with the length `l` (m) that turns an angle into a way.
///
/// # Errors
/// [`MetricError::Scale`] for a length that is none, [`MetricError::Pose`] for a configuration that is not finite.
pub fn distance(from: &PalmsInBody, to: &PalmsInBody, l: f64) -> Result<f64, MetricError> {
    check("the length of the metric", l)?;
    combined(from, to, |way, angle| way.hypot(l * angle))
}

/// Least duration in s of the way from one to the other as the body sees it, with a hinge of `linear` m/s at most and palms of `angular` rad/s.
///
/// # Errors
/// As [`distance`].
pub fn duration(from: &PalmsInBody, to: &PalmsInBody, linear: f64, angular: f64) -> Result<f64, MetricError> {
    check("the linear speed", linear)?;
    check("the angular speed", angular)?;
    combined(from, to, |way, angle| (way / linear).max(angle / angular))
}

fn combined(
    from: &PalmsInBody,
    to: &PalmsInBody,
    norm: impl Fn(f64, f64) -> f64,
) -> Result<f64, MetricError> {
    for c in [from, to] {
        if let Some(palm) = c.angles.iter().position(|a| !a.is_finite() || !c.hinge.is_finite()) {
            return Err(MetricError::Pose { palm });
        }
    }
    let way = from.hinge.distance(to.hinge);
    let one = |i: usize| norm(way, between(from.angles[i], to.angles[i]));
    Ok(one(0).max(one(1)))
}

/// Angle between two directions in rad, in [0, pi].
pub(super) fn between(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(TAU);
    turn.min(TAU - turn)
}

fn check(what: &'static str, value: f64) -> Result<(), MetricError> {
    if value > 0.0 && value.is_finite() { Ok(()) } else { Err(MetricError::Scale { what, value }) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::metric::{self, PalmPose, Together};
    use glam::DQuat;
    use proptest::prelude::*;

    fn configuration() -> impl Strategy<Value = PalmsInBody> {
        let angle = || -7.0..7.0f64;
        (-2.0..2.0f64, -2.0..2.0f64, angle(), angle())
            .prop_map(|(x, y, a, b)| PalmsInBody { hinge: DVec2::new(x, y), angles: [a, b] })
    }

    fn in_space(c: &PalmsInBody) -> Vec<PalmPose> {
        let pose = |a: &f64| PalmPose { R_OP: DQuat::from_rotation_z(*a), p_OP: c.hinge.extend(0.0) };
        c.angles.iter().map(pose).collect()
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]
        #[test]
        fn the_laws_of_a_metric_hold(
            a in configuration(), b in configuration(), c in configuration(),
            turn in -4.0..4.0f64, x in -1.0..1.0f64, l in 0.1..3.0f64, full in -2..3i32,
        ) {
            type Metric<'a> = &'a dyn Fn(&PalmsInBody, &PalmsInBody) -> f64;
            let way: Metric<'_> = &|a, b| distance(a, b, l).unwrap();
            let time: Metric<'_> = &|a, b| duration(a, b, 0.4, l).unwrap();
            let moved = |c: &PalmsInBody| PalmsInBody {
                hinge: DVec2::from_angle(turn).rotate(c.hinge) + DVec2::new(x, -x),
                angles: c.angles.map(|a| a + turn),
            };
            let wound = PalmsInBody { angles: [a.angles[0] + TAU * f64::from(full), a.angles[1]], ..a };
            for d in [way, time] {
                prop_assert!(d(&a, &c) <= d(&a, &b) + d(&b, &c) + 1e-12, "triangle");
                prop_assert!((d(&a, &b) - d(&b, &a)).abs() < 1e-12, "symmetry");
                prop_assert!(d(&a, &a) == 0.0 && d(&a, &wound) < 1e-11, "the same is at 0");
                prop_assert!(a.hinge == b.hinge || d(&a, &b) > 0.0, "nothing else is");
                prop_assert!((d(&a, &b) - d(&moved(&a), &moved(&b))).abs() < 1e-11, "another frame");
            }
            // The metric of space, of which this is a case.
            let space = metric::distance(&in_space(&a), &in_space(&b), l, Together::AtOnce).unwrap();
            prop_assert!((way(&a, &b) - space).abs() < 1e-9);
        }
    }

    #[test]
    fn what_has_no_distance_is_named() {
        let c = PalmsInBody { hinge: DVec2::ZERO, angles: [0.5, 1.5] };
        let none = PalmsInBody { angles: [0.5, f64::NAN], ..c };
        assert_eq!(distance(&c, &none, 1.0), Err(MetricError::Pose { palm: 1 }));
        for l in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(distance(&c, &c, l), Err(MetricError::Scale { .. })));
        }
    }
}
