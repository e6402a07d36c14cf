//! The scene file of the plane as it stands on disk.

use crate::scene::file::SensorsTable;
use crate::scene::palms::LawTable;
use serde::Deserialize;

/// Of any scene file: whether it is of the plane.
#[derive(Deserialize)]
pub(in crate::scene) struct Whether {
    #[serde(default)]
    pub(in crate::scene) plane: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PlanarFile {
    pub(super) plane: bool,
    pub(super) gravity: f64,
    pub(super) object: Option<ObjectTable>,
    #[serde(default)]
    pub(super) sensors: SensorsTable,
    #[serde(default)]
    pub(super) palms: PalmsTable,
    #[serde(default)]
    pub(super) palm: Vec<PalmTable>,
    pub(super) simulation: Option<SimulationTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    pub(super) mass: Option<f64>,
    pub(super) inertia: Option<f64>,
    pub(super) radius_of_gyration: Option<f64>,
    pub(super) size: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PalmsTable {
    pub(super) friction: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PalmTable {
    pub(super) kind: KindName,
    pub(super) radius: Option<f64>,
    pub(super) friction: Option<f64>,
    pub(super) pose: Option<PoseTable>,
    #[serde(default)]
    pub(super) motion: Vec<PartTable>,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(super) enum KindName {
    Line,
    Arc,
    Cup,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseTable {
    pub(super) position: [f64; 2],
    pub(super) angle: Option<f64>,
    pub(super) angle_deg: Option<f64>,
}

/// A shift along a direction, or a turn about a pivot.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartTable {
    pub(super) shift: Option<[f64; 2]>,
    pub(super) pivot: Option<[f64; 2]>,
    pub(super) law: LawTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SimulationTable {
    pub(super) duration: f64,
    pub(super) sample_rate: Option<f64>,
    pub(super) position: [f64; 2],
    pub(super) angle: Option<f64>,
    pub(super) angle_deg: Option<f64>,
    #[serde(default)]
    pub(super) velocity: [f64; 2],
    #[serde(default)]
    pub(super) angular_velocity: f64,
    pub(super) touches: Vec<usize>,
    #[serde(default)]
    pub(super) seed: u64,
    pub(super) shape: ShapeTable,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(super) enum ShapeTable {
    Circle {
        radius: f64,
        #[serde(default)]
        centre: [f64; 2],
    },
    Ellipse {
        semi_axes: [f64; 2],
        #[serde(default)]
        centre: [f64; 2],
    },
    Fourier {
        cosines: Vec<f64>,
        sines: Vec<f64>,
    },
    Polygon {
        corners: Vec<[f64; 2]>,
        corner_radius: f64,
        edge_half_angle: f64,
    },
}
