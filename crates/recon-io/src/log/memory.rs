//! Sensor logs from numbers in memory: whole ones by their columns, running ones row by row.

use super::columns::Columns;
use super::contacts::{
    AnyLog, ContactColumns, PalmSetup, check_setups, contact_sample, contacts, palms_in_space,
};
use super::error::LogFileErrorKind as Kind;
use super::ordered::Times;
use super::planar::planar_log;
use super::planar_contacts::planar_contact_log;
use super::read::{Cells, EachRow, Row, Table, three_palms};
use recon::contact_kinematics::planar::PalmSurface;
use recon::object_dynamics::Sample;
use recon::object_dynamics::planar::{ContactLog as PlanarContactLog, PlanarLog};
use recon::observer::contacts::stream::PalmSensed;

/// A sensor log of version 1 or 2 from its columns, with the names and units of the format; `names` and `columns` are in the same order, and
/// all columns are of the same length. What a CSV file of these numbers gives, to the last bit.
///
/// # Errors
/// As for [`parse_any_log`](super::parse_any_log); where an error names a line, it is the row, counted from 0.
pub fn log_of_columns(
    names: &[String],
    columns: &[&[f64]],
    palms: Option<&[PalmSetup]>,
) -> Result<AnyLog, Kind> {
    let table = table(names, columns)?;
    if palms_in_space(&table.header)? == 0 {
        return table.three_palms().map(AnyLog::ThreePalms);
    }
    contacts(table, palms.ok_or(Kind::NoPalms)?).map(AnyLog::Contacts)
}

/// A planar sensor log of version 1 from its columns, as [`log_of_columns`].
///
/// # Errors
/// As for [`parse_planar_log`](super::parse_planar_log); where an error names a line, it is the row, counted from 0.
pub fn planar_log_of_columns(names: &[String], columns: &[&[f64]]) -> Result<PlanarLog, Kind> {
    planar_log(table(names, columns)?)
}

/// A planar sensor log of version 2 from its columns, as [`log_of_columns`].
///
/// # Errors
/// As for [`parse_planar_contact_log`](super::parse_planar_contact_log); where an error names a line, it is the row, counted from 0.
pub fn planar_contact_log_of_columns(
    names: &[String],
    columns: &[&[f64]],
    surfaces: &[PalmSurface],
) -> Result<PlanarContactLog, Kind> {
    planar_contact_log(table(names, columns)?, surfaces)
}

fn table<'a>(names: &[String], columns: &'a [&'a [f64]]) -> Result<Table<InMemory<'a>>, Kind> {
    let rows = InMemory { columns, count: columns.first().map_or(0, |first| first.len()) };
    if let Some((i, column)) = columns.iter().enumerate().find(|(_, column)| column.len() != rows.count) {
        let name = names.get(i).cloned().unwrap_or_default();
        return Err(Kind::ColumnLength { column: name, found: column.len(), expected: rows.count });
    }
    Ok(Table { header: names.iter().collect(), rows })
}

/// Columns of the same length.
struct InMemory<'a> {
    columns: &'a [&'a [f64]],
    count: usize,
}

impl EachRow for InMemory<'_> {
    fn each_row(self, mut take: impl FnMut(&Row) -> Result<(), Kind>) -> Result<(), Kind> {
        let mut numbers = vec![0.0; self.columns.len()];
        for k in 0..self.count {
            for (number, column) in numbers.iter_mut().zip(self.columns) {
                *number = column[k];
            }
            take(&Row { cells: Cells::Numbers(&numbers), line: k as u64 })?;
        }
        Ok(())
    }
}

/// The samples of a running log, from rows of numbers as they come; truth is not looked at.
pub struct RowReader {
    format: Format,
    times: Times,
    rows: u64,
}

enum Format {
    ThreePalms(Box<Columns>),
    Contacts(Box<ContactColumns>, Vec<PalmSetup>),
}

/// What a row of a log says.
#[derive(Clone, Debug, PartialEq)]
pub enum RowSample {
    /// Version 1.
    ThreePalms(Box<Sample>),
    /// Version 2: time in s, and what the palms sense.
    Contacts(f64, Vec<PalmSensed>),
}

impl RowReader {
    /// Rows that hold the columns of these names in this order. Version 2 needs the palms' shapes.
    ///
    /// # Errors
    /// A column that is needed is not there, or the palms are not described.
    pub fn new(names: &[String], palms: Option<&[PalmSetup]>) -> Result<Self, Kind> {
        let header: csv::StringRecord = names.iter().collect();
        let format = if palms_in_space(&header)? == 0 {
            Format::ThreePalms(Box::new(three_palms(&header)?))
        } else {
            let palms = palms.ok_or(Kind::NoPalms)?;
            let columns = ContactColumns::find(&header, palms.len())?;
            check_setups(&columns, palms)?;
            Format::Contacts(Box::new(columns), palms.to_vec())
        };
        Ok(Self { format, times: Times::default(), rows: 0 })
    }

    /// Whether the log is one of three flat palms through the origin (version 1).
    pub fn is_of_three_palms(&self) -> bool {
        matches!(self.format, Format::ThreePalms(_))
    }

