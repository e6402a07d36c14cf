//! Cost of the planar observers beside their accuracy: prints a table in Markdown.
//!
//! `cargo xtask study planar_costs` writes docs/planar-costs.md.

use nalgebra::SVector;
use recon::contact_kinematics::planar::{FourierBody, PairContact};
use recon::object_dynamics::planar::*;
use recon::observer::planar::*;
use recon::observer::{
    Arrival, BatchOptions, ExtendedKalmanFilter, Model, NewtonObserver, NewtonOptions, Start, solve_batch,
};
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

/// Repetitions of each measurement; the fastest third is averaged, which leaves out what else the machine does.
const REPEATS: usize = 30;

/// Microseconds of the fastest third of the repetitions.
fn microseconds(mut work: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..REPEATS)
        .map(|_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e6
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[..REPEATS / 3].iter().sum::<f64>() / (REPEATS / 3) as f64
}

fn state<const N: usize>(truth: &PlanarTruth) -> SVector<f64, N> {
    let (p, v) = (truth.p_WCm, truth.v_WCm);
    let motion = [p.x, p.y, v.x, v.y, truth.omega0];
    SVector::from_fn(|i, _| motion.get(i).copied().unwrap_or(0.0))
}

struct Setting {
    nominal: PlanarNominal,
    scale: NaturalScale,
    inputs: Vec<PairInput>,
    truth: Vec<PlanarTruth>,
}

impl Setting {
    fn model<const N: usize>(&self, constants: &[Constant]) -> Result<ForceDriven<N>, Box<dyn Error>> {
        Ok(ForceDriven::<N>::new(self.nominal, self.scale, constants)?)
    }

    /// A Newton step on a window of 200 samples at its solution.
    fn newton<const N: usize>(&self, constants: &[Constant], what: &str) -> Result<(), Box<dyn Error>> {
        let model = self.model::<N>(constants)?;
        let options = NewtonOptions { window: 200, steps: 1, damping: 0.0, arrival: Arrival::Carry(1.0) };
        let start = Start::guess(state::<N>(&self.truth[0]));
        let mut observer = NewtonObserver::new(model.clone(), options, start)?;
        for &input in &self.inputs[..200] {
            observer.append(model.sample(input));
        }
        let time = microseconds(|| {
            black_box(observer.step());
        });
        let estimate = observer.step().ok_or("no samples")?;
        let error = estimate.state - state::<N>(&self.truth[199]);
        let position = 1e3 * error[0].hypot(error[1]);
        println!("| {what} | {time:.0} | {:.2} | {position:.1e} |", time / 200.0);
        Ok(())
    }

    fn filter(&self, what: &str) -> Result<(), Box<dyn Error>> {
        let model = self.model::<5>(&[])?;
        let deviations = model.scales() * 1e-3;
        let samples: Vec<_> = self.inputs[..200].iter().map(|&i| model.sample(i)).collect();
        let start = Start::prior(state::<5>(&self.truth[0]), &deviations);
        let mut filter = ExtendedKalmanFilter::new(model.clone(), &start)?;
        let mut broken = false;
        let time = microseconds(|| match ExtendedKalmanFilter::new(model.clone(), &start) {
            Ok(fresh) => {
                filter = fresh;
                samples.iter().for_each(|s| filter.push(s));
            }
            Err(_) => broken = true,
        });
        if broken {
            return Err("the filter cannot start".into());
        }
        let error = filter.state() - state::<5>(&self.truth[199]);
        let position = 1e3 * error[0].hypot(error[1]);
        println!("| {what} | {time:.0} | {:.2} | {position:.1e} |", time / 200.0);
        Ok(())
    }

    fn starts(&self) -> Result<(), Box<dyn Error>> {
        let model = self.model::<5>(&[])?;
        let inputs = &self.inputs[..401];
        let mut found = residual_start(&model, inputs, None)?;
        let cold = microseconds(|| {
            if let Ok(start) = residual_start(&model, inputs, None) {
                found = start;
            }
        });
        let error = found.state - state::<5>(&self.truth[0]);
        println!(
            "| velocity residuals, nine starts, 401 samples | {cold:.0} | | {:.1e} |",
            1e3 * error[0].hypot(error[1])
        );
        let samples: Vec<_> = inputs.iter().map(|&i| model.sample(i)).collect();
        let exact = model.without_process_noise();
        let mut fit = None;
        let polish = microseconds(|| {
            fit = solve_batch(&exact, &samples, &Start::guess(found.state), &BatchOptions::default()).ok();
        });
        let fit = fit.ok_or("no fit")?;
        let error = fit.states[0] - state::<5>(&self.truth[0]);
        println!(
            "| batch fit from there, {} linearisations of 401 samples | {polish:.0} | {:.2} | {:.1e} |",
            fit.iterations,
            polish / (401 * fit.iterations) as f64,
            1e3 * error[0].hypot(error[1])
        );
        Ok(())
    }
}

