//! The way from measured contacts to bounds, as `recon bounds` goes it, and what came of it.

use super::Case;
use shape_bounds::noise::{
    CertainBounds, ContactNoise, NoiseError, NoisyContact, Outlier, correlated_noise, estimate_noise,
    independence_is_tested, with_noise_as_found, without_outliers,
};

/// Where the levels of noise come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// As stated.
    Stated,
    /// From the contacts.
    Estimated,
}

/// What came of measured contacts.
pub struct Bounded {
    /// The bounds.
    pub bounds: CertainBounds,
    /// The contacts left out.
    pub outliers: Vec<Outlier>,
    /// Whether a warning says that noise is not as stated or may not be.
    pub warned: bool,
}

/// What became of the runs of one row with as many contacts each.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Runs with bounds; the others are refused with an error.
    pub bounded: usize,
    /// Of these, both bounds hold.
    pub hold: usize,
    /// Of these, noise is said to be not as stated, or not to be tested.
    pub warned: usize,
    /// One of the bounds fails without that warning.
    pub silent: usize,
    /// Wrong contacts in runs with bounds.
    pub wrong: usize,
    /// Of these, left out.
    pub found: usize,
    /// Right contacts that are left out.
    pub taken: usize,
}

impl Tally {
    /// Of one run.
    #[must_use]
    pub fn of(case: &Case, levels: Levels, confidence: f64) -> Self {
        // Refused: the contacts contradict what is stated or assumed by more than can be mended.
        let Ok(Some(run)) = bounded(case, levels, confidence) else { return Self::default() };
        let holds = case.body.is_between(&run.bounds);
        let found = run.outliers.iter().filter(|o| case.wrong[o.curve][o.index].is_some()).count();
        Self {
            bounded: 1,
            hold: usize::from(holds),
            warned: usize::from(run.warned),
            silent: usize::from(!holds && !run.warned),
            wrong: case.wrong.iter().flatten().flatten().count(),
            found,
            taken: run.outliers.len() - found,
        }
    }

    /// All of them.
    pub fn counts(&mut self) -> [&mut usize; 7] {
        let Self { bounded, hold, warned, silent, wrong, found, taken } = self;
        [bounded, hold, warned, silent, wrong, found, taken]
    }
}

/// Contacts that are left of a case where noise is as found, as the command leaves them.
pub struct Cleaned {
    /// In curves, with their noise.
    pub kept: Vec<Vec<NoisyContact>>,
    /// Contacts that are taken for wrong.
    pub outliers: Vec<Outlier>,
    /// Whether noise is alike from contact to contact.
    pub correlated: bool,
    /// Whether anything is said of the noise.
    pub warned: bool,
}

/// Contacts of a case whose noise is as found and which are not taken for wrong; `None` where estimated noise is alike from contact to contact.
///
/// # Errors
/// Those of the bounds.
pub fn cleaned(case: &Case, levels: Levels, confidence: f64) -> Result<Option<Cleaned>, NoiseError> {
    let noisy = match levels {
        Levels::Stated => stated(case),
        Levels::Estimated => estimate_noise(&case.curves, confidence)?,
    };
    let estimated = levels == Levels::Estimated;
    let correlated = correlated_noise(&noisy).is_some();
    if correlated && estimated {
        return Ok(None);
    }
    let (noisy, doubts) = with_noise_as_found(&noisy);
    let untested = estimated && !independence_is_tested(&noisy);
    let (kept, outliers) = without_outliers(&noisy, confidence)?;
    Ok(Some(Cleaned { kept, outliers, correlated, warned: correlated || untested || !doubts.is_empty() }))
}

/// None where estimated noise is alike from one contact to the next: the estimate says nothing then.
///
/// # Errors
/// For contacts that contradict what is stated or assumed by more than can be mended.
pub fn bounded(case: &Case, levels: Levels, confidence: f64) -> Result<Option<Bounded>, NoiseError> {
    let Some(Cleaned { kept, outliers, correlated, warned }) = cleaned(case, levels, confidence)? else {
        return Ok(None);
    };
    let bounds = if correlated {
        CertainBounds::from_correlated_curves(&kept, confidence)?
    } else {
        CertainBounds::from_noisy_curves(&kept, confidence)?
    };
    Ok(Some(Bounded { bounds, outliers, warned }))
}

fn stated(case: &Case) -> Vec<Vec<NoisyContact>> {
    let noise = ContactNoise::isotropic(case.point_sd, case.normal_sd);
    let with = |contact: &_| NoisyContact { contact: *contact, noise };
    case.curves.iter().map(|curve| curve.iter().map(with).collect()).collect()
}
