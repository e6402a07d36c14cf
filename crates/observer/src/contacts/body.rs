//! Mass and inertia: of an unknown body, or of one whose axes alone are unknown.

use super::state::Turn;
use crate::rigid::{
    exponential, inertia_of_numbers, inertia_slope, logarithm, logarithm_slope, numbers_of_inertia,
};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::{Matrix3, Matrix6, SMatrix, SVector, Vector6};
use object_dynamics::MassProperties;

/// Constants of a body: logarithm of the mass, six of the inertia.
pub(super) const CONSTANTS: usize = 7;
/// Those of the inertia.
pub(super) const INERTIA: usize = CONSTANTS - 1;

/// Change of the logarithms of an unknown inertia up to which a step is straight in its entries: farther on it may lead to no body.
const STRAIGHT: f64 = 0.7;

/// Change of a logarithm of the root of a second moment with that of a principal moment from which on a body is too thin for that change.
const THINNEST: f64 = 100.0;

/// Mass and inertia about the centre of mass, in axes that are those of the world at the first sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) log_mass: f64,
    constants: Constants,
    inverse_mass: f64,
    inertia: DMat3,
    inverse: DMat3,
    /// Derivatives of the inertia by its constants.
    slopes: [DMat3; INERTIA],
}

/// What the inertia follows from.
#[derive(Clone, Copy, Debug)]
enum Constants {
    /// Factor of the second moments: logarithms of its diagonal, entries beside it.
    Free([f64; INERTIA]),
    /// Logarithms of the roots of the principal second moments, and how their axes lie: what is known of a body, and what is not.
    Turned([f64; 3], DQuat),
}

impl Body {
    /// A body of any inertia.
    pub(super) fn free(log_mass: f64, inertia: DMat3) -> Self {
        Self::new(log_mass, Constants::Free(numbers_of_inertia(inertia)))
    }

    /// A body of the mass and the moments of `mass`, whose own axes are turned by `R` at the first sample.
    pub(super) fn turned(mass: &MassProperties, R: DQuat) -> Self {
        let principal = mass.principal();
        let half = 0.5 * principal.moments.element_sum();
        let roots = (principal.moments.to_array())
            .map(|moment| 0.5 * (half - moment).max(f64::EPSILON * half).max(f64::MIN_POSITIVE).ln());
        Self::new(mass.mass().ln(), Constants::Turned(roots, (R * principal.axes).normalize()))
    }

    fn new(log_mass: f64, constants: Constants) -> Self {
        let (inertia, slopes) = match &constants {
            Constants::Free(numbers) => {
                (inertia_of_numbers(numbers), std::array::from_fn(|i| inertia_slope(numbers, i)))
            }
            Constants::Turned(roots, axes) => turned(roots, DMat3::from_quat(*axes)),
        };
        let inverse = inertia.inverse();
        Self { log_mass, constants, inverse_mass: (-log_mass).exp(), inertia, inverse, slopes }
    }

    pub(super) fn inverse_mass(&self) -> f64 {
        self.inverse_mass
    }

    pub(super) fn inertia(&self) -> DMat3 {
        self.inertia
    }

    /// In world axes, of a body turned by `R`.
    pub(super) fn inertia_along(&self, R: DMat3) -> DMat3 {
        R * self.inertia * R.transpose()
    }

    /// Its derivative by one of its constants.
    pub(super) fn slope_along(&self, R: DMat3, constant: usize) -> DMat3 {
        R * self.slopes[constant] * R.transpose()
    }

    /// Changes of the constants of the inertia that are about as large as it is.
    pub(super) fn inertia_units(&self) -> [f64; INERTIA] {
        match self.constants {
            Constants::Free([a, b, c, ..]) => {
                let root = ((a + b + c) / 3.0).exp();
                [1.0, 1.0, 1.0, root, root, root]
            }
            Constants::Turned(..) => [1.0; INERTIA],
        }
    }

    /// Whether it is one of known moments.
    pub(super) fn is_turned(&self) -> bool {
        matches!(self.constants, Constants::Turned(..))
    }

