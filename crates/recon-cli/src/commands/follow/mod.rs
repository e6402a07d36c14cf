//! `recon follow`: the motion sample by sample, as a log is written or read.

pub(crate) mod input;
mod page;
mod spans;
mod words;

use crate::cli::FollowArgs;
use crate::console::{Console, listened};
use crate::error::{CliError, Outcome};
use crate::interrupt::{check, while_writing};
use crate::pipeline::{condition_floor, known_body};
use crate::progress::Progress;
use input::Samples;
use recon::object_dynamics::MassProperties;
use recon::observer::contacts::stream::{MotionStream, StreamEstimate, StreamOptions, StreamStage};
use recon::observer::contacts::{ContactNoiseLevel, ContactOptions};
use recon_io::StreamRow;
use recon_io::{
    FileTarget, FollowedMotion, OutputError, Scene, is_bag, is_standard_output, write_followed_report,
    write_stream_header, write_stream_row,
};
use serde_json::json;
use spans::Spans;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use words::object;

/// Share of the interval between rows by which rounding moves a sample's time at most.
const ROUNDING: f64 = 1e-6;

pub(crate) fn run(args: &FollowArgs, console: &Console) -> Result<Outcome, CliError> {
    let output = args.output.as_ref().filter(|path| !is_standard_output(path));
    let inputs: Vec<_> = [&args.log].into_iter().chain(&args.scene).cloned().collect();
    let target = output.map(|path| FileTarget::new(path, &inputs)).transpose()?;
    let others: Vec<_> = inputs.iter().chain(output).cloned().collect();
    let page = args.report.as_ref().map(|path| FileTarget::new(path, &others)).transpose()?;
    let scene = args.scene.as_ref().map(Scene::read).transpose()?.ok_or(CliError::LogNeedsScene)?;
    if is_bag(&args.log) {
        return Err(CliError::BagFollowed { path: args.log.clone() });
    }
    let body = if args.identify { None } else { Some(known_body(&scene)?) };
    let mut samples = Samples::open(&args.log, &scene)?;
    let noise = noise(args, &scene, || samples.size())?;
    let contacts = options(body, &scene, noise);
    let sample_rate = match args.rate {
        Some(rate) => rate,
        None => samples.rate()?,
    };
    let stream = MotionStream::new(samples.palms()?, StreamOptions { contacts, sample_rate })?;
    let progress = Progress::new(1, console.is_quiet() || output.is_none());
    progress.step("following the motion");
    let shown = page.as_ref().map(|_| FollowedMotion::default());
    let mut followed = Followed { shown, ..Followed::default() };
    let ended = match output.zip(target) {
        Some((path, target)) => while_writing(|| {
            let mut file = target.begin()?;
            let run = Run { stream, every: args.every, console, json: false };
            // Whether to stop is asked between rows, which are written whole.
            match run.all(samples, &mut file, &mut followed) {
                Ok(()) => file.commit()?,
                Err(Failure::Written(source)) => {
                    return Err(OutputError::Io { action: "write", path: path.clone(), source }.into());
                }
                // Whatever ends it, a row that is wrong or the user: what was followed until then is not lost.
                Err(Failure::Other(error)) => {
                    if let Some(last) = &followed.last {
                        file.commit()?;
                        let (t, path) = (last.t, path.display());
                        console.note(&format!("t = {t:.3} s: what was followed until then is in {path}"));
                    }
                    return Err(error);
                }
            }
            Ok(None)
        }),
        None => {
            let run = Run { stream, every: args.every, console, json: console.is_json() };
            match run.all(samples, io::stdout().lock(), &mut followed) {
                Ok(()) => Ok(None),
                Err(Failure::Other(error)) => Err(error),
                // Whoever reads has had what it wanted.
                Err(Failure::Written(error)) => listened(Err(error)).map(|()| Some(Outcome::Done)),
            }
        }
    };
    drop(progress);
    // Whatever ended it, the page shows what was followed until then.
    let page = args.report.as_ref().zip(page);
    let shown = page.map_or(Ok(()), |(path, target)| followed.show(&args.log, path, target));
    let ended = ended?;
    shown?;
    match ended {
        Some(outcome) => Ok(outcome),
        None => followed.tell(console, [output, args.report.as_ref()].map(|path| path.map(PathBuf::as_path))),
    }
}

/// What the stream is told of a body that may be known.
pub(crate) fn options(
    body: Option<MassProperties>,
    scene: &Scene,
    noise: ContactNoiseLevel,
) -> ContactOptions {
    ContactOptions {
        body,
        size: scene.size,
        suspects: true,
        mode_odds: true,
        ..ContactOptions::new(noise, scene.gravity)
    }
}

