use super::{LogFileErrorKind as Kind, LogReader, parse_log, write_log};
use glam::{DQuat, DVec3};
use proptest::prelude::*;
use recon::contact_kinematics::PalmFrame;
use recon::object_dynamics::{LogError, PalmReading, Sample, SensorLog, SeriesError, TrueState};
use std::io::Cursor;

/// A log as text: two samples of three palms 120 degrees apart, edited cell by cell in the tests below.
struct Table {
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Table {
    fn good() -> Self {
        let mut header = vec!["t".to_owned()];
        let mut row = vec!["0".to_owned()];
        for i in 1..=3 {
            let n = PalmFrame::from_azimuth_slope(2.1 * f64::from(i), 1.0).n;
            for (stem, value) in [("s1", 0.1), ("s2", 2.0), ("nx", n.x), ("ny", n.y), ("nz", n.z), ("f", 6.5)]
            {
                header.push(format!("{stem}_{i}"));
                row.push(value.to_string());
            }
        }
        let mut second = row.clone();
        second[0] = "0.001".to_owned();
        Self { header, rows: vec![row, second] }
    }

    fn set(mut self, row: usize, column: &str, value: &str) -> Self {
        let place = self.header.iter().position(|h| h == column).unwrap();
        self.rows[row][place] = value.to_owned();
        self
    }

    fn parse(&self) -> Result<SensorLog, Kind> {
        let mut text = self.header.join(",");
        for row in &self.rows {
            text.push('\n');
            text.push_str(&row.join(","));
        }
        parse_log(text.as_bytes())
    }
}

#[test]
fn good_table_is_read() {
    let log = Table::good().parse().unwrap();
    assert_eq!(log.samples().len(), 2);
    assert_eq!(log.samples()[1].palms[2].contact, Some([0.1, 2.0]));
    assert!(log.truth().is_none());
}

#[test]
fn order_of_columns_extra_columns_blanks_and_byte_order_mark_do_not_matter() {
    let mut table = Table::good();
    let reference = table.parse().unwrap();
    table.header.reverse();
    table.rows.iter_mut().for_each(|r| r.reverse());
    table.header.insert(0, "\u{feff} camera frame".to_owned());
    table.rows.iter_mut().for_each(|r| r.insert(0, "not a number".to_owned()));
    table.header.iter_mut().for_each(|h| *h = format!(" {h} "));
    assert_eq!(table.parse().unwrap(), reference);
}

#[test]
fn missing_column_is_named_with_the_one_that_was_probably_meant() {
    let mut table = Table::good();
    table.header[1] = "S1-1".to_owned();
    let Err(Kind::MissingColumn { column, similar, .. }) = table.parse() else { panic!("not refused") };
    assert_eq!((column.as_str(), similar.as_deref()), ("s1_1", Some("S1-1")));
    let mut table = Table::good();
    table.header[6] = "s2_1".to_owned(); // in place of f_1, which a log may do without
    assert!(matches!(table.parse(), Err(Kind::RepeatedColumn { column }) if column == "s2_1"));
}

#[test]
fn bad_cells_are_named_by_line_and_column() {
    let at = |row, column: &str, value: &str| Table::good().set(row, column, value).parse().unwrap_err();
    assert!(matches!(at(1, "t", "nan"), Kind::NotFinite { line: 3, column, .. } if column == "t"));
    assert!(matches!(at(0, "t", "inf"), Kind::NotFinite { line: 2, .. }));
    assert!(
        matches!(at(0, "nx_2", "0,5"), Kind::FieldCount { line: 2, expected: 19, found: 20 }),
        "a decimal comma splits the field"
    );
    assert!(
        matches!(at(1, "f_3", "six"), Kind::NotANumber { line: 3, column, text } if column == "f_3" && text == "six")
    );
    assert!(matches!(at(1, "f_3", "nan"), Kind::NotFinite { line: 3, .. }));
    assert!(matches!(at(1, "s1_2", "nan"), Kind::HalfContact { line: 3, palm: 2, .. }));
    assert!(matches!(at(1, "nz_3", "1.5"), Kind::Normal { line: 3, palm: 3, .. }));
    assert!(matches!(
        at(1, "t", "0"),
        Kind::Samples {
            line: Some(3),
            source: LogError::Series(SeriesError::TimeNotIncreasing { sample: 1, .. })
        }
    ));
    assert!(matches!(
        at(0, "f_2", "-5"),
        Kind::Samples { line: Some(2), source: LogError::NegativeForce { palm: 2, .. } }
    ));
}

#[test]
fn no_contact_is_two_nans_and_no_force() {
    let free = || Table::good().set(1, "s1_2", "nan").set(1, "s2_2", "NaN");
    for force in ["0", "nan", "-0.0"] {
        let palm = free().set(1, "f_2", force).parse().unwrap().samples()[1].palms[1];
        assert_eq!((palm.contact, palm.force), (None, Some(0.0)));
    }
    assert!(matches!(free().parse(), Err(Kind::ForceWithoutContact { line: 3, palm: 2, .. })));
}

#[test]
fn palms_without_frame_or_without_span_are_refused() {
    let vertical = Table::good().set(0, "nx_1", "0").set(0, "ny_1", "0").set(0, "nz_1", "1");
    assert!(matches!(vertical.parse(), Err(Kind::Palm { line: 2, palm: 1, .. })));
    let copy = |row: usize, mut table: Table| {
        for axis in ["nx", "ny", "nz"] {
            let from = table.header.iter().position(|h| *h == format!("{axis}_1")).unwrap();
            let value = table.rows[row][from].clone();
            table = table.set(row, &format!("{axis}_2"), &value);
        }
        table
    };
    assert!(
        copy(0, Table::good()).parse().is_ok(),
        "one sample with parallel palms is left to the estimator"
    );
    assert!(matches!(copy(1, copy(0, Table::good())).parse(), Err(Kind::Palms { line: 2, .. })));
}

#[test]
fn too_little_is_named() {
    assert!(matches!(parse_log("".as_bytes()), Err(Kind::Empty)));
    assert!(matches!(parse_log("\n\n".as_bytes()), Err(Kind::Empty)));
    let mut table = Table::good();
    table.rows.truncate(1);
    assert!(matches!(
        table.parse(),
        Err(Kind::Samples { source: LogError::Series(SeriesError::TooShort { found: 1 }), .. })
    ));
    table.rows.clear();
    assert!(matches!(
        table.parse(),
        Err(Kind::Samples { source: LogError::Series(SeriesError::TooShort { found: 0 }), .. })
    ));
}

#[test]
fn bytes_that_are_not_text_are_an_error() {
    assert!(matches!(parse_log(&b"t,\xff\xfe\n1,2\n"[..]), Err(Kind::Csv(_))));
}

fn any_vector() -> impl Strategy<Value = DVec3> {
    [-1e3..1e3, -1.0..1.0, -1e-9..1e-9f64].prop_map(DVec3::from_array)
}

fn any_palm(azimuth: f64) -> impl Strategy<Value = PalmReading> {
    let contact =
        prop_oneof![3 => (-3.0..3.0f64, 0.0..4.0f64).prop_map(|(a, b)| Some([a, b])), 1 => Just(None)];
    (0.3..1.3f64, contact, 0.0..9.0f64, -2.0..2.0f64).prop_map(move |(slope, contact, force, rate)| {
        let n = PalmFrame::from_azimuth_slope(azimuth, slope).n;
        PalmReading {
            normal: recon::contact_kinematics::Direction::new(n).unwrap(),
            contact,
            force: Some(if contact.is_some() { force } else { 0.0 }),
            torque: None,
            rate: Some(rate),
        }
    })
}

proptest! {
    #[test]
    fn what_is_written_reads_back(
        palms in proptest::collection::vec((any_palm(0.1), any_palm(2.2), any_palm(4.3)), 2..6),
        p in any_vector(), w in any_vector(), angle in any_vector(),
    ) {
        let truth = TrueState { p_WCm: p, R_WO: DQuat::from_scaled_axis(angle), v_WCm: w * 0.1, w_WO: w };
        let samples: Vec<_> = palms
            .into_iter()
            .enumerate()
            .map(|(k, (a, b, c))| Sample { t: k as f64 / 3.0, palms: [a, b, c] })
            .collect();
        let rows = vec![truth; samples.len()];
        let log = SensorLog::new(samples, Some(rows)).unwrap();
        let mut text = Vec::new();
        write_log(&log, &mut text).unwrap();
        let back = parse_log(&text[..]).unwrap();
        for (a, b) in log.samples().iter().zip(back.samples()) {
            prop_assert_eq!(a.t, b.t);
            for (palm, read) in a.palms.iter().zip(&b.palms) {
                prop_assert_eq!((palm.contact, palm.force, palm.rate), (read.contact, read.force, read.rate));
                prop_assert!((palm.normal.get() - read.normal.get()).length() < 4.0 * f64::EPSILON);
            }
        }
        let (before, after) = (log.truth().unwrap()[0], back.truth().unwrap()[0]);
        prop_assert_eq!((before.p_WCm, before.w_WO), (after.p_WCm, after.w_WO));
        prop_assert!(before.R_WO.dot(after.R_WO) > 1.0 - 4.0 * f64::EPSILON);
    }

    #[test]
    fn no_text_makes_it_panic(text in "[t,s12nxyzf_\n\".0-9e -]{0,200}") {
        let _ = parse_log(text.as_bytes());
    }
}

fn planes<R: std::io::Read>(reader: LogReader<R>) -> super::PlaneRows<R> {
    match reader {
        LogReader::ThreePalms(rows) => *rows,
        LogReader::Contacts(_) => panic!("not of three planes"),
    }
}

#[test]
fn samples_come_one_by_one_as_from_the_whole_log() {
    let text = |table: &Table| {
        let lines: Vec<_> =
            std::iter::once(&table.header).chain(&table.rows).map(|row| row.join(",")).collect();
        lines.join("\n")
    };
    let good = Table::good();
    let one_by_one: Vec<Sample> =
        planes(LogReader::new(text(&good).as_bytes(), None).unwrap()).map(Result::unwrap).collect();
    assert_eq!(one_by_one, good.parse().unwrap().samples());
    // An error names its line, and ends the samples.
    let stuck = Table::good().set(1, "t", "0");
    let mut samples = planes(LogReader::new(Cursor::new(text(&stuck)), None).unwrap());
    assert!(samples.next().unwrap().is_ok());
    let error = samples.next().unwrap().unwrap_err();
    assert!(
        matches!(
            error,
            Kind::Samples { line: Some(3), source: LogError::Series(SeriesError::TimeNotIncreasing { .. }) }
        ),
        "{error}"
    );
    assert!(samples.next().is_none());
    assert!(matches!(LogReader::new("".as_bytes(), None), Err(Kind::Empty)));
}
