//! How far off a start may be, and which constants can be estimated along.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

mod planar_common;

use nalgebra::{SMatrix, SVector};
use planar_common::{scene, times};
use rand_distr::{Distribution, Uniform};
use rand_pcg::Pcg64Mcg;
use rand_pcg::rand_core::SeedableRng;
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;
use recon::observer::{Arrival, Model, NewtonObserver, NewtonOptions, Sample, Start, Status};

type V5 = SVector<f64, 5>;

fn state(truth: &PlanarTruth) -> V5 {
    let (p, v) = (truth.p_WCm, truth.v_WCm);
    V5::new(p.x, p.y, v.x, v.y, truth.omega0)
}

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
        recon::observer::rk4(x, input.dt, |fraction, x| {
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

fn fields(object: &PlanarObject<planar_common::Shape>) -> AuthorsFields {
    AuthorsFields { mass: object.mass, gravity: object.gravity, palm_rates: [0.2, 0.2] }
}

#[test]
fn half_off_in_every_state_and_still_right() {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(1000.0, 0.4), 1e-13).unwrap();
    let clean = run.log().unwrap();
    let first = run.samples[0].truth;
    let s = run.samples[0].sample.contacts.map(Option::unwrap);
    let palms = motion.at(0.0).unwrap();
    let fields = fields(&object);
    let normals = palms.pair.normals();
    let radii = normals.map(|n| n.dot(first.p_WCm));
    // Noise-free to 1e-8 of the natural scales; with noise within 5 standard deviations, of which the largest is 2e-3.
    for (contact, limit) in [(0.0, 1e-8), (1e-4, 1e-2)] {
        let log = PlanarNoise { contact, ..PlanarNoise::default() }.add_to(&clean, 9);
        let nominal = PlanarNominal {
            mass: object.mass,
            gravity: object.gravity,
            contact_deviation: contact,
            force_deviation: 0.0,
        };
        let mut converged = 0;
        for [a, b, c] in draws(100, 17) {
            let q = AuthorsState::from([
                radii[0] * a,
                radii[1] * b,
                first.omega0 * c,
                s[0],
                s[1],
                sample_angles(&run, 0)[0],
                sample_angles(&run, 0)[1],
            ]);
            let guess = fields.to_motion(&q).unwrap();
            let options = PlanarObserverOptions {
                window: Some(0.4),
                start: PlanarStartFrom::Guess(guess.into()),
                ..PlanarObserverOptions::default()
            };
            let mut observer = PlanarObserver::<5>::new(nominal, &[], options).unwrap();
            let mut last = None;
            for sample in log.samples() {
                last = observer.push(sample).unwrap().or(last);
            }
            let estimate = last.unwrap();
            let truth = run.samples.last().unwrap().truth;
            let error = (estimate.state - state(&truth)).component_div(&V5::new(0.05, 0.05, 0.7, 0.7, 14.0));
            converged += usize::from(error.amax() < limit && estimate.doubt.is_none());
        }
        println!("start 50 % off, noise {} mm: {converged} of 100 converge", 1e3 * contact);
        assert!(converged >= 99, "{converged}");
    }
}

fn sample_angles(run: &PlanarRun, k: usize) -> [f64; 2] {
    run.samples[k].sample.angles
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
    let mut converged = 0;
    for [a, b, c] in draws(40, 17) {
        let start = truth.component_mul(&V5::new(a, b, c, 1.0, 1.0));
        // The contacts at the start are measured; only three states are unknown, as in the paper's observer.
        let mut guess = Start::guess(start);
        (guess.information[(3, 3)], guess.information[(4, 4)]) = (1e12, 1e12);
        let observer = undamped(&model, &samples, &guess);
        converged += usize::from((observer - truth).component_div(&truth).amax() < 1e-6);
    }
    println!("torques alone, undamped Newton, window 0.1 s, start 50 % off: {converged} of 40 converge");
    assert!(converged < 30, "{converged}");
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
        last = estimate.first_state;
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

/// Runs with wrong constants in the model (`factor` on mass and inertia) and wrong sensors, constants estimated as states.
fn constants<const N: usize>(
    list: &[Constant],
    factors: [f64; 2],
    sensor: impl Fn(&PlanarSample) -> PlanarSample,
) -> (PlanarEstimate<N>, PlanarTruth) {
    let (object, motion, start) = scene("S2_rotating_pair");
    let run = simulate_prescribed(&object, &motion, start, &times(500.0, 0.8), 1e-13).unwrap();
    let noise = PlanarNoise { contact: 1e-4, force: 0.002, torque: 0.0 };
    let log = noise.add_to(&run.log().unwrap(), 4);
    let mass = PlanarMass::new(object.mass.mass() * factors[0], object.mass.inertia() * factors[1]).unwrap();
    let nominal = PlanarNominal {
        mass,
        gravity: object.gravity,
        contact_deviation: noise.contact,
        force_deviation: noise.force,
    };
    let options = PlanarObserverOptions { steps: 2, ..PlanarObserverOptions::default() };
    let mut observer = PlanarObserver::<N>::new(nominal, list, options).unwrap();
    let mut last = None;
    for sample in log.samples() {
        last = observer.push(&sensor(sample)).unwrap().or(last);
    }
    (last.unwrap(), run.samples.last().unwrap().truth)
}

fn check<const N: usize>(
    what: &str,
    estimate: &PlanarEstimate<N>,
    truth: &PlanarTruth,
    expected: &[f64],
    largest: &[f64],
) {
    let mut full = SVector::<f64, N>::zeros();
    full.fixed_rows_mut::<5>(0).copy_from(&state(truth));
    full.as_mut_slice()[5..].copy_from_slice(expected);
    let deviations = estimate.report.deviations();
    let values: Vec<String> = (5..N)
        .map(|i| format!("{:.5} +- {:.5} for {:.5}", estimate.state[i], deviations[i], full[i]))
        .collect();
    println!(
        "{what}: {} ({:?}), r +- {:.4} mm",
        values.join(", "),
        estimate.report.status,
        1e3 * estimate.radius_deviations[0]
    );
    assert_eq!(estimate.doubt, None, "{what}");
    for i in 0..N {
        let error = (estimate.state[i] - full[i]).abs() / deviations[i];
        assert!(error < 4.0, "{what} state {i}: {error} deviations");
    }
    for (i, limit) in largest.iter().enumerate() {
        assert!(deviations[5 + i] < *limit, "{what} constant {i}: {}", deviations[5 + i]);
    }
}

#[test]
fn constants_are_estimated_each_on_its_own() {
    use Constant::*;
    let same = |s: &PlanarSample| *s;
    let (e, t) = constants::<6>(&[Mass], [1.1, 1.0], same);
    check("mass 10 % off", &e, &t, &[(1.0_f64 / 1.1).ln()], &[0.005]);
    let (e, t) = constants::<6>(&[Inertia], [1.0, 1.1], same);
    check("inertia 10 % off", &e, &t, &[(1.0_f64 / 1.1).ln()], &[0.02]);
    let gain = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a / 1.05, b]), ..*s };
    let (e, t) = constants::<6>(&[ForceGain(Side::First)], [1.0; 2], gain);
    check("gain of force 1 5 % low", &e, &t, &[1.05_f64.ln()], &[0.005]);
    let bias = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a, b - 0.05]), ..*s };
    let (e, t) = constants::<6>(&[ForceBias(Side::Second)], [1.0; 2], bias);
    check("bias of force 2, 0.05 N", &e, &t, &[0.05], &[0.01]);
}

