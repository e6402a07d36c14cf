//! Banks of modes: how near their odds are to the exact ones against what they keep, and what that costs.

use cpu_time::ThreadTime;
use nalgebra::{SMatrix, SVector};
use recon::observer::Model;
use recon::observer::bank::{
    Bank, BankError, BankOptions, Gaussian, KalmanMember, Memory, ModeState, Modes, smooth_backward,
};
use recon_tests::belt::{Entry, belt_velocity, modes, run, start};
use std::time::Duration;

const RUNS: u64 = 200;
const SAMPLES: usize = 200;
/// Runs that are timed: of the whole of them the fastest of as many repeats counts.
const TIMED: u64 = 20;
const REPEATS: usize = 5;
/// Probability above which a mode counts as told with confidence.
const CONFIDENT: f64 = 0.99;

const EXACT: Memory = Memory::Hypotheses(2 * SAMPLES);

/// What a bank says over all runs, sample by sample, with what is true.
#[derive(Default)]
struct Told {
    filtered: Vec<f64>,
    smoothed: Vec<f64>,
    slides: Vec<bool>,
    log_evidence: Vec<f64>,
    lost: Vec<f64>,
    /// Hypotheses held after each sample.
    held: Vec<f64>,
}

pub(crate) fn main() -> Result<(), BankError> {
    println!("# Banks of modes\n\nMade by `cargo xtask study mode_bank`.\n");
    println!(
        "A body on a belt sticks (two states) or slides (three), and switches at one sample in 50; only its position is"
    );
    println!(
        "measured. {RUNS} runs of {SAMPLES} samples, drawn from the model. Exact: every switch time is kept, and merged is only"
    );
    println!(
        "what lies beyond the last switch. Error: distance of the probability of sliding from the exact one. Brier: mean"
    );
    println!(
        "squared distance from the truth. Confident: share of samples held for more than 99 % one mode; wrong: share of these."
    );
    println!(
        "Times are the thread's own, smoothing off, on one core, of {TIMED} runs the fastest of {REPEATS}.\n"
    );
    let exact = tell(Entry::TRUE, with(EXACT, SAMPLES))?;
    println!("## What is kept\n");
    println!(
        "| kept | error: mean, 99 %, largest | Brier filtered, smoothed | confident, wrong | log-evidence of a run less exact | us a sample |"
    );
    println!("|---|---|---|---|---|---|");
    kept("one a mode, merged before the update", Memory::MergedBeforeUpdate, &exact)?;
    for count in [2, 4, 6, 8, 12, 16, 32] {
        kept(&count.to_string(), Memory::Hypotheses(count), &exact)?;
    }
    kept("all switch times (exact)", EXACT, &exact)?;
    println!("\n## What is given up\n");
    println!(
        "Given up after a sample: the lightest hypotheses, together as much as is said. Not run: each that is less likely"
    );
    println!("before a sample than is said.\n");
    println!(
        "| kept | given up, not run | error: mean, 99 %, largest | lost a run, in sum | hypotheses held | us a sample |"
    );
    println!("|---|---|---|---|---|---|");
    let eight = Memory::Hypotheses(8);
    for (name, memory, drop, skip) in [
        ("all", EXACT, 1e-2, 0.0),
        ("all", EXACT, 1e-3, 0.0),
        ("all", EXACT, 1e-4, 0.0),
        ("all", EXACT, 1e-6, 0.0),
        ("all", EXACT, 0.0, 1e-3),
        ("all", EXACT, 0.0, 1e-4),
        ("all", EXACT, 0.0, 1e-6),
        ("8", eight, 0.0, 0.0),
        ("8", eight, 1e-3, 0.0),
        ("8", eight, 0.0, 1e-3),
    ] {
        let options = BankOptions { memory, drop, skip, lag: 0 };
        let told = tell(Entry::TRUE, options)?;
        let (lost, held) = (mean(&told.lost), mean(&told.held));
        let off = told.errors(&exact);
        println!(
            "| {name} | {drop:.0e}, {skip:.0e} | {off} | {lost:.3} | {held:.1} | {:.2} |",
            cost(options)?
        );
    }
    println!("\n## Modes after the fact\n");
    println!(
        "Paths: what each hypothesis remembers of its modes. Backward: states and modes by `smooth_backward`.\n"
    );
    println!("| smoother | mean error against exact paths | Brier | confident, wrong |");
    println!("|---|---|---|---|");
    for (name, memory) in [
        ("paths of all", EXACT),
        ("paths of 16", Memory::Hypotheses(16)),
        ("paths of 8", eight),
        ("paths, merged before the update", Memory::MergedBeforeUpdate),
    ] {
        smoothed(name, &tell(Entry::TRUE, with(memory, SAMPLES))?.smoothed, &exact);
    }
    smoothed("backward, merged before the update", &backward(Memory::MergedBeforeUpdate)?, &exact);
    smoothed("backward from 8", &backward(eight)?, &exact);
    println!("\n## What fills the velocity at the start of sliding\n");
    println!("Merged before the update, but for the last column: eight hypotheses.\n");
    println!("| filling | error: mean, 99 %, largest | Brier | confident, wrong | mean error with eight |");
    println!("|---|---|---|---|---|");
    for (name, entry) in [
        ("as it is: belt's velocity, 0.15", Entry::TRUE),
        ("belt's velocity, 0.45", Entry { deviation: 0.45, ..Entry::TRUE }),
        ("belt's velocity, 0.05", Entry { deviation: 0.05, ..Entry::TRUE }),
        ("belt's velocity, 0", Entry { deviation: 0.0, ..Entry::TRUE }),
        ("zero, 1", Entry { share: 0.0, deviation: 1.0 }),
        ("zero, 0", Entry::ZEROS),
    ] {
        let told = tell(entry, with(Memory::MergedBeforeUpdate, 0))?;
        let eight = tell(entry, with(Memory::Hypotheses(8), 0))?;
        let brier = told.brier(&told.filtered);
        println!(
            "| {name} | {} | {brier:.4} | {} | {:.4} |",
            told.errors(&exact),
            told.confident(&told.filtered),
            mean(&eight.off(&exact))
        );
    }
    println!("\n## Cost against the number of modes\n");
    println!("Microseconds a sample; every mode can follow every other.\n");
    println!(
        "| modes | 3 states, one output: merged before the update | 8 hypotheses | 16 | 12 states, three outputs: merged before the update | 8 | 16 |"
    );
    println!("|---|---|---|---|---|---|---|");
    for count in [1, 2, 3, 4, 6, 8] {
        let memories = [Memory::MergedBeforeUpdate, Memory::Hypotheses(8), Memory::Hypotheses(16)];
        let small = memories.map(|memory| chain_cost::<3, 1>(count, memory));
        let large = memories.map(|memory| chain_cost::<12, 3>(count, memory));
        print!("| {count} |");
        for microseconds in small.into_iter().chain(large) {
            print!(" {:.2} |", microseconds?);
        }
        println!();
    }
    Ok(())
}

