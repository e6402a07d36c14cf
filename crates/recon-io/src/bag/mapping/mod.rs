//! The mapping file: which topics of a bag are which readings of which palm.

mod draft;
mod error;
mod shape;

pub use draft::{MappingDraft, draft_mapping};
pub use error::{MappingError, MappingErrorKind};
pub(super) use shape::{described, guess_shape};

use error::MappingErrorKind as Kind;
use recon::contact_kinematics::PalmSurface;
use serde::Deserialize;
use std::path::Path;

/// What a bag's topics are. As a TOML file, which `recon inspect` drafts:
/// ```
/// # fn main() -> Result<(), recon_io::MappingErrorKind> {
/// let mapping = recon_io::BagMapping::parse(r#"
/// world = "world"                 # frame whose z axis points up
/// times = "/palm_1/contact"       # samples at its times; else at those of the slowest topic
/// truth = "/truth/pose"           # pose of the body's axes and centre of mass (PoseStamped), to compare with alone
/// cut_off = false                 # whether a bag that was cut off is used up to there
/// leave_out_not_finite = false    # whether messages with NaN are left out
/// clocks_as_stamped = false       # whether offsets between clocks that the readings tell are no error
///
/// [units]                         # all 1 if left out
/// length = 1.0                    # m, of points
/// force = 1.0                     # N
/// torque = 1.0                    # N m
///
/// [[palm]]                        # one for each, in the order of the scene
/// frame = "palm_1"                # its frame in /tf or /tf_static; else the scene says where it stands
/// kind = "flat"                   # as in the scene; needed where that has no [[palm]]
/// wrench = "/palm_1/wrench"       # WrenchStamped
/// force_on = "object"             # or "palm", as most sensors measure: then its sign is turned
/// contact = "/palm_1/contact"     # PointStamped or recon_msgs/Contact; else from taxels, else from the wrench
/// least_force = 0.01              # N; below it a palm is not touched, where contacts are taken from forces
///
/// [[palm]]
/// kind = "sphere"
/// radius = 0.012
/// wrench = "/palm_2/wrench"
/// wrench_frame = "sensor_2"       # in place of that of its messages; so `contact_frame`
///
/// [[palm]]
/// frame = "palm_3"
/// wrench = "/palm_3/wrench"
/// joint = { topic = "/joint_states", name = "palm_3_joint" }   # effort: torque of its motor
/// ## Rows along y, columns along x, middle of the array in the origin of its frame; pitch: m, or one for x and one for y.
/// ## Values times `factor` are Pa (`value = "pressure"`) or N (`value = "force"`); those below `floor` times the largest count for nothing.
/// taxels = { topic = "/palm_3/taxels", pitch = 0.005, value = "pressure", factor = 1.0, floor = 0.05 }
///
/// [[clock]]
/// topic = "/palm_1/contact"
/// ahead = 0.003                   # s: its stamps minus the time of the others
/// time = "stamp"                  # or "log", "published": what its time is
/// "#)?;
/// assert_eq!(mapping.palms.len(), 3);
/// # Ok(())
/// # }
/// ```
/// Of a `TactileState` `sensor` of the taxels names one, and `rows` and `columns` are needed.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct BagMapping {
    /// Frame whose z axis points up.
    #[serde(default = "world")]
    pub world: String,
    /// Topic at whose times the samples are.
    pub times: Option<String>,
    /// Topic of the true pose.
    pub truth: Option<String>,
    /// Whether a bag that was cut off is used.
    #[serde(default)]
    pub cut_off: bool,
    /// Whether messages with NaN are left out.
    #[serde(default)]
    pub leave_out_not_finite: bool,
    /// Whether offsets between clocks that the readings tell are no error.
    #[serde(default)]
    pub clocks_as_stamped: bool,
    /// Units of the messages.
    #[serde(default)]
    pub units: BagUnits,
    /// The palms.
    #[serde(rename = "palm", default)]
    pub palms: Vec<PalmTopics>,
    /// Clocks of topics.
    #[serde(rename = "clock", default)]
    pub clocks: Vec<TopicClock>,
}

