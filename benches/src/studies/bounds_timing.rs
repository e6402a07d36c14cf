//! Times hull and half-space intersection beside parry3d, Qhull (through SciPy) and CGAL, in one run on one core.
//!
//! Usage: `bounds_timing [LARGEST [INPUT]]` (1,000,000 and all inputs by default), with `BOUNDS_CGAL` naming the compiled
//! `benches/peers/bounds_cgal.cpp` if there is one. Prints the table `docs/charts/bounds/timing.csv`: thread time in ms, the
//! fastest of a few repeats; empty where a peer is absent, not tried at that size, or beyond the time limit.

use cpu_time::ThreadTime;
use glam::DVec3;
use shape_bounds::exact_hull::{HalfSpace, Hull, Intersection};
use shape_bounds::generators::{InputKind, curve_contacts};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// A peer that takes longer than this is stopped.
const LIMIT: Duration = Duration::from_secs(150);

type Failure = Box<dyn std::error::Error>;

pub(crate) fn main() -> Result<(), Failure> {
    let largest: usize = crate::words().next().map_or(Ok(1_000_000), |a| a.parse())?;
    let only = crate::words().nth(1);
    let wanted = |name: &str| only.as_deref().is_none_or(|o| o == name);
    let folder = std::env::temp_dir().join(format!("bounds-timing-{}", std::process::id()));
    std::fs::create_dir_all(&folder)?;
    let file = folder.join("input");
    println!("input,n,ours_ms,parry_ms,qhull_ms,cgal_ms,cgal_constructed_ms");
    for n in [100, 1000, 10_000, 100_000, 1_000_000].into_iter().filter(|n| *n <= largest) {
        for kind in [
            InputKind::Curves,
            InputKind::Sphere,
            InputKind::Duplicates,
            InputKind::TiltedSections,
            InputKind::Sections,
        ] {
            // The sections make peers run for minutes, or hours.
            let sections = matches!(kind, InputKind::TiltedSections | InputKind::Sections);
            if !wanted(&format!("{kind:?}"))
                || (sections && n != 100_000)
                || (kind == InputKind::Duplicates && n == 1_000_000)
            {
                continue;
            }
            println!("{}", hull_line(kind, n, &file)?);
        }
        if wanted("HalfSpaces") {
            println!("{}", half_space_line(n, &file)?);
        }
    }
    std::fs::remove_dir_all(&folder)?;
    Ok(())
}

fn hull_line(kind: InputKind, n: usize, file: &Path) -> Result<String, Failure> {
    let points = kind.points(n, 1);
    write_raw(file, points.iter().flat_map(|p| p.to_array()))?;
    let ours = fastest(repeats(n), || Hull::of(&points).map(|h| h.dimension()).unwrap_or(0));
    let parry = if n <= 100_000 && kind != InputKind::Sections {
        format!("{:.4}", fastest(repeats(n).min(3), || parry_corners(&points)))
    } else {
        String::new()
    };
    let qhull = peer(Command::new("python3").arg("benches/peers/bounds_qhull.py").arg("hull"), file, n);
    let cgal = cgal("hull", file, n);
    Ok(format!("{kind:?},{n},{ours:.4},{parry},{qhull},{cgal},"))
}

fn half_space_line(n: usize, file: &Path) -> Result<String, Failure> {
    let spaces: Vec<HalfSpace> = curve_contacts(n, 1).iter().map(|c| c.half_space()).collect();
    let planes = spaces.iter().flat_map(|h| {
        let offset = -h.normal.get().dot(h.point);
        [h.normal.get().x, h.normal.get().y, h.normal.get().z, offset]
    });
    write_raw(file, DVec3::ZERO.to_array().into_iter().chain(planes))?;
    let ours = fastest(repeats(n), || {
        Intersection::of(&spaces).ok().and_then(|i| i.bounded().map(|p| p.face_count())).unwrap_or(0)
    });
    let qhull = peer(Command::new("python3").arg("benches/peers/bounds_qhull.py").arg("half"), file, n);
    let (dual, constructed) = (cgal("dual", file, n), cgal("constructed", file, n));
    Ok(format!("HalfSpaces,{n},{ours:.4},,{qhull},{dual},{constructed}"))
}

fn repeats(n: usize) -> usize {
    (3_000_000 / n).clamp(3, 50)
}

fn parry_corners(points: &[DVec3]) -> usize {
    parry3d_f64::transformation::try_convex_hull(points).map_or(0, |(vertices, _)| vertices.len())
}

/// Thread time of the fastest of `repeats` runs, in ms.
fn fastest(repeats: usize, mut work: impl FnMut() -> usize) -> f64 {
    (0..repeats)
        .map(|_| {
            let start = ThreadTime::now();
            std::hint::black_box(work());
            start.elapsed().as_secs_f64() * 1e3
        })
        .fold(f64::INFINITY, f64::min)
}

fn write_raw(file: &Path, values: impl Iterator<Item = f64>) -> std::io::Result<()> {
    std::fs::write(file, values.flat_map(f64::to_le_bytes).collect::<Vec<u8>>())
}

fn cgal(what: &str, file: &Path, n: usize) -> String {
    match std::env::var_os("BOUNDS_CGAL") {
        Some(program) => peer(Command::new(program).arg(what), file, n),
        None => String::new(),
    }
}

/// The time that a peer prints; empty if it is absent, fails or takes too long.
fn peer(command: &mut Command, file: &Path, n: usize) -> String {
    let repeats = if n >= 100_000 { 1 } else { 5 };
    let child = command
        .arg(file)
        .arg(n.to_string())
        .arg(repeats.to_string())
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn();
    let Ok(mut child) = child else { return String::new() };
    let start = Instant::now();
    while start.elapsed() < LIMIT {
        match child.try_wait() {
            Ok(Some(_)) => {
                let output = child.wait_with_output().map(|o| o.stdout).unwrap_or_default();
                let text = String::from_utf8_lossy(&output).into_owned();
                return text.split_whitespace().next().unwrap_or_default().to_owned();
            }
            Ok(None) => std::thread::sleep(Duration::from_millis(5)),
            Err(_) => break,
        }
    }
    // Ours to stop: it was started above.
    let _ = child.kill();
    let _ = child.wait();
    format!(">{}", LIMIT.as_millis())
}
