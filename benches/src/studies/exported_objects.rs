//! Exported objects as simulators load them: mass, inertia and the shape that collides, from MJCF and URDF, in MuJoCo, Drake and the crate
//! `urdf-rs`.
//!
//! Arguments: objects a size. Needs Python with NumPy, MuJoCo and Drake. Writes a Markdown table.

use glam::{DMat3, DVec3};
use recon::object_dynamics::MassProperties;
use recon_io::{ExportFormat, ExportShape, ObjectModel, TriangleMesh};
use serde_json::Value;
use shape_bounds::generators::Source;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;

type Failure = Box<dyn Error>;

/// Mean sizes of the objects, m.
const SIZES: [f64; 4] = [0.003, 0.03, 0.3, 3.0];
/// Density of a uniform ellipsoid of the same mass and size, kg/m^3.
const DENSITY: f64 = 1000.0;
/// Name of the object, and of what is written of it.
const NAME: &str = "object";

pub(crate) fn main() -> Result<(), Failure> {
    let count: u64 = crate::words().next().map_or(Ok(5), |a| a.parse())?;
    let folder = std::env::temp_dir().join(format!("recon-exported-{}", std::process::id()));
    let table = table(&folder, count);
    // Also after an error; what cannot be removed is in a folder for such things.
    let _ = std::fs::remove_dir_all(&folder);
    print!("{}", table?);
    Ok(())
}

fn table(folder: &Path, count: u64) -> Result<String, Failure> {
    let mut objects = Vec::new();
    for size in SIZES {
        for k in 0..count {
            for of_mesh in [false, true] {
                let at = folder.join(format!("{}", objects.len()));
                objects.push(Exported::new(at, size, k, of_mesh)?);
            }
        }
    }
    let (mujoco, drake) = (Loader::new("mujoco"), Loader::new("drake"));
    let mut rows = String::new();
    let mut versions = Vec::new();
    for of_mesh in [false, true] {
        let of_kind: Vec<&Exported> = objects.iter().filter(|object| object.of_mesh == of_mesh).collect();
        let shape = if of_mesh { "mesh" } else { "ellipsoid" };
        for (format, file) in [("MJCF", "xml"), ("URDF", "urdf")] {
            for (name, loader) in [("MuJoCo", &mujoco), ("Drake", &drake)] {
                let paths = of_kind.iter().map(|object| object.folder.join(format!("{NAME}.{file}")));
                let (version, found) = loader.load(&paths.collect::<Vec<_>>())?;
                rows += &row(shape, format, &format!("{name} {version}"), &of_kind, &found)?;
                versions.push(format!("{name} {version}"));
            }
        }
        let read: Vec<Loaded> =
            of_kind.iter().map(|object| with_urdf_rs(object)).collect::<Result<_, _>>()?;
        rows += &row(shape, "URDF", "urdf-rs", &of_kind, &read)?;
    }
    Ok(format!(
        "# Exported objects in simulators\n\n\
         Made by `cargo xtask study exported_objects`: {} random objects of {SIZES:?} m ({count} of each size, once as an ellipsoid and once \
         as a mesh), written as `--export mjcf,urdf` does, as each loader takes them in (`tests/simulators/load.py`). Ellipsoids of any \
         centre and axes, inertia tensors that are full. Errors are the largest of all objects: of the mass and of the inertia as a share of \
         their size, of the centre of mass and of the extent (along ten directions, of what collides) as a share of the object's size.\n\n\
         | shape | file | loaded by | objects | mass | inertia | centre of mass | extent | warnings |\n|---|---|---|---|---|---|---|---|---|\n\
         {rows}\n\
         URDF knows no ellipsoids: that one is a mesh with its vertices on it, whose facets lie inside by up to 0.11 % of the size. MuJoCo keeps \
         vertices of meshes in single precision. `urdf-rs` reads no meshes: their extent is that of the file it names.\n",
        objects.len(),
    ))
}

