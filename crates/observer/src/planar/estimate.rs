//! What the planar observer knows at one sample.

use super::doubt::Doubt;
use super::force_driven::ForceDriven;
use crate::{NewtonObserver, Report};
use glam::DVec2;
use nalgebra::SVector;

/// What is known at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarEstimate<const N: usize> {
    /// Time, s.
    pub t: f64,
    /// State `(cm, v, omega0, constants)`.
    pub state: SVector<f64, N>,
    /// Orientation against the first sample, rad: the body's axes are those of the world at the first sample.
    pub phi0: f64,
    /// Radius functions `r_i = n_i . cm` at the contacts, m.
    pub radii: [f64; 2],
    /// Their standard deviations, m.
    pub radius_deviations: [f64; 2],
    /// Contact points in body axes from the centre of mass, m: the shape, point by point.
    pub contact_points: [DVec2; 2],
    /// Evidence.
    pub report: Report<N>,
    /// Why the linear covariance was not believed, where it was not; the report then claims no more than natural sizes.
    pub doubt: Option<Doubt>,
}

impl<const N: usize> PlanarEstimate<N> {
    /// From the window's latest state; `base` is the orientation at the window's first sample.
    pub(super) fn new(
        newton: &NewtonObserver<ForceDriven<N>, N, 2>,
        base: f64,
        state: SVector<f64, N>,
        report: Report<N>,
        doubt: Option<Doubt>,
    ) -> Option<Self> {
        let input = newton.samples().last()?.input;
        let phi0 = base + turns(newton).sum::<f64>();
        let stage = &input.stages[2];
        let cm = DVec2::new(state[0], state[1]);
        let radii = stage.normals.map(|n| n.dot(cm));
        let p = report.covariance.fixed_view::<2, 2>(0, 0);
        let radius_deviations = stage.normals.map(|n| {
            let n = SVector::<f64, 2>::new(n.x, n.y);
            n.dot(&(p * n)).max(0.0).sqrt()
        });
        let d = newton.model().contact_offsets(&state, stage);
        // Outward normal -n_i; the tangents in the world are -u_1 and u_2.
        let along = [stage.along[0] * -d[0], stage.along[1] * d[1]];
        let back = DVec2::from_angle(-phi0);
        let contact_points = [0, 1].map(|i| back.rotate(along[i] - stage.normals[i] * radii[i]));
        Some(Self { t: input.t, state, phi0, radii, radius_deviations, contact_points, report, doubt })
    }
}

/// Turn over each interval of the window, by the trapezoid rule with end correction: error of order `h^5` an interval.
pub(super) fn turns<const N: usize>(
    newton: &NewtonObserver<ForceDriven<N>, N, 2>,
) -> impl Iterator<Item = f64> {
    let model = newton.model();
    let mut before: Option<(f64, f64)> = None;
    newton.trajectory().zip(newton.samples()).filter_map(move |(x, sample)| {
        let here = (x[4], model.angular_acceleration(x, &sample.input.stages[2]));
        let h = sample.input.dt;
        let turn = before.map(|b| h * (0.5 * (b.0 + here.0) + h / 12.0 * (b.1 - here.1)));
        before = Some(here);
        turn
    })
}
