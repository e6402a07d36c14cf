use super::super::columns::Field;
use super::super::error::{LogFileError, LogFileErrorKind as Kind};
use super::super::read::{EachRow, Row, Table};
use super::PalmSetup;
use super::columns::{Columns, ForceColumns, PalmColumns};
use super::two_poses::check_pose;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::SurfacePose;
use recon::object_dynamics::{
    ContactLog, ContactMode, ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion,
    TrueContact, TrueState,
};
use recon::observer::contacts::stream::{ForceReading, PalmSensed};
use std::io::{BufReader, Read};
use std::path::Path;

/// Reads a sensor log, version 2, from a CSV file. Shapes of the palms, and poses of those that the log has none of, stand in
/// `palms`.
///
/// # Errors
/// [`LogFileError`] names the file, the line and the column.
pub fn read_contact_log(path: impl AsRef<Path>, palms: &[PalmSetup]) -> Result<ContactLog, LogFileError> {
    let path = path.as_ref();
    let in_file = |kind| LogFileError { path: path.to_owned(), kind };
    let file = std::fs::File::open(path).map_err(|e| in_file(Kind::Read(e)))?;
    parse_contact_log(BufReader::new(file), palms).map_err(in_file)
}

/// Reads a sensor log, version 2, from CSV text; columns are found by name, in any order.
///
/// # Errors
/// [`LogFileErrorKind`](super::super::LogFileErrorKind) names the line and the column.
pub fn parse_contact_log(text: impl Read, palms: &[PalmSetup]) -> Result<ContactLog, Kind> {
    contacts(Table::open(text)?, palms)
}

pub(in crate::log) fn contacts(table: Table<impl EachRow>, palms: &[PalmSetup]) -> Result<ContactLog, Kind> {
    let columns = Columns::find(&table.header, palms.len())?;
    let palm = |(i, setup)| Palm::new(i + 1, setup, &columns.palms[i]);
    let mut palms = palms.iter().enumerate().map(palm).collect::<Result<Vec<_>, _>>()?;
    let (mut times, mut lines, mut truth): (_, _, Vec<TrueState>) = (Vec::new(), Vec::new(), Vec::new());
    table.each_row(|row| {
        row.check_count(columns.count)?;
        times.push(row.finite(&columns.t)?);
        lines.push(row.line);
        palms.iter_mut().try_for_each(|palm| palm.push(row))?;
        if let Some(fields) = &columns.truth {
            truth.push(row.truth(fields)?);
        }
        Ok(())
    })?;
    let records = palms.into_iter().map(|palm| palm.record).collect();
    let truth = columns.truth.is_some().then_some(truth);
    ContactLog::new(times, records, truth).map_err(|source| Kind::ContactSamples {
        line: source.sample().and_then(|sample| lines.get(sample).copied()),
        source,
    })
}

/// One palm while its rows come.
pub(super) struct Palm<'a> {
    /// From 1.
    number: usize,
    columns: &'a PalmColumns,
    /// Where it stands if there are no columns for that.
    fixed: SurfacePose,
    /// Where it stands by what is known beside the log, if there are columns for that as well.
    also: Option<SurfacePose>,
    record: PalmRecord,
}

impl<'a> Palm<'a> {
    pub(super) fn new(number: usize, setup: &PalmSetup, columns: &'a PalmColumns) -> Result<Self, Kind> {
        let nowhere = SurfacePose { p_WP: DVec3::ZERO, R_WP: DQuat::IDENTITY };
        let fixed = match (&columns.pose, setup.pose) {
            (_, Some(pose)) => pose,
            (Some(_), None) => nowhere,
            (None, None) => return Err(Kind::NoPose { palm: number }),
        };
        let motion = match (&columns.pose, &columns.twist) {
            (None, None) => RecordedMotion::Fixed(fixed),
            (Some(_), None) => RecordedMotion::Poses(Vec::new()),
            (_, Some(_)) => RecordedMotion::Measured(Vec::new()),
        };
        let channel = |columns: &ForceColumns| match columns {
            ForceColumns::None => ForceChannel::Missing,
            ForceColumns::Normal(_) => ForceChannel::Normal(Vec::new()),
            ForceColumns::Three(_) => ForceChannel::Three(Vec::new()),
        };
        let record = PalmRecord {
            surface: setup.surface,
            friction: setup.friction,
            motion,
            contacts: match columns.in_palm {
                true => ContactPoints::Palm(Vec::new()),
                false => ContactPoints::World(Vec::new()),
            },
            force: channel(&columns.force),
            impulse: channel(&columns.impulse),
            torque: columns.torque.is_some().then(Vec::new),
            hinge: setup.hinge,
            truth: columns.truth.is_some().then(Vec::new),
            largest_offset: setup.largest_offset,
        };
        let also = columns.pose.is_some().then_some(setup.pose).flatten();
        Ok(Self { number, columns, fixed, also, record })
    }

