//! Another simulator's log that goes on after a palm has lost contact.

use super::super::Failure;
use super::super::judged::Ran;
use super::estimate::doubt;
use super::worse;
use glam::DVec3;
use recon::object_dynamics::{ContactLog, MassProperties, Sample, SensorLog};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions, estimate_contacts};

/// MuJoCo's log of the gentle scene at 250 Hz; palm 2 loses contact at 1.25888 s.
const LOG: &str = include_str!("../../../../tests/data/mj_B_gentle_thinned.csv");
const LOSS: f64 = 1.25888;
const GRAVITY: f64 = 1.0;
/// What the centre of mass may be off by, m: how far contacts sink in there.
const RIGHT: f64 = 2e-5;
/// Samples of which seeds leave out some at the start.
const LEFT_OUT: u64 = 12;

/// So long after the loss; the loss is marked, or the last contact is held and its force zero.
pub(super) fn run(after: f64, held: bool, known: bool, seed: u64) -> Result<Ran, Failure> {
    let log = recon_io::parse_log(LOG.as_bytes())?;
    let left_out = (seed % LEFT_OUT) as usize;
    let truth = &log.truth().ok_or("the log has no truth columns")?[left_out..];
    let kept = log.samples()[left_out..].iter().filter(|s| s.t <= LOSS + after);
    let mut samples: Vec<Sample> = kept.copied().collect();
    if held {
        hold_contacts(&mut samples);
    }
    let log = ContactLog::try_from(&SensorLog::new(samples, None)?)?;
    let noise = ContactNoiseLevel::guessed(&log, GRAVITY, None).ok_or("no two palms are touched at once")?;
    let mass = MassProperties::uniform_ellipsoid(1.0, DVec3::new(2.5, 2.0, 1.0))?;
    let body = known.then_some(mass);
    let options =
        ContactOptions { friction: Some(0.0), body, suspects: true, ..ContactOptions::new(noise, GRAVITY) };
    let found = match estimate_contacts(&log, None, &options) {
        Ok(found) => found,
        Err(error) => return Ok(Ran::refused(&error)),
    };
    let mut off = 0.0;
    for (k, (state, truth)) in found.states.iter().zip(truth).enumerate().filter(|(k, _)| found.relied_on[*k])
    {
        let allowed = RIGHT.max(super::super::DEVIATIONS * found.deviations[k][0].max_element());
        off = worse(off, state.p_WCm.distance(truth.p_WCm) / allowed);
    }
    Ok(Ran::Found { off, doubt: doubt(&found) })
}

/// Sensors that hold their last contact when it is lost.
fn hold_contacts(samples: &mut [Sample]) {
    let mut last = [None; 3];
    for sample in samples {
        for (palm, last) in sample.palms.iter_mut().zip(&mut last) {
            palm.contact = palm.contact.or(*last);
            *last = palm.contact;
        }
    }
}
