use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, Palm, SlopeMotion};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{InitialMotion, MassProperties, SampleTimes, ThreePalmScene};
fn main() {
    let axes = DVec3::new(1.6, 2.0, 2.4);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    for amp in [0.02,0.04] {
        for spin in [0.1,0.3] {
            for (name, q) in [
                ("z up", DQuat::IDENTITY),
                ("x up", DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2)),
                ("y up", DQuat::from_rotation_x(std::f64::consts::FRAC_PI_2)),
            ] {
                let palm = |azimuth, frequency, phase| {
                    Palm::new(azimuth, SlopeMotion::Sinusoid { slope: 0.8, amplitude: amp, frequency, phase }).unwrap()
                };
                let palms = [palm(0.1, 1.7, 0.3), palm(2.2, 2.1, 1.0), palm(4.3, 1.3, 2.0)];
                let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
                let start = InitialMotion { R_WO: q, w_WO: spin * DVec3::new(0.7, -0.5, 0.5) };
                let times = SampleTimes { duration: 60.0, rate: 100.0 };
                match scene.simulate(start, times, Tolerance::uniform(1e-10)) {
                    Ok(s) => {
                        let n = s.instants.len();
                        let mut wmax: f64 = 0.0;
                        for i in &s.instants { wmax = wmax.max(i.w_WO.length()); }
                        println!("{amp} {spin} {name} {} wmax {wmax:.2} z {:.2}", n, s.instants[n - 1].touch.p_WCm.z)
                    }
                    Err(e) => println!("{e}"),
                }
            }
        }
    }
}
