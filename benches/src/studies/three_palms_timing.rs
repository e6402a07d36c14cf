//! Three palms from no guess: time beside error, and beside a least-squares peer in SciPy that is given a start nearby.
//!
//! Usage: `three_palms_timing [REPEATS]` (20 by default). Reads the MuJoCo log `mj_A_fig5.csv` where the shared logs are, and
//! simulates the same scene without error. Needs Python with SciPy for the peer's columns; they stay empty without. Prints a
//! page in Markdown.

use cpu_time::ThreadTime;
use glam::{DMat3, DQuat, DVec3};
use recon::object_dynamics::{ContactLog, MassProperties, SensorLog};
use recon::observer::contacts::{ContactEstimate, ContactNoiseLevel, ContactOptions, estimate_contacts};
use recon_tests::{Random, exact_log, fig5};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Length of the logs, s.
const DURATION: f64 = 1.5;
/// Starts nearby, and how far off they are: m, m/s, rad/s and rad, and shares of mass and inertia.
const STARTS: usize = 5;
const OFF: f64 = 0.05;
/// Samples for one that is used.
const STRIDES: [usize; 3] = [1, 4, 10];
/// Timed runs of the peer for each start.
const PEER_REPEATS: usize = 2;

type Failure = Box<dyn std::error::Error>;

/// A scene's log with its truth.
struct Case {
    name: &'static str,
    log: SensorLog,
    mass: MassProperties,
    gravity: DVec3,
}

/// A start nearby: motion, and mass and inertia.
struct Near {
    p_WCm: DVec3,
    v_WCm: DVec3,
    R_WO: DQuat,
    w_WO: DVec3,
    mass: MassProperties,
}

/// Largest errors over a log.
#[derive(Clone, Copy, Default)]
struct Errors {
    position: f64,
    velocity: f64,
    turning: f64,
    mass: f64,
}

impl Errors {
    fn of(found: &ContactEstimate, case: &Case, log: &SensorLog) -> Self {
        let mut errors = Self::default();
        for (state, truth) in found.states.iter().zip(log.truth().unwrap_or_default()) {
            errors.position = errors.position.max(state.p_WCm.distance(truth.p_WCm));
            errors.velocity = errors.velocity.max(state.v_WCm.distance(truth.v_WCm));
            errors.turning = errors.turning.max(state.w_WO.distance(truth.w_WO));
        }
        // Of a known body it is given.
        errors.mass =
            if found.axes_deviations.is_some() { 0.0 } else { (found.mass / case.mass.mass() - 1.0).abs() };
        errors
    }

    fn max(self, other: Self) -> Self {
        Self {
            position: self.position.max(other.position),
            velocity: self.velocity.max(other.velocity),
            turning: self.turning.max(other.turning),
            mass: self.mass.max(other.mass),
        }
    }

    fn columns(&self) -> String {
        let mass = if self.mass > 0.0 { format!("{:.1e}", self.mass) } else { String::new() };
        format!("{:.2e} | {:.2e} | {:.2e} | {mass} |", self.position, self.velocity, self.turning)
    }
}

pub(crate) fn main() -> Result<(), Failure> {
    let repeats: usize = crate::words().next().map_or(Ok(20), |a| a.parse())?;
    let cases = cases()?;
    println!("# Three palms: time beside error\n\nMade by `cargo xtask study three_palms_timing`.\n");
    println!(
        "The first {DURATION} s, at 1 kHz, of the paper's Fig. 5 (ellipsoid of semi-axes 2.5, 2, 1 m, 1 kg). Times are thread \
         time, the fastest of {repeats} runs (SciPy: of {PEER_REPEATS}), all in one run on a shared machine. Errors are the \
         largest over the log, against the simulator's own truth."
    );
    if cases.len() == 1 {
        println!("The MuJoCo log was not there: only the exact simulation was measured.");
    }
    times(&cases, repeats)?;
    notes();
    Ok(())
}

