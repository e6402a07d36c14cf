use super::KnownPalm;
use super::drive::drive;
use super::file::{KindName, PalmTable};
use crate::scene::SceneErrorKind as Kind;
use recon::contact_kinematics::{CurvatureRadii, PalmSurface};
use std::path::Path;

/// Checks every number of the `[[palm]]` tables of a scene in `folder`; palms that say nothing of friction have that of all.
pub(in crate::scene) fn palms(
    tables: Vec<PalmTable>,
    friction: Option<f64>,
    folder: &Path,
) -> Result<Option<Vec<KnownPalm>>, Kind> {
    if tables.is_empty() {
        return Ok(None);
    }
    let palm = |(i, table): (usize, PalmTable)| Keys { palm: i + 1 }.palm(&table, friction, folder);
    tables.into_iter().enumerate().map(palm).collect::<Result<_, _>>().map(Some)
}

/// The keys of one palm, for errors.
#[derive(Clone, Copy)]
pub(super) struct Keys {
    /// Number from 1.
    pub(super) palm: usize,
}

impl Keys {
    /// Full path of a key.
    pub(super) fn path(self, key: &str) -> String {
        format!("palm[{}].{key}", self.palm)
    }

    pub(super) fn missing(self, key: &'static str) -> Kind {
        Kind::MissingOfPalm { palm: self.palm, key }
    }

    pub(super) fn ambiguous(self, keys: &[&str]) -> Kind {
        Kind::Ambiguous { keys: keys.iter().map(|key| format!("`{}`", self.path(key))).collect() }
    }

    fn palm(self, table: &PalmTable, friction: Option<f64>, folder: &Path) -> Result<KnownPalm, Kind> {
        let palm = self.palm;
        let surface = self.surface(table)?;
        let own = table.friction.map(|f| Kind::not_negative(&self.path("friction"), f)).transpose()?;
        let drive = drive(self, table, folder)?;
        if let Some(drive) = &drive {
            drive.check().map_err(|source| Kind::PalmDrive { palm, source })?;
        }
        Ok(KnownPalm { surface, friction: own.or(friction), drive })
    }

    fn surface(self, table: &PalmTable) -> Result<PalmSurface, Kind> {
        let radius = || table.radius.ok_or(self.missing("radius"));
        let surface = match table.kind {
            KindName::Flat => {
                if let Some(radius) = table.radius {
                    let must = "left out: a flat palm has none";
                    return Kind::check(&self.path("radius"), radius, must, |_| false)
                        .map(|_| PalmSurface::Plane);
                }
                PalmSurface::Plane
            }
            KindName::Sphere => PalmSurface::Sphere { radius: radius()? },
            KindName::Cup => PalmSurface::Cup { radius: radius()? },
            KindName::Cylinder => PalmSurface::Cylinder { radius: radius()? },
        };
        // The object is not known here: of one without any extent.
        let none = CurvatureRadii { min: 0.0, max: 0.0 };
        surface.check(none).map_err(|source| Kind::PalmSurface { palm: self.palm, source })?;
        Ok(surface)
    }
}
