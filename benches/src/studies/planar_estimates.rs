//! Motion in the plane from contacts and forces, on bodies and palms drawn at random: relied on, right, and what is noticed of wrong
//! constants. Prints tables in Markdown.
//!
//! `cargo xtask study planar_estimates [BODIES]` writes docs/planar-estimates.md.

use crate::planar_tally::{SILENT, Tally};
use recon::contact_kinematics::planar::{FourierBody, RadiusFunction};
use recon::object_dynamics::planar::*;
use recon::observer::ContactNoiseLevel;
use recon::observer::planar::*;
use recon_tests::Random;
use std::error::Error;
use std::f64::consts::TAU;

type Failure = Box<dyn Error>;

/// Seed of the bodies.
const SEED: u64 = 91_000;
const GRAVITY: f64 = 9.81;
/// Length of a log, natural times.
const LASTS: f64 = 20.0;
/// Floor of contact conditions, natural speeds.
const FLOOR: f64 = 1e-6;

struct Scene {
    object: PlanarObject<FourierBody>,
    palms: HarmonicPalms,
    start: PlanarStart,
    /// Size (m) and natural time (s).
    length: f64,
    time: f64,
}

/// What is wrong with a log or with what is told of it.
#[derive(Clone, Copy)]
enum Wrong {
    Nothing,
    Inertia,
    Mass,
    ForcesLate,
    ContactsLate,
    Gap,
    Palm,
    Gain,
    BothGains,
    Bias,
    Outliers,
}

const FAULTS: [(Wrong, &str); 11] = [
    (Wrong::Nothing, "nothing"),
    (Wrong::Inertia, "inertia 10 %"),
    (Wrong::Mass, "mass and inertia 5 %"),
    (Wrong::ForcesLate, "forces 4 ms late"),
    (Wrong::ContactsLate, "contacts 4 ms late"),
    (Wrong::Gap, "gap of 48 ms"),
    (Wrong::Palm, "angle of a palm 0.5 degrees"),
    (Wrong::Gain, "gain of a palm 1 %"),
    (Wrong::BothGains, "both gains 1 %"),
    (Wrong::Bias, "bias of 1 % of the weight"),
    (Wrong::Outliers, "1 % outliers of contacts"),
];

pub(crate) fn main() -> Result<(), Failure> {
    let bodies: usize = crate::words().next().map_or(Ok(40), |a| a.parse())?;
    println!(
        "# Motion in the plane from contacts and forces\n\nMade by `cargo xtask study planar_estimates {bodies}`.\n"
    );
    println!(
        "{bodies} bodies of 2 to 5 harmonics, 3 cm to 3 m, on two frictionless palms that swing slowly or fast, up to {LASTS} natural times,"
    );
    println!(
        "from no guess; seed {SEED}. After the first run the odds at which a stated body is contradicted were changed, by other seeds. Noise of contacts as a share of the size, of forces 1 % of the weight."
    );
    println!(
        "Relied on: runs without a warning. Silent: of these with an error beyond {SILENT} deviations of some number at some sample. Mean"
    );
    println!(
        "square: of position, velocity and spin in their deviations. Place: median over the runs of the largest error of the centre of mass"
    );
    println!("over the size.\n");
    println!(
        "| rate, Hz | noise | body | runs | relied on | silent | mean square | place | us a sample |\n|---|---|---|---|---|---|---|---|---|"
    );
    let scenes = drawn(bodies)?;
    for rate in [100.0, 250.0, 1000.0] {
        for noise in [1e-3, 1e-2] {
            for known in [true, false] {
                let mut tally = Tally::default();
                for (i, scene) in scenes.iter().enumerate() {
                    scene.run(&mut tally, rate, noise, known, Wrong::Nothing, i as u64)?;
                }
                println!(
                    "| {rate} | {noise} | {} | {} |",
                    if known { "known" } else { "unknown" },
                    tally.told()
                );
            }
        }
    }
    println!("\nWrong constants and broken logs, known body, noise 0.2 % of the size:\n");
    println!(
        "| wrong | rate, Hz | runs | relied on | silent | mean square | place | us a sample |\n|---|---|---|---|---|---|---|---|"
    );
    for (wrong, name) in FAULTS {
        for rate in [100.0, 1000.0] {
            let mut tally = Tally::default();
            for (i, scene) in scenes.iter().enumerate() {
                scene.run(&mut tally, rate, 2e-3, true, wrong, 1000 + i as u64)?;
            }
            println!("| {name} | {rate} | {} |", tally.told());
        }
    }
    Ok(())
}