/// The largest errors of one loader.
fn row(
    shape: &str,
    format: &str,
    loader: &str,
    objects: &[&Exported],
    found: &[Loaded],
) -> Result<String, Failure> {
    if objects.len() != found.len() {
        return Err(format!("{loader} took in {} of {} objects", found.len(), objects.len()).into());
    }
    let mut worst = [0.0_f64; 4];
    let mut warnings = 0;
    for (object, loaded) in objects.iter().zip(found) {
        for (worst, error) in worst.iter_mut().zip(object.errors(loaded)) {
            *worst = if error.is_nan() { f64::NAN } else { worst.max(error) };
        }
        warnings += loaded.warnings;
    }
    let worst =
        worst.map(|error| if error == 0.0 { "0".to_owned() } else { format!("{error:.1e}") }).join(" | ");
    Ok(format!("| {shape} | {format} | {loader} | {} | {worst} | {warnings} |\n", found.len()))
}

/// An object, and the folder with its files.
struct Exported {
    folder: PathBuf,
    size: f64,
    of_mesh: bool,
    model: ObjectModel,
    reach: Vec<f64>,
}

impl Exported {
    fn new(folder: PathBuf, size: f64, seed: u64, of_mesh: bool) -> Result<Self, Failure> {
        let mut source = Source::new(seed ^ size.to_bits());
        let mut near =
            |low: f64, high: f64| DVec3::from_array([0; 3].map(|_| size * source.between(low, high)));
        let (semi_axes, like) = (near(0.5, 1.5), near(0.5, 1.5));
        let centre = near(-0.2, 0.2);
        let (orientation, turned) = (source.rotation(), DMat3::from_quat(source.rotation()));
        let mass = 4.0 / 3.0 * std::f64::consts::PI * DENSITY * semi_axes.element_product();
        let tensor = turned * MassProperties::uniform_ellipsoid(mass, like)?.inertia() * turned.transpose();
        // The same on both sides of the diagonal, to the last digit.
        let tensor = (tensor + tensor.transpose()) * 0.5;
        let ellipsoid = ExportShape::Ellipsoid { centre, orientation, semi_axes };
        let net = TriangleMesh::net(7, 12, |unit| centre + orientation * (semi_axes * unit));
        let reach = match of_mesh {
            true => {
                directions().map(|d| net.vertices.iter().map(|v| v.dot(d)).fold(f64::MIN, f64::max)).to_vec()
            }
            false => directions()
                .map(|d| d.dot(centre) + (semi_axes * (orientation.inverse() * d)).length())
                .to_vec(),
        };
        let shape =
            if of_mesh { ExportShape::Mesh { name: "inner".to_owned(), mesh: net } } else { ellipsoid };
        let mass = MassProperties::new(mass, tensor)?;
        let (notes, seen) = (Vec::new(), Vec::new());
        let model =
            ObjectModel { name: NAME.to_owned(), notes, mass, deviations: None, shape, seen, start: None };
        std::fs::create_dir_all(&folder)?;
        for file in model.files(&[ExportFormat::Mjcf, ExportFormat::Urdf])? {
            std::fs::write(folder.join(file.name), file.contents)?;
        }
        Ok(Self { folder, size, of_mesh, model, reach })
    }

    /// Of mass, inertia, centre of mass and extent.
    fn errors(&self, loaded: &Loaded) -> [f64; 4] {
        let (mass, inertia) = (self.model.mass.mass(), self.model.mass.inertia());
        let norm = |m: DMat3| m.to_cols_array().map(|v| v * v).iter().sum::<f64>().sqrt();
        let reach = self.reach.iter().zip(&loaded.reach).map(|(own, found)| (own - found).abs());
        let reach = if loaded.reach.len() == self.reach.len() { reach.fold(0.0, f64::max) } else { f64::NAN };
        [
            (loaded.mass / mass - 1.0).abs(),
            norm(loaded.inertia - inertia) / norm(inertia),
            loaded.centre.length() / self.size,
            reach / self.size,
        ]
    }
}

