//! `recon init`: files to begin from.

use crate::cli::InitArgs;
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{simulate, write_files_folder};
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::shape_bounds::ContactSample;
use recon_io::{FolderTarget, Scene, SceneError, SummaryOf, write_contacts, write_log};
use serde_json::json;
use std::path::Path;

const SCENE: &str = "scene.toml";
const TEXT: &str = include_str!("../../scenes/init.toml");
/// Tolerance of the integration.
const TOLERANCE: f64 = 1e-12;
/// Contacts in the list.
const CONTACTS: u32 = 200;

pub(crate) fn run(args: &InitArgs, console: &Console) -> Result<Outcome, CliError> {
    let target = FolderTarget::new(&args.folder, &[], args.force)?;
    let scene = Scene::parse(TEXT).map_err(|kind| SceneError { path: SCENE.into(), kind })?;
    let (mut log, mut list) = (Vec::new(), Vec::new());
    write_log(&simulate(&scene, Path::new(SCENE), TOLERANCE)?.log, &mut log)
        .map_err(CliError::StandardOutput)?;
    write_contacts(&contacts(&scene)?, &mut list).map_err(CliError::StandardOutput)?;
    let folder = args.folder.display();
    let commands = [
        format!("recon check-input {folder}/log.csv --scene {folder}/scene.toml"),
        format!("recon reconstruct {folder}/log.csv --scene {folder}/scene.toml -o out"),
        format!("recon bounds {folder}/contacts.csv --fit auto -o bounds"),
        format!("recon simulate {folder}/scene.toml -o log.csv"),
    ];
    let figures = SummaryOf::Start.named(json!({ "next": commands }));
    let files = [
        (SCENE.to_owned(), TEXT.as_bytes().to_vec()),
        ("log.csv".to_owned(), log),
        ("contacts.csv".to_owned(), list),
    ];
    write_files_folder(target, &files, &figures)?;
    let told = [
        "scene.toml     what is known of a scene, each key explained",
        "log.csv        what three palms felt in it (columns: recon formats log)",
        "contacts.csv   points with outward normals (columns: recon formats contacts)",
    ];
    let text = format!("{folder}\n  {}\nGo on with\n  {}", told.join("\n  "), commands.join("\n  "));
    console.written(&text, &figures)?;
    Ok(Outcome::Done)
}

/// Contacts all over the object of the scene, on a spiral of normals (Fibonacci lattice).
fn contacts(scene: &Scene) -> Result<Vec<ContactSample>, CliError> {
    let Some(simulation) = &scene.simulation else {
        return Err(CliError::NothingToSimulate { path: SCENE.into() });
    };
    let body = simulation.body()?;
    let golden = std::f64::consts::PI * (3.0 - f64::sqrt(5.0));
    let contact = |k: u32| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(CONTACTS);
        let (sin, cos) = (golden * f64::from(k)).sin_cos();
        let across = (1.0 - z * z).sqrt();
        let normal = Direction::new_unchecked(glam::DVec3::new(across * cos, across * sin, z));
        ContactSample { point: body.point(normal), normal }
    };
    Ok((0..CONTACTS).map(contact).collect())
}
