//! Outlines in the plane that are not convex, followed by a round finger.
//!
//! A finger of radius `q` that keeps in touch rolls its centre `c = x + q n` along the outline's outer parallel curve. Where the outline's curvature
//! is `k` (positive where it bulges) the centre moves by `dc = (1 + q k) ds`: a hollow is felt all along as long as its radius of curvature is larger than the
//! finger's, and faster the nearer the two are. Where it is smaller, or the way in too narrow, the finger touches on both sides at once and the contact
//! **jumps**. Over a motion of the centre by `L` that turns the normal by `-a` the outline, if all of it was felt, has the length `L + q a` and therefore the
//! mean radius of curvature `q + L / a`: a jump and a hollow can be told apart down to that, by moving less and less.
//!
//! What is proven of the body: its hull holds the hull of all contacts, and its support function is that of the centre's path less `q`, which is known where the finger
//! was and bulges no more sharply than the finger in between; with noisy touches at a confidence. Nothing is known of
//! what is behind a jump but that the finger's own disc is free.

mod finger;
mod hull;
mod margins;
mod outline;
mod spline;
mod trace;

pub use finger::{SimulatedFinger, StuckFinger};
pub use hull::HullBounds;
pub use margins::Margins;
pub use outline::{ConvexOutline, OutlinePoint, SmoothOutline, Waved};
pub use spline::{OutlineError, SplineOutline};
pub use trace::{Bridge, ContourFinger, Touch, TraceEnd, TraceError, Traced, Tracing, trace};
