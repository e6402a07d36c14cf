//! Real pushes of a right triangle (Zhou, Paolini, Bagnell, Mason 2016, arXiv 1602.06056), which lie beside the repository.

use super::judge::quantile;
use super::outline_panel;
use glam::DVec2;
use recon::object_dynamics::pushing::{ClosedLine, PushLog};
use recon::observer::pushes::{PushesEstimate, estimate_pushes};
use recon_io::{FigurePanel, read_push_logs};
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

/// Where the logs lie, from the root of the repository.
const FOLDER: &str = "../shared/data/pushes";
/// Radius of the finger, m.
const RADIUS: f64 = 1e-3;
/// The true triangle, m: for this comparison alone.
const TRIANGLE: [[f64; 2]; 3] = [[-0.05, -0.05], [0.1, -0.05], [-0.05, 0.1]];

pub(super) fn text(panels: &mut Vec<FigurePanel>) -> Result<String, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(FOLDER);
    let files = ["triangle_pushes.csv", "triangle_poses.csv"].map(|name| folder.join(name));
    let mut text = String::from("\n## Real logs\n\n");
    if !files.iter().all(|file| file.exists()) {
        text += "Not there on this machine: nothing is told of them.\n";
        return Ok(text);
    }
    let [pushes, poses] = files;
    let triangle = ClosedLine::new(TRIANGLE.map(DVec2::from).to_vec())?;
    text += "A right triangle of 150 mm, finger 1 mm; nothing was set on these logs. Outline in mm, against the true one; corners in the order of\n\
             (-50, -50), (100, -50), (-50, 100) with the way to the nearest touch on either side.\n\n\
             | log, pushes | outline | friction | from the outline told to the true one: median, largest | from the true one to that told: median, largest, within 5 mm of a touch | corners off (told deviation; way to touches) | gaps left, rms |\n\
             |---|---|---|---|---|---|---|\n";
    for (number, log) in read_push_logs(pushes, poses)? {
        let all = log.pushes();
        let (first, second) = all.split_at(all.len() / 2);
        let (even, odd): (Vec<_>, Vec<_>) = all.iter().cloned().partition(|p| p.number % 2 == 0);
        let parts = [
            ("all", all.to_vec()),
            ("first half", first.to_vec()),
            ("second half", second.to_vec()),
            ("even", even),
            ("odd", odd),
        ];
        for (name, pushes) in parts {
            let told = estimate_pushes(&PushLog::new(pushes)?, RADIUS)?;
            writeln!(text, "| {number}, {name} {}", row(&told, &triangle)?)?;
            if name == "all" {
                panels.push(outline_panel(&format!("Real log {number}"), &told.outline.line, &triangle));
            }
        }
    }
    Ok(text)
}

fn row(told: &PushesEstimate, triangle: &ClosedLine) -> Result<String, Box<dyn Error>> {
    let off = |p: DVec2, line: &ClosedLine| line.nearest(p).distance.abs() * 1e3;
    let out: Vec<f64> = told.outline.points.iter().map(|p| off(p.point, triangle)).collect();
    let mut back: Vec<[f64; 2]> = Vec::new();
    for (a, b) in triangle.edges() {
        for k in 0..150 {
            let p = a.lerp(b, f64::from(k) / 150.0);
            let next = told
                .outline
                .points
                .iter()
                .min_by(|i, j| i.point.distance_squared(p).total_cmp(&j.point.distance_squared(p)));
            back.push([off(p, &told.outline.line), next.map_or(0.0, |n| n.to_touch)]);
        }
    }
    let all_back: Vec<f64> = back.iter().map(|b| b[0]).collect();
    let near: Vec<f64> = back.iter().filter(|b| b[1] <= 5e-3).map(|b| b[0]).collect();
    let mut corners = String::new();
    for corner in triangle.corners() {
        let found =
            told.outline.corners.iter().min_by(|i, j| {
                i.point.distance_squared(*corner).total_cmp(&j.point.distance_squared(*corner))
            });
        if let Some(found) = found {
            let [back, on] = found.to_touch.map(|way| way * 1e3);
            let deviation = found.deviation() * 1e3;
            write!(
                corners,
                "{:.1} ({deviation:.1}; {back:.0}, {on:.0}) ",
                found.point.distance(*corner) * 1e3
            )?;
        }
    }
    let gaps = told.pushes.iter().flat_map(|p| p.gaps).map(|g| g * g).sum::<f64>();
    Ok(format!(
        "| {} | {} | {:.2}, {:.2} | {:.2}, {:.2}, {:.2} | {corners}| {:.2} |",
        told.outline.name,
        told.friction.map_or("–".to_owned(), |f| format!("{:.3} ± {:.3}", f.value, f.deviation)),
        quantile(out.clone(), 0.5),
        quantile(out, 1.0),
        quantile(all_back.clone(), 0.5),
        quantile(all_back, 1.0),
        quantile(near, 1.0),
        (gaps / (2 * told.pushes.len()) as f64).sqrt() * 1e3,
    ))
}
