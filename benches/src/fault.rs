//! What is not as stated of a log of three palms, or of the body on them.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, PalmFrame};
use recon::object_dynamics::{MassProperties, Sample, SensorLog};
use recon::observer::faults::{Assumption, Constant};
use recon_tests::Random;

type Failure = Box<dyn std::error::Error>;

/// What departures are stated in.
#[derive(Clone, Copy, Debug)]
pub struct Scale {
    /// Mean semi-axis, m.
    pub size: f64,
    /// Of the body, N.
    pub weight: f64,
}

/// One departure; its palm is the first one.
#[derive(Clone, Copy, Debug)]
pub enum Fault {
    /// Contacts at taxels so far from each other, in sizes.
    Taxels(f64),
    /// Forces through a filter of first order with this time constant, s.
    Lag(f64),
    /// Forces so late, s.
    Delay(f64),
    /// In weights.
    Bias(f64),
    /// Relative.
    Gain(f64),
    /// Share of the contacts that are off by a fifth of the size.
    Outliers(f64),
    /// Share of the samples that are missing.
    Dropped(f64),
    /// s, in the middle.
    Gap(f64),
    /// Contacts of a palm shifted along its first axis, in sizes.
    Shifted(f64),
    /// Palm turned about its level axis, degrees.
    Turned(f64),
    /// Relative, stated too large.
    Mass(f64),
    /// All moments of inertia.
    Inertia(f64),
    /// One moment of inertia.
    Moment(f64),
}

/// Those of the study of whole logs.
pub const FAULTS: [Fault; 16] = [
    Fault::Taxels(0.01),
    Fault::Lag(0.01),
    Fault::Delay(0.005),
    Fault::Bias(0.02),
    Fault::Gain(0.005),
    Fault::Gain(0.02),
    Fault::Outliers(0.01),
    Fault::Dropped(0.1),
    Fault::Gap(0.02),
    Fault::Gap(0.06),
    Fault::Gap(0.2),
    Fault::Turned(0.4),
    Fault::Turned(1.0),
    Fault::Mass(0.05),
    Fault::Inertia(0.1),
    Fault::Moment(0.05),
];

impl Fault {
    /// In words.
    #[must_use]
    pub fn name(&self) -> String {
        match self {
            Self::Taxels(pitch) => format!("taxels {} % of the size apart", 100.0 * pitch),
            Self::Lag(lag) => format!("forces lag by {} ms", 1e3 * lag),
            Self::Delay(delay) => format!("forces {} ms late", 1e3 * delay),
            Self::Bias(bias) => format!("a force's bias, {} % of the weight", 100.0 * bias),
            Self::Gain(gain) => format!("a force's gain, {} %", 100.0 * gain),
            Self::Outliers(share) => format!("{} % of the contacts a fifth of the size off", 100.0 * share),
            Self::Dropped(share) => format!("{} % of the samples missing", 100.0 * share),
            Self::Gap(gap) => format!("gap of {} ms", 1e3 * gap),
            Self::Shifted(shift) => format!("contacts of a palm {} % of the size off", 100.0 * shift),
            Self::Turned(angle) => format!("a palm {angle} degrees off"),
            Self::Mass(share) => format!("mass stated {} % too large", 100.0 * share),
            Self::Inertia(share) => format!("inertia stated {} % too large", 100.0 * share),
            Self::Moment(share) => format!("one moment stated {} % too large", 100.0 * share),
        }
    }

    /// Whether it is in what is stated of the body.
    #[must_use]
    pub fn of_body(&self) -> bool {
        matches!(self, Self::Mass(_) | Self::Inertia(_) | Self::Moment(_))
    }

    /// Whether this is what an estimate takes it for; a delay is what a lag is to first order.
    #[must_use]
    pub fn is(&self, assumption: &Assumption) -> bool {
        match (self, assumption) {
            (Self::Mass(_) | Self::Inertia(_) | Self::Moment(_), Assumption::Body)
            | (Self::Taxels(_) | Self::Outliers(_), Assumption::Noise) => true,
            (_, Assumption::One(fault)) => matches!(
                (self, fault),
                (Self::Bias(_), Constant::ForceBias { palm: 1 })
                    | (Self::Gain(_), Constant::ForceGain { palm: 1 })
                    | (Self::Delay(_) | Self::Lag(_), Constant::ForceDelay)
                    | (Self::Turned(_), Constant::PalmTilt { palm: 1, axis: 0 })
                    | (Self::Shifted(_), Constant::ContactOffset { palm: 1, axis: 0 })
                    | (Self::Mass(_), Constant::Mass)
                    | (Self::Inertia(_) | Self::Moment(_), Constant::Moment { .. })
            ),
            _ => false,
        }
    }

