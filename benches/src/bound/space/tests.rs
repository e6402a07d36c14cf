//! Derivatives against differences of the equations of motion themselves, and what more or less knowledge does to the bound.

use super::*;
use glam::DQuat;
use recon::object_dynamics::SampleTimes;
use recon::object_dynamics::integrate::Tolerance;

/// Motion, body and readings at a sample, none of which need fit the others.
#[derive(Clone, Copy)]
struct Free {
    p: DVec3,
    v: DVec3,
    R: DMat3,
    w: DVec3,
    mass: f64,
    inertia: DMat3,
    c: [DVec3; 3],
    f: [f64; 3],
}

impl Free {
    fn of(told: &Told) -> Self {
        let at = told.at;
        Self {
            p: at.touch.p_WCm,
            v: at.rates.v_WCm,
            R: DMat3::from_quat(at.R_WO),
            w: at.w_WO,
            mass: told.mass.mass(),
            inertia: told.mass.inertia(),
            c: at.touch.contacts.map(|contact| contact.p_WC),
            f: at.accelerations.forces,
        }
    }

    /// With one unknown (those of the motion and body first, then those of the readings) a little larger.
    fn moved(mut self, told: &Told, which: usize, by: f64) -> Self {
        let axis = DVec3::AXES[which % 3] * by;
        match which {
            0..3 => self.p += axis,
            3..6 => self.v += axis,
            6..9 => self.R = DMat3::from_quat(DQuat::from_scaled_axis(axis)) * self.R,
            9..12 => self.w += axis,
            12 => self.mass *= by.exp(),
            13..19 => {
                let (i, j) = ENTRIES[which - INERTIA];
                self.inertia.col_mut(i)[j] += by;
                if i != j {
                    self.inertia.col_mut(j)[i] += by;
                }
            }
            _ => {
                let (palm, what) = ((which - OWN) / EACH, (which - OWN) % EACH);
                let [_, _, t1, t2] = told.touch(palm);
                match what {
                    0 => self.c[palm] += t1 * by,
                    1 => self.c[palm] += t2 * by,
                    _ => self.f[palm] += by,
                }
            }
        }
        self
    }

    /// Velocity, acceleration, angular velocity and angular acceleration, then the openings, by Newton and Euler.
    fn told(&self, told: &Told) -> [DVec3; 5] {
        let n = [0, 1, 2].map(|palm| told.touch(palm)[1]);
        let inertia = self.R * self.inertia * self.R.transpose();
        let force: DVec3 = (0..3).map(|i| n[i] * self.f[i]).sum();
        let moment: DVec3 = (0..3).map(|i| (self.c[i] - self.p).cross(n[i] * self.f[i])).sum();
        let alpha = inertia.inverse() * (moment - self.w.cross(inertia * self.w));
        let opening = |i: usize| {
            let body = self.v + self.w.cross(self.c[i] - self.p);
            n[i].dot(body - told.turning(i).cross(self.c[i]))
        };
        [self.v, force / self.mass, self.w, alpha, DVec3::new(opening(0), opening(1), opening(2))]
    }
}

fn instants(seconds: f64, rate: f64) -> (Vec<Instant>, MassProperties) {
    let (scene, start) = recon_tests::tilted();
    let times = SampleTimes { duration: seconds, rate };
    let run = scene.simulate(start, times, Tolerance::uniform(1e-10)).expect("it was simulated before");
    (run.instants, *scene.mass())
}

#[test]
fn derivatives_are_those_of_newton_and_euler() {
    const STEP: f64 = 1e-5;
    let (instants, mass) = instants(0.4, 10.0);
    for at in &instants {
        let told = Told { at, mass };
        let (rates, openings) = (told.rates(), told.openings());
        let here = Free::of(&told).told(&told);
        // The simulated motion obeys what the derivatives are of.
        assert!(here[3].distance(at.accelerations.alpha_WO) < 1e-9 && here[4].length() < 1e-9, "{here:?}");
        for which in 0..OWN + READ {
            let ends = [STEP, -STEP].map(|by| Free::of(&told).moved(&told, which, by).told(&told));
            let slope = |k: usize| (ends[0][k] - ends[1][k]) / (2.0 * STEP);
            let (of, column) = if which < OWN { (0, which) } else { (1, which - OWN) };
            let own = |row: usize| DVec3::from_array([0, 1, 2].map(|i| rates[of][(row + i, column)]));
            for (k, row) in [(0, PLACE), (1, VELOCITY), (3, SPIN)] {
                assert!(own(row).distance(slope(k)) < 1e-6, "{which} {k}: {} {}", own(row), slope(k));
            }
            let opening = DVec3::from_array([0, 1, 2].map(|i| openings[of][(i, column)]));
            assert!(opening.distance(slope(4)) < 1e-6, "{which}: {opening} {}", slope(4));
        }
    }
}