/// From samples to what drives the flow: a whole log at once, and as samples come.
fn inputs(log: &PlanarLog, force: f64) -> Result<(), Box<dyn Error>> {
    let samples = log.samples();
    let mut failure = None;
    let whole = microseconds(|| failure = black_box(planar_samples(log, force)).err());
    let coming = microseconds(|| {
        let mut builder = InputBuilder::new().with_force_deviation(force);
        let mut last = 0.0;
        let taken = samples.iter().try_for_each(|s| builder.push(s, |input| last = input.t));
        black_box(last);
        failure = failure.or(taken.err());
    });
    if let Some(error) = failure {
        return Err(error.into());
    }
    let count = samples.len();
    for (what, time) in
        [("of a whole log", whole), ("as samples come, with revision of the last ones", coming)]
    {
        println!("| inputs {what}, {count} samples | {time:.0} | {:.2} | |", time / count as f64);
    }
    Ok(())
}

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let shape = FourierBody::new(&[0.04, 0.003, 0.0045, 0.0006], &[0.0, -0.002, 0.001, -0.0008])?;
    let object = PlanarObject { shape, mass: PlanarMass::from_gyration(0.2, 0.000_729)?, gravity: 9.81 };
    let motion = ConstantRates { angles: [45_f64.to_radians(), 90_f64.to_radians()], rates: [0.2, 0.0] };
    let times: Vec<f64> = (0..=400).map(|k| f64::from(k) / 1000.0).collect();
    let start = PlanarStart { phi0: 5.85, omega0: 6.0 };
    let run = simulate_prescribed(&object, &motion, start, &times, 1e-13)?;
    println!("# Cost of the planar observers\n");
    println!(
        "Made by `cargo xtask study planar_costs`: 50 mm object, 1 kHz, noise of 0.1 mm and 0.2 % of the"
    );
    println!(
        "weight where it says noise; mean of the fastest third of {REPEATS} repetitions on one core of a shared machine."
    );
    println!(
        "To compare: a prototype on plain arrays, without covariance and report, took 0.14 us an evaluation of the forward dynamics and"
    );
    println!("0.36 us a sample, 75 us a Newton step of 200 samples and 5 states.\n");
    println!("| work | us | us a sample | error of the centre of mass, mm |");
    println!("|---|---|---|---|");
    let palms = motion.at(0.0)?;
    let evaluation = microseconds(|| {
        for k in 0..1000_u32 {
            black_box(object.reaction(black_box(&palms), 5.85 + 1e-3 * f64::from(k), 6.0));
        }
    });
    println!(
        "| 1000 evaluations of the forward dynamics (3 harmonics) | {evaluation:.0} | {:.3} | |",
        evaluation / 1000.0
    );
    let simulation = microseconds(|| {
        black_box(simulate_prescribed(&object, &motion, start, &times, 1e-10).ok());
    });
    println!(
        "| simulation of 0.4 s with events, 401 samples, tolerance 1e-10 | {simulation:.0} | {:.2} | |",
        simulation / 401.0
    );
    let clean = run.log()?;
    let truth = clean.truth().ok_or("no truth")?.to_vec();
    let check = PairContact::new(&object.shape, &palms.pair, start.phi0);
    assert!((check.p_WCm - truth[0].p_WCm).length() < 1e-12);
    for (contact, force) in [(0.0, 0.0), (1e-4, 0.002 * 0.2 * 9.81)] {
        let nominal = PlanarNominal {
            mass: object.mass,
            gravity: 9.81,
            contact_deviation: contact,
            force_deviation: force,
        };
        let log = PlanarNoise { contact, force, torque: 0.0 }.add_to(&clean, 1);
        let scale = NaturalScale::from_sample(&clean.samples()[0], 9.81)?;
        inputs(&log, force)?;
        let setting = Setting { nominal, scale, inputs: planar_samples(&log, force)?, truth: truth.clone() };
        let kind = if contact > 0.0 {
            "with noise (process noise estimated)"
        } else {
            "exact data (single shooting)"
        };
        setting.newton::<5>(&[], &format!("Newton step and report, 200 samples, 5 states, {kind}"))?;
        let list = [
            Constant::Mass,
            Constant::Inertia,
            Constant::ForceBias(Side::First),
            Constant::ForceBias(Side::Second),
        ];
        setting.newton::<9>(&list, &format!("Newton step and report, 200 samples, 9 states, {kind}"))?;
        setting.filter(&format!("extended Kalman filter, 200 samples, 5 states, {kind}"))?;
        setting.starts()?;
    }
    Ok(())
}
