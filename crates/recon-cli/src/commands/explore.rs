use super::answers::written_to;
use crate::cli::{ExploreArgs, PlannerAs, Until};
use crate::console::Console;
use crate::error::{CliError, Outcome};
use crate::pipeline::{
    CONFIDENCE, Descending, Explored, Following, InPlane, InSpace, Settings, explored, felt, followed,
    goal_of, rolled, sensed, stroked, write_files_folder,
};
use crate::progress::Progress;
use glam::{DVec2, DVec3};
use recon::contact_kinematics::planar::RadiusFunction;
use recon::contact_kinematics::{Direction, SupportFunction};
use recon::exploration::parallel::{
    EstimatedPalms, ParallelError, ParallelWorkspace, SimulatedParallelPalms,
};
use recon::exploration::rolling::{RollingBody, SensedError, SimulatedHands, SimulatedPalms, Workspace};
use recon::exploration::{Heading, Motion, Source, planar, space};
use recon::object_dynamics::planar::PlanarObject;
use recon::observer::rolling::RollingNoise;
use recon::shape_bounds::exact_hull::planar as flat;
use recon_io::{FolderTarget, OutlineScene, PlanarBody, PlanarScene, Scene, SceneErrorKind, SurfaceScene};
use serde_json::Value;
use std::f64::consts::TAU;
use std::slice;

pub(crate) fn run(args: &ExploreArgs, console: &Console) -> Result<Outcome, CliError> {
    let inputs = slice::from_ref(&args.scene);
    let target =
        args.output.as_ref().map(|folder| FolderTarget::new(folder, inputs, args.force)).transpose()?;
    let progress = Progress::new(args.goal.budget.map_or(0, u64::from), console.is_quiet());
    if !args.rolling && args.goal.contact_noise.is_some() != args.goal.normal_noise.is_some() {
        return Err(CliError::HalfNoise);
    }
    progress.step("reading the scene");
    let made = match Scene::read(&args.scene) {
        _ if args.contour => contour(args, &progress)?,
        _ if args.relief => relief(args, &progress)?,
        Ok(scene) if args.rolling => between(args, &scene, &progress)?,
        Ok(scene) => in_space(args, &scene, &progress)?,
        Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
            let scene = PlanarScene::read(&args.scene)?;
            if args.rolling { rolling(args, &scene, &progress)? } else { in_plane(args, &scene, &progress)? }
        }
        Err(error) => return Err(error.into()),
    };
    match target {
        Some(folder) => write_files_folder(folder, &made.files, &made.figures)?,
        None => made.drawn.check(&made.figures)?,
    }
    drop(progress);
    let text = made.text + &written_to(args.output.as_deref());
    match args.output {
        Some(_) => console.written(&text, &made.figures)?,
        None => console.result(&text, &made.figures)?,
    }
    Ok(made.exit)
}

fn motion(args: &ExploreArgs) -> Motion {
    if args.rays { Motion::Ray } else { Motion::Plane }
}

fn title(args: &ExploreArgs) -> String {
    args.scene.file_stem().map_or_else(|| "scene".to_owned(), |name| name.to_string_lossy().into_owned())
}

/// What is to be proven: the command line asks for it wherever it is needed.
fn until(args: &ExploreArgs) -> Result<&Until, CliError> {
    args.until.as_ref().ok_or_else(|| CliError::NoGoal { path: args.scene.clone() })
}

fn contour(args: &ExploreArgs, progress: &Progress) -> Result<Explored, CliError> {
    let scene = OutlineScene::read(&args.scene)?;
    let radius = finger(args, scene.finger)?;
    let following = Following::new(&args.goal, args.step, [scene.outline.size(), radius])?;
    progress.step("following the outline");
    followed(&title(args), scene.outline, radius, &following)
}

/// Radius of the round finger, m, where the scene may state one.
fn finger(args: &ExploreArgs, stated: Option<f64>) -> Result<f64, CliError> {
    args.finger.or(stated).ok_or_else(|| CliError::NoFinger { path: args.scene.clone() })
}

