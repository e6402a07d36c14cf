use super::super::columns::{Field, Header, TRUTH};
use super::super::error::LogFileErrorKind as Kind;

/// Stems of the columns of one palm that have a meaning.
const STEMS: [&str; 34] = [
    "px", "py", "pz", "sx", "sy", "sz", "Px", "Py", "Pz", "Qw", "Qx", "Qy", "Qz", "Vx", "Vy", "Vz", "Wx",
    "Wy", "Wz", "fx", "fy", "fz", "fn", "Jx", "Jy", "Jz", "Jn", "tau", "gap", "slip", "mode", "nx", "ny",
    "nz",
];

/// Where each quantity stands in a row.
pub(in crate::log) struct Columns {
    pub(super) count: usize,
    pub(super) t: Field,
    pub(super) palms: Vec<PalmColumns>,
    /// Present only where all thirteen are.
    pub(super) truth: Option<[Field; 13]>,
}

pub(super) struct PalmColumns {
    /// Whether the contact point is in palm axes.
    pub(super) in_palm: bool,
    pub(super) contact: [Field; 3],
    pub(super) pose: Option<[Field; 7]>,
    pub(super) twist: Option<[Field; 6]>,
    pub(super) force: ForceColumns,
    pub(super) impulse: ForceColumns,
    pub(super) torque: Option<Field>,
    pub(super) truth: Option<[Field; 3]>,
}

pub(super) enum ForceColumns {
    None,
    Normal(Field),
    Three([Field; 3]),
}

/// Number of palms of which a header has contact points.
pub(in crate::log) fn palms_in(header: &csv::StringRecord) -> usize {
    let number = |name: &str| {
        let (stem, number) = name.trim_start_matches('\u{feff}').trim().rsplit_once('_')?;
        matches!(stem, "px" | "sx").then(|| number.parse().ok())?
    };
    header.iter().filter_map(number).max().unwrap_or(0)
}

/// The same of palms in space: a header of the plane is told as that.
pub(in crate::log) fn palms_in_space(header: &csv::StringRecord) -> Result<usize, Kind> {
    let has = |stem: &str| header.iter().any(|name| name.trim().starts_with(stem));
    match palms_in(header) {
        palms if palms > 0 && !["pz_", "sx_"].into_iter().any(has) && has("angle_") => {
            Err(Kind::PlanarContacts)
        }
        palms => Ok(palms),
    }
}

/// A header with contact points of palms must have those of so many.
pub(in crate::log) fn check_palms(header: &csv::StringRecord, expected: usize) -> Result<(), Kind> {
    match palms_in(header) {
        found if found != expected && found > 0 => Err(Kind::PalmCount { expected, found }),
        _ => Ok(()),
    }
}

impl Columns {
    /// Finds the columns of so many palms by name in a header row.
    pub(in crate::log) fn find(record: &csv::StringRecord, palms: usize) -> Result<Self, Kind> {
        let header = Header::new(record);
        check_palms(record, palms)?;
        let palm = |i: usize| Palm { header: &header, number: i }.columns();
        let truth = header.all(TRUTH)?;
        Ok(Self {
            count: header.names.len(),
            t: header.need("t".to_owned())?,
            palms: (1..=palms).map(palm).collect::<Result<_, _>>()?,
            truth,
        })
    }
}

/// The columns of one palm, looked up by their stems.
struct Palm<'a> {
    header: &'a Header,
    /// From 1.
    number: usize,
}

impl Palm<'_> {
    fn columns(&self) -> Result<PalmColumns, Kind> {
        let (world, palm) = (self.all(["px", "py", "pz"])?, self.all(["sx", "sy", "sz"])?);
        let (in_palm, contact) = match (world, palm) {
            (Some(world), None) => (false, world),
            (None, Some(palm)) => (true, palm),
            (Some(_), Some(_)) => return Err(self.two_ways("px", "sx")),
            (None, None) => (false, self.needed(["px", "py", "pz"])?),
        };
        Ok(PalmColumns {
            in_palm,
            contact,
            pose: self.all(["Px", "Py", "Pz", "Qw", "Qx", "Qy", "Qz"])?,
            twist: self.all(["Vx", "Vy", "Vz", "Wx", "Wy", "Wz"])?,
            force: self.force("fn", ["fx", "fy", "fz"])?,
            impulse: self.force("Jn", ["Jx", "Jy", "Jz"])?,
            torque: self.find("tau")?,
            truth: self.all(["gap", "slip", "mode"])?,
        })
    }

    fn force(&self, normal: &str, three: [&str; 3]) -> Result<ForceColumns, Kind> {
        match (self.find(normal)?, self.all(three)?) {
            (None, None) => Ok(ForceColumns::None),
            (Some(normal), None) => Ok(ForceColumns::Normal(normal)),
            (None, Some(three)) => Ok(ForceColumns::Three(three)),
            (Some(_), Some(_)) => Err(self.two_ways(normal, three[0])),
        }
    }

    fn two_ways(&self, first: &str, second: &str) -> Kind {
        let name = |stem: &str| format!("`{stem}_{}`", self.number);
        Kind::TwoWays { first: name(first), second: name(second) }
    }

    fn find(&self, stem: &str) -> Result<Option<Field>, Kind> {
        self.header.find(format!("{stem}_{}", self.number))
    }

    /// All of these columns, or none where none is there.
    fn all<const N: usize>(&self, stems: [&str; N]) -> Result<Option<[Field; N]>, Kind> {
        let mut none = true;
        for stem in stems {
            none &= self.find(stem)?.is_none();
        }
        if none { Ok(None) } else { self.needed(stems).map(Some) }
    }

    fn needed<const N: usize>(&self, stems: [&str; N]) -> Result<[Field; N], Kind> {
        let mut fields = Vec::with_capacity(N);
        for stem in stems {
            let name = format!("{stem}_{}", self.number);
            fields.push(self.header.need(name).map_err(unless_of_the_format)?);
        }
        let count = fields.len();
        fields.try_into().map_err(|_| Kind::FieldCount { line: 1, expected: N, found: count })
    }
}

/// `Px_1` is not what was meant where `px_1` is missing: both are columns of the format.
fn unless_of_the_format(missing: Kind) -> Kind {
    let known = |name: &str| name.rsplit_once('_').is_some_and(|(stem, _)| STEMS.contains(&stem));
    match missing {
        Kind::MissingColumn { column, similar, found } => {
            Kind::MissingColumn { column, similar: similar.filter(|name| !known(name)), found }
        }
        other => other,
    }
}
