//! Quasistatic reconstruction in closed form: slow palms, no forces, no masses.

use contact_kinematics::planar::{PalmPair, PalmPairError};
use glam::DVec2;
use object_dynamics::integrate::find_root;
use object_dynamics::planar::{PlanarLog, PlanarSample};
use thiserror::Error;

/// Height of the centre of mass over the meeting point of the lines of force, as a share of the contact distances, below
/// which the turn of the object cannot be computed: it is divided by its square.
const SMALLEST_HEIGHT: f64 = 1e-6;
/// Change of the closure over the bracket, in rad, below which it says nothing about the height.
const SMALLEST_CLOSURE: f64 = 1e-9;

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

/// Height of the centre of mass from the closure of the orientation on a loop of the palms.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightFit {
    /// Height of the centre of mass at the first sample, m.
    pub height: f64,
    /// Change of the closure with the height, rad/m. The deviation of the height is that of the closing orientation over this.
    pub sensitivity: f64,
}

/// Why a quasistatic reconstruction cannot be made.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum QuasistaticError {
    /// Fewer than four samples.
    #[error("{found} sample(s) given, at least 4 are needed")]
    TooFewSamples {
        /// How many there are.
        found: usize,
    },
    /// A palm has no contact.
    #[error("palm {palm} has no contact at sample {sample}")]
    LostContact {
        /// 1 or 2.
        palm: usize,
        /// Index from 0.
        sample: usize,
    },
    /// The wedge is closed or flat.
    #[error("sample {sample}: {source}")]
    Palms {
        /// Index from 0.
        sample: usize,
        /// Why.
        source: PalmPairError,
    },
    /// The centre of mass is where the lines of force meet, as in a centred disc: the orientation cannot be seen.
    #[error(
        "at sample {sample} the centre of mass is {lever:.3e} m from where the lines of force meet; the turn of the object cannot be seen there"
    )]
    NoLever {
        /// Index from 0.
        sample: usize,
        /// Lever in m.
        lever: f64,
    },
    /// The palms do not come back to where they started.
    #[error("palms end {distance:.3e} rad from where they started; closure needs a loop")]
    NoLoop {
        /// Distance in rad.
        distance: f64,
    },
    /// The loop does not say where the centre of mass is.
    #[error(
        "closure changes from {low:.3e} to {high:.3e} rad over the bracket; give another bracket or a loop on which the angle between the palms changes"
    )]
    NoClosure {
        /// Closure at the lower height, rad.
        low: f64,
        /// Closure at the upper height, rad.
        high: f64,
    },
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

/// Height of the centre of mass at the first sample for which the orientation closes on a loop of the palms, between two
/// heights (m).
///
/// On a loop that ends where it began the object is back in the same equilibrium, if it stayed on one stable branch. The
/// height enters the closure only weakly, and not at all while the angle between the palms is constant.
///
/// # Errors
/// [`QuasistaticError`]: no loop, no closure within the bracket, or what [`quasistatic_reconstruction`] refuses.
pub fn height_from_closure(log: &PlanarLog, bracket: [f64; 2]) -> Result<HeightFit, QuasistaticError> {
    let samples = log.samples();
    let (first, last) = (samples[0].angles, samples[samples.len() - 1].angles);
    let distance = (first[0] - last[0]).hypot(first[1] - last[1]);
    let path: f64 = samples
        .windows(2)
        .map(|w| (w[1].angles[0] - w[0].angles[0]).hypot(w[1].angles[1] - w[0].angles[1]))
        .sum();
    if distance.is_nan() || distance > 1e-6 * path {
        return Err(QuasistaticError::NoLoop { distance });
    }
    let closure = |height: f64| {
        quasistatic_reconstruction(log, height).map(|p| p.points.last().map_or(f64::NAN, |p| p.phi0))
    };
    let (low, high) = (closure(bracket[0])?, closure(bracket[1])?);
    let size = bracket[0].abs().max(bracket[1].abs());
    let root = find_root(|h| closure(h).unwrap_or(f64::NAN), bracket[0], bracket[1], 1e-12 * size);
    let height = match root {
        Ok(height) if (high - low).abs() > SMALLEST_CLOSURE => height,
        _ => return Err(QuasistaticError::NoClosure { low, high }),
    };
    let step = 1e-4 * (bracket[1] - bracket[0]);
    let sensitivity = (closure(height + step)? - closure(height - step)?) / (2.0 * step);
    Ok(HeightFit { height, sensitivity })
}

/// Integral of `f dg` over each interval between samples: cubics through the four nearest samples, three-point Gauss rule.
fn line_integral(f: &[f64], g: &[f64]) -> Vec<f64> {
    let gauss = 0.5 * 0.6_f64.sqrt();
    let rule = [(0.5 - gauss, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + gauss, 5.0 / 18.0)];
    (0..f.len() - 1)
        .map(|k| {
            let from = k.saturating_sub(1).min(f.len() - 4);
            let at = (k - from) as f64;
            let part = |(u, weight): (f64, f64)| {
                weight * cubic(&f[from..from + 4], at + u).0 * cubic(&g[from..from + 4], at + u).1
            };
            rule.into_iter().map(part).sum()
        })
        .collect()
}

/// Cubic through four values at 0, 1, 2, 3, and its slope, at `u`; Newton's forward differences.
fn cubic(v: &[f64], u: f64) -> (f64, f64) {
    let d1 = v[1] - v[0];
    let d2 = v[2] - 2.0 * v[1] + v[0];
    let d3 = v[3] - 3.0 * (v[2] - v[1]) - v[0];
    let value = v[0] + u * (d1 + (u - 1.0) / 2.0 * (d2 + (u - 2.0) / 3.0 * d3));
    let slope = d1 + (2.0 * u - 1.0) / 2.0 * d2 + (3.0 * u * u - 6.0 * u + 2.0) / 6.0 * d3;
    (value, slope)
}
