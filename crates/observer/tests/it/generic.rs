//! The generic observers on a linear problem, where the Kalman filter is exact, and on a pendulum.

use nalgebra::{SMatrix, SVector};
use observer::batch::*;
use observer::ekf::*;
use observer::newton::*;
use observer::rk4::*;
use observer::*;

type V3 = SVector<f64, 3>;
type M3 = SMatrix<f64, 3, 3>;

/// A damped oscillator with a drifting offset, position and a mixture measured.
struct Linear {
    noise: bool,
}

fn transition() -> M3 {
    M3::new(0.995, 0.099, 0.01, -0.099, 0.985, 0.02, 0.0, 0.0, 1.0)
}

fn process() -> M3 {
    let b = M3::new(0.01, 0.0, 0.0, 0.003, 0.02, 0.0, 0.0, 0.001, 0.005);
    b * b.transpose()
}

fn outputs() -> SMatrix<f64, 2, 3> {
    SMatrix::<f64, 2, 3>::new(1.0, 0.0, 0.2, 0.3, 1.0, 0.0)
}

impl Model<3, 2> for Linear {
    type Input = V3;
    fn flow(&self, x: &V3, input: &V3) -> (V3, M3) {
        (transition() * x + input, transition())
    }
    fn output(&self, x: &V3, _: &V3) -> (SVector<f64, 2>, SMatrix<f64, 2, 3>) {
        (outputs() * x, outputs())
    }
    fn process_noise(&self, _: &V3, _: &V3) -> Option<M3> {
        self.noise.then(process)
    }
    fn scales(&self) -> V3 {
        V3::new(1.0, 1.0, 0.5)
    }
    fn names(&self) -> [&'static str; 3] {
        ["position", "speed", "offset"]
    }
}

/// A deterministic, irregular sequence in (-1, 1).
pub(crate) fn wobble(k: usize, salt: f64) -> f64 {
    ((k as f64 + 1.0) * (12.9898 + salt)).sin()
}

fn samples(count: usize) -> Vec<Sample<V3, 2>> {
    (0..count)
        .map(|k| Sample {
            input: V3::new(0.02 * wobble(k, 1.0), 0.0, 0.01),
            measured: SVector::<f64, 2>::new(wobble(k, 2.0), 0.5 * wobble(k, 3.0)),
            // Now and then a channel is missing; what stands there must not matter.
            information: SVector::<f64, 2>::new(if k % 5 == 3 { 0.0 } else { 25.0 }, 16.0),
        })
        .collect()
}

/// The Kalman filter in its textbook form, with an inverse, as the oracle.
fn kalman(samples: &[Sample<V3, 2>], x: V3, p: M3, noise: bool) -> Vec<(V3, M3)> {
    let (mut x, mut p) = (x, p);
    let q = if noise { process() } else { M3::zeros() };
    let mut out = Vec::new();
    for (k, sample) in samples.iter().enumerate() {
        if k > 0 {
            x = transition() * x + sample.input;
            p = transition() * p * transition().transpose() + q;
        }
        let mut information = p.try_inverse().unwrap();
        let mut vector = information * x;
        for c in 0..2 {
            let row = outputs().row(c).transpose();
            information += row * row.transpose() * sample.information[c];
            vector += row * (sample.information[c] * sample.measured[c]);
        }
        p = information.try_inverse().unwrap();
        x = p * vector;
        out.push((x, p));
    }
    out
}

fn start() -> (Start<3>, M3) {
    let deviations = V3::new(1.0, 2.0, 0.7);
    (Start::prior(V3::new(0.3, -0.2, 0.1), &deviations), M3::from_diagonal(&deviations.map(|d| d * d)))
}

