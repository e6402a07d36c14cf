use super::columns::{Columns, Field, PalmColumns};
use super::contacts::palms_in_space;
use super::error::{LogFileError, LogFileErrorKind as Kind};
use crate::rows::{Whole, read_error, rows};
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Direction, PalmFrame, PalmTriple};
use recon::object_dynamics::{LogError, PalmReading, Sample, SensorLog, TrueState};
use std::io::{BufReader, Read};
use std::path::Path;

/// Largest departure of a unit vector's length from 1: four digits pass (they are off by 9e-5), wrong units do not.
const UNIT_TOLERANCE: f64 = 1e-4;

/// Reads a sensor log, version 1, from a CSV file.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_log(path: impl AsRef<Path>) -> Result<SensorLog, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_log(BufReader::new(file)).map_err(in_file)
}

/// Reads a sensor log, version 1, from CSV text.
///
/// Columns are found by name, in any order; those that the format does not know are ignored. Truth is taken where all
/// thirteen of its columns are there. A palm without contact has `s1 = s2 = nan` and a force of 0 or nan.
///
/// # Errors
/// [`LogFileErrorKind`](super::LogFileErrorKind) names the line and the column.
pub fn parse_log(text: impl Read) -> Result<SensorLog, Kind> {
    Table::open(text)?.three_palms()
}

/// A table whose header is known: the rest of a CSV file, or columns in memory.
pub(super) struct Table<S> {
    pub(super) header: csv::StringRecord,
    pub(super) rows: S,
}

/// Rows of a table, one after the other.
pub(super) trait EachRow {
    fn each_row(self, take: impl FnMut(&Row) -> Result<(), Kind>) -> Result<(), Kind>;
}

impl<R: Read> Table<csv::StringRecordsIntoIter<Whole<R>>> {
    pub(super) fn open(text: R) -> Result<Self, Kind> {
        let mut rows = rows(text);
        let header = rows.next().ok_or(Kind::Empty)?.map_err(csv_error)?;
        Ok(Self { header, rows })
    }
}

impl<R: Read> EachRow for csv::StringRecordsIntoIter<Whole<R>> {
    fn each_row(self, mut take: impl FnMut(&Row) -> Result<(), Kind>) -> Result<(), Kind> {
        for row in self {
            take(&Row::of(&row.map_err(csv_error)?))?;
        }
        Ok(())
    }
}

impl<S: EachRow> Table<S> {
    pub(super) fn three_palms(self) -> Result<SensorLog, Kind> {
        let columns = three_palms(&self.header)?;
        let mut rows = Rows::default();
        self.each_row(|row| rows.push(row, &columns))?;
        rows.finish()
    }

    pub(super) fn each_row(self, take: impl FnMut(&Row) -> Result<(), Kind>) -> Result<(), Kind> {
        self.rows.each_row(take)
    }
}

/// The columns of version 1; a header of version 2 is told as that.
pub(super) fn three_palms(header: &csv::StringRecord) -> Result<Columns, Kind> {
    let read = "three flat palms through the origin (s1_i, s2_i)";
    if palms_in_space(header)? > 0 { Err(Kind::AnyPalms { read }) } else { Columns::find(header) }
}

pub(super) fn csv_error(error: csv::Error) -> Kind {
    read_error(error).map_or_else(Kind::Csv, Kind::Read)
}

/// What has been read so far. `lines[k]` is the line of sample `k`.
#[derive(Default)]
struct Rows {
    samples: Vec<Sample>,
    truth: Vec<TrueState>,
    lines: Vec<u64>,
}

impl Rows {
    fn push(&mut self, row: &Row, columns: &Columns) -> Result<(), Kind> {
        self.samples.push(row.sample(columns)?);
        if let Some(fields) = &columns.truth {
            self.truth.push(row.truth(fields)?);
        }
        self.lines.push(row.line);
        Ok(())
    }

    fn finish(self) -> Result<SensorLog, Kind> {
        let truth = (!self.truth.is_empty()).then_some(self.truth);
        let log = SensorLog::new(self.samples, truth).map_err(|source| Kind::Samples {
            line: sample_of(&source).and_then(|k| self.lines.get(k).copied()),
            source,
        })?;
        check_palms(&log, &self.lines)?;
        Ok(log)
    }
}

/// One row with its line number; of columns in memory with its number from 0.
pub(super) struct Row<'a> {
    pub(super) cells: Cells<'a>,
    pub(super) line: u64,
}

