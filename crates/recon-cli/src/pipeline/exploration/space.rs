//! Explorations in space.

use super::page::outline_panel;
use super::settings::Settings;
use super::side::{CONTACTS, Drawn, Side};
use crate::cli::PlannerAs;
use crate::error::CliError;
use crate::pipeline::bounds::{LOWER, UPPER};
use crate::pipeline::folder::Extra;
use crate::pipeline::views::{VIEWS, seen, silhouette};
use glam::DVec3;
use recon::contact_kinematics::Direction;
use recon::exploration::space::{
    FixedSweep, GaussianVariance, HausdorffGreedy, Noise, PathAware, RandomTouches, SpaceKnowledge,
    VolumeGreedy, turned_tetrahedron,
};
use recon::exploration::{Knowledge, Planner};
use recon::shape_bounds::ContactSample;
use recon_io::{FigurePanel, TriangleMesh, write_contacts};
use serde_json::{Value, json};

/// Space.
pub(crate) struct InSpace;

impl Side for InSpace {
    type Known = SpaceKnowledge;
    const DIMENSION: usize = 3;
    const UNIT: &'static str = "m³";

    fn nothing(settings: &Settings) -> Result<SpaceKnowledge, CliError> {
        Ok(match settings.stated_noise()? {
            Some(([point, normal], confidence)) => SpaceKnowledge::noisy(Noise { point, normal, confidence }),
            None => SpaceKnowledge::exact(),
        })
    }

    fn planner(settings: &Settings) -> Result<Box<dyn Planner<SpaceKnowledge>>, CliError> {
        let start = turned_tetrahedron(settings.seed);
        Ok(match settings.planner {
            PlannerAs::PathAware => Box::new(PathAware::new(start)),
            PlannerAs::Volume => Box::new(VolumeGreedy::new(start)),
            PlannerAs::Hausdorff => Box::new(HausdorffGreedy::new(start)),
            PlannerAs::Gaussian => Box::new(GaussianVariance::new(start)),
            PlannerAs::Sweep => Box::new(FixedSweep::new(start)),
            PlannerAs::Random => Box::new(RandomTouches::new(start, settings.seed)),
            PlannerAs::PerSecond | PlannerAs::PerRadian => {
                return Err(settings.planner.not_for("a finger that touches", "path-aware"));
            }
        })
    }

    fn heading(coordinates: &[f64]) -> Result<Direction, String> {
        match coordinates {
            [x, y, z] => Direction::new(DVec3::new(*x, *y, *z)).map_err(|e| e.to_string()),
            other => Err(format!("has {} components; in space it has three", other.len())),
        }
    }

    fn contact(contact: &ContactSample) -> [Vec<f64>; 2] {
        [contact.point.to_array().to_vec(), contact.normal.get().to_array().to_vec()]
    }

    fn normal(contact: &ContactSample) -> Direction {
        contact.normal
    }

    fn contacts(known: &SpaceKnowledge) -> &[ContactSample] {
        known.contacts()
    }

    fn point(point: DVec3) -> Vec<f64> {
        point.to_array().to_vec()
    }

    fn contacts_file(known: &SpaceKnowledge) -> Result<Extra, CliError> {
        let mut contacts = Vec::new();
        write_contacts(known.contacts(), &mut contacts).map_err(CliError::Page)?;
        Ok((CONTACTS.to_owned(), contacts))
    }

    fn drawn(known: &SpaceKnowledge) -> Result<Drawn, CliError> {
        let bounds = known.bounds();
        let lower = bounds.and_then(|b| b.lower().solid()).map(|s| s.mesh());
        let upper = bounds.and_then(|b| b.upper().bounded()).map(|p| p.mesh());
        let named = [(LOWER, lower), (UPPER, upper)].into_iter();
        let checked = named.filter_map(|(name, mesh)| {
            mesh.map(|m| TriangleMesh::new(m.vertices, m.triangles).map(|mesh| (name, mesh)))
        });
        Ok(Drawn { surfaces: checked.collect::<Result<_, _>>()?, ..Drawn::default() })
    }

    fn bounds(known: &SpaceKnowledge) -> Value {
        let measures = known.measures();
        let mut bounds = json!({ "lower_volume_m3": measures.lower, "upper_volume_m3": measures.upper });
        if measures.upper.is_finite() {
            bounds["lower_over_upper"] = (measures.lower / measures.upper).into();
            bounds["largest_gap_m"] = known.hausdorff().into();
        }
        bounds
    }

    /// Seen along three axes.
    fn pictures(known: &SpaceKnowledge, next: Option<&[f64]>) -> Vec<FigurePanel> {
        let bounds = known.bounds();
        let lower = bounds.and_then(|b| b.lower().solid()).map_or(&[][..], |s| s.vertices());
        let upper = bounds.and_then(|b| b.upper().bounded()).map_or(&[][..], |p| p.vertices());
        let one = |(title, axes): (&str, [usize; 2])| {
            let flat = |v: DVec3| seen(v, axes);
            let contacts = known.contacts().iter().map(|c| (flat(c.point), flat(c.normal.get()))).collect();
            let next = next.map(|n| axes.map(|axis| n[axis]));
            let names = axes.map(|axis| ["x", "y", "z"][axis]);
            let outlines = [lower, upper].map(|corners| silhouette(corners.iter().map(|v| flat(*v))));
            outline_panel(title, names, outlines, contacts, next)
        };
        VIEWS.into_iter().map(one).collect()
    }
}
