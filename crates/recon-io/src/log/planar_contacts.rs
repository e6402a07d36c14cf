//! Planar sensor logs, version 2: palms of any number, shape, pose and motion.

use super::columns::{Field, Header};
use super::contacts::check_palms;
use super::error::{LogFileError, LogFileErrorKind as Kind};
use super::planar::{TRUTH, end_row};
use super::read::{EachRow, Row, Table};
use glam::DVec2;
use recon::contact_kinematics::planar::{PalmSurface, SurfacePose};
use recon::object_dynamics::planar::{
    ContactLog, ContactLogError, ContactLogSample, PalmSample, PlanarTruth,
};
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

/// Reads a planar sensor log, version 2, from a CSV file. The shapes of the palms stand in `surfaces`.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_planar_contact_log(
    path: impl AsRef<Path>,
    surfaces: &[PalmSurface],
) -> Result<ContactLog, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_planar_contact_log(BufReader::new(file), surfaces).map_err(in_file)
}

/// Reads a planar sensor log, version 2, from CSV text; columns are found by name, in any order.
///
/// # Errors
/// [`LogFileErrorKind`](super::LogFileErrorKind) names the line and the column.
pub fn parse_planar_contact_log(text: impl Read, surfaces: &[PalmSurface]) -> Result<ContactLog, Kind> {
    planar_contact_log(Table::open(text)?, surfaces)
}

/// The samples of a table of version 2.
pub(super) fn planar_contact_log(
    table: Table<impl EachRow>,
    surfaces: &[PalmSurface],
) -> Result<ContactLog, Kind> {
    let columns = Columns::find(&table.header, surfaces.len())?;
    let (mut samples, mut truth, mut lines) = (Vec::new(), Vec::new(), Vec::new());
    table.each_row(|row| {
        row.check_count(columns.count)?;
        let palm = |(i, palm): (usize, &PalmColumns)| palm.read(i + 1, row);
        let palms = columns.palms.iter().enumerate().map(palm).collect::<Result<_, _>>()?;
        samples.push(ContactLogSample { t: row.finite(&columns.t)?, palms });
        if let Some(fields) = &columns.truth {
            let [cmx, cmy, phi0, vx, vy, omega0] = row.vector(fields)?;
            let (p_WCm, v_WCm) = (DVec2::new(cmx, cmy), DVec2::new(vx, vy));
            truth.push(PlanarTruth { p_WCm, phi0, v_WCm, omega0 });
        }
        lines.push(row.line);
        Ok(())
    })?;
    let truth = columns.truth.is_some().then_some(truth);
    ContactLog::new(surfaces.to_vec(), samples, truth).map_err(|source| Kind::PlanarContactSamples {
        line: sample_of(&source).and_then(|sample| lines.get(sample).copied()),
        source,
    })
}

/// Where each quantity stands in a row.
struct Columns {
    count: usize,
    t: Field,
    palms: Vec<PalmColumns>,
    /// Present only where all six are.
    truth: Option<[Field; 6]>,
}

struct PalmColumns {
    contact: [Field; 2],
    pose: [Field; 3],
    force: [Field; 2],
    impulse: Option<[Field; 2]>,
}

impl Columns {
    fn find(record: &csv::StringRecord, palms: usize) -> Result<Self, Kind> {
        let header = Header::new(record);
        check_palms(record, palms)?;
        let palm = |i: usize| -> Result<PalmColumns, Kind> {
            let need = |stem: &str| header.need(format!("{stem}_{i}"));
            let measured = header.find(format!("Jx_{i}"))?.or(header.find(format!("Jy_{i}"))?).is_some();
            Ok(PalmColumns {
                contact: [need("px")?, need("py")?],
                pose: [need("Px")?, need("Py")?, need("angle")?],
                force: [need("fx")?, need("fy")?],
                impulse: if measured { Some([need("Jx")?, need("Jy")?]) } else { None },
            })
        };
        let truth = header.all(TRUTH)?;
        Ok(Self {
            count: header.names.len(),
            t: header.need("t".to_owned())?,
            palms: (1..=palms).map(palm).collect::<Result<_, _>>()?,
            truth,
        })
    }
}

