//! Results as a bag.

use super::any_palms::AnyPalms;
use crate::error::CliError;
use recon_io::{ResultBag, ResultContact, ResultPose};

/// Name of the bag in a folder of results.
const NAME: &str = "result.mcap";

/// Name and contents of the bag of an estimate, the time of whose log is zero at `epoch`, ns.
pub(crate) fn bag_of_estimate(made: &AnyPalms, epoch: i64) -> Result<(String, Vec<u8>), CliError> {
    let data = &made.data;
    let contacts = |palm: &recon::object_dynamics::LoggedPalm| {
        let contact = |k: usize| {
            let force = palm.force(k).map(|force| force.vector);
            palm.touch(k).map(|touch| ResultContact { p_WC: touch.p_WC, force })
        };
        (0..data.log.times().len()).map(contact).collect()
    };
    let pose = |(k, state): (usize, &recon::object_dynamics::BodyState)| {
        let covariance = data.estimate.pose_covariances.get(k).copied();
        ResultPose { p_WCm: state.p_WCm, R_WO: state.R_WO, covariance }
    };
    let bounds = made.bounds.as_ref();
    let bag = ResultBag {
        epoch,
        times: data.log.times(),
        motion: data.estimate.states.iter().enumerate().map(pose).collect(),
        contacts: data.log.palms().iter().map(contacts).collect(),
        curves: data.curves.iter().flatten().flatten().map(|contact| contact.p_OC).collect(),
        lower: bounds.and_then(|bounds| bounds.lower.as_ref()),
        upper: bounds.and_then(|bounds| bounds.upper.as_ref()),
    };
    Ok((NAME.to_owned(), bag.bytes().map_err(CliError::ResultBag)?))
}