/// Units in which messages have their readings.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct BagUnits {
    /// Of points, m.
    pub length: f64,
    /// Of forces, N.
    pub force: f64,
    /// Of torques, N m.
    pub torque: f64,
}

impl Default for BagUnits {
    fn default() -> Self {
        Self { length: 1.0, force: 1.0, torque: 1.0 }
    }
}

/// Topics of one palm.
#[derive(Clone, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct PalmTopics {
    /// Its frame.
    pub frame: Option<String>,
    /// Its kind, as in a scene.
    pub kind: Option<String>,
    /// Its radius, m.
    pub radius: Option<f64>,
    /// Topic of its force and torque.
    pub wrench: Option<String>,
    /// Frame of these, in place of that of the messages.
    pub wrench_frame: Option<String>,
    /// On which body the measured force acts.
    #[serde(default)]
    pub force_on: ForceOn,
    /// Topic of its contacts.
    pub contact: Option<String>,
    /// Frame of these, in place of that of the messages.
    pub contact_frame: Option<String>,
    /// Force below which it is not touched, N.
    pub least_force: Option<f64>,
    /// Its array of taxels.
    pub taxels: Option<TaxelTopic>,
    /// The joint of its motor.
    pub joint: Option<JointTopic>,
}

/// The body on which a measured force acts.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum ForceOn {
    /// The object: as recon takes it.
    #[default]
    Object,
    /// The palm: its sign is turned.
    Palm,
}

/// Where the values of a palm's taxels are.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TaxelTopic {
    /// Topic of images or tactile states.
    pub topic: String,
    /// Name of the array in tactile states.
    pub sensor: Option<String>,
    /// Its frame, in place of that of the messages.
    pub frame: Option<String>,
    /// Rows, where messages do not say them.
    pub rows: Option<usize>,
    /// Columns, where messages do not say them.
    pub columns: Option<usize>,
    /// Distance of neighbours, m.
    pub pitch: Pitch,
    /// What a value is.
    #[serde(default)]
    pub value: TaxelValue,
    /// By which values are multiplied to be Pa or N.
    #[serde(default = "one")]
    pub factor: f64,
    /// Share of the largest value below which values count for nothing.
    pub floor: Option<f64>,
}

/// Distances of neighbouring taxels, m.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub enum Pitch {
    /// Along both axes.
    Both(f64),
    /// Along x and along y.
    Each([f64; 2]),
}

/// What a taxel measures.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum TaxelValue {
    /// Pressure, Pa.
    #[default]
    Pressure,
    /// Force, N.
    Force,
}

/// A joint in a topic of joint states.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct JointTopic {
    /// The topic.
    pub topic: String,
    /// The joint.
    pub name: String,
}

/// The clock of a topic.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TopicClock {
    /// The topic.
    pub topic: String,
    /// By how much its times are later than those of the others for one event, s.
    #[serde(default)]
    pub ahead: f64,
    /// Which of its times is taken.
    #[serde(default)]
    pub time: TimeOf,
}

/// Which time of a message is its time.
#[derive(Clone, Copy, Debug, Default, Deserialize, Eq, PartialEq)]
#[serde(rename_all = "lowercase")]
pub enum TimeOf {
    /// That in its header.
    #[default]
    Stamp,
    /// When it was recorded.
    Log,
    /// When it was published.
    Published,
}

fn world() -> String {
    "world".to_owned()
}

fn one() -> f64 {
    1.0
}

impl BagMapping {
    /// Reads a mapping file.
    ///
    /// # Errors
    /// [`MappingError`] names the file and the key.
    pub fn read(path: impl AsRef<Path>) -> Result<Self, MappingError> {
        let path = path.as_ref();
        let in_file = |kind| MappingError { path: path.to_owned(), kind };
        let text = std::fs::read_to_string(path).map_err(|error| in_file(error.into()))?;
        Self::parse(&text).map_err(in_file)
    }

