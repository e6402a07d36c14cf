//! What palms can bring about at all with a body that is known: the check on planners that say that nothing is left to be done.
//!
//! A flood over a lattice six times as fine as the planners', by the true body. No code is shared with theirs but where a body rests.

use super::{Asked, Rolled, START, let_go, rolled};
use exploration::Knowledge;
use exploration::generators::Family;
use exploration::planar::PlanarKnowledge;
use exploration::rolling::{Balance, Workspace, settle};
use recon::contact_kinematics::planar::PalmPair;
use recon::shape_bounds::exact_hull::planar::Direction;
use recon::shape_bounds::planar::ContactSample;
use std::collections::{HashMap, VecDeque};
use std::f64::consts::TAU;

/// Spacing of the lattice, rad.
const STEP: f64 = 0.05;
/// Rests of the same palms closer than this, rad, are one.
const SAME: f64 = 0.02;
/// Directions closer than this, rad, are one contact.
const CONTACT: f64 = 0.01;

/// Everything that can be felt of a body.
#[derive(Clone, Debug)]
pub struct Reachable {
    /// The gap that all of its contacts prove.
    pub gap: f64,
    /// Their directions, rad, in order.
    pub directions: Vec<f64>,
}

impl Reachable {
    /// Of a body within the limits of `asked`, from where it is let go.
    #[must_use]
    pub fn of((family, seed): (Family, u64), asked: &Asked) -> Self {
        let (body, width) = rolled(family, seed);
        let mut directions = flood(&body, &asked.workspace(width), let_go(seed));
        directions.sort_by(f64::total_cmp);
        directions.dedup_by(|b, a| *b - *a < CONTACT);
        let mut known = PlanarKnowledge::exact();
        for theta in &directions {
            let normal = Direction::from_angle(*theta);
            let point = (body.outline)(normal);
            // Exact contacts of a convex body contradict nothing.
            known.insert(ContactSample { point, normal }).expect("a contact of the body");
        }
        Self { gap: known.measures().gap(), directions }
    }

    /// Angle from a direction (rad) to the nearest that can be felt.
    #[must_use]
    pub fn distance(&self, theta: f64) -> f64 {
        self.directions.iter().map(|felt| between(*felt, theta)).fold(f64::INFINITY, f64::min)
    }
}

/// Angle between two directions, rad.
fn between(a: f64, b: f64) -> f64 {
    let turn = (a - b).rem_euclid(TAU);
    turn.min(TAU - turn)
}

/// Directions of all contacts, rad, in one turn.
fn flood(body: &Rolled, workspace: &Workspace, phi: f64) -> Vec<f64> {
    let at = |node: [i32; 2]| [0, 1].map(|palm| START[palm] + STEP * f64::from(node[palm]));
    let rest = |node: [i32; 2], phi: f64| {
        let [one, two] = at(node);
        let palms = PalmPair::from_absolute(one, two).ok()?;
        let rest = settle(body, &palms, phi)?;
        let balance = Balance::at(body, &palms, rest.phi);
        balance.s.iter().all(|s| *s <= workspace.length).then_some((rest.phi, balance.thetas))
    };
    let mut felt = Vec::new();
    let mut seen: HashMap<[i32; 2], Vec<f64>> = HashMap::new();
    let mut open: VecDeque<([i32; 2], f64)> = VecDeque::new();
    let mut arrive = |node: [i32; 2], from: f64, open: &mut VecDeque<([i32; 2], f64)>| {
        let Some((phi, thetas)) = rest(node, from) else { return };
        let phi = phi.rem_euclid(TAU);
        let there = seen.entry(node).or_default();
        if there.iter().all(|p| between(*p, phi) >= SAME) {
            there.push(phi);
            felt.extend(thetas.map(|theta| theta.rem_euclid(TAU)));
            open.push_back((node, phi));
        }
    };
    arrive([0, 0], phi, &mut open);
    while let Some((node, phi)) = open.pop_front() {
        for step in [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [1, -1], [-1, 1]] {
            let to = [node[0] + step[0], node[1] + step[1]];
            if workspace.allows(at(to)) {
                arrive(to, phi, &mut open);
            }
        }
    }
    felt
}