/// What stands in a row.
pub(super) enum Cells<'a> {
    Text(&'a csv::StringRecord),
    Numbers(&'a [f64]),
}

impl<'a> Row<'a> {
    pub(super) fn of(record: &'a csv::StringRecord) -> Self {
        Self { cells: Cells::Text(record), line: record.position().map_or(0, csv::Position::line) }
    }
}

impl Row<'_> {
    pub(super) fn check_count(&self, expected: usize) -> Result<(), Kind> {
        let found = match self.cells {
            Cells::Text(record) => record.len(),
            Cells::Numbers(numbers) => numbers.len(),
        };
        if found == expected { Ok(()) } else { Err(Kind::FieldCount { line: self.line, expected, found }) }
    }

    /// The readings, without truth.
    pub(super) fn sample(&self, columns: &Columns) -> Result<Sample, Kind> {
        self.check_count(columns.count)?;
        let t = self.finite(&columns.t)?;
        let palm = |i: usize| self.palm(i + 1, &columns.palms[i]);
        Ok(Sample { t, palms: [palm(0)?, palm(1)?, palm(2)?] })
    }

    pub(super) fn number(&self, field: &Field) -> Result<f64, Kind> {
        let text = match self.cells {
            Cells::Numbers(numbers) => return Ok(numbers.get(field.index).copied().unwrap_or(f64::NAN)),
            Cells::Text(record) => record.get(field.index).unwrap_or_default(),
        };
        text.parse().map_err(|_| Kind::NotANumber {
            line: self.line,
            column: field.name.clone(),
            text: text.to_owned(),
        })
    }

    pub(super) fn finite(&self, field: &Field) -> Result<f64, Kind> {
        let value = self.number(field)?;
        if value.is_finite() { Ok(value) } else { Err(self.not_finite(field, value)) }
    }

    pub(super) fn finite_or_none(&self, field: Option<&Field>) -> Result<Option<f64>, Kind> {
        field.map(|f| self.finite(f)).transpose()
    }

    pub(super) fn not_finite(&self, field: &Field, value: f64) -> Kind {
        Kind::NotFinite { line: self.line, column: field.name.clone(), value }
    }

    pub(super) fn vector<const N: usize>(&self, fields: &[Field; N]) -> Result<[f64; N], Kind> {
        let mut values = [0.0; N];
        for (value, field) in values.iter_mut().zip(fields) {
            *value = self.finite(field)?;
        }
        Ok(values)
    }

    fn palm(&self, palm: usize, columns: &PalmColumns) -> Result<PalmReading, Kind> {
        let line = self.line;
        let n = DVec3::from_array(self.vector(&columns.normal)?);
        let normal =
            Direction::from_unit(n, UNIT_TOLERANCE).map_err(|source| Kind::Normal { line, palm, source })?;
        PalmFrame::from_normal(normal).map_err(|source| Kind::Palm { line, palm, source })?;
        let (s1, s2) = (self.number(&columns.s[0])?, self.number(&columns.s[1])?);
        let contact = match (s1.is_nan(), s2.is_nan()) {
            (true, true) => None,
            (false, false) => Some(self.vector(&columns.s)?),
            _ => return Err(Kind::HalfContact { line, palm, s1, s2 }),
        };
        Ok(PalmReading {
            normal,
            contact,
            force: self.force(palm, contact.is_some(), columns.force.as_ref())?,
            torque: if contact.is_some() { self.finite_or_none(columns.torque.as_ref())? } else { None },
            rate: self.finite_or_none(columns.rate.as_ref())?,
        })
    }

    fn force(&self, palm: usize, in_contact: bool, field: Option<&Field>) -> Result<Option<f64>, Kind> {
        let Some(field) = field else { return Ok(None) };
        let force = self.number(field)?;
        if in_contact {
            return if force.is_finite() { Ok(Some(force)) } else { Err(self.not_finite(field, force)) };
        }
        if force.is_nan() || force == 0.0 {
            return Ok(Some(0.0));
        }
        Err(Kind::ForceWithoutContact { line: self.line, palm, force })
    }

    pub(super) fn truth(&self, fields: &[Field; 13]) -> Result<TrueState, Kind> {
        let [px, py, pz, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz] = self.vector(fields)?;
        let q = DQuat::from_xyzw(qx, qy, qz, qw);
        let length = q.length();
        if (length - 1.0).abs() > UNIT_TOLERANCE {
            return Err(Kind::TrueOrientation { line: self.line, length });
        }
        Ok(TrueState {
            p_WCm: DVec3::new(px, py, pz),
            // A quaternion that was written at unit length reads back digit by digit.
            R_WO: if (length - 1.0).abs() <= 2.0 * f64::EPSILON { q } else { q.normalize() },
            v_WCm: DVec3::new(vx, vy, vz),
            w_WO: DVec3::new(wx, wy, wz),
        })
    }
}

/// The sample that an error of the log is about.
fn sample_of(error: &LogError) -> Option<usize> {
    match *error {
        LogError::TimeNotFinite { sample, .. }
        | LogError::ReadingNotFinite { sample, .. }
        | LogError::TooLarge { sample, .. }
        | LogError::NegativeForce { sample, .. }
        | LogError::Normal { sample, .. } => Some(sample),
        LogError::Series(series) => series.sample(),
        _ => None,
    }
}

/// Refuses palms that share a line at *every* sample. Palms that only pass through such a pose are left to the
/// estimators, some of which never invert the matrix of normals.
fn check_palms(log: &SensorLog, lines: &[u64]) -> Result<(), Kind> {
    let mut first = None;
    for (sample, &line) in log.samples().iter().zip(lines) {
        match PalmTriple::new([0, 1, 2].map(|i| sample.palms[i].normal.get())) {
            Ok(_) => return Ok(()),
            Err(source) => first = first.or(Some(Kind::Palms { line, source })),
        }
    }
    first.map_or(Ok(()), Err)
}