    /// What the next row says. After an error the next row may be taken as if the one at fault had not been.
    ///
    /// # Errors
    /// As for [`parse_any_log`](super::parse_any_log); where an error names a line, it is the row, counted from 0.
    pub fn take(&mut self, row: &[f64]) -> Result<RowSample, Kind> {
        let row = Row { cells: Cells::Numbers(row), line: self.rows };
        self.rows += 1;
        let (time, sample) = match &self.format {
            Format::ThreePalms(columns) => {
                row.sample(columns).map(|sample| (sample.t, RowSample::ThreePalms(Box::new(sample))))?
            }
            Format::Contacts(columns, palms) => {
                let (t, palms) = contact_sample(&row, columns, palms)?;
                (t, RowSample::Contacts(t, palms))
            }
        };
        self.times.take(time, row.line)?;
        Ok(sample)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{parse_any_log, write_log};
    use recon::object_dynamics::SensorLog;

    /// Two samples of three palms, of which the last loses contact.
    const TEXT: &str = "t,s1_1,s2_1,nx_1,ny_1,nz_1,f_1,s1_2,s2_2,nx_2,ny_2,nz_2,f_2,s1_3,s2_3,nx_3,ny_3,nz_3,f_3\n\
        0,0.1,0.2,0,0.6,0.8,1,0.1,0.2,0.6,0,0.8,1,0.1,0.3,-0.6,0,0.8,1\n\
        0.001,0.1,0.2,0,0.6,0.8,1.5,0.1,0.2,0.6,0,0.8,1,nan,nan,-0.6,0,0.8,0\n";

    fn columns(text: &str) -> (Vec<String>, Vec<Vec<f64>>) {
        let mut lines = text.lines();
        let names: Vec<String> = lines.next().unwrap().split(',').map(str::to_owned).collect();
        let rows: Vec<Vec<f64>> =
            lines.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect();
        let columns = (0..names.len()).map(|i| rows.iter().map(|row| row[i]).collect()).collect();
        (names, columns)
    }

    fn log(names: &[String], columns: &[Vec<f64>]) -> Result<AnyLog, Kind> {
        log_of_columns(names, &columns.iter().map(Vec::as_slice).collect::<Vec<_>>(), None)
    }

    #[test]
    fn columns_give_the_planar_log_that_a_file_of_them_gives() {
        let hinged = "s2,s1,t,phi2,phi1,f1,f2\n0.05,0.04,0,1.5,0.7,1,2\nnan,0.041,0.001,1.5,0.7,1,nan\n";
        let (names, columns) = columns(hinged);
        let columns: Vec<_> = columns.iter().map(Vec::as_slice).collect();
        assert_eq!(
            planar_log_of_columns(&names, &columns).unwrap(),
            crate::parse_planar_log(hinged.as_bytes()).unwrap()
        );
        let wrong = planar_log_of_columns(&names, &columns[..6]).unwrap_err();
        assert!(matches!(wrong, Kind::FieldCount { line: 0, expected: 7, found: 6 }), "{wrong}");
    }

    #[test]
    fn columns_give_the_planar_contacts_that_a_file_of_them_gives() {
        let text =
            "t,px_1,py_1,Px_1,Py_1,angle_1,fx_1,fy_1\n0,0.1,0,0,0,0.01,0.5,2\n0.1,nan,nan,0,0,0.02,0,0\n";
        let (names, columns) = columns(text);
        let columns: Vec<_> = columns.iter().map(Vec::as_slice).collect();
        let made = planar_contact_log_of_columns(&names, &columns, &[PalmSurface::Line]).unwrap();
        assert_eq!(made, crate::parse_planar_contact_log(text.as_bytes(), &[PalmSurface::Line]).unwrap());
        assert!(made.samples()[1].palms[0].p_WC.is_none());
    }

    fn written(log: &SensorLog) -> Vec<u8> {
        let mut text = Vec::new();
        write_log(log, &mut text).unwrap();
        text
    }

    #[test]
    fn columns_give_the_log_that_a_file_of_them_gives() {
        let (names, columns) = columns(TEXT);
        let (Ok(AnyLog::ThreePalms(a)), Ok(AnyLog::ThreePalms(b))) =
            (log(&names, &columns), parse_any_log(TEXT.as_bytes(), None))
        else {
            panic!("both are logs of three palms")
        };
        assert_eq!(written(&a), written(&b));
        assert!(a.samples()[1].palms[2].contact.is_none());
    }

    #[test]
    fn what_is_wrong_is_named_with_its_row_and_column() {
        let (names, mut columns) = columns(TEXT);
        columns[3][1] = f64::INFINITY;
        let wrong = log(&names, &columns).unwrap_err();
        assert!(matches!(&wrong, Kind::NotFinite { line: 1, column, .. } if column == "nx_1"), "{wrong}");
        columns[3].pop();
        let wrong = log(&names, &columns).unwrap_err();
        assert!(
            matches!(&wrong, Kind::ColumnLength { column, found: 1, expected: 2 } if column == "nx_1"),
            "{wrong}"
        );
        let wrong = log(&names[..18], &columns[..3]).unwrap_err();
        assert!(matches!(wrong, Kind::FieldCount { line: 0, expected: 18, found: 3 }), "{wrong}");
    }

    #[test]
    fn rows_give_the_samples_of_the_log_and_must_go_on_in_time() {
        let (names, columns) = columns(TEXT);
        let Ok(AnyLog::ThreePalms(log)) = log(&names, &columns) else { panic!("a log of three palms") };
        let mut rows = RowReader::new(&names, None).unwrap();
        assert!(rows.is_of_three_palms());
        let row = |k: usize| columns.iter().map(|column| column[k]).collect::<Vec<f64>>();
        for (k, sample) in log.samples().iter().enumerate() {
            assert_eq!(rows.take(&row(k)).unwrap(), RowSample::ThreePalms(Box::new(*sample)));
        }
        assert!(matches!(rows.take(&row(0)), Err(Kind::Samples { line: Some(2), .. })));
        assert!(matches!(rows.take(&[0.0]), Err(Kind::FieldCount { line: 3, expected: 19, found: 1 })));
    }
}
