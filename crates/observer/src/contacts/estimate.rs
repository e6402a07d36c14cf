use super::noise::SensorNoise;
use super::problem::{Problem, Units};
use super::record::Record;
use super::solve::solve;
use super::state::{Body, Tangent};
use super::{cold, state::Motion};
use glam::{DMat3, DQuat, DVec3};
use nalgebra::SVector;
use object_dynamics::{BodyState, ContactLog, ContactMode, MOST_PALMS};

/// What was found.
#[derive(Clone, Debug)]
pub struct ContactEstimate {
    /// Motion at the nodes; body axes are those of the first node.
    pub states: Vec<BodyState>,
    /// Samples of the nodes.
    pub nodes: Vec<usize>,
    /// Mass, kg.
    pub mass: f64,
    /// Inertia about the centre of mass, body axes.
    pub inertia: DMat3,
    /// Linearisations.
    pub iterations: usize,
    /// Whether a minimum was reached.
    pub settled: bool,
    /// Cost over conditions.
    pub cost: f64,
}

/// Motion and body from a log with known modes.
#[must_use]
pub fn estimate_contacts(
    log: &ContactLog,
    modes: &[[ContactMode; MOST_PALMS]],
    noise: SensorNoise,
    gravity: f64,
    stride: usize,
    from: Option<(&[BodyState], f64, DMat3)>,
) -> Option<ContactEstimate> {
    let record = Record::new(log, modes, &noise)?;
    let length = cold::size(&record).unwrap_or(0.03);
    let last = record.times.len() - 1;
    let mut nodes: Vec<usize> = (0..last).step_by(stride).collect();
    nodes.push(last);
    let body = cold::ball(&record, gravity, length);
    let first = Motion { p: DVec3::ZERO, v: DVec3::ZERO, L: DVec3::ZERO, q: DQuat::IDENTITY };
    let prior = Tangent::from_fn(|i, _| if i < 9 { 0.0 } else { 1e10 });
    let cross = (body.log_mass.exp() * length * length * 0.2).sqrt();
    let body_information = SVector::<f64, 7>::from_fn(|i, _| match i {
        0 => 0.01,
        1..=3 => 0.25,
        _ => 0.25 / (cross * cross),
    });
    let problem = Problem {
        record: &record,
        noise,
        gravity: DVec3::new(0.0, 0.0, -gravity),
        nodes,
        units: Units { length, speed: (gravity * length).sqrt(), mass: body.log_mass.exp() },
        first: Some((first, prior)),
        body: (body, body_information),
        unexplained: 0.0,
    };
    let stages: Vec<f64> = std::env::var("STAGES").map_or(vec![1.0], |s| s.split(',').map(|x| x.parse().unwrap()).collect());
    let most: usize = std::env::var("MOST").map_or(200, |s| s.parse().unwrap());
    let mut start = cold::start(&problem, body, DQuat::IDENTITY);
    if let Some((states, mass, inertia)) = from {
        let R0 = states[0].R_WO;
        let inertia = DMat3::from_quat(R0) * inertia * DMat3::from_quat(R0).transpose();
        let body = Body::new(mass.ln(), crate::three_palms::numbers_of_inertia(inertia));
        start.body = body;
        start.motions = problem.nodes.iter().map(|&k| {
            let q = states[k].R_WO * R0.conjugate();
            let R = DMat3::from_quat(q);
            Motion { p: states[k].p_WCm - record.origin, v: states[k].v_WCm, L: R * inertia * R.transpose() * states[k].w_WO, q }
        }).collect();
    }
    let mut problem = problem;
    let mut total = 0;
    let mut solved = None;
    for stage in stages {
        let fl: f64 = std::env::var("FL").map_or(1.0, |s| s.parse().unwrap());
        problem.noise = SensorNoise { floor: noise.floor * (1.0 + fl * stage), ..noise };
        problem.unexplained = stage;
        let done = solve::<7>(&problem, start, most)?;
        start = done.unknowns.clone();
        total += done.iterations;
        solved = Some(done);
    }
    let mut solved = solved?;
    solved.iterations = total;
    let state = |motion: &Motion, body: &Body| BodyState {
        p_WCm: motion.p + record.origin,
        v_WCm: motion.v,
        w_WO: body.turn(motion.q, motion.L).w,
        R_WO: motion.q,
    };
    Some(ContactEstimate {
        states: solved.unknowns.motions.iter().map(|m| state(m, &solved.unknowns.body)).collect(),
        mass: solved.unknowns.body.log_mass.exp(),
        inertia: solved.unknowns.body.inertia(),
        iterations: solved.iterations,
        settled: solved.settled,
        cost: solved.equations.cost / solved.equations.conditions as f64,
        nodes: problem.nodes,
    })
}
