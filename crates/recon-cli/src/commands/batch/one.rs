//! One log of many.

use crate::cli::{BatchArgs, ShapeAs};
use crate::commands::planar::write_estimated;
use crate::console::causes;
use crate::error::CliError;
use crate::pipeline::{
    Asked, Extra, LogSource, PlanarSource, estimated, load, planar_motion, read_planar, sorted_with_forces,
    with_palms,
};
use crate::progress::Progress;
use clap::ValueEnum;
use recon::observer::contacts::ContactEstimate;
use recon::observer::planar::PlaneEstimate;
use recon_io::{
    FolderTarget, PlanarScene, Scene, SceneErrorKind, brief_to, fingerprint, is_bag, with_brief_numbers,
};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// File in each folder of results that says what these were made from.
const MADE_FROM: &str = "batch.json";

/// Points of the path that a small picture shows.
const SHOWN: usize = 60;

/// How it went with a log.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum State {
    ReliedOn,
    Doubtful,
    /// It cannot be used; there is no folder of results.
    Broken,
}

impl State {
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::ReliedOn => "relied on",
            Self::Doubtful => "not relied on",
            Self::Broken => "skipped",
        }
    }
}

/// Time (s) and place of the centre of mass (m), and the standard deviations of that, where they are finite.
pub(super) type PathPoint = ([f64; 4], [Option<f64>; 3]);

/// What one log told.
pub(super) struct Row {
    /// File name of the log.
    pub(super) log: String,
    /// Name of the folder of its results.
    pub(super) folder: String,
    pub(super) state: State,
    /// The verdict, or what is wrong with the log.
    pub(super) why: String,
    /// Whether an earlier run made the results.
    pub(super) before: bool,
    /// Time that it took, s.
    pub(super) seconds: f64,
    /// The summary; null of a broken log.
    pub(super) summary: Value,
    /// Where the centre of mass was, at some of all times.
    pub(super) path: Vec<PathPoint>,
}

impl Row {
    /// Of results that are about to be written.
    fn of(relied_on: bool, why: String, begun: Instant, path: Vec<PathPoint>) -> Self {
        let state = if relied_on { State::ReliedOn } else { State::Doubtful };
        let (log, folder, summary) = Default::default();
        let seconds = begun.elapsed().as_secs_f64();
        Self { log, folder, state, why, before: false, seconds, summary, path }
    }

    /// The file beside results by which a later run knows them.
    fn origin(&self, args: &BatchArgs, log: &Path) -> Extra {
        let relied_on = self.state == State::ReliedOn;
        let of = json!({
            "made_from": made_from(args, log), "relied_on": relied_on, "seconds": self.seconds, "path": self.path,
        });
        (MADE_FROM.to_owned(), format!("{of:#}\n").into_bytes())
    }

    pub(super) fn describe(&self) -> String {
        let how =
            if self.before { "done before".to_owned() } else { format!("{} s", brief_to(2, self.seconds)) };
        let why = if self.state == State::ReliedOn { String::new() } else { format!(": {}", self.why) };
        format!("{}: {} ({how}){why}", self.log, self.state.word())
    }

    pub(super) fn figures(&self) -> Value {
        json!({
            "log": self.log,
            "state": self.state.word(),
            "why": self.why,
            "done_before": self.before,
            "seconds": self.seconds,
            "mass_kg": self.mass(),
            "std_mass_kg": self.std_mass(),
        })
    }

    /// Mass in kg, where the summary has it.
    pub(super) fn mass(&self) -> Option<f64> {
        self.evidence("mass").or_else(|| self.summary["mass_kg"].as_f64())
    }

    pub(super) fn std_mass(&self) -> Option<f64> {
        self.evidence("std_mass").or_else(|| self.summary["std_mass_kg"].as_f64())
    }

    /// A number of the evidence; in the plane the summary has it itself.
    pub(super) fn evidence(&self, key: &str) -> Option<f64> {
        let in_plane = match key {
            "misfit" => self.summary["chi_squared"].as_f64(),
            "relied_on" => self.summary["relied_on_share"].as_f64(),
            _ => None,
        };
        self.summary["evidence"][key]["value"].as_f64().or(in_plane)
    }
}

/// The scene of a log: the one of its name beside it, or that of all.
fn scene_of(args: &BatchArgs, log: &Path) -> Option<PathBuf> {
    let own = log.with_extension("toml");
    if own.is_file() { Some(own) } else { args.scene.clone() }
}

fn names(log: &Path) -> [String; 2] {
    [log.file_name(), log.file_stem()].map(|name| name.unwrap_or_default().to_string_lossy().into_owned())
}

/// What results are made from: if none of it has changed, they are what they would be.
fn made_from(args: &BatchArgs, log: &Path) -> Option<Value> {
    let print =
        |path: &Path| fingerprint(path).ok().map(|(bytes, crc32)| json!({ "bytes": bytes, "crc32": crc32 }));
    let scene = scene_of(args, log)?;
    let mapping = args.mapping.as_ref().map(|path| print(path));
    let exported: Vec<_> =
        args.export.iter().filter_map(|of| Some(of.to_possible_value()?.get_name().to_owned())).collect();
    Some(json!({
        "recon": env!("CARGO_PKG_VERSION"),
        "log": print(log)?,
        "scene": print(&scene)?,
        "mapping": mapping,
        "identify": args.identify,
        "export": exported,
    }))
}