/// Mean radius of a random outline, m, and the harmonics of its radius function.
pub(crate) fn outline(between: &mut impl FnMut(f64, f64) -> f64) -> (f64, Vec<f64>, Vec<f64>) {
    let length = 0.03 * 100_f64.powf(between(0.0, 1.0));
    let harmonics = 2 + between(0.0, 4.0) as usize;
    let mut cosines = vec![length, length * between(-0.2, 0.2)];
    let mut sines = vec![0.0, length * between(-0.2, 0.2)];
    for k in 2..=harmonics {
        let most = 0.35 / (k * k - 1) as f64;
        cosines.push(length * between(-most, most));
        sines.push(length * between(-most, most));
    }
    (length, cosines, sines)
}

/// Scenes whose contacts last for at least half of the time.
fn drawn(count: usize) -> Result<Vec<Scene>, Failure> {
    let mut random = Random::new(SEED);
    let mut all = Vec::new();
    while all.len() < count {
        let mut between = |a: f64, b: f64| random.within(a, b);
        let (length, cosines, sines) = outline(&mut between);
        let Ok(shape) = FourierBody::new(&cosines, &sines) else { continue };
        if shape.radius_bounds().min < 0.1 * length {
            continue;
        }
        let mass = PlanarMass::from_gyration(
            200.0 * length * length * between(0.5, 2.0),
            length * length * between(0.3, 0.6),
        )?;
        let time = (length / GRAVITY).sqrt();
        let (wedge, middle) = (between(60.0, 120.0_f64), between(-20.0, 20.0));
        let palms = HarmonicPalms {
            centres: [(90.0 + middle - wedge / 2.0).to_radians(), wedge.to_radians()],
            amplitudes: [between(0.0, 0.5), between(0.0, 0.2)],
            frequencies: [between(0.05, 0.4) / time, between(0.05, 0.4) / time],
            phases: [between(0.0, TAU), between(0.0, TAU)],
        };
        let start = PlanarStart { phi0: between(0.0, TAU), omega0: between(-1.0, 1.0) / time };
        let scene =
            Scene { object: PlanarObject { shape, mass, gravity: GRAVITY }, palms, start, length, time };
        if scene.log(100.0 / time / 10.0).is_ok_and(|log| log.duration() > 0.5 * LASTS * scene.time) {
            all.push(scene);
        }
    }
    Ok(all)
}

/// Time from the first sample to the last, s.
trait Lasts {
    fn duration(&self) -> f64;
}

impl Lasts for PlanarLog {
    fn duration(&self) -> f64 {
        let samples = self.samples();
        samples[samples.len() - 1].t - samples[0].t
    }
}

impl Scene {
    fn log(&self, rate: f64) -> Result<PlanarLog, Failure> {
        self.log_at(rate, 0.0)
    }

    /// With all times shifted, s.
    fn log_at(&self, rate: f64, shift: f64) -> Result<PlanarLog, Failure> {
        let count = (LASTS * self.time * rate) as usize;
        let times = (1..=count).map(|k| k as f64 / rate - shift).filter(|t| *t > 0.0);
        let times: Vec<f64> = std::iter::once(0.0).chain(times).collect();
        Ok(simulate_prescribed(&self.object, &self.palms, self.start, &times, 1e-12)?.log()?)
    }

    fn weight(&self) -> f64 {
        self.object.mass.mass() * GRAVITY
    }

