//! The scene file as it stands on disk; [`super::build`] turns it into a checked [`super::Scene`].

use super::palms::PalmTable as AnyPalmTable;
use serde::Deserialize;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneFile {
    pub(super) gravity: f64,
    #[serde(default)]
    pub(super) object: ObjectTable,
    #[serde(default)]
    pub(super) sensors: SensorsTable,
    #[serde(default)]
    pub(super) palms: PalmsTable,
    #[serde(default)]
    pub(super) palm: Vec<AnyPalmTable>,
    pub(super) simulation: Option<SimulationTable>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ObjectTable {
    pub(super) mass: Option<f64>,
    pub(super) inertia: Option<[[f64; 3]; 3]>,
    pub(super) principal_moments: Option<[f64; 3]>,
    pub(super) radii_of_gyration: Option<[f64; 3]>,
    pub(super) curvature_radii: Option<[f64; 2]>,
    pub(super) size: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SensorsTable {
    pub(super) contact_std: Option<f64>,
    pub(super) force_std: Option<f64>,
    pub(super) force_share: Option<f64>,
    pub(super) impulse_std: Option<f64>,
    pub(super) impulse_share: Option<f64>,
    pub(super) torque_std: Option<f64>,
    pub(super) contact_off_palm: Option<f64>,
    pub(super) contact_speed_std: Option<f64>,
    pub(super) sample_rate: Option<f64>,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PalmsTable {
    pub(super) inertia: Option<[f64; 3]>,
    pub(super) friction: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SimulationTable {
    pub(super) duration: f64,
    pub(super) sample_rate: Option<f64>,
    #[serde(default = "upright")]
    pub(super) orientation: [f64; 4],
    #[serde(default)]
    pub(super) angular_velocity: [f64; 3],
    #[serde(default)]
    pub(super) seed: u64,
    pub(super) position: Option<[f64; 3]>,
    pub(super) velocity: Option<[f64; 3]>,
    pub(super) in_flight: Option<bool>,
    pub(super) shape: ShapeTable,
    pub(super) palms: Option<Vec<PalmTable>>,
}

fn upright() -> [f64; 4] {
    [1.0, 0.0, 0.0, 0.0]
}

#[derive(Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub(super) enum ShapeTable {
    Sphere {
        radius: f64,
        #[serde(default)]
        offset: [f64; 3],
    },
    Ellipsoid {
        semi_axes: [f64; 3],
        #[serde(default)]
        offset: [f64; 3],
    },
    EllipsoidPlusBall {
        semi_axes: [f64; 3],
        radius: f64,
        #[serde(default)]
        offset: [f64; 3],
    },
    Polytope {
        corners: Vec<[f64; 3]>,
        radius: f64,
        sharpness: f64,
        #[serde(default)]
        offset: [f64; 3],
    },
    Polynomial {
        terms: Vec<TermTable>,
        #[serde(default)]
        offset: [f64; 3],
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct TermTable {
    pub(super) coefficient: f64,
    pub(super) powers: [u8; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PalmTable {
    pub(super) azimuth: Option<f64>,
    pub(super) azimuth_deg: Option<f64>,
    pub(super) slope: Option<f64>,
    pub(super) slope_deg: Option<f64>,
    pub(super) rate: Option<f64>,
    pub(super) sinusoid: Option<SinusoidTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SinusoidTable {
    pub(super) amplitude: f64,
    pub(super) frequency: f64,
    #[serde(default)]
    pub(super) phase: f64,
}
