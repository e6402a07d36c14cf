//! Failure sweep: logs that go on after a palm has lost contact.

use super::parallel_palms::judged;
use super::shared::{exact_estimate, warning};
use super::{Chart, Drawn};
use crate::{Axis, Budget, Subject, Sweep};
use glam::DVec3;
use recon::object_dynamics::{ContactLog, MassProperties, Sample, SensorLog};

pub(super) const CHART: Chart = Chart {
    name: "sweep-contact-loss",
    about: "logs that go on after contact is lost: right, reported or silent",
    draw,
};

/// MuJoCo's log of the gentle scene at 250 Hz; palm 2 loses contact at 1.25888 s.
const LOG: &str = include_str!("../../../tests/data/mj_B_gentle_thinned.csv");
const LOSS: f64 = 1.25888;
/// How long the log goes on after that, s.
const AFTER: [f64; 7] = [0.004, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5];

fn draw(_: Budget) -> Drawn {
    let log = recon_io::parse_log(LOG.as_bytes())?;
    let truth = log.truth().ok_or("the log has no truth columns")?;
    let mass = MassProperties::uniform_ellipsoid(1.0, DVec3::new(2.5, 2.0, 1.0))?;
    let mut marked = Subject::new("loss marked in the log");
    let mut held = Subject::new("loss not marked: last contact held, force zero");
    for after in AFTER {
        let samples: Vec<Sample> = log.samples().iter().filter(|s| s.t <= LOSS + after).copied().collect();
        let unmarked = hold_contacts(&samples);
        for (subject, samples) in [(&mut marked, samples), (&mut held, unmarked)] {
            let cut = SensorLog::new(samples, None)?;
            let taken = std::mem::replace(subject, Subject::new(""));
            *subject = match exact_estimate(&ContactLog::try_from(&cut)?, mass, 1.0) {
                Ok(found) => {
                    let pairs = found.states.iter().zip(truth).zip(&found.relied_on);
                    let relied = pairs.filter(|(_, relied)| **relied);
                    let error = relied.map(|((m, t), _)| m.p_WCm.distance(t.p_WCm)).fold(0.0, f64::max);
                    judged(taken, after, error, warning(&found.reliability))
                }
                Err(error) => taken.refused(after, error),
            };
        }
    }
    let sweep = Sweep::new("sweep-contact-loss", "Logs that go on after contact is lost", 2e-5)
        .subtitle("MuJoCo's log of the gentle scene at 250 Hz; right: centre of mass within 2e-5 m at all samples that are relied on")
        .axes(Axis::log("length of the log after the loss", "s"), Axis::log("largest error of the centre of mass", "m"))
        .subject(marked)
        .subject(held);
    Ok(vec![sweep.into()])
}

/// Sensors that hold their last contact when it is lost.
fn hold_contacts(samples: &[Sample]) -> Vec<Sample> {
    let mut last = [None; 3];
    let mut held = samples.to_vec();
    for sample in &mut held {
        for (palm, last) in sample.palms.iter_mut().zip(&mut last) {
            palm.contact = palm.contact.or(*last);
            *last = palm.contact;
        }
    }
    held
}
