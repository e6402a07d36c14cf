//! Against a body that rolls by the equations of rolling, integrated finely, its contacts by its support function.

use super::*;
use crate::random::Normal;
use nalgebra::{SMatrix, Vector6};

/// An ellipsoid between palms.
struct Rolled {
    axes: DVec3,
    R_WO: DQuat,
    p_WO: DVec3,
    /// How far the upper palm went.
    upper: DVec2,
}

impl Rolled {
    fn new(axes: DVec3, R_WO: DQuat) -> Self {
        let mut all = Self { axes, R_WO, p_WO: DVec3::ZERO, upper: DVec2::ZERO };
        all.p_WO = -all.arms()[1];
        all
    }

    /// From the centre to the upper and to the lower contact, world axes.
    fn arms(&self) -> [DVec3; 2] {
        let farthest = |up: DVec3| {
            let n = self.R_WO.inverse() * up;
            self.R_WO * (self.axes * self.axes * n / (self.axes * n).length())
        };
        [farthest(DVec3::Z), farthest(-DVec3::Z)]
    }

    fn places(&self) -> [DVec3; 2] {
        self.arms().map(|arm| self.p_WO + arm)
    }

    /// A motion of the upper palm by `shift`, and a turn about the line through both contacts, in `parts` steps (midpoints).
    fn moved(&mut self, shift: DVec2, spin: f64, parts: usize) {
        let rate = |at: &Self| {
            let [up, low] = at.arms();
            let span = up - low;
            let v = shift / parts as f64;
            let w = DVec3::new(-v.y, v.x, 0.0) / span.z + span.normalize() * (spin / parts as f64);
            (w, w.cross(-low))
        };
        for _ in 0..parts {
            let (w, v) = rate(self);
            let half = Self {
                R_WO: DQuat::from_scaled_axis(0.5 * w) * self.R_WO,
                p_WO: self.p_WO + 0.5 * v,
                ..*self
            };
            let (w, v) = rate(&half);
            self.R_WO = (DQuat::from_scaled_axis(w) * self.R_WO).normalize();
            self.p_WO += v;
        }
        self.upper += shift;
    }

    fn reading(&self) -> RollingReading {
        let [up, low] = self.places();
        let upper = self.upper.extend((up - low).z);
        RollingReading { upper, contacts: [up.truncate() - self.upper, low.truncate()] }
    }
}

const AXES: DVec3 = DVec3::new(0.030, 0.026, 0.022);
const EXACT: RollingNoise = RollingNoise { contact: 0.0, palm: 0.0, spin: 0.0 };

fn start() -> DQuat {
    DQuat::from_xyzw(0.3, -0.2, 0.5, 0.7).normalize()
}

/// Strokes in three directions, 0.05 m each, read every so many metres.
fn strokes(step: f64) -> Vec<DVec2> {
    let each = (0.05 / step).round() as usize;
    [0.3, 2.0, 4.4].iter().flat_map(|heading| vec![DVec2::from_angle(*heading) * step; each]).collect()
}

/// How far the pose is off after exact readings: turn, and place.
fn off(step: f64) -> (f64, f64) {
    let mut body = Rolled::new(AXES, start());
    let first = body.R_WO;
    let at = body.p_WO;
    let noise = RollingNoise { contact: 1e-4, palm: 1e-4, ..EXACT };
    let mut observer = RollingObserver::new(&body.reading(), noise).unwrap();
    for shift in strokes(step) {
        body.moved(shift, 0.0, 20);
        observer.push(&body.reading()).unwrap();
    }
    let pose = observer.pose();
    let turned = body.R_WO * first.inverse();
    let place = body.p_WO - turned * at;
    let off = pose.R_WO * turned.inverse();
    (off.to_scaled_axis().length(), (pose.p_WO - place).length())
}

#[test]
fn a_pose_from_exact_readings_is_of_second_order_in_their_spacing() {
    let (coarse, fine) = (off(1e-3), off(5e-4));
    assert!(fine.0 < 1e-4 && fine.1 < 1e-4 * AXES.x, "{fine:?}");
    for ratio in [coarse.0 / fine.0, coarse.1 / fine.1] {
        assert!((ratio - 4.0).abs() < 0.6, "{ratio}");
    }
}

