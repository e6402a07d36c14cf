//! The scenes of the reference logs as `recon export` writes them, in MuJoCo: how far from our own motion.
//!
//! Arguments: the folder of the logs, seconds, scenes. Needs Python with MuJoCo and NumPy. Writes a Markdown table.

use crate::contact_logs::log::{Anything, Log};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, PalmSurface};
use recon::object_dynamics::{ContactScene, ContactStart, SampleTimes, ScenePalm};
use recon_io::{ExportShape, MotionState, ObjectModel, SceneModel};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

const TOLERANCE: f64 = 1e-8;

pub(crate) fn main() -> Anything<()> {
    let mut words = crate::words();
    let folder = PathBuf::from(words.next().ok_or("the folder of the logs is missing")?);
    let seconds: f64 = words.next().map_or(Ok(0.2), |s| s.parse())?;
    let mut names: Vec<String> = words.collect();
    if names.is_empty() {
        names = (1..=8).map(|k| format!("S{k}")).collect();
    }
    println!("# Exported scenes in MuJoCo");
    println!();
    println!(
        "The eight scenes of [contact-logs.md](contact-logs.md), exported as `recon export` does, {seconds} s in MuJoCo beside our own \
         motion at tolerance {TOLERANCE:e} (`tests/mujoco/scene.py`)."
    );
    println!();
    println!(
        "| scene | palms | centre moves (m) | departs (m) | object turns (rad) | departs (rad) | time in MuJoCo (s) |"
    );
    println!("|---|---|---|---|---|---|---|");
    for name in names {
        println!("| {name} | {} |", one(&folder, &name, seconds)?);
    }
    Ok(())
}

fn one(folder: &Path, name: &str, seconds: f64) -> Anything<String> {
    let log = Log::read(folder, name)?;
    let scene = log.scene()?;
    let (body, palms) = (log.body(0)?, log.palm_coordinates(0)?);
    let start = ContactStart { body, palms: Some(palms), in_flight: false };
    let ours = scene.simulate(&start, SampleTimes { duration: seconds, rate: 1000.0 }, TOLERANCE)?;
    let end = ours.instants.last().ok_or("no sample")?.state.body;
    let model = SceneModel {
        object: ObjectModel {
            name: name.to_owned(),
            notes: Vec::new(),
            mass: *scene.mass(),
            deviations: None,
            shape: ExportShape::Ellipsoid {
                centre: DVec3::ZERO,
                orientation: DQuat::IDENTITY,
                semi_axes: log.semi_axes(),
            },
            seen: Vec::new(),
            start: Some(MotionState::from(body)),
        },
        palms: scene.palms().to_vec(),
        start: palms,
        gravity: -scene.gravity().z,
    };
    let theirs = in_mujoco(&model, seconds)?;
    let (p, q) = (vector(&theirs["end"][name]), quaternion(&theirs["turn"][name]));
    Ok(format!(
        "{} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.1}",
        kinds(&scene),
        (end.p_WCm - body.p_WCm).length(),
        (end.p_WCm - p).length(),
        end.R_WO.angle_between(body.R_WO),
        end.R_WO.angle_between(q),
        theirs["wall"].as_f64().unwrap_or(f64::NAN),
    ))
}

/// Where the exported scene ends.
fn in_mujoco(model: &SceneModel, seconds: f64) -> Anything<Value> {
    let name = &model.object.name;
    let folder = std::env::temp_dir().join(format!("recon-export-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    for file in model.files()? {
        std::fs::write(folder.join(file.name), file.contents)?;
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/mujoco/scene.py");
    let mut command = Command::new("python3");
    let run =
        command.arg(script).arg(folder.join(format!("{name}.xml"))).arg(seconds.to_string()).output()?;
    std::fs::remove_dir_all(&folder)?;
    if !run.status.success() {
        return Err(format!("{name}: {}", String::from_utf8_lossy(&run.stderr)).into());
    }
    Ok(serde_json::from_slice(&run.stdout)?)
}

fn kinds(scene: &ContactScene<Ellipsoid>) -> String {
    let kind = |palm: &ScenePalm| match palm.surface {
        PalmSurface::Plane => "flat",
        PalmSurface::Sphere { .. } => "sphere",
        PalmSurface::Cup { .. } => "cup",
        PalmSurface::Cylinder { .. } => "cylinder",
    };
    scene.palms().iter().map(kind).collect::<Vec<_>>().join(", ")
}

fn vector(value: &Value) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|k| value[k].as_f64().unwrap_or(f64::NAN)))
}

/// MuJoCo's order: w first.
fn quaternion(value: &Value) -> DQuat {
    let [w, x, y, z] = [0, 1, 2, 3].map(|k| value[k].as_f64().unwrap_or(f64::NAN));
    DQuat::from_xyzw(x, y, z, w)
}
