//! Reconstruction of the paper's Fig. 5 motion: cost against error by length of log and by sample rate, for the
//! estimator that needs no guess and for the paper's own integration from exact initial conditions.

use super::shared::{FLOOR, centre_error, estimate, exact_log, noisy_estimate};
use super::{Chart, Drawn};
use crate::{Axis, Budget, Method, Outcome, Study, WorkPrecision};
use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::{SensorLog, SensorNoise, Simulation, ThreePalmScene};
use recon::observer::{
    ContactEstimate, PaperMethod, PaperStart, PredictorCorrector, Track, integrate_paper_system,
};

pub(super) const BY_WINDOW: Chart = Chart {
    name: "reconstruction-by-window",
    about: "error and time of the estimator over the length of the log, exact and noisy",
    draw: by_window,
};
pub(super) const BY_RATE: Chart = Chart {
    name: "reconstruction-by-rate",
    about: "estimator and the paper's integration over the sample rate",
    draw: by_rate,
};

/// MuJoCo's log of the same scene, every tenth sample; the same result as from all of them.
const MUJOCO: &str = include_str!("../../../tests/data/mj_A_fig5_thinned.csv");

/// Noise of the contact coordinates as a share of the body's size, of the forces as a share of what a palm carries.
const SIZE: f64 = 2.5;
const LOAD: f64 = 6.5;
/// Draws of the noise.
const NOISES: u64 = 40;
/// Factor by which the noise is made small where the bound is taken.
const SMALL: f64 = 0.01;

fn by_window(budget: Budget) -> Drawn {
    let (scene, start) = recon_tests::fig5(9.81);
    let durations = [1.0, 1.5, 2.0, 3.0, 4.2];
    let logs = durations.map(|duration| exact_log(&scene, start, duration, 1000.0));
    let logs = logs.into_iter().collect::<Result<Vec<_>, _>>()?;
    let noises = [("0.1 % and 1 % noise", 1e-3, 1e-2), ("1 % and 1 % noise", 1e-2, 1e-2)];
    let mut noisy: Vec<(&str, f64, Vec<SensorLog>, &Simulation, SensorNoise)> = Vec::new();
    let mut bounds = noises.map(|(name, ..)| (name, Vec::new()));
    for ((simulation, log), duration) in logs.iter().zip(durations) {
        for ((name, contact, force), (_, bounds)) in noises.into_iter().zip(&mut bounds) {
            let noise = SensorNoise { contact: contact * SIZE, force: force * LOAD, torque: 0.0 };
            let all = (1..=NOISES).map(|seed| log.with_noise(&noise, seed)).collect::<Result<Vec<_>, _>>()?;
            noisy.push((name, duration, all, simulation, noise));
            bounds.push(least_deviation(&scene, log, &noise)?);
        }
    }
    let method = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
    let foreign = recon_io::parse_log(MUJOCO.as_bytes())?;
    let truth = foreign.truth().ok_or("MuJoCo's log has no truth columns")?.to_vec();
    let mut study = Study::new();
    for ((simulation, log), duration) in logs.iter().zip(durations) {
        let run = || estimate(&scene, log);
        study
            .fallible_case("no noise", format!("{duration} s"), run, |found| centre_error(found, simulation));
    }
    for (name, duration, logs, simulation, noise) in &noisy {
        let run = || noisy_estimate(&scene, &logs[0], noise, FLOOR);
        let others = logs[1..].iter().filter_map(|log| noisy_estimate(&scene, log, noise, FLOOR).ok());
        let others: Vec<f64> = others.map(|found| mean_square(&found, simulation)).collect();
        study.fallible_case(*name, format!("{duration} s"), run, |found| {
            let sum = mean_square(found, simulation) + others.iter().sum::<f64>();
            (sum / (1 + others.len()) as f64).sqrt()
        });
    }
    for ((simulation, log), duration) in logs.iter().zip(durations) {
        let run = || integrate(&scene, log, simulation, method);
        study.fallible_case("(35)-(37), Adams, exact start", format!("{duration} s"), run, |error| *error);
    }
    study.fallible_case(
        "MuJoCo's log at 100 Hz",
        "4.2 s",
        || estimate(&scene, &foreign),
        |found| found.states.iter().zip(&truth).map(|(m, t)| m.p_WCm.distance(t.p_WCm)).fold(0.0, f64::max),
    );
    let mut methods = study.measure(budget, 1.0);
    for (name, bounds) in bounds {
        let bound = methods.iter().find(|method| method.name() == name).map(|of| bound_line(of, &bounds));
        methods.extend(bound);
    }
    let chart =
        WorkPrecision::new("reconstruction-by-window", "Motion from a log, no guess: cost against error")
            .subtitle(
                "Fig. 5 scene at 1 kHz, mass and inertia known; points: length of the log; with noise the root mean square of forty draws, and the least that is possible at the same cost",
            )
            .axes(Axis::log("error of the centre of mass", "m"), Axis::log("cost", "ms a log"))
            .methods(methods)
            .method(
                Method::recorded("SciPy with CasADi, MuJoCo's log", "best of ten starts at 0.2 s each")
                    .point("4.2 s", 9e-7, 200.0),
            );
    Ok(vec![chart.into()])
}

