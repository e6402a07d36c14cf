//! The `[[palm]]` tables as they stand on disk.

use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::scene) struct PalmTable {
    pub(super) kind: KindName,
    pub(super) radius: Option<f64>,
    pub(super) friction: Option<f64>,
    pub(super) pose: Option<PoseTable>,
    pub(super) motion: Option<Vec<PartTable>>,
    /// Name of a file beside the scene.
    pub(super) poses: Option<String>,
    pub(super) spring: Option<SpringTable>,
    pub(super) motor: Option<MotorTable>,
}

#[derive(Clone, Copy, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase")]
pub(super) enum KindName {
    Flat,
    Sphere,
    Cup,
    Cylinder,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseTable {
    pub(super) position: [f64; 3],
    pub(super) orientation: Option<[f64; 4]>,
    pub(super) normal: Option<[f64; 3]>,
    pub(super) axis: Option<[f64; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PartTable {
    pub(super) shift: Option<[f64; 3]>,
    pub(super) turn: Option<[f64; 3]>,
    pub(super) pivot: Option<[f64; 3]>,
    pub(super) law: LawTable,
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase", deny_unknown_fields)]
pub(in crate::scene) enum LawTable {
    Constant {
        value: f64,
    },
    Steady {
        #[serde(default)]
        start: f64,
        rate: f64,
    },
    Sinusoid {
        #[serde(default)]
        mean: f64,
        amplitude: f64,
        frequency: f64,
        #[serde(default)]
        phase: f64,
    },
    Ramp {
        height: f64,
        start: f64,
        duration: f64,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SpringTable {
    pub(super) stiffness: Option<MatrixTable>,
    pub(super) damping: Option<MatrixTable>,
    pub(super) mass: Option<f64>,
}

/// A number for all directions, one for each world axis, or the whole matrix.
#[derive(Clone, Copy, Deserialize)]
#[serde(untagged, expecting = "a number, three numbers (one for each world axis) or three rows of three")]
pub(super) enum MatrixTable {
    Same(f64),
    Axes([f64; 3]),
    Rows([[f64; 3]; 3]),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotorTable {
    pub(super) pivot: [f64; 3],
    pub(super) axis: [f64; 3],
    pub(super) inertia: f64,
    pub(super) law: LawTable,
    #[serde(default)]
    pub(super) angle: f64,
    #[serde(default)]
    pub(super) rate: f64,
}
