use super::simulated::{Touched, TouchedBody, Touching};
use super::*;
use glam::DVec3;

const HOW: [Touching; 4] =
    [Touching::Palm, Touching::Palm, Touching::Fingertip(0.0), Touching::Fingertip(0.5)];

fn right(touched: &Touched, found: &Features) -> [[usize; 5]; 4] {
    let mut confusion = [[0; 5]; 4];
    let of = found.run_of_each(touched.curves.len());
    for (kinds, runs) in touched.kinds.iter().zip(&of) {
        for (kind, run) in kinds.iter().zip(runs) {
            let told = found.runs[*run].kind.map_or(4, |k| k as usize);
            confusion[*kind as usize][told] += 1;
        }
    }
    confusion
}

#[test]
fn look() {
    let bodies = [
        ("cube", TouchedBody::cuboid(DVec3::splat(0.5), 0.0)),
        ("wedge", TouchedBody::wedge(1.2, 0.8, 0.5)),
        ("rounded", TouchedBody::cuboid(DVec3::splat(0.4), 0.1)),
        ("ellipsoid", TouchedBody::Ellipsoid(DVec3::new(1.0, 0.8, 0.5))),
    ];
    for (name, body) in bodies {
        for noise in [1e-3, 1e-2] {
            for seed in 140_000..140_004 {
                let touched = body.touched(&HOW, 600, noise, seed);
                let t = std::time::Instant::now();
                let found = Features::find(&touched.curves, &FeatureOptions::default()).unwrap();
                let c = right(&touched, &found);
                println!(
                    "{name} {noise} {c:?} corners {} edges {} faces {} runs {} {:?}",
                    found.corners.len(),
                    found.edges.len(),
                    found.faces.len(),
                    found.runs.len(),
                    t.elapsed()
                );
                if let Some(p) = found.polyhedron() {
                    println!("   {} {}", p.volume, p.by_faces);
                }
            }
        }
    }
}

#[test]
fn dig() {
    let body = TouchedBody::cuboid(DVec3::splat(0.5), 0.0);
    for (noise, seed) in [(1e-2, 140_001), (1e-2, 140_002), (1e-3, 140_001)] {
        println!("== {noise} {seed}");
        let touched = body.touched(&HOW, 600, noise, seed);
        let found = Features::find(&touched.curves, &FeatureOptions::default()).unwrap();
        for run in &found.runs {
            let kinds = &touched.kinds[run.curve][run.first..run.first + run.count];
            let mut c = [0; 4];
            kinds.iter().for_each(|k| c[*k as usize] += 1);
            let ex = &touched.exact[run.curve][run.first..run.first + run.count];
            let (a, b) = (ex[0], ex[ex.len() - 1]);
            let mark = match run.kind {
                Some(k) if c[k as usize] * 10 < run.count * 9 => "<<<<",
                None => "open",
                _ => "",
            };
            println!(
                "{} {:>3}+{:<3} {:?} {:?} {:.0} {:?} {:.2} -> {:.2}  n {:.2} -> {:.2} {:.1?} {mark}",
                run.curve,
                run.first,
                run.count,
                run.kind,
                run.feature,
                run.log_odds,
                c,
                a.point,
                b.point,
                a.normal.get(),
                b.normal.get(),
                run.log_evidence
            );
        }
    }
}

#[test]
fn bounds() {
    use crate::noise::CertainBounds;
    for (name, body) in [
        ("cube", TouchedBody::cuboid(DVec3::splat(0.5), 0.0)),
        ("wedge", TouchedBody::wedge(1.2, 0.8, 0.5)),
        ("rounded", TouchedBody::cuboid(DVec3::splat(0.4), 0.1)),
    ] {
        for noise in [1e-3, 1e-2] {
            let touched = body.touched(&HOW, 600, noise, 140_000);
            let found = Features::find(&touched.curves, &FeatureOptions::default()).unwrap();
            let plain = CertainBounds::from_noisy_curves(&touched.curves, 0.95).unwrap();
            let t = std::time::Instant::now();
            let with =
                CertainBounds::from_features(&touched.curves, &FeatureOptions::default(), 0.95).unwrap();
            for b in [plain, with] {
                let low = b.lower.as_ref().and_then(|l| l.solid());
                let out = low.map(|l| l.vertices().iter().map(|v| body.outside(*v)).fold(-1.0, f64::max));
                let up = b.upper.as_ref().map(|u| {
                    let f = u.face_half_spaces();
                    f.iter()
                        .map(|h| body.support(h.normal.get()) - h.normal.get().dot(h.point) - h.margin)
                        .fold(-1.0, f64::max)
                });
                println!(
                    "{name} {noise} {:?} {:?} {out:?} {up:?} {:?}",
                    low.map(|l| l.volume()),
                    b.upper.as_ref().map(|u| u.volume()),
                    t.elapsed()
                );
            }
        }
    }
}