fn by_rate(budget: Budget) -> Drawn {
    let (scene, start) = recon_tests::fig5(9.81);
    let rates = [25.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
    let logs =
        rates.map(|rate| exact_log(&scene, start, 4.2, rate)).into_iter().collect::<Result<Vec<_>, _>>()?;
    let mut study = Study::new();
    for ((simulation, log), rate) in logs.iter().zip(rates) {
        let setting = format!("{rate} Hz");
        let scene = &scene;
        study.fallible_case(
            "from contacts, no guess",
            setting.clone(),
            move || estimate(scene, log),
            move |found| centre_error(found, simulation),
        );
        for (name, scheme, enforce_constraint) in [
            ("(35)-(37), Heun", PredictorCorrector::Heun, false),
            ("(35)-(37), Adams", PredictorCorrector::Adams4, false),
            ("(35)-(37), Adams, held on (24)", PredictorCorrector::Adams4, true),
        ] {
            let method = PaperMethod { scheme, enforce_constraint };
            let run = move || integrate(scene, log, simulation, method);
            study.fallible_case(name, setting.clone(), run, move |error: &f64| *error);
        }
    }
    let chart = WorkPrecision::new("reconstruction-by-rate", "Reconstruction over the sample rate: cost against error")
        .subtitle("Fig. 5 scene, 4.2 s without noise; the integrations are given the exact initial state, the estimator nothing")
        .axes(Axis::log("largest error of the centre of mass", "m"), Axis::log("cost", "ms a log"))
        .methods(study.measure(budget, 1.0));
    Ok(vec![chart.into()])
}

/// The Cramér-Rao bound beside the points of a method: no unbiased estimator is to the left of it.
fn bound_line(of: &Method, bounds: &[f64]) -> Method {
    let line = Method::new(format!("Cramér-Rao bound, {}", of.name()));
    of.points().iter().zip(bounds).fold(line, |line, (point, bound)| match point.outcome {
        Outcome::Measured { cost, .. } => line.point(point.setting.clone(), *bound, cost),
        Outcome::Failed { .. } => line,
    })
}

/// Least possible root mean square of the centre's error over a log, m: that of the model linearised where noise is next to nothing.
fn least_deviation(
    scene: &ThreePalmScene<Ellipsoid>,
    log: &SensorLog,
    noise: &SensorNoise,
) -> Result<f64, Box<dyn std::error::Error + Send + Sync>> {
    let small = SensorNoise { contact: SMALL * noise.contact, force: SMALL * noise.force, torque: 0.0 };
    let found = noisy_estimate(scene, &log.with_noise(&small, 1)?, &small, SMALL * SMALL * FLOOR)?;
    let squares: f64 = found.deviations.iter().map(|of| of[0].length_squared()).sum();
    Ok((squares / found.deviations.len() as f64).sqrt() / SMALL)
}

/// Of the centre's error over a log, m^2.
fn mean_square(found: &ContactEstimate, simulation: &Simulation) -> f64 {
    let pairs = found.states.iter().zip(&simulation.instants);
    let sum: f64 = pairs.map(|(state, now)| state.p_WCm.distance_squared(now.touch.p_WCm)).sum();
    sum / found.states.len() as f64
}

/// Largest error of the centre of mass by the paper's integration from the exact start; the time includes the
/// sensitivities that it reports, nine runs more.
fn integrate(
    scene: &ThreePalmScene<Ellipsoid>,
    log: &SensorLog,
    simulation: &Simulation,
    method: PaperMethod,
) -> Result<f64, String> {
    let track = Track::new(log, scene.gravity(), None).map_err(|e| e.to_string())?;
    let now = &simulation.instants[0];
    let start = PaperStart { radii: now.touch.contacts.map(|c| c.jet.value), R_WO: now.R_WO, w_WO: now.w_WO };
    let found = integrate_paper_system(&track, scene.mass(), &start, method).map_err(|e| e.to_string())?;
    if let Some(t) = found.diverged_at {
        return Err(format!("diverged at {t} s"));
    }
    let pairs = found.motion.iter().zip(&simulation.instants);
    Ok(pairs.map(|(m, now)| m.p_WCm.distance(now.touch.p_WCm)).fold(0.0, f64::max))
}
