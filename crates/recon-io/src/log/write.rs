use super::columns::TRUTH;
use crate::number::push_exact;
use recon::object_dynamics::{PalmReading, SensorLog, TrueState};
use std::io::{self, Write};

/// Writes a sensor log, version 1, with numbers that read back bit for bit.
///
/// `f_i`, `tau_i` and `rate_i` are written where the first sample in contact has them; truth where the log has it.
///
/// # Errors
/// Those of `to`.
pub fn write_log(log: &SensorLog, mut to: impl Write) -> io::Result<()> {
    let optional: [Optional; 3] = [0, 1, 2].map(|i| Optional::of(log, i));
    writeln!(to, "{}", header(&optional, log.truth().is_some()).join(","))?;
    let mut row = String::new();
    for (k, sample) in log.samples().iter().enumerate() {
        row.clear();
        push_exact(&mut row, sample.t);
        for (palm, columns) in sample.palms.iter().zip(&optional) {
            for value in columns.values(palm) {
                row.push(',');
                push_exact(&mut row, value);
            }
        }
        for value in log.truth().map(|truth| true_values(&truth[k])).iter().flatten() {
            row.push(',');
            push_exact(&mut row, *value);
        }
        writeln!(to, "{row}")?;
    }
    to.flush()
}

/// Which optional columns a palm has.
struct Optional {
    force: bool,
    torque: bool,
    rate: bool,
}

impl Optional {
    fn of(log: &SensorLog, palm: usize) -> Self {
        let any = |has: fn(&PalmReading) -> bool| log.samples().iter().any(|s| has(&s.palms[palm]));
        Self {
            force: any(|p| p.force.is_some()),
            torque: any(|p| p.torque.is_some()),
            rate: any(|p| p.rate.is_some()),
        }
    }

    fn names(&self) -> impl Iterator<Item = &'static str> {
        let optional = [("f", self.force), ("tau", self.torque), ("rate", self.rate)];
        ["s1", "s2", "nx", "ny", "nz"].into_iter().chain(optional.into_iter().filter(|o| o.1).map(|o| o.0))
    }

    fn values(&self, palm: &PalmReading) -> Vec<f64> {
        let s = palm.contact.unwrap_or([f64::NAN; 2]);
        let n = palm.normal.get();
        let missing = if palm.contact.is_some() { f64::NAN } else { 0.0 };
        let optional = [
            (palm.force.unwrap_or(missing), self.force),
            (palm.torque.unwrap_or(f64::NAN), self.torque),
            (palm.rate.unwrap_or(f64::NAN), self.rate),
        ];
        [s[0], s[1], n.x, n.y, n.z]
            .into_iter()
            .chain(optional.into_iter().filter(|o| o.1).map(|o| o.0))
            .collect()
    }
}

fn header(optional: &[Optional; 3], truth: bool) -> Vec<String> {
    let mut names = vec!["t".to_owned()];
    for (i, columns) in optional.iter().enumerate() {
        names.extend(columns.names().map(|stem| format!("{stem}_{}", i + 1)));
    }
    if truth {
        names.extend(TRUTH.map(str::to_owned));
    }
    names
}

/// A state in the order of the truth columns.
pub(super) fn true_values(state: &TrueState) -> [f64; 13] {
    let (p, q, v, w) = (state.p_WCm, state.R_WO, state.v_WCm, state.w_WO);
    [p.x, p.y, p.z, q.w, q.x, q.y, q.z, v.x, v.y, v.z, w.x, w.y, w.z]
}
