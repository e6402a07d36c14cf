//! What noise of the forces does to a motion over a link, and what a link that misses the next node by some residual costs.

use super::body::Body;
use super::flow::Transition;
use super::noise::WrenchNoise;
use super::state::{MOTION, Tangent, Turn, parts};
use super::triangular::{Rows, factor, inverse, length_squared};
use glam::{DMat3, DVec3};
use nalgebra::{Matrix3, Matrix6, SMatrix};

/// Of a link of duration `h`, in factors. The noise's first integral is that of the momenta, its second one mass times place and inertia
/// times turn; of this half the duration times the first is the same, and the rest independent of it.
pub(super) struct LinkNoise {
    h: f64,
    white: Rows<6, 6>,
    /// Of the rest, where that is not what white noise alone leaves.
    rest: Option<Rows<6, 6>>,
}

impl LinkNoise {
    /// Of noise with moments about the centre of mass at the link's end. None where it has no inverse.
    pub(super) fn new(noise: &WrenchNoise, h: f64) -> Option<Self> {
        let rest = if noise.late == Matrix6::zeros() {
            None
        } else {
            Some(factor(&(noise.white * (h * h / 12.0) + noise.late))?)
        };
        Some(Self { h, white: factor(&noise.white)?, rest })
    }

    /// The square of a residual in its deviations, of a motion that ends with `turn`.
    pub(super) fn cost(&self, residual: &Tangent, body: &Body, turn: &Turn) -> f64 {
        let [place, velocity, momentum, by] = parts(residual);
        let mass = 1.0 / body.inverse_mass();
        let first = [velocity * mass, momentum];
        let second = [place * mass, body.inertia_along(turn.R) * by];
        let rest = [0, 1].map(|i| second[i] - 0.5 * self.h * first[i]);
        let six = |[a, b]: [DVec3; 2]| [a.x, a.y, a.z, b.x, b.y, b.z];
        let of_rest = match &self.rest {
            Some(factor) => length_squared(factor, six(rest)),
            None => length_squared(&self.white, six(rest)) * self.share_of_white(),
        };
        length_squared(&self.white, six(first)) + of_rest
    }

    /// The inverse covariance of the motion at its end.
    pub(super) fn information(&self, body: &Body, turn: &Turn) -> Transition {
        let mass = DMat3::IDENTITY * (1.0 / body.inverse_mass());
        let white = inverse(&self.white);
        let rest = self.rest.as_ref().map_or_else(|| white * self.share_of_white(), inverse);
        let mixed = rest * (-0.5 * self.h);
        let once = white + rest * (0.25 * self.h * self.h);
        // Of force and moment: the numbers of a motion that their second integrals are, times what, and their first ones.
        let places = [(0, mass), (3, body.inertia_along(turn.R))];
        let momenta = [(1, mass), (2, DMat3::IDENTITY)];
        let mut all = Transition::zeros();
        let mut set = |i: usize, j: usize, block: DMat3| {
            all.fixed_view_mut::<3, 3>(3 * i, 3 * j).copy_from(&Matrix3::from(block));
        };
        for (i, (place, A)) in places.into_iter().enumerate() {
            for (j, (momentum, C)) in momenta.into_iter().enumerate() {
                let block = |of: &Matrix6<f64>| DMat3::from(of.fixed_view::<3, 3>(3 * i, 3 * j).into_owned());
                let crossed = A * block(&mixed) * C;
                set(place, momentum, crossed);
                set(momentum, place, crossed.transpose());
                set(place, places[j].0, A * block(&rest) * places[j].1);
                set(momenta[i].0, momentum, momenta[i].1 * block(&once) * C);
            }
        }
        all
    }

    /// Information of the rest as a multiple of that of the first integral, where white noise alone leaves it.
    fn share_of_white(&self) -> f64 {
        12.0 / (self.h * self.h)
    }
}

/// What `noise` of the forces over a time `h`, with moments about the centre of mass, does to the motion at its end.
pub(super) fn link_covariance(noise: &WrenchNoise, h: f64, body: &Body, turn: &Turn) -> Transition {
    let (m, K) = (body.inverse_mass(), Matrix3::from(turn.K));
    let one = Matrix3::identity();
    // Of the wrench's impulse: white noise moves the path by half of it, and what is left of the path is independent of it.
    let mut impulse = SMatrix::<f64, MOTION, 6>::zeros();
    let mut rest = impulse;
    let set = |of: &mut SMatrix<f64, MOTION, 6>, row: usize, column: usize, block: Matrix3<f64>| {
        of.fixed_view_mut::<3, 3>(row, column).copy_from(&block);
    };
    set(&mut impulse, 0, 0, one * (0.5 * h * m));
    set(&mut impulse, 3, 0, one * m);
    set(&mut impulse, 6, 3, one);
    set(&mut impulse, 9, 3, K * (0.5 * h));
    set(&mut rest, 0, 0, one * m);
    set(&mut rest, 9, 3, K);
    let of_rest = noise.white * (h * h / 12.0) + noise.late;
    impulse * noise.white * impulse.transpose() + rest * of_rest * rest.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Normal;
    use glam::DQuat;

    /// Covariance, information and cost are three ways to the same.
    #[test]
    fn information_is_the_inverse_of_the_covariance() {
        let mut normal = Normal::seeded(11);
        let mut covariance = || {
            let root = Matrix6::from_fn(|_, _| normal.draw());
            root * root.transpose() + Matrix6::identity() * 0.1
        };
        let body = Body::free(0.3, DMat3::from_diagonal(DVec3::new(2.0, 2.5, 3.1)));
        let turn = body.turn(DQuat::from_rotation_y(0.7), DVec3::new(0.2, -0.4, 1.0));
        for late in [Matrix6::zeros(), covariance()] {
            let noise = WrenchNoise { white: covariance(), late, sampled: [0.0; 2] };
            let noise = noise.about(DVec3::new(0.3, -0.2, 0.5));
            let link = LinkNoise::new(&noise, 0.4).unwrap();
            let information = link.information(&body, &turn);
            let unit = information * link_covariance(&noise, 0.4, &body, &turn);
            assert!((unit - Transition::identity()).amax() < 1e-9, "{unit}");
            let residual = Tangent::from_fn(|i, _| 0.1 * (i as f64 - 4.0));
            let cost = (information * residual).dot(&residual);
            assert!((link.cost(&residual, &body, &turn) - cost).abs() < 1e-9 * cost);
        }
    }
}
