//! Between the cells of a grid of frictions.

use super::*;
use crate::random::Normal;

/// A reading with noise `share` of a force of 1 N and white slip noise of 2 mm/s.
fn noisy(ratio: f64, slip: f64, share: f64, normal: &mut Normal) -> ContactSeen {
    let mut both = |deviation: f64| Vector2::new(normal.draw(), normal.draw()) * deviation;
    let (force, velocity, along) = (both(share), both(2e-3), both(share).x);
    let exact = reading(ratio, slip);
    ContactSeen::Read(ContactReading {
        normal_force: exact.normal_force + along,
        friction: exact.friction + force,
        force_deviation: share,
        slip: exact.slip.map(|slip| ContactSlip { velocity: slip.velocity + velocity, ..slip }),
        ..exact
    })
}

/// Forces that are known to 0.1 % tell a friction better than a cell of the grid, 1.6 %, is wide; one halfway between two cells is learned all the same.
#[test]
fn forces_better_than_a_cell_of_the_grid_tell_modes() {
    let step = 12_f64.ln() / 159.0;
    let friction = 0.1 * (70.5 * step).exp();
    let mut normal = Normal::seeded(1);
    let sticks = |k: usize| k % 200 < 100;
    let seen: Vec<ContactSeen> = (0..800)
        .map(|k| {
            let (ratio, slip) = if sticks(k) { (0.6 * friction, 0.0) } else { (friction, 0.1) };
            noisy(ratio, slip, 1e-3, &mut normal)
        })
        .collect();
    let mut modes = one(ContactFriction::Unknown { material: 0 });
    let mut right = 0;
    for (k, seen) in seen.iter().enumerate() {
        modes.push(DT, &[*seen]).unwrap();
        right += usize::from((modes.odds(0).unwrap().stick > 0.5) == sticks(k));
    }
    assert!(right > 780, "{right}");
    let learned = modes.friction(0).unwrap();
    assert!((learned.coefficient / friction - 1.0).abs() < 0.51 * step, "{learned:?}");
    let times: Vec<f64> = (0..800).map(|k| DT * f64::from(k)).collect();
    let whole = whole_modes(&times, &[seen], &options()).unwrap();
    let right = (0..800).filter(|k| (whole.odds[0][*k].stick > 0.5) == sticks(*k)).count();
    assert!(right > 790, "{right}");
}