/// What is known of the sensors' noise; `size` is about that of the object, m, where the first samples tell it.
pub(crate) fn noise(
    args: &FollowArgs,
    scene: &Scene,
    size: impl FnOnce() -> Result<Option<f64>, CliError>,
) -> Result<ContactNoiseLevel, CliError> {
    let sensors = &scene.sensors;
    let contact = args.contact_noise.or(sensors.contact_std).ok_or(CliError::StreamNoise)?;
    let fixed = args.force_noise.or(sensors.force_std);
    if fixed.or(sensors.force_share).is_none() {
        return Err(CliError::StreamNoise);
    }
    let length = match scene.size {
        Some(size) => Some(size),
        None => size()?,
    };
    let floor = length.map(|length| condition_floor(scene, length)).or(sensors.contact_speed_std);
    Ok(ContactNoiseLevel {
        contact,
        force_fixed: fixed.unwrap_or_default(),
        force_share: sensors.force_share.unwrap_or_default(),
        impulse: None,
        floor: floor.ok_or(CliError::SizeNotStated)?,
    })
}

/// Why following ended: nothing takes the rows, or anything else.
enum Failure {
    Written(io::Error),
    Other(CliError),
}

impl From<CliError> for Failure {
    fn from(error: CliError) -> Self {
        Self::Other(error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Written(error)
    }
}

struct Run<'a> {
    stream: MotionStream,
    every: f64,
    console: &'a Console,
    json: bool,
}

/// Which samples have a row: those at and next after multiples of an interval from the first one on.
struct Rows {
    every: f64,
    first: Option<f64>,
    /// Multiple that the latest row belongs to.
    latest: f64,
}

impl Rows {
    fn due(&mut self, t: f64) -> bool {
        let first = *self.first.get_or_insert(t);
        if self.every <= 0.0 {
            return true;
        }
        // A sample that rounding has put before its multiple stands at it.
        let multiple = ((t - first) / self.every + ROUNDING).floor();
        let due = multiple > self.latest;
        self.latest = self.latest.max(multiple);
        due
    }
}

/// How it went.
#[derive(Default)]
struct Followed {
    samples: usize,
    /// Samples that could not be used, and what was wrong with the first of them.
    left_out: usize,
    why: Option<String>,
    spans: Spans,
    /// Palms whose modes are told.
    palms: usize,
    last: Option<StreamEstimate>,
    /// What a page is to show.
    shown: Option<FollowedMotion>,
}

impl Run<'_> {
    fn all(
        mut self,
        mut samples: Samples<'_>,
        mut to: impl Write,
        followed: &mut Followed,
    ) -> Result<(), Failure> {
        let mut rows = Rows { every: self.every, first: None, latest: -1.0 };
        let palms = self.stream.palms_with_modes();
        followed.palms = palms;
        if !self.json {
            write_stream_header(palms, &mut to)?;
        }
        while let Some((t, sensed)) = samples.next()? {
            check()?;
            let estimate = match self.stream.push(t, &sensed) {
                Ok(estimate) => estimate,
                Err(error) => {
                    samples.leave_out(error, followed.last.is_some())?;
                    continue;
                }
            };
            let before = followed.last.replace(estimate).map(|e| e.stage);
            self.tell(before, &estimate);
            followed.spans.take(t, estimate.stage == StreamStage::Tracking);
            followed.shown.iter_mut().for_each(|shown| shown.take(&estimate));
            if rows.due(t) {
                self.row(&estimate, palms, &mut to)?;
            }
        }
        to.flush()?;
        followed.left_out = samples.left_out + self.stream.left_out();
        (followed.samples, followed.why) = (samples.rows, samples.why);
        Ok(())
    }

    /// Says when a motion is found, and when the data contradict it.
    fn tell(&self, before: Option<StreamStage>, estimate: &StreamEstimate) {
        let t = estimate.t;
        match (before, estimate.stage) {
            (Some(StreamStage::Tracking), StreamStage::Contradicted) => {
                self.console.note(&format!("t = {t:.3} s: the data contradict the motion"));
            }
            (Some(StreamStage::Tracking), StreamStage::Searching { .. }) => {
                self.console.note(&format!("t = {t:.3} s: the motion is not known well enough"));
            }
            (Some(StreamStage::Tracking), _) => {}
            (_, StreamStage::Tracking) => {
                let [cm, v, ..] = deviations(estimate);
                self.console
                    .note(&format!("t = {t:.3} s: the motion is known to {cm:.1e} m and {v:.1e} m/s"));
            }
            _ => {}
        }
    }

    fn row(&self, estimate: &StreamEstimate, palms: usize, to: &mut impl Write) -> io::Result<()> {
        let row = stream_row(estimate);
        if self.json { writeln!(to, "{}", object(&row, palms)) } else { write_stream_row(&row, palms, to) }
    }
}

