use super::super::page::{escape_text, fill, head};
use super::bands::{LEGEND, bands};
use super::moment::Shown;
use super::picture::drawn;
use super::{plane, space};
use crate::number::brief_to;
use crate::planar_figures::figures_in_page;
use recon::contact_kinematics::SupportFunction;
use recon::contact_kinematics::planar::RadiusFunction;
use recon::object_dynamics::{ContactScene, ContactSimulation, planar};
use std::io::{self, Write};

const PAGE: &str = include_str!("../assets/contacts.html");
pub(in crate::report) const STYLE: &str = include_str!("../assets/contacts.css");

/// Writes a simulation through contact modes as one HTML page that needs nothing else: pictures, bands of modes, curves of force,
/// slip and energy.
///
/// # Errors
/// Those of `to`, and [`io::ErrorKind::InvalidInput`] for a simulation of less than two samples.
pub fn write_contact_report<S: SupportFunction>(
    title: &str,
    scene: &ContactScene<S>,
    simulation: &ContactSimulation,
    to: impl Write,
) -> io::Result<()> {
    write(title, &space::shown(scene, simulation), to)
}

/// The same in the plane.
///
/// # Errors
/// As [`write_contact_report`].
pub fn write_planar_contact_report<S: RadiusFunction>(
    title: &str,
    scene: &planar::ContactScene<S>,
    simulation: &planar::ContactSimulation,
    to: impl Write,
) -> io::Result<()> {
    write(title, &plane::shown(scene, simulation), to)
}

fn write(title: &str, shown: &Shown, to: impl Write) -> io::Result<()> {
    let [first, .., last] = &shown.moments[..] else {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a report needs at least two samples"));
    };
    let facts = [
        ("Samples", shown.moments.len().to_string(), ""),
        ("Time", brief_to(4, last.t - first.t), "s"),
        ("Changes of modes", shown.changes.to_string(), ""),
        ("Turn at the end", brief_to(3, last.turn.to_degrees()), "degrees"),
        ("Energy not accounted for", brief_to(2, shown.energy_defect()), "J"),
    ];
    let marks: Vec<f64> = shown.pictures.iter().map(|picture| picture.t).collect();
    let parts = [
        ("head", head(title, STYLE)?),
        ("title", escape_text(title)),
        ("facts", facts.iter().map(fact).collect()),
        ("pictures", drawn(&shown.pictures)),
        ("caption", shown.caption.to_owned()),
        ("legend", LEGEND.to_owned()),
        ("bands", bands(&shown.spans, &marks, &[])),
        ("curves", figures_in_page(&shown.panels())?),
    ];
    fill(PAGE, &parts, to)
}

/// A key figure: name, value and unit.
pub(in crate::report) fn fact((name, value, unit): &(&str, String, &str)) -> String {
    format!("<div><dt>{name}</dt><dd>{value}<small>{unit}</small></dd></div>\n")
}
