//! Writes a report from the truth columns of a log, with stand-in bounds: for work on the page alone.
//!
//! `cargo run -p recon-io --example report_preview -- LOG OUT.html A B C` (semi-axes of the ellipsoid in m).

use glam::{DQuat, DVec3};
use parry3d_f64::transformation::try_convex_hull;
use recon::contact_kinematics::PalmFrame;
use recon_io::{
    Bound, Bounds, Evidence, EvidenceValue, Level, MotionState, PalmContact, PalmTrack, ReportData,
    TriangleMesh, TrueShape, Verdict,
};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [log, out, a, b, c] = args.as_slice() else { return Err("LOG OUT.html A B C".into()) };
    let axes = DVec3::new(a.parse()?, b.parse()?, c.parse()?);
    let log = recon_io::read_log(log)?;
    let truth: Vec<MotionState> =
        log.truth().ok_or("the log has no truth columns")?.iter().map(|&s| s.into()).collect();
    let motion: Vec<_> = truth
        .iter()
        .enumerate()
        .map(|(k, s)| {
            let e = DVec3::new(1.0, -0.4, 0.3) * 4e-6 * (1.0 + (k as f64 * 0.01).sin());
            MotionState {
                p_WCm: s.p_WCm + e,
                R_WO: s.R_WO * DQuat::from_scaled_axis(e),
                w_WO: s.w_WO + 3.0 * e,
                ..*s
            }
        })
        .collect();
    let palms = [0, 1, 2].map(|i| {
        let frames: Vec<_> = log
            .samples()
            .iter()
            .map(|s| PalmFrame::from_normal(s.palms[i].normal).expect("checked by the reader"))
            .collect();
        let contacts = log
            .samples()
            .iter()
            .zip(&frames)
            .zip(&truth)
            .map(|((s, f), state)| {
                let p_WC = f.contact_from_sensor(s.palms[i].contact?);
                let back = state.R_WO.conjugate();
                Some(PalmContact {
                    p_WC,
                    p_OC: back * (p_WC - state.p_WCm),
                    normal: back * -f.n,
                    radius: f.n.dot(state.p_WCm),
                })
            })
            .collect();
        PalmTrack { frames, contacts }
    });
    let contacts: Vec<PalmContact> = palms
        .iter()
        .flat_map(|p: &PalmTrack| p.contacts.iter().flatten().copied().step_by(8).collect::<Vec<_>>())
        .collect();
    let (lower, duals) = (
        hull(&contacts.iter().map(|c| c.p_OC).collect::<Vec<_>>())?,
        hull(&contacts.iter().map(|c| c.normal / c.radius).collect::<Vec<_>>())?,
    );
    let corners: Vec<_> = duals
        .triangles
        .iter()
        .map(|t| {
            let [a, b, c] = t.map(|k| duals.vertices[k as usize]);
            let n = (b - a).cross(c - a);
            n / n.dot(a)
        })
        .collect();
    let upper = hull(&corners)?;
    let data = ReportData {
        title: "ex_A_fig5.csv".into(),
        verdict: Verdict {
            level: Level::Good,
            text: "The estimator converged and the log determines all 16 unknowns.".into(),
        },
        times: log.samples().iter().map(|s| s.t).collect(),
        palms,
        motion,
        truth: Some(truth),
        bounds: Some(Bounds {
            largest_gap: None,
            lower: Bound { volume: volume(&lower), mesh: lower },
            upper: Some(Bound { volume: volume(&upper), mesh: upper }),
        }),
        true_shape: Some(ellipsoid(axes)),
        evidence: vec![
            row(
                "residual_rms",
                "Residual (root mean square)",
                EvidenceValue::Number(3.2e-7),
                "m/s",
                "How far the contact velocities are from rigid-body motion.",
                Level::Good,
            ),
            row(
                "rank",
                "Rank",
                EvidenceValue::Text("16 of 16".into()),
                "",
                "Unknowns that the log determines.",
                Level::Good,
            ),
            row(
                "condition",
                "Condition number",
                EvidenceValue::Number(112.4),
                "",
                "Ratio of the best to the worst determined combination.",
                Level::Neutral,
            ),
            row(
                "window",
                "Window",
                EvidenceValue::Number(4.2),
                "s",
                "Part of the log that was used.",
                Level::Neutral,
            ),
        ],
        warnings: vec!["This is a preview: the estimate is the truth with a small error put on it.".into()],
    };
    let file = std::fs::File::create(out)?;
    recon_io::write_report(&data, std::io::BufWriter::new(file))?;
    Ok(())
}

fn row(key: &str, name: &str, value: EvidenceValue, unit: &str, meaning: &str, level: Level) -> Evidence {
    Evidence { key: key.into(), name: name.into(), value, unit: unit.into(), meaning: meaning.into(), level }
}

fn hull(points: &[DVec3]) -> Result<TriangleMesh, Box<dyn Error>> {
    let (vertices, triangles) = try_convex_hull(points).map_err(|e| format!("{e:?}"))?;
    Ok(TriangleMesh::new(vertices, triangles)?)
}

fn volume(mesh: &TriangleMesh) -> f64 {
    let corner = |k: u32| mesh.vertices[k as usize];
    mesh.triangles.iter().map(|t| corner(t[0]).dot(corner(t[1]).cross(corner(t[2]))) / 6.0).sum()
}

fn ellipsoid(axes: DVec3) -> TrueShape {
    let at = |i: u32, j: u32, rows: u32, columns: u32| {
        let (polar, around) = (
            std::f64::consts::PI * f64::from(i) / f64::from(rows),
            std::f64::consts::TAU * f64::from(j) / f64::from(columns),
        );
        axes * DVec3::new(polar.sin() * around.cos(), polar.sin() * around.sin(), polar.cos())
    };
    let (rows, columns) = (32, 64);
    let mut mesh = TriangleMesh::default();
    for i in 0..=rows {
        for j in 0..columns {
            mesh.vertices.push(at(i, j, rows, columns));
            if i < rows {
                let k = |i: u32, j: u32| i * columns + j % columns;
                mesh.triangles.extend([
                    [k(i, j), k(i + 1, j), k(i + 1, j + 1)],
                    [k(i, j), k(i + 1, j + 1), k(i, j + 1)],
                ]);
            }
        }
    }
    let rings = (1..12).map(|i| (0..=72).map(|j| at(i, j, 12, 72)).collect());
    let meridians = (0..24).map(|j| (0..=36).map(|i| at(i, j, 36, 24)).collect());
    TrueShape {
        mesh,
        wireframe: rings.chain(meridians).collect(),
        volume: Some(4.0 / 3.0 * std::f64::consts::PI * axes.element_product()),
    }
}
