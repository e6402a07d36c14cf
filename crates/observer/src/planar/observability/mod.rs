//! Observability of the paper's system by Lie derivatives of its readings.
//!
//! The paper says that it is observable and cites a report. Here the derivatives are computed: exactly but for rounding, at any
//! state.

mod nilpotent;
#[cfg(test)]
mod tests;

use super::authors::{AuthorsFields, AuthorsState, Scalar};
use super::error::PlanarEstimateError;
use nalgebra::{DMatrix, SVector};
use nilpotent::Nilpotent;
use std::array;

/// The longest chain of fields.
pub const LONGEST_CHAIN: usize = 4;
/// Singular values below this share of the largest are rounding: the rank does not count them.
const RANK: f64 = 1e-10;

/// A vector field `a f + b_1 g_1 + b_2 g_2`, as its coefficients.
pub type LieField = [f64; 3];

/// Units in which states and readings count alike, so that singular values mean something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalUnits {
    /// Size of the object, m.
    pub length: f64,
    /// `sqrt(length / gravity)`, s.
    pub time: f64,
    /// Weight times size, N m.
    pub torque: f64,
}

/// What Lie derivatives of the readings tell of the state.
///
/// Gradients that are longer than one in natural units count as of length one. That changes no rank, and derivatives that grow as powers
/// of `1 / z_i` where a contact hardly moves on the object do not hide all others.
#[derive(Clone, Debug, PartialEq)]
pub struct Observability {
    /// Independent directions that are told, of 7.
    pub rank: usize,
    /// Singular values of the observability matrix in natural units, largest first.
    pub singular_values: [f64; 7],
    /// The direction of the state that is told worst, of unit length in natural units: `r_1, r_2, omega0, s_1, s_2, phi_1, phi_2`.
    pub worst: [f64; 7],
}

impl Observability {
    /// Largest over smallest singular value.
    #[must_use]
    pub fn condition(&self) -> f64 {
        self.singular_values[0] / self.singular_values[6]
    }
}

impl AuthorsFields {
    /// `L_X1 L_X2 .. L_Xn h` for the readings `h = (s_1, s_2, phi_1, phi_2)`, along at most [`LONGEST_CHAIN`] fields; and their gradients,
    /// each row that of a reading. An empty chain gives the readings.
    ///
    /// `L_X p (q)` is the coefficient of `e` in `p(q + e X(q))` with `e^2 = 0`: one such variable for each field, one more for
    /// the gradient.
    ///
    /// # Errors
    /// As [`Self::drift`]; [`PlanarEstimateError::ChainTooLong`].
    pub fn lie_derivative(
        &self,
        q: &AuthorsState,
        chain: &[LieField],
    ) -> Result<(SVector<f64, 4>, [AuthorsState; 4]), PlanarEstimateError> {
        if chain.len() > LONGEST_CHAIN {
            return Err(PlanarEstimateError::ChainTooLong { found: chain.len(), most: LONGEST_CHAIN });
        }
        self.rate(q, [0.0; 2])?;
        let mut value = SVector::zeros();
        let mut gradients = [AuthorsState::zeros(); 4];
        for direction in 0..7 {
            let mut state = perturbed(q, direction, 1.0);
            for (k, field) in chain.iter().enumerate() {
                let fields = self.at(&state);
                state = moved(&state, &fields, *field, k + 1);
            }
            // Bits of the chain's variables, without and with that of the gradient.
            let along = ((1 << chain.len()) - 1) << 1;
            for (i, reading) in state[3..].iter().enumerate() {
                value[i] = reading.coefficient(along);
                gradients[i][direction] = reading.coefficient(along | 1);
            }
        }
        Ok((value, gradients))
    }

