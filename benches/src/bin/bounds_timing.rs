use shape_bounds::generators::*;
use shape_bounds::*;
use std::time::Instant;
fn main() {
    let max: usize = std::env::args().nth(1).map_or(1_000_000, |a| a.parse().unwrap());
    for n in [1000, 10_000, 100_000, 1_000_000] {
        if n > max {
            break;
        }
        for kind in [
            InputKind::Curves,
            InputKind::Sphere,
            InputKind::Duplicates,
            InputKind::Sections,
            InputKind::TiltedSections,
        ] {
            let p = kind.points(n, 1);
            let t = (0..3)
                .map(|_| {
                    let t = Instant::now();
                    let h = Hull::of(&p).unwrap();
                    let e = t.elapsed().as_secs_f64();
                    (e, h.solid().map_or(0, |s| s.vertices().len()))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap();
            println!("{n} {kind:?} {:.3} ms, {} corners", t.0 * 1e3, t.1);
        }
        let c: Vec<HalfSpace> = curve_contacts(n, 1).iter().map(|c| c.half_space()).collect();
        let t = (0..3)
            .map(|_| {
                let t = Instant::now();
                let h = Intersection::of(&c).unwrap();
                let e = t.elapsed().as_secs_f64();
                (e, h.bounded().map_or(0, |s| s.face_count()))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap();
        println!("{n} half-spaces {:.3} ms, {} faces", t.0 * 1e3, t.1);
    }
}
