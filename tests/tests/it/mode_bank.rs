//! Banks of modes against the numbers of another implementation (`tests/data/modes.json`).

use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use recon::observer::Model;
use recon::observer::bank::{
    Bank, BankOptions, Gaussian, KalmanMember, Landing, Member, Memory, ModeState, Modes, jump,
    match_rotations, smooth_backward,
};
use recon_tests::belt::{Entry, belt_velocity, modes, start};
use serde_json::Value;

/// Of each number, and what is left of one that is nearly zero.
const TOLERANCE: f64 = 1e-10;
const ROUNDING: f64 = 1e-14;
const IMM: BankOptions = BankOptions { memory: Memory::MergedBeforeUpdate, drop: 0.0, skip: 0.0, lag: 0 };

fn file(name: &str) -> Value {
    let path = format!("{}/data/{name}", env!("CARGO_MANIFEST_DIR"));
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

fn oracle() -> Value {
    file("modes.json")
}

/// All numbers of nested lists, row by row.
fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(entries) => entries.iter().flat_map(numbers).collect(),
        number => vec![number.as_f64().unwrap()],
    }
}

fn vector<const N: usize>(value: &Value) -> SVector<f64, N> {
    SVector::from_column_slice(&numbers(value))
}

fn matrix<const R: usize, const C: usize>(value: &Value) -> SMatrix<f64, R, C> {
    SMatrix::from_row_slice(&numbers(value))
}

fn near(what: &str, found: &[f64], expected: &Value) {
    let expected = numbers(expected);
    assert_eq!(found.len(), expected.len(), "{what}");
    for (f, e) in found.iter().zip(&expected) {
        assert!((f - e).abs() <= TOLERANCE * e.abs() + ROUNDING, "{what}: {f} {e}");
    }
}

/// `x' = F x + b`, `y = H x + d`, from a table.
struct Affine<const N: usize, const M: usize> {
    f: SMatrix<f64, N, N>,
    b: SVector<f64, N>,
    q: SMatrix<f64, N, N>,
    h: SMatrix<f64, M, N>,
    d: SVector<f64, M>,
}

impl<const N: usize, const M: usize> Model<N, M> for Affine<N, M> {
    type Input = ();
    fn flow(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        (self.f * x + self.b, self.f)
    }
    fn output(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, M>, SMatrix<f64, M, N>) {
        (self.h * x + self.d, self.h)
    }
    fn process_noise(&self, _: &SVector<f64, N>, (): &()) -> Option<SMatrix<f64, N, N>> {
        Some(self.q)
    }
    fn scales(&self) -> SVector<f64, N> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; N] {
        ["state"; N]
    }
}

/// Without an entry `b` or `d` the model is linear.
fn member<const N: usize, const M: usize>(model: &Value) -> Box<dyn Member<()>> {
    let affine: Affine<N, M> = Affine {
        f: matrix(&model["F"]),
        b: if model["b"].is_null() { SVector::zeros() } else { vector(&model["b"]) },
        q: matrix(&model["Q"]),
        h: matrix(&model["H"]),
        d: if model["d"].is_null() { SVector::zeros() } else { vector(&model["d"]) },
    };
    Box::new(KalmanMember::new(affine, vector::<M>(&model["R"])).unwrap())
}

fn state<const N: usize>(input: &Value, mode: usize) -> ModeState {
    let state = Gaussian::new(&vector::<N>(&input["x"][mode]), &matrix::<N, N>(&input["P"][mode]));
    ModeState { probability: input["mu"][mode].as_f64().unwrap(), state }
}

fn switches(modes: Vec<Box<dyn Member<()>>>, table: &Value) -> Modes<()> {
    let rows: Vec<Vec<f64>> = table.as_array().unwrap().iter().map(numbers).collect();
    let rows: Vec<&[f64]> = rows.iter().map(Vec::as_slice).collect();
    Modes::new(modes, &rows).unwrap()
}

/// With the jumps between two states and three.
fn with_jumps(modes: Modes<()>, table: &Value) -> Modes<()> {
    let (there, back) = (&table["0->1"], &table["1->0"]);
    let (a, o, n) = (matrix::<3, 2>(&there["A"]), vector::<3>(&there["a"]), matrix::<3, 3>(&there["N"]));
    let entry = jump(move |x: &SVector<f64, 2>, (): &()| Landing { state: a * x + o, map: a, noise: n });
    let (a, o, n) = (matrix::<2, 3>(&back["A"]), vector::<2>(&back["a"]), matrix::<2, 2>(&back["N"]));
    let exit = jump(move |x: &SVector<f64, 3>, (): &()| Landing { state: a * x + o, map: a, noise: n });
    modes.with_jump(0, 1, entry).unwrap().with_jump(1, 0, exit).unwrap()
}

