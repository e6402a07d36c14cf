//! Logs of three flat palms through one point, the only ones that the estimators of frictionless motion know, and back.

mod error;
mod from;

pub use error::NotThreePlanes;

use super::record::{ForceChannel, MeasuredMotion, SensedAxes, TwistSource};
use super::{ContactLog, LoggedPalm};
use crate::{PalmReading, Sample, SensorLog, TrueState};
use contact_kinematics::{Direction, PalmError, PalmFrame, PalmSurface};
use glam::{DMat3, DVec3};

/// Planes that pass the point in which they meet at this share of the distance of the contacts from it, or nearer, are taken
/// to go through it: the rounding of a file with nine digits.
const MEETING: f64 = 1e-9;
/// Smallest ratio of tangential and normal force that is not the rounding of a file with nine digits.
const ROUNDED_FORCE: f64 = 1e-8;
/// Share of a palm's largest angular velocity up to which a component is the rounding of a file with six digits.
const ROUNDED_TURN: f64 = 1e-6;
/// Squared condition of three normals at which [`contact_kinematics::PalmTriple`] takes them for parallel to one plane.
const SQUARED_CONDITION: f64 = 1e12;
/// Where noise alone has made tangential forces agree from sample to sample, of a million logs one is refused: by the bound
/// `exp(-x^2 / 2)` of self-normalised sums of symmetric terms.
const DEVIATIONS: f64 = 5.26;

/// A log of three flat palms through the origin, and where in the world that origin is.
#[derive(Clone, Debug, PartialEq)]
pub struct ThreePlanes {
    /// The log, seen from the point in which the palms meet.
    pub log: SensorLog,
    /// That point, world, m: to be added to what is estimated from the log.
    pub p_WM: DVec3,
    /// How far the farthest palm passes it, m. A palm off along its normal leaves the motion as it is, and moves the surface of
    /// the object by as much.
    pub apart: f64,
}

/// Palms that meet in the world's origin.
impl From<SensorLog> for ThreePlanes {
    fn from(log: SensorLog) -> Self {
        Self { log, p_WM: DVec3::ZERO, apart: 0.0 }
    }
}

impl ContactLog {
    /// The log as one of three flat palms through the origin: normals, contacts and normal forces. Impulses are left out.
    ///
    /// # Errors
    /// [`NotThreePlanes`] names what the estimators of frictionless motion on three such palms do not know.
    pub fn three_planes(&self) -> Result<ThreePlanes, NotThreePlanes> {
        self.three_planes_within(0.0)
    }

    /// The same of palms whose poses are only known to within `apart`, m: they may pass each other by as much.
    ///
    /// # Errors
    /// As [`Self::three_planes`].
    pub fn three_planes_within(&self, apart: f64) -> Result<ThreePlanes, NotThreePlanes> {
        let [a, b, c] = &self.palms[..] else {
            return Err(NotThreePlanes::Count { found: self.palms.len() });
        };
        let palms = [a, b, c];
        if let Some(i) = palms.iter().position(|palm| palm.surface != PalmSurface::Plane) {
            return Err(NotThreePlanes::Curved { palm: i + 1, kind: palms[i].surface.name() });
        }
        check_friction(palms, self.times.len())?;
        let (p_WM, apart) = self.meeting_point(palms, apart)?;
        let has_rate = palms.map(|palm| palm.twist_source() == TwistSource::Stated && self.is_about_t1(palm));
        let sample = |k: usize| {
            let reading = |i: usize| {
                self.reading((palms[i], has_rate[i]), k, (p_WM, apart)).map_err(|source| {
                    NotThreePlanes::Frame { palm: i + 1, sample: k, time: self.times[k], source }
                })
            };
            Ok::<_, NotThreePlanes>(Sample {
                t: self.times[k],
                palms: [reading(0)?, reading(1)?, reading(2)?],
            })
        };
        let mut samples = Vec::with_capacity(self.times.len());
        for k in 0..self.times.len() {
            samples.push(sample(k)?);
        }
        let moved = |state: &TrueState| TrueState { p_WCm: state.p_WCm - p_WM, ..*state };
        let truth = self.truth.as_ref().map(|truth| truth.iter().map(moved).collect());
        Ok(ThreePlanes { log: SensorLog::new(samples, truth)?, p_WM, apart })
    }

    fn reading(
        &self,
        (palm, has_rate): (&LoggedPalm, bool),
        k: usize,
        (p_WM, apart): (DVec3, f64),
    ) -> Result<PalmReading, PalmError> {
        let motion = palm.motion(k);
        let normal = plane_normal(&motion);
        let frame = PalmFrame::from_normal(normal)?;
        Ok(PalmReading {
            normal,
            contact: palm.touch(k).map(|touch| frame.sensor_from_contact(touch.p_WC - p_WM)),
            force: match &palm.force {
                ForceChannel::Missing => None,
                ForceChannel::Normal(values) => Some(values[k]),
                ForceChannel::Three(vectors) => {
                    Some(palm.touch(k).map_or(0.0, |touch| vectors[k].dot(touch.n.get())))
                }
            },
            torque: torque_about(palm, k, [p_WM, frame.t1], apart),
            rate: has_rate.then(|| motion.w_WP.dot(frame.t1)),
        })
    }