impl PalmColumns {
    fn read(&self, number: usize, row: &Row) -> Result<PalmSample, Kind> {
        let value = [row.number(&self.contact[0])?, row.number(&self.contact[1])?];
        let p_WC = match value.iter().filter(|v| v.is_nan()).count() {
            2 => None,
            0 => Some(row.vector(&self.contact)?.into()),
            _ => {
                let columns = self.contact.each_ref().map(|field| field.name.as_str()).join(", ");
                let (line, value) = (row.line, value.to_vec());
                return Err(Kind::PartOfContact { line, palm: number, columns, value });
            }
        };
        let [x, y, angle] = row.vector(&self.pose)?;
        let force = |field: &Field| -> Result<f64, Kind> {
            let force = row.number(field)?;
            match (p_WC, force.is_nan() || force == 0.0) {
                (Some(_), _) => row.finite(field),
                (None, true) => Ok(0.0),
                (None, false) => {
                    let (line, column) = (row.line, field.name.clone());
                    Err(Kind::ForceOffContact { line, column, palm: number, force })
                }
            }
        };
        Ok(PalmSample {
            pose: SurfacePose { p_WP: DVec2::new(x, y), angle },
            p_WC,
            force: DVec2::new(force(&self.force[0])?, force(&self.force[1])?),
            impulse: self.impulse.as_ref().map(|fields| row.vector(fields)).transpose()?.map(DVec2::from),
        })
    }
}

fn sample_of(error: &ContactLogError) -> Option<usize> {
    match *error {
        ContactLogError::Series(series) => series.sample(),
        ContactLogError::Readings { sample, .. }
        | ContactLogError::NotFinite { sample, .. }
        | ContactLogError::TooLarge { sample, .. } => Some(sample),
        // Errors of the palms as a whole.
        _ => None,
    }
}

