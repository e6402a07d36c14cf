use crate::cli::FollowArgs;
use crate::console::{Console, listened};
use crate::error::{CliError, Outcome};
use crate::interrupt::{Checked, check, while_writing};
use crate::pipeline::known_body;
use crate::progress::Progress;
use glam::DVec3;
use recon::object_dynamics::Sample;
use recon::observer::{MotionStream, NoiseLevel, StreamEstimate, StreamOptions, StreamStage};
use recon_io::{
    FileTarget, LogFileError, LogReader, OutputError, Scene, is_bag, is_standard_output, write_stream_header,
    write_stream_row,
};
use recon_io::{MotionState, StreamRow};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufReader, Read, Write};
use std::path::{Path, PathBuf};

/// Samples from which the rate is taken where it is not stated.
const FIRST: usize = 21;
/// Share of the interval between rows by which rounding moves a sample's time at most.
const ROUNDING: f64 = 1e-6;

pub(crate) fn run(args: &FollowArgs, console: &Console) -> Result<Outcome, CliError> {
    let output = args.output.as_ref().filter(|path| !is_standard_output(path));
    let inputs: Vec<_> = [&args.log].into_iter().chain(&args.scene).cloned().collect();
    let target = output.map(|path| FileTarget::new(path, &inputs)).transpose()?;
    let scene = args.scene.as_ref().map(Scene::read).transpose()?.ok_or(CliError::UnknownBody)?;
    let mass = if args.identify { None } else { Some(known_body(&scene)?) };
    let noise = noise(args, &scene).ok_or(CliError::StreamNoise)?;
    if is_bag(&args.log) {
        return Err(CliError::BagFollowed { path: args.log.clone() });
    }
    let mut samples = Samples::open(&args.log)?;
    let options = StreamOptions {
        mass,
        gravity: DVec3::new(0.0, 0.0, -scene.gravity),
        palm_inertias: scene.palm_inertia,
        noise,
        sample_rate: match args.rate {
            Some(rate) => rate,
            None => samples.rate()?,
        },
    };
    let stream = MotionStream::new(options)?;
    let progress = Progress::new(1, console.is_json() || output.is_none());
    progress.step("following the motion");
    let followed = match output.zip(target) {
        Some((path, target)) => while_writing(|| {
            let mut file = target.begin()?;
            let run = Run { stream, every: args.every, console, json: false };
            let followed = run.all(samples, Checked(&mut file)).map_err(|failure| match failure {
                Failure::Written(source) => {
                    OutputError::Io { action: "write", path: path.clone(), source }.into()
                }
                Failure::Other(error) => error,
            })?;
            file.commit()?;
            Ok(followed)
        })?,
        None => {
            let run = Run { stream, every: args.every, console, json: console.is_json() };
            match run.all(samples, io::stdout().lock()) {
                Ok(followed) => followed,
                Err(Failure::Other(error)) => return Err(error),
                // Whoever reads has had what it wanted.
                Err(Failure::Written(error)) => return listened(Err(error)).map(|()| Outcome::Done),
            }
        }
    };
    drop(progress);
    followed.tell(console, output.map(PathBuf::as_path))
}

fn noise(args: &FollowArgs, scene: &Scene) -> Option<NoiseLevel> {
    let contact = args.contact_noise.or(scene.sensors.contact_std)?;
    Some(NoiseLevel { contact, force: args.force_noise.or(scene.sensors.force_std)? })
}

/// The samples of a log as they come, with the place that errors name.
struct Samples<'a> {
    path: &'a Path,
    reader: LogReader<Box<dyn Read>>,
    /// Read ahead, latest first.
    ahead: Vec<Sample>,
}

impl<'a> Samples<'a> {
    fn open(path: &'a Path) -> Result<Self, CliError> {
        let in_file = |kind| CliError::Log(LogFileError { path: path.to_owned(), kind });
        let text: Box<dyn Read> = if path.as_os_str() == "-" {
            Box::new(io::stdin())
        } else {
            Box::new(BufReader::new(File::open(path).map_err(|e| in_file(e.into()))?))
        };
        Ok(Self { path, reader: LogReader::new(text).map_err(in_file)?, ahead: Vec::new() })
    }

    fn read(&mut self) -> Result<Option<Sample>, CliError> {
        let sample = self.reader.next().transpose();
        sample.map_err(|kind| CliError::Log(LogFileError { path: self.path.to_owned(), kind }))
    }

    fn next(&mut self) -> Result<Option<Sample>, CliError> {
        match self.ahead.pop() {
            Some(sample) => Ok(Some(sample)),
            None => self.read(),
        }
    }

    /// Samples a second, from the first of them: the median interval, which a gap does not move.
    fn rate(&mut self) -> Result<f64, CliError> {
        while self.ahead.len() < FIRST {
            let Some(sample) = self.read()? else { break };
            self.ahead.push(sample);
        }
        let mut intervals: Vec<f64> = self.ahead.windows(2).map(|w| w[1].t - w[0].t).collect();
        intervals.sort_by(f64::total_cmp);
        self.ahead.reverse();
        let too_few = CliError::TooFewSamples { found: self.ahead.len(), needed: 2 };
        intervals.get(intervals.len() / 2).map(|interval| 1.0 / interval).ok_or(too_few)
    }
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
    /// Time of the first motion, s.
    found: Option<f64>,
    last: Option<StreamEstimate>,
}

