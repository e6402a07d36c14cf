//! Accelerations and forces of one set of modes.

use super::{ContactProblem, PlanarMode, feasible};
use glam::DVec2;
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use thiserror::Error;

/// Rows or columns whose smallest singular value is below this share of the largest count as dependent: forces that
/// are 1e9 times what they do to the body would be needed to tell them apart.
const DEPENDENT: f64 = 1e-9;
/// Share of its terms up to which a solution of dependent equations may miss them: rounding, amplified by the least
/// independent of them.
const CONTRADICTION: f64 = 1e-9;

/// What a body does under one set of modes.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::planar) struct Response {
    /// Acceleration of the centre of mass, m/s^2.
    pub(in crate::planar) a_WCm: DVec2,
    /// Angular acceleration, rad/s^2.
    pub(in crate::planar) alpha0: f64,
    /// Force of each palm on the body along its normal and its tangent, N; zero where the contact is off.
    pub(in crate::planar) forces: Vec<[f64; 2]>,
    /// Whether the forces are not unique: bodies stuck on several palms squeeze themselves. They are then those of
    /// least size within the friction cones, or, where there are none, of least size.
    pub(in crate::planar) redundant: bool,
    /// What the palms' motion leaves of constraints that contradict each other, m/s^2; zero but for rounding where it
    /// can be followed.
    pub(in crate::planar) torn: f64,
    /// Mass-weighted acceleration.
    pub(super) x: Vector3<f64>,
}

/// Why a set of modes has no accelerations: friction makes the forces infinite, or undetermined together with the
/// acceleration.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("friction leaves forces and acceleration undetermined: the contacts are jammed")]
pub struct Jammed;

/// The linear system of a set: `rows . x = -biases`, `x = free + columns forces`.
struct System {
    rows: Vec<Vector3<f64>>,
    biases: Vec<f64>,
    columns: Vec<Vector3<f64>>,
}

/// Least-norm solution of a system of rows in three unknowns.
pub(super) struct LeastNorm {
    pub(super) solution: Vector3<f64>,
    /// Shares of the rows in it: `solution = sum of shares rows`.
    pub(super) shares: Vec<f64>,
    rank: usize,
    residual: f64,
}

impl ContactProblem {
    /// Accelerations and forces under `modes`, one for each contact, whatever the signs of the forces.
    ///
    /// Row `n` for sliding contacts with the force along `n - mu sense t`; rows and forces along `n` and `t` for
    /// sticking ones.
    pub(in crate::planar) fn respond(&self, modes: &[PlanarMode]) -> Result<Response, Jammed> {
        let system = self.assemble(modes);
        let size = system.rows.len();
        if size == 0 {
            return Ok(self.response(modes, self.free, &[], None));
        }
        if size <= 3 && independent(&system.rows) {
            return self.regular(modes, &system);
        }
        self.redundant(modes, &system)
    }

    fn assemble(&self, modes: &[PlanarMode]) -> System {
        let mut system = System { rows: Vec::new(), biases: Vec::new(), columns: Vec::new() };
        for (c, mode) in self.contacts.iter().zip(modes) {
            match *mode {
                PlanarMode::Off => {}
                PlanarMode::Slide { sense } => {
                    system.rows.push(c.normal);
                    system.biases.push(c.contact.biases[0]);
                    system.columns.push(c.normal - c.tangent * (c.contact.mu * sense));
                }
                PlanarMode::Stick => {
                    for (row, bias) in [c.normal, c.tangent].into_iter().zip(c.contact.biases) {
                        system.rows.push(row);
                        system.biases.push(bias);
                        system.columns.push(row);
                    }
                }
            }
        }
        system
    }

