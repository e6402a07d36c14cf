//! Planar sensor logs, version 1: two palms hinged at the origin.

use super::columns::{Field, Header};
use super::contacts::palms_in_space;
use super::error::{LogFileError, LogFileErrorKind as Kind};
use super::read::{EachRow, Row, Table};
use crate::number::exact;
use glam::DVec2;
use recon::object_dynamics::planar::{PlanarLog, PlanarLogError, PlanarSample, PlanarTruth};
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

pub(super) const TRUTH: [&str; 6] = ["cmx", "cmy", "phi0", "vx", "vy", "omega0"];

/// Where each quantity stands in a row.
struct Columns {
    count: usize,
    needed: [Field; 5],
    forces: Option<[Field; 2]>,
    torques: Option<[Field; 2]>,
    /// Present only where all six are.
    truth: Option<[Field; 6]>,
}

impl Columns {
    fn find(record: &csv::StringRecord) -> Result<Self, Kind> {
        if palms_in_space(record)? > 0 {
            return Err(Kind::AnyPalms { read: "two palms hinged at the origin (phi1, phi2, s1, s2)" });
        }
        let header = Header::new(record);
        let need = |name: &str| header.need(name.to_owned());
        let pair = |names: [&str; 2]| -> Result<Option<[Field; 2]>, Kind> {
            let [a, b] = names.map(|name| header.find(name.to_owned()));
            Ok(a?.zip(b?).map(|(a, b)| [a, b]))
        };
        let truth = header.all(TRUTH)?;
        Ok(Self {
            count: header.names.len(),
            needed: [need("t")?, need("phi1")?, need("phi2")?, need("s1")?, need("s2")?],
            forces: pair(["f1", "f2"])?,
            torques: pair(["tau1", "tau2"])?,
            truth,
        })
    }
}

/// Reads a planar sensor log, version 1, from a CSV file.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_planar_log(path: impl AsRef<Path>) -> Result<PlanarLog, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_planar_log(BufReader::new(file)).map_err(in_file)
}

/// Reads a planar sensor log, version 1, from CSV text: `t, phi1, phi2, s1, s2`, and where they are there in pairs `f1, f2`
/// and `tau1, tau2`, found by name in any order. A palm without contact has `s = nan`, and what its force and torque columns
/// say is then taken as zero where it is nan.
///
/// # Errors
/// [`LogFileErrorKind`](super::LogFileErrorKind) names the line and the column.
pub fn parse_planar_log(text: impl Read) -> Result<PlanarLog, Kind> {
    planar_log(Table::open(text)?)
}

