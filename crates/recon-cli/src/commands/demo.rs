use super::reconstruct::tell;
use crate::cli::{DemoArgs, DemoScene};
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{Asked, estimated_planes, simulate, simulate_contacts, write_contact_folder};
use crate::progress::Progress;
use recon_io::{FolderTarget, Scene, SceneError, SceneModel, SummaryOf, write_log};
use std::path::Path;

const SCENE: &str = "scene.toml";
/// Tolerance of the integration of the paper's scene.
const TOLERANCE: f64 = 1e-12;
/// Tolerance of that through contact modes: three tilting palms turn the object by the same angle to 1e-6 degrees at 1e-10.
const CONTACT_TOLERANCE: f64 = 1e-8;

pub(crate) fn run(args: &DemoArgs, console: &Console) -> Result<Outcome, CliError> {
    match args.scene {
        // The scene of the paper's Fig. 5, with what the paper leaves open filled in.
        DemoScene::Fig5 => fig5(args, include_str!("../../scenes/fig5.toml"), console),
        DemoScene::ThreeTiltingPalms => {
            let text = include_str!("../../scenes/three-tilting-palms.toml");
            any_palms(args, "Three tilting palms turn an ellipsoid over", text, console)
        }
        DemoScene::PickUp => {
            let text = include_str!("../../scenes/pick-up.toml");
            any_palms(args, "Three fingertips take an ellipsoid from a table", text, console)
        }
    }
}

fn fig5(args: &DemoArgs, text: &str, console: &Console) -> Result<Outcome, CliError> {
    let scene = Scene::parse(text).map_err(in_scene)?;
    let target = FolderTarget::new(&args.output, &[], args.force)?;
    let progress = Progress::new(4, console.is_quiet());
    progress.step("simulating");
    let simulated = simulate(&scene, Path::new(SCENE), TOLERANCE)?;
    let title = "An ellipsoid on three palms (Fig. 5 of Moll and Erdmann, 2002)";
    let mut log = Vec::new();
    write_log(&simulated.log, &mut log).map_err(CliError::StandardOutput)?;
    let asked = Asked {
        path: Path::new("log.csv"),
        scene: &scene,
        title,
        identify: false,
        accuracy: None,
        covariances: false,
    };
    let made = estimated_planes(simulated.log.into(), &asked, Vec::new(), &progress)?;
    progress.step("writing the results");
    let extras = [(SCENE.to_owned(), text.into()), ("log.csv".to_owned(), log)];
    let figures = made.write(target, &extras)?;
    drop(progress);
    tell(console, &made, figures, &args.output)
}

/// A scene of any palms: simulated and shown.
fn any_palms(args: &DemoArgs, title: &str, text: &str, console: &Console) -> Result<Outcome, CliError> {
    let scene = Scene::parse(text).map_err(in_scene)?;
    let target = FolderTarget::new(&args.output, &[], args.force)?;
    let progress = Progress::new(2, console.is_quiet());
    progress.step("simulating");
    let run = simulate_contacts(&scene, Path::new(SCENE), CONTACT_TOLERANCE)?;
    progress.step("writing the results");
    let mut extras = vec![(SCENE.to_owned(), text.into())];
    let model = SceneModel::new("scene", &scene).map_err(in_scene)?.files()?;
    extras.extend(model.into_iter().map(|file| (file.name, file.contents)));
    let told = run.told();
    let mut figures = SummaryOf::Simulation.named(told.figures());
    figures["title"] = title.into();
    write_contact_folder(target, title, &run, &extras, &figures)?;
    drop(progress);
    figures["folder"] = args.output.to_string_lossy().into();
    let turned = told.turn.to_degrees();
    let said = format!(
        "{title}\n{}\nturned by {turned:.1} degrees\n{}",
        told.describe(),
        args.output.join("report.html").display()
    );
    console.written(&said, &figures)?;
    Ok(Outcome::Done)
}

fn in_scene(kind: recon_io::SceneErrorKind) -> CliError {
    SceneError { path: SCENE.into(), kind }.into()
}
