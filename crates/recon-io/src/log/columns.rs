use super::error::LogFileErrorKind as Kind;
use std::collections::HashMap;

/// Truth columns, in the order in which [`super::read`] takes them.
pub(crate) const TRUTH: [&str; 13] =
    ["cmx", "cmy", "cmz", "qw", "qx", "qy", "qz", "vx", "vy", "vz", "wx", "wy", "wz"];

/// Where each quantity stands in a row.
pub(super) struct Columns {
    pub(super) count: usize,
    pub(super) t: Field,
    pub(super) palms: [PalmColumns; 3],
    /// Present only where all thirteen are.
    pub(super) truth: Option<[Field; 13]>,
}

/// One column: its place, and its name for messages.
#[derive(Clone)]
pub(super) struct Field {
    pub(super) index: usize,
    pub(super) name: String,
}

pub(super) struct PalmColumns {
    pub(super) s: [Field; 2],
    pub(super) normal: [Field; 3],
    pub(super) force: Option<Field>,
    pub(super) torque: Option<Field>,
    pub(super) rate: Option<Field>,
}

impl Columns {
    /// Finds the format's columns by name in a header row.
    pub(super) fn find(header: &csv::StringRecord) -> Result<Self, Kind> {
        let header = Header::new(header);
        let palm = |i: usize| -> Result<PalmColumns, Kind> {
            let need = |stem: &str| header.need(format!("{stem}_{i}"));
            let may = |stem: &str| header.find(format!("{stem}_{i}"));
            Ok(PalmColumns {
                s: [need("s1")?, need("s2")?],
                normal: [need("nx")?, need("ny")?, need("nz")?],
                force: may("f")?,
                torque: may("tau")?,
                rate: may("rate")?,
            })
        };
        let truth = header.all(TRUTH)?;
        Ok(Self {
            count: header.names.len(),
            t: header.need("t".to_owned())?,
            palms: [palm(1)?, palm(2)?, palm(3)?],
            truth,
        })
    }
}

pub(super) struct Header {
    pub(super) names: Vec<String>,
    places: HashMap<String, Vec<usize>>,
}

impl Header {
    pub(super) fn new(record: &csv::StringRecord) -> Self {
        let names: Vec<String> =
            record.iter().map(|n| n.trim_start_matches('\u{feff}').trim().to_owned()).collect();
        let mut places: HashMap<String, Vec<usize>> = HashMap::new();
        for (index, name) in names.iter().enumerate() {
            places.entry(name.clone()).or_default().push(index);
        }
        Self { names, places }
    }

    /// The columns of these names, where all of them are there.
    pub(super) fn all<const N: usize>(&self, names: [&str; N]) -> Result<Option<[Field; N]>, Kind> {
        let mut found = Vec::with_capacity(N);
        for name in names {
            found.extend(self.find(name.to_owned())?);
        }
        Ok(found.try_into().ok())
    }

    pub(super) fn find(&self, name: String) -> Result<Option<Field>, Kind> {
        match self.places.get(&name).map(Vec::as_slice) {
            None => Ok(None),
            Some(&[index]) => Ok(Some(Field { index, name })),
            Some(_) => Err(Kind::RepeatedColumn { column: name }),
        }
    }

    pub(super) fn need(&self, column: String) -> Result<Field, Kind> {
        self.find(column.clone())?.ok_or_else(|| {
            let wanted = plain(&column);
            let similar = self.names.iter().find(|n| plain(n) == wanted).cloned();
            Kind::MissingColumn { column, similar, found: self.names.join(", ") }
        })
    }
}

/// A name without case and punctuation: `S1.1` and `s1_1` are most likely meant to be the same.
fn plain(name: &str) -> String {
    name.chars().filter(char::is_ascii_alphanumeric).map(|c| c.to_ascii_lowercase()).collect()
}