    /// Rank and singular values of the gradients of all Lie derivatives along chains of up to `depth` of the given fields, the
    /// readings themselves included. Each field comes with the unit that makes its derivatives natural.
    ///
    /// Along `f`, `g_1` and `g_2` this is the paper's observability rank condition: torques may be anything. Along the one field of
    /// torques that are held it is what the readings tell while these act.
    ///
    /// # Errors
    /// As [`Self::lie_derivative`].
    pub fn observability(
        &self,
        q: &AuthorsState,
        fields: &[(LieField, f64)],
        depth: usize,
        units: NaturalUnits,
    ) -> Result<Observability, PlanarEstimateError> {
        if depth > LONGEST_CHAIN {
            return Err(PlanarEstimateError::ChainTooLong { found: depth, most: LONGEST_CHAIN });
        }
        self.rate(q, [0.0; 2])?;
        let state_units =
            [units.length, units.length, 1.0 / units.time, units.length, units.length, 1.0, 1.0];
        let chains = (0..=depth as u32).map(|n| fields.len().pow(n)).sum::<usize>();
        let mut matrix = DMatrix::<f64>::zeros(4 * chains, 7);
        for (direction, unit) in state_units.iter().enumerate() {
            let walk = Walk { own: self, fields, depth };
            let mut row = 0;
            walk.rows(&perturbed(q, direction, *unit), 0, 1.0, &mut |column: [f64; 4]| {
                for (i, value) in column.iter().enumerate() {
                    matrix[(4 * row + i, direction)] = value / state_units[3 + i];
                }
                row += 1;
            });
            debug_assert_eq!(row, chains);
        }
        Ok(told(matrix))
    }
}

/// All chains of fields.
struct Walk<'a> {
    own: &'a AuthorsFields,
    fields: &'a [(LieField, f64)],
    depth: usize,
}

impl Walk<'_> {
    /// Hands out the gradients of the readings along the chain that led to `state`, and along all that go on from it.
    fn rows(&self, state: &[Nilpotent; 7], length: usize, unit: f64, take: &mut impl FnMut([f64; 4])) {
        let term = (1 << (length + 1)) - 1;
        take(array::from_fn(|i| state[3 + i].coefficient(term) * unit));
        if length == self.depth {
            return;
        }
        let at = self.own.at(state);
        for (field, own) in self.fields {
            let next = moved(state, &at, *field, length + 1);
            self.rows(&next, length + 1, unit * own, take);
        }
    }
}

/// The state with the variable of the gradient along one of its components.
fn perturbed(q: &AuthorsState, direction: usize, unit: f64) -> [Nilpotent; 7] {
    array::from_fn(|i| {
        let own = Nilpotent::constant(q[i]);
        if i == direction { own + Nilpotent::variable(0, unit) } else { own }
    })
}

/// `q + e_k X(q)`.
fn moved(
    state: &[Nilpotent; 7],
    fields: &[[Nilpotent; 7]; 3],
    field: LieField,
    variable: usize,
) -> [Nilpotent; 7] {
    array::from_fn(|i| {
        let along = (0..3)
            .filter(|k| field[*k] != 0.0)
            .fold(Nilpotent::constant(0.0), |sum, k| sum + fields[k][i] * Nilpotent::constant(field[k]));
        state[i] + Nilpotent::variable(variable, 1.0) * along
    })
}

fn told(mut matrix: DMatrix<f64>) -> Observability {
    for mut row in matrix.row_iter_mut() {
        let length = row.norm();
        if length > 1.0 {
            row /= length;
        }
    }
    let svd = matrix.svd(false, true);
    let largest = svd.singular_values[0];
    let mut order: Vec<usize> = (0..7).collect();
    order.sort_by(|a, b| svd.singular_values[*b].total_cmp(&svd.singular_values[*a]));
    let singular_values = array::from_fn(|k| svd.singular_values[order[k]]);
    let worst = array::from_fn(|i| svd.v_t.as_ref().map_or(0.0, |v| v[(order[6], i)]));
    let rank = singular_values.iter().filter(|value| **value > RANK * largest).count();
    Observability { rank, singular_values, worst }
}
