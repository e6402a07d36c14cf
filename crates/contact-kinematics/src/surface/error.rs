use thiserror::Error;

/// Fastest motion of a palm, m/s: about that of sound.
pub const FASTEST_PALM: f64 = 300.0;
/// Fastest turn of a palm, degrees a second: 10,000 turns a minute.
pub const FASTEST_TURN: f64 = 60_000.0;

/// Why the surface of a palm or its motion cannot be used as given.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum SurfaceError {
    /// The radius is not a positive number.
    #[error("radius of the palm is {radius} m; it must be positive and finite")]
    Radius {
        /// As given, in m.
        radius: f64,
    },
    /// The body would touch the cup in more than a point.
    #[error(
        "cup of radius {radius} m is not wider than the object's largest radius of curvature, {largest} m, and would \
         touch it in more than one point; take a wider cup"
    )]
    CupTooSmall {
        /// Radius of the cup, m.
        radius: f64,
        /// Largest radius of curvature of the body, m.
        largest: f64,
    },
    /// A pose has a component that is not a number.
    #[error("{what} of the palm's pose has a component that is not finite: ({}, {}, {})", value[0], value[1], value[2])]
    PoseNotFinite {
        /// Which part.
        what: &'static str,
        /// As given.
        value: [f64; 3],
    },
    /// A quaternion is no rotation.
    #[error("orientation of the palm has a quaternion of length {length}; a rotation has length 1, w first")]
    NoRotation {
        /// The quaternion's length.
        length: f64,
    },
    /// A parameter of a motion cannot be used.
    #[error("{what} of the palm's motion is {value}; it must be finite, and a duration above zero")]
    Parameter {
        /// Which parameter.
        what: &'static str,
        /// As given.
        value: f64,
    },
    /// Two poses of a palm, one after the other, that no motion of a palm joins.
    #[error(
        "pose {row} is {distance:.3e} m and {degrees:.1} degrees away from the pose {seconds:.3e} s before it, and between two poses a palm \
         moves at {FASTEST_PALM} m/s and turns by {farthest} degrees at most; correct the pose or its time, or give poses in between"
    )]
    Jump {
        /// Row from 0 of the second of the two.
        row: usize,
        /// Time between them, s.
        seconds: f64,
        /// Their distance, m.
        distance: f64,
        /// Angle by which the palm has turned.
        degrees: f64,
        /// The largest angle that is taken, degrees.
        farthest: f64,
    },
    /// A table of poses is too short or out of order.
    #[error(
        "table of poses: row {row} (t = {time} s) is out of order, or the table has fewer than 4 rows ({rows})"
    )]
    Table {
        /// Row from 0.
        row: usize,
        /// Its time in s.
        time: f64,
        /// Number of rows.
        rows: usize,
    },
}

/// Why a contact could not be found, or its rates not be told.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ContactError {
    /// Newton's iteration did not settle.
    #[error(
        "contact with the palm was not found: after {iterations} steps the normals still differ by {residual:.1e} rad"
    )]
    NotFound {
        /// Steps taken.
        iterations: u32,
        /// Angle between the body's normal and the palm's, rad.
        residual: f64,
    },
    /// The curvatures of body and palm match: the contact is not one point.
    #[error(
        "body and palm have matching curvatures at their contact (condition {condition:.1e}, limit {limit:.0e}): it is \
         not one point there"
    )]
    Matching {
        /// Ratio of the radii to their difference.
        condition: f64,
        /// Largest accepted.
        limit: f64,
    },
    /// The palm's centre lies inside of the body.
    #[error("the palm's centre lies {depth} m inside of the object")]
    CentreInside {
        /// How deep, in m.
        depth: f64,
    },
    /// An input is NaN or infinite.
    #[error("pose of object or palm is not finite")]
    NotFinite,
}