fn with(memory: Memory, lag: usize) -> BankOptions {
    BankOptions { memory, drop: 0.0, skip: 0.0, lag }
}

fn tell(entry: Entry, options: BankOptions) -> Result<Told, BankError> {
    let mut told = Told::default();
    for seed in 0..RUNS {
        let mut bank = Bank::new(modes(entry), &start(), options)?;
        for (k, (slides, y)) in run(seed, SAMPLES).into_iter().enumerate() {
            bank.push(&belt_velocity(k), &[Some(y)])?;
            told.filtered.push(bank.probability(1));
            told.slides.push(slides);
            told.held.push(bank.hypotheses().count() as f64);
        }
        told.smoothed.extend((0..SAMPLES).rev().map_while(|back| bank.smoothed(back, 1)));
        told.log_evidence.push(bank.log_evidence());
        told.lost.push(bank.lost());
    }
    Ok(told)
}

impl Told {
    fn off(&self, exact: &Self) -> Vec<f64> {
        self.filtered.iter().zip(&exact.filtered).map(|(a, b)| (a - b).abs()).collect()
    }

    fn errors(&self, exact: &Self) -> String {
        let mut off = self.off(exact);
        off.sort_by(f64::total_cmp);
        let at = |share: f64| off.get((share * (off.len() - 1) as f64) as usize).copied().unwrap_or(f64::NAN);
        format!("{:.2e}, {:.1e}, {:.1e}", mean(&off), at(0.99), at(1.0))
    }

    fn brier(&self, odds: &[f64]) -> f64 {
        let off = |(p, slides): (&f64, &bool)| (p - f64::from(u8::from(*slides))).powi(2);
        mean(&odds.iter().zip(&self.slides).map(off).collect::<Vec<_>>())
    }

