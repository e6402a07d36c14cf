//! Results as a bag.

use super::any_palms::AnyPalms;
use super::read::LogStand;
use super::reconstruct::Reconstruction;
use crate::error::CliError;
use recon::object_dynamics::SensorLog;
use recon_io::{ResultBag, ResultContact, ResultPose};

/// Name of the bag in a folder of results.
const NAME: &str = "result.mcap";

/// Sizes of the normal forces of three palms at all samples, N, where they are known.
pub(crate) fn normal_forces(log: &SensorLog) -> Vec<[Option<f64>; 3]> {
    log.samples().iter().map(|sample| sample.palms.each_ref().map(|palm| palm.force)).collect()
}

/// Name and contents of the bag of a reconstruction on three palms.
pub(crate) fn bag_of_planes(
    made: &Reconstruction,
    forces: &[[Option<f64>; 3]],
    stand: LogStand,
) -> Result<(String, Vec<u8>), CliError> {
    let data = &made.data;
    let contacts = |i: usize| {
        let palm = &data.palms[i];
        let contact = |(k, contact): (usize, &Option<recon_io::PalmContact>)| {
            let size = forces.get(k).and_then(|sizes| sizes[i]);
            let normal = palm.frames.get(k).map(|frame| frame.n);
            let force = size.zip(normal).map(|(size, n)| size * n);
            contact.map(|contact| ResultContact { p_WC: contact.p_WC, force })
        };
        palm.contacts.iter().enumerate().map(contact).collect()
    };
    let pose =
        |state: &recon_io::MotionState| ResultPose { p_WCm: state.p_WCm, R_WO: state.R_WO, deviations: None };
    let bag = ResultBag {
        epoch: stand.epoch,
        origin: stand.origin,
        times: &data.times,
        motion: data.motion.iter().map(pose).collect(),
        contacts: (0..3).map(contacts).collect(),
        curves: data.palms.iter().flat_map(|palm| palm.contacts.iter().flatten()).map(|c| c.p_OC).collect(),
        lower: made.lower.as_ref(),
        upper: made.upper.as_ref(),
    };
    Ok((NAME.to_owned(), bag.bytes().map_err(CliError::ResultBag)?))
}

/// Name and contents of the bag of an estimate from contacts of any palms.
pub(crate) fn bag_of_any_palms(made: &AnyPalms, stand: LogStand) -> Result<(String, Vec<u8>), CliError> {
    let data = &made.data;
    let contacts = |palm: &recon::object_dynamics::LoggedPalm| {
        let contact = |k: usize| {
            let force = palm.force(k).map(|force| force.vector);
            palm.touch(k).map(|touch| ResultContact { p_WC: touch.p_WC, force })
        };
        (0..data.log.times().len()).map(contact).collect()
    };
    let poses = data.estimate.states.iter().zip(&data.estimate.deviations);
    let pose = |(state, [position, _, _, turn]): (&recon::object_dynamics::BodyState, &[glam::DVec3; 4])| {
        ResultPose { p_WCm: state.p_WCm, R_WO: state.R_WO, deviations: Some([*position, *turn]) }
    };
    let bounds = made.bounds.as_ref();
    let bag = ResultBag {
        epoch: stand.epoch,
        origin: stand.origin,
        times: data.log.times(),
        motion: poses.map(pose).collect(),
        contacts: data.log.palms().iter().map(contacts).collect(),
        curves: data.curves.iter().flatten().flatten().map(|contact| contact.p_OC).collect(),
        lower: bounds.and_then(|bounds| bounds.lower.as_ref()),
        upper: bounds.and_then(|bounds| bounds.upper.as_ref()),
    };
    Ok((NAME.to_owned(), bag.bytes().map_err(CliError::ResultBag)?))
}