    /// What a broken log has; the first sample is left out where readings come late.
    fn broken(&self, rate: f64, wrong: Wrong) -> Result<PlanarLog, Failure> {
        let good = self.log(rate)?;
        let truth = good.truth().ok_or("no truth")?.to_vec();
        let mut samples = good.samples().to_vec();
        let gains = |samples: &mut [PlanarSample], gains: [f64; 2], bias: f64| {
            for sample in samples {
                sample.forces = sample.forces.map(|[a, b]| [a * gains[0] + bias, b * gains[1]]);
            }
        };
        match wrong {
            Wrong::Gain => gains(&mut samples, [1.01, 1.0], 0.0),
            Wrong::BothGains => gains(&mut samples, [1.01, 1.01], 0.0),
            Wrong::Bias => gains(&mut samples, [1.0, 1.0], 0.01 * self.weight()),
            Wrong::Palm => samples.iter_mut().for_each(|s| s.angles[1] += 0.5_f64.to_radians()),
            Wrong::ForcesLate | Wrong::ContactsLate => {
                const LATE: f64 = 0.004;
                let late = self.log_at(rate, LATE)?;
                // Samples before the first one that is late.
                let early = samples.iter().take_while(|sample| sample.t - LATE <= 0.0).count();
                for (sample, late) in samples[early..].iter_mut().zip(&late.samples()[1..]) {
                    match wrong {
                        Wrong::ForcesLate => sample.forces = late.forces,
                        _ => sample.contacts = late.contacts,
                    }
                }
                let end = samples.len().min(early + late.samples().len() - 1);
                return Ok(PlanarLog::new(samples[early..end].to_vec(), Some(truth[early..end].to_vec()))?);
            }
            Wrong::Gap => {
                let middle = samples[samples.len() / 2].t;
                let kept: Vec<usize> =
                    (0..samples.len()).filter(|&k| (samples[k].t - middle).abs() > 0.024).collect();
                let of = |k: &usize| (samples[*k], truth[*k]);
                let (samples, truth) = kept.iter().map(of).unzip();
                return Ok(PlanarLog::new(samples, Some(truth))?);
            }
            Wrong::Nothing | Wrong::Inertia | Wrong::Mass | Wrong::Outliers => {}
        }
        Ok(PlanarLog::new(samples, Some(truth))?)
    }

    fn known(&self, wrong: Wrong) -> Result<PlanarMass, Failure> {
        let [mass, inertia] = match wrong {
            Wrong::Inertia => [1.0, 1.1],
            Wrong::Mass => [1.05, 1.05],
            _ => [1.0, 1.0],
        };
        Ok(PlanarMass::new(self.object.mass.mass() * mass, self.object.mass.inertia() * inertia)?)
    }
}

impl Scene {
    fn run(
        &self,
        tally: &mut Tally,
        rate: f64,
        noise: f64,
        known: bool,
        wrong: Wrong,
        seed: u64,
    ) -> Result<(), Failure> {
        let level = PlanarNoise { contact: noise * self.length, force: 0.01 * self.weight(), torque: 0.0 };
        let mut log = level.add_to(&self.broken(rate, wrong)?, seed);
        if matches!(wrong, Wrong::Outliers) {
            let mut random = Random::new(seed);
            let mut samples = log.samples().to_vec();
            for contact in samples.iter_mut().flat_map(|sample| &mut sample.contacts) {
                if random.within(0.0, 1.0) < 0.01 {
                    *contact = contact.map(|s| s + self.length * random.within(-0.2, 0.2));
                }
            }
            log = PlanarLog::new(samples, log.truth().map(<[_]>::to_vec))?;
        }
        let floor = FLOOR * self.length / self.time;
        let options = PlaneOptions {
            noise: ContactNoiseLevel {
                contact: level.contact,
                force_fixed: level.force,
                force_share: 0.0,
                impulse: None,
                floor,
            },
            gravity: GRAVITY,
            friction: vec![Some(0.0); 2],
            body: known.then(|| self.known(wrong)).transpose()?,
            size: None,
            suspects: true,
        };
        tally.run(&log.contact_log([0.0; 2]).ok_or("no forces")?, &options, self.length)?;
        Ok(())
    }
}
