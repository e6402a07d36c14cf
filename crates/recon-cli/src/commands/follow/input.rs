//! The samples of a log as they come, whatever its palms.

use crate::error::CliError;
use crate::pipeline::spread;
use recon::object_dynamics::Sample;
use recon::observer::contacts::stream::{ForceReading, PalmSensed, PlaneReadings, StreamError, StreamPalm};
use recon_io::{LogFileError, LogReader, Scene};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, BufReader, Read};
use std::path::Path;

/// Samples from which the rate and about the size are taken where they are not stated.
pub(crate) const FIRST: usize = 21;

/// What palms sense at a time, s.
pub(crate) type Sensed = (f64, Vec<PalmSensed>);

/// With the place that errors name.
pub(super) struct Samples<'a> {
    path: &'a Path,
    reader: LogReader<Box<dyn Read>>,
    planes: PlaneReadings,
    palms: Vec<StreamPalm>,
    ahead: VecDeque<Sensed>,
    /// Rows that were read.
    pub(super) rows: usize,
    /// Rows that could not be used, and what was wrong with the first of them.
    pub(super) left_out: usize,
    pub(super) why: Option<String>,
    latest: Option<Sample>,
}

impl<'a> Samples<'a> {
    pub(super) fn open(path: &'a Path, scene: &Scene) -> Result<Self, CliError> {
        let in_file = |kind| CliError::Log(LogFileError { path: path.to_owned(), kind });
        let text: Box<dyn Read> = if path.as_os_str() == "-" {
            Box::new(io::stdin())
        } else {
            Box::new(BufReader::new(File::open(path).map_err(|e| in_file(e.into()))?))
        };
        let setups = scene.palm_setups();
        let reader = LogReader::new(text, setups.as_deref()).map_err(in_file)?;
        let palms = match &reader {
            LogReader::ThreePalms(_) => PlaneReadings::palms(),
            LogReader::Contacts(_) => {
                let palm = |setup: &recon_io::PalmSetup| StreamPalm {
                    surface: setup.surface,
                    friction: setup.friction,
                };
                setups.iter().flatten().map(palm).collect()
            }
        };
        let planes = PlaneReadings::new(scene.palm_inertia);
        let (ahead, rows, left_out, why) = (VecDeque::new(), 0, 0, None);
        Ok(Self { path, reader, planes, palms, ahead, rows, left_out, why, latest: None })
    }

    /// Palms whose friction is not stated and that measure their normal force alone are taken to have none.
    pub(super) fn palms(&mut self) -> Result<Vec<StreamPalm>, CliError> {
        self.first()?;
        Ok(without_friction(self.palms.clone(), self.ahead.front().map(|(_, sensed)| &sensed[..])))
    }

    pub(super) fn next(&mut self) -> Result<Option<Sensed>, CliError> {
        match self.ahead.pop_front() {
            Some(sample) => Ok(Some(sample)),
            None => self.read(),
        }
    }

    fn read(&mut self) -> Result<Option<Sensed>, CliError> {
        loop {
            let in_file = |kind| CliError::Log(LogFileError { path: self.path.to_owned(), kind });
            let sample = match &mut self.reader {
                LogReader::Contacts(rows) => {
                    let sample = rows.next().transpose().map_err(in_file)?;
                    self.rows += usize::from(sample.is_some());
                    return Ok(sample);
                }
                LogReader::ThreePalms(rows) => rows.next().transpose().map_err(in_file)?,
            };
            let pushed = match sample {
                Some(sample) => {
                    self.rows += 1;
                    self.latest = Some(sample);
                    self.planes.push(&sample)
                }
                // Rates of the last sample come from those before it.
                None => match self.latest.take() {
                    Some(_) => self.planes.last(),
                    None => return Ok(None),
                },
            };
            match pushed {
                Ok(Some((t, sensed))) => return Ok(Some((t, sensed.to_vec()))),
                Ok(None) => {}
                Err(error) => self.leave_out(error, self.rows > 2)?,
            }
        }
    }

    /// A log of which nothing was used so far fails; a sample of another one is left out.
    pub(super) fn leave_out(&mut self, error: StreamError, used: bool) -> Result<(), CliError> {
        if !used {
            return Err(CliError::Stream(error));
        }
        self.left_out += 1;
        self.why.get_or_insert_with(|| error.to_string());
        Ok(())
    }

    fn first(&mut self) -> Result<(), CliError> {
        while self.ahead.len() < FIRST {
            let Some(sample) = self.read()? else { break };
            self.ahead.push_back(sample);
        }
        match self.ahead.len() {
            found @ (0 | 1) => Err(CliError::TooFewSamples { found, needed: 2 }),
            _ => Ok(()),
        }
    }

    /// Samples a second, from the first of them: the median interval, which a gap does not move.
    pub(super) fn rate(&mut self) -> Result<f64, CliError> {
        self.first()?;
        rate_of(self.ahead.iter())
    }

    /// Root mean square of the distance of contacts from their mean in the first samples, m; none where there is one at most.
    pub(super) fn size(&mut self) -> Result<Option<f64>, CliError> {
        self.first()?;
        Ok(size_of(self.ahead.iter()))
    }
}

/// Palms whose friction is not stated and that measure their normal force alone are taken to have none.
pub(crate) fn without_friction(mut palms: Vec<StreamPalm>, first: Option<&[PalmSensed]>) -> Vec<StreamPalm> {
    for (palm, sensed) in palms.iter_mut().zip(first.unwrap_or_default()) {
        if matches!(sensed.force, ForceReading::Normal(_)) {
            palm.friction = palm.friction.or(Some(0.0));
        }
    }
    palms
}

/// Samples a second: the median interval, which a gap does not move.
pub(crate) fn rate_of<'a>(samples: impl Iterator<Item = &'a Sensed>) -> Result<f64, CliError> {
    let times: Vec<f64> = samples.map(|sample| sample.0).collect();
    let mut intervals: Vec<f64> = times.windows(2).map(|w| w[1] - w[0]).collect();
    intervals.sort_by(f64::total_cmp);
    let too_few = CliError::TooFewSamples { found: times.len(), needed: 2 };
    intervals.get(intervals.len() / 2).map(|interval| 1.0 / interval).ok_or(too_few)
}

/// Root mean square of the distance of contacts from their mean, m; none where there is one at most.
pub(crate) fn size_of<'a>(samples: impl Iterator<Item = &'a Sensed> + Clone) -> Option<f64> {
    let spread = spread(samples.flat_map(|(_, sensed)| sensed).filter_map(|s| s.contact));
    (spread > 0.0).then_some(spread)
}