/// Chi-squared of the pose after strokes with noise.
fn run(noise: RollingNoise, seed: u64) -> Result<f64, RollingError> {
    let mut random = Normal::seeded(seed);
    let mut normal = || random.draw();
    let mut body = Rolled::new(AXES, start());
    let (first, at) = (body.R_WO, body.p_WO);
    let sensed = |body: &Rolled, normal: &mut dyn FnMut() -> f64| {
        let RollingReading { upper, contacts } = body.reading();
        let upper = upper + DVec3::new(normal(), normal(), normal()) * noise.palm;
        let contacts = contacts.map(|c| c + DVec2::new(normal(), normal()) * noise.contact);
        RollingReading { upper, contacts }
    };
    let mut observer = RollingObserver::new(&sensed(&body, &mut normal), noise)?;
    for shift in strokes(5e-4) {
        let turn = shift.length() / body.reading().upper.z;
        body.moved(shift, normal() * noise.spin * turn.sqrt(), 4);
        observer.push(&sensed(&body, &mut normal))?;
    }
    let pose = observer.pose();
    let turned = body.R_WO * first.inverse();
    // Both take points of the body, in its axes, to where they are.
    let theta = (pose.R_WO.inverse() * turned).to_scaled_axis();
    let d = pose.R_WO.inverse() * (body.p_WO - turned * at - pose.p_WO);
    let mut covariance = SMatrix::<f64, 6, 6>::zeros();
    let block = |m: DMat3| nalgebra::Matrix3::from(m);
    covariance.fixed_view_mut::<3, 3>(0, 0).copy_from(&block(pose.rotation));
    covariance.fixed_view_mut::<3, 3>(0, 3).copy_from(&block(pose.cross));
    covariance.fixed_view_mut::<3, 3>(3, 0).copy_from(&block(pose.cross).transpose());
    covariance.fixed_view_mut::<3, 3>(3, 3).copy_from(&block(pose.translation));
    let error = Vector6::new(theta.x, theta.y, theta.z, d.x, d.y, d.z);
    let squared = covariance.cholesky().map_or(f64::NAN, |factor| error.dot(&factor.solve(&error)));
    Ok(squared)
}

#[test]
fn squared_errors_are_chi_squared_of_six() {
    let noise = RollingNoise { contact: 5e-5, palm: 5e-5, spin: 3e-3 };
    let runs = 200;
    let squares: Vec<f64> = (0..runs).map(|seed| run(noise, seed).unwrap()).collect();
    let mean = squares.iter().sum::<f64>() / squares.len() as f64;
    // Give or take 3 deviations of a mean of so many.
    let band = 3.0 * (12.0 / runs as f64).sqrt();
    assert!((mean - 6.0).abs() < band, "{mean}");
    assert!(squares.iter().all(|s| *s < 30.0), "{squares:?}");
}

#[test]
fn a_contact_that_slips_is_told() {
    let noise = RollingNoise { contact: 5e-5, palm: 2e-5, spin: 0.0 };
    let mut body = Rolled::new(AXES, start());
    let mut observer = RollingObserver::new(&body.reading(), noise).unwrap();
    let mut told = None;
    for (k, shift) in strokes(5e-4).into_iter().enumerate() {
        // From the second stroke on the upper palm slides ahead by a fifth.
        body.moved(shift, 0.0, 4);
        if k >= 100 {
            body.upper += 0.2 * shift;
        }
        if let Err(error) = observer.push(&body.reading()) {
            told = Some((k, error));
            break;
        }
    }
    let (k, error) = told.unwrap();
    assert!(k >= 100 && matches!(error, RollingError::Slipped { .. }), "{k} {error}");
}

#[test]
fn what_is_no_reading_is_named() {
    let good = Rolled::new(AXES, start()).reading();
    let noise = RollingNoise { contact: 1e-4, palm: 1e-5, spin: 0.0 };
    for value in [-1.0, f64::NAN, f64::INFINITY] {
        for noise in [
            RollingNoise { contact: value, ..noise },
            RollingNoise { palm: value, ..noise },
            RollingNoise { spin: value, ..noise },
        ] {
            assert!(matches!(RollingObserver::new(&good, noise), Err(RollingError::Noise { .. })));
        }
    }
    let below = RollingReading { upper: -good.upper, ..good };
    assert!(matches!(RollingObserver::new(&below, noise), Err(RollingError::Height { index: 0, .. })));
    let mut observer = RollingObserver::new(&good, noise).unwrap();
    let before = observer.pose();
    let none = RollingReading { contacts: [DVec2::NAN, DVec2::ZERO], ..good };
    assert_eq!(observer.push(&none), Err(RollingError::NotFinite { index: 1 }));
    let far = RollingReading { upper: good.upper + DVec3::X, ..good };
    assert!(matches!(observer.push(&far), Err(RollingError::Apart { index: 1, .. })));
    assert_eq!(observer.pose(), before);
}
