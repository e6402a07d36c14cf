use super::*;
use crate::three_palms::covariance::NoiseLevel;
use contact_kinematics::{Ellipsoid, Palm, SlopeMotion};
use glam::{DQuat, DVec3};
use object_dynamics::integrate::Tolerance;
use object_dynamics::{
    InitialMotion, SampleTimes, SensorLog, SensorNoise, Simulation, ThreePalmScene, MassProperties,
};

const NOISE: NoiseLevel = NoiseLevel { contact: 2.5e-3, force: 0.065 };

/// An ellipsoid on palms that swing, which keeps its contacts.
fn run(duration: f64, rate: f64) -> (ThreePalmScene<Ellipsoid>, Simulation, SensorLog) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    let mass = MassProperties::uniform_ellipsoid(1.3, axes).unwrap();
    let palm = |azimuth, phase| {
        let motion = SlopeMotion::Sinusoid { slope: 1.0, amplitude: 0.08, frequency: 1.7, phase };
        Palm::new(azimuth, motion).unwrap()
    };
    let palms = [palm(0.1, 0.3), palm(2.2, 1.0), palm(4.3, 2.0)];
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, 9.81).unwrap();
    let start = InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) };
    let times = SampleTimes { duration, rate };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-12)).unwrap();
    let log = simulation.sensor_log(&scene).unwrap();
    (scene, simulation, log)
}

fn stream(scene: &ThreePalmScene<Ellipsoid>, noise: NoiseLevel, rate: f64, known: bool) -> MotionStream {
    let options = StreamOptions {
        mass: known.then_some(*scene.mass()),
        gravity: scene.gravity(),
        palm_inertias: None,
        noise,
        sample_rate: rate,
    };
    MotionStream::new(options).unwrap()
}

#[test]
fn it_finds_the_motion_and_follows_it() {
    let (scene, simulation, log) = run(8.0, 1000.0);
    println!("{} samples", log.samples().len());
    let noise = SensorNoise { contact: NOISE.contact, force: NOISE.force, torque: 0.0 };
    for (t,n) in if true {vec![]} else {vec![("clean",0.0),("tenth",0.1),("full",1.0)]} {
        let l = log.with_noise(&SensorNoise{contact:noise.contact*n,force:noise.force*n,torque:0.0},1).unwrap();
        let m=NoiseLevel{contact:(NOISE.contact*n).max(1e-9),force:(NOISE.force*n).max(1e-8)};
        let e=crate::estimate_motion(&l,&crate::KnownBody{mass:*scene.mass(),gravity:scene.gravity(),palm_inertias:None,noise:Some(m)}).unwrap();
        println!("batch {t} {:e} {:?}", e.start.p_WCm.distance(simulation.instants[0].touch.p_WCm), e.reliability);
        let mut s=stream(&scene,m,1000.0,true);
        let mut last=None;
        for x in l.samples(){ last=s.push(x).unwrap(); }
        let e=last.unwrap(); println!("stream {t} {:?} {:e}", e.stage, e.motion.p_WCm.distance(simulation.instants[3999].touch.p_WCm));
    }
    let noisy = log.with_noise(&noise, 1).unwrap();
    for known in [true, false] {
    let mut stream = stream(&scene, NOISE, 1000.0, known);
    let clock = std::time::Instant::now();
    for (k, sample) in noisy.samples().iter().enumerate() {
        let Some(estimate) = stream.push(sample).unwrap() else { continue };
        if k % 250 == 0 {
            let truth = &simulation.instants[k - 1];
            let dev = estimate.covariance.diagonal().map(f64::sqrt);
            println!(
                "{:.3} {:?} p {:.1e} ({:.1e}) v {:.1e} ({:.1e}) w {:.1e} nis {:.2} cpu {:.1} ms {:?}",
                estimate.motion.t,
                estimate.stage,
                estimate.motion.p_WCm.distance(truth.touch.p_WCm), dev.rows(0,3).norm(),
                estimate.motion.v_WCm.distance(truth.rates.v_WCm), dev.rows(3,3).norm(),
                estimate.motion.w_WO.distance(truth.w_WO),
                estimate.innovation, clock.elapsed().as_secs_f64()*1e3, estimate.body.map(|b| (b.mass, b.mass_deviation, b.inertia.to_cols_array(), b.inertia_deviation.x_axis)),
            );
        }
    }
}
}