    /// At most three independent rows: the forces are unique unless friction makes the matrix singular.
    fn regular(&self, modes: &[PlanarMode], system: &System) -> Result<Response, Jammed> {
        let size = system.rows.len();
        let (mut matrix, mut right) = (Matrix3::identity(), Vector3::zeros());
        for i in 0..size {
            for j in 0..size {
                matrix[(i, j)] = system.rows[i].dot(&system.columns[j]);
            }
            right[i] = -(system.rows[i].dot(&self.free) + system.biases[i]);
        }
        let lengths = |list: &[Vector3<f64>]| list.iter().map(Vector3::norm).product::<f64>();
        let volume = matrix.determinant().abs() / (lengths(&system.rows) * lengths(&system.columns));
        if volume.is_nan() || volume < DEPENDENT {
            return Err(Jammed);
        }
        let forces = matrix.lu().solve(&right).ok_or(Jammed)?;
        let x = if size == 3 {
            // The palms alone determine the motion: what rests on them rests exactly.
            let matrix = Matrix3::from_fn(|i, j| system.rows[i][j]);
            let biases = Vector3::from_fn(|i, _| -system.biases[i]);
            matrix.lu().solve(&biases).ok_or(Jammed)?
        } else {
            (0..size).fold(self.free, |x, i| x + system.columns[i] * forces[i])
        };
        Ok(self.response(modes, x, &forces.as_slice()[..size], None))
    }

    /// More rows than are independent: the motion is unique where they do not contradict each other (where they do,
    /// it is that of least squares), the forces are not.
    fn redundant(&self, modes: &[PlanarMode], system: &System) -> Result<Response, Jammed> {
        let size = system.rows.len();
        let right: Vec<f64> = system.biases.iter().map(|b| -b).collect();
        let motion = least_norm(&system.rows, &right);
        let columns = DMatrix::from_fn(3, size, |i, j| system.columns[j][i]);
        // Square, so that its decomposition holds the null space too.
        let side = size.max(3);
        let mut matrix = DMatrix::zeros(side, size);
        let mut wanted = DVector::zeros(side);
        if motion.rank == 3 {
            matrix.view_mut((0, 0), (3, size)).copy_from(&columns);
            wanted.rows_mut(0, 3).copy_from(&(motion.solution - self.free));
        } else {
            for i in 0..size {
                for j in 0..size {
                    matrix[(i, j)] = system.rows[i].dot(&system.columns[j]);
                }
                wanted[i] = right[i] - system.rows[i].dot(&self.free);
            }
        }
        let (least, null) = split(&matrix, &wanted).ok_or(Jammed)?;
        let terms = wanted.norm() + matrix.norm() * least.norm();
        let contradicts = motion.residual > CONTRADICTION * self.scale();
        if !contradicts && (&matrix * &least - &wanted).norm() > CONTRADICTION * terms {
            return Err(Jammed);
        }
        let squeezed = &columns * &null;
        if squeezed.norm() > CONTRADICTION.sqrt() * columns.norm() {
            return Err(Jammed);
        }
        let forces = feasible::within_cones(&least, &null, &self.cones(modes, size)).unwrap_or(least);
        let x = if motion.rank == 3 {
            motion.solution
        } else {
            let push = &columns * &forces;
            self.free + Vector3::new(push[0], push[1], push[2])
        };
        Ok(self.response(modes, x, forces.as_slice(), Some(motion.residual)))
    }

    /// Rows `H` of the cones `H forces >= 0`: normal forces push, sticking ones stay within friction.
    fn cones(&self, modes: &[PlanarMode], size: usize) -> DMatrix<f64> {
        let (mut rows, mut at) = (Vec::new(), 0);
        for (c, mode) in self.contacts.iter().zip(modes) {
            match mode {
                PlanarMode::Off => {}
                PlanarMode::Slide { .. } => {
                    rows.push(DVector::from_fn(size, |i, _| f64::from(i == at)));
                    at += 1;
                }
                PlanarMode::Stick => {
                    for side in [-1.0, 1.0] {
                        let mu = c.contact.mu;
                        rows.push(DVector::from_fn(size, |i, _| {
                            mu * f64::from(i == at) + side * f64::from(i == at + 1)
                        }));
                    }
                    at += 2;
                }
            }
        }
        DMatrix::from_fn(rows.len(), size, |i, j| rows[i][j])
    }

