//! Sets of tosses: which there are, and what they hold.

use super::body::Body;
use recon::shape_bounds::exact_hull::HalfSpace;
use recon::shape_bounds::poses::{BodyPose, half_space_above_plane};
use recon_io::parse_poses;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

pub(crate) const TOSSES: u32 = 100;

/// A family of bodies, whether its sets calibrate or check, and for each tracker the seeds of its sets.
struct Family {
    name: &'static str,
    calibrates: bool,
    nominal: u32,
    worse: u32,
}

const FAMILIES: [Family; 7] = [
    Family { name: "ellipsoid", calibrates: true, nominal: 25, worse: 10 },
    Family { name: "capsule", calibrates: true, nominal: 25, worse: 10 },
    Family { name: "cylinder", calibrates: true, nominal: 25, worse: 10 },
    Family { name: "polyhedron", calibrates: true, nominal: 25, worse: 10 },
    Family { name: "box", calibrates: false, nominal: 15, worse: 6 },
    Family { name: "tetrahedron", calibrates: false, nominal: 15, worse: 6 },
    Family { name: "prism", calibrates: false, nominal: 15, worse: 0 },
];
/// The second tracker's errors over those of the first.
pub(crate) const WORSE: u32 = 4;
/// First seed of its sets.
const FIRST_WORSE: u32 = 1000;

/// One set of tosses of one body.
pub(crate) struct Set {
    pub(crate) family: &'static str,
    pub(crate) calibrates: bool,
    /// Errors of its tracker, over those of the first.
    pub(crate) tracker: u32,
    seed: u32,
}

/// What was tracked and what was true.
pub(crate) struct Tosses {
    pub(crate) body: Body,
    pub(crate) runs: Vec<Vec<BodyPose>>,
    /// The half-spaces of the true poses.
    pub(crate) exact: Vec<HalfSpace>,
}

/// All sets, of each family at most `most` for each tracker.
pub(crate) fn sets(most: u32) -> Vec<Set> {
    let of_family = |family: &'static Family| {
        let set = |tracker, seed| Set { family: family.name, calibrates: family.calibrates, tracker, seed };
        let nominal = (0..family.nominal.min(most)).map(move |seed| set(1, seed));
        nominal.chain((0..family.worse.min(most)).map(move |seed| set(WORSE, FIRST_WORSE + seed)))
    };
    FAMILIES.iter().flat_map(of_family).collect()
}

impl Set {
    /// Reads the set from the folder, where it is simulated first if it is not there.
    pub(crate) fn load(&self, folder: &Path) -> Result<Tosses, Box<dyn Error>> {
        let folder = folder.join(self.tracker.to_string());
        let file =
            |ending: &str| -> PathBuf { folder.join(format!("{}-{}.{ending}", self.family, self.seed)) };
        if !file("body").is_file() {
            self.simulate(&folder)?;
        }
        let runs = parse_poses(fs::File::open(file("csv"))?)?;
        let truth = parse_poses(fs::File::open(file("true.csv"))?)?;
        let exact = truth.iter().flatten().map(|pose| half_space_above_plane(pose, 0.0)).collect();
        Ok(Tosses { body: Body::parse(&fs::read_to_string(file("body"))?)?, runs, exact })
    }

    fn simulate(&self, folder: &Path) -> Result<(), Box<dyn Error>> {
        fs::create_dir_all(folder)?;
        let script = concat!(env!("CARGO_MANIFEST_DIR"), "/peers/tosses.py");
        let numbers = [TOSSES, self.seed, 1, self.tracker].map(|n| n.to_string());
        let output =
            Command::new("python3").arg(script).arg(folder).arg(self.family).args(numbers).output()?;
        if output.status.success() {
            return Ok(());
        }
        let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
        Err(format!("{script} needs Python with MuJoCo and SciPy: {complaint}").into())
    }
}
