use crate::log::LogFileError;
use recon::contact_kinematics::{DirectionError, PalmError, ShapeError, SurfaceError};
use recon::object_dynamics::planar::{self, PlanarMassError};
use recon::object_dynamics::{ContactSceneError, ContactSimulationError, DriveError, MassError};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A scene file that cannot be used: which file, and what is wrong with it where.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct SceneError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: SceneErrorKind,
}

impl SceneError {
    /// What is read of the text of a file; what is wrong with either names it.
    pub(super) fn in_file<T>(
        path: &Path,
        parse: impl FnOnce(&str) -> Result<T, SceneErrorKind>,
    ) -> Result<T, Self> {
        let text = std::fs::read_to_string(path).map_err(SceneErrorKind::from);
        text.and_then(|text| parse(&text)).map_err(|kind| Self { path: path.to_owned(), kind })
    }
}

/// What is wrong with a scene. Keys are named by their full path, such as `object.mass`.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SceneErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] std::io::Error),
    /// Not TOML, or a key that is unknown, missing or of the wrong type; the message shows the place.
    #[error("is not a scene\n{}", in_words(.0))]
    Toml(#[from] toml::de::Error),
    /// None of space, but one of the plane that does not say so.
    #[error("is not a scene of space\n{}\nit is one of the plane: write `plane = true` at its beginning", in_words(.0))]
    PlaneNotSaid(#[source] toml::de::Error),
    /// A number outside of what the quantity can be.
    #[error("`{key}` is {value}; it must be {must}")]
    Value {
        /// Full path of the key.
        key: String,
        /// As given.
        value: f64,
        /// What is accepted.
        must: &'static str,
    },
    /// The same thing is given in two ways.
    #[error("{} are different ways to say the same; give one of them", keys.join(" and "))]
    Ambiguous {
        /// The keys, with backquotes.
        keys: Vec<String>,
    },
    /// Something needed is not given.
    #[error("{what} is not given; {mend}")]
    Missing {
        /// What it is.
        what: &'static str,
        /// How to give it.
        mend: &'static str,
    },
    /// Mass and inertia that no body has.
    #[error("`object`: {0}")]
    Mass(#[from] MassError),
    /// Mass where the shape is not.
    #[error(
        "`object`: a mass of {mass} kg with its moments of inertia lies {spread:.2e} m from the centre of mass along an axis, beyond the \
         {reach:.2e} m that `simulation.shape` reaches; check the units of mass, moments (kg m^2) and shape (m)"
    )]
    MassOutside {
        /// Mass, kg.
        mass: f64,
        /// Root of the second moment along the axis over the mass, m.
        spread: f64,
        /// How far the shape reaches along it, m.
        reach: f64,
    },
    /// A palm that cannot be used.
    #[error("`simulation.palms` ({palm}): {source}")]
    Palm {
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: PalmError,
    },
    /// Three palms are needed.
    #[error("`simulation.palms` has {found} palms; three are needed")]
    PalmCount {
        /// How many there are.
        found: usize,
    },
    /// The palms cannot hold an object.
    #[error("`simulation.palms`: {0}")]
    Palms(PalmError),
    /// A `[[palm]]` lacks something.
    #[error("`palm[{palm}].{key}` is not given; give it in the {} [[palm]]", ordinal(*palm))]
    MissingOfPalm {
        /// Palm from 1.
        palm: usize,
        /// What it lacks.
        key: &'static str,
    },
    /// A vector that has no direction.
    #[error("`{key}`: {source}")]
    Direction {
        /// Full path of the key.
        key: String,
        /// Why.
        source: DirectionError,
    },
    /// Shape or pose of a `[[palm]]`.
    #[error("`palm[{palm}]`: {source}")]
    PalmSurface {
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: SurfaceError,
    },
    /// What moves a `[[palm]]`.
    #[error("`palm[{palm}]`: {source}")]
    PalmDrive {
        /// Palm from 1.
        palm: usize,
        /// Why.
        source: DriveError,
    },
    /// The table of poses of a `[[palm]]`.
    #[error("`palm[{palm}].poses`: {source}")]
    Poses {
        /// Palm from 1.
        palm: usize,
        /// The file and what is wrong with it.
        source: Box<LogFileError>,
    },
    /// A key that has a meaning on palms of one kind alone.
    #[error("`{key}` is only for scenes with {only}")]
    OtherPalms {
        /// Full path of the key.
        key: &'static str,
        /// Where it belongs.
        only: &'static str,
    },
    /// The object's shape.
    #[error("`simulation.shape`: {0}")]
    Shape(ShapeError),
    /// A scene in the plane where one of space is needed.
    #[error(
        "is a scene in the plane (`plane = true`), and here one of space is needed; `recon simulate` and `recon reconstruct` take either"
    )]
    InPlane,
    /// The object's outline.
    #[error("`simulation.shape`: {0}")]
    Outline(recon::contact_kinematics::planar::ShapeError),
    /// The outline that a finger follows.
    #[error("`outline.points`: {0}")]
    FollowedOutline(#[from] recon::exploration::contour::OutlineError),
    /// Mass and inertia that no body in the plane has.
    #[error("`object`: {0}")]
    PlanarMass(#[from] PlanarMassError),
    /// Object and palms make no scene in the plane.
    #[error(transparent)]
    PlanarContacts(planar::ContactSceneError),
    /// Object and palms make no scene.
    #[error(transparent)]
    Contacts(ContactSceneError),
    /// The object cannot start where it is said to be.
    #[error(transparent)]
    Start(Box<ContactSimulationError>),
}

/// `first` to `fifth`, and so many others as there may be.
fn ordinal(number: usize) -> String {
    match number {
        1 => "first".to_owned(),
        2 => "second".to_owned(),
        3 => "third".to_owned(),
        other => format!("{other}th"),
    }
}

impl SceneErrorKind {
    /// `value` when `accept` holds for it, else an error that names `key` and says what it `must` be.
    pub(super) fn check(
        key: &str,
        value: f64,
        must: &'static str,
        accept: impl Fn(f64) -> bool,
    ) -> Result<f64, Self> {
        if accept(value) { Ok(value) } else { Err(Self::Value { key: key.to_owned(), value, must }) }
    }

    pub(super) fn positive(key: &str, value: f64) -> Result<f64, Self> {
        Self::check(key, value, "above zero and finite", |v| v > 0.0 && v.is_finite())
    }

    pub(super) fn not_negative(key: &str, value: f64) -> Result<f64, Self> {
        Self::check(key, value, "zero or above and finite", |v| v >= 0.0 && v.is_finite())
    }

    pub(super) fn finite(key: &str, value: f64) -> Result<f64, Self> {
        Self::check(key, value, "finite", f64::is_finite)
    }
}

/// What is wrong with a file in TOML, with the place, and types by names that no Rust is needed for.
pub(crate) fn in_words(error: &toml::de::Error) -> String {
    const NAMES: [(&str, &str); 6] = [
        ("f64", "a number"),
        ("u64", "a whole number"),
        ("u32", "a whole number"),
        ("usize", "a whole number"),
        ("a boolean", "true or false"),
        ("struct ", ""),
    ];
    let of = |text: String, (name, word): (&str, &str)| {
        text.replace(&format!("expected {name}"), &format!("expected {word}"))
    };
    NAMES.into_iter().fold(error.to_string(), of)
}