#[test]
fn every_observer_is_the_kalman_filter_on_a_linear_problem() {
    for noise in [false, true] {
        let samples = samples(60);
        let (start, p) = start();
        let expected = kalman(&samples, start.state, p, noise);
        let mut filter = ExtendedKalmanFilter::new(Linear { noise }, &start).unwrap();
        let moving = NewtonOptions { window: 10, steps: 1, damping: 0.0, arrival: Arrival::Carry(1.0) };
        let growing = NewtonOptions { window: 60, ..moving };
        let mut short = NewtonObserver::new(Linear { noise }, moving, start).unwrap();
        let mut long = NewtonObserver::new(Linear { noise }, growing, start).unwrap();
        for (sample, (x, p)) in samples.iter().zip(&expected) {
            filter.push(sample);
            let estimates = [
                ("filter", *filter.state(), *filter.covariance()),
                ("moving window", short.push(*sample).state, short.estimate().unwrap().report.covariance),
                ("growing window", long.push(*sample).state, long.estimate().unwrap().report.covariance),
            ];
            for (what, state, covariance) in estimates {
                assert!((state - x).amax() < 1e-10, "{what} noise {noise}: {state} {x}");
                assert!((covariance - p).amax() < 1e-10, "{what} noise {noise}: {covariance} {p}");
            }
        }
        let batch = solve_batch(&Linear { noise }, &samples, &start, &BatchOptions::default()).unwrap();
        let last = batch.states.last().unwrap();
        assert!((last - expected[59].0).amax() < 1e-10);
        // Against the smoother of Rauch, Tung and Striebel, backward from the filter.
        let q = if noise { process() } else { M3::zeros() };
        let (mut x, mut p) = expected[59];
        for (k, (xf, pf)) in expected.iter().enumerate().take(59).rev() {
            let predicted = transition() * pf * transition().transpose() + q;
            let gain = pf * transition().transpose() * predicted.try_inverse().unwrap();
            x = xf + gain * (x - transition() * xf - samples[k + 1].input);
            p = pf + gain * (p - predicted) * gain.transpose();
            assert!((batch.states[k] - x).amax() < 1e-9, "smoothed state {k}");
        }
        assert!((batch.report.covariance - p).amax() < 1e-9, "smoothed covariance");
    }
}

#[test]
fn forgetting_leaves_exactly_the_window() {
    let samples = samples(40);
    let (start, _) = start();
    let options = NewtonOptions { window: 12, steps: 2, damping: 0.0, arrival: Arrival::Forget };
    let mut observer = NewtonObserver::new(Linear { noise: false }, options, start).unwrap();
    for sample in &samples {
        observer.push(*sample);
    }
    let guess = Start::guess(V3::zeros());
    let batch =
        solve_batch(&Linear { noise: false }, &samples[28..], &guess, &BatchOptions::default()).unwrap();
    let estimate = observer.estimate().unwrap();
    assert!((estimate.first_state - batch.states[0]).amax() < 1e-10);
    assert!((estimate.state - batch.states[11]).amax() < 1e-10);
}

/// Two position-like states of which only the sum is measured: the difference is named and stays uncertain.
/// An input that becomes known only later: put right in the window, it is as if it had been right from the start.
#[test]
fn an_amended_sample_counts_as_if_it_had_been_so_from_the_start() {
    let samples = samples(30);
    let (start, covariance) = start();
    for noise in [true, false] {
        let options = NewtonOptions { window: 10, steps: 1, damping: 0.0, arrival: Arrival::Carry(1.0) };
        let mut observer = NewtonObserver::new(Linear { noise }, options, start).unwrap();
        let mut last = None;
        for k in 0..samples.len() {
            let early = Sample { input: V3::repeat(0.3), ..samples[k] };
            if k > 0 {
                assert!(observer.amend(0, samples[k - 1]));
            }
            last = Some(observer.push(early));
        }
        assert!(observer.amend(0, samples[29]) && !observer.amend(10, samples[0]));
        let before = last.unwrap().state;
        let estimate = observer.step().unwrap();
        let (state, _) = *kalman(&samples, start.state, covariance, noise).last().unwrap();
        assert!((estimate.state - state).amax() < 1e-10, "noise {noise}: {}", estimate.state - state);
        assert!((before - state).amax() > 0.1);
    }
}