    fn confident(&self, odds: &[f64]) -> String {
        let sure = odds.iter().zip(&self.slides).filter(|(p, _)| p.max(1.0 - **p) > CONFIDENT);
        let (count, wrong) =
            sure.fold((0, 0), |(n, w), (p, slides)| (n + 1, w + u32::from((*p > 0.5) != *slides)));
        let share = f64::from(count) / odds.len() as f64;
        format!("{share:.3}, {:.4}", f64::from(wrong) / f64::from(count.max(1)))
    }
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn kept(name: &str, memory: Memory, exact: &Told) -> Result<(), BankError> {
    let told = tell(Entry::TRUE, with(memory, SAMPLES))?;
    println!(
        "| {name} | {} | {:.4}, {:.4} | {} | {:.2} | {:.2} |",
        told.errors(exact),
        told.brier(&told.filtered),
        told.brier(&told.smoothed),
        told.confident(&told.filtered),
        mean(&told.log_evidence) - mean(&exact.log_evidence),
        cost(with(memory, 0))?
    );
    Ok(())
}

fn smoothed(name: &str, odds: &[f64], exact: &Told) {
    let off: Vec<f64> = odds.iter().zip(&exact.smoothed).map(|(a, b)| (a - b).abs()).collect();
    println!("| {name} | {:.4} | {:.4} | {} |", mean(&off), exact.brier(odds), exact.confident(odds));
}

/// Probabilities of sliding by the pass backward.
fn backward(memory: Memory) -> Result<Vec<f64>, BankError> {
    let mut odds = Vec::new();
    let inputs: Vec<f64> = (0..SAMPLES).map(belt_velocity).collect();
    for seed in 0..RUNS {
        let mut bank = Bank::new(modes(Entry::TRUE), &start(), with(memory, 0))?;
        let mut filtered = Vec::new();
        for (input, (_, y)) in inputs.iter().zip(run(seed, SAMPLES)) {
            bank.push(input, &[Some(y)])?;
            filtered.push(bank.mode_states());
        }
        let states = smooth_backward(bank.modes(), &filtered, &inputs)?;
        odds.extend(states.iter().map(|modes| modes[1].probability));
    }
    Ok(odds)
}

/// Microseconds a sample.
fn cost(options: BankOptions) -> Result<f64, BankError> {
    let runs: Vec<_> = (0..TIMED).map(|seed| run(seed, SAMPLES)).collect();
    let mut best = Duration::MAX;
    for _ in 0..REPEATS {
        let mut banks = Vec::new();
        for _ in &runs {
            banks.push(Bank::new(modes(Entry::TRUE), &start(), options)?);
        }
        let clock = ThreadTime::now();
        for (bank, run) in banks.iter_mut().zip(&runs) {
            for (k, (_, y)) in run.iter().enumerate() {
                bank.push(&belt_velocity(k), &[Some(*y)])?;
            }
        }
        best = best.min(clock.elapsed());
    }
    Ok(best.as_secs_f64() * 1e6 / (TIMED as f64 * SAMPLES as f64))
}

/// `N / M` integrators in a row behind each of `M` outputs.
struct Chain<const N: usize, const M: usize> {
    noise: f64,
}

impl<const N: usize, const M: usize> Model<N, M> for Chain<N, M> {
    type Input = ();
    fn flow(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, N>, SMatrix<f64, N, N>) {
        let f = SMatrix::from_fn(|i, j| if i == j { 1.0 } else { f64::from(u8::from(j == i + M)) * 0.01 });
        (f * x, f)
    }
    fn output(&self, x: &SVector<f64, N>, (): &()) -> (SVector<f64, M>, SMatrix<f64, M, N>) {
        (SVector::from_fn(|i, _| x[i]), SMatrix::from_fn(|i, j| f64::from(u8::from(i == j))))
    }
    fn process_noise(&self, _: &SVector<f64, N>, (): &()) -> Option<SMatrix<f64, N, N>> {
        Some(SMatrix::identity() * self.noise)
    }
    fn scales(&self) -> SVector<f64, N> {
        SVector::from_element(1.0)
    }
    fn names(&self) -> [&'static str; N] {
        ["state"; N]
    }
}

/// Microseconds a sample of a bank of so many modes, which differ in their noise.
fn chain_cost<const N: usize, const M: usize>(count: usize, memory: Memory) -> Result<f64, BankError> {
    const PUSHES: usize = 2000;
    let mut members = Vec::new();
    for mode in 0..count {
        let model = Chain::<N, M> { noise: 1e-4 * 4.0_f64.powi(mode as i32) };
        members.push(Box::new(KalmanMember::new(model, SVector::from_element(0.01))?) as _);
    }
    let share = 1.0 / count as f64;
    let row = vec![share; count];
    let first =
        ModeState { probability: share, state: Gaussian::new::<N>(&SVector::zeros(), &SMatrix::identity()) };
    let modes = Modes::new(members, &vec![&row[..]; count])?;
    let mut bank = Bank::new(modes, &vec![first; count], with(memory, 0))?;
    let mut best = Duration::MAX;
    for repeat in 0..REPEATS {
        let clock = ThreadTime::now();
        for k in 0..PUSHES {
            let y = ((repeat * PUSHES + k) as f64 * 0.013).sin();
            bank.push(&(), &[Some(y); M])?;
        }
        best = best.min(clock.elapsed());
    }
    Ok(best.as_secs_f64() * 1e6 / PUSHES as f64)
}