    /// How the constants of a known body change with the logarithm of its principal moment `k` alone. None of an unknown one, and where one of the second
    /// moments is so small a share of it that the body would be none.
    pub(super) fn by_moment(&self, k: usize) -> Option<SVector<f64, CONSTANTS>> {
        let Constants::Turned(roots, _) = &self.constants else { return None };
        let seconds = DVec3::from_array(roots.map(|root| (2.0 * root).exp()));
        let moment = seconds.element_sum() - seconds[k];
        // Half of a change of this moment is taken from its own second moment, and half given to each of the others.
        let root = |i: usize| if i == k { -0.25 } else { 0.25 } * moment / seconds[i];
        let by =
            SVector::<f64, CONSTANTS>::from_fn(|i, _| if (1..=3).contains(&i) { root(i - 1) } else { 0.0 });
        (by.amax() < THINNEST).then_some(by)
    }

    /// Covariance of the entries xx, yy, zz, xy, xz, yz of the inertia, by that of the constants.
    pub(super) fn inertia_covariance(&self, of: &SMatrix<f64, CONSTANTS, CONSTANTS>) -> Matrix6<f64> {
        let entry =
            |m: &DMat3, i: usize| [m.x_axis.x, m.y_axis.y, m.z_axis.z, m.x_axis.y, m.x_axis.z, m.y_axis.z][i];
        let by_constants = Matrix6::from_fn(|i, j| entry(&self.slopes[j], i));
        by_constants * of.fixed_view::<INERTIA, INERTIA>(1, 1) * by_constants.transpose()
    }

    /// How the own axes of a known body of the mass properties `mass` lie at the first sample; those of an unknown one are the world's there.
    pub(super) fn orientation(&self, mass: &MassProperties) -> DQuat {
        match self.constants {
            Constants::Free(_) => DQuat::IDENTITY,
            Constants::Turned(_, axes) => axes * mass.principal().axes.inverse(),
        }
    }

    pub(super) fn turn(&self, q: DQuat, L: DVec3) -> Turn {
        let R = DMat3::from_quat(q);
        let K = R * self.inverse * R.transpose();
        Turn { R, K, w: K * L }
    }

    /// Angular velocity, world axes, of a body turned by `q`.
    pub(super) fn spin(&self, q: DQuat, L: DVec3) -> DVec3 {
        q * (self.inverse * (q.conjugate() * L))
    }

    /// `-dI w` in world axes for each constant of the inertia: `K` times it is the change of the angular velocity.
    pub(super) fn by_inertia(&self, turn: &Turn) -> [DVec3; INERTIA] {
        let w = turn.R.transpose() * turn.w;
        self.slopes.map(|slope| -(turn.R * (slope * w)))
    }

    /// After a step of its constants. The angular momentum of a given motion is linear in the inertia, so that steps are taken straight in that
    /// where they are short: along a bend of the constants links would miss each other by the square of the step.
    pub(super) fn moved(&self, log_mass: f64, by: &Vector6<f64>) -> Self {
        let straight = match self.constants {
            Constants::Free(numbers) => {
                let straight =
                    self.slopes.iter().zip(by.iter()).fold(self.inertia, |all, (s, by)| all + *s * *by);
                let to = numbers_of_inertia(straight);
                let near = (0..3).all(|i| (to[i] - numbers[i]).abs() < STRAIGHT);
                near.then_some(Constants::Free(to))
            }
            Constants::Turned(..) => None,
        };
        match straight {
            Some(constants) => Self::new(self.log_mass + log_mass, constants),
            None => self.beside(log_mass, by),
        }
    }

    /// After a step that is straight in the constants themselves: [`Self::from`] leads back by it.
    pub(super) fn beside(&self, log_mass: f64, by: &Vector6<f64>) -> Self {
        let constants = match self.constants {
            Constants::Free(numbers) => Constants::Free(std::array::from_fn(|i| numbers[i] + by[i])),
            Constants::Turned(roots, axes) => {
                let turn = exponential(DVec3::new(by[3], by[4], by[5]));
                Constants::Turned(std::array::from_fn(|i| roots[i] + by[i]), (turn * axes).normalize())
            }
        };
        Self::new(self.log_mass + log_mass, constants)
    }

