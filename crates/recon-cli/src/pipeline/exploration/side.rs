//! What explorations in space and in the plane do differently.

use super::settings::Settings;
use crate::error::CliError;
use crate::pipeline::bounds::LOWER;
use crate::pipeline::folder::Extra;
use glam::DVec2;
use recon::exploration::{Finger, Knowledge, Planner};
use recon_io::{FigurePanel, TriangleMesh, check_unwritten, write_ply};
use serde_json::Value;

/// The file of contacts.
pub(crate) const CONTACTS: &str = "contacts.csv";

/// Space, or the plane.
pub(crate) trait Side {
    /// Contacts and bounds.
    type Known: Knowledge;
    /// 2 or 3.
    const DIMENSION: usize;
    /// What the bounds are measured in.
    const UNIT: &'static str;

    /// No contacts, of the noise that is stated.
    fn nothing(settings: &Settings) -> Result<Self::Known, CliError>;

    /// The planner that is asked for, if it is one of touches.
    fn planner(settings: &Settings) -> Result<Box<dyn Planner<Self::Known>>, CliError>;

    /// A direction from its coordinates, or what is wrong with them.
    fn heading(coordinates: &[f64]) -> Result<<Self::Known as Knowledge>::Heading, String>;

    /// Point and normal of a contact.
    fn contact(contact: &<Self::Known as Knowledge>::Contact) -> [Vec<f64>; 2];

    /// The normal of a contact as a direction of touch.
    fn normal(contact: &<Self::Known as Knowledge>::Contact) -> <Self::Known as Knowledge>::Heading;

    /// All contacts.
    fn contacts(known: &Self::Known) -> &[<Self::Known as Knowledge>::Contact];

    /// Coordinates of a place.
    fn point(point: <Self::Known as Knowledge>::Point) -> Vec<f64>;

    /// The contacts as a file.
    fn contacts_file(known: &Self::Known) -> Result<Extra, CliError>;

    /// The bounds that there are.
    fn drawn(known: &Self::Known) -> Result<Drawn, CliError>;

    /// Sizes of the bounds, as the check of a folder looks for them.
    fn bounds(known: &Self::Known) -> Value;

    /// The bounds with the contacts, and the direction of the next touch.
    fn pictures(known: &Self::Known, next: Option<&[f64]>) -> Vec<FigurePanel>;
}

/// Bounds as surfaces or outlines, each with the name of its file.
#[derive(Default)]
pub(crate) struct Drawn {
    pub(crate) surfaces: Vec<(&'static str, TriangleMesh)>,
    pub(crate) outlines: Vec<(&'static str, Vec<DVec2>)>,
}

impl Drawn {
    /// As files.
    pub(super) fn files(&self) -> Result<Vec<Extra>, CliError> {
        let mut files = Vec::new();
        for (name, mesh) in &self.surfaces {
            let mut file = Vec::new();
            let where_it_is = if *name == LOWER { "inside the object" } else { "around the object" };
            write_ply(mesh, &format!("{where_it_is}; metres"), &mut file).map_err(CliError::Page)?;
            files.push(((*name).to_owned(), file));
        }
        for (name, corners) in &self.outlines {
            let rows = corners.iter().map(|p| format!("{:?},{:?}\n", p.x, p.y));
            let text: String = std::iter::once("x,y\n".to_owned()).chain(rows).collect();
            files.push(((*name).to_owned(), text.into_bytes()));
        }
        Ok(files)
    }

    /// Checks what is stated of them, where no folder is written.
    pub(crate) fn check(&self, figures: &Value) -> Result<(), CliError> {
        let surfaces: Vec<_> = self.surfaces.iter().map(|(name, mesh)| (*name, mesh)).collect();
        let outlines: Vec<_> = self.outlines.iter().map(|(name, corners)| (*name, &corners[..])).collect();
        Ok(check_unwritten(figures, &surfaces, &outlines)?)
    }
}

/// A finger of one side.
pub(crate) type AnyFinger<'a, S> = dyn Finger<<S as Side>::Known> + 'a;
