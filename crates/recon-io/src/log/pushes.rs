//! Logs of pushes: samples of force and finger, and poses before and after each push, as two CSV files.

use super::columns::{Field, Header};
use super::error::{LogFileError, LogFileErrorKind as Kind};
use super::read::{Row, csv_error};
use crate::number::exact;
use crate::rows::rows;
use glam::DVec2;
use recon::object_dynamics::pushing::{Push, PushLog, PushLogError, PushPose, PushSample};
use std::collections::BTreeMap;
use std::io::{self, BufReader, Read, Write};
use std::path::Path;

const SAMPLE: [&str; 6] = ["push", "t", "fx", "fy", "finger_x", "finger_y"];
const POSE: [&str; 7] = ["push", "pre_x", "pre_y", "pre_theta", "post_x", "post_y", "post_theta"];

/// Which push of which log.
type Key = (u32, u32);

/// Something that was read, with its line.
struct Lined<T> {
    line: u64,
    value: T,
}

/// Samples of a push and poses, by push.
type Samples = BTreeMap<Key, Vec<Lined<PushSample>>>;
type Poses = BTreeMap<Key, Lined<[PushPose; 2]>>;

/// Reads logs of pushes: `log, push, t, fx, fy, finger_x, finger_y` in one file, `log, push, pre_x, pre_y, pre_theta, post_x, post_y,
/// post_theta` in the other; columns are found by name in any order, and without `log` all belongs to log 0.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_push_logs(
    pushes: impl AsRef<Path>,
    poses: impl AsRef<Path>,
) -> Result<BTreeMap<u32, PushLog>, LogFileError> {
    let (pushes, poses) = (pushes.as_ref(), poses.as_ref());
    let in_file = |path: &Path| {
        let path = path.to_owned();
        move |kind| LogFileError { path: path.clone(), kind }
    };
    let open = |path: &Path| std::fs::File::open(path).map(BufReader::new).map_err(Kind::Read);
    let told = open(poses).and_then(parse_poses).map_err(in_file(poses))?;
    let samples = open(pushes).and_then(parse_samples).map_err(in_file(pushes))?;
    if let Some(((log, push), row)) = told.iter().find(|(key, _)| !samples.contains_key(key)) {
        let kind = Kind::PoseWithoutPush { line: row.line, log: *log, push: *push };
        return Err(in_file(poses)(kind));
    }
    joined(samples, &told).map_err(in_file(pushes))
}

/// The columns of these names, and whether there is one of logs.
fn columns<const N: usize>(
    record: &csv::StringRecord,
    names: [&str; N],
) -> Result<(usize, Option<Field>, Vec<Field>), Kind> {
    let header = Header::new(record);
    let fields = names.iter().map(|name| header.need((*name).to_owned()));
    let fields = fields.collect::<Result<Vec<_>, Kind>>()?;
    Ok((header.names.len(), header.find("log".to_owned())?, fields))
}

/// Hands each row to a closure: its line, its push, and its values after the number of the push.
fn each_row<const N: usize>(
    text: impl Read,
    names: [&str; N],
    mut take: impl FnMut(u64, Key, &[f64]) -> Result<(), Kind>,
) -> Result<(), Kind> {
    let mut rows = rows(text);
    let header = rows.next().ok_or(Kind::Empty)?.map_err(csv_error)?;
    let (count, log, fields) = columns(&header, names)?;
    for record in rows {
        let record = record.map_err(csv_error)?;
        let row = Row::of(&record);
        row.check_count(count)?;
        let log = log.as_ref().map_or(Ok(0), |field| whole(&row, field))?;
        let key = (log, whole(&row, &fields[0])?);
        let values = fields[1..].iter().map(|field| row.finite(field));
        take(row.line, key, &values.collect::<Result<Vec<_>, Kind>>()?)?;
    }
    Ok(())
}

/// A number of a log or of a push.
fn whole(row: &Row, field: &Field) -> Result<u32, Kind> {
    let value = row.finite(field)?;
    if value.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&value) {
        Ok(value as u32)
    } else {
        Err(Kind::PushNumber { line: row.line, column: field.name.clone(), value })
    }
}

fn parse_samples(text: impl Read) -> Result<Samples, Kind> {
    let mut all = Samples::new();
    each_row(text, SAMPLE, |line, key, values| {
        if let [t, fx, fy, x, y] = *values {
            let value = PushSample { t, force: DVec2::new(fx, fy), finger: DVec2::new(x, y) };
            all.entry(key).or_default().push(Lined { line, value });
        }
        Ok(())
    })?;
    Ok(all)
}

fn parse_poses(text: impl Read) -> Result<Poses, Kind> {
    let mut all = Poses::new();
    each_row(text, POSE, |line, key, values| {
        if let [x, y, theta, after_x, after_y, after_theta] = *values {
            let before = PushPose { p_WO: DVec2::new(x, y), theta };
            let after = PushPose { p_WO: DVec2::new(after_x, after_y), theta: after_theta };
            if let Some(first) = all.insert(key, Lined { line, value: [before, after] }) {
                return Err(Kind::PoseTwice { line, log: key.0, push: key.1, first: first.line });
            }
        }
        Ok(())
    })?;
    Ok(all)
}