impl Run<'_> {
    fn all(mut self, mut samples: Samples<'_>, mut to: impl Write) -> Result<Followed, Failure> {
        let mut followed = Followed::default();
        let mut rows = Rows { every: self.every, first: None, latest: -1.0 };
        if !self.json {
            write_stream_header(&mut to)?;
        }
        while let Some(sample) = samples.next()? {
            check()?;
            followed.samples += 1;
            let estimate = match self.stream.push(&sample) {
                Ok(estimate) => estimate,
                // A log in which nothing can be used fails; a sample of one that can is left out.
                Err(error) if followed.last.is_none() => return Err(CliError::Stream(error).into()),
                Err(error) => {
                    followed.left_out += 1;
                    followed.why.get_or_insert_with(|| error.to_string());
                    continue;
                }
            };
            let Some(estimate) = estimate else { continue };
            let before = followed.last.replace(estimate).map(|e| e.stage);
            self.tell(before, &estimate, &mut followed);
            let t = estimate.motion.t;
            if rows.due(t) {
                self.row(&estimate, &mut to)?;
            }
        }
        to.flush()?;
        Ok(followed)
    }

    /// Says when a motion is found, and when the data contradict it.
    fn tell(&self, before: Option<StreamStage>, estimate: &StreamEstimate, followed: &mut Followed) {
        let t = estimate.motion.t;
        let [cm, v] = deviations(estimate);
        match (before, estimate.stage) {
            (Some(StreamStage::Tracking), StreamStage::Contradicted) => {
                self.console.note(&format!("t = {t:.3} s: the data contradict the motion"));
            }
            (Some(StreamStage::Tracking), _)
            | (_, StreamStage::Gathering | StreamStage::Searching { .. }) => {}
            (_, StreamStage::Contradicted) => {}
            (_, StreamStage::Tracking) => {
                followed.found.get_or_insert(t);
                self.console
                    .note(&format!("t = {t:.3} s: the motion is known to {cm:.1e} m and {v:.1e} m/s"));
            }
        }
    }

    fn row(&self, estimate: &StreamEstimate, to: &mut impl Write) -> io::Result<()> {
        let row = stream_row(estimate);
        if self.json { writeln!(to, "{}", object(&row)) } else { write_stream_row(&row, to) }
    }
}

fn stream_row(estimate: &StreamEstimate) -> StreamRow {
    let motion = &estimate.motion;
    let [std_cm, std_v] = deviations(estimate);
    StreamRow {
        t: motion.t,
        motion: MotionState {
            p_WCm: motion.p_WCm,
            R_WO: motion.R_WO,
            v_WCm: motion.v_WCm,
            w_WO: motion.w_WO,
        },
        std_cm,
        std_v,
        stage: name(estimate.stage),
        innovation: estimate.innovation,
        mass: estimate.body.map(|b| [b.mass, b.mass_deviation]),
    }
}

/// Standard deviations of position and velocity, all axes together.
fn deviations(estimate: &StreamEstimate) -> [f64; 2] {
    [0, 3].map(|first| (first..first + 3).map(|i| estimate.covariance[(i, i)]).sum::<f64>().sqrt())
}

fn name(stage: StreamStage) -> &'static str {
    match stage {
        StreamStage::Gathering => "gathering",
        StreamStage::Searching { .. } => "searching",
        StreamStage::Tracking => "tracking",
        StreamStage::Contradicted => "contradicted",
    }
}

fn object(row: &StreamRow) -> Value {
    let MotionState { p_WCm, R_WO, v_WCm, w_WO } = row.motion;
    json!({
        "t_s": row.t,
        "stage": row.stage,
        "p_WCm_m": p_WCm.to_array(),
        "R_WO_wxyz": [R_WO.w, R_WO.x, R_WO.y, R_WO.z],
        "v_WCm_m_per_s": v_WCm.to_array(),
        "w_WO_rad_per_s": w_WO.to_array(),
        "std_position_m": row.std_cm,
        "std_velocity_m_per_s": row.std_v,
        // No number before there is a motion: null.
        "innovation": row.innovation,
        "mass_kg": row.mass.map(|m| m[0]),
        "std_mass_kg": row.mass.map(|m| m[1]),
    })
}

impl Followed {
    fn tell(&self, console: &Console, output: Option<&Path>) -> Result<Outcome, CliError> {
        let last = self.last.ok_or(CliError::TooFewSamples { found: self.samples, needed: 2 })?;
        let [cm, v] = deviations(&last);
        let end = match last.stage {
            StreamStage::Tracking => format!("at the end it is known to {cm:.1e} m and {v:.1e} m/s"),
            StreamStage::Contradicted => "at the end the data contradict it".to_owned(),
            StreamStage::Gathering | StreamStage::Searching { .. } => "at the end there is none".to_owned(),
        };
        let found = match self.found {
            Some(t) => format!("a motion from t = {t:.3} s on; {end}"),
            None => {
                "no motion: the log is too short, moves too little, or is not that of this body".to_owned()
            }
        };
        let mut text = format!("{} samples, {found}", self.samples);
        if let Some(why) = &self.why {
            text += &format!("\n{} samples could not be used; the first: {why}", self.left_out);
        }
        match output {
            Some(path) => {
                let figures = json!({
                    "table": path.to_string_lossy(),
                    "samples": self.samples,
                    "left_out": self.left_out,
                    "found_t_s": self.found,
                    "stage": name(last.stage),
                    "std_position_m": cm,
                    "std_velocity_m_per_s": v,
                });
                console.result(&format!("{}: {text}", path.display()), &figures)?;
            }
            None => console.note(&text),
        }
        let known = last.stage == StreamStage::Tracking && self.left_out == 0;
        Ok(if known { Outcome::Done } else { Outcome::WithReservations })
    }
}
