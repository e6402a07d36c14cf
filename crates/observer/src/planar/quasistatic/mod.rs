//! Quasistatic reconstruction in closed form: slow palms, no forces, no masses.

mod closure;
mod error;
mod quadrature;

pub use closure::{HeightFit, height_from_closure};
pub use error::QuasistaticError;

use contact_kinematics::planar::PalmPair;
use glam::DVec2;
use object_dynamics::planar::{PlanarLog, PlanarSample};
use quadrature::line_integral;

/// Height of the centre of mass over the meeting point of the lines of force, as a share of the contact distances, below
/// which the turn of the object cannot be computed: it is divided by its square.
const SMALLEST_HEIGHT: f64 = 1e-6;
/// One instant of a quasistatic reconstruction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuasistaticPoint {
    /// Time, s.
    pub t: f64,
    /// Centre of mass in the world, m.
    pub p_WCm: DVec2,
    /// Orientation against the first sample, rad.
    pub phi0: f64,
    /// Radius functions at the contacts, m.
    pub radii: [f64; 2],
    /// Contact offsets along the tangents, m.
    pub offsets: [f64; 2],
    /// Contact points in body axes (those of the world at the first sample), m.
    pub contact_points: [DVec2; 2],
    /// Height of the centre of mass over the meeting point of the lines of force, m. Zero means a disc: no turn can be seen.
    pub lever: f64,
}

/// A quasistatic reconstruction with its conditions.
#[derive(Clone, Debug, PartialEq)]
pub struct QuasistaticPath {
    /// One point a sample.
    pub points: Vec<QuasistaticPoint>,
    /// Largest ratio of contact distance to lever: how much noise in the contacts is amplified in the orientation.
    pub condition: f64,
    /// Largest difference of the two palms' accounts of the turn over one interval, rad, and the sample at its end. At a fold
    /// the object jumps, the balance does not hold in between, and this difference stands out.
    pub mismatch: (f64, usize),
    /// Root mean square of those differences, rad.
    pub mismatch_rms: f64,
    /// Largest ratio of the object's turn to the palms' turn over one interval, and the sample at its end. It grows without
    /// bound towards a fold.
    pub gain: (f64, usize),
}

/// Palms and contacts of one sample and what follows from them alone.
struct Row {
    t: f64,
    angles: [f64; 2],
    sines: [f64; 2],
    pair: PalmPair,
    s: [f64; 2],
    /// Horizontal place of the centre of mass.
    x: f64,
    /// Height of the meeting point of the lines of force.
    meeting: f64,
}

/// Reconstruction from contacts and palm angles, given the height (m) of the centre of mass at the first sample.
///
/// Balance puts the centre of mass on the vertical through the meeting point of the lines of force (the paper's geometric
/// argument): `X = (s_1 sin P_2 - s_2 sin P_1) / sin phi2`. Its height follows from the palms' work, `dY = (s_1 sin P_2 dP_1 -
/// s_2 sin P_1 dP_2) / sin phi2`, a quadrature of readings that are nowhere differentiated. Then `r_i = n_i . cm`,
/// `d_1 = h sin P_1`, `d_2 = -h sin P_2` with the lever `h`, and the orientation from `d_i^2`-weighted
/// `dphi_0 = dP_i + dr_i / d_i`. An error of the height stays constant along the path. Quadratures are of fourth order.
///
/// # Errors
/// [`QuasistaticError`]: lost contact, a closed wedge, too few samples, or no lever.
pub fn quasistatic_reconstruction(log: &PlanarLog, height: f64) -> Result<QuasistaticPath, QuasistaticError> {
    let rows = rows(log)?;
    let angle = |i: usize| -> Vec<f64> { rows.iter().map(|r| r.angles[i]).collect() };
    let column = |f: &dyn Fn(&Row) -> f64| -> Vec<f64> { rows.iter().map(f).collect() };
    let angles = [angle(0), angle(1)];
    let rise1 = line_integral(&column(&|r| r.s[0] * r.sines[1] / r.pair.sin()), &angles[0]);
    let rise2 = line_integral(&column(&|r| -r.s[1] * r.sines[0] / r.pair.sin()), &angles[1]);
    let mut y = height;
    let mut heights = vec![y];
    for (a, b) in rise1.iter().zip(&rise2) {
        y += a + b;
        heights.push(y);
    }
    let levers: Vec<f64> = rows.iter().zip(&heights).map(|(r, y)| y - r.meeting).collect();
    if let Some(sample) = (0..rows.len()).find(|&k| {
        let size = rows[k].s[0].abs().max(rows[k].s[1].abs());
        // A lever that changes sign was zero in between; a NaN is refused too.
        levers[k].is_nan() || levers[k].abs() <= SMALLEST_HEIGHT * size || levers[k] * levers[0] < 0.0
    }) {
        return Err(QuasistaticError::NoLever { sample, lever: levers[sample] });
    }
    let radii: [Vec<f64>; 2] = [0, 1].map(|i| {
        rows.iter().zip(&heights).map(|(r, &y)| r.pair.normals()[i].dot(DVec2::new(r.x, y))).collect()
    });
    let offsets = [0, 1].map(|i| -> Vec<f64> {
        let sign = if i == 0 { 1.0 } else { -1.0 };
        rows.iter().zip(&levers).map(|(r, h)| sign * h * r.sines[i]).collect()
    });
    Ok(assemble(&rows, &heights, &levers, &radii, &offsets, &angles))
}