#[test]
fn an_unobservable_direction_is_named() {
    struct Sum;
    impl Model<2, 1> for Sum {
        type Input = ();
        fn flow(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
            (*x, SMatrix::identity())
        }
        fn output(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 2>) {
            (SVector::<f64, 1>::new(x[0] + x[1]), SMatrix::<f64, 1, 2>::new(1.0, 1.0))
        }
        fn scales(&self) -> SVector<f64, 2> {
            SVector::<f64, 2>::new(1.0, 1.0)
        }
        fn names(&self) -> [&'static str; 2] {
            ["left", "right"]
        }
    }
    let options = NewtonOptions { window: 20, steps: 1, damping: 0.0, arrival: Arrival::Carry(1.0) };
    let guess = Start::guess(SVector::<f64, 2>::new(3.0, 0.0));
    let mut observer = NewtonObserver::new(Sum, options, guess).unwrap();
    let mut filter = ExtendedKalmanFilter::new(Sum, &guess).unwrap();
    for _ in 0..50 {
        let measured = SVector::<f64, 1>::new(1.0);
        let sample = Sample { input: (), measured, information: SVector::<f64, 1>::new(1e4) };
        observer.push(sample);
        filter.push(&sample);
    }
    for report in [observer.estimate().unwrap().report, filter.estimate().report] {
        assert_eq!((report.status, report.rank), (Status::NotObservable, 1));
        let words = report.direction_in_words(&Sum.names());
        assert!(words.contains("0.71") && words.contains("-0.71"), "{words}");
        // The truth may be anywhere along left - right: the covariance covers an error of any size met.
        assert!(report.deviations().iter().all(|&d| d > 1e6));
    }
}

/// Newton converges quadratically from a start that is 20 % off, on exact data of a pendulum.
#[test]
fn newton_converges_quadratically_on_exact_data() {
    struct Pendulum;
    impl Model<2, 1> for Pendulum {
        type Input = ();
        fn flow(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 2>, SMatrix<f64, 2, 2>) {
            rk4_linearised(x, 0.02, |_, x| {
                let (sin, cos) = x[0].sin_cos();
                let rate = SVector::<f64, 2>::new(x[1], -9.0 * sin);
                (rate, SMatrix::<f64, 2, 2>::new(0.0, 1.0, -9.0 * cos, 0.0))
            })
        }
        fn output(&self, x: &SVector<f64, 2>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 2>) {
            (SVector::<f64, 1>::new(x[0].sin()), SMatrix::<f64, 1, 2>::new(x[0].cos(), 0.0))
        }
        fn scales(&self) -> SVector<f64, 2> {
            SVector::<f64, 2>::new(1.0, 3.0)
        }
        fn names(&self) -> [&'static str; 2] {
            ["angle", "speed"]
        }
    }
    let truth = SVector::<f64, 2>::new(0.8, 1.0);
    let mut x = truth;
    let mut samples = Vec::new();
    for _ in 0..50 {
        let measured = Pendulum.output(&x, &()).0;
        samples.push(Sample { input: (), measured, information: SVector::<f64, 1>::new(1.0) });
        x = Pendulum.advance(&x, &());
    }
    let mut errors = Vec::new();
    for iterations in 1..8 {
        let options = BatchOptions { iterations, ..BatchOptions::default() };
        let start = Start::guess(truth * 1.2);
        let solution = solve_batch(&Pendulum, &samples, &start, &options).unwrap();
        errors.push((solution.states[0] - truth).amax());
    }
    let quadratic = errors.windows(2).filter(|e| e[0] < 0.1 && e[1] > 1e-13);
    assert!(quadratic.clone().count() >= 2, "{errors:?}");
    assert!(quadratic.clone().all(|e| e[1] < 5.0 * e[0] * e[0]), "{errors:?}");
    assert!(errors[6] < 1e-13, "{errors:?}");
}

#[test]
fn bad_options_are_named() {
    let options = NewtonOptions { window: 10, steps: 1, damping: 0.0, arrival: Arrival::Forget };
    let make = |options| NewtonObserver::new(Linear { noise: false }, options, start().0).map(|_| ());
    assert!(matches!(
        make(NewtonOptions { window: 1, ..options }),
        Err(ObserverError::TooFewSamples { found: 1, needed: 2 })
    ));
    assert!(matches!(make(NewtonOptions { steps: 0, ..options }), Err(ObserverError::Value { .. })));
    assert!(matches!(make(NewtonOptions { damping: f64::NAN, ..options }), Err(ObserverError::Value { .. })));
    assert!(matches!(
        make(NewtonOptions { arrival: Arrival::Carry(1.5), ..options }),
        Err(ObserverError::Value { what: "arrival factor", .. })
    ));
    let bad = Start::guess(V3::new(0.0, f64::NAN, 0.0));
    assert!(ExtendedKalmanFilter::new(Linear { noise: false }, &bad).is_err());
    assert!(
        solve_batch(&Linear { noise: false }, &samples(1), &start().0, &BatchOptions::default()).is_err()
    );
}

