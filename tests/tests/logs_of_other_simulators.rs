use glam::*;
use recon::object_dynamics::*;
use recon::observer::*;

#[test]
fn probe() {
    for (file, axes) in [
        ("mj_A_fig5", DVec3::new(2.5, 2.0, 1.0)),
        ("ex_A_fig5", DVec3::new(2.5, 2.0, 1.0)),
        ("dr_D_tilted", DVec3::new(1.8, 1.3, 0.9)),
        ("mj_B_gentle", DVec3::new(2.5, 2.0, 1.0)),
    ] {
        let path = format!("{}/../../shared/logs/{file}.csv", env!("CARGO_MANIFEST_DIR"));
        let log = recon_io::read_log(&path).unwrap();
        let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
        let g = if file == "mj_B_gentle" { 1.0 } else { 9.81 };
        let known = KnownBody { mass, gravity: DVec3::new(0.0, 0.0, -g), palm_inertias: None, noise: None };
        let clock = std::time::Instant::now();
        let estimate = estimate_motion(&log, &known).unwrap();
        let time = clock.elapsed().as_secs_f64() * 1e3;
        let truth = log.truth().unwrap();
        let cm =
            estimate.motion.iter().zip(truth).map(|(a, b)| (a.p_WCm - b.p_WCm).length()).fold(0.0, f64::max);
        let w =
            estimate.motion.iter().zip(truth).map(|(a, b)| (a.w_WO - b.w_WO).length()).fold(0.0, f64::max);
        println!(
            "{file} n {} of {} cm {cm:.2e} w {w:.2e} {time:.0} ms {:?} {:?}",
            estimate.motion.len(),
            log.samples().len(),
            estimate.reliability,
            estimate.evidence
        );
        println!(
            "  std cm {:?}",
            (0..12).map(|i| format!("{:.1e}", estimate.covariance[(i, i)].sqrt())).collect::<Vec<_>>()
        );
    }
}
