//! The motion sample by sample over a minute at 1 kHz: time per sample, its quantiles and its course, beside the errors; and
//! over many shorter logs, for what the covariance is worth.

use cpu_time::ThreadTime;
use glam::{DQuat, DVec3};
use nalgebra::SVector;
use recon::contact_kinematics::{Ellipsoid, MotionLaw, Palm};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, Instant, MassProperties, SampleTimes, SensorLog, SensorNoise, ThreePalmScene,
};
use recon::observer::{MotionStream, NoiseLevel, StreamEstimate, StreamOptions, StreamStage};
use recon_tests::Random;

/// Samples a second, and length of the log in s.
const RATE: f64 = 1000.0;
const DURATION: f64 = 60.0;
/// Noise: 0.1 % of the size, 1 % of what a palm carries.
const NOISE: NoiseLevel = NoiseLevel { contact: 2.4e-3, force: 0.065 };
/// Parts in which the course of the time is told.
const PARTS: usize = 6;
/// Runs of the minute: of each sample the fastest counts, so that what else the machine does is not counted.
const REPEATS: usize = 3;
/// Logs whose errors are told, and their length in s.
const LOGS: usize = 20;
const RANDOM_LOGS: usize = 40;
/// Scenes that are tried for them: some lose contact too soon, and in some the body cannot stand.
const TRIED: u64 = 400;
const SHORT: f64 = 20.0;
/// Chi-squared of six numbers that one in a thousand exceeds.
const RARE: f64 = 22.46;

type Failure = Box<dyn std::error::Error>;
type Scene = ThreePalmScene<Ellipsoid>;

pub(crate) fn main() -> Result<(), Failure> {
    let axes = DVec3::new(1.6, 2.0, 2.4);
    let minute = minute(axes)?;
    println!("# Streaming\n\nMade by `cargo xtask study streaming`.\n");
    println!(
        "An ellipsoid (semi-axes 1.6, 2.0, 2.4 m, 1.3 kg) on three palms that swing by 0.04 rad, {} samples at 1 kHz,",
        minute.log.samples().len()
    );
    println!(
        "with noise of 0.1 % of the size on contacts and 1 % on forces; on one core, from no guess. Times are the"
    );
    println!("thread's own, of each sample the fastest of {REPEATS} runs.\n");
    let runs = [("known", true), ("unknown", false)].map(|(name, known)| (name, run(&minute, known)));
    let mut all = Vec::new();
    for (name, run) in runs {
        all.push((name, run?));
    }
    times(&all);
    courses(&all);
    println!(
        "\nErrors (root mean square) and what the covariance says, over all samples for which a motion is stated;"
    );
    println!(
        "contradicted: share of these that the innovations speak against. Mass (with its deviation) and moments at the"
    );
    println!("end.\n");
    println!("| body | position m | said | velocity m/s | said | mass | inertia | NEES / 6 | contradicted |");
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, run) in &all {
        let errors = Errors::of(&minute, &run.estimates);
        println!(
            "| {name} |{} {} {:.2} | {:.3} |",
            errors.sizes(),
            body(&minute, run),
            errors.mean(),
            errors.contradicted()
        );
    }
    println!("\n## Many logs\n");
    println!(
        "Normalised squared errors of position and velocity (NEES / 6: one where the covariance is true) over all samples"
    );
    println!(
        "for which a motion is stated, from the first one on. The same body, spins of up to 0.1 rad/s about each axis and"
    );
    println!(
        "other swings of the palms; and random ellipsoids of 1 to 2.5 m, spins of up to 0.6 rad/s, palms that swing by 0.05"
    );
    println!(
        "rad. Logs of {SHORT} s, or up to the loss of contact if that comes after 6 s. Rare: share of samples beyond the 99.9 %"
    );
    println!("quantile of chi-squared, 0.001 where the errors are Gaussian.\n");
    println!(
        "| scenes | body | logs | with a motion | NEES / 6 | of a log: median, largest | rare | contradicted | first motion after: median, largest |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    many("near rest", LOGS, |seed| near_rest(axes, seed))?;
    many("random", RANDOM_LOGS, random)?;
    Ok(())
}