fn cases() -> Result<Vec<Case>, Failure> {
    let (scene, start) = fig5(9.81);
    let (mass, gravity) = (*scene.mass(), scene.gravity());
    let mut cases = Vec::new();
    let path = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../shared/logs/mj_A_fig5.csv"));
    if path.exists() {
        let log = part(&recon_io::read_log(&path)?, 1)?;
        cases.push(Case { name: "MuJoCo", log, mass, gravity });
    }
    let (simulation, _) = exact_log(&scene, start, DURATION, 1000.0);
    let log = part(&simulation.sensor_log(&scene)?, 1)?;
    cases.push(Case { name: "exact", log, mass, gravity });
    Ok(cases)
}

/// Every `stride`-th sample of the first seconds.
fn part(log: &SensorLog, stride: usize) -> Result<SensorLog, Failure> {
    let picked = || (0..log.samples().len()).step_by(stride).filter(|&k| log.samples()[k].t <= DURATION);
    let samples = picked().map(|k| log.samples()[k]).collect();
    let truth = log.truth().map(|truth| picked().map(|k| truth[k]).collect());
    Ok(SensorLog::new(samples, truth)?)
}

fn times(cases: &[Case], repeats: usize) -> Result<(), Failure> {
    println!(
        "\nOurs is the whole estimator, from a log to motion, covariances and evidence, from no guess. The peer's is the least-squares solve \
         alone, its integrals made before, the mean over {STARTS} starts of which each number of the motion is up to {OFF} (m, m/s, rad/s, rad) \
         off, and mass and inertia up to {} %.\n",
        100.0 * OFF
    );
    println!(
        "| log | mass and inertia | Hz | by | ms | times ours | position m | velocity m/s | angular velocity rad/s | mass |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|");
    let folder = std::env::temp_dir().join(format!("three-palms-timing-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    for case in cases {
        for known in [true, false] {
            for stride in STRIDES {
                beside(case, known, stride, repeats, &folder)?;
            }
        }
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

fn beside(case: &Case, known: bool, stride: usize, repeats: usize, folder: &Path) -> Result<(), Failure> {
    let log = part(&case.log, stride)?;
    let contacts = ContactLog::try_from(&log.clone().split_truth().0)?;
    let gravity = case.gravity.length();
    let noise = ContactNoiseLevel::guessed(&contacts, gravity, None).ok_or("nothing is touched")?;
    let body = known.then_some(case.mass);
    let options = ContactOptions { friction: Some(0.0), body, ..ContactOptions::new(noise, gravity) };
    let errors = Errors::of(&estimate_contacts(&contacts, None, &options)?, case, &log);
    let ours = fastest(repeats, || estimate_contacts(&contacts, None, &options));
    let body = if known { "known" } else { "unknown" };
    let place = format!("| {} | {body} | {} |", case.name, 1000 / stride);
    println!("{place} ours | {ours:.1} | 1 | {}", errors.columns());
    if let Some((ms, errors)) = peer(&log, &starts(case)?, known, folder)? {
        println!("{place} SciPy | {ms:.0} | {:.0} | {}", ms / ours, errors.columns());
    }
    Ok(())
}

/// Starts that are off by random amounts. The body's axes stand along the world's at the start of these logs.
fn starts(case: &Case) -> Result<Vec<Near>, Failure> {
    let truth = case.log.truth().and_then(|t| t.first()).ok_or("the log has no truth")?;
    let mut random = Random::new(1);
    let one = |_| {
        let mut off = || random.vector(-OFF, OFF);
        let (p_WCm, v_WCm) = (truth.p_WCm + off(), truth.v_WCm + off());
        let R_WO = DQuat::from_scaled_axis(off()) * truth.R_WO;
        let w_WO = truth.w_WO + off();
        let (diagonal, cross, mass) = (off(), off(), off().x);
        let change = DMat3::from_cols(
            DVec3::new(diagonal.x, cross.x, cross.y),
            DVec3::new(cross.x, diagonal.y, cross.z),
            DVec3::new(cross.y, cross.z, diagonal.z),
        );
        let mass = MassProperties::new(case.mass.mass() * (1.0 + mass), case.mass.inertia() + change)?;
        Ok(Near { p_WCm, v_WCm, R_WO, w_WO, mass })
    };
    (0..STARTS).map(one).collect()
}

/// Mean time in ms and largest errors of the peer; none where it is absent or fails.
fn peer(
    log: &SensorLog,
    starts: &[Near],
    known: bool,
    folder: &Path,
) -> Result<Option<(f64, Errors)>, Failure> {
    let (data, list) = (folder.join("log.csv"), folder.join("starts.txt"));
    recon_io::write_log(log, std::fs::File::create(&data)?)?;
    let mut lines = String::new();
    for Near { p_WCm, v_WCm, R_WO, w_WO, mass } in starts {
        let mut numbers: Vec<f64> = [*p_WCm, *v_WCm, *w_WO].iter().flat_map(|v| v.to_array()).collect();
        let inertia = mass.inertia();
        if known {
            // The true body: only the motion is off.
            numbers.extend(R_WO.to_scaled_axis().to_array());
            numbers.extend([1.0, 1.0, 1.45, 2.05]);
        } else {
            let (x, y, z) = (inertia.x_axis, inertia.y_axis, inertia.z_axis);
            numbers.extend([mass.mass(), x.x, x.y, x.z, y.y, y.z, z.z]);
        }
        let numbers: Vec<String> = numbers.iter().map(f64::to_string).collect();
        writeln!(lines, "{} {}", if known { "known" } else { "unknown" }, numbers.join(" "))?;
    }
    std::fs::write(&list, lines)?;
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/three_palms_scipy.py");
    let mut command = Command::new("python3");
    command.arg(script).arg(&data).arg(&list).arg(PEER_REPEATS.to_string());
    command.env("OMP_NUM_THREADS", "1").env("OPENBLAS_NUM_THREADS", "1");
    let Ok(output) = command.output() else { return Ok(None) };
    if !output.status.success() {
        eprintln!("no peer: {}", String::from_utf8_lossy(&output.stderr).lines().last().unwrap_or_default());
        return Ok(None);
    }
    let (mut total, mut errors) = (0.0, Errors::default());
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let numbers: Vec<f64> = line.split_whitespace().map(str::parse).collect::<Result<_, _>>()?;
        let [ms, position, velocity, turning, mass] = numbers[..] else { return Ok(None) };
        total += ms / starts.len() as f64;
        errors = errors.max(Errors { position, velocity, turning, mass });
    }
    Ok(Some((total, errors)))
}

/// Thread time of the fastest of some runs, ms.
fn fastest<T>(repeats: usize, mut work: impl FnMut() -> T) -> f64 {
    let one = |_| {
        let start = ThreadTime::now();
        std::hint::black_box(work());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..repeats).map(one).fold(f64::INFINITY, f64::min)
}

fn notes() {
    println!(
        "\n## Beside it

SciPy: `benches/peers/three_palms_scipy.py`, contact conditions along the motion that the measured forces and a start make, `least_squares` with central differences, the perturbed
motions of all columns integrated side by side in NumPy arrays. A peer with derivatives by CasADi, measured elsewhere on the
MuJoCo log: 130 to 420 ms a solve with known inertia and 800 to 2500 ms with unknown, from no guess several of them (10 of 10 to
3 of 10 random starts arrive with known inertia, 3 of 6 to 1 of 6 with unknown); 9e-7 m and 3e-6 rad/s.

On the exact log errors are those of rounding; what is left on the MuJoCo log is the log's own departure from rigid contact: its
forces, integrated from its own true start, miss its own velocities by up to 2.6e-6 m/s and its positions by 1.5e-6 m, and its true
motion leaves 9e-7 m/s of the contact conditions."
    );
}
