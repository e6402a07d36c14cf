//! The first use that README.md shows, line for line.

use glam::DVec3;
use shape_bounds::{ContactSample, ShapeBounds};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    // Where a unit ball was touched, with the outward normal there: its six poles.
    let poles = [DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let bounds = ShapeBounds::from_contacts(&ContactSample::from_raw(poles.map(|p| (p, p)))?)?;
    assert!((bounds.lower_volume() - 4.0 / 3.0).abs() < 1e-12); // the octahedron inside,
    Ok(assert!((bounds.upper_volume() - 8.0).abs() < 1e-12)) // the cube outside
}

#[test]
fn the_first_use_is_what_stands_here_and_holds() {
    main().unwrap();
    let shown =
        include_str!("../../../README.md").split("```rust\n").nth(1).unwrap().split("```").next().unwrap();
    assert!(shown.lines().count() > 5 && include_str!("readme.rs").contains(shown), "{shown}");
}