    /// What an estimate is to find of it at so many samples a second; none where that is no one number.
    #[must_use]
    pub fn value(&self, of: Scale, rate: f64) -> Option<f64> {
        match self {
            Self::Gain(share) | Self::Mass(share) => Some(1.0 / (1.0 + share) - 1.0),
            Self::Bias(bias) => Some(-bias * of.weight),
            Self::Delay(delay) => Some((delay * rate).ceil() / rate),
            Self::Shifted(shift) => Some(-shift * of.size),
            Self::Turned(angle) => Some(-angle.to_radians()),
            _ => None,
        }
    }

    /// What is stated of a body.
    #[must_use]
    pub fn of_mass(&self, mass: MassProperties) -> MassProperties {
        let moments = mass.principal().moments;
        let stated = match self {
            Self::Mass(share) => MassProperties::from_principal(mass.mass() * (1.0 + share), moments),
            Self::Inertia(share) => MassProperties::from_principal(mass.mass(), moments * (1.0 + share)),
            Self::Moment(share) => {
                MassProperties::from_principal(mass.mass(), moments * DVec3::new(1.0 + share, 1.0, 1.0))
            }
            _ => Ok(mass),
        };
        stated.unwrap_or(mass)
    }

    /// A log that has it.
    ///
    /// # Errors
    /// Those of readings that are no log any more.
    pub fn of_log(&self, log: &SensorLog, of: Scale) -> Result<SensorLog, Failure> {
        let mut samples = log.samples().to_vec();
        let mut random = Random::new(7);
        let last = samples[samples.len() - 1].t;
        let contacts = |samples: &mut [Sample], change: &mut dyn FnMut(&mut [f64; 2])| {
            let all = samples.iter_mut().flat_map(|sample| &mut sample.palms);
            all.filter_map(|palm| palm.contact.as_mut()).for_each(change);
        };
        match self {
            Self::Taxels(pitch) => {
                let pitch = pitch * of.size;
                contacts(&mut samples, &mut |s| *s = s.map(|s| (s / pitch).round() * pitch));
            }
            Self::Outliers(share) => contacts(&mut samples, &mut |s| {
                if random.within(0.0, 1.0) < *share {
                    s[0] += 0.2 * of.size;
                }
            }),
            Self::Bias(bias) => forces(&mut samples, |_, f| f + bias * of.weight),
            Self::Gain(gain) => forces(&mut samples, |_, f| f * (1.0 + gain)),
            Self::Lag(_) | Self::Delay(_) => self.late(log, &mut samples),
            Self::Dropped(share) => {
                samples.retain(|sample| sample.t == 0.0 || random.within(0.0, 1.0) >= *share);
            }
            Self::Gap(gap) => samples.retain(|sample| (sample.t - 0.5 * last).abs() > 0.5 * gap),
            Self::Shifted(shift) => {
                let first = samples.iter_mut().filter_map(|sample| sample.palms[0].contact.as_mut());
                first.for_each(|s| s[0] += shift * of.size);
            }
            Self::Turned(angle) => {
                for sample in &mut samples {
                    let normal = &mut sample.palms[0].normal;
                    let axis = PalmFrame::from_normal(*normal)?.t1;
                    let turned = DQuat::from_axis_angle(axis, angle.to_radians()) * normal.get();
                    *normal = Direction::new(turned)?;
                }
            }
            Self::Mass(_) | Self::Inertia(_) | Self::Moment(_) => {}
        }
        Ok(SensorLog::new(samples, None)?)
    }

    fn late(&self, log: &SensorLog, samples: &mut [Sample]) {
        for i in 0..3 {
            let force = |k: usize| log.samples()[k].palms[i].force.unwrap_or_default();
            let mut held = force(0);
            for k in 0..samples.len() {
                let step = if k > 0 { samples[k].t - samples[k - 1].t } else { 0.0 };
                held = match self {
                    Self::Lag(lag) => held + (force(k) - held) * (1.0 - (-step / lag).exp()),
                    Self::Delay(delay) => {
                        let after = log.samples().partition_point(|s| s.t <= samples[k].t - delay).max(1);
                        force(after - 1)
                    }
                    _ => held,
                };
                samples[k].palms[i].force = Some(held);
            }
        }
    }
}

/// Changes the forces of the first palm.
fn forces(samples: &mut [Sample], change: impl Fn(f64, f64) -> f64) {
    for sample in samples {
        let t = sample.t;
        sample.palms[0].force = sample.palms[0].force.map(|f| change(t, f));
    }
}
