use super::failure::Failure;
use super::options::{parsed, unlike};
use crate::cli::{Command, FollowArgs};
use crate::commands::follow::input::{FIRST, Sensed, rate_of, size_of, without_friction};
use crate::commands::follow::{noise, options, stream_row};
use crate::error::CliError;
use crate::pipeline::known_body;
use recon::object_dynamics::MassProperties;
use recon::observer::contacts::stream::{MotionStream, PlaneReadings, StreamOptions, StreamPalm};
use recon_io::{LogFileError, RowReader, RowSample, Scene, StreamRow};

/// The motion of a body sample by sample, from rows of numbers as they come: what `recon follow` makes of a file.
///
/// The first samples are held back until the rate and about the size of the object are known from them (21 of them, as in the command); of
/// three planes each sample waits for the next, whose palms tell how fast these turn.
pub struct Follower {
    args: FollowArgs,
    scene: Scene,
    body: Option<MassProperties>,
    rows: RowReader,
    planes: PlaneReadings,
    palms: Vec<StreamPalm>,
    first: Vec<Sensed>,
    stream: Option<MotionStream>,
    /// Samples of three palms so far.
    samples: usize,
    left_out: usize,
    why: Option<String>,
    used: bool,
}

impl Follower {
    /// Rows will hold the columns of these names; `options` are `--identify`, `--contact-noise`, `--force-noise` and `--rate`.
    ///
    /// # Errors
    /// A column or the body is missing, or the noise is not stated.
    pub fn new(names: &[String], scene: Scene, options: &[String]) -> Result<Self, Failure> {
        let mut words = options.to_vec();
        words.push("log".to_owned());
        let Command::Follow(args) = parsed("follow", &words)? else { return Err(unlike("follow")) };
        let body = if args.identify { None } else { Some(known_body(&scene)?) };
        let setups = scene.palm_setups();
        let rows = RowReader::new(names, setups.as_deref()).map_err(in_rows)?;
        let palms = match rows.is_of_three_palms() {
            true => PlaneReadings::palms(),
            false => {
                let palm = |setup: &recon_io::PalmSetup| StreamPalm {
                    surface: setup.surface,
                    friction: setup.friction,
                };
                setups.iter().flatten().map(palm).collect()
            }
        };
        // What is missing of the noise is said before a sample comes.
        noise(&args, &scene, || Ok(Some(1.0)))?;
        let planes = PlaneReadings::new(scene.palm_inertia);
        let (first, stream, samples, left_out, why, used) = Default::default();
        Ok(Self { args, scene, body, rows, planes, palms, first, stream, samples, left_out, why, used })
    }

    /// Takes the next row; returns the estimates that it makes known, in order of time.
    ///
    /// # Errors
    /// The row cannot be read, or the first of them cannot be used. Later samples that cannot be used are counted.
    pub fn push(&mut self, row: &[f64]) -> Result<Vec<StreamRow>, Failure> {
        let sensed = match self.rows.take(row).map_err(in_rows)? {
            RowSample::Contacts(t, palms) => Some((t, palms)),
            RowSample::ThreePalms(sample) => {
                self.samples += 1;
                match self.planes.push(&sample) {
                    Ok(sensed) => sensed.map(|(t, sensed)| (t, sensed.to_vec())),
                    Err(error) => {
                        self.leave_out(CliError::Stream(error), self.samples > 2)?;
                        None
                    }
                }
            }
        };
        sensed.map_or(Ok(Vec::new()), |sensed| self.take(sensed))
    }

    /// Says that no row will come; returns the estimates that were held back.
    ///
    /// # Errors
    /// As for [`Follower::push`]; or there were too few samples.
    pub fn finish(&mut self) -> Result<Vec<StreamRow>, Failure> {
        let mut rows = Vec::new();
        if self.rows.is_of_three_palms() && self.samples > 0 {
            let last = self.planes.last().map(|sensed| sensed.map(|(t, sensed)| (t, sensed.to_vec())));
            match last {
                Ok(Some(sensed)) => rows.extend(self.take(sensed)?),
                Ok(None) => {}
                Err(error) => self.leave_out(CliError::Stream(error), self.samples > 2)?,
            }
        }
        if self.stream.is_none() {
            rows.extend(self.begin()?);
        }
        Ok(rows)
    }

    /// Number of palms whose contact modes are told; zero before the first rows.
    pub fn palms_with_modes(&self) -> usize {
        self.stream.as_ref().map_or(0, MotionStream::palms_with_modes)
    }

    /// Samples that could not be used, and what was wrong with the first of them.
    pub fn left_out(&self) -> (usize, Option<&str>) {
        let by_stream = self.stream.as_ref().map_or(0, MotionStream::left_out);
        (self.left_out + by_stream, self.why.as_deref())
    }

    fn take(&mut self, sensed: Sensed) -> Result<Vec<StreamRow>, Failure> {
        if self.stream.is_none() {
            self.first.push(sensed);
            return if self.first.len() < FIRST { Ok(Vec::new()) } else { self.begin() };
        }
        Ok(self.estimate(&sensed)?.into_iter().collect())
    }

    fn begin(&mut self) -> Result<Vec<StreamRow>, Failure> {
        let first = std::mem::take(&mut self.first);
        let noise = noise(&self.args, &self.scene, || Ok(size_of(first.iter())))?;
        let contacts = options(self.body, &self.scene, noise);
        let sample_rate = self.args.rate.map_or_else(|| rate_of(first.iter()), Ok)?;
        let palms = without_friction(self.palms.clone(), first.first().map(|(_, sensed)| &sensed[..]));
        let stream = MotionStream::new(palms, StreamOptions { contacts, sample_rate });
        self.stream = Some(stream.map_err(CliError::from)?);
        let mut rows = Vec::with_capacity(first.len());
        for sensed in &first {
            rows.extend(self.estimate(sensed)?);
        }
        Ok(rows)
    }

    fn estimate(&mut self, (t, sensed): &Sensed) -> Result<Option<StreamRow>, Failure> {
        let Some(stream) = &mut self.stream else { return Ok(None) };
        match stream.push(*t, sensed) {
            Ok(estimate) => {
                self.used = true;
                Ok(Some(stream_row(&estimate)))
            }
            Err(error) => {
                let used = self.used;
                self.leave_out(CliError::Stream(error), used).map(|()| None)
            }
        }
    }

    fn leave_out(&mut self, error: CliError, used: bool) -> Result<(), Failure> {
        let error = Failure::from(error);
        if !used {
            return Err(error);
        }
        self.left_out += 1;
        self.why.get_or_insert(error.message);
        Ok(())
    }
}

fn in_rows(kind: recon_io::LogFileErrorKind) -> Failure {
    Failure::in_rows(LogFileError { path: "the log".into(), kind }.into())
}