    /// Whether a palm turns as the one number of a rate tells, at all samples: a log has rates of a palm everywhere or nowhere.
    fn is_about_t1(&self, palm: &LoggedPalm) -> bool {
        let motions = || (0..self.times.len()).map(|k| palm.motion(k));
        let largest = motions().map(|motion| motion.w_WP.length()).fold(0.0, f64::max);
        motions().all(|motion| {
            let frame = PalmFrame::from_normal(plane_normal(&motion));
            frame.is_ok_and(|frame| motion.w_WP.dot(frame.t2).abs() <= ROUNDED_TURN * largest)
        })
    }

    /// The point through which all planes go at all times, and how far they pass it: the origin, if they go through that to
    /// rounding, else the point nearest to them.
    fn meeting_point(&self, palms: [&LoggedPalm; 3], known_to: f64) -> Result<(DVec3, f64), NotThreePlanes> {
        let apart = |p_WM: DVec3, known_to: f64| {
            let all = (0..self.times.len()).flat_map(|k| (0..3).map(move |i| (k, i)));
            let (mut extent, mut worst) = (0.0_f64, (0.0_f64, 0, 0));
            for (k, i) in all {
                let motion = palms[i].motion(k);
                let distance = plane_normal(&motion).get().dot(motion.pose.p_WP - p_WM).abs();
                if distance > worst.0 {
                    worst = (distance, k, i);
                }
                extent = extent.max(palms[i].touch(k).map_or(0.0, |touch| (touch.p_WC - p_WM).length()));
            }
            let ((distance, sample, i), limit) = (worst, known_to.max(MEETING * extent));
            let time = self.times[sample];
            match distance <= limit {
                true => Ok((p_WM, distance)),
                false => Err(NotThreePlanes::Apart { palm: i + 1, sample, time, distance, limit }),
            }
        };
        apart(DVec3::ZERO, 0.0).or_else(|_| apart(self.nearest_point(palms)?, known_to))
    }

    /// The point with the least sum of squared distances from all planes at all times.
    fn nearest_point(&self, palms: [&LoggedPalm; 3]) -> Result<DVec3, NotThreePlanes> {
        let (mut matrix, mut side) = (DMat3::ZERO, DVec3::ZERO);
        for k in 0..self.times.len() {
            for palm in palms {
                let motion = palm.motion(k);
                let n = plane_normal(&motion).get();
                matrix += DMat3::from_cols(n * n.x, n * n.y, n * n.z);
                side += n * n.dot(motion.pose.p_WP);
            }
        }
        let mean = (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z) / 3.0;
        if matrix.determinant() <= mean.powi(3) / SQUARED_CONDITION {
            return Err(NotThreePlanes::NoPoint);
        }
        Ok(matrix.inverse() * side)
    }
}

/// Torque of the palm's motor about the line through `p_WM` along `t1`, N m; none where it was measured about another line, or
/// one that passes by farther than the palms do.
fn torque_about(palm: &LoggedPalm, k: usize, [p_WM, t1]: [DVec3; 2], apart: f64) -> Option<f64> {
    let motion = palm.motion(k);
    let (pivot, axis) = palm
        .hinge()
        .map_or((motion.pose.p_WP, motion.pose.R_WP * DVec3::X), |hinge| (hinge.pivot, hinge.axis.get()));
    let extent = palm.touch(k).map_or(0.0, |touch| (touch.p_WC - p_WM).length());
    let along = axis.dot(t1);
    let same_line = axis.cross(t1).length() <= ROUNDED_TURN
        && (pivot - p_WM).cross(axis).length() <= apart.max(MEETING * extent);
    palm.torque(k).filter(|_| same_line).map(|torque| torque * along.signum())
}

fn plane_normal(motion: &MeasuredMotion) -> Direction {
    Direction::new_unchecked(motion.pose.R_WP * DVec3::Z)
}

/// Refuses friction: where tangential forces are measured, by whether those of neighbouring samples agree, which those of
/// noise do not; else where it is stated.
fn check_friction(palms: [&LoggedPalm; 3], samples: usize) -> Result<(), NotThreePlanes> {
    let (mut sum, mut squares, mut worst) = (0.0, 0.0, (0, 0.0));
    for (i, palm) in palms.into_iter().enumerate() {
        if let (Some(SensedAxes::Normal), Some(friction @ f64::MIN_POSITIVE..)) =
            (palm.force_axes(), palm.friction)
        {
            return Err(NotThreePlanes::Friction { palm: i + 1, friction });
        }
        let (mut along, mut normal) = (0.0, 0.0);
        for k in 1..samples {
            let (Some([f_t, f_n]), Some([g_t, g_n])) = (parts(palm, k - 1), parts(palm, k)) else { continue };
            let product = f_t.dot(g_t);
            along += product;
            squares += product * product;
            normal += f_n.dot(g_n);
        }
        sum += along;
        let ratio = if along > 0.0 && normal > 0.0 { (along / normal).sqrt() } else { 0.0 };
        if ratio > worst.1 {
            worst = (i, ratio);
        }
    }
    let deviations = if squares > 0.0 { sum / squares.sqrt() } else { 0.0 };
    let (i, ratio) = worst;
    match deviations > DEVIATIONS && ratio > ROUNDED_FORCE {
        true => Err(NotThreePlanes::Rubs { palm: i + 1, ratio, deviations }),
        false => Ok(()),
    }
}

/// Tangential and normal part of a force of which all is measured.
fn parts(palm: &LoggedPalm, k: usize) -> Option<[DVec3; 2]> {
    let (force, n) = (palm.force(k)?, palm.touch(k)?.n.get());
    let normal = force.vector.dot(n) * n;
    (force.axes == SensedAxes::Three).then_some([force.vector - normal, normal])
}
