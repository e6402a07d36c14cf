//! A second of sliding with friction on three palms, against equations of motion written out by hand and integrated by other
//! code: Runge-Kutta steps of 2 ms, with nothing that would draw the contacts closed.

use contact_kinematics::{Ellipsoid, PalmFrame, PalmSurface, SurfaceMotion, SurfacePose};
use glam::{DMat3, DQuat, DVec3};
use object_dynamics::*;

const AXES: DVec3 = DVec3::new(2.5, 2.0, 1.0);
const G: DVec3 = DVec3::new(0.0, 0.0, -9.81);
const FRICTION: f64 = 0.05;

fn frames() -> [PalmFrame; 3] {
    [270.0, 30.0, 150.0f64]
        .map(|azimuth| PalmFrame::from_azimuth_slope(azimuth.to_radians(), 60f64.to_radians()))
}

/// Rates of position, orientation, velocity and angular velocity of a body of 1 kg whose three contacts slide.
fn rates(body: &BodyState) -> BodyState {
    let (R, v, w, D) = (DMat3::from_quat(body.R_WO.normalize()), body.v_WCm, body.w_WO, AXES * AXES);
    let moments = DVec3::new(D.y + D.z, D.x + D.z, D.x + D.y) / 5.0;
    let world = |diagonal: DVec3| R * DMat3::from_diagonal(diagonal) * R.transpose();
    let K = world(1.0 / moments);
    let free = -(K * w.cross(world(moments) * w));
    let n = frames().map(|frame| frame.n);
    let (mut b, mut push, mut side) = ([DVec3::ZERO; 3], [DVec3::ZERO; 3], [0.0; 3]);
    for i in 0..3 {
        let u = -(R.transpose() * n[i]);
        let (h, u_dot) = ((u.dot(D * u)).sqrt(), R.transpose() * w.cross(n[i]));
        b[i] = R * (D * u / h);
        let b_dot = w.cross(b[i]) + R * (D * u_dot / h - D * u * ((D * u).dot(u_dot) / h.powi(3)));
        let slip = (v + w.cross(b[i])).reject_from_normalized(n[i]).normalize();
        push[i] = n[i] - FRICTION * slip;
        // n . (a + alpha x b + w x b') = 0: the palms are at rest.
        side[i] = -n[i].dot(G + free.cross(b[i]) + w.cross(b_dot));
    }
    let answer = |j: usize, i: usize| n[i].dot(push[j] + (K * b[j].cross(push[j])).cross(b[i]));
    let column = |j: usize| DVec3::new(answer(j, 0), answer(j, 1), answer(j, 2));
    let forces = (DMat3::from_cols(column(0), column(1), column(2)).inverse() * DVec3::from(side)).to_array();
    let a = G + (0..3).map(|i| forces[i] * push[i]).sum::<DVec3>();
    let alpha = free + (0..3).map(|i| forces[i] * (K * b[i].cross(push[i]))).sum::<DVec3>();
    let R_WO = DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * body.R_WO * 0.5;
    BodyState { p_WCm: v, R_WO, v_WCm: a, w_WO: alpha }
}

fn moved(body: &BodyState, rate: &BodyState, h: f64) -> BodyState {
    BodyState {
        p_WCm: body.p_WCm + h * rate.p_WCm,
        R_WO: body.R_WO + rate.R_WO * h,
        v_WCm: body.v_WCm + h * rate.v_WCm,
        w_WO: body.w_WO + h * rate.w_WO,
    }
}

fn by_hand(mut body: BodyState, steps: usize) -> BodyState {
    let h = 1.0 / steps as f64;
    for _ in 0..steps {
        let k1 = rates(&body);
        let k2 = rates(&moved(&body, &k1, 0.5 * h));
        let k3 = rates(&moved(&body, &k2, 0.5 * h));
        let k4 = rates(&moved(&body, &k3, h));
        for (k, share) in [(k1, 1.0), (k2, 2.0), (k3, 2.0), (k4, 1.0)] {
            body = moved(&body, &k, share * h / 6.0);
        }
    }
    body
}

#[test]
fn sliding_with_friction_is_that_of_equations_by_hand() {
    let (body, mass) = (Ellipsoid::new(AXES).unwrap(), MassProperties::uniform_ellipsoid(1.0, AXES).unwrap());
    let palms = [270.0, 30.0, 150.0f64].map(|azimuth: f64| {
        contact_kinematics::Palm::fixed(azimuth.to_radians(), 60f64.to_radians()).unwrap()
    });
    // The start of the paper's Fig. 5.
    let w_WO = DVec3::new(0.0, 0.3, 0.3);
    let smooth = ThreePalmScene::new(body, mass, palms, -G.z).unwrap();
    let now = smooth.instant(0.0, DQuat::IDENTITY, w_WO).unwrap();
    let start = BodyState { p_WCm: now.touch.p_WCm, R_WO: DQuat::IDENTITY, v_WCm: now.rates.v_WCm, w_WO };
    let palms = frames().map(|frame| {
        let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&frame.rotation())).unwrap();
        let drive = PalmDrive::Prescribed(SurfaceMotion::immobile(pose));
        ScenePalm { surface: PalmSurface::Plane, drive, friction: FRICTION }
    });
    let scene = ContactScene::new(body, mass, palms.to_vec(), -G.z).unwrap();
    let times = SampleTimes { duration: 1.0, rate: 1.0 };
    let run = scene.simulate(&ContactStart::touching(start), times, 1e-12).unwrap();
    assert!(run.events.is_empty(), "all contacts slide: {:?}", run.events);
    let ours = run.instants[1].state.body;
    let apart = |a: BodyState, b: BodyState| {
        a.p_WCm.distance(b.p_WCm).max(a.R_WO.normalize().angle_between(b.R_WO.normalize()))
    };
    let [coarse, fine] = [by_hand(start, 250), by_hand(start, 500)];
    // Fourth order: what is left at the short steps is a fifteenth of what they have changed, or less while the order is not
    // reached. Nothing else is between the two.
    let left = apart(coarse, fine) / 15.0;
    let error = apart(fine, ours);
    assert!(left < 2e-8 && error < 1.5 * left, "{error:e} {left:e}");
}
