use super::super::page::{escape_text, fill, style};
use super::bands::bands;
use super::curves::{energy_defect, panels};
use super::picture::pictures;
use crate::number::brief_to;
use crate::planar_figures::write_figures;
use recon::contact_kinematics::SupportFunction;
use recon::object_dynamics::{ContactScene, ContactSimulation};
use std::io::{self, Write};

const PAGE: &str = include_str!("../assets/contacts.html");
const STYLE: &str = include_str!("../assets/contacts.css");
/// Instants that are shown as pictures.
const PICTURES: usize = 6;

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
    let instants = &simulation.instants;
    if instants.len() < 2 {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "a report needs at least two samples"));
    }
    let shown: Vec<_> = (0..PICTURES).map(|k| &instants[k * (instants.len() - 1) / (PICTURES - 1)]).collect();
    let marks: Vec<f64> = shown.iter().map(|now| now.state.t).collect();
    let mut curves = Vec::new();
    write_figures(&panels(scene, instants), &mut curves)?;
    let parts = [
        ("title", escape_text(title)),
        ("style", style() + STYLE),
        ("facts", facts(scene, simulation)),
        ("pictures", pictures(scene, &shown)),
        ("bands", bands(simulation, scene.palms().len(), &marks)),
        ("curves", String::from_utf8_lossy(&curves).into_owned()),
    ];
    fill(PAGE, &parts, to)
}

fn facts<S: SupportFunction>(scene: &ContactScene<S>, simulation: &ContactSimulation) -> String {
    let instants = &simulation.instants;
    let (first, last) = (&instants[0].state, &instants[instants.len() - 1].state);
    let turn = first.body.R_WO.angle_between(last.body.R_WO).to_degrees();
    let rows = [
        ("Samples", instants.len().to_string(), ""),
        ("Time", brief_to(4, last.t - first.t), "s"),
        ("Changes of modes", simulation.events.len().to_string(), ""),
        ("Turn at the end", brief_to(3, turn), "degrees"),
        ("Energy not accounted for", brief_to(2, energy_defect(scene, instants)), "J"),
    ];
    let row = |(name, value, unit): &(&str, String, &str)| {
        format!("<div><dt>{name}</dt><dd>{value}<small>{unit}</small></dd></div>\n")
    };
    rows.iter().map(row).collect()
}