fn relief(args: &ExploreArgs, progress: &Progress) -> Result<Explored, CliError> {
    let scene = SurfaceScene::read(&args.scene)?;
    let radius = finger(args, scene.finger)?;
    let descending = Descending::new(&args.goal, args.step, &scene, radius)?;
    progress.step("coming down on the body");
    felt(&title(args), scene.surface, radius, &descending, |words| progress.say(words))
}

fn in_space(args: &ExploreArgs, scene: &Scene, progress: &Progress) -> Result<Explored, CliError> {
    let nothing = || CliError::NothingToSimulate { path: args.scene.clone() };
    let body = scene.simulation.as_ref().ok_or_else(nothing)?.body()?;
    let settings = Settings::new(&args.goal, &Value::Null, 3);
    let support = |n: Direction| -> DVec3 { body.point(n) };
    let [point, normal] = settings.noise.map_or([0.0; 2], |(noise, _)| noise);
    let mut finger =
        space::SimulatedFinger::new(support, motion(args)).with_noise(point, normal, settings.seed);
    let goal = goal_of::<InSpace>(until(args)?)?;
    // The scene's size is a mean radius.
    let width = scene.size.map(|radius| 2.0 * radius);
    progress.step("touching");
    explored::<InSpace>(&title(args), goal, &settings, width, &mut finger, |_, words| progress.say(words))
}

/// Friction of parallel palms that is taken if none is stated: dry soft rubber.
const RUBBER: f64 = 1.0;

/// Between two parallel palms, of which the upper one moves.
fn between(args: &ExploreArgs, scene: &Scene, progress: &Progress) -> Result<Explored, CliError> {
    for (given, option) in [(args.force_noise, "--force-noise"), (args.goal.normal_noise, "--normal-noise")] {
        if given.is_some() {
            return Err(CliError::NotBetween { option });
        }
    }
    let nothing = || CliError::NothingToSimulate { path: args.scene.clone() };
    let body = scene.simulation.as_ref().ok_or_else(nothing)?.body()?;
    let mut settings = Settings::new(&args.goal, &Value::Null, 3);
    settings.planner = args.goal.planner.unwrap_or(PlannerAs::PerSecond);
    let lattice = <Direction as Heading>::spread(DIRECTIONS);
    let mean = lattice.iter().map(|n| body.value(*n)).sum::<f64>() / lattice.len() as f64;
    let workspace =
        ParallelWorkspace::for_size(args.width.unwrap_or(2.0 * mean), args.friction.unwrap_or(RUBBER));
    workspace.check().map_err(ParallelError::Workspace)?;
    let support = |n: Direction| -> DVec3 { body.point(n) };
    let palms = SimulatedParallelPalms::new(support, workspace, Source::new(settings.seed).rotation());
    let mut palms = palms.map_err(CliError::ParallelPalms)?;
    progress.step("moving the palm");
    let (title, until, watch) = (title(args), until(args)?, |words: &str| progress.say(words));
    match (args.goal.contact_noise, args.palm_noise) {
        (Some(contact), Some(palm)) => {
            let noise = RollingNoise { contact, palm, spin: args.spin_noise.unwrap_or(0.0) };
            let settings = settings.estimated_between(noise, args.goal.confidence.unwrap_or(CONFIDENCE));
            let palms = EstimatedPalms::new(palms.with_noise(noise, settings.seed), noise);
            let mut palms = palms.map_err(ParallelError::Palms)?;
            stroked(&title, until, &settings, workspace, &mut palms, watch)
        }
        (None, None) => stroked(&title, until, &settings, workspace, &mut palms, watch),
        _ => Err(CliError::HalfNoise),
    }
}

/// Where palms are at first, rad.
const PALMS: [f64; 2] = [0.7, 2.4];

/// The scene's object about its centre of mass.
struct Rolled<'a>(&'a PlanarBody);

impl RollingBody for Rolled<'_> {
    fn farthest(&self, theta: f64) -> DVec2 {
        self.0.point(theta)
    }

    fn centre(&self) -> DVec2 {
        DVec2::ZERO
    }
}

