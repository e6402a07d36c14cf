//! What may be wrong with a log in the plane, or with what is told of it.

use super::scene::Scene;
use recon::object_dynamics::planar::*;
use recon::observer::faults::Constant;
use recon_tests::Random;

type Failure = Box<dyn std::error::Error>;

/// What is wrong with a log or with what is told of it.
#[derive(Clone, Copy)]
pub enum Wrong {
    /// Nothing.
    Nothing,
    /// The moment of inertia, by this share.
    Inertia(f64),
    /// Mass and moment of inertia, by this share.
    Mass(f64),
    /// Forces are so old, s.
    ForcesLate(f64),
    /// Contacts are so old, s.
    ContactsLate(f64),
    /// Nothing is read for so long, s.
    Gap(f64),
    /// The angle of a palm, degrees.
    Palm(f64),
    /// The gain of a palm's force, by this share.
    Gain(f64),
    /// Both gains, by this share.
    BothGains(f64),
    /// A force, in weights.
    Bias(f64),
    /// This share of the contacts, by up to a fifth of the size.
    Outliers(f64),
}

/// Those of the study, with their names.
pub const FAULTS: [(Wrong, &str); 11] = [
    (Wrong::Nothing, "nothing"),
    (Wrong::Inertia(0.1), "inertia 10 %"),
    (Wrong::Mass(0.05), "mass and inertia 5 %"),
    (Wrong::ForcesLate(0.004), "forces 4 ms late"),
    (Wrong::ContactsLate(0.004), "contacts 4 ms late"),
    (Wrong::Gap(0.048), "gap of 48 ms"),
    (Wrong::Palm(0.5), "angle of a palm 0.5 degrees"),
    (Wrong::Gain(0.01), "gain of a palm 1 %"),
    (Wrong::BothGains(0.01), "both gains 1 %"),
    (Wrong::Bias(0.01), "bias of 1 % of the weight"),
    (Wrong::Outliers(0.01), "1 % outliers of contacts"),
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
            Self::Gain(by) => gains(&mut samples, [1.0 + by, 1.0], 0.0),
            Self::BothGains(by) => gains(&mut samples, [1.0 + by; 2], 0.0),
            Self::Bias(by) => gains(&mut samples, [1.0; 2], by * scene.weight()),
            Self::Palm(by) => samples.iter_mut().for_each(|s| s.angles[1] += by.to_radians()),
            Self::ForcesLate(age) | Self::ContactsLate(age) => {
                let late = scene.log_at(rate, age)?;
                // Samples before the first one that is late.
                let early = samples.iter().take_while(|sample| sample.t - age <= 0.0).count();
                for (sample, late) in samples[early..].iter_mut().zip(&late.samples()[1..]) {
                    match self {
                        Self::ForcesLate(_) => sample.forces = late.forces,
                        _ => sample.contacts = late.contacts,
                    }
                }
                let end = samples.len().min(early + late.samples().len() - 1);
                return Ok(PlanarLog::new(samples[early..end].to_vec(), Some(truth[early..end].to_vec()))?);
            }
            Self::Gap(gap) => {
                let middle = samples[samples.len() / 2].t;
                let kept = |(of, _): &(&PlanarSample, &PlanarTruth)| (of.t - middle).abs() > 0.5 * gap;
                let (samples, truth) = samples.iter().zip(&truth).filter(kept).unzip();
                return Ok(PlanarLog::new(samples, Some(truth))?);
            }
            Self::Nothing | Self::Inertia(_) | Self::Mass(_) | Self::Outliers(_) => {}
        }
        Ok(PlanarLog::new(samples, Some(truth))?)
    }

    /// A noisy log with what is wrong beside noise.
    ///
    /// # Errors
    /// Never: times are those of `log`.
    pub fn misread(self, log: PlanarLog, length: f64, seed: u64) -> Result<PlanarLog, Failure> {
        let Self::Outliers(share) = self else { return Ok(log) };
        let mut random = Random::new(seed);
        let mut samples = log.samples().to_vec();
        for contact in samples.iter_mut().flat_map(|sample| &mut sample.contacts) {
            if random.within(0.0, 1.0) < share {
                *contact = contact.map(|s| s + length * random.within(-0.2, 0.2));
            }
        }
        Ok(PlanarLog::new(samples, log.truth().map(<[_]>::to_vec))?)
    }

    /// The constant of the sensors or of the body that it is, and its value.
    #[must_use]
    pub fn constant(self, scene: &Scene) -> Option<(Constant, f64)> {
        match self {
            Self::Inertia(by) => Some((Constant::Moment { axis: 2 }, (1.0 + by).recip() - 1.0)),
            Self::ForcesLate(age) => Some((Constant::ForceDelay, age)),
            Self::ContactsLate(age) => Some((Constant::ContactDelay, age)),
            Self::Palm(by) => Some((Constant::PalmTilt { palm: 2, axis: 1 }, by.to_radians())),
            Self::Gain(by) => Some((Constant::ForceGain { palm: 1 }, by)),
            Self::Bias(by) => Some((Constant::ForceBias { palm: 1 }, by * scene.weight())),
            _ => None,
        }
    }

    /// What is told of the body.
    ///
    /// # Errors
    /// Those of a body that has no mass.
    pub fn told(self, body: PlanarMass) -> Result<PlanarMass, Failure> {
        let [mass, inertia] = match self {
            Self::Inertia(by) => [1.0, 1.0 + by],
            Self::Mass(by) => [1.0 + by; 2],
            _ => [1.0, 1.0],
        };
        Ok(PlanarMass::new(body.mass() * mass, body.inertia() * inertia)?)
    }
}