/// One step from a state after a sample: the bank sees that sample as one in which nothing was measured.
fn one_step(modes: Modes<()>, start: &[ModeState], case: &Value) {
    let mut bank = Bank::new(modes, start, IMM).unwrap();
    assert_eq!(bank.push(&(), &[None]).unwrap(), 0.0);
    let y = case["input"]["y"][0].as_f64().unwrap();
    let output = &case["output"];
    near("log-evidence", &[bank.push(&(), &[Some(y)]).unwrap()], &output["logev"]);
    near("probabilities", &[bank.probability(0), bank.probability(1)], &output["mu"]);
    check_states(&bank.mode_states(), &output["x"], &output["P"]);
}

fn check_states(states: &[ModeState], means: &Value, covariances: &Value) {
    assert_eq!(states.len(), 2);
    for (mode, of_mode) in states.iter().enumerate() {
        near("state", of_mode.state.mean.as_slice(), &means[mode]);
        // A covariance is symmetric: columns are rows.
        near("covariance", of_mode.state.covariance.as_slice(), &covariances[mode]);
    }
}

#[test]
fn a_step_of_equal_states_is_that_of_filterpy() {
    let case = &oracle()["equal_step"];
    let input = &case["input"];
    let modes = switches(
        vec![member::<2, 1>(&input["models"][0]), member::<2, 1>(&input["models"][1])],
        &input["Pi"],
    );
    one_step(modes, &[state::<2>(input, 0), state::<2>(input, 1)], case);
}

/// Over a whole log, of a model in which both modes have `N` states. Filterpy works in the linear domain, in another order.
fn whole_log<const N: usize, const M: usize>(case: &Value) {
    let members: Vec<_> = case["models"].as_array().unwrap().iter().map(member::<N, M>).collect();
    let state =
        Gaussian::new(&vector::<N>(&case["x"]), &SMatrix::from_diagonal(&vector::<N>(&case["variances"])));
    let start: Vec<ModeState> = numbers(&case["mu"])
        .into_iter()
        .map(|probability| ModeState { probability, state: state.clone() })
        .collect();
    let mut bank = Bank::new(switches(members, &case["Pi"]), &start, IMM).unwrap();
    bank.push(&(), &[None; M]).unwrap();
    let rows: [usize; N] = std::array::from_fn(|i| i);
    let rows = vec![&rows[..]; start.len()];
    let (samples, steps) = (case["y"].as_array().unwrap(), case["steps"].as_array().unwrap());
    assert!(samples.len() == steps.len() && samples.len() >= 40);
    let within = |what: &str, found: f64, expected: f64| {
        assert!((found - expected).abs() <= 1e-9 * expected.abs() + 1e-13, "{what}: {found} {expected}");
    };
    for (sample, step) in samples.iter().zip(steps) {
        let measured = vector::<M>(sample);
        bank.push(&(), &std::array::from_fn::<_, M, _>(|c| Some(measured[c]))).unwrap();
        for (mode, expected) in numbers(&step["mu"]).into_iter().enumerate() {
            within("probability", bank.probability(mode), expected);
        }
        let mixed = bank.common(&rows).unwrap();
        mixed.mean.iter().zip(numbers(&step["x"])).for_each(|(f, e)| within("state", *f, e));
    }
    let mixed = bank.common(&rows).unwrap();
    mixed
        .covariance
        .iter()
        .zip(numbers(&case["mixed_P"]))
        .for_each(|(f, e)| within("mixed covariance", *f, e));
    for (of_mode, expected) in bank.mode_states().iter().zip(case["last_P"].as_array().unwrap()) {
        let found = of_mode.state.covariance.iter();
        found.zip(numbers(expected)).for_each(|(f, e)| within("covariance", *f, e));
    }
}

#[test]
fn whole_logs_of_equal_states_are_those_of_filterpy() {
    let file = file("filterpy_imm.json");
    whole_log::<6, 2>(&file["crassidis_4_6"]);
    whole_log::<2, 1>(&file["three_models"]);
}

#[test]
fn a_step_of_unequal_states_is_that_of_the_oracle() {
    let case = &oracle()["unequal_step"];
    let input = &case["input"];
    let members = vec![member::<2, 1>(&input["models"][0]), member::<3, 1>(&input["models"][1])];
    let modes = with_jumps(switches(members, &input["Pi"]), &input["jump"]);
    one_step(modes, &[state::<2>(input, 0), state::<3>(input, 1)], case);
}

