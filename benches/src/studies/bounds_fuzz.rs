//! Fuzzes the hull over every kind of input, judged by exact predicates, with parry3d and Qhull on the same inputs.
//!
//! Usage: `bounds_fuzz [CASES]` (100,000 by default). Prints a table as CSV; an error if the hull failed on any case.

use shape_bounds::exact_hull::{Hull, HullCertificate, TriangleMesh};
use shape_bounds::generators::{InputKind, Source};
use std::io::{Read, Write as _};
use std::process::Command;

/// Height of a point over a facet, relative to the size of the set, that a peer without exact predicates is granted.
const GRANTED: f64 = 1e-9;

#[derive(Clone, Copy, Default)]
struct Tally {
    /// Sets that span space.
    solid: usize,
    /// Judged wrong by exact signs.
    inexact: usize,
    /// Wrong by more than what is granted, or not closed.
    wrong: usize,
    /// No hull, and said so.
    refused: usize,
}

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let cases: usize = crate::words().next().map_or(Ok(100_000), |a| a.parse())?;
    let per_kind = cases.div_ceil(InputKind::ALL.len());
    // A panic of parry's is one of its refusals, not news.
    std::panic::set_hook(Box::new(|_| {}));
    println!(
        "kind,cases,solid,ours_failures,ours_dimension_wrong,parry_inexact,parry_wrong,parry_refused,\
         qhull_inexact,qhull_wrong,qhull_refused"
    );
    let mut failures = 0;
    for kind in InputKind::ALL {
        let line = crate::rows::row(|| -> Result<(String, usize), Box<dyn std::error::Error>> {
            let (ours, dimension_wrong, parry, qhull) = fuzz(kind, per_kind)?;
            let columns = match qhull {
                Some(q) => format!("{},{},{}", q.inexact, q.wrong, q.refused),
                None => "absent,absent,absent".into(),
            };
            let line = format!(
                "{kind:?},{per_kind},{},{},{dimension_wrong},{},{},{},{columns}",
                ours.solid, ours.inexact, parry.inexact, parry.wrong, parry.refused
            );
            Ok((line, ours.inexact + dimension_wrong))
        })?;
        let Some((line, wrong)) = line else { continue };
        failures += wrong;
        println!("{line}");
    }
    eprintln!("{failures} failures of ours");
    if failures > 0 { Err("the hull failed".into()) } else { Ok(()) }
}

type Verdicts = (Tally, usize, Tally, Option<Tally>);

fn fuzz(kind: InputKind, cases: usize) -> Result<Verdicts, Box<dyn std::error::Error>> {
    let mut s = Source::new(kind as u64 + 77);
    let (mut ours, mut parry, mut dimension_wrong) = (Tally::default(), Tally::default(), 0);
    let mut solids: Vec<Vec<glam::DVec3>> = Vec::new();
    let mut qhull = Some(Tally::default());
    for case in 0..cases {
        // From 4 to 2000, small sets more often: they hold most of the degeneracies.
        let count = (4.0 * 500_f64.powf(s.unit().powf(1.5))).round() as usize;
        let points = kind.points(count, case as u64 + 1000);
        let hull = Hull::of(&points)?;
        if kind.dimension().is_some_and(|d| count > 60 && d != hull.dimension()) {
            dimension_wrong += 1;
        }
        if let Some(solid) = hull.solid() {
            ours.solid += 1;
            judge(&mut ours, &solid.mesh(), &points);
            let theirs = std::panic::catch_unwind(|| parry3d_f64::transformation::try_convex_hull(&points));
            match theirs {
                Ok(Ok((vertices, triangles))) => {
                    judge(&mut parry, &TriangleMesh { vertices, triangles }, &points);
                }
                _ => parry.refused += 1,
            }
            solids.push(points);
        }
        if solids.len() == 500 || case + 1 == cases {
            qhull = match qhull {
                Some(tally) => judge_qhull(tally, &solids)?,
                None => None,
            };
            solids.clear();
        }
    }
    Ok((ours, dimension_wrong, parry, qhull))
}

fn judge(tally: &mut Tally, mesh: &TriangleMesh, points: &[glam::DVec3]) {
    // Corners that another library made of finite points may be none.
    let verdict = HullCertificate::of(mesh, points).ok();
    if verdict.is_some_and(|verdict| verdict.holds()) {
        return;
    }
    tally.inexact += 1;
    let Some(verdict) = verdict else {
        tally.wrong += 1;
        return;
    };
    if verdict.open_edges > 0 || verdict.euler != 2 || largest_height(mesh, points) > GRANTED {
        tally.wrong += 1;
    }
}

/// The largest height of a point over a facet, relative to the size of the set.
fn largest_height(mesh: &TriangleMesh, points: &[glam::DVec3]) -> f64 {
    let (low, high) = points
        .iter()
        .fold((glam::DVec3::INFINITY, glam::DVec3::NEG_INFINITY), |(l, h), p| (l.min(*p), h.max(*p)));
    let heights = mesh.corners().filter_map(|[a, b, c]| {
        let normal = (b - a).cross(c - a).try_normalize()?;
        points.iter().map(|p| normal.dot(*p - a)).max_by(f64::total_cmp)
    });
    heights.fold(0.0, f64::max) / (high - low).length()
}

/// Qhull through SciPy on a batch of sets; `None` when Python has no SciPy.
fn judge_qhull(
    mut tally: Tally,
    sets: &[Vec<glam::DVec3>],
) -> Result<Option<Tally>, Box<dyn std::error::Error>> {
    let folder = std::env::temp_dir().join(format!("bounds-fuzz-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let (input, output) = (folder.join("in"), folder.join("out"));
    let mut file = std::io::BufWriter::new(std::fs::File::create(&input)?);
    for points in sets {
        file.write_all(&(points.len() as u64).to_le_bytes())?;
        for c in points.iter().flat_map(|p| p.to_array()) {
            file.write_all(&c.to_le_bytes())?;
        }
    }
    file.flush()?;
    let status = Command::new("python3")
        .arg("benches/peers/bounds_qhull.py")
        .arg("batch")
        .args([&input, &output])
        .stderr(std::process::Stdio::null())
        .status();
    if !status.is_ok_and(|s| s.success()) {
        return Ok(None);
    }
    let mut file = std::io::BufReader::new(std::fs::File::open(&output)?);
    for points in sets {
        let mut count = [0; 8];
        file.read_exact(&mut count)?;
        let mut triangles = Vec::new();
        for _ in 0..u64::from_le_bytes(count) {
            let mut t = [[0; 4]; 3];
            for corner in &mut t {
                file.read_exact(corner)?;
            }
            triangles.push(t.map(u32::from_le_bytes));
        }
        if triangles.is_empty() {
            tally.refused += 1;
        } else {
            judge(&mut tally, &TriangleMesh { vertices: points.clone(), triangles }, points);
        }
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(Some(tally))
}
