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