fn rolling(args: &ExploreArgs, scene: &PlanarScene, progress: &Progress) -> Result<Explored, CliError> {
    if args.palm_noise.is_some() {
        return Err(CliError::NotHinged);
    }
    let body = Rolled(&scene.world.object().shape);
    let mut settings = Settings::new(&args.goal, &Value::Null, 2);
    settings.planner = args.goal.planner.unwrap_or(PlannerAs::PerSecond);
    let width = args.width.unwrap_or_else(|| mean_width(&body));
    let let_go = Source::new(settings.seed).unit() * TAU;
    progress.step("turning the palms");
    match (args.goal.contact_noise, args.force_noise) {
        (Some(contact), Some(force)) => {
            settings.planner = args.goal.planner.unwrap_or(PlannerAs::PerRadian);
            settings.noise = None;
            settings.sensors = Some(([contact, force], args.goal.confidence.unwrap_or(CONFIDENCE)));
            settings.budget = args.goal.budget.map_or(MOTIONS, |budget| budget as usize);
            estimated(args, scene, &settings, width, let_go, progress)
        }
        (None, None) if args.friction.is_some() => Err(CliError::FrictionAtRest),
        (None, None) if args.goal.normal_noise.is_none() => {
            let workspace = Workspace::for_size(width);
            let mut palms = SimulatedPalms::new(body, workspace.length, PALMS, let_go)?;
            rolled(&title(args), until(args)?, &settings, workspace, &mut palms, |words| progress.say(words))
        }
        _ => Err(CliError::HalfNoise),
    }
}

/// Samples of the sensors in a natural time: what the estimate of the motion needs.
const SAMPLED: f64 = 36.0;
/// Contact conditions are off by this much beside the noise, as a share of the natural speed: what the simulation is.
const FLOOR: f64 = 1e-6;
/// Motions at most where the motion is estimated: the confidence is shared among the looks after each.
const MOTIONS: usize = 25;

/// With noisy sensors: the object moves by the equations of motion, and what it does is estimated.
fn estimated(
    args: &ExploreArgs,
    scene: &PlanarScene,
    settings: &Settings,
    width: f64,
    let_go: f64,
    progress: &Progress,
) -> Result<Explored, CliError> {
    let PlanarObject { shape, mass, gravity } = scene.world.object();
    if *gravity <= 0.0 {
        return Err(CliError::RolledWithoutGravity);
    }
    let Some((noise, level)) = settings.sensors else { return Err(CliError::HalfNoise) };
    let natural = (0.5 * width / gravity).sqrt();
    let rate = SAMPLED / natural;
    let workspace = Workspace::in_motion(width, *gravity);
    let object = PlanarObject { shape: shape.clone(), mass: *mass, gravity: *gravity };
    let hands =
        SimulatedHands::new(object, args.friction.unwrap_or(0.0), workspace.length, PALMS, let_go, rate);
    let mut hands = hands.map_err(SensedError::Start)?.with_noise(noise, settings.seed);
    let sensors = hands.sensors(FLOOR * (0.5 * width * gravity).sqrt());
    let with = (workspace, sensors, level);
    sensed(&title(args), until(args)?, settings, with, &mut hands, |words| progress.say(words))
}

/// In m; to within what it is needed for: lengths of palms, and bodies that are drawn where nothing is known yet.
fn mean_width(body: &Rolled) -> f64 {
    let all = flat::Direction::spread(DIRECTIONS);
    let value = |n: &flat::Direction| body.farthest(n.angle()).dot(n.get());
    2.0 * all.iter().map(value).sum::<f64>() / all.len() as f64
}

const DIRECTIONS: usize = 90;

fn in_plane(args: &ExploreArgs, scene: &PlanarScene, progress: &Progress) -> Result<Explored, CliError> {
    let body = &scene.world.object().shape;
    let settings = Settings::new(&args.goal, &Value::Null, 2);
    let support = |n: flat::Direction| -> DVec2 { body.point(n.angle()) };
    let [point, normal] = settings.noise.map_or([0.0; 2], |(noise, _)| noise);
    let mut finger =
        planar::SimulatedFinger::new(support, motion(args)).with_noise(point, normal, settings.seed);
    let goal = goal_of::<InPlane>(until(args)?)?;
    progress.step("touching");
    explored::<InPlane>(&title(args), goal, &settings, None, &mut finger, |_, words| progress.say(words))
}
