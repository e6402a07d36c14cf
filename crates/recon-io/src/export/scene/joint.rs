//! Joints of a palm in MuJoCo: springs, hinges with motors, and what follows a prescribed motion.

use crate::export::xml::numbers;
use glam::{DQuat, DVec3};
use recon::contact_kinematics::{MotionLaw, MotionPart, PoseTable, SurfacePose, SurfaceState};
use std::io::{self, Write};

/// Added to the inertia of joints that follow a prescribed motion, kg or kg m^2. They are set anew at every step, within which 10 N
/// change their rate by 2e-6 m/s. More would spoil the solver, whose tolerance is relative to the mean inertia.
const ARMATURE: f64 = 1e3;

#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Slide,
    Hinge,
    Ball,
}

/// A joint of a palm; axis and pivot in world axes, while all joints are at zero.
pub(super) struct Joint {
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) axis: DVec3,
    pub(super) pivot: DVec3,
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) armature: f64,
    /// Position and rate at the start; of a ball a quaternion, and the rate in palm axes.
    pub(super) position: Vec<f64>,
    pub(super) rate: Vec<f64>,
    /// Kind and numbers of what it follows.
    pub(super) law: Option<(&'static str, Vec<f64>)>,
    /// Torque at the start.
    pub(super) motor: Option<f64>,
}

impl Joint {
    pub(super) fn new(name: String, axis: DVec3, [position, rate]: [f64; 2]) -> Self {
        Self {
            name,
            kind: Kind::Slide,
            axis,
            pivot: DVec3::ZERO,
            stiffness: 0.0,
            damping: 0.0,
            armature: 0.0,
            position: vec![position],
            rate: vec![rate],
            law: None,
            motor: None,
        }
    }

    /// The element inside of a palm's body that stands at `pose` while all joints are at zero.
    pub(super) fn write(&self, pose: &SurfacePose, to: &mut dyn Write) -> io::Result<()> {
        let inverse = pose.R_WP.inverse();
        let pivot = || numbers(&(inverse * (self.pivot - pose.p_WP)).to_array());
        let kind = match self.kind {
            Kind::Slide => "type=\"slide\"".to_owned(),
            Kind::Hinge => format!("type=\"hinge\" pos=\"{}\"", pivot()),
            Kind::Ball => format!("type=\"ball\" pos=\"{}\"", pivot()),
        };
        let axis = numbers(&(inverse * self.axis).to_array());
        let [stiffness, damping, armature] =
            [self.stiffness, self.damping, self.armature].map(|v| numbers(&[v]));
        writeln!(
            to,
            "    <joint name=\"{}\" {kind} axis=\"{axis}\" stiffness=\"{stiffness}\" damping=\"{damping}\" \
             armature=\"{armature}\"/>",
            self.name
        )
    }
}

/// Joints that follow the parts of a motion: what moves last is outermost, so its axis is fixed in the world.
pub(super) fn along_parts(palm: &str, parts: &[MotionPart]) -> Vec<Joint> {
    let joint = |(j, part): (usize, &MotionPart)| {
        let (kind, axis, pivot, motion) = match part {
            MotionPart::Shift { direction, law } => (Kind::Slide, direction.get(), DVec3::ZERO, law),
            MotionPart::Turn { pivot, axis, law } => (Kind::Hinge, axis.get(), *pivot, law),
        };
        let [value, rate, _] = motion.at(0.0);
        let named = Joint::new(format!("{palm}_{}", j + 1), axis, [value, rate]);
        Joint { kind, pivot, armature: ARMATURE, law: Some(law(motion)), ..named }
    };
    parts.iter().enumerate().rev().map(joint).collect()
}

/// Joints of a palm that follows a table of poses: three slides along the axes of the world, and a ball.
pub(super) fn along_path(palm: &str, table: &PoseTable) -> Vec<Joint> {
    let [x, y, z, w, rest @ ..] = at(&table.at(0.0));
    let named = |tail: &str, axis, start| {
        let plain = Joint::new(format!("{palm}_path_{tail}"), axis, start);
        Joint { armature: ARMATURE, ..plain }
    };
    let [i, j, k, vx, vy, vz, wx, wy, wz, ..] = rest;
    let ball = Joint {
        kind: Kind::Ball,
        position: vec![w, i, j, k],
        rate: vec![wx, wy, wz],
        ..named("turn", DVec3::Z, [0.0; 2])
    };
    let slides = [("x", DVec3::X, [x, vx]), ("y", DVec3::Y, [y, vy]), ("z", DVec3::Z, [z, vz])];
    slides.into_iter().map(|(tail, axis, start)| named(tail, axis, start)).chain([ball]).collect()
}

/// Where such joints are at every time step of the model: time, positions, rates and accelerations of the slides and the ball.
pub(super) fn path(table: &PoseTable, step: f64) -> Vec<u8> {
    let last = table.times().last().copied().unwrap_or(0.0);
    let mut text = "t,x,y,z,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz,ax,ay,az,alphax,alphay,alphaz\n".to_owned();
    for k in 0..=(last / step).round() as u64 {
        let t = k as f64 * step;
        let row = numbers(&[&[t][..], &at(&table.at(t))].concat()).replace(' ', ",");
        text.push_str(&row);
        text.push('\n');
    }
    text.into_bytes()
}

/// Positions, rates and accelerations: those of the turn in palm axes, as MuJoCo has them.
fn at(palm: &SurfaceState) -> [f64; 19] {
    let (q, back) = (DQuat::from_mat3(&palm.R_WP), palm.R_WP.transpose());
    let mut row = [0.0; 19];
    row[3..7].copy_from_slice(&[q.w, q.x, q.y, q.z]);
    let vectors =
        [palm.p_WP, palm.v_WP, back * palm.w_WP, palm.a_WP, back * palm.alpha_WP].map(|v| v.to_array());
    for (from, vector) in [0, 7, 10, 13, 16].into_iter().zip(vectors) {
        row[from..from + 3].copy_from_slice(&vector);
    }
    row
}

/// Kind and numbers of a law, in the order in which scene files have them.
pub(super) fn law(law: &MotionLaw) -> (&'static str, Vec<f64>) {
    match *law {
        MotionLaw::Constant { value } => ("constant", vec![value]),
        MotionLaw::Steady { start, rate } => ("steady", vec![start, rate]),
        MotionLaw::Sinusoid { mean, amplitude, frequency, phase } => {
            ("sinusoid", vec![mean, amplitude, frequency, phase])
        }
        MotionLaw::Ramp { height, start, duration } => ("ramp", vec![height, start, duration]),
    }
}
