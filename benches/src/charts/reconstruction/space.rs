//! The paper's Fig. 5 motion, for the estimator that needs no guess and for the paper's own integration from exact initial conditions.

use super::super::shared::{centre_error, estimate, exact_log, noisy_estimate};
use super::super::{Chart, Drawn};
use super::{DRAWS, Sweep};
use crate::bound::Scales;
use crate::bound::space::least_place;
use crate::{Axis, Budget, Method, Study, WorkPrecision};
use recon::contact_kinematics::Ellipsoid;
use recon::object_dynamics::{SensorLog, SensorNoise, Simulation, ThreePalmScene};
use recon::observer::three_palms::Track;
use recon::observer::three_palms::paper_method::{
    PaperMethod, PaperStart, PredictorCorrector, integrate_paper_system,
};

pub(in super::super) const BY_WINDOW: Chart = Chart {
    name: "reconstruction-by-window",
    about: "error and time of the estimator over the length of the log, exact and noisy",
    draw: by_window,
};
pub(in super::super) const BY_RATE: Chart = Chart {
    name: "reconstruction-by-rate",
    about: "estimator and the paper's integration over the sample rate, exact and noisy",
    draw: by_rate,
};
pub(in super::super) const BY_NOISE: Chart = Chart {
    name: "reconstruction-by-noise",
    about: "error and time of the estimator over the noise, of a known body and an unknown",
    draw: by_noise,
};

/// MuJoCo's log of the same scene, every tenth sample; the same result as from all of them.
const MUJOCO: &str = include_str!("../../../../tests/data/mj_A_fig5_thinned.csv");

/// Size of the body, m, and what a palm carries, N: noise of contacts is a share of the first, of forces of the second.
const SIZE: f64 = 2.5;
const LOAD: f64 = 6.5;
/// Length of a log where that does not change, s.
const LASTS: f64 = 4.2;
/// What conditions are off by beside noise, m/s.
const FLOOR: f64 = 1e-6;
/// Noise of a contact, and ten times of a force.
const LITTLE: f64 = 1e-3;

/// A scene with an exact log, and noise that it is drawn with.
struct Noisy<'a> {
    scene: &'a ThreePalmScene<Ellipsoid>,
    simulation: &'a Simulation,
    log: &'a SensorLog,
}

impl Noisy<'_> {
    /// At a noise of contacts and forces, as shares, of a known body or an unknown.
    fn add(
        &self,
        sweep: &mut Sweep,
        setting: String,
        [contact, force]: [f64; 2],
        known: bool,
        budget: Budget,
    ) {
        let noise = SensorNoise { contact: contact * SIZE, force: force * LOAD, torque: 0.0 };
        let scales = Scales { length: SIZE, time: (SIZE / self.scene.gravity().length()).sqrt() };
        let least = least_place(&self.simulation.instants, *self.scene.mass(), known, noise, scales);
        sweep.at(setting, budget.of(DRAWS), least, |seed| {
            let log = self.log.with_noise(&noise, seed).ok()?;
            let found = noisy_estimate(self.scene, &log, &noise, known, FLOOR).ok()?;
            let relied = found.reliability.is_reliable() && found.relied_on.last() == Some(&true);
            let (last, truth) = (found.states.last()?, self.simulation.instants.last()?);
            relied.then(|| last.p_WCm.distance_squared(truth.touch.p_WCm))
        });
    }
}

fn by_window(budget: Budget) -> Drawn {
    let (scene, start) = recon_tests::fig5(9.81);
    let durations = [1.0, 1.5, 2.0, 3.0, 4.2];
    let logs = durations.map(|duration| exact_log(&scene, start, duration, 1000.0));
    let logs = logs.into_iter().collect::<Result<Vec<_>, _>>()?;
    let method = PaperMethod { scheme: PredictorCorrector::Adams4, enforce_constraint: false };
    let foreign = recon_io::parse_log(MUJOCO.as_bytes())?;
    let truth = foreign.truth().ok_or("MuJoCo's log has no truth columns")?.to_vec();
    let mut study = Study::new();
    for ((simulation, log), duration) in logs.iter().zip(durations) {
        let run = || estimate(&scene, log);
        study
            .fallible_case("no noise", format!("{duration} s"), run, |found| centre_error(found, simulation));
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
    for (name, noise) in [("0.1 % and 1 % noise", [LITTLE, 1e-2]), ("1 % and 1 % noise", [1e-2, 1e-2])] {
        let mut sweep = Sweep::new(name);
        for ((simulation, log), duration) in logs.iter().zip(durations) {
            let of = Noisy { scene: &scene, simulation, log };
            of.add(&mut sweep, format!("{duration} s"), noise, true, budget);
        }
        methods.extend(sweep.methods());
    }
    let chart =
        WorkPrecision::new("reconstruction-by-window", "Motion from a log, no guess: cost against error")
            .subtitle(
                "Fig. 5 scene at 1 kHz, mass and inertia known; points: length of the log; without noise the largest error, with noise the root mean square of forty draws at the last sample",
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
        rates.map(|rate| exact_log(&scene, start, LASTS, rate)).into_iter().collect::<Result<Vec<_>, _>>()?;
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
    let mut methods = study.measure(budget, 1.0);
    let mut sweep = Sweep::new("0.1 % and 1 % noise");
    for ((simulation, log), rate) in logs.iter().zip(rates) {
        let of = Noisy { scene: &scene, simulation, log };
        of.add(&mut sweep, format!("{rate} Hz"), [LITTLE, 1e-2], true, budget);
    }
    methods.extend(sweep.methods());
    let chart = WorkPrecision::new("reconstruction-by-rate", "Reconstruction over the sample rate: cost against error")
        .subtitle("Fig. 5 scene, 4.2 s, mass and inertia known; the integrations are given the exact initial state and no noise, the estimator nothing; with noise as by window")
        .axes(Axis::log("error of the centre of mass", "m"), Axis::log("cost", "ms a log"))
        .methods(methods);
    Ok(vec![chart.into()])
}

fn by_noise(budget: Budget) -> Drawn {
    let (scene, start) = recon_tests::fig5(9.81);
    let (simulation, log) = exact_log(&scene, start, LASTS, 500.0)?;
    let of = Noisy { scene: &scene, simulation: &simulation, log: &log };
    let mut chart = WorkPrecision::new("reconstruction-by-noise", "Reconstruction over the noise: cost against error")
        .subtitle("Fig. 5 scene, 4.2 s at 500 Hz; points: noise of contacts over the size, of forces ten times that; root mean square of forty draws at the last sample")
        .axes(Axis::log("error of the centre of mass", "m"), Axis::log("cost", "ms a log"));
    for (name, known) in [("known body", true), ("unknown body", false)] {
        let mut sweep = Sweep::new(name);
        for share in [1e-5, 1e-4, 3e-4, 1e-3, 3e-3, 1e-2] {
            let setting = format!("{} %", 100.0 * share);
            of.add(&mut sweep, setting, [share, 10.0 * share], known, budget);
        }
        chart = chart.methods(sweep.methods());
    }
    Ok(vec![chart.into()])
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
