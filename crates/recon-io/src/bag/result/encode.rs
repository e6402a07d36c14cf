//! Messages as bytes.

use super::SECOND;
use crate::bag::cdr::CdrWriter;
use glam::{DQuat, DVec3};

/// Stamp and frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Header<'a> {
    /// ns.
    pub(super) time: i64,
    pub(super) frame: &'a str,
}

/// Something to be drawn, or taken away.
#[derive(Clone, Debug)]
pub(super) struct Marker<'a> {
    header: Header<'a>,
    space: &'a str,
    id: usize,
    kind: i32,
    action: i32,
    position: DVec3,
    scale: DVec3,
    color: [f32; 4],
    /// Whether it goes along with its frame.
    frame_locked: bool,
    points: Vec<DVec3>,
}

const ARROW: i32 = 0;
const SPHERE: i32 = 2;
const TRIANGLE_LIST: i32 = 11;
const ADD: i32 = 0;
const DELETE: i32 = 2;
/// Type of numbers in clouds: single precision.
const FLOAT32: u8 = 7;

impl<'a> Marker<'a> {
    fn new(header: Header<'a>, space: &'a str, id: usize, kind: i32) -> Self {
        Self {
            header,
            space,
            id,
            kind,
            action: ADD,
            position: DVec3::ZERO,
            scale: DVec3::ONE,
            color: [0.9, 0.3, 0.1, 1.0],
            frame_locked: false,
            points: Vec::new(),
        }
    }

    pub(super) fn ball(header: Header<'a>, space: &'a str, id: usize, position: DVec3, size: f64) -> Self {
        Self { position, scale: DVec3::splat(size), ..Self::new(header, space, id, SPHERE) }
    }

    /// From the one point to the other; `width` is that of the shaft.
    pub(super) fn arrow(header: Header<'a>, space: &'a str, id: usize, ends: [DVec3; 2], width: f64) -> Self {
        let scale = DVec3::new(width, 2.0 * width, 0.0);
        Self {
            points: ends.to_vec(),
            scale,
            color: [0.9, 0.7, 0.1, 1.0],
            ..Self::new(header, space, id, ARROW)
        }
    }

    pub(super) fn triangles(header: Header<'a>, space: &'a str, id: usize, points: Vec<DVec3>) -> Self {
        Self { points, ..Self::new(header, space, id, TRIANGLE_LIST) }
    }

    /// In this color, going along with its frame.
    pub(super) fn with_frame(self, color: [f32; 4]) -> Self {
        Self { color, frame_locked: true, ..self }
    }

    /// Takes away what was drawn under this name.
    pub(super) fn gone(header: Header<'a>, space: &'a str, id: usize) -> Self {
        Self { action: DELETE, ..Self::new(header, space, id, SPHERE) }
    }

    fn put(&self, to: &mut CdrWriter) {
        put_header(to, self.header);
        to.text(self.space).i32(i32::try_from(self.id).unwrap_or(i32::MAX)).i32(self.kind).i32(self.action);
        put_pose(to, (self.position, DQuat::IDENTITY));
        to.f64s(&self.scale.to_array());
        self.color.iter().fold(&mut *to, |to, part| to.f32(*part));
        // Lifetime: for ever.
        to.i32(0).u32(0).u8(u8::from(self.frame_locked)).count(self.points.len());
        for point in &self.points {
            to.f64s(&point.to_array());
        }
        // No colors of points, no texture.
        to.count(0).text("");
        put_header(to, Header { time: 0, frame: "" });
        to.text("").count(0).count(0);
        // No text, no mesh file.
        to.text("").text("").text("").count(0).u8(0);
    }
}

pub(super) fn markers(markers: &[Marker]) -> Vec<u8> {
    let mut to = CdrWriter::new();
    to.count(markers.len());
    markers.iter().for_each(|marker| marker.put(&mut to));
    to.into_bytes()
}

pub(super) fn transform(header: Header, child: &str, (position, turn): (DVec3, DQuat)) -> Vec<u8> {
    let mut to = CdrWriter::new();
    to.count(1);
    put_header(&mut to, header);
    to.text(child);
    put_pose(&mut to, (position, turn));
    to.into_bytes()
}

/// Rows and columns of the covariance: x, y, z, and turns about x, y, z.
pub(super) fn pose_with_covariance(
    header: Header,
    place: (DVec3, DQuat),
    covariance: Option<[[f64; 6]; 6]>,
) -> Vec<u8> {
    let mut to = CdrWriter::new();
    put_header(&mut to, header);
    put_pose(&mut to, place);
    to.f64s(covariance.unwrap_or_default().as_flattened());
    to.into_bytes()
}

pub(super) fn contact(header: Header, contact: Option<(DVec3, DVec3)>) -> Vec<u8> {
    let mut to = CdrWriter::new();
    put_header(&mut to, header);
    let (point, force) = contact.unwrap_or_default();
    to.u8(u8::from(contact.is_some())).f64s(&point.to_array()).f64s(&force.to_array());
    to.into_bytes()
}

/// Points in single precision, which is what viewers take.
pub(super) fn cloud(header: Header, points: &[DVec3]) -> Vec<u8> {
    const STEP: usize = 12;
    let mut to = CdrWriter::new();
    put_header(&mut to, header);
    to.u32(1).count(points.len()).count(3);
    for (name, offset) in [("x", 0), ("y", 4), ("z", 8)] {
        to.text(name).u32(offset).u8(FLOAT32).u32(1);
    }
    to.u8(0).count(STEP).count(STEP * points.len()).count(STEP * points.len());
    for value in points.iter().flat_map(DVec3::to_array) {
        (value as f32).to_le_bytes().into_iter().fold(&mut to, |to, byte| to.u8(byte));
    }
    to.u8(1);
    to.into_bytes()
}

fn put_header(to: &mut CdrWriter, header: Header) {
    let (seconds, rest) = (header.time.div_euclid(SECOND), header.time.rem_euclid(SECOND));
    to.i32(i32::try_from(seconds).unwrap_or(i32::MAX))
        .u32(u32::try_from(rest).unwrap_or(0))
        .text(header.frame);
}

fn put_pose(to: &mut CdrWriter, (position, turn): (DVec3, DQuat)) {
    to.f64s(&position.to_array()).f64s(&turn.to_array());
}
