//! From a log that was read to everything it tells.

use super::any_palms::{AnyPalms, AnyPalmsRequest, estimate_any_palms, refuse_unfelt};
use super::bounds::BoundsResult;
use super::condensed::condensed;
use super::export::exported;
use super::folder::{Extra, estimate_figures, write_estimate_folder};
use super::planes::with_forces;
use super::read::{LogOf, ReadLog};
use super::result_bag::bag_of_estimate;
use super::simulate::known_body;
use super::words::sentence;
use crate::cli::{ExportAs, ShapeAs};
use crate::error::CliError;
use crate::progress::Progress;
use recon::least_model::Accuracy;
use recon::object_dynamics::ThreePlanes;
use recon_io::{
    FolderTarget, Implausibility, Level, POSE, Scene, TriangleMesh, implausibilities, implausible_contacts,
    write_covariances, write_estimate_report,
};
use serde_json::Value;
use std::io::{self, Write};
use std::path::Path;

/// What is asked of a log.
pub(crate) struct Asked<'a> {
    /// Where the log is from, for messages.
    pub(crate) path: &'a Path,
    pub(crate) scene: &'a Scene,
    pub(crate) title: &'a str,
    /// Whether mass and inertia of the scene are not to be looked at.
    pub(crate) identify: bool,
    /// How near the motion is wanted, where the least model is to be chosen by that.
    pub(crate) accuracy: Option<Accuracy>,
    /// Whether covariances of all poses are wanted.
    pub(crate) covariances: bool,
}

/// What a log tells, with what its files need beside it.
pub(crate) struct Estimated {
    pub(crate) made: AnyPalms,
    /// Whether the palms are three planes without friction, on which radius functions tell the motion.
    pub(super) of_planes: bool,
}

/// Everything that the log tells. Truth in it is only compared with, never used.
pub(crate) fn estimated(
    ReadLog { log, warnings, .. }: ReadLog,
    asked: &Asked<'_>,
    progress: &Progress,
) -> Result<Estimated, CliError> {
    let Asked { path, scene, title, identify, accuracy, covariances } = *asked;
    let mut request =
        AnyPalmsRequest { accuracy, covariances, ..AnyPalmsRequest::new(scene, title, identify) };
    match log {
        LogOf::ThreePalms(planes) => estimated_planes(planes, asked, warnings, progress),
        LogOf::AnyPalms(log, why) => {
            refuse_unfelt(&log, path, &why)?;
            let odd = implausible_contacts(&log, scene);
            request.doubt(&odd, warnings);
            request.note = sentence(&format!("{why}; the estimate is that from contacts of any palms"));
            let made = estimate_any_palms(*log, request, progress);
            Ok(Estimated { made: made.map_err(|error| odd_first(error, &odd))?, of_planes: false })
        }
    }
}

/// Of three flat palms without friction.
pub(crate) fn estimated_planes(
    ThreePlanes { log, p_WM, .. }: ThreePlanes,
    asked: &Asked<'_>,
    warnings: Vec<String>,
    progress: &Progress,
) -> Result<Estimated, CliError> {
    let Asked { scene, title, identify, accuracy, covariances, .. } = *asked;
    if !identify {
        // What is to be estimated is asked for.
        known_body(scene)?;
    }
    let mut request =
        AnyPalmsRequest { accuracy, covariances, ..AnyPalmsRequest::new(scene, title, identify) };
    let odd = implausibilities(&log, scene);
    if let Some(first) = odd.first().filter(|_| odd.iter().any(Implausibility::is_hopeless)) {
        return Err(CliError::Hopeless { odd: first.to_string() });
    }
    let (log, together) = condensed(log);
    let contacts = with_forces(&log, scene)?.shifted(p_WM);
    request.friction = Some(0.0);
    request.together = together;
    request.note = "Three flat palms without friction.".to_owned();
    request.doubt(&odd, warnings);
    let made = estimate_any_palms(contacts, request, progress).map_err(|error| odd_first(error, &odd))?;
    Ok(Estimated { made, of_planes: true })
}

/// Of an estimate that fails on a log that does not go with its scene, that it does not.
fn odd_first(error: CliError, odd: &[Implausibility]) -> CliError {
    match (error, odd.first()) {
        (CliError::ContactEstimate(source), Some(odd)) => CliError::OddLog { odd: odd.to_string(), source },
        (error, _) => error,
    }
}

impl Estimated {
    /// The table of the covariances of all poses, as a file.
    pub(crate) fn covariances(&self) -> Result<Extra, CliError> {
        let (data, mut table) = (&self.made.data, Vec::new());
        write_covariances(POSE, data.log.times(), &data.estimate.pose_covariances, &mut table)
            .map_err(CliError::Page)?;
        Ok(("covariance.csv".to_owned(), table))
    }

    /// Further files of its folder: the object in these formats, and where the time is given at which the log's is zero (ns) its bag.
    pub(crate) fn extras(
        &self,
        formats: &[ExportAs],
        shape: ShapeAs,
        bag: Option<i64>,
    ) -> Result<Vec<Extra>, CliError> {
        let mut extras = Vec::new();
        if !formats.is_empty() {
            let files = exported(&self.made.object()?, formats, shape)?;
            extras.extend(files.into_iter().map(|file| (file.name, file.contents)));
        }
        if let Some(epoch) = bag {
            extras.push(bag_of_estimate(&self.made, epoch)?);
        }
        Ok(extras)
    }

    /// The surfaces of the bounds by the names of their files.
    pub(crate) fn surfaces(&self) -> Vec<(&'static str, &TriangleMesh)> {
        self.made.bounds.as_ref().map(BoundsResult::surfaces).unwrap_or_default()
    }

    /// The summary.
    pub(crate) fn figures(&self) -> Value {
        let mut figures = estimate_figures(&self.made);
        let radius = self.made.data.largest_radius_error().filter(|_| self.of_planes);
        if let (Some(errors), Some(largest)) = (figures["largest_error"].as_object_mut(), radius) {
            errors.insert("radius_function_m".to_owned(), largest.into());
        }
        figures
    }

    /// Writes its page.
    pub(crate) fn write_page(&self, to: &mut dyn Write) -> io::Result<()> {
        write_estimate_report(&self.made.data, to)
    }

    /// Writes its folder; returns the summary.
    pub(crate) fn write(&self, target: FolderTarget, extras: &[Extra]) -> Result<Value, CliError> {
        write_estimate_folder(target, self, extras)
    }

    /// Whether the result may be relied on.
    pub(crate) fn is_reliable(&self) -> bool {
        self.made.data.verdict.level == Level::Good
    }
}
