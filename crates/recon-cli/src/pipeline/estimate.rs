//! From a log that was read to everything it tells, by whichever estimator it is for.

use super::any_palms::{AnyPalms, AnyPalmsRequest, estimate_any_palms, refuse_unfelt};
use super::bounds::{BoundsResult, LOWER, UPPER};
use super::export::exported;
use super::folder::{Extra, write_estimate_folder, write_reconstruction_folder};
use super::noisy_planes::{as_planes, noisy_planes};
use super::read::{LogOf, LogStand, ReadLog};
use super::reconstruct::{Reconstruction, condensed, reconstruct, sentence};
use super::result_bag::{bag_of_any_palms, bag_of_planes, normal_forces};
use crate::cli::{ExportAs, ShapeAs};
use crate::error::CliError;
use crate::progress::Progress;
use recon_io::{FolderTarget, Level, ReportData, Scene, TriangleMesh};
use serde_json::Value;
use std::path::Path;

/// What is asked of a log.
pub(crate) struct Asked<'a> {
    /// Where the log is from, for messages.
    pub(crate) path: &'a Path,
    pub(crate) scene: &'a Scene,
    pub(crate) title: &'a str,
    /// Whether mass and inertia of the scene are not to be looked at.
    pub(crate) identify: bool,
}

/// What a log tells, with what its files need beside it.
pub(crate) enum Estimated {
    /// Three flat palms without friction and noise; sizes of the normal forces.
    Planes(Box<Reconstruction>, Vec<[Option<f64>; 3]>),
    /// Any palms; what the page of three palms shows where they are that.
    AnyPalms(Box<AnyPalms>, Option<Box<ReportData>>),
}

/// Everything that the log tells. Truth in it is only compared with, never used.
pub(crate) fn estimated(
    ReadLog { log, warnings, .. }: ReadLog,
    asked: &Asked<'_>,
    progress: &Progress,
) -> Result<Estimated, CliError> {
    let Asked { path, scene, title, identify } = *asked;
    let mut request = AnyPalmsRequest::new(scene, title, identify);
    let log = match log {
        LogOf::ThreePalms(log) => log,
        LogOf::AnyPalms(log, why) => {
            refuse_unfelt(&log, path, &why)?;
            request.warnings = warnings;
            request.note = sentence(&format!("{why}; the estimate is that from contacts of any palms"));
            let made = estimate_any_palms(*log, request, progress)?;
            return Ok(Estimated::AnyPalms(Box::new(made), None));
        }
    };
    let (log, together) = condensed(log);
    if let Some(contacts) = noisy_planes(&log, scene)? {
        request.of_noisy_planes(&log, together, warnings);
        let made = estimate_any_palms(contacts, request, progress)?;
        let page = as_planes(&made, &log, scene)?;
        return Ok(Estimated::AnyPalms(Box::new(made), Some(Box::new(page))));
    }
    let forces = normal_forces(&log);
    let mut made = reconstruct(log, scene, title, (identify, together), progress)?;
    made.data.warnings.extend(warnings);
    Ok(Estimated::Planes(Box::new(made), forces))
}

impl Estimated {
    /// Further files of its folder: the object in these formats, and where a stand is given its bag.
    pub(crate) fn extras(
        &self,
        formats: &[ExportAs],
        shape: ShapeAs,
        bag: Option<LogStand>,
    ) -> Result<Vec<Extra>, CliError> {
        let files = match self {
            _ if formats.is_empty() => Vec::new(),
            Self::Planes(made, _) => exported(&made.object(), formats, shape)?,
            Self::AnyPalms(made, _) => exported(&made.object()?, formats, shape)?,
        };
        let mut extras: Vec<_> = files.into_iter().map(|file| (file.name, file.contents)).collect();
        if let Some(stand) = bag {
            extras.push(match self {
                Self::Planes(made, forces) => bag_of_planes(made, forces, stand)?,
                Self::AnyPalms(made, _) => bag_of_any_palms(made, stand)?,
            });
        }
        Ok(extras)
    }

    /// The surfaces of the bounds by the names of their files.
    pub(crate) fn surfaces(&self) -> Vec<(&'static str, &TriangleMesh)> {
        match self {
            Self::Planes(made, _) => {
                let both = [(LOWER, made.lower.as_ref()), (UPPER, made.upper.as_ref())];
                both.into_iter().filter_map(|(name, mesh)| Some((name, mesh?))).collect()
            }
            Self::AnyPalms(made, _) => made.bounds.as_ref().map(BoundsResult::surfaces).unwrap_or_default(),
        }
    }

    /// Writes its folder; returns the summary.
    pub(crate) fn write(&self, target: FolderTarget, extras: &[Extra]) -> Result<Value, CliError> {
        match self {
            Self::Planes(made, _) => write_reconstruction_folder(target, made, extras),
            Self::AnyPalms(made, page) => write_estimate_folder(target, made, page.as_deref(), extras),
        }
    }

    /// Whether the result may be relied on.
    pub(crate) fn is_reliable(&self) -> bool {
        match self {
            Self::Planes(made, _) => made.is_reliable(),
            Self::AnyPalms(made, _) => made.data.verdict.level == Level::Good,
        }
    }
}