/// The samples of a table of version 1.
pub(super) fn planar_log(table: Table<impl EachRow>) -> Result<PlanarLog, Kind> {
    let columns = Columns::find(&table.header)?;
    let (mut samples, mut truth, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    table.each_row(|row| {
        row.check_count(columns.count)?;
        samples.push(sample(row, &columns)?);
        if let Some(fields) = &columns.truth {
            let [cmx, cmy, phi0, vx, vy, omega0] = row.vector(fields)?;
            truth.push(PlanarTruth { p_WCm: DVec2::new(cmx, cmy), phi0, v_WCm: DVec2::new(vx, vy), omega0 });
        }
        lines.push(row.line);
        Ok(())
    })?;
    let truth = (!truth.is_empty()).then_some(truth);
    PlanarLog::new(samples, truth).map_err(|source| Kind::PlanarSamples {
        line: sample_of(&source).and_then(|k| lines.get(k).copied()),
        source,
    })
}

fn sample(row: &Row, columns: &Columns) -> Result<PlanarSample, Kind> {
    let [t, phi1, phi2, s1, s2] = &columns.needed;
    let contact = |field: &Field| -> Result<Option<f64>, Kind> {
        let value = row.number(field)?;
        if value.is_nan() { Ok(None) } else { row.finite(field).map(Some) }
    };
    let contacts = [contact(s1)?, contact(s2)?];
    let pair = |fields: &Option<[Field; 2]>| -> Result<Option<[f64; 2]>, Kind> {
        let Some(fields) = fields else { return Ok(None) };
        let mut values = [0.0; 2];
        for i in 0..2 {
            let away = contacts[i].is_none() && row.number(&fields[i])?.is_nan();
            values[i] = if away { 0.0 } else { row.finite(&fields[i])? };
        }
        Ok(Some(values))
    };
    Ok(PlanarSample {
        t: row.finite(t)?,
        angles: [row.finite(phi1)?, row.finite(phi2)?],
        contacts,
        forces: pair(&columns.forces)?,
        torques: pair(&columns.torques)?,
    })
}

fn sample_of(error: &PlanarLogError) -> Option<usize> {
    match *error {
        PlanarLogError::NotFinite { sample, .. }
        | PlanarLogError::TooLarge { sample, .. }
        | PlanarLogError::NegativeForce { sample, .. }
        | PlanarLogError::Palms { sample, .. } => Some(sample),
        PlanarLogError::Series(series) => series.sample(),
        _ => None,
    }
}

/// Writes a row of a planar log, the truth behind what was measured.
pub(super) fn end_row(mut row: Vec<f64>, truth: Option<&PlanarTruth>, to: &mut impl Write) -> io::Result<()> {
    if let Some(PlanarTruth { p_WCm: p, phi0, v_WCm: v, omega0 }) = truth {
        row.extend([p.x, p.y, *phi0, v.x, v.y, *omega0]);
    }
    let row: Vec<String> = row.into_iter().map(exact).collect();
    writeln!(to, "{}", row.join(","))
}

/// Writes a planar sensor log, version 1, with numbers that read back bit for bit. Forces and torques are written where some
/// sample has them, truth where the log has it.
///
/// # Errors
/// Those of `to`.
pub fn write_planar_log(log: &PlanarLog, mut to: impl Write) -> io::Result<()> {
    let forces = log.samples().iter().any(|s| s.forces.is_some());
    let torques = log.samples().iter().any(|s| s.torques.is_some());
    let mut names = vec!["t", "phi1", "phi2", "s1", "s2"];
    names.extend(["f1", "f2"].iter().filter(|_| forces));
    names.extend(["tau1", "tau2"].iter().filter(|_| torques));
    names.extend(TRUTH.iter().filter(|_| log.truth().is_some()));
    writeln!(to, "{}", names.join(","))?;
    for (k, s) in log.samples().iter().enumerate() {
        let contacts = s.contacts.map(|c| c.unwrap_or(f64::NAN));
        let mut row = vec![s.t, s.angles[0], s.angles[1], contacts[0], contacts[1]];
        for values in [s.forces.filter(|_| forces), s.torques.filter(|_| torques)].into_iter().flatten() {
            row.extend(values);
        }
        end_row(row, log.truth().map(|truth| &truth[k]), &mut to)?;
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const GOOD: &str = "s2,s1,t,phi2,phi1,f1,f2\n0.05,0.04,0,1.5,0.7,1,2\nnan,0.041,0.001,1.5,0.7,1,nan\n";

    fn parse(text: &str) -> Result<PlanarLog, Kind> {
        parse_planar_log(text.as_bytes())
    }

    #[test]
    fn columns_are_found_by_name_and_lost_contact_is_kept() {
        let log = parse(GOOD).unwrap();
        assert_eq!(log.samples()[0].contacts, [Some(0.04), Some(0.05)]);
        assert_eq!(log.samples()[1].forces, Some([1.0, 0.0]));
        assert_eq!(log.first_contact_loss(), Some((1, 1)));
        assert_eq!(log.samples()[0].torques, None);
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        let text = |e: Kind| e.to_string();
        let missing = text(parse("t,phi1,phi2,s1\n").unwrap_err());
        assert!(missing.contains("`s2`"), "{missing}");
        let word = text(parse(&GOOD.replace("0.041", "four")).unwrap_err());
        assert!(word.contains("line 3") && word.contains("`s1`") && word.contains("four"), "{word}");
        let flat = text(parse(&GOOD.replace("0.001,1.5", "0.001,3.5")).unwrap_err());
        assert!(flat.contains("line 3") && flat.contains("between 0 and pi"), "{flat}");
        let back = text(parse(&GOOD.replace("0.001", "-1")).unwrap_err());
        assert!(back.contains("line 3") && back.contains("-1"), "{back}");
        let pull = text(parse(&GOOD.replace("0.7,1,nan", "0.7,-1,nan")).unwrap_err());
        assert!(pull.contains("line 3") && pull.contains("palm 1") && pull.contains("cannot pull"), "{pull}");
        assert!(matches!(parse(""), Err(Kind::Empty)));
        assert!(matches!(
            parse("t,phi1,phi2,s1,s2\n1,2\n"),
            Err(Kind::FieldCount { line: 2, expected: 5, found: 2 })
        ));
    }

    proptest! {
        #[test]
        fn logs_read_back_bit_for_bit(rows in proptest::collection::vec((-3.0..3.0f64, 0.01..3.1f64, any::<bool>(), 0.0..1.0f64), 2..20),
                                      forces in any::<bool>(), truth in any::<bool>()) {
            let samples: Vec<PlanarSample> = rows.iter().enumerate().map(|(k, &(phi1, phi2, touch, s))| PlanarSample {
                t: k as f64 * 0.1,
                angles: [phi1, phi2],
                contacts: [Some(s), touch.then_some(s * 0.3)],
                forces: forces.then_some([s * 7.0, 0.0]),
                torques: None,
            }).collect();
            let truth = truth.then(|| vec![PlanarTruth { phi0: 0.1, omega0: 1.0 / 3.0, ..PlanarTruth::default() }; samples.len()]);
            let log = PlanarLog::new(samples, truth).unwrap();
            let mut text = Vec::new();
            write_planar_log(&log, &mut text).unwrap();
            prop_assert_eq!(parse_planar_log(text.as_slice()).unwrap(), log);
        }
    }
}
