//! Scenes of a surface in space that a round finger comes down on: it need not be convex.

use super::outline::FingerTable;
use super::{SceneError, SceneErrorKind};
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::exploration::relief::{Wave, WavedBody};
use serde::Deserialize;
use std::path::Path;

/// A surface with the finger that comes down on it.
///
/// ```
/// # fn main() -> Result<(), recon_io::SceneErrorKind> {
/// let scene = recon_io::SurfaceScene::parse(r#"
/// [finger]
/// radius = 0.008            # m; or --finger
///
/// [surface]                 # at the distance size (1 + sum depth cos(count angle)) from its centre, the angle from the axis
/// size = 0.05               # m
/// waves = [{ axis = [0.0, 0.0, 1.0], depth = 0.3, count = 2 }]
/// "#)?;
/// assert_eq!(scene.finger, Some(0.008));
/// assert!((scene.reach() - 0.065).abs() < 1e-12);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceScene {
    /// The surface.
    pub surface: WavedBody,
    /// Radius of the finger, m, where it is stated.
    pub finger: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceFile {
    #[serde(default)]
    finger: FingerTable,
    surface: SurfaceTable,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceTable {
    size: f64,
    #[serde(default)]
    waves: Vec<WaveTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WaveTable {
    axis: [f64; 3],
    depth: f64,
    count: u32,
}

/// Of any scene file: whether it has a surface.
#[derive(Deserialize)]
struct Whether {
    surface: Option<toml::Table>,
}

/// More waves are finer than the simulated finger looks.
const MOST_WAVES: u32 = 16;

impl SurfaceScene {
    /// Reads a scene file with a surface.
    ///
    /// # Errors
    /// [`SceneError`] names the file and the key.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, SceneError> {
        SceneError::in_file(path.as_ref(), Self::parse)
    }

    /// The same from TOML text.
    ///
    /// # Errors
    /// [`SceneErrorKind`] names the key.
    pub fn parse(text: &str) -> Result<Self, SceneErrorKind> {
        if toml::from_str::<Whether>(text)?.surface.is_none() {
            return Err(SceneErrorKind::Missing {
                what: "`[surface]`",
                mend: "give it `size`, m, and `waves`",
            });
        }
        let SurfaceFile { finger, surface } = toml::from_str(text)?;
        let size = SceneErrorKind::positive("surface.size", surface.size)?;
        let waves = surface.waves.iter().enumerate().map(wave).collect::<Result<Vec<_>, _>>()?;
        let depth = waves.iter().map(|wave: &Wave| wave.depth.abs()).sum::<f64>();
        if depth >= 1.0 {
            let key = "surface.waves.depth, in all".to_owned();
            return Err(SceneErrorKind::Value { key, value: depth, must: "below 1" });
        }
        Ok(Self { surface: WavedBody { size, waves }, finger: finger.radius()? })
    }

    /// The surface is within this of its centre, m.
    #[must_use]
    pub fn reach(&self) -> f64 {
        self.surface.size * (1.0 + self.surface.waves.iter().map(|wave| wave.depth.abs()).sum::<f64>())
    }
}

fn wave((k, of): (usize, &WaveTable)) -> Result<Wave, SceneErrorKind> {
    let key = |name: &str| format!("surface.waves[{k}].{name}");
    let axis = Direction::new(DVec3::from(of.axis)).map_err(|_| SceneErrorKind::Value {
        key: key("axis"),
        value: DVec3::from(of.axis).length(),
        must: "of a length that is finite and not zero",
    })?;
    if !(of.depth > -1.0 && of.depth < 1.0) {
        return Err(SceneErrorKind::Value { key: key("depth"), value: of.depth, must: "between -1 and 1" });
    }
    if !(1..=MOST_WAVES).contains(&of.count) {
        let value = f64::from(of.count);
        return Err(SceneErrorKind::Value { key: key("count"), value, must: "from 1 to 16" });
    }
    Ok(Wave { axis, depth: of.depth, waves: of.count })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_surface_is_named_by_its_key() {
        let told = |text: &str| SurfaceScene::parse(text).unwrap_err().to_string();
        assert!(told("gravity = 9.81").contains("`[surface]` is not given"));
        assert!(told("[surface]\nsize = 0.0").contains("surface.size"));
        assert!(told("[finger]\nradius = -1.0\n[surface]\nsize = 1.0").contains("`finger.radius` is -1"));
        let wave = |axis: &str, depth: &str, count: &str| {
            let of = format!("{{ axis = {axis}, depth = {depth}, count = {count} }}");
            told(&format!("[surface]\nsize = 1.0\nwaves = [{of}, {of}]"))
        };
        assert!(wave("[0, 0, 0]", "0.1", "2").contains("surface.waves[0].axis"));
        assert!(wave("[0, 0, 1]", "nan", "2").contains("surface.waves[0].depth"));
        assert!(wave("[0, 0, 1]", "0.1", "0").contains("surface.waves[0].count"));
        assert!(wave("[0, 0, 1]", "0.5", "2").contains("in all"));
        assert!(wave("[0, 0]", "0.5", "2").contains("3"), "the axis has three numbers");
    }
}
