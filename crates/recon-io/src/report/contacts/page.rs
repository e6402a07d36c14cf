use super::super::page::{Page, curves_section};
use super::bands::modes_section;
use super::moment::Shown;
use super::{plane, space};
use crate::number::brief_to;
use recon::contact_kinematics::SupportFunction;
use recon::contact_kinematics::planar::RadiusFunction;
use recon::object_dynamics::{ContactScene, ContactSimulation, planar};
use std::io::{self, Write};

const ENERGY: &str =
    "Kinetic and potential energy changes by the work that the palms' motion, friction and blows have done.";

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
    let body = shown.pictures.section(shown.caption)
        + &modes_section(
            &shown.spans,
            &shown.pictures.times(),
            None,
            &[],
            "Time in s. Dashed lines: the instants of the small pictures.",
        )
        + &curves_section("Forces, slip, energy", &shown.panels(), ENERGY);
    let (kicker, verdict) = ("Contact modes of a simulated motion", String::new());
    Page { kicker, title, verdict, facts: &facts, body }.write(to)
}
