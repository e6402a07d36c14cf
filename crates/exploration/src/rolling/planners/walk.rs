//! All that the palms can do with the body itself, step by step over their lattice, where no body drawn promises anything.
//!
//! At rest, what is felt is a matter of the palms' angles and of which rest the body is in. Where every step from every state that can be got to
//! leads to a state that was there before, the palms can do nothing else: no motion uncovers more, up to what hides between the nodes.

use crate::planner::Reason;
use crate::random::Source;
use crate::rolling::belief::Belief;
use crate::rolling::flood::is_same;
use crate::rolling::planner::{RollProposal, SPACING, View};
use crate::rolling::predict::Course;
use crate::rolling::workspace::{Workspace, radians};

/// What was seen of the states of palms and body.
#[derive(Clone, Debug, Default)]
pub(super) struct Walk {
    nodes: Vec<[f64; 2]>,
    states: Vec<State>,
    under_way: Option<UnderWay>,
}

/// The body at rest, the palms at a node.
#[derive(Clone, Debug)]
struct State {
    node: usize,
    phi: f64,
    steps: Vec<Step>,
}

/// To a neighbouring node.
#[derive(Clone, Copy, Debug)]
struct Step {
    node: usize,
    led: Led,
}

/// What a step came to.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Led {
    Untried,
    /// It would lose too many of the bodies drawn.
    Risky,
    /// To a state.
    To(usize),
}

/// A step that is being made, and the falls before it.
#[derive(Clone, Copy, Debug)]
struct UnderWay {
    state: usize,
    step: usize,
    falls: usize,
}

/// Palms closer than this to a node, rad, are there.
const THERE: f64 = 1e-3;
/// Nodes that differ by more, rad, are no neighbours.
const FARTHEST: f64 = 1.5 * SPACING;

impl Walk {
    /// The next step that was not made yet, or the way to where one is left; none where all were made, but for those that the risk forbids.
    pub(super) fn next(&mut self, view: &View<'_>, belief: &Belief) -> Option<RollProposal> {
        if self.nodes.is_empty() {
            self.nodes = view.workspace.lattice(SPACING);
        }
        let Some(here) = self.arrive(view) else {
            let way = |node: &&[f64; 2]| radians(view.track.palms, **node);
            let nearest = self.nodes.iter().min_by(|a, b| way(a).total_cmp(&way(b)))?;
            return Some(proposed(vec![*nearest]));
        };
        self.judge(here, view, belief);
        let route = self.route(here)?;
        let (last, rest) = route.split_last()?;
        if !rest.is_empty() {
            return Some(proposed(route[1..].iter().map(|state| self.palms(*state)).collect()));
        }
        // Any of them: who asks for one motion at a time, without memory, so does not go to and fro.
        let open = self.states[*last].untried();
        let drawn = Source::new(view.motion as u64).unit() * open.len() as f64;
        let step = open.get(drawn as usize).copied()?;
        self.under_way = Some(UnderWay { state: here, step, falls: view.track.falls });
        Some(proposed(vec![self.nodes[self.states[here].steps[step].node]]))
    }

    fn palms(&self, state: usize) -> [f64; 2] {
        self.nodes[self.states[state].node]
    }

    /// The state that palms and body are in, and what a step under way has led to; none between the nodes.
    fn arrive(&mut self, view: &View<'_>) -> Option<usize> {
        let (palms, phi) = (view.track.palms, view.track.phi);
        let under_way = self.under_way.take();
        let node = self.nodes.iter().position(|n| is_near(*n, palms, THERE))?;
        let known = self.states.iter().position(|s| s.node == node && is_same(s.phi, phi));
        let here = known.unwrap_or_else(|| {
            let steps = neighbours(view.workspace, &self.nodes, node);
            self.states.push(State { node, phi, steps });
            self.states.len() - 1
        });
        if let Some(UnderWay { state, step, falls }) = under_way
            && self.states[state].steps[step].node == node
        {
            self.states[state].steps[step].led = Led::To(here);
            // Rest by rest the way back is the way there; where the body fell, or moves on, it is not.
            if falls == view.track.falls && view.track.dynamics.is_none() {
                let back = self.states[state].node;
                for step in self.states[here].steps.iter_mut().filter(|s| s.node == back) {
                    step.led = Led::To(state);
                }
            }
        }
        Some(here)
    }