/// Directions of the extents, those of `load.py`: the axes, two oblique ones, and against them.
fn directions() -> [DVec3; 10] {
    let along = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE, DVec3::new(-1.0, 2.0, 0.5)].map(DVec3::normalize);
    std::array::from_fn(|k| if k < 5 { along[k] } else { -along[k - 5] })
}

/// What a loader took in.
struct Loaded {
    mass: f64,
    inertia: DMat3,
    centre: DVec3,
    reach: Vec<f64>,
    warnings: usize,
}

/// A simulator with a loader in Python.
struct Loader(&'static str);

impl Loader {
    fn new(name: &'static str) -> Self {
        Self(name)
    }

    /// The simulator's version, and what it took in of each model.
    fn load(&self, paths: &[PathBuf]) -> Result<(String, Vec<Loaded>), Failure> {
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/simulators/load.py");
        let run = Command::new("python3").arg(script).args([self.0, NAME]).args(paths).output()?;
        if !run.status.success() {
            return Err(format!("{}: {}", self.0, String::from_utf8_lossy(&run.stderr)).into());
        }
        let told = String::from_utf8(run.stdout)?;
        let told: Vec<Value> = told.lines().map(serde_json::from_str).collect::<Result<_, _>>()?;
        let version = told.first().and_then(|first| first["version"].as_str()).unwrap_or_default().to_owned();
        Ok((version, told.iter().map(Loaded::of).collect()))
    }
}

impl Loaded {
    fn of(told: &Value) -> Self {
        let number = |value: &Value| value.as_str().and_then(|word| word.parse().ok()).unwrap_or(f64::NAN);
        let vector = |value: &Value| DVec3::from_array([0, 1, 2].map(|k| number(&value[k])));
        let column = |k: usize| vector(&told["inertia"][k]);
        // What collides is one shape.
        let one = told["colliding"] == 1;
        let reach = told["reach"].as_array().filter(|_| one).into_iter().flatten().map(number);
        Self {
            mass: number(&told["mass"]),
            inertia: DMat3::from_cols(column(0), column(1), column(2)),
            centre: vector(&told["centre"]),
            reach: reach.collect(),
            warnings: told["warnings"].as_array().map_or(0, Vec::len),
        }
    }
}

fn with_urdf_rs(object: &Exported) -> Result<Loaded, Failure> {
    let robot = urdf_rs::read_file(object.folder.join(format!("{NAME}.urdf")))?;
    let link =
        robot.links.iter().find(|link| link.name == NAME).ok_or("urdf-rs found no link of the object")?;
    let of = &link.inertial.inertia;
    let reach = match &link.collision[..] {
        [one] => reach_of(&object.folder, &one.geometry)?,
        _ => Vec::new(),
    };
    Ok(Loaded {
        mass: link.inertial.mass.value,
        inertia: DMat3::from_cols_array(&[
            of.ixx, of.ixy, of.ixz, of.ixy, of.iyy, of.iyz, of.ixz, of.iyz, of.izz,
        ]),
        centre: DVec3::from_array(link.inertial.origin.xyz.0),
        reach,
        warnings: 0,
    })
}

/// Extent of the vertices in the file that a geometry names.
fn reach_of(folder: &Path, geometry: &urdf_rs::Geometry) -> Result<Vec<f64>, Failure> {
    let urdf_rs::Geometry::Mesh { filename, .. } = geometry else { return Ok(Vec::new()) };
    let text = std::fs::read_to_string(folder.join(filename))?;
    let mut reach = [f64::MIN; 10];
    for line in text.lines().filter_map(|line| line.strip_prefix("v ")) {
        let numbers: Vec<f64> = line.split(' ').map(str::parse).collect::<Result<_, _>>()?;
        let [x, y, z] = numbers[..] else { return Err(format!("{filename}: no vertex: {line:?}").into()) };
        for (reach, direction) in reach.iter_mut().zip(directions()) {
            *reach = reach.max(direction.dot(DVec3::new(x, y, z)));
        }
    }
    Ok(reach.to_vec())
}