/// A scene with its motion and its noisy log.
struct Case {
    scene: Scene,
    truth: Vec<Instant>,
    log: SensorLog,
}

struct Run {
    microseconds: Vec<f64>,
    /// With the index of the sample that each belongs to.
    estimates: Vec<(usize, StreamEstimate)>,
}

impl Case {
    /// None where contact is lost within `shortest` seconds.
    fn new(
        axes: DVec3,
        palms: [Palm; 3],
        start: InitialMotion,
        duration: f64,
        shortest: f64,
        seed: u64,
    ) -> Result<Option<Self>, Failure> {
        let mass = MassProperties::uniform_ellipsoid(1.3, axes)?;
        let scene = ThreePalmScene::new(Ellipsoid::new(axes)?, mass, palms, 9.81)?;
        let times = SampleTimes { duration, rate: RATE };
        let run = scene.simulate(start, times, Tolerance::uniform(1e-11))?;
        let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force, torque: 0.0 };
        let log = run.sensor_log(&scene)?.split_truth().0.with_noise(&noise, seed)?;
        Ok((log.duration() >= shortest).then_some(Self { scene, truth: run.instants, log }))
    }

    fn stream(&self, known: bool) -> Result<MotionStream, Failure> {
        Ok(MotionStream::new(StreamOptions {
            mass: known.then_some(*self.scene.mass()),
            gravity: self.scene.gravity(),
            palm_inertias: None,
            noise: NOISE,
            sample_rate: RATE,
        })?)
    }
}

fn swing(azimuth: f64, slope: f64, amplitude: f64, frequency: f64, phase: f64) -> Result<Palm, Failure> {
    Ok(Palm::new(azimuth, MotionLaw::Sinusoid { mean: slope, amplitude, frequency, phase })?)
}

fn minute(axes: DVec3) -> Result<Case, Failure> {
    let palms = [
        swing(0.1, 0.8, 0.04, 1.7, 0.3)?,
        swing(2.2, 0.8, 0.04, 2.1, 1.0)?,
        swing(4.3, 0.8, 0.04, 1.3, 2.0)?,
    ];
    let R_WO = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let start = InitialMotion { R_WO, w_WO: DVec3::new(0.07, -0.05, 0.05) };
    Case::new(axes, palms, start, DURATION, DURATION, 1)?
        .ok_or_else(|| "the minute's scene loses contact".into())
}

fn near_rest(axes: DVec3, seed: u64) -> Result<Option<Case>, Failure> {
    let mut random = Random::new(100 + seed);
    let mut palm = |azimuth, frequency: f64| {
        swing(azimuth, 0.8, 0.04, frequency + random.within(-0.3, 0.3), random.within(-3.0, 3.0))
    };
    let palms = [palm(0.1, 1.7)?, palm(2.2, 2.1)?, palm(4.3, 1.3)?];
    let R_WO = DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let start = InitialMotion { R_WO, w_WO: random.vector(-0.1, 0.1) };
    Case::new(axes, palms, start, SHORT, 6.0, seed)
}

fn random(seed: u64) -> Result<Option<Case>, Failure> {
    let mut random = Random::new(1000 + seed);
    let axes = random.vector(1.0, 2.5);
    let mut palm = |k: u32| {
        let azimuth = f64::from(k) * std::f64::consts::TAU / 3.0 + random.within(-0.3, 0.3);
        swing(azimuth, random.within(0.8, 1.1), 0.05, random.within(1.0, 2.5), random.within(-3.0, 3.0))
    };
    let palms = [palm(0)?, palm(1)?, palm(2)?];
    let start = InitialMotion {
        R_WO: DQuat::from_scaled_axis(random.vector(-3.0, 3.0)),
        w_WO: random.vector(-0.6, 0.6),
    };
    // Where the body cannot stand there is no log.
    Ok(Case::new(axes, palms, start, SHORT, 6.0, seed).unwrap_or_default())
}