    fn response(&self, modes: &[PlanarMode], x: Vector3<f64>, parts: &[f64], torn: Option<f64>) -> Response {
        let mut parts = parts.iter();
        let mut next = || parts.next().copied().unwrap_or(0.0);
        let forces = self.contacts.iter().zip(modes).map(|(c, mode)| match *mode {
            PlanarMode::Off => [0.0, 0.0],
            PlanarMode::Slide { sense } => {
                let normal = next();
                [normal, -c.contact.mu * sense * normal]
            }
            PlanarMode::Stick => [next(), next()],
        });
        let forces = forces.collect();
        let (a_WCm, alpha0) = self.unweighted(&x);
        Response { a_WCm, alpha0, forces, redundant: torn.is_some(), torn: torn.unwrap_or(0.0), x }
    }

    /// Size of the rates at hand, m/s^2: what rounding is a share of.
    pub(super) fn scale(&self) -> f64 {
        let free = self.free.norm() / self.roots[0];
        let biases = self.contacts.iter().flat_map(|c| c.contact.biases).map(f64::abs);
        biases.fold(free, f64::max).max(f64::MIN_POSITIVE)
    }
}

/// Whether up to three rows are linearly independent.
fn independent(rows: &[Vector3<f64>]) -> bool {
    let volume = match *rows {
        [] | [_] => 1.0,
        [a, b] => a.cross(&b).norm() / (a.norm() * b.norm()),
        [a, b, c] => a.cross(&b).dot(&c).abs() / (a.norm() * b.norm() * c.norm()),
        _ => 0.0,
    };
    volume > DEPENDENT
}

/// Steps within which singular values are found, if at all: without a limit there are matrices in which they are looked for without end.
pub(super) const STEPS: usize = 1000;

/// Solution of least size of `rows . x = right`, in the sense of least squares.
pub(super) fn least_norm(rows: &[Vector3<f64>], right: &[f64]) -> LeastNorm {
    if rows.is_empty() {
        return LeastNorm { solution: Vector3::zeros(), shares: Vec::new(), rank: 0, residual: 0.0 };
    }
    let matrix = DMatrix::from_fn(rows.len().max(3), 3, |i, j| rows.get(i).map_or(0.0, |row| row[j]));
    let none = || {
        let shares = vec![0.0; rows.len()];
        LeastNorm { solution: Vector3::zeros(), shares, rank: 0, residual: f64::INFINITY }
    };
    let Some(svd) = matrix.try_svd(true, true, f64::EPSILON, STEPS) else { return none() };
    let (Some(u), Some(v_t)) = (svd.u.as_ref(), svd.v_t.as_ref()) else { return none() };
    let limit = DEPENDENT * svd.singular_values.max();
    let (mut solution, mut shares, mut rank) = (Vector3::zeros(), vec![0.0; rows.len()], 0);
    for k in 0..3 {
        if svd.singular_values[k] > limit {
            let part: f64 = right.iter().enumerate().map(|(i, r)| u[(i, k)] * r).sum();
            let length = part / svd.singular_values[k];
            solution += Vector3::new(v_t[(k, 0)], v_t[(k, 1)], v_t[(k, 2)]) * length;
            for (i, share) in shares.iter_mut().enumerate() {
                *share += u[(i, k)] * length / svd.singular_values[k];
            }
            rank += 1;
        }
    }
    let left = rows.iter().zip(right).map(|(row, r)| (row.dot(&solution) - r).abs());
    LeastNorm { solution, shares, rank, residual: left.fold(0.0, f64::max) }
}

/// Least-norm solution of a square system, and an orthonormal basis of its null space.
fn split(matrix: &DMatrix<f64>, wanted: &DVector<f64>) -> Option<(DVector<f64>, DMatrix<f64>)> {
    let svd = matrix.clone().try_svd(true, true, f64::EPSILON, STEPS)?;
    let limit = DEPENDENT * svd.singular_values.max();
    let v_t = svd.v_t.as_ref()?;
    let null: Vec<_> = (0..svd.singular_values.len())
        .filter(|&k| svd.singular_values[k] <= limit)
        .map(|k| v_t.row(k).transpose())
        .collect();
    let basis = DMatrix::from_fn(matrix.ncols(), null.len(), |i, j| null[j][i]);
    Some((svd.solve(wanted, limit).ok()?, basis))
}