/// Writes a planar sensor log, version 2, with numbers that read back bit for bit; impulses where every sample of the palm has
/// one, truth where the log has it. Shapes and friction of the palms stand in the scene, not in the log.
///
/// # Errors
/// Those of `to`.
pub fn write_planar_contact_log(log: &ContactLog, mut to: impl Write) -> io::Result<()> {
    let measured: Vec<bool> = (0..log.surfaces().len())
        .map(|i| log.samples().iter().all(|sample| sample.palms[i].impulse.is_some()))
        .collect();
    let mut names = vec!["t".to_owned()];
    for (i, measured) in measured.iter().enumerate() {
        let stems = ["px", "py", "Px", "Py", "angle", "fx", "fy"];
        let impulse = ["Jx", "Jy"].into_iter().filter(|_| *measured);
        names.extend(stems.into_iter().chain(impulse).map(|stem| format!("{stem}_{}", i + 1)));
    }
    names.extend(TRUTH.iter().filter(|_| log.truth().is_some()).map(|name| (*name).to_owned()));
    writeln!(to, "{}", names.join(","))?;
    for (k, sample) in log.samples().iter().enumerate() {
        let mut row = vec![sample.t];
        for (palm, measured) in sample.palms.iter().zip(&measured) {
            let contact = palm.p_WC.unwrap_or(DVec2::NAN);
            let SurfacePose { p_WP, angle } = palm.pose;
            row.extend([contact.x, contact.y, p_WP.x, p_WP.y, angle, palm.force.x, palm.force.y]);
            row.extend(palm.impulse.filter(|_| *measured).into_iter().flat_map(|impulse| impulse.to_array()));
        }
        end_row(row, log.truth().map(|truth| &truth[k]), &mut to)?;
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const HEADER: &str = "t,px_1,py_1,Px_1,Py_1,angle_1,fx_1,fy_1,Jx_1,Jy_1,px_2,py_2,Px_2,Py_2,angle_2,fx_2,fy_2,\
                          cmx,cmy,phi0,vx,vy,omega0,comment";
    const ROWS: [&str; 2] = [
        "0,0.1,0,0,0,0.01,0.5,2,0,0,nan,nan,0,1,3.1,nan,0,0.1,0.05,0.2,0.3,0,1,a",
        "0.1,0.11,0,0,0,0.02,0.5,2.5,0.05,0.2,0.1,0.9,0,1,3.1,0.1,-1,0.1,0.05,0.2,0.3,0,1,b",
    ];
    const SURFACES: [PalmSurface; 2] = [PalmSurface::Line, PalmSurface::Arc { radius: 0.1 }];

    fn with(row: usize, column: &str, value: &str) -> Result<ContactLog, Kind> {
        let place = HEADER.split(',').position(|name| name == column).unwrap();
        let mut rows = ROWS.map(|row| row.split(',').collect::<Vec<_>>());
        rows[row][place] = value;
        let text = [HEADER.to_owned(), rows[0].join(","), rows[1].join(",")].join("\n");
        parse_planar_contact_log(text.as_bytes(), &SURFACES)
    }

    #[test]
    fn what_the_columns_say_is_read() {
        let log = with(0, "t", "0").unwrap();
        let [line, arc] = &log.samples()[0].palms[..] else { panic!("two palms") };
        assert_eq!((line.p_WC, line.force), (Some(DVec2::new(0.1, 0.0)), DVec2::new(0.5, 2.0)));
        assert_eq!((line.pose.angle, line.impulse), (0.01, Some(DVec2::ZERO)));
        assert_eq!((arc.p_WC, arc.force, arc.impulse), (None, DVec2::ZERO, None));
        assert_eq!(log.samples()[1].palms[1].pose.p_WP, DVec2::Y);
        assert_eq!(log.truth().unwrap()[0].omega0, 1.0);
        assert_eq!(log.surfaces(), SURFACES);
    }

    #[test]
    fn bad_cells_are_named_by_line_and_column() {
        let finite = |row, column: &str, value: &str| match with(row, column, value) {
            Err(Kind::NotFinite { line, column, .. }) => (line, column),
            other => panic!("{other:?}"),
        };
        assert_eq!(finite(1, "fx_1", "nan"), (3, "fx_1".to_owned()));
        assert_eq!(finite(0, "angle_2", "inf"), (2, "angle_2".to_owned()));
        assert_eq!(finite(0, "Jx_1", "nan"), (2, "Jx_1".to_owned()));
        assert!(matches!(with(0, "Px_1", "left"), Err(Kind::NotANumber { line: 2, .. })));
        let half = with(1, "py_1", "nan").unwrap_err();
        assert!(matches!(half, Kind::PartOfContact { line: 3, palm: 1, .. }), "{half}");
        assert!(half.to_string().contains("(px_1, py_1) is (0.11, NaN)"), "{half}");
        let ghost = with(0, "fy_2", "0.5");
        assert!(
            matches!(ghost, Err(Kind::ForceOffContact { line: 2, palm: 2, column, .. }) if column == "fy_2")
        );
        let back = with(1, "t", "-1").unwrap_err();
        assert!(matches!(back, Kind::PlanarContactSamples { line: Some(3), .. }), "{back}");
    }

    #[test]
    fn columns_that_are_missing_are_named() {
        let text = |from: &str, to: &str| [&HEADER.replacen(from, to, 1), ROWS[0], ROWS[1]].join("\n");
        let missing =
            |from: &str, to: &str| match parse_planar_contact_log(text(from, to).as_bytes(), &SURFACES) {
                Err(Kind::MissingColumn { column, .. }) => column,
                other => panic!("{other:?}"),
            };
        assert_eq!(missing("angle_2", "phi_2"), "angle_2");
        assert_eq!(missing("fy_1", "fz_1"), "fy_1");
        assert_eq!(missing("Jy_1", "J_1"), "Jy_1");
        assert_eq!(missing("t,", "time,"), "t");
        let three = [SURFACES[0]; 3];
        let count = parse_planar_contact_log(text("t,", "t,").as_bytes(), &three);
        assert!(matches!(count, Err(Kind::PalmCount { expected: 3, found: 2 })));
    }

    proptest! {
        #[test]
        fn logs_read_back_bit_for_bit(
            rows in proptest::collection::vec(([-3.0..3.0f64, -1.0..1.0], any::<bool>(), -9.0..9.0f64), 2..12),
            impulse in any::<bool>(), truth in any::<bool>(),
        ) {
            let palm = |(p, touched, f): ([f64; 2], bool, f64)| PalmSample {
                pose: SurfacePose { p_WP: DVec2::from(p) / 3.0, angle: f / 7.0 },
                p_WC: touched.then_some(p.into()),
                force: if touched { DVec2::new(f, 1.0 / 3.0) } else { DVec2::ZERO },
                impulse: impulse.then_some(DVec2::splat(f / 11.0)),
            };
            let samples: Vec<_> = rows.iter().enumerate().map(|(k, &row)| ContactLogSample {
                t: k as f64 * 0.1,
                palms: vec![palm(row), palm((row.0, true, 0.5 * row.2))],
            }).collect();
            let truth = truth.then(|| vec![PlanarTruth { phi0: 0.1, omega0: 1.0 / 3.0, ..PlanarTruth::default() }; samples.len()]);
            let log = ContactLog::new(SURFACES.to_vec(), samples, truth).unwrap();
            let mut text = Vec::new();
            write_planar_contact_log(&log, &mut text).unwrap();
            prop_assert_eq!(parse_planar_contact_log(text.as_slice(), &SURFACES).unwrap(), log);
        }
    }
}
