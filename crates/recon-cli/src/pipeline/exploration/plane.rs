//! Explorations in the plane.

use super::page::outline_panel;
use super::settings::Settings;
use super::side::{CONTACTS, Drawn, Side};
use crate::cli::PlannerAs;
use crate::error::CliError;
use crate::pipeline::folder::Extra;
use glam::DVec2;
use recon::exploration::planar::{
    AreaGreedy, FixedSweep, GaussianVariance, HausdorffGreedy, Noise, PathAware, PlanarKnowledge,
    RandomTouches, turned_start,
};
use recon::exploration::{Knowledge, Planner};
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::ContactSample;
use recon_io::FigurePanel;
use serde_json::{Value, json};
use std::fmt::Write;

/// Directions of the start: cells are halved from there, and ten are the least that ten per cent take.
const START: usize = 5;

/// The plane.
pub(crate) struct InPlane;

impl Side for InPlane {
    type Known = PlanarKnowledge;
    const DIMENSION: usize = 2;
    const UNIT: &'static str = "m²";

    fn nothing(settings: &Settings) -> Result<PlanarKnowledge, CliError> {
        Ok(match settings.stated_noise()? {
            Some(([point, normal], confidence)) => {
                PlanarKnowledge::noisy(Noise { point, normal, confidence })
            }
            None => PlanarKnowledge::exact(),
        })
    }

    fn planner(settings: &Settings) -> Result<Box<dyn Planner<PlanarKnowledge>>, CliError> {
        let start = turned_start(START, settings.seed);
        Ok(match settings.planner {
            PlannerAs::PathAware => Box::new(PathAware::new(start)),
            PlannerAs::Volume => Box::new(AreaGreedy::new(start)),
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
            [x, y] => Direction::new(DVec2::new(*x, *y)).map_err(|e| e.to_string()),
            other => Err(format!("has {} components; in the plane it has two", other.len())),
        }
    }

    fn contact(contact: &ContactSample) -> [Vec<f64>; 2] {
        [contact.point.to_array().to_vec(), contact.normal.get().to_array().to_vec()]
    }

    fn normal(contact: &ContactSample) -> Direction {
        contact.normal
    }

    fn contacts(known: &PlanarKnowledge) -> &[ContactSample] {
        known.contacts()
    }

    fn point(point: DVec2) -> Vec<f64> {
        point.to_array().to_vec()
    }

    fn contacts_file(known: &PlanarKnowledge) -> Result<Extra, CliError> {
        let mut contacts = String::from("x,y,nx,ny\n");
        for c in known.contacts() {
            let (p, n) = (c.point, c.normal.get());
            let _ = writeln!(contacts, "{:?},{:?},{:?},{:?}", p.x, p.y, n.x, n.y);
        }
        Ok((CONTACTS.to_owned(), contacts.into_bytes()))
    }

    fn drawn(known: &PlanarKnowledge) -> Result<Drawn, CliError> {
        let named = [("lower_bound.csv", lower(known)), ("upper_bound.csv", upper(known))];
        let outlines = named.into_iter().filter(|(_, corners)| !corners.is_empty()).collect();
        Ok(Drawn { outlines, ..Drawn::default() })
    }

    fn bounds(known: &PlanarKnowledge) -> Value {
        let measures = known.measures();
        let mut bounds = json!({ "lower_area_m2": measures.lower, "upper_area_m2": measures.upper });
        if measures.upper.is_finite() {
            bounds["lower_over_upper"] = (measures.lower / measures.upper).into();
            bounds["largest_gap_m"] = known.hausdorff().into();
        }
        bounds
    }

    fn pictures(known: &PlanarKnowledge, next: Option<&[f64]>) -> Vec<FigurePanel> {
        let flat = |corners: Vec<DVec2>| corners.iter().map(DVec2::to_array).collect::<Vec<_>>();
        let contacts =
            known.contacts().iter().map(|c| (c.point.to_array(), c.normal.get().to_array())).collect();
        let next = next.and_then(|n| <[f64; 2]>::try_from(n).ok());
        let outlines = [flat(lower(known)), flat(upper(known))];
        vec![outline_panel("Where it was touched", ["x", "y"], outlines, contacts, next)]
    }
}

/// Corners of the lower bound, counter-clockwise; none without one.
pub(super) fn lower(known: &PlanarKnowledge) -> Vec<DVec2> {
    let polygon = known.bounds().and_then(|b| b.lower().polygon());
    polygon.map_or_else(Vec::new, |p| p.shape().vertices().to_vec())
}

/// Corners of the upper bound.
pub(super) fn upper(known: &PlanarKnowledge) -> Vec<DVec2> {
    let region = known.bounds().and_then(|b| b.upper().bounded());
    region.map_or_else(Vec::new, |r| r.shape().vertices().to_vec())
}