    pub(super) fn push(&mut self, row: &Row) -> Result<(), Kind> {
        let contact = self.contact(row)?;
        let pose = self.push_motion(row)?;
        if let (Some(also), Some(contact)) = (&self.also, contact) {
            let in_palm = matches!(self.record.contacts, ContactPoints::Palm(_));
            let point = if in_palm { contact } else { pose.at_rest().to_palm(contact) };
            let limit = self.record.largest_offset;
            check_pose((row.line, self.number), [&pose, also], point, limit)
                .map_err(Kind::PoseAgainstScene)?;
        }
        match (&mut self.record.force, &self.columns.force) {
            (ForceChannel::Normal(values), ForceColumns::Normal(field)) => {
                values.push(force(row, self.number, field, contact.is_some())?);
            }
            (ForceChannel::Three(vectors), ForceColumns::Three(fields)) => {
                let axis = |i: usize| force(row, self.number, &fields[i], contact.is_some());
                vectors.push(DVec3::new(axis(0)?, axis(1)?, axis(2)?));
            }
            _ => {}
        }
        match (&mut self.record.impulse, &self.columns.impulse) {
            (ForceChannel::Normal(sums), ForceColumns::Normal(field)) => sums.push(row.finite(field)?),
            (ForceChannel::Three(sums), ForceColumns::Three(fields)) => sums.push(row.vector(fields)?.into()),
            _ => {}
        }
        if let (Some(torques), Some(field)) = (&mut self.record.torque, &self.columns.torque) {
            let torque = row.number(field)?;
            torques.push((!torque.is_nan()).then_some(torque));
        }
        if let (Some(truth), Some(fields)) = (&mut self.record.truth, &self.columns.truth) {
            truth.push(true_contact(row, fields)?);
        }
        match &mut self.record.contacts {
            ContactPoints::World(points) | ContactPoints::Palm(points) => points.push(contact),
        }
        Ok(())
    }

    /// What the latest row says; none without a force.
    pub(super) fn sensed(&self) -> Option<PalmSensed> {
        let (pose, twist) = match &self.record.motion {
            RecordedMotion::Fixed(pose) => (*pose, None),
            RecordedMotion::Poses(poses) => (*poses.last()?, None),
            RecordedMotion::Measured(states) => {
                states.last().map(|state| (state.pose, Some([state.v_WP, state.w_WP])))?
            }
        };
        let contact = match &self.record.contacts {
            ContactPoints::World(points) => *points.last()?,
            ContactPoints::Palm(points) => points.last()?.map(|point| pose.at_rest().to_world(point)),
        };
        let force = match &self.record.force {
            ForceChannel::Missing => return None,
            ForceChannel::Normal(values) => ForceReading::Normal(*values.last()?),
            ForceChannel::Three(vectors) => ForceReading::Three(*vectors.last()?),
        };
        Some(PalmSensed { pose, twist, contact, force })
    }

    fn contact(&self, row: &Row) -> Result<Option<DVec3>, Kind> {
        let fields = &self.columns.contact;
        let value = [row.number(&fields[0])?, row.number(&fields[1])?, row.number(&fields[2])?];
        match value.iter().filter(|v| v.is_nan()).count() {
            3 => Ok(None),
            0 => Ok(Some(row.vector(fields)?.into())),
            _ => {
                let columns = fields.each_ref().map(|field| field.name.as_str()).join(", ");
                Err(Kind::PartOfContact { line: row.line, palm: self.number, columns, value: value.to_vec() })
            }
        }
    }

    fn push_motion(&mut self, row: &Row) -> Result<SurfacePose, Kind> {
        let pose = match &self.columns.pose {
            None => self.fixed,
            Some(fields) => {
                let [px, py, pz, qw, qx, qy, qz] = row.vector(fields)?;
                let pose =
                    SurfacePose { p_WP: DVec3::new(px, py, pz), R_WP: DQuat::from_xyzw(qx, qy, qz, qw) };
                let (line, palm) = (row.line, self.number);
                SurfacePose::new(pose.p_WP, pose.R_WP).map_err(|source| Kind::Pose { line, palm, source })?;
                pose
            }
        };
        match (&mut self.record.motion, &self.columns.twist) {
            (RecordedMotion::Poses(poses), _) => poses.push(pose),
            (RecordedMotion::Measured(states), Some(fields)) => {
                let [vx, vy, vz, wx, wy, wz] = row.vector(fields)?;
                let (v_WP, w_WP) = (DVec3::new(vx, vy, vz), DVec3::new(wx, wy, wz));
                states.push(MeasuredMotion { pose, v_WP, w_WP });
            }
            _ => {}
        }
        Ok(pose)
    }
}

/// A component of a force, which is zero (or nan) where there is no contact.
fn force(row: &Row, palm: usize, field: &Field, in_contact: bool) -> Result<f64, Kind> {
    let force = row.number(field)?;
    if in_contact {
        return if force.is_finite() { Ok(force) } else { Err(row.not_finite(field, force)) };
    }
    if force.is_nan() || force == 0.0 {
        return Ok(0.0);
    }
    Err(Kind::ForceOffContact { line: row.line, column: field.name.clone(), palm, force })
}

fn true_contact(row: &Row, fields: &[Field; 3]) -> Result<TrueContact, Kind> {
    let [gap, slip, number] = row.vector(fields)?;
    let mode = ContactMode::ALL.into_iter().find(|mode| f64::from(mode.number()) == number);
    let column = || fields[2].name.clone();
    let mode = mode.ok_or_else(|| Kind::Mode { line: row.line, column: column(), value: number })?;
    Ok(TrueContact { mode, gap, slip })
}
