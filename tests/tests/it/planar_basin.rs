//! How far off a start of the paper's own system may be.

use crate::planar_common::{scene, times};
use nalgebra::{SMatrix, SVector};
use rand_distr::{Distribution, Uniform};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;
use recon::object_dynamics::planar::*;
use recon::observer::newton::{Arrival, NewtonObserver, NewtonOptions};
use recon::observer::planar::*;
use recon::observer::{Model, Sample, Start, Status};
use recon_tests::few_or_all;

type V5 = SVector<f64, 5>;

/// The paper's system with torques alone: `(r_1, r_2, omega0, s_1, s_2)`, outputs `s_1, s_2`, central differences.
struct TorquesAlone {
    fields: AuthorsFields,
}

/// Step and torques and palm angles at the start, middle and end of it.
#[derive(Clone, Copy)]
struct TorqueInput {
    dt: f64,
    torques: [[f64; 2]; 3],
    angles: [[f64; 2]; 3],
}

impl TorquesAlone {
    fn step(&self, x: &V5, input: &TorqueInput) -> V5 {
        recon::observer::rk4::rk4(x, input.dt, |fraction, x| {
            let stage = (2.0 * fraction) as usize;
            let a = input.angles[stage];
            let q = AuthorsState::from([x[0], x[1], x[2], x[3], x[4], a[0], a[1]]);
            let rate = self.fields.rate(&q, input.torques[stage]);
            rate.map_or(V5::repeat(f64::NAN), |r| r.fixed_rows::<5>(0).into_owned())
        })
    }
}

impl Model<5, 2> for TorquesAlone {
    type Input = TorqueInput;
    fn flow(&self, x: &V5, input: &TorqueInput) -> (V5, SMatrix<f64, 5, 5>) {
        let mut slope = SMatrix::<f64, 5, 5>::zeros();
        for (k, scale) in self.scales().iter().enumerate() {
            let mut step = V5::zeros();
            step[k] = 1e-6 * scale;
            let column = (self.step(&(x + step), input) - self.step(&(x - step), input)) / (2e-6 * scale);
            slope.set_column(k, &column);
        }
        (self.step(x, input), slope)
    }
    fn output(&self, x: &V5, _: &TorqueInput) -> (SVector<f64, 2>, SMatrix<f64, 2, 5>) {
        let mut h = SMatrix::<f64, 2, 5>::zeros();
        (h[(0, 3)], h[(1, 4)]) = (1.0, 1.0);
        (SVector::<f64, 2>::new(x[3], x[4]), h)
    }
    fn scales(&self) -> V5 {
        V5::new(0.05, 0.05, 14.0, 0.05, 0.05)
    }
    fn names(&self) -> [&'static str; 5] {
        ["r1", "r2", "angular velocity", "s1", "s2"]
    }
}

/// Starts that are 50 % off in every state of the paper: `r_1`, `r_2`, `omega0`.
fn draws(count: usize, seed: u64) -> Vec<[f64; 3]> {
    let mut source = Pcg64Mcg::seed_from_u64(seed);
    let uniform = Uniform::new(-0.5, 0.5).unwrap();
    (0..count).map(|_| std::array::from_fn(|_| 1.0 + uniform.sample(&mut source))).collect()
}

fn fields(object: &PlanarObject<crate::planar_common::Shape>) -> AuthorsFields {
    AuthorsFields { mass: object.mass, gravity: object.gravity, palm_rates: [0.2, 0.2] }
}

/// The rival: Newton without damping on the paper's system with torques alone, window 0.1 s (it never converges at 0.4 s).
#[test]
fn torques_alone_are_worse() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(2000.0, 0.1), 1e-13).unwrap();
    let model = TorquesAlone { fields: fields(&object) };
    let samples: Vec<Sample<TorqueInput, 2>> = (0..=100_usize)
        .map(|k| {
            let rows =
                [2 * k, (2 * k).saturating_sub(1), (2 * k).saturating_sub(2)].map(|i| run.samples[i].sample);
            let [end, middle, begin] = rows;
            TorqueSample { dt: if k == 0 { 0.0 } else { 1e-3 }, rows: [begin, middle, end] }.sample()
        })
        .collect();
    let radii = motion.at(0.0).unwrap().pair.normals().map(|n| n.dot(run.samples[0].truth.p_WCm));
    let s = run.samples[0].sample.contacts.map(Option::unwrap);
    let truth = V5::new(radii[0], radii[1], run.samples[0].truth.omega0, s[0], s[1]);
    let (mut converged, starts) = (0, few_or_all(16, 40));
    for [a, b, c] in draws(starts, 17) {
        let start = truth.component_mul(&V5::new(a, b, c, 1.0, 1.0));
        // The contacts at the start are measured; only three states are unknown, as in the paper's observer.
        let mut guess = Start::guess(start);
        (guess.information[(3, 3)], guess.information[(4, 4)]) = (1e12, 1e12);
        let observer = undamped(&model, &samples, &guess);
        converged += usize::from((observer - truth).component_div(&truth).amax() < 1e-6);
    }
    println!(
        "torques alone, undamped Newton, window 0.1 s, start 50 % off: {converged} of {starts} converge"
    );
    assert!(4 * converged < 3 * starts, "{converged}");
}

/// Thirty undamped Newton steps; zeros where they leave the numbers.
fn undamped(model: &TorquesAlone, samples: &[Sample<TorqueInput, 2>], start: &Start<5>) -> V5 {
    let options = NewtonOptions { window: samples.len(), steps: 1, damping: 0.0, arrival: Arrival::Forget };
    let mut observer = NewtonObserver::new(TorquesAlone { fields: model.fields }, options, *start).unwrap();
    for sample in samples {
        observer.append(*sample);
    }
    let mut last = V5::zeros();
    for _ in 0..30 {
        let estimate = observer.step().unwrap();
        if estimate.report.status == Status::Diverged {
            return V5::zeros();
        }
        let at_rest = (estimate.first_state - last).amax() < 1e-13;
        last = estimate.first_state;
        // Further steps would not move it.
        if at_rest {
            break;
        }
    }
    last
}

struct TorqueSample {
    dt: f64,
    rows: [PlanarSample; 3],
}

impl TorqueSample {
    fn sample(&self) -> Sample<TorqueInput, 2> {
        let input = TorqueInput {
            dt: self.dt,
            torques: self.rows.map(|r| r.torques.unwrap()),
            angles: self.rows.map(|r| r.angles),
        };
        let measured = SVector::<f64, 2>::from(self.rows[2].contacts.map(Option::unwrap));
        Sample { input, measured, information: SVector::<f64, 2>::repeat(1e10) }
    }
}
