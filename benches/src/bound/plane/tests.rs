//! Against all least squares at once, with sensitivities by differences of motions that are computed from changed readings.

use super::*;
use crate::planar::scene::{Scene, drawn};

const STEP: f64 = 1e-6;
/// Errors of both contacts and of both forces at a sample.
const EACH: usize = 4;

/// Motion and openings at the samples from what is unknown: the start, the body, and the readings.
struct Readings<'a> {
    samples: &'a [TrueSample],
    mass: PlanarMass,
}

impl Readings<'_> {
    /// Openings at all samples, then the motion at the last one; `errors` of readings are what was read too little.
    fn of(&self, unknown: &DVector<f64>) -> DVector<f64> {
        let [mass, inertia] = [self.mass.mass() * unknown[5].exp(), self.mass.inertia() * unknown[6].exp()];
        let first = &self.samples[0];
        let mut x = [
            first.p_WCm.x + unknown[0],
            first.p_WCm.y + unknown[1],
            first.v_WCm.x + unknown[2],
            first.v_WCm.y + unknown[3],
            first.omega0 + unknown[4],
        ];
        let mut told = Vec::new();
        for (k, sample) in self.samples.iter().enumerate() {
            let read = |i: usize| unknown[OWN + EACH * k + i];
            let force_and_moment = |x: &[f64; 5], sample: &TrueSample, read: &dyn Fn(usize) -> f64| {
                let (mut force, mut moment) = (DVec2::ZERO, 0.0);
                for palm in 0..2 {
                    let u = sample.palms.pair.along()[palm];
                    let f = sample.palms.pair.normals()[palm] * (sample.forces[palm] + read(2 + palm));
                    let c = u * (sample.contacts[palm] + read(palm));
                    (force, moment) = (force + f, moment + (c - DVec2::new(x[0], x[1])).perp_dot(f));
                }
                [x[2], x[3], force.x / mass, force.y / mass - 9.81, moment / inertia]
            };
            for palm in 0..2 {
                let (u, n) = (sample.palms.pair.along()[palm], sample.palms.pair.normals()[palm]);
                let c = u * (sample.contacts[palm] + read(palm));
                let v = DVec2::new(x[2], x[3]) + (c - DVec2::new(x[0], x[1])).perp() * x[4];
                told.push(n.dot(v - c.perp() * sample.palms.motion.rates[palm]));
            }
            let Some(after) = self.samples.get(k + 1) else { break };
            let next_read = |i: usize| unknown[OWN + EACH * (k + 1) + i];
            let h = after.t - sample.t;
            let rate = force_and_moment(&x, sample, &read);
            let mut next: [f64; 5] = std::array::from_fn(|i| x[i] + h * rate[i]);
            // The trapezoidal rule, to rounding.
            for _ in 0..60 {
                let end = force_and_moment(&next, after, &next_read);
                next = std::array::from_fn(|i| x[i] + 0.5 * h * (rate[i] + end[i]));
            }
            x = next;
        }
        told.extend(x);
        DVector::from_vec(told)
    }

    /// Conditioning normal unknowns on openings that are zero.
    fn least(&self, deviations: &DVector<f64>, rounding: f64) -> DMatrix<f64> {
        let count = deviations.len();
        let column = |j: usize| {
            let mut moved = DVector::zeros(count);
            moved[j] = STEP * deviations[j];
            (self.of(&moved) - self.of(&-moved)) / (2.0 * STEP)
        };
        let slopes = DMatrix::from_columns(&(0..count).map(column).collect::<Vec<_>>());
        let openings = slopes.nrows() - 5;
        let (conditions, last) = (slopes.rows(0, openings), slopes.rows(openings, 5));
        // In units of the deviations the unknowns are standard normals.
        let all =
            conditions * conditions.transpose() + DMatrix::identity(openings, openings) * rounding * rounding;
        let across = last * conditions.transpose();
        let told = all.cholesky().expect("rounding is positive").solve(&across.transpose());
        last * last.transpose() - across * told
    }
}

fn samples(scene: &Scene, count: usize) -> Vec<TrueSample> {
    let exact = scene.log(40.0 / scene.time).expect("the scene was simulated when it was drawn");
    scene.true_samples(&exact).expect("contacts last")[..count].to_vec()
}

#[test]
fn the_filter_is_all_least_squares_at_once() {
    for (i, scene) in drawn(3, 5).expect("scenes").iter().enumerate() {
        let samples = samples(scene, 30);
        for known in [false, true] {
            let scales = Scales { length: scene.length, time: scene.time };
            let (noise, mass) = (scene.noise(1e-2), scene.object.mass);
            let speed = scene.length / scene.time;
            let constant = if known { KNOWN / UNKNOWN } else { 1.0 };
            let natural = [scene.length, scene.length, speed, speed, scene.time.recip(), constant, constant];
            let mut deviations = natural.map(|of| of * UNKNOWN).to_vec();
            for _ in &samples {
                deviations.extend([noise.contact, noise.contact, noise.force, noise.force]);
            }
            let oracle =
                Readings { samples: &samples, mass }.least(&DVector::from_vec(deviations), ROUNDING * speed);
            let found = least_covariance(&samples, mass, known, noise, scales, ContactErrors::Once)
                .expect("not singular");
            for k in 0..5 {
                let (found, oracle) = (found[(k, k)].sqrt(), oracle[(k, k)].sqrt());
                // Differences are taken about the motion of the trapezoidal rule, which departs from the true one by some 1e-4 over so long.
                assert!((found / oracle - 1.0).abs() < 1e-3, "{i} {known} {k}: {found} {oracle}");
            }
        }
    }
}

#[test]
fn less_noise_and_a_known_body_allow_less() {
    for scene in drawn(3, 6).expect("scenes") {
        let exact = scene.log(20.0 / scene.time).expect("simulated before");
        let bound =
            |known, share| scene.bound(&exact, known, share, ContactErrors::Once).expect("not singular");
        let [known, unknown, noisier] = [bound(true, 1e-3), bound(false, 1e-3), bound(true, 1e-2)];
        let apart = scene.bound(&exact, true, 1e-2, ContactErrors::Apart).expect("not singular");
        for k in 0..5 {
            assert!(noisier[(k, k)] < apart[(k, k)]);
            assert!(known[(k, k)] <= unknown[(k, k)] * (1.0 + 1e-6) && known[(k, k)] < noisier[(k, k)]);
        }
    }
}