    /// Reads a mapping from TOML text.
    ///
    /// # Errors
    /// [`MappingErrorKind`] names the key.
    pub fn parse(text: &str) -> Result<Self, Kind> {
        let mapping: Self = toml::from_str(text)?;
        let [length, force, torque] = [mapping.units.length, mapping.units.force, mapping.units.torque];
        for (key, value) in [("units.length", length), ("units.force", force), ("units.torque", torque)] {
            positive(key, value)?;
        }
        if mapping.palms.is_empty() {
            return Err(Kind::NoPalms);
        }
        for (i, palm) in mapping.palms.iter().enumerate() {
            palm.check(i + 1)?;
        }
        mapping.check_shared()?;
        for (i, clock) in mapping.clocks.iter().enumerate() {
            let key = format!("clock[{}].ahead", i + 1);
            // Beyond that it is no offset of a clock but another epoch, for which there is `time`.
            check(&key, clock.ahead, "within 1000 s of zero", |v| v.abs() <= 1000.0)?;
        }
        Ok(mapping)
    }
}

impl BagMapping {
    /// Each palm has its own frame, and sensors of its own.
    fn check_shared(&self) -> Result<(), Kind> {
        type Of = fn(&PalmTopics) -> Option<&String>;
        let own: [(&'static str, Of); 3] = [
            ("frame", |palm| palm.frame.as_ref()),
            ("wrench", |palm| palm.wrench.as_ref()),
            ("contact", |palm| palm.contact.as_ref()),
        ];
        for (j, palm) in self.palms.iter().enumerate() {
            for (key, of) in own {
                let first =
                    self.palms[..j].iter().position(|other| of(palm).is_some() && of(other) == of(palm));
                if let (Some(first), Some(name)) = (first, of(palm)) {
                    return Err(Kind::Shared { key, palms: [first + 1, j + 1], name: name.clone() });
                }
            }
        }
        Ok(())
    }
}

impl PalmTopics {
    fn check(&self, palm: usize) -> Result<(), Kind> {
        let key = |name: &str| format!("palm[{palm}].{name}");
        self.surface(palm)?;
        if let Some(least) = self.least_force {
            check(&key("least_force"), least, "zero or above and finite", |v| v >= 0.0 && v.is_finite())?;
        }
        if let Some(taxels) = &self.taxels {
            for pitch in taxels.pitch.each() {
                positive(&key("taxels.pitch"), pitch)?;
            }
            check(&key("taxels.factor"), taxels.factor, "finite and not zero", |v| {
                v.is_finite() && v != 0.0
            })?;
            if let Some(floor) = taxels.floor {
                check(&key("taxels.floor"), floor, "from 0 to less than 1", |v| (0.0..1.0).contains(&v))?;
            }
        }
        if self.contact.is_none() && self.taxels.is_none() && self.wrench.is_none() {
            return Err(Kind::NoContact { palm });
        }
        Ok(())
    }

    /// Its shape, where the mapping says it.
    ///
    /// # Errors
    /// [`MappingErrorKind`] names the key.
    pub fn surface(&self, palm: usize) -> Result<Option<PalmSurface>, Kind> {
        let key = format!("palm[{palm}].radius");
        let radius = || match self.radius {
            Some(radius) => positive(&key, radius),
            None => Err(Kind::NoRadius { palm }),
        };
        Ok(Some(match self.kind.as_deref() {
            None => return Ok(None),
            Some("flat") => PalmSurface::Plane,
            Some("sphere") => PalmSurface::Sphere { radius: radius()? },
            Some("cup") => PalmSurface::Cup { radius: radius()? },
            Some("cylinder") => PalmSurface::Cylinder { radius: radius()? },
            Some(other) => return Err(Kind::Shape { palm, found: other.to_owned() }),
        }))
    }
}

impl Pitch {
    /// Along x and along y.
    #[must_use]
    pub fn each(self) -> [f64; 2] {
        match self {
            Self::Both(pitch) => [pitch; 2],
            Self::Each(each) => each,
        }
    }
}

fn positive(key: &str, value: f64) -> Result<f64, Kind> {
    check(key, value, "above zero and finite", |v| v > 0.0 && v.is_finite())
}

fn check(key: &str, value: f64, must: &'static str, accept: impl Fn(f64) -> bool) -> Result<f64, Kind> {
    if accept(value) { Ok(value) } else { Err(Kind::Value { key: key.to_owned(), value, must }) }
}
