use super::{SurfaceError, SurfacePose, SurfaceState};
use glam::{DMat3, DQuat, DVec3};

/// Fewest rows through which a not-a-knot spline goes.
const FEWEST_ROWS: usize = 4;
/// Farthest turn between two rows, degrees: beyond it which way the palm has turned is no more than a guess.
const FARTHEST_TURN: f64 = 90.0;

/// A motion through given poses: cubic splines through positions and quaternions, with the ends left free (not-a-knot).
///
/// Velocity and acceleration are continuous. Between rows `h` apart the pose is off by about `h^4 / 384` times the
/// fourth derivative of the motion, the acceleration by `h^2 / 12` times. Before the first row and after the last the palm
/// rests in the pose of that row.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseTable {
    times: Vec<f64>,
    values: Vec<[f64; 7]>,
    /// Second derivatives at the rows.
    bends: Vec<[f64; 7]>,
}

impl PoseTable {
    /// Through `poses` at strictly increasing times in s.
    ///
    /// Of the two quaternions of an orientation the one near that of the row before is taken.
    ///
    /// # Errors
    /// [`SurfaceError::Table`], and those of [`SurfacePose::new`] and [`SurfacePose::check_step`].
    pub fn new(poses: &[(f64, SurfacePose)]) -> Result<Self, SurfaceError> {
        let rows = poses.len();
        let mut times: Vec<f64> = Vec::with_capacity(rows);
        let mut values: Vec<[f64; 7]> = Vec::with_capacity(rows);
        for (row, &(time, pose)) in poses.iter().enumerate() {
            let SurfacePose { p_WP: p, R_WP } = SurfacePose::new(pose.p_WP, pose.R_WP)?;
            let in_order = time.is_finite() && times.last().is_none_or(|&before| time > before);
            if !in_order {
                return Err(SurfaceError::Table { row, time, rows });
            }
            if let Some(&(earlier, before)) = row.checked_sub(1).and_then(|k| poses.get(k)) {
                pose.check_step(&before, time - earlier, row, FARTHEST_TURN)?;
            }
            let before = values.last().map_or(R_WP, |v| DQuat::from_xyzw(v[3], v[4], v[5], v[6]));
            let q = if before.dot(R_WP) < 0.0 { -R_WP } else { R_WP };
            times.push(time);
            values.push([p.x, p.y, p.z, q.x, q.y, q.z, q.w]);
        }
        if rows < FEWEST_ROWS {
            return Err(SurfaceError::Table { row: 0, time: times.first().copied().unwrap_or(0.0), rows });
        }
        let bends = not_a_knot(&times, &values);
        Ok(Self { times, values, bends })
    }

    /// Times of the rows in s.
    #[must_use]
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Pose, velocity and acceleration at time `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> SurfaceState {
        let last = self.times.len() - 1;
        let inside = t.clamp(self.times[0], self.times[last]);
        let [value, mut rate, mut bend] = self.spline(inside);
        if inside != t {
            (rate, bend) = ([0.0; 7], [0.0; 7]);
        }
        let position = |v: &[f64; 7]| DVec3::new(v[0], v[1], v[2]);
        let quaternion = |v: &[f64; 7]| DQuat::from_xyzw(v[3], v[4], v[5], v[6]);
        let (s, s1, s2) = (quaternion(&value), quaternion(&rate), quaternion(&bend));
        // For s of any length: w = 2 Im(s' s*) / |s|^2, and its rate. Lengths stay near 1: neighbours have s . s > 0.
        let square = s.length_squared();
        let w_WP = 2.0 / square * (s1 * s.conjugate()).xyz();
        let alpha_WP = 2.0 / square * ((s2 * s.conjugate()).xyz() - s.dot(s1) * w_WP);
        SurfaceState {
            p_WP: position(&value),
            R_WP: DMat3::from_quat(s.normalize()),
            v_WP: position(&rate),
            w_WP,
            a_WP: position(&bend),
            alpha_WP,
        }
    }

    /// Value, first and second derivative of the splines at a time inside of the table.
    fn spline(&self, t: f64) -> [[f64; 7]; 3] {
        let k = self.times.partition_point(|&row| row <= t).clamp(1, self.times.len() - 1);
        let (start, h) = (self.times[k - 1], self.times[k] - self.times[k - 1]);
        let (b, a) = ((t - start) / h, 1.0 - (t - start) / h);
        let mut result = [[0.0; 7]; 3];
        for i in 0..7 {
            let (y0, y1) = (self.values[k - 1][i], self.values[k][i]);
            let (m0, m1) = (self.bends[k - 1][i], self.bends[k][i]);
            result[0][i] = a * y0 + b * y1 + ((a * a * a - a) * m0 + (b * b * b - b) * m1) * h * h / 6.0;
            result[1][i] = (y1 - y0) / h + ((3.0 * b * b - 1.0) * m1 - (3.0 * a * a - 1.0) * m0) * h / 6.0;
            result[2][i] = a * m0 + b * m1;
        }
        result
    }
}

/// Second derivatives of the cubic spline whose third derivative does not jump at the first and the last inner row.
///
/// The tridiagonal system is diagonally dominant but for its ends, which stay above zero: no pivoting is needed.
fn not_a_knot(times: &[f64], values: &[[f64; 7]]) -> Vec<[f64; 7]> {
    let n = times.len();
    let h = |k: usize| times[k + 1] - times[k];
    let mut diagonal = vec![0.0; n];
    let mut above = vec![0.0; n];
    let mut bends = vec![[0.0; 7]; n];
    for k in 1..n - 1 {
        let (before, after) = (h(k - 1), h(k));
        let mut below = before;
        (diagonal[k], above[k]) = (2.0 * (before + after), after);
        if k == 1 {
            // M_0 = M_1 + (M_1 - M_2) h_0 / h_1.
            diagonal[k] += before + before * before / after;
            above[k] -= before * before / after;
            below = 0.0;
        }
        if k == n - 2 {
            diagonal[k] += after + after * after / before;
            below -= after * after / before;
            above[k] = 0.0;
        }
        let factor = if k > 1 { below / diagonal[k - 1] } else { 0.0 };
        diagonal[k] -= factor * above[k - 1];
        for i in 0..7 {
            let slope = |k: usize| (values[k + 1][i] - values[k][i]) / h(k);
            bends[k][i] = 6.0 * (slope(k) - slope(k - 1)) - factor * bends[k - 1][i];
        }
    }
    for k in (1..n - 1).rev() {
        for i in 0..7 {
            let next = if k + 1 < n - 1 { above[k] * bends[k + 1][i] } else { 0.0 };
            bends[k][i] = (bends[k][i] - next) / diagonal[k];
        }
    }
    let (first, last) = (h(0) / h(1), h(n - 2) / h(n - 3));
    for i in 0..7 {
        bends[0][i] = bends[1][i] + (bends[1][i] - bends[2][i]) * first;
        bends[n - 1][i] = bends[n - 2][i] + (bends[n - 2][i] - bends[n - 3][i]) * last;
    }
    bends
}
