//! Bodies, palms and motions in the plane drawn at random, what may be wrong with their logs, and the least deviations that logs allow.

pub mod broken;
pub mod scene;