fn rows(log: &PlanarLog) -> Result<Vec<Row>, QuasistaticError> {
    let found = log.samples().len();
    if found < 4 {
        return Err(QuasistaticError::TooFewSamples { found });
    }
    log.samples().iter().enumerate().map(|(sample, s)| row(sample, s)).collect()
}

fn row(sample: usize, reading: &PlanarSample) -> Result<Row, QuasistaticError> {
    let pair = reading.palms().map_err(|source| QuasistaticError::Palms { sample, source })?;
    let mut s = [0.0; 2];
    for (i, contact) in reading.contacts.iter().enumerate() {
        s[i] = contact.ok_or(QuasistaticError::LostContact { palm: i + 1, sample })?;
    }
    let angles = pair.angles();
    let [u1, u2] = pair.along();
    let x = (s[0] * u2.y - s[1] * u1.y) / pair.sin();
    let meeting = (s[1] * u1.x - s[0] * u2.x) / pair.sin();
    Ok(Row { t: reading.t, angles, sines: [u1.y, u2.y], pair, s, x, meeting })
}

/// Orientation and conditions.
fn assemble(
    rows: &[Row],
    heights: &[f64],
    levers: &[f64],
    radii: &[Vec<f64>; 2],
    offsets: &[Vec<f64>; 2],
    angles: &[Vec<f64>; 2],
) -> QuasistaticPath {
    let squares: Vec<f64> = offsets[0].iter().zip(&offsets[1]).map(|(a, b)| a * a + b * b).collect();
    let shares = [0, 1].map(|i| -> [Vec<f64>; 2] {
        let share = |power: i32| offsets[i].iter().zip(&squares).map(|(d, q)| d.powi(power) / q).collect();
        [share(2), share(1)]
    });
    // Each palm's account of the turn, weighted: (d^2 dP + d dr) / sum d^2.
    let accounts = [0, 1].map(|i| -> Vec<f64> {
        let by_palm = line_integral(&shares[i][0], &angles[i]);
        let by_radius = line_integral(&shares[i][1], &radii[i]);
        by_palm.iter().zip(&by_radius).map(|(a, b)| a + b).collect()
    });
    let mut phi0 = 0.0;
    let mut points = Vec::with_capacity(rows.len());
    let (mut mismatch, mut sum, mut gain, mut condition) = ((0.0, 0), 0.0, (0.0, 0), 0.0_f64);
    for (k, row) in rows.iter().enumerate() {
        if k > 0 {
            let [a, b] = [accounts[0][k - 1], accounts[1][k - 1]];
            phi0 += a + b;
            let share = 0.5 * (shares[0][0][k - 1] + shares[0][0][k]);
            let difference = share_difference(a, b, share);
            sum += difference * difference;
            if difference.abs() > mismatch.0 {
                mismatch = (difference.abs(), k);
            }
            let palms = (angles[0][k] - angles[0][k - 1]).hypot(angles[1][k] - angles[1][k - 1]);
            if palms > 0.0 && (a + b).abs() / palms > gain.0 {
                gain = ((a + b).abs() / palms, k);
            }
        }
        condition = condition.max(row.s[0].abs().max(row.s[1].abs()) / levers[k].abs());
        let (r, d) = ([radii[0][k], radii[1][k]], [offsets[0][k], offsets[1][k]]);
        let ([n1, n2], [u1, u2]) = (row.pair.normals(), row.pair.along());
        let back = DVec2::from_angle(-phi0);
        points.push(QuasistaticPoint {
            t: row.t,
            p_WCm: DVec2::new(row.x, heights[k]),
            phi0,
            radii: r,
            offsets: d,
            contact_points: [back.rotate(-n1 * r[0] - u1 * d[0]), back.rotate(-n2 * r[1] + u2 * d[1])],
            lever: levers[k],
        });
    }
    let mismatch_rms = (sum / (rows.len() - 1) as f64).sqrt();
    QuasistaticPath { points, condition, mismatch, mismatch_rms, gain }
}

/// Difference of the two accounts of the turn from their weighted parts; zero where one palm has no say.
fn share_difference(first: f64, second: f64, share: f64) -> f64 {
    if share <= 1e-6 || share >= 1.0 - 1e-6 { 0.0 } else { first / share - second / (1.0 - share) }
}