/// Of a linear problem Laplace's approximation is exact: what a batch solution says about its probability mass is the
/// likelihood of all outputs together, Gaussian with the covariance that prior, process and sensors give them.
#[test]
fn the_probability_mass_is_the_likelihood_of_the_outputs() {
    let samples = samples(12);
    let of_mass = |deviations: V3| {
        let start = Start::prior(V3::new(0.3, -0.2, 0.1), &deviations);
        let solution =
            solve_batch(&Linear { noise: true }, &samples, &start, &BatchOptions::default()).unwrap();
        let sensors: f64 =
            samples.iter().flat_map(|s| s.information.iter()).filter(|&&i| i > 0.0).map(|i| -i.ln()).sum();
        let prior: f64 = deviations.iter().map(|d| 2.0 * d.ln()).sum();
        solution.chi_squared + solution.prior_cost + solution.log_determinant + sensors + prior
    };
    let of_outputs = |deviations: V3| {
        let (mut mean, mut p) = (V3::new(0.3, -0.2, 0.1), M3::from_diagonal(&deviations.map(|d| d * d)));
        // Channel by channel, in the order of time: each conditioned on those before it.
        let mut likelihood = 0.0;
        for (k, sample) in samples.iter().enumerate() {
            if k > 0 {
                mean = transition() * mean + sample.input;
                p = transition() * p * transition().transpose() + process();
            }
            for c in (0..2).filter(|&c| sample.information[c] > 0.0) {
                let row = outputs().row(c).transpose();
                let variance = row.dot(&(p * row)) + 1.0 / sample.information[c];
                let surprise = sample.measured[c] - row.dot(&mean);
                likelihood += surprise * surprise / variance + variance.ln();
                let gain = p * row / variance;
                mean += gain * surprise;
                p -= gain * (row.transpose() * p);
            }
        }
        likelihood
    };
    for deviations in [V3::new(1.0, 0.5, 0.2), V3::new(0.1, 3.0, 0.02), V3::new(10.0, 10.0, 10.0)] {
        let (mass, outputs) = (of_mass(deviations), of_outputs(deviations));
        assert!((mass - outputs).abs() < 1e-9 * outputs.abs().max(1.0), "{mass} {outputs}");
    }
}

/// Far along the flank of an arctangent full Gauss-Newton steps lead to and fro, ever farther away; short ones arrive.
#[test]
fn steps_to_and_fro_are_shortened() {
    struct Flank;
    impl Model<1, 1> for Flank {
        type Input = ();
        fn flow(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
            (*x, SMatrix::identity())
        }
        fn output(&self, x: &SVector<f64, 1>, (): &()) -> (SVector<f64, 1>, SMatrix<f64, 1, 1>) {
            (x.map(f64::atan), x.map(|x| 1.0 / (1.0 + x * x)))
        }
        fn process_noise(&self, _: &SVector<f64, 1>, (): &()) -> Option<SMatrix<f64, 1, 1>> {
            Some(SMatrix::from_element(1e-12))
        }
        fn scales(&self) -> SVector<f64, 1> {
            SVector::from_element(1.0)
        }
        fn names(&self) -> [&'static str; 1] {
            ["place"]
        }
    }
    let sample =
        Sample { input: (), measured: SVector::from_element(0.0), information: SVector::from_element(1e4) };
    let solve = |longest_step: f64| {
        let options = BatchOptions { iterations: 60, longest_step, ..BatchOptions::default() };
        solve_batch(&Flank, &[sample; 3], &Start::guess(SVector::from_element(3.0)), &options).unwrap()
    };
    // With a longest step from the start, and with none: then the first step that turns back sets one.
    for longest_step in [0.3, f64::INFINITY] {
        let found = solve(longest_step);
        assert!(found.report.status == Status::Converged, "{:?}", found.report);
        assert!(found.states[0][0].abs() < 1e-9, "{}", found.states[0][0]);
    }
}