/// An offset of one contact shifts the centre of mass along, and nothing contradicts it: it stays unknown, and is reported.
#[test]
fn a_contact_offset_is_not_observable() {
    let list = [Constant::ContactOffset(Side::First)];
    let offset =
        |s: &PlanarSample| PlanarSample { contacts: [s.contacts[0].map(|v| v + 1e-3), s.contacts[1]], ..*s };
    let (e, t) = constants::<6>(&list, [1.0; 2], offset);
    assert_eq!(e.report.status, Status::NotObservable);
    assert!(e.report.direction[5].abs() > 0.5, "{}", e.report.direction);
    check("offset of contact 1, 1 mm", &e, &t, &[1e-3], &[]);
}

#[test]
fn mass_inertia_and_biases_are_estimated_together() {
    use Constant::*;
    let list = [Mass, Inertia, ForceBias(Side::First), ForceBias(Side::Second)];
    let bias = |s: &PlanarSample| PlanarSample { forces: s.forces.map(|[a, b]| [a - 0.02, b + 0.03]), ..*s };
    let (e, t) = constants::<9>(&list, [1.05, 0.95], bias);
    let expected = [(1.0_f64 / 1.05).ln(), (1.0_f64 / 0.95).ln(), 0.02, -0.03];
    check("mass, inertia, both biases", &e, &t, &expected, &[0.02, 0.05, 0.03, 0.03]);
}

/// Mass, inertia and both gains can all be scaled together without any change of the motion: that is what is reported.
#[test]
fn a_common_scale_of_mass_and_gains_is_not_observable() {
    use Constant::*;
    let list = [Mass, Inertia, ForceGain(Side::First), ForceGain(Side::Second)];
    let (e, _) = constants::<9>(&list, [1.0; 2], |s: &PlanarSample| *s);
    assert_eq!(e.report.status, Status::NotObservable, "{:?}", e.report);
    let share = |i: usize| e.report.direction[i].abs();
    assert!((5..9).all(|i| (share(i) - 0.5).abs() < 0.01), "{}", e.report.direction);
    assert!(
        PlanarObserver::<8>::new(
            PlanarNominal {
                mass: PlanarMass::new(1.0, 1.0).unwrap(),
                gravity: 9.81,
                contact_deviation: 0.0,
                force_deviation: 0.0
            },
            &list,
            PlanarObserverOptions::default()
        )
        .is_err()
    );
}
