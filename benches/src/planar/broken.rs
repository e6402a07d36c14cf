//! What may be wrong with a log in the plane, or with what is told of it.

use super::scene::Scene;
use recon::object_dynamics::planar::*;
use recon::observer::SensorFault;
use recon_tests::Random;

type Failure = Box<dyn std::error::Error>;

/// How late readings are, s.
const LATE: f64 = 0.004;
/// Half of a gap, s.
const HALF_GAP: f64 = 0.024;

/// What is wrong with a log or with what is told of it.
#[derive(Clone, Copy)]
pub enum Wrong {
    /// Nothing.
    Nothing,
    /// The moment of inertia, by 10 %.
    Inertia,
    /// Mass and moment of inertia, by 5 %.
    Mass,
    /// Forces are 4 ms old.
    ForcesLate,
    /// Contacts are 4 ms old.
    ContactsLate,
    /// Nothing is read for 48 ms.
    Gap,
    /// The angle of a palm, by half a degree.
    Palm,
    /// The gain of a palm's force, by 1 %.
    Gain,
    /// Both gains, by 1 %.
    BothGains,
    /// A force, by 1 % of the weight.
    Bias,
    /// One contact in a hundred, by up to a fifth of the size.
    Outliers,
}

/// All of them, with their names.
pub const FAULTS: [(Wrong, &str); 11] = [
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

impl Wrong {
    /// The log of a scene that has it, without noise; the first sample is left out where readings come late.
    ///
    /// # Errors
    /// Those of the simulation.
    pub fn log(self, scene: &Scene, rate: f64) -> Result<PlanarLog, Failure> {
        let good = scene.log(rate)?;
        let truth = good.truth().ok_or("no truth")?.to_vec();
        let mut samples = good.samples().to_vec();
        let gains = |samples: &mut [PlanarSample], gains: [f64; 2], bias: f64| {
            for sample in samples {
                sample.forces = sample.forces.map(|[a, b]| [a * gains[0] + bias, b * gains[1]]);
            }
        };
        match self {
            Self::Gain => gains(&mut samples, [1.01, 1.0], 0.0),
            Self::BothGains => gains(&mut samples, [1.01, 1.01], 0.0),
            Self::Bias => gains(&mut samples, [1.0, 1.0], 0.01 * scene.weight()),
            Self::Palm => samples.iter_mut().for_each(|s| s.angles[1] += 0.5_f64.to_radians()),
            Self::ForcesLate | Self::ContactsLate => {
                let late = scene.log_at(rate, LATE)?;
                // Samples before the first one that is late.
                let early = samples.iter().take_while(|sample| sample.t - LATE <= 0.0).count();
                for (sample, late) in samples[early..].iter_mut().zip(&late.samples()[1..]) {
                    match self {
                        Self::ForcesLate => sample.forces = late.forces,
                        _ => sample.contacts = late.contacts,
                    }
                }
                let end = samples.len().min(early + late.samples().len() - 1);
                return Ok(PlanarLog::new(samples[early..end].to_vec(), Some(truth[early..end].to_vec()))?);
            }
            Self::Gap => {
                let middle = samples[samples.len() / 2].t;
                let kept = |(of, _): &(&PlanarSample, &PlanarTruth)| (of.t - middle).abs() > HALF_GAP;
                let (samples, truth) = samples.iter().zip(&truth).filter(kept).unzip();
                return Ok(PlanarLog::new(samples, Some(truth))?);
            }
            Self::Nothing | Self::Inertia | Self::Mass | Self::Outliers => {}
        }
        Ok(PlanarLog::new(samples, Some(truth))?)
    }

    /// A noisy log with what is wrong beside noise.
    ///
    /// # Errors
    /// Never: times are those of `log`.
    pub fn misread(self, log: PlanarLog, length: f64, seed: u64) -> Result<PlanarLog, Failure> {
        if !matches!(self, Self::Outliers) {
            return Ok(log);
        }
        let mut random = Random::new(seed);
        let mut samples = log.samples().to_vec();
        for contact in samples.iter_mut().flat_map(|sample| &mut sample.contacts) {
            if random.within(0.0, 1.0) < 0.01 {
                *contact = contact.map(|s| s + length * random.within(-0.2, 0.2));
            }
        }
        Ok(PlanarLog::new(samples, log.truth().map(<[_]>::to_vec))?)
    }

    /// The constant of the sensors that it is, and its value.
    #[must_use]
    pub fn constant(self, scene: &Scene) -> Option<(SensorFault, f64)> {
        match self {
            Self::ForcesLate => Some((SensorFault::ForceDelay, LATE)),
            Self::ContactsLate => Some((SensorFault::ContactDelay, LATE)),
            Self::Palm => Some((SensorFault::PalmTilt { palm: 2, axis: 1 }, 0.5_f64.to_radians())),
            Self::Gain => Some((SensorFault::ForceGain { palm: 1 }, 0.01)),
            Self::Bias => Some((SensorFault::ForceBias { palm: 1 }, 0.01 * scene.weight())),
            _ => None,
        }
    }

    /// What is told of the body.
    ///
    /// # Errors
    /// Those of a body that has no mass.
    pub fn told(self, body: PlanarMass) -> Result<PlanarMass, Failure> {
        let [mass, inertia] = match self {
            Self::Inertia => [1.0, 1.1],
            Self::Mass => [1.05, 1.05],
            _ => [1.0, 1.0],
        };
        Ok(PlanarMass::new(body.mass() * mass, body.inertia() * inertia)?)
    }
}