fn run(case: &Case, known: bool) -> Result<Run, Failure> {
    let samples = case.log.samples();
    let mut microseconds = vec![f64::INFINITY; samples.len()];
    let mut estimates = Vec::new();
    for _ in 0..REPEATS {
        let mut stream = case.stream(known)?;
        estimates = Vec::with_capacity(samples.len());
        for (k, sample) in samples.iter().enumerate() {
            let clock = ThreadTime::now();
            let estimate = stream.push(sample)?;
            microseconds[k] = microseconds[k].min(1e6 * clock.elapsed().as_secs_f64());
            estimates.extend(estimate.map(|e| (k - 1, e)));
        }
    }
    Ok(Run { microseconds, estimates })
}

fn times(all: &[(&str, Run)]) {
    println!("| body | first motion after | median us | 99 % us | largest us | samples over 1 ms |");
    println!("|---|---|---|---|---|---|");
    for (name, run) in all {
        let first = first(&run.estimates).map_or("never".to_owned(), |t| format!("{t:.2} s"));
        let mut sorted = run.microseconds.clone();
        sorted.sort_by(f64::total_cmp);
        let slow = sorted.iter().filter(|&&us| us > 1000.0).count();
        println!(
            "| {name} | {first} | {:.1} | {:.0} | {:.0} | {slow} |",
            share(&sorted, 0.5),
            share(&sorted, 0.99),
            share(&sorted, 1.0)
        );
    }
}

fn courses(all: &[(&str, Run)]) {
    println!("\nThe course of the time: mean and 99 % (us) in each sixth of the minute.\n");
    println!("| body |{}", (0..PARTS).map(|k| format!(" {} s |", 10 * k)).collect::<String>());
    println!("|---|{}", "---|".repeat(PARTS));
    for (name, run) in all {
        let part = |k: usize| {
            let length = run.microseconds.len() / PARTS;
            let mut part = run.microseconds[k * length..(k + 1) * length].to_vec();
            part.sort_by(f64::total_cmp);
            format!(" {:.1}, {:.0} |", part.iter().sum::<f64>() / length as f64, share(&part, 0.99))
        };
        println!("| {name} |{}", (0..PARTS).map(part).collect::<String>());
    }
}

/// Time of the first motion that is stated, s.
fn first(estimates: &[(usize, StreamEstimate)]) -> Option<f64> {
    estimates.iter().find(|(_, e)| e.stage == StreamStage::Tracking).map(|(_, e)| e.motion.t)
}

/// What came of one kind of body over many logs.
#[derive(Default)]
struct Tally {
    all: Errors,
    /// NEES / 6 of each log, and time of its first motion, s.
    means: Vec<f64>,
    firsts: Vec<f64>,
}

impl Tally {
    fn take(&mut self, case: &Case, known: bool) -> Result<(), Failure> {
        let mut stream = case.stream(known)?;
        let mut estimates = Vec::with_capacity(case.log.samples().len());
        for (k, sample) in case.log.samples().iter().enumerate() {
            estimates.extend(stream.push(sample)?.map(|e| (k - 1, e)));
        }
        let errors = Errors::of(case, &estimates);
        self.firsts.extend(first(&estimates));
        if errors.count > 0 {
            self.means.push(errors.mean());
        }
        self.all.add(&errors);
        Ok(())
    }

    fn row(&mut self) -> String {
        self.means.sort_by(f64::total_cmp);
        self.firsts.sort_by(f64::total_cmp);
        format!(
            " {} | {:.2} | {:.2}, {:.2} | {:.4} | {:.4} | {:.2} s, {:.2} s |",
            self.firsts.len(),
            self.all.mean(),
            share(&self.means, 0.5),
            share(&self.means, 1.0),
            self.all.rare as f64 / self.all.count.max(1) as f64,
            self.all.contradicted(),
            share(&self.firsts, 0.5),
            share(&self.firsts, 1.0)
        )
    }
}