    /// Rules out the steps from `here` that lose too many of the bodies drawn.
    fn judge(&mut self, here: usize, view: &View<'_>, belief: &Belief) {
        let start = Course::start(belief, view.track);
        let nodes = &self.nodes;
        for step in self.states[here].steps.iter_mut().filter(|step| step.led == Led::Untried) {
            let course = start.then(belief, view.workspace, nodes[step.node]);
            if course.prediction(belief, view.workspace).lost > view.risk {
                step.led = Led::Risky;
            }
        }
    }

    /// States from `here` to the nearest one from which a step was not made yet, both included; none where there is none.
    fn route(&self, here: usize) -> Option<Vec<usize>> {
        let mut ways = vec![f64::INFINITY; self.states.len()];
        let mut from = vec![None; self.states.len()];
        let mut done = vec![false; self.states.len()];
        ways[here] = 0.0;
        loop {
            let open = (0..ways.len()).filter(|k| !done[*k] && ways[*k].is_finite());
            let next = open.min_by(|a, b| ways[*a].total_cmp(&ways[*b]))?;
            if !self.states[next].untried().is_empty() {
                let mut route: Vec<usize> = std::iter::successors(Some(next), |k| from[*k]).collect();
                route.reverse();
                return Some(route);
            }
            done[next] = true;
            for step in &self.states[next].steps {
                let Led::To(to) = step.led else { continue };
                let way = ways[next] + radians(self.palms(next), self.palms(to));
                if way < ways[to] {
                    (ways[to], from[to]) = (way, Some(next));
                }
            }
        }
    }
}

impl State {
    fn untried(&self) -> Vec<usize> {
        (0..self.steps.len()).filter(|k| self.steps[*k].led == Led::Untried).collect()
    }
}

fn proposed(legs: Vec<[f64; 2]>) -> RollProposal {
    RollProposal { legs, expected: None, reason: Reason::Sequence }
}

fn is_near(a: [f64; 2], b: [f64; 2], within: f64) -> bool {
    (a[0] - b[0]).abs() < within && (a[1] - b[1]).abs() < within
}

/// Steps from a node: one palm turns, or both where neither can alone.
fn neighbours(workspace: &Workspace, nodes: &[[f64; 2]], node: usize) -> Vec<Step> {
    let here = nodes[node];
    let is_step = |to: [f64; 2]| {
        let one_turns = (0..2).any(|palm| (to[palm] - here[palm]).abs() < THERE);
        let could_alone = [[to[0], here[1]], [here[0], to[1]]].iter().any(|palms| workspace.allows(*palms));
        to != here && is_near(to, here, FARTHEST) && (one_turns || !could_alone)
    };
    let all = (0..nodes.len()).filter(|k| is_step(nodes[*k]));
    all.map(|node| Step { node, led: Led::Untried }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A band of angles in which palms can only turn together is gone along, and a box step by step.
    #[test]
    fn neighbours_differ_in_one_palm_where_one_can_turn_alone() {
        let wide = Workspace { angles: [[0.5, 1.0], [2.0, 2.5]], ..Workspace::for_size(1.0) };
        let counts = |workspace: &Workspace| -> Vec<usize> {
            let nodes = workspace.lattice(SPACING);
            assert!(nodes.iter().all(|node| workspace.allows(*node)));
            (0..nodes.len()).map(|k| neighbours(workspace, &nodes, k).len()).collect()
        };
        assert_eq!(counts(&wide), [2, 3, 2, 3, 4, 3, 2, 3, 2]);
        // On nodes of the lattice of both angles, and between them.
        assert_eq!(counts(&Workspace { wedge: [1.5, 1.5], ..wide }), [1, 2, 1]);
        assert_eq!(counts(&Workspace { wedge: [1.6, 1.6], ..wide }), [1, 1]);
        let alone = Workspace { angles: [[0.5, 1.0], [2.0, 2.0]], ..wide };
        assert_eq!(counts(&alone), [1, 2, 1]);
    }
}
