use super::failure::Failure;
use super::log::Log;
use super::options::{parsed, unlike};
use crate::cli::{Command, ReconstructArgs};
use crate::commands::reconstruct::describe;
use crate::error::CliError;
use crate::pipeline::{
    Asked, Estimated, LogOf, WithoutForces, estimated, meshes_as, seen_from_meeting_point,
    sorted_with_forces, sorted_without_forces, without_forces, without_forces_page,
};
use crate::progress::{Progress, Watch};
use glam::{DMat3, DVec3};
use recon_io::{
    Bounds, Evidence, FolderTarget, Level, MotionState, PalmContact, Scene, TriangleMesh, mode_probabilities,
    write_figures_page,
};
use serde_json::Value;
use std::path::Path;

/// Everything that a log tells: what `recon reconstruct` writes into a folder.
pub struct Reconstructed {
    made: Made,
    log: Log,
    figures: Value,
    text: String,
}

enum Made {
    Estimated(Box<Estimated>),
    WithoutForces(Box<WithoutForces>),
}

/// Mass and inertia in the body axes of the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// kg.
    pub mass: f64,
    /// About the centre of mass, kg m^2.
    pub inertia: DMat3,
    /// Standard deviations of mass and of the entries of the inertia, where these were estimated.
    pub deviations: Option<(f64, DMat3)>,
}

impl Reconstructed {
    /// Motion, contacts, bounds, and where it is asked for mass and inertia. `options` are `--identify`, `--accuracy` and
    /// `--without-forces`. Truth in the log is only compared with.
    ///
    /// # Errors
    /// Why the log gives no estimate.
    pub fn of(log: &Log, scene: &Scene, options: &[String], watch: Option<Watch>) -> Result<Self, Failure> {
        let args = arguments(options, None)?;
        let progress = Progress::watched(watch);
        let title = log.title();
        let loaded = log.loaded.as_ref().clone();
        let made = if args.without_forces {
            let read = sorted_without_forces(loaded, scene);
            let planes = match read.log {
                LogOf::ThreePalms(planes) => planes,
                LogOf::AnyPalms(_, source) => {
                    return Err(CliError::NotThreePlanes { path: log.path.clone(), source }.into());
                }
            };
            let (planes, warnings) = seen_from_meeting_point(planes, read.warnings);
            let (planes, _) = planes.split_truth();
            let made = without_forces(planes, warnings, scene, &progress)?;
            Made::WithoutForces(Box::new(made))
        } else {
            let read = sorted_with_forces(loaded, scene);
            let asked = Asked {
                path: &log.path,
                scene,
                title: &title,
                identify: args.identify,
                accuracy: args.accuracy,
                covariances: true,
            };
            Made::Estimated(Box::new(estimated(read, &asked, &progress)?))
        };
        let figures = match &made {
            Made::Estimated(made) => made.figures(),
            Made::WithoutForces(made) => made.figures(),
        };
        let text = match &made {
            Made::Estimated(made) => describe(made, &figures),
            Made::WithoutForces(made) => made.describe(),
        };
        let text = recon_io::with_brief_numbers(text.trim_end());
        Ok(Self { made, log: log.clone(), figures, text })
    }

    /// What `summary.json` holds.
    pub fn summary(&self) -> &Value {
        &self.figures
    }

    /// What the command prints.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Covariances of all poses: centre of mass (m), turn since the first sample (rad), world axes. None without forces.
    pub fn pose_covariances(&self) -> &[[[f64; 6]; 6]] {
        match &self.made {
            Made::Estimated(made) => &made.made.data.estimate.pose_covariances,
            Made::WithoutForces(_) => &[],
        }
    }

    /// Whether the result may be relied on, and why or why not.
    pub fn verdict(&self) -> (bool, String) {
        match &self.made {
            Made::Estimated(of) => (of.is_reliable(), of.made.data.verdict.text.clone()),
            Made::WithoutForces(made) => {
                (true, made.describe().lines().next().unwrap_or_default().to_owned())
            }
        }
    }

    /// Whether bounds and all else that was asked for are there and may be relied on: what the command's exit code 0 says.
    pub fn is_whole(&self) -> bool {
        match &self.made {
            Made::Estimated(made) => made.is_reliable(),
            Made::WithoutForces(made) => made.bounded.is_some(),
        }
    }

    /// What the reader must know.
    pub fn warnings(&self) -> &[String] {
        match &self.made {
            Made::Estimated(made) => &made.made.data.warnings,
            Made::WithoutForces(made) => &made.warnings,
        }
    }

    /// What the estimate rests on, row by row; none without forces, where the summary has all of it.
    pub fn evidence(&self) -> &[Evidence] {
        match &self.made {
            Made::Estimated(made) => &made.made.data.evidence,
            Made::WithoutForces(_) => &[],
        }
    }

