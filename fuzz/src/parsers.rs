//! Parsers: a value or a typed error, whose words can be made, and never a panic.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::planar::PalmSurface as PlanarSurface;
use recon::contact_kinematics::{PalmSurface, SurfacePose};
use recon_io::{
    BagMapping, PalmSetup, PlanarScene, Scene, parse_any_log, parse_bag, parse_contact_log, parse_contacts,
    parse_log, parse_planar_contact_log, parse_planar_contacts, parse_planar_log, parse_poses,
};
use std::fmt::Display;

/// Whether it is a value; an error must have words.
fn is_value<T, E: Display>(parsed: Result<T, E>) -> bool {
    match parsed {
        Ok(_) => true,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    }
}

/// Text, or nothing is tried: these parsers take what is UTF-8 already.
fn is_value_of_text<T, E: Display>(bytes: &[u8], parse: impl Fn(&str) -> Result<T, E>) -> bool {
    std::str::from_utf8(bytes).is_ok_and(|text| is_value(parse(text)))
}

fn palms() -> [PalmSetup; 2] {
    let plane = PalmSetup {
        surface: PalmSurface::Plane,
        friction: Some(0.3),
        pose: None,
        hinge: None,
        largest_offset: f64::INFINITY,
    };
    // The second stands still unless the log says otherwise.
    [plane, PalmSetup { pose: SurfacePose::new(DVec3::ZERO, DQuat::IDENTITY).ok(), ..plane }]
}

pub(crate) fn log(bytes: &[u8]) -> bool {
    is_value(parse_log(bytes))
}

pub(crate) fn any_log(bytes: &[u8]) -> bool {
    is_value(parse_any_log(bytes, None))
}

pub(crate) fn contact_log(bytes: &[u8]) -> bool {
    is_value(parse_contact_log(bytes, &palms()))
}

pub(crate) fn planar_log(bytes: &[u8]) -> bool {
    is_value(parse_planar_log(bytes))
}

pub(crate) fn planar_contact_log(bytes: &[u8]) -> bool {
    is_value(parse_planar_contact_log(bytes, &[PlanarSurface::Line, PlanarSurface::Arc { radius: 0.1 }]))
}

pub(crate) fn contacts(bytes: &[u8]) -> bool {
    is_value(parse_contacts(bytes))
}

pub(crate) fn planar_contacts(bytes: &[u8]) -> bool {
    is_value(parse_planar_contacts(bytes))
}

pub(crate) fn poses(bytes: &[u8]) -> bool {
    is_value(parse_poses(bytes))
}

pub(crate) fn scene(bytes: &[u8]) -> bool {
    is_value_of_text(bytes, Scene::parse)
}

pub(crate) fn planar_scene(bytes: &[u8]) -> bool {
    is_value_of_text(bytes, PlanarScene::parse)
}

pub(crate) fn planar_known(bytes: &[u8]) -> bool {
    is_value_of_text(bytes, PlanarScene::parse_known)
}

pub(crate) fn bag_mapping(bytes: &[u8]) -> bool {
    is_value_of_text(bytes, BagMapping::parse)
}

pub(crate) fn bag(bytes: &[u8]) -> bool {
    is_value(parse_bag(bytes))
}
