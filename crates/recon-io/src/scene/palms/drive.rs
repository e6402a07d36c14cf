//! Where a palm stands and what moves it.

use super::build::Keys;
use super::file::{LawTable, MatrixTable, MotorTable, PalmTable, PartTable, PoseTable, SpringTable};
use crate::log::read_pose_table;
use crate::scene::SceneErrorKind as Kind;
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{Direction, MotionLaw, MotionPart, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{PalmDrive, PalmSpring, PalmTorque};
use std::path::Path;

/// What moves the palm; none where the table says nothing of its pose.
pub(super) fn drive(keys: Keys, table: &PalmTable, folder: &Path) -> Result<Option<PalmDrive>, Kind> {
    let pose = table.pose.as_ref().map(|pose| keys.pose(pose)).transpose()?;
    if table.spring.is_some() && table.motor.is_some() {
        return Err(keys.ambiguous(&["spring", "motor"]));
    }
    if table.motion.is_some() && table.motor.is_some() {
        return Err(keys.ambiguous(&["motion", "motor"]));
    }
    let motion = match (pose, &table.poses) {
        (Some(_), Some(_)) => return Err(keys.ambiguous(&["pose", "poses"])),
        (None, Some(_)) if table.motion.is_some() => return Err(keys.ambiguous(&["motion", "poses"])),
        (None, Some(_)) if table.motor.is_some() => return Err(keys.ambiguous(&["motor", "poses"])),
        (None, Some(file)) => {
            let read = read_pose_table(folder.join(file));
            let poses = read.map_err(|source| Kind::Poses { palm: keys.palm, source: Box::new(source) })?;
            Some(SurfaceMotion::Table(poses))
        }
        (Some(pose), None) => {
            Some(SurfaceMotion::Parts { pose, parts: keys.parts(table.motion.as_deref())? })
        }
        (None, None) if table.motion.is_some() || table.spring.is_some() || table.motor.is_some() => {
            return Err(keys.missing("pose"));
        }
        (None, None) => None,
    };
    match (motion, &table.spring, &table.motor, pose) {
        (Some(command), Some(spring), ..) => keys.spring(command, spring).map(Some),
        (_, None, Some(motor), Some(pose)) => keys.motor(pose, motor).map(Some),
        (motion, ..) => Ok(motion.map(PalmDrive::Prescribed)),
    }
}

/// The pose of a palm that never moves.
pub(super) fn fixed_pose(drive: &PalmDrive) -> Option<SurfacePose> {
    match drive {
        PalmDrive::Prescribed(SurfaceMotion::Parts { pose, parts }) if parts.is_empty() => Some(*pose),
        _ => None,
    }
}

impl Keys {
    fn pose(self, table: &PoseTable) -> Result<SurfacePose, Kind> {
        let ways = [table.orientation.is_some(), table.normal.is_some(), table.axis.is_some()];
        if ways.iter().filter(|way| **way).count() > 1 {
            let keys = ["pose.orientation", "pose.normal", "pose.axis"];
            let given: Vec<_> =
                keys.into_iter().zip(ways).filter(|(_, given)| *given).map(|(k, _)| k).collect();
            return Err(self.ambiguous(&given));
        }
        // From an axis of the frame to where it points, by the shortest turn.
        let turned = |key, from: DVec3, to: Option<[f64; 3]>| -> Result<_, Kind> {
            let to = to.map(|to| self.direction(key, to)).transpose()?;
            Ok(to.map(|to| DQuat::from_rotation_arc(from, to.get())))
        };
        let normal = turned("pose.normal", DVec3::Z, table.normal)?;
        let axis = turned("pose.axis", DVec3::X, table.axis)?;
        let orientation = table.orientation.map(|[w, x, y, z]| DQuat::from_xyzw(x, y, z, w));
        let R_WP = orientation.or(normal).or(axis).unwrap_or(DQuat::IDENTITY);
        SurfacePose::new(table.position.into(), R_WP)
            .map_err(|source| Kind::PalmSurface { palm: self.palm, source })
    }

    fn direction(self, key: &str, vector: [f64; 3]) -> Result<Direction, Kind> {
        Direction::new(vector.into()).map_err(|source| Kind::Direction { key: self.path(key), source })
    }

    fn parts(self, tables: Option<&[PartTable]>) -> Result<Vec<MotionPart>, Kind> {
        let part = |(i, table): (usize, &PartTable)| {
            let key = |name: &str| format!("motion[{}].{name}", i + 1);
            match (table.shift, table.turn) {
                (Some(_), Some(_)) => Err(self.ambiguous(&[&key("shift"), &key("turn")])),
                (None, None) => Err(self.missing("motion with `shift` or `turn` in each part")),
                (Some(shift), None) => {
                    if table.pivot.is_some() {
                        return Err(self.ambiguous(&[&key("shift"), &key("pivot")]));
                    }
                    let direction = self.direction(&key("shift"), shift)?;
                    Ok(MotionPart::Shift { direction, law: law(&table.law) })
                }
                (None, Some(turn)) => {
                    let pivot = table.pivot.ok_or(self.missing("motion with a `pivot` beside `turn`"))?;
                    let axis = self.direction(&key("turn"), turn)?;
                    Ok(MotionPart::Turn { pivot: pivot.into(), axis, law: law(&table.law) })
                }
            }
        };
        tables.unwrap_or_default().iter().enumerate().map(part).collect()
    }

    fn spring(self, command: SurfaceMotion, table: &SpringTable) -> Result<PalmDrive, Kind> {
        let stiffness = table.stiffness.ok_or(self.missing("spring.stiffness"))?;
        Ok(PalmDrive::Spring(PalmSpring {
            command,
            stiffness: matrix(stiffness),
            damping: table.damping.map_or(DMat3::ZERO, matrix),
            mass: table.mass.ok_or(self.missing("spring.mass"))?,
        }))
    }

    fn motor(self, pose: SurfacePose, table: &MotorTable) -> Result<PalmDrive, Kind> {
        Ok(PalmDrive::Torque(PalmTorque {
            pose,
            pivot: table.pivot.into(),
            axis: self.direction("motor.axis", table.axis)?,
            inertia: table.inertia,
            torque: law(&table.law),
            angle: table.angle,
            rate: table.rate,
        }))
    }
}

fn matrix(table: MatrixTable) -> DMat3 {
    match table {
        MatrixTable::Same(value) => DMat3::from_diagonal(DVec3::splat(value)),
        MatrixTable::Axes(values) => DMat3::from_diagonal(values.into()),
        MatrixTable::Rows(rows) => DMat3::from_cols_array_2d(&rows).transpose(),
    }
}

/// As it stands in a file.
pub(in crate::scene) fn law(table: &LawTable) -> MotionLaw {
    match *table {
        LawTable::Constant { value } => MotionLaw::Constant { value },
        LawTable::Steady { start, rate } => MotionLaw::Steady { start, rate },
        LawTable::Sinusoid { mean, amplitude, frequency, phase } => {
            MotionLaw::Sinusoid { mean, amplitude, frequency, phase }
        }
        LawTable::Ramp { height, start, duration } => MotionLaw::Ramp { height, start, duration },
    }
}
