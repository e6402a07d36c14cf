use shape_bounds::generators::*;
use shape_bounds::*;
fn cpu() -> f64 { let s = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap(); s.split(' ').next().unwrap().parse::<f64>().unwrap() * 1e-6 }
fn main() {
    let n: usize = std::env::args().nth(1).unwrap().parse().unwrap();
    for k in ["c", "s", "h"] {
        let p = if k == "s" {InputKind::Sphere} else {InputKind::Curves}.points(n, 1);
        let c: Vec<HalfSpace> = curve_contacts(n, 1).iter().map(|c| c.half_space()).collect();
        let mut best = f64::INFINITY;
        for _ in 0..4 { let t = cpu();
            let d = if k == "h" { Intersection::of(&c).unwrap().bounded().unwrap().face_count() } else { Hull::of(&p).unwrap().dimension() };
            let e = cpu() - t; std::hint::black_box(d); best = best.min(e); }
        println!("{k} {n} {best:.2} ms");
    }
}
