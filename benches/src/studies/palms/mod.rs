//! x
use recon_benches::palms::*;
use exploration::generators::Family;
use recon::object_dynamics::{ContactStart, SampleTimes};
use recon_benches::reaching::in_threads;
use recon_benches::reaching::Bodies;
use std::time::Instant;

pub(crate) fn main() -> Result<(), Box<dyn std::error::Error>> {
    let w: Vec<f64> = crate::words().map(|a| a.parse()).collect::<Result<_, _>>()?;
    let get = |k: usize, d: f64| w.get(k).copied().unwrap_or(d);
    let (each, first) = (get(0, 1.0) as u64, get(1, 150000.0) as u64);
    let m = Motion { slope: get(2, 55.0).to_radians(), tilts: [get(3, 0.35), get(4, 0.35)], ramp: get(5, 0.3), count: get(6, 12.0) as usize, friction: get(7, 0.2) };
    let all: Vec<(Family, u64)> = Bodies { first, each }.all().collect();
    let out = in_threads(&all, |&(family, seed)| {
        let t0 = Instant::now();
        let body = match palm_body(family, seed) { Ok(b) => b, Err(e) => return format!("{e}\n") };
        use recon::contact_kinematics::SupportFunction;
        let r = body.shape.curvature_radii();
        let mut text = format!("{} {seed} rounding {} radii {:.2} {:.2} {:.2} s\n", family.name(), body.ball, r.min / SIZE, r.max / SIZE, t0.elapsed().as_secs_f64());
        for kind in PalmKind::ALL {
            let t0 = Instant::now();
            let line = match held(&body, kind, &m, seed) {
                Err(e) => e.to_string(),
                Ok((scene, start)) => match scene.simulate(&ContactStart::touching(start), SampleTimes { duration: m.duration(), rate: 200.0 }, 1e-7) {
                    Err(e) => e.to_string(),
                    Ok(run) => {
                        let last = run.instants.last().unwrap();
                        let f = &run.instants[0].state.body; let l = &last.state.body;
                        let touch = run.instants.iter().map(|i| i.modes.iter().filter(|m| !matches!(m, recon::object_dynamics::ContactMode::Off)).count()).sum::<usize>() as f64 / run.instants.len() as f64 / 3.0;
                        format!("turn {:.0} deg, path {:.2} touch {:.2} moved {:.2} events {} height {:.2}", f.R_WO.angle_between(l.R_WO).to_degrees(), run.instants.windows(2).map(|w| w[0].state.body.R_WO.angle_between(w[1].state.body.R_WO)).sum::<f64>(), touch, (l.p_WCm - f.p_WCm).length() / SIZE, run.events.len(), l.p_WCm.z / SIZE)
                    }
                },
            };
            eprintln!("{} {seed} {} {:.1}", family.name(), kind.name(), t0.elapsed().as_secs_f64());
            text += &format!("   {:14} {:.2} s {line}\n", kind.name(), t0.elapsed().as_secs_f64());
        }
        text
    });
    out.iter().for_each(|t| print!("{t}"));
    Ok(())
}
