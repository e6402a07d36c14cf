//! What a finger felt that came down on a body, as files.

use crate::pipeline::folder::Extra;
use recon::exploration::relief::{Bridge, Relief};
use std::fmt::Write;

pub(super) fn files(relief: &Relief) -> Vec<Extra> {
    vec![touches_file(relief), misses_file(relief), jumps_file(relief)]
}

fn touches_file(relief: &Relief) -> Extra {
    let mut text = String::from("x,y,z,nx,ny,nz,ax,ay,az\n");
    for touch in &relief.touches {
        let (p, n, a) = (touch.point, touch.normal.get(), touch.line.along.get());
        let _ = writeln!(
            text,
            "{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?},{:?}",
            p.x, p.y, p.z, n.x, n.y, n.z, a.x, a.y, a.z
        );
    }
    ("relief.csv".to_owned(), text.into_bytes())
}

/// Lines on which the finger passed.
fn misses_file(relief: &Relief) -> Extra {
    let mut text = String::from("x,y,z,ax,ay,az\n");
    for line in &relief.misses {
        let (p, a) = (line.at, line.along.get());
        let _ = writeln!(text, "{:?},{:?},{:?},{:?},{:?},{:?}", p.x, p.y, p.z, a.x, a.y, a.z);
    }
    ("misses.csv".to_owned(), text.into_bytes())
}

fn jumps_file(relief: &Relief) -> Extra {
    let mut text = String::from("x1,y1,z1,x2,y2,z2,mouth,radius_at_most\n");
    for bridge in &relief.bridges {
        let [a, b] = bridge.touches.map(|k| relief.touches[k].point);
        let Bridge { mouth, radius_at_most, .. } = bridge;
        let _ = writeln!(
            text,
            "{:?},{:?},{:?},{:?},{:?},{:?},{mouth:?},{radius_at_most:?}",
            a.x, a.y, a.z, b.x, b.y, b.z
        );
    }
    ("jumps.csv".to_owned(), text.into_bytes())
}
