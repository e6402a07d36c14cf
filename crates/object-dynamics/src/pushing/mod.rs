//! Pushes of an object on a table by a round finger: what a log of them holds, outlines as closed lines, and simulated pushes.
//!
//! Everything is slow: the object moves only while the finger moves it, and the friction of the table alone resists. Frames: `W` world,
//! `O` object, whose origin is the centre of mass; both in the plane of the table. Units: SI.

mod closed_line;
mod log;
#[cfg(feature = "noise")]
mod random;
mod simulate;

pub use closed_line::{ClosedLine, ClosedLineError, Nearest};
pub use log::{FEWEST_SAMPLES, Push, PushLog, PushLogError, PushPose, PushSample};
#[cfg(feature = "noise")]
pub use random::{PushDisturbances, SimulatedPushes, simulate_pushes};
pub use simulate::{PushMode, PushScene, PushSceneError, PushStep, PushStroke, limit_twist, simulate_push};