/// An estimate as a row of the table.
pub(crate) fn stream_row(estimate: &StreamEstimate) -> StreamRow {
    let body = estimate.motion.map(|motion| motion.body).filter(|body| body.mass_deviation > 0.0);
    StreamRow {
        t: estimate.t,
        motion: estimate.motion.map(|motion| motion.state.into()),
        deviations: deviations(estimate),
        stage: name(estimate.stage),
        relied_on: estimate.stage == StreamStage::Tracking,
        misfit: estimate.motion.map_or(f64::NAN, |motion| motion.misfit),
        mass: body.map(|body| [body.mass, body.mass_deviation]),
        modes: estimate.modes,
    }
}

/// Standard deviations of position, velocity, angular velocity and orientation, all axes together; no numbers without a motion.
fn deviations(estimate: &StreamEstimate) -> [f64; 4] {
    let of = |motion: &recon::observer::contacts::stream::StreamMotion, first: usize| {
        (first..first + 3).map(|i| motion.covariance[(i, i)]).sum::<f64>().sqrt()
    };
    [0, 3, 6, 9].map(|first| estimate.motion.as_ref().map_or(f64::NAN, |motion| of(motion, first)))
}

fn name(stage: StreamStage) -> &'static str {
    match stage {
        StreamStage::Gathering => "gathering",
        StreamStage::Searching { .. } => "searching",
        StreamStage::Tracking => "tracking",
        StreamStage::Contradicted => "contradicted",
    }
}

impl Followed {
    /// When the motion was known, and how well at the end.
    fn known(&self, last: &StreamEstimate) -> String {
        let [cm, v, ..] = deviations(last);
        let end = match last.stage {
            StreamStage::Tracking => format!("at the end it is known to {cm:.1e} m and {v:.1e} m/s"),
            StreamStage::Contradicted => "at the end the data contradict it".to_owned(),
            StreamStage::Gathering | StreamStage::Searching { .. } => "at the end it is not known".to_owned(),
        };
        if self.spans.is_empty() {
            "no motion: the log is too short, moves too little, or is not that of this body".to_owned()
        } else {
            format!("the motion is known {}; {end}", self.spans)
        }
    }

    fn told(&self, last: &StreamEstimate) -> words::Told {
        last.modes.as_ref().map(|modes| words::told(modes, self.palms)).unwrap_or_default()
    }

    /// Writes the page, if there is anything to show; after an interruption too, as the rows until then stay.
    fn show(&mut self, log: &Path, path: &Path, target: FileTarget) -> Result<(), CliError> {
        let (Some(last), Some(motion)) = (self.last, self.shown.take()) else { return Ok(()) };
        let mut known = self.known(&last);
        known[..1].make_ascii_uppercase();
        let title = match log.file_name() {
            _ if is_standard_output(log) => "standard input".to_owned(),
            name => name.unwrap_or(log.as_os_str()).to_string_lossy().into_owned(),
        };
        let page = page::page(self, motion, title, (known + ".", &self.told(&last).doubts));
        let mut file = target.begin()?;
        let failed = |source| OutputError::Io { action: "write", path: path.to_owned(), source };
        write_followed_report(&page, &mut file).map_err(failed)?;
        Ok(file.commit()?)
    }

    fn tell(&self, console: &Console, [output, page]: [Option<&Path>; 2]) -> Result<Outcome, CliError> {
        let last = self.last.ok_or(CliError::TooFewSamples { found: self.samples, needed: 2 })?;
        let ([cm, v, ..], found) = (deviations(&last), self.known(&last));
        let mut text = format!("{} samples, {found}", self.samples);
        if self.left_out > 0 {
            text += &format!("\n{} samples could not be used", self.left_out);
        }
        if let Some(why) = &self.why {
            text += &format!("; the first: {why}");
        }
        let told = self.told(&last);
        text += &told.text;
        match output {
            Some(path) => {
                let mut figures = json!({
                    "table": path.to_string_lossy(),
                    "samples": self.samples,
                    "left_out": self.left_out,
                    "found_t_s": self.spans.first(),
                    "known_s": self.spans.all(),
                    "stage": name(last.stage),
                    "std_position_m": cm,
                    "std_velocity_m_per_s": v,
                    "friction": told.frictions,
                    "mode_doubts": told.doubts,
                });
                if let Some(page) = page {
                    figures["report"] = page.to_string_lossy().into();
                }
                console.written(&format!("{}: {text}", path.display()), &figures)?;
            }
            None => console.note(&text),
        }
        let known = last.stage == StreamStage::Tracking && self.left_out == 0 && told.doubts.is_empty();
        Ok(if known { Outcome::Done } else { Outcome::WithReservations })
    }
}
