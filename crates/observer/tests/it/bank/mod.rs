//! Banks of modes: what theory says of them, on systems that are no palms.

mod enumeration;
mod errors;
mod evidence;
mod memory;
mod rates;
mod rotations;
mod smoothing;
mod target;
mod units;