    /// How much each row of the evidence speaks for the result, in a word.
    pub fn level(evidence: &Evidence) -> &'static str {
        match evidence.level {
            Level::Good => "good",
            Level::Caution => "caution",
            Level::Bad => "bad",
            Level::Neutral => "neutral",
        }
    }

    /// Times of the motion, s.
    pub fn times(&self) -> Vec<f64> {
        match &self.made {
            Made::Estimated(made) => made.made.data.log.times().to_vec(),
            Made::WithoutForces(made) => made.times(),
        }
    }

    /// The motion at these times.
    pub fn motion(&self) -> Vec<MotionState> {
        match &self.made {
            Made::Estimated(made) => {
                made.made.data.estimate.states.iter().map(|state| (*state).into()).collect()
            }
            Made::WithoutForces(made) => made.motion(),
        }
    }

    /// Standard deviations at these times: centre of mass (m), velocity (m/s), angular velocity (rad/s), turn since the first sample
    /// (rad), world axes.
    pub fn deviations(&self) -> &[[DVec3; 4]] {
        match &self.made {
            Made::Estimated(made) => &made.made.data.estimate.deviations,
            Made::WithoutForces(made) => &made.found.deviations,
        }
    }

    /// Whether the motion of a sample is relied on to within its deviations, where that is known sample by sample.
    pub fn relied_on(&self) -> Option<&[bool]> {
        Some(&self.any_palms()?.estimate.relied_on)
    }

    /// Contact modes of the palms at these times: 0 (off), 1 (slides), 2 (sticks). Known of contacts of any palms.
    pub fn modes(&self) -> Option<Vec<Vec<u8>>> {
        let data = self.any_palms()?;
        let palms = data.log.palms().len();
        Some(
            data.estimate
                .modes
                .iter()
                .map(|modes| modes[..palms].iter().map(|m| m.number()).collect())
                .collect(),
        )
    }

    /// How probable it is at these times that each palm slides and that it sticks, as the file of the motion has it. Estimated of contacts
    /// of any palms.
    pub fn mode_probabilities(&self) -> Option<Vec<Vec<[f64; 2]>>> {
        let data = self.any_palms()?;
        mode_probabilities(&data.estimate, data.log.palms().len())
    }

    fn any_palms(&self) -> Option<&recon_io::EstimateData> {
        match &self.made {
            Made::Estimated(made) => Some(&made.made.data),
            _ => None,
        }
    }

    /// Where each palm touched the object at these times.
    pub fn contacts(&self) -> Vec<&[Option<PalmContact>]> {
        match &self.made {
            Made::Estimated(made) => made.made.data.curves.iter().map(Vec::as_slice).collect(),
            Made::WithoutForces(_) => Vec::new(),
        }
    }

    /// Bounds on the shape with their volumes; the meshes in them are for drawing.
    pub fn bounds(&self) -> Option<&Bounds> {
        match &self.made {
            Made::Estimated(made) => made.made.data.bounds.as_ref(),
            Made::WithoutForces(made) => made.bounded.as_ref().map(|bounded| &bounded.drawn),
        }
    }

    /// Surfaces of the lower and the upper bound, from all contacts.
    pub fn surfaces(&self) -> [Option<&TriangleMesh>; 2] {
        let bounded = match &self.made {
            Made::Estimated(made) => made.made.bounds.as_ref(),
            Made::WithoutForces(made) => made.bounded.as_ref(),
        };
        bounded.map_or([None, None], |bounds| [bounds.lower.as_ref(), bounds.upper.as_ref()])
    }

    /// Mass and inertia; none without forces.
    pub fn body(&self) -> Option<Body> {
        let Made::Estimated(made) = &self.made else { return None };
        let object = made.made.object().ok()?;
        let deviations = object.deviations.map(|of| (of.mass, of.inertia));
        Some(Body { mass: object.mass.mass(), inertia: object.mass.inertia(), deviations })
    }

    /// The page that the command writes.
    ///
    /// # Errors
    /// Where a number of it is not finite, which is a fault of recon.
    pub fn report(&self) -> Result<Vec<u8>, Failure> {
        let mut page = Vec::new();
        let written = match &self.made {
            Made::Estimated(made) => made.write_page(&mut page),
            Made::WithoutForces(made) => {
                write_figures_page(&without_forces_page(&self.log.title(), made), &mut page)
            }
        };
        written.map_err(CliError::Page)?;
        Ok(page)
    }

    /// Writes the folder that the command writes; `options` are `--force`, `--export`, `--export-shape`, `--mesh`, `--mcap` and
    /// `--covariance`.
    ///
    /// # Errors
    /// Where it cannot be written, or does not hold.
    pub fn write(&self, folder: &Path, options: &[String]) -> Result<(), Failure> {
        let args = arguments(options, Some(folder))?;
        let inputs = [self.log.path.clone()];
        let target = FolderTarget::new(folder, &inputs, args.force).map_err(CliError::from)?;
        match &self.made {
            Made::Estimated(made) => {
                let bag = args.mcap.then_some(self.log.loaded.epoch);
                let mut extras = made.extras(&args.export, args.export_shape, bag)?;
                extras.extend(meshes_as(made.surfaces(), &args.mesh)?);
                if args.covariance {
                    extras.push(made.covariances()?);
                }
                made.write(target, &extras)?;
            }
            Made::WithoutForces(made) => {
                made.write(target, &self.log.title())?;
            }
        }
        Ok(())
    }
}

/// Options of `recon reconstruct`.
pub(super) fn arguments(options: &[String], folder: Option<&Path>) -> Result<ReconstructArgs, Failure> {
    let mut words = options.to_vec();
    words.push("log".to_owned());
    match parsed("reconstruct", &words)? {
        Command::Reconstruct(args) => {
            Ok(ReconstructArgs { output: folder.map_or(args.output, Path::to_owned), ..args })
        }
        _ => Err(unlike("reconstruct")),
    }
}