    /// The step that leads here from another body of the same kind.
    pub(super) fn from(&self, other: &Self) -> SVector<f64, CONSTANTS> {
        let inertia: [f64; INERTIA] = match (&self.constants, &other.constants) {
            (Constants::Free(to), Constants::Free(from)) => std::array::from_fn(|i| to[i] - from[i]),
            (Constants::Turned(to, axes), Constants::Turned(from, before)) => {
                let turn = logarithm((*axes * before.conjugate()).normalize());
                std::array::from_fn(|i| if i < 3 { to[i] - from[i] } else { turn[i - 3] })
            }
            // Bodies of two kinds are never compared: the kind is chosen once, with what is known beforehand.
            _ => [f64::NAN; INERTIA],
        };
        SVector::from_fn(|i, _| if i == 0 { self.log_mass - other.log_mass } else { inertia[i - 1] })
    }

    /// How that step changes with a further one.
    pub(super) fn slope_from(&self, other: &Self) -> SMatrix<f64, CONSTANTS, CONSTANTS> {
        let mut slope = SMatrix::<f64, CONSTANTS, CONSTANTS>::identity();
        if let (Constants::Turned(_, axes), Constants::Turned(_, before)) =
            (&self.constants, &other.constants)
        {
            let turn = logarithm((*axes * before.conjugate()).normalize());
            slope.fixed_view_mut::<3, 3>(4, 4).copy_from(&Matrix3::from(logarithm_slope(turn)));
        }
        slope
    }
}

/// Inertia of principal second moments whose axes are the columns of `A`, and its derivatives by the logarithms of their roots and by a
/// turn.
fn turned(roots: &[f64; 3], A: DMat3) -> (DMat3, [DMat3; INERTIA]) {
    let squares = DVec3::from_array(*roots).map(|root| (2.0 * root).exp());
    let across = |square: f64, i: usize| {
        let axis = A.col(i);
        (DMat3::IDENTITY - DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z)) * square
    };
    let inertia = across(squares.x, 0) + across(squares.y, 1) + across(squares.z, 2);
    let slopes = std::array::from_fn(|i| match i {
        0..=2 => across(2.0 * squares[i], i),
        _ => {
            let e = DVec3::AXES[i - 3];
            let cross = DMat3::from_cols(e.cross(DVec3::X), e.cross(DVec3::Y), e.cross(DVec3::Z));
            cross * inertia - inertia * cross
        }
    });
    (inertia, slopes)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both kinds of constants: small steps lead back, slopes are those of differences.
    #[test]
    fn slopes_are_those_of_differences() {
        let mass = MassProperties::from_principal(0.3, DVec3::new(2.0, 2.5, 3.1)).unwrap();
        let known = Body::turned(&mass, DQuat::from_scaled_axis(DVec3::new(0.3, -0.9, 0.4)));
        let free = Body::free(known.log_mass, known.inertia());
        for body in [known, free] {
            for i in 0..INERTIA {
                let by = |h: f64| Vector6::from_fn(|j, _| if i == j { h } else { 0.0 });
                let moved = |h: f64| body.moved(0.2, &by(h));
                let slope = (moved(1e-5).inertia() - moved(-1e-5).inertia()) * 0.5e5;
                let error = slope - body.slope_along(DMat3::IDENTITY, i);
                assert!(error.to_cols_array().iter().all(|e| e.abs() < 1e-8), "{i} {error}");
                // Straight in the inertia is straight in its constants to first order.
                let step = moved(1e-5).from(&body);
                let taken = |j: usize| match j {
                    0 => 0.2,
                    _ if j == i + 1 => 1e-5,
                    _ => 0.0,
                };
                assert!((0..CONSTANTS).all(|j| (step[j] - taken(j)).abs() < 1e-9), "{i} {step}");
            }
        }
        assert!((known.inertia() - free.inertia()).to_cols_array().iter().all(|e| e.abs() < 1e-12));
    }
}
