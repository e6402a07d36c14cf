//! Scenes of an outline that a round finger follows: it need not be convex.

use super::{PlanarBody, PlanarScene, SceneError, SceneErrorKind};
use glam::DVec2;
use recon::exploration::contour::{ConvexOutline, OutlinePoint, SmoothOutline, SplineOutline, Waved};
use serde::Deserialize;
use std::f64::consts::TAU;
use std::path::Path;

/// An outline with the finger that follows it.
///
/// ```
/// # fn main() -> Result<(), recon_io::SceneErrorKind> {
/// let scene = recon_io::OutlineScene::parse(r#"
/// [finger]
/// radius = 0.008            # m; or --finger
///
/// [outline]                 # m; the curve that is twice differentiable through points, in either sense, at least 4
/// points = [[0.05, 0.0], [0.0, 0.02], [-0.05, 0.0], [0.0, -0.06]]
/// ## or waves: r = size (1 + depth cos(count angle))
/// ## waves = { size = 0.05, depth = 0.25, count = 3 }
/// "#)?;
/// assert_eq!(scene.finger, Some(0.008));
/// # Ok(())
/// # }
/// ```
/// A scene of the plane with the shape of an object serves as well: its outline is convex.
#[derive(Clone, Debug, PartialEq)]
pub struct OutlineScene {
    /// The outline.
    pub outline: AnyOutline,
    /// Radius of the finger, m, where it is stated.
    pub finger: Option<f64>,
}

/// An outline of a kind that is known when the program runs.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyOutline {
    /// Through points.
    Points(SplineOutline),
    /// A circle with waves.
    Waves(Waved),
    /// Of a convex object.
    Convex(PlanarBody),
}

impl SmoothOutline for AnyOutline {
    fn at(&self, t: f64) -> OutlinePoint {
        match self {
            Self::Points(outline) => outline.at(t),
            Self::Waves(outline) => outline.at(t),
            Self::Convex(body) => ConvexOutline(body).at(t),
        }
    }
}

/// Places by which the size of an outline is told.
const PLACES: u32 = 720;

impl AnyOutline {
    /// Half of its largest extent along the axes, m.
    #[must_use]
    pub fn size(&self) -> f64 {
        let points = (0..PLACES).map(|k| self.at(TAU * f64::from(k) / f64::from(PLACES)).point);
        let (low, high) =
            points.fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(low, high), p| (low.min(p), high.max(p)));
        0.5 * (high - low).max_element()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OutlineFile {
    #[serde(default)]
    finger: FingerTable,
    outline: OutlineTable,
}

#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FingerTable {
    radius: Option<f64>,
}

impl FingerTable {
    /// In m, where it is stated.
    pub(super) fn radius(&self) -> Result<Option<f64>, SceneErrorKind> {
        self.radius.map(|radius| SceneErrorKind::positive("finger.radius", radius)).transpose()
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct OutlineTable {
    points: Option<Vec<[f64; 2]>>,
    waves: Option<WavesTable>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WavesTable {
    size: f64,
    depth: f64,
    count: u32,
}

/// Of any scene file: whether it has an outline.
#[derive(Deserialize)]
struct Whether {
    outline: Option<toml::Table>,
    #[serde(default)]
    plane: bool,
}

impl OutlineScene {
    /// Reads a scene file with an outline, or of the plane.
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
        match toml::from_str(text)? {
            Whether { outline: Some(_), .. } => Self::of_file(toml::from_str(text)?),
            Whether { plane: true, .. } => {
                let body = PlanarScene::parse(text)?.world.object().shape.clone();
                Ok(Self { outline: AnyOutline::Convex(body), finger: None })
            }
            Whether { .. } => Err(SceneErrorKind::Missing {
                what: "`[outline]`",
                mend: "give it `points` or `waves`, or take a scene of the plane with the shape of an object",
            }),
        }
    }

    fn of_file(OutlineFile { finger, outline }: OutlineFile) -> Result<Self, SceneErrorKind> {
        let outline = match (outline.points, outline.waves) {
            (Some(points), None) => {
                let points: Vec<DVec2> = points.into_iter().map(DVec2::from).collect();
                AnyOutline::Points(SplineOutline::through(&points)?)
            }
            (None, Some(of)) => AnyOutline::Waves(waves(&of)?),
            (Some(_), Some(_)) => {
                let keys = ["`outline.points`", "`outline.waves`"].map(str::to_owned).to_vec();
                return Err(SceneErrorKind::Ambiguous { keys });
            }
            (None, None) => {
                return Err(SceneErrorKind::Missing {
                    what: "`outline.points`",
                    mend: "give at least 4 points in m, or `outline.waves`",
                });
            }
        };
        Ok(Self { outline, finger: finger.radius()? })
    }
}

fn waves(&WavesTable { size, depth, count }: &WavesTable) -> Result<Waved, SceneErrorKind> {
    let size = SceneErrorKind::positive("outline.waves.size", size)?;
    if !(0.0..1.0).contains(&depth) {
        let key = "outline.waves.depth".to_owned();
        return Err(SceneErrorKind::Value { key, value: depth, must: "at least 0 and below 1" });
    }
    if !(1..=MOST_WAVES).contains(&count) {
        let (key, value) = ("outline.waves.count".to_owned(), f64::from(count));
        return Err(SceneErrorKind::Value { key, value, must: "from 1 to 64" });
    }
    Ok(Waved { size, depth, waves: count })
}

/// More waves are finer than the simulated finger looks.
const MOST_WAVES: u32 = 64;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_outline_is_named_by_its_key() {
        let told = |text: &str| OutlineScene::parse(text).unwrap_err().to_string();
        assert!(told("gravity = 9.81").contains("`[outline]` is not given"));
        assert!(told("[outline]").contains("`outline.points` is not given"));
        assert!(told("[outline]\npoints = [[0, 0], [1, 0], [1, 1]]").contains("4 at least"));
        let both = "[outline]\npoints = []\nwaves = { size = 1.0, depth = 0.1, count = 3 }";
        assert!(told(both).contains("different ways to say the same"));
        let wave = |size: &str, depth: &str, count: &str| {
            told(&format!("[outline]\nwaves = {{ size = {size}, depth = {depth}, count = {count} }}"))
        };
        assert!(wave("0.0", "0.1", "3").contains("outline.waves.size"));
        assert!(wave("1.0", "1.0", "3").contains("outline.waves.depth"));
        assert!(wave("1.0", "0.1", "65").contains("outline.waves.count"));
        let finger = "[finger]\nradius = 0.0\n[outline]\nwaves = { size = 1.0, depth = 0.1, count = 3 }";
        assert!(told(finger).contains("`finger.radius` is 0"));
    }

    /// Half of the extent of `1 + 0.2 cos 2 t` is 1.2.
    #[test]
    fn the_size_is_half_of_the_extent() {
        let scene = OutlineScene::parse("[outline]\nwaves = { size = 1.0, depth = 0.2, count = 2 }").unwrap();
        assert!((scene.outline.size() - 1.2).abs() < 1e-12);
    }
}