/// Pushes with their poses, by log.
fn joined(samples: Samples, poses: &Poses) -> Result<BTreeMap<u32, PushLog>, Kind> {
    let mut lines: BTreeMap<Key, Vec<u64>> = BTreeMap::new();
    let mut logs: BTreeMap<u32, Vec<Push>> = BTreeMap::new();
    for (key, samples) in samples {
        let (log, number) = key;
        let line = samples.first().map_or(0, |s| s.line);
        let Some(Lined { value: [before, after], .. }) = poses.get(&key) else {
            return Err(Kind::NoPoseOfPush { line, log, push: number });
        };
        lines.insert(key, samples.iter().map(|s| s.line).collect());
        let samples = samples.into_iter().map(|s| s.value).collect();
        logs.entry(log).or_default().push(Push { number, before: *before, after: *after, samples });
    }
    let one = |(log, pushes)| {
        let made = PushLog::new(pushes).map_err(|source| {
            let at = |push, sample: usize| lines.get(&(log, push)).and_then(|of| of.get(sample)).copied();
            let line = match source {
                PushLogError::NotFinite { push, sample, .. } | PushLogError::Time { push, sample, .. } => {
                    at(push, sample)
                }
                PushLogError::Short { push, .. } | PushLogError::Twice { push } => at(push, 0),
                _ => None,
            };
            Kind::Pushes { log, line, source }
        })?;
        Ok((log, made))
    };
    if logs.is_empty() {
        return Err(Kind::NoRows);
    }
    logs.into_iter().map(one).collect()
}

/// Writes the samples of logs of pushes, with numbers that read back bit for bit.
///
/// # Errors
/// Those of `to`.
pub fn write_push_samples(logs: &BTreeMap<u32, PushLog>, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "log,{}", SAMPLE.join(","))?;
    for (log, push) in logs.iter().flat_map(|(log, made)| made.pushes().iter().map(move |p| (log, p))) {
        for s in &push.samples {
            let values = [s.t, s.force.x, s.force.y, s.finger.x, s.finger.y].map(exact);
            writeln!(to, "{log},{},{}", push.number, values.join(","))?;
        }
    }
    to.flush()
}

/// Writes the poses of logs of pushes, with numbers that read back bit for bit.
///
/// # Errors
/// Those of `to`.
pub fn write_push_poses(logs: &BTreeMap<u32, PushLog>, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "log,{}", POSE.join(","))?;
    for (log, push) in logs.iter().flat_map(|(log, made)| made.pushes().iter().map(move |p| (log, p))) {
        let values = [push.before, push.after].map(|p| [p.p_WO.x, p.p_WO.y, p.theta].map(exact).join(","));
        writeln!(to, "{log},{},{}", push.number, values.join(","))?;
    }
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    const POSES: &str =
        "log,push,pre_x,pre_y,pre_theta,post_x,post_y,post_theta\n3,1,0.1,0.2,0.3,0.4,0.5,0.6\n";

    fn samples() -> String {
        let rows = (0..8).map(|k| format!("3,1,{}.5,0.25,-1,0.125,2\n", k));
        format!("log,push,t,fx,fy,finger_x,finger_y\n{}", rows.collect::<String>())
    }

    fn parse(samples: &str, poses: &str) -> Result<BTreeMap<u32, PushLog>, Kind> {
        joined(parse_samples(samples.as_bytes())?, &parse_poses(poses.as_bytes())?)
    }

    #[test]
    fn logs_read_back_bit_for_bit() {
        let logs = parse(&samples(), POSES).unwrap();
        let push = &logs[&3].pushes()[0];
        assert_eq!((push.number, push.before.theta, push.after.p_WO.x), (1, 0.3, 0.4));
        let sample = PushSample { t: 7.5, force: DVec2::new(0.25, -1.0), finger: DVec2::new(0.125, 2.0) };
        assert_eq!(push.samples[7], sample);
        let (mut told, mut poses) = (Vec::new(), Vec::new());
        write_push_samples(&logs, &mut told).unwrap();
        write_push_poses(&logs, &mut poses).unwrap();
        let text = |bytes| String::from_utf8(bytes).unwrap();
        assert_eq!(parse(&text(told), &text(poses)).unwrap(), logs);
    }

    #[test]
    fn without_a_column_of_logs_there_is_one_log() {
        let without = |text: &str| text.replace("log,push", "push").replace("3,1,", "1,");
        assert_eq!(parse(&without(&samples()), &without(POSES)).unwrap().keys().collect::<Vec<_>>(), [&0]);
    }

    #[test]
    fn mistakes_are_named_with_place_and_mend() {
        let told = |samples: &str, poses: &str| parse(samples, poses).unwrap_err().to_string();
        let all = samples();
        for (text, words) in [
            (told(&all.replace("fx", "Fx"), POSES), vec!["`fx`", "is it `Fx`?"]),
            (
                told(&all.replace("3,1,4.5", "3,1.5,4.5"), POSES),
                vec!["line 6", "`push` is 1.5", "whole number"],
            ),
            (told(&all.replace("3,1,4.5", "3,1,2.5"), POSES), vec!["line 6", "log 3", "push 1", "2.5 s"]),
            (told(&all.replace("3,1,4.5", "3,1,four"), POSES), vec!["line 6", "`t`", "four"]),
            (told(&all.replace("3,1,4.5", "3,2,4.5"), POSES), vec!["line 6", "push 2 of log 3", "no row"]),
            (
                told(&all.replace("3,1,7.5,0.25,-1,0.125,2\n", ""), POSES),
                vec!["line 2", "push 1", "7 sample(s)"],
            ),
            (told(&all, &POSES.replace("3,1,", "3,9,")), vec!["line 2", "push 1 of log 3", "poses"]),
            (told(&all, &format!("{POSES}3,1,0,0,0,0,0,0\n")), vec!["line 3", "push 1 of log 3", "line 2"]),
        ] {
            assert!(words.iter().all(|w| text.contains(w)), "{text}: {words:?}");
        }
    }
}
