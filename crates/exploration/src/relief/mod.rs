//! Bodies in space that are not convex, touched by a round finger that comes down on straight lines.
//!
//! A finger of radius `q` comes from several directions, each time down a lattice of lines, and stops at the first contact. Where its centre was all is free that is nearer to it than `q`:
//! about the ray from where it stopped to where it came from, about the whole line where it passed. A place may be of the body if and only if it is farther than `q` from all of these rays, and within
//! the reach that was taken for known. No more is used for the bounds ([`ReliefBounds`]), neither that the body is convex nor that it is smooth, in one piece or without holes.
//!
//! Over its surface the finger's centre `c = x + q n` is on the outer parallel surface, whose principal curvatures are `k / (1 + q k)` (positive where it bulges): less than `1 / q` for what bulges, and for hollows of
//! the radius `R > q` no more than `1 / (R - q)` inwards. Where the normal turns by `a` over a way of the centre by `L`, with `a / L > 1 / q`, there is thus a hollow with a principal radius of no more than `q + L / a`,
//! if all of the surface along the way was felt: as for outlines ([`crate::contour`]). Where both principal radii of all hollows are larger than `q` everything is felt; where the smaller one is not the ball
//! touches on both sides and the contact **jumps**. Lines are added between those where the normal turns by much, and what still turns inwards by as much over the least spacing is a jump ([`Bridge`]). The way is
//! known by the distance of the lines, which is exact, and by the slope that the normals give, as long as it is nowhere steeper than at its ends.
//!
//! A direction sees what is turned to it by less than 60 degrees and hidden by nothing. Where its sight ends the parallel surface goes on: a touch there is a **rim** unless another direction has a centre next to it
//! in the midst of what it sees. Without rims and jumps, to the resolution of the lattice, all pieces of the parallel surface that were met are closed and all of the body's surface that they belong to was felt ([`Relief::is_felt`]);
//! what is inside of closed walls, or a piece between all lines, nobody can say.

mod bounds;
mod cut;
mod edges;
mod felt;
mod finger;
mod lines;
mod probing;
mod rays;
mod surface;
mod view;

pub use bounds::{ReliefBounds, ReliefBoundsError};
pub use felt::{Bridge, Relief, ReliefEnd};
pub use finger::{SimulatedFinger, StuckFinger};
pub use lines::{Line, ProbingFinger, Touch};
pub use probing::{Probing, ProbingError, probe};
pub use surface::{ImplicitSurface, Level, Wave, WavedBody};
