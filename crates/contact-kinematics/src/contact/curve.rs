use crate::Direction;
use glam::DVec3;
use thiserror::Error;

/// One point of a contact curve: the trace of a contact on the body, in body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvePoint {
    /// Time in s.
    pub t: f64,
    /// Contact point from the centre of mass, in m.
    pub beta_O: DVec3,
    /// Outward unit normal there.
    pub n_O: Direction,
    /// Velocity of the contact point on the body, m/s.
    pub beta_dot_O: DVec3,
    /// Rate of the normal, 1/s.
    pub n_dot_O: DVec3,
}

/// Darboux frame and curvatures of a curve on a surface (paper, (25) to (27)).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Darboux {
    /// Speed along the curve, m/s.
    pub speed: f64,
    /// Unit tangent `T` of the curve.
    pub tangent: DVec3,
    /// `V = U x T`, in the surface.
    pub binormal: DVec3,
    /// Surface normal `U`, outward.
    pub normal: DVec3,
    /// Normal curvature `kappa_n`, 1/m: negative on a convex body, whose surface bends away from its outward normal.
    pub normal_curvature: f64,
    /// Geodesic curvature `kappa_g`, 1/m.
    pub geodesic_curvature: f64,
    /// Geodesic torsion `tau_g`, 1/m.
    pub geodesic_torsion: f64,
}

/// Why a curve cannot be used.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum CurveError {
    /// Times do not increase.
    #[error("t of curve point {index} is {time} s, not above {previous} s before it")]
    TimeNotIncreasing {
        /// Index from 0.
        index: usize,
        /// Its time in s.
        time: f64,
        /// The time before, in s.
        previous: f64,
    },
    /// A value is NaN or infinite.
    #[error("curve point {index} (t = {time} s) is not finite")]
    NotFinite {
        /// Index from 0.
        index: usize,
        /// Its time in s.
        time: f64,
    },
}

/// Darboux data at one point of a curve, from velocity, acceleration and the rate of the normal, all in body axes.
///
/// None where the contact point stands still on the body (speed below `smallest_speed`, m/s): the curve then has no
/// tangent, and curvatures would be divided by zero.
#[must_use]
pub fn darboux(point: &CurvePoint, beta_ddot_O: DVec3, smallest_speed: f64) -> Option<Darboux> {
    let speed = point.beta_dot_O.length();
    let usable = speed > smallest_speed.max(f64::MIN_POSITIVE) && speed.is_finite();
    usable.then(|| {
        let tangent = point.beta_dot_O / speed;
        let normal = point.n_O.get();
        let binormal = normal.cross(tangent);
        Darboux {
            speed,
            tangent,
            binormal,
            normal,
            normal_curvature: -point.n_dot_O.dot(tangent) / speed,
            geodesic_curvature: beta_ddot_O.dot(binormal) / (speed * speed),
            geodesic_torsion: -point.n_dot_O.dot(binormal) / speed,
        }
    })
}

/// A contact curve: points in strictly increasing time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactCurve {
    points: Vec<CurvePoint>,
}

impl ContactCurve {
    /// Checks the points and takes them.
    ///
    /// # Errors
    /// [`CurveError`] names the first point that cannot be used.
    pub fn new(points: Vec<CurvePoint>) -> Result<Self, CurveError> {
        for (index, point) in points.iter().enumerate() {
            let finite =
                point.beta_O.is_finite() && point.beta_dot_O.is_finite() && point.n_dot_O.is_finite();
            if !(finite && point.t.is_finite()) {
                return Err(CurveError::NotFinite { index, time: point.t });
            }
            if index > 0 && point.t <= points[index - 1].t {
                return Err(CurveError::TimeNotIncreasing {
                    index,
                    time: point.t,
                    previous: points[index - 1].t,
                });
            }
        }
        Ok(Self { points })
    }

    /// The points.
    #[must_use]
    pub fn points(&self) -> &[CurvePoint] {
        &self.points
    }

    /// Length of the curve on the body, in m, by the trapezoidal rule over its speed.
    #[must_use]
    pub fn length(&self) -> f64 {
        let pieces = self
            .points
            .windows(2)
            .map(|w| 0.5 * (w[1].t - w[0].t) * (w[0].beta_dot_O.length() + w[1].beta_dot_O.length()));
        pieces.sum()
    }