/// What an earlier run found, where its results stand there whole and are of the same log, scene and options.
pub(super) fn done_before(args: &BatchArgs, log: &Path) -> Option<Row> {
    let [log_name, folder] = names(log);
    let place = args.output.join(&folder);
    let read =
        |name: &str| -> Option<Value> { serde_json::from_slice(&std::fs::read(place.join(name)).ok()?).ok() };
    let (of, summary) = (read(MADE_FROM)?, read("summary.json")?);
    if Some(&of["made_from"]) != made_from(args, log).as_ref() || recon_io::check(&place).is_err() {
        return None;
    }
    let state = if of["relied_on"].as_bool()? { State::ReliedOn } else { State::Doubtful };
    let path = serde_json::from_value(of["path"].clone()).ok()?;
    let (seconds, why) = (of["seconds"].as_f64()?, summary["verdict"]["text"].as_str()?.to_owned());
    Some(Row { log: log_name, folder, state, why, before: true, seconds, summary, path })
}

/// What the log tells, written into its folder.
pub(super) fn estimate_one(args: &BatchArgs, log: &Path) -> Row {
    let begun = Instant::now();
    let [name, folder] = names(log);
    match made(args, log, &args.output.join(&folder), begun) {
        Ok(row) => Row { log: name, folder, ..row },
        Err(error) => {
            let said: Vec<String> = std::iter::once(error.to_string()).chain(causes(&error)).collect();
            Row {
                log: name,
                folder,
                state: State::Broken,
                why: with_brief_numbers(&said.join(": ")),
                before: false,
                seconds: begun.elapsed().as_secs_f64(),
                summary: Value::Null,
                path: Vec::new(),
            }
        }
    }
}

fn made(args: &BatchArgs, log: &Path, folder: &Path, begun: Instant) -> Result<Row, CliError> {
    let scene_path = scene_of(args, log).ok_or(CliError::LogNeedsScene)?;
    let scene = match Scene::read(&scene_path) {
        Err(error) if matches!(error.kind, SceneErrorKind::InPlane) => {
            return made_in_plane(args, log, folder, (&scene_path, begun));
        }
        read => read?,
    };
    let mapping = args.mapping.as_deref().filter(|_| is_bag(log));
    let loaded = load(LogSource { path: log, scene: &scene, mapping })?;
    let [title, _] = names(log);
    let asked = Asked {
        path: log,
        scene: &scene,
        title: &title,
        identify: args.identify,
        accuracy: None,
        covariances: false,
    };
    let estimate = estimated(sorted_with_forces(loaded, &scene), &asked, &Progress::watched(None))?;
    let relied_on = estimate.is_reliable();
    let data = &estimate.made.data;
    let (path, why) = (path(data.log.times(), &data.estimate), data.verdict.text.clone());
    let row = Row::of(relied_on, why, begun, path);
    let mut extras = estimate.extras(&args.export, ShapeAs::Auto, None)?;
    extras.push(row.origin(args, log));
    let inputs: Vec<PathBuf> = [log.to_owned(), scene_path].into_iter().chain(args.mapping.clone()).collect();
    let summary = estimate.write(FolderTarget::new(folder, &inputs, false)?, &extras)?;
    Ok(Row { summary, ..row })
}

/// The same of a log in the plane.
fn made_in_plane(
    args: &BatchArgs,
    log: &Path,
    folder: &Path,
    (scene, begun): (&Path, Instant),
) -> Result<Row, CliError> {
    if !args.export.is_empty() {
        return Err(CliError::in_space_alone("export", scene));
    }
    let mut known = PlanarScene::read_known(scene)?;
    if args.identify {
        known.mass = None;
    }
    let read = read_planar(&PlanarSource::File(log), &known)?;
    let times: Vec<f64> = read.samples().iter().map(|sample| sample.t).collect();
    let made = planar_motion(read, &with_palms(known), None, false)?;
    let row = Row::of(made.is_reliable(), made.verdict(), begun, path_in_plane(&times, made.estimate()));
    let [title, _] = names(log);
    let target = FolderTarget::new(folder, &[log.to_owned(), scene.to_owned()], false)?;
    let summary = made.figures();
    write_estimated(target, &made, (&title, &summary), (None, &[row.origin(args, log)]))?;
    Ok(Row { summary, ..row })
}

fn path_in_plane(times: &[f64], found: &PlaneEstimate) -> Vec<PathPoint> {
    let step = times.len().div_ceil(SHOWN).max(1);
    let point = |k: usize| {
        let (p, std) = (found.states[k].p_WCm, found.deviations[k].p_WCm);
        let known = |std: f64| Some(std).filter(|std| std.is_finite());
        ([times[k], p.x, p.y, 0.0], [known(std.x), known(std.y), None])
    };
    (0..times.len()).step_by(step).map(point).collect()
}

fn path(times: &[f64], found: &ContactEstimate) -> Vec<PathPoint> {
    let step = times.len().div_ceil(SHOWN).max(1);
    let point = |k: usize| {
        let (p, std) = (found.states[k].p_WCm, found.deviations[k][0].to_array());
        // What is not finite has no place in JSON.
        ([times[k], p.x, p.y, p.z], std.map(|std| Some(std).filter(|std| std.is_finite())))
    };
    (0..times.len()).step_by(step).map(point).collect()
}