fn many(
    scenes: &str,
    logs: usize,
    case: impl Fn(u64) -> Result<Option<Case>, Failure>,
) -> Result<(), Failure> {
    let mut tallies = [("known", true), ("unknown", false)].map(|kind| (kind, Tally::default()));
    let mut count = 0;
    for seed in 0..TRIED {
        if count == logs {
            break;
        }
        let Some(case) = case(seed)? else { continue };
        count += 1;
        for ((_, known), tally) in &mut tallies {
            tally.take(&case, *known)?;
        }
    }
    for ((name, _), tally) in &mut tallies {
        println!("| {scenes} | {name} | {count} |{}", tally.row());
    }
    Ok(())
}

/// Sums over the samples for which a motion is stated.
#[derive(Default)]
struct Errors {
    /// Squares of position, what is said of it, velocity, what is said of it.
    sums: [f64; 4],
    nees: f64,
    count: usize,
    rare: usize,
    against: usize,
}

impl Errors {
    fn of(case: &Case, estimates: &[(usize, StreamEstimate)]) -> Self {
        let mut all = Self::default();
        for (k, estimate) in estimates {
            match estimate.stage {
                StreamStage::Tracking => all.take(&case.truth[*k], estimate),
                StreamStage::Contradicted => all.against += 1,
                StreamStage::Gathering | StreamStage::Searching { .. } => {}
            }
        }
        all
    }

    fn take(&mut self, now: &Instant, estimate: &StreamEstimate) {
        let p = estimate.motion.p_WCm - now.touch.p_WCm;
        let v = estimate.motion.v_WCm - now.rates.v_WCm;
        let variance =
            |block: usize| (3 * block..3 * block + 3).map(|i| estimate.covariance[(i, i)]).sum::<f64>();
        let six = estimate.covariance.fixed_view::<6, 6>(0, 0).into_owned();
        let error = SVector::<f64, 6>::from_fn(|i, _| [p, v][i / 3][i % 3]);
        let square = six.cholesky().map_or(f64::INFINITY, |c| error.dot(&c.solve(&error)));
        let terms = [p.length_squared(), variance(0), v.length_squared(), variance(1)];
        for (sum, term) in self.sums.iter_mut().zip(terms) {
            *sum += term;
        }
        self.nees += square;
        self.count += 1;
        self.rare += usize::from(square > RARE);
    }

    fn add(&mut self, other: &Self) {
        for (sum, term) in self.sums.iter_mut().zip(other.sums) {
            *sum += term;
        }
        self.nees += other.nees;
        self.count += other.count;
        self.rare += other.rare;
        self.against += other.against;
    }

    fn mean(&self) -> f64 {
        self.nees / self.count.max(1) as f64 / 6.0
    }

    fn contradicted(&self) -> f64 {
        self.against as f64 / (self.count + self.against).max(1) as f64
    }

    fn sizes(&self) -> String {
        self.sums.iter().map(|sum| format!(" {:.1e} |", (sum / self.count.max(1) as f64).sqrt())).collect()
    }
}

/// Mass and moments at the end.
fn body(case: &Case, run: &Run) -> String {
    let Some(body) = run.estimates.last().and_then(|(_, e)| e.body) else {
        return "known | known |".to_owned();
    };
    let truth = case.scene.mass();
    let moments = MassProperties::new(body.mass, body.inertia).map_or(DVec3::NAN, |m| m.principal().moments);
    let off = ((moments - truth.principal().moments) / truth.principal().moments).abs().max_element();
    let mass = (body.mass - truth.mass()).abs();
    format!("{mass:.1e} ({:.1e}) kg | {off:.1e} of the moments |", body.mass_deviation)
}

fn share(sorted: &[f64], p: f64) -> f64 {
    sorted.get(((sorted.len() as f64 - 1.0) * p) as usize).copied().unwrap_or(f64::NAN)
}