    /// Darboux data along the curve; none where the contact stands still ([`darboux`]).
    ///
    /// The acceleration comes from five-point differences of the velocity (fourth order in the spacing, third at the
    /// ends of a curve with uneven spacing); a curve of fewer than five points uses what it has.
    #[must_use]
    pub fn darboux(&self, smallest_speed: f64) -> Vec<Option<Darboux>> {
        let count = self.points.len();
        (0..count)
            .map(|k| {
                let width = count.min(5);
                let start = k.saturating_sub(width / 2).min(count - width);
                let acceleration = derivative_at(&self.points[start..start + width], k - start);
                darboux(&self.points[k], acceleration, smallest_speed)
            })
            .collect()
    }
}

/// Derivative, at node `at`, of the polynomial through the velocities of the nodes.
fn derivative_at(nodes: &[CurvePoint], at: usize) -> DVec3 {
    let t = |k: usize| nodes[k].t;
    let mut sum = DVec3::ZERO;
    for (k, node) in nodes.iter().enumerate() {
        // Lagrange weights; times are strictly increasing, so no difference is zero.
        let weight = if k == at {
            (0..nodes.len()).filter(|&j| j != at).map(|j| 1.0 / (t(at) - t(j))).sum::<f64>()
        } else {
            let others = (0..nodes.len()).filter(|&j| j != at && j != k);
            others.map(|j| (t(at) - t(j)) / (t(k) - t(j))).product::<f64>() / (t(k) - t(at))
        };
        sum += weight * node.beta_dot_O;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A circle of latitude on the unit sphere: geodesic curvature cot(colatitude), normal curvature -1, no torsion.
    fn latitude(colatitude: f64, count: u32, step: f64) -> ContactCurve {
        let (sin, cos) = colatitude.sin_cos();
        let point = |k: u32| {
            let t = f64::from(k) * step;
            let beta = DVec3::new(sin * t.cos(), sin * t.sin(), cos);
            let rate = DVec3::new(-sin * t.sin(), sin * t.cos(), 0.0);
            let n_O = Direction::new(beta).unwrap();
            CurvePoint { t, beta_O: beta, n_O, beta_dot_O: rate, n_dot_O: rate }
        };
        ContactCurve::new((0..count).map(point).collect()).unwrap()
    }

    #[test]
    fn circle_of_latitude_has_its_curvatures() {
        let colatitude = 0.6_f64;
        for frame in latitude(colatitude, 40, 0.01).darboux(1e-9) {
            let frame = frame.unwrap();
            assert!((frame.normal_curvature + 1.0).abs() < 1e-14);
            assert!(frame.geodesic_torsion.abs() < 1e-14);
            assert!((frame.geodesic_curvature - 1.0 / colatitude.tan()).abs() < 1e-8);
        }
    }

    #[test]
    fn geodesic_curvature_converges_with_fourth_order() {
        let error = |step: f64| {
            let frames = latitude(0.6, 11, step).darboux(1e-9);
            (frames[5].unwrap().geodesic_curvature - 1.0 / 0.6_f64.tan()).abs()
        };
        let order = (error(0.1) / error(0.05)).log2();
        assert!((order - 4.0).abs() < 0.2, "{order}");
    }

    #[test]
    fn standing_contact_and_short_curves_have_no_silent_nan() {
        let mut point = latitude(0.6, 2, 0.1).points()[0];
        point.beta_dot_O = DVec3::ZERO;
        assert_eq!(darboux(&point, DVec3::X, 1e-9), None);
        assert!(ContactCurve::default().darboux(1e-9).is_empty());
        assert!(latitude(0.6, 2, 0.1).darboux(1e-9).iter().all(Option::is_some));
        assert!(latitude(0.6, 1, 0.1).darboux(1e-9).iter().all(Option::is_some));
        let repeated = vec![latitude(0.6, 1, 0.1).points()[0]; 2];
        assert!(matches!(ContactCurve::new(repeated), Err(CurveError::TimeNotIncreasing { index: 1, .. })));
    }
}