/// States and modes of the sample before, given one more: the oracle's Gaussian division. Its probability of the mode lies
/// within 2e-6 of that of the exact branches.
#[test]
fn a_step_backward_is_that_of_the_oracle() {
    let oracle = oracle();
    let (before, case) = (&oracle["unequal_step"], &oracle["smooth_step"]);
    let input = &case["input"];
    let members = vec![member::<2, 1>(&input["models"][0]), member::<3, 1>(&input["models"][1])];
    let modes = with_jumps(switches(members, &before["input"]["Pi"]), &input["jump"]);
    let pair = |of: &Value| vec![state::<2>(of, 0), state::<3>(of, 1)];
    let filtered = [pair(&before["output"]), pair(&input["filtered_k1"])];
    let smoothed = smooth_backward(&modes, &filtered, &[(), ()]).unwrap();
    let expected = &case["output"]["gauss"];
    let probabilities = [smoothed[0][0].probability, smoothed[0][1].probability];
    near("probabilities", &probabilities, &expected["mu_s"]);
    check_states(&smoothed[0], &expected["x_s"], &expected["P_s"]);
    let exact = numbers(&case["exact_branches"]["smoothed_mode_k"]);
    assert!((probabilities[1] - exact[1]).abs() < 2e-6);
    assert_eq!(smoothed[1], filtered[1]);
}

#[test]
fn twelve_samples_merged_before_the_update_are_the_oracle_s() {
    let toy = &oracle()["toy"];
    let mut bank = Bank::new(modes(Entry::TRUE), &start(), IMM).unwrap();
    for (k, y) in numbers(&toy["y"]).into_iter().enumerate() {
        bank.push(&belt_velocity(k), &[Some(y)]).unwrap();
        near("slides", &[bank.probability(1)], &toy["imm_P_slide"][k]);
    }
    near("log-evidence", &[bank.log_evidence()], &toy["imm_log_evidence"]);
}

/// All 4096 sequences of modes, by the oracle: what is lost by merging beyond the last switch is less than 0.008, and most of it
/// is gone already with eight hypotheses.
#[test]
fn twelve_samples_with_all_switch_times_are_nearly_exact() {
    let toy = &oracle()["toy"];
    let mut last = f64::INFINITY;
    for (kept, filtered, smoothed, evidence) in [(8, 0.05, 0.05, 0.2), (24, 0.008, 0.01, 0.01)] {
        let options = BankOptions { memory: Memory::Hypotheses(kept), drop: 0.0, skip: 0.0, lag: 12 };
        let mut bank = Bank::new(modes(Entry::TRUE), &start(), options).unwrap();
        let mut errors = Vec::new();
        for (k, y) in numbers(&toy["y"]).into_iter().enumerate() {
            bank.push(&belt_velocity(k), &[Some(y)]).unwrap();
            errors.push((bank.probability(1) - toy["exact_filter_P_slide"][k].as_f64().unwrap()).abs());
            let common = bank.common(&[&[0, 1], &[0, 2]]).unwrap();
            for (found, exact) in common.mean.iter().zip(numbers(&toy["exact_mean_p_mu"][k])) {
                assert!((found - exact).abs() < 1e-3, "{kept} at {k}: {found} {exact}");
            }
        }
        let largest = errors.iter().copied().fold(0.0, f64::max);
        assert!(largest < filtered && largest < last, "{kept}: {errors:?}");
        last = largest;
        for (k, exact) in numbers(&toy["exact_smoothed_P_slide"]).into_iter().enumerate() {
            let found = bank.smoothed(11 - k, 1).unwrap();
            assert!((found - exact).abs() < smoothed, "{kept} at {k}: {found} {exact}");
        }
        let exact = toy["exact_log_evidence"].as_f64().unwrap();
        assert!((bank.log_evidence() - exact).abs() < evidence, "{kept}: {} {exact}", bank.log_evidence());
    }
}

#[test]
fn rotations_are_merged_as_by_the_oracle() {
    let case = &oracle()["rotation_moment_match"];
    let weighted: Vec<(f64, Vector3<f64>, Matrix3<f64>)> = (0..3)
        .map(|i| (case["w"][i].as_f64().unwrap(), vector(&case["rotvec"][i]), matrix(&case["P"][i])))
        .collect();
    let (mean, covariance) = match_rotations(&weighted).unwrap();
    near("mean", mean.as_slice(), &case["mean_rotvec"]);
    near("covariance", covariance.as_slice(), &case["cov_right_perturbation"]);
}