#[test]
fn an_error_of_the_turn_is_carried_as_the_body_carries_it() {
    let (instants, mass) = instants(0.02, 1000.0);
    let told = Told { at: &instants[0], mass };
    let ([by_own, _], h) = (told.rates(), 1e-6);
    for axis in 0..3 {
        // Two bodies whose orientations differ a little turn on for a moment by one angular velocity, and by two that differ.
        let (apart, faster) = (DVec3::AXES[axis] * 1e-3, DVec3::AXES[(axis + 1) % 3] * 1e-3);
        let (R, w) = (told.at.R_WO, told.at.w_WO);
        let other = DQuat::from_scaled_axis(apart) * R;
        let on = |R: DQuat, w: DVec3| DQuat::from_scaled_axis(w * h) * R;
        let after = (on(other, w + faster) * on(R, w).inverse()).to_scaled_axis();
        let column = |at: usize, k: usize| DVec3::from_array([0, 1, 2].map(|i| by_own[(TURN + i, at + k)]));
        let rate = column(TURN, axis) * 1e-3 + column(SPIN, (axis + 1) % 3) * 1e-3;
        assert!(((after - apart) / h).distance(rate) < 1e-5, "{} {rate}", (after - apart) / h);
    }
}

#[test]
fn less_noise_a_known_body_and_more_of_a_log_allow_less() {
    let (instants, mass) = instants(1.5, 200.0);
    let scales = Scales { length: 1.3, time: 0.36 };
    let bound = |count: usize, known: bool, share: f64| {
        let noise = SensorNoise { contact: share, force: 3.0 * share, torque: 0.0 };
        least_place(&instants[..count], mass, known, noise, scales).expect("not singular")
    };
    let all = instants.len();
    let [own, noisier, unknown, shorter] =
        [bound(all, true, 1e-3), bound(all, true, 2e-3), bound(all, false, 1e-3), bound(all / 2, true, 1e-3)];
    // Linear: twice the noise is twice the bound, but for what is given beforehand.
    assert!((noisier / own - 2.0).abs() < 1e-3, "{own} {noisier}");
    assert!(own < unknown && own < shorter, "{own} {unknown} {shorter}");
    assert!(least_place(&instants[..1], mass, true, SensorNoise::default(), scales).is_none());
}

/// A centre of mass at the end of a log is as well known to a filter that runs forward as one at the start is to one that runs back, if all is known of the
/// turns of both; and of an unknown body moments about principal axes do not depend on where its axes are those of the world.
#[test]
fn back_from_the_end_the_start_is_bounded_as_the_end_is() {
    let (instants, mass) = instants(1.5, 200.0);
    let scales = Scales { length: 1.3, time: 0.36 };
    let noise = SensorNoise { contact: 1e-3, force: 3e-3, torque: 0.0 };
    let mut back: Vec<Instant> = instants.clone();
    back.reverse();
    for known in [true, false] {
        let start = least_at_start(&instants, mass, known, noise, scales).expect("not singular");
        let end = least_place(&back, mass, known, noise, scales).expect("not singular");
        let place = start[..3].iter().map(|d| d * d).sum::<f64>().sqrt();
        assert!((place / end - 1.0).abs() < 1e-9, "{place} {end}");
        assert!(start.iter().all(|d| *d > 0.0 && d.is_finite()), "{start:?}");
        if !known {
            let other = least_at_start(&back, mass, known, noise, scales).expect("not singular");
            for (a, b) in start[9..].iter().zip(&other[9..]) {
                assert!((a / b - 1.0).abs() < 1e-3, "{start:?} {other:?}");
            }
        }
    }
}
