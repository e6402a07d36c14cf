//! What one more contact costs when both bounds are kept up to date, beside starting over, and the largest gap.
//!
//! Usage: `bounds_incremental [CONTACTS]` (10,000 by default): three curves traced side by side, and contacts all over an
//! ellipsoid in random order. Prints the table `docs/charts/bounds/incremental.csv`.

use cpu_time::ThreadTime;
use shape_bounds::generators::{curve_contacts, ellipsoid_contacts};
use shape_bounds::{ContactSample, IncrementalBounds, ShapeBounds};

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let count: usize = crate::words().next().map_or(Ok(10_000), |a| a.parse())?;
    println!(
        "input,contacts,microseconds_per_contact,microseconds_to_start_over,microseconds_to_largest_gap"
    );
    for (name, contacts) in
        [("curves", curve_contacts(count, 1)), ("scattered", ellipsoid_contacts(count, 1))]
    {
        study(name, &contacts)?;
    }
    Ok(())
}

fn study(name: &str, contacts: &[ContactSample]) -> Result<(), Box<dyn std::error::Error>> {
    let mut growing = IncrementalBounds::new();
    let mut next = 100;
    let mut begin = 0;
    let mut start = ThreadTime::now();
    for (k, contact) in contacts.iter().enumerate() {
        growing.insert(contact)?;
        if k + 1 == next {
            let each = start.elapsed().as_secs_f64() * 1e6 / (k + 1 - begin) as f64;
            let over = ThreadTime::now();
            let bounds = ShapeBounds::from_contacts(&contacts[..=k])?;
            let over = over.elapsed().as_secs_f64() * 1e6;
            let gap = ThreadTime::now();
            std::hint::black_box(bounds.largest_gap());
            let gap = gap.elapsed().as_secs_f64() * 1e6;
            println!("{name},{next},{each:.3},{over:.1},{gap:.1}");
            (begin, next) = (k + 1, next * 10);
            start = ThreadTime::now();
        }
    }
    Ok(())
}
