//! How modes, speeds of sliding and ratios of sticking change from one sample to the next.

use super::bins::{Bins, Ends, Walk};
use super::normal::below;

/// Bins of the speed of sliding, in shares of the natural speed, and of the ratio of sticking over the friction.
pub(super) const SPEEDS: usize = 36;
const RATIOS: usize = 40;

/// Time steps within this share of each other are taken as one: walks grow by their root, and are no better known.
pub(super) const SAME: f64 = 0.1;
/// The time that the numbers below are of, s.
const UNIT: f64 = 1e-3;
/// How fast things change has two paces: where a body moves on its own, and where it goes along with palms that move slowly. At the first one alone, what
/// slides slowly for long is next to impossible, and is held for sticking at a ratio that happens to stay: frictions come out too high.
pub(super) const PACES: usize = 2;
/// Share of what begins at each.
const EACH: f64 = 1.0 / PACES as f64;
/// Deviation of the change of the speed, in shares of the natural speed, and of the ratio, at each.
const SPEED_STEPS: [f64; PACES] = [0.0055, 0.06 * 0.0055];
const RATIO_STEPS: [f64; PACES] = [0.002, 0.1 * 0.002];
/// Probability a millisecond that the pace changes.
const PACED: f64 = 0.002;
/// Share of what is known of the pace that is given up for that from sample to sample.
pub(super) const CHANGED: f64 = PACES as f64 * PACED;
/// Units for which a ratio goes on as it goes: what presses and turns a body has inertia. Were it a walk over the time without samples, it would come
/// less far than it does, and what begins to slide there would be held for sticking.
const SMOOTH: f64 = 30.0;
/// Probability that the ratio jumps anywhere in the disc.
const JUMP: f64 = 0.002;
/// Share of sticking that begins near its cone.
const NEAR: f64 = 0.95;
/// Bins of the ratio where frictions are to be told from each other: alike up to `LOW`, each wider than the one before beyond.
const LOW: f64 = 0.1;
const FINE: usize = 12;
const WIDER: f64 = 1.032;
/// Bins next to the cone that are those of a known friction.
const RIM: usize = 8;
/// Probability a millisecond that sticking ends although the ratio is within the cone (blows, errors of the friction), and that a
/// contact comes or goes.
const BREAK: f64 = 0.002;
const TOUCH: f64 = 0.002;
/// Share of the walks that come to rest which stick; the others slide on, back. A walk that comes to zero crosses it again and again, where a speed
/// with inertia comes to rest once: were each crossing a stop, sliding slowly and sticking near the cone would change with each other from sample to
/// sample, and a ratio that stays at the cone would be held for sticking.
const CAPTURED: f64 = 0.2;
/// Share of what comes to the edge of the cone, from sliding or from within, that stays there without a slip until it breaks away. A ratio that stays the same says
/// that it is the friction, whatever the friction is, and of a body at rest all do: were there but sliding at that ratio, a body at rest would be held for sliding
/// slowly, and tell its friction.
pub(super) const EDGE: f64 = 0.005;
/// Probability a millisecond that it does break away.
const LEAVES: f64 = 0.01;
/// Steps of the ratio within which sticking begins near its cone.
const NEAR_STEPS: f64 = 3.0;
/// Deviation of the slip at touch-down, in shares of the natural speed.
const LANDING: f64 = 0.15;
/// What steps under a speed of zero sticks from now on, or slides on, back; what steps over the friction slides from now on.
const SPEED_ENDS: Ends = Ends { reflected: 1.0 - CAPTURED, stops: true };
const RATIO_ENDS: Ends = Ends { reflected: 1.0, stops: false };
/// Least probability of a switch: nothing is ever impossible for good.
const LEAST: f64 = 1e-12;

/// What happens in one time step to a contact of some friction.
#[derive(Clone, Debug)]
pub(super) struct Steps {
    pub(super) speeds: Bins,
    pub(super) ratios: Bins,
    /// So many of the first are those of all frictions (see [`bins_of_all`]).
    pub(super) common: usize,
    /// Of each pace: what steps under zero sticks from now on.
    pub(super) speed: [Walk; PACES],
    /// Of each pace: what steps over one, the friction, slides from now on.
    pub(super) ratio: [Walk; PACES],
    /// Probabilities of a jump of the ratio, of the end of sticking, of touch and its loss, that the pace changes, and that rest at the edge ends.
    pub(super) jump: f64,
    pub(super) breaks: f64,
    pub(super) touch: f64,
    pub(super) paced: f64,
    pub(super) leaves: f64,
    /// Of each pace, one after the other: speeds at the start of sliding, after sticking and after touch-down; ratios at the start of sticking, after sliding
    /// and anywhere.
    pub(super) starts: Vec<f64>,
    pub(super) landing: Vec<f64>,
    pub(super) stops: Vec<f64>,
    pub(super) disc: Vec<f64>,
    /// What it is of.
    pub(super) friction: f64,
    dt: f64,
}

impl Steps {
    /// For steps of this time, s, of a contact with this friction, where frictions are to be told from each other.
    ///
    /// Bins and walk of the ratio are those of any other friction, cut off at this one: how a contact sticks well within its cone then
    /// says nothing of where that ends. Were they shares of the friction, a ratio that changes slowly would speak for a low one.
    pub(super) fn of_friction(dt: f64, friction: f64) -> Self {
        // Close to the cone bins are those of a known friction, which get narrow there.
        let rim: Vec<f64> = (0..=RIM).rev().map(|k| relative((RATIOS - k) as f64 / RATIOS as f64)).collect();
        let within = |edge: &f64| *edge < rim[0] - (rim[1] - rim[0]);
        let mut edges: Vec<f64> = (0..).map(|k| edge(k) / friction).take_while(within).collect();
        let common = edges.len().saturating_sub(1);
        edges.extend(rim);
        let (speeds, ratios) = (speeds(), Bins::between(&edges));
        let at_each = |shares: Vec<f64>| -> Vec<f64> {
            let all = shares.into_iter().map(|share| EACH * share);
            all.collect::<Vec<_>>().repeat(PACES)
        };
        let mut steps = Self {
            starts: vec![0.0; PACES * SPEEDS],
            landing: at_each(speeds.shares(|s| below(s / LANDING))),
            jump: 0.0,
            breaks: 0.0,
            touch: 0.0,
            paced: 0.0,
            leaves: 0.0,
            stops: vec![0.0; PACES * ratios.count()],
            disc: at_each(ratios.shares(|q| q * q)),
            speed: std::array::from_fn(|_| Walk::on(SPEEDS)),
            ratio: std::array::from_fn(|_| Walk::on(ratios.count())),
            speeds,
            ratios,
            common,
            friction,
            dt,
        };
        steps.set(dt);
        steps
    }

    /// The same, with room to be made anew for another time without allocating.
    pub(super) fn that_follow(dt: f64, friction: f64) -> Self {
        let mut steps = Self::of_friction(dt, friction);
        steps.speed.iter_mut().for_each(Walk::make_room);
        steps.ratio.iter_mut().for_each(Walk::make_room);
        steps
    }

    /// For steps of another time.
    fn set(&mut self, dt: f64) {
        let units = dt / UNIT;
        let speed_steps = SPEED_STEPS.map(|a_unit| a_unit * units.sqrt());
        let ratio_steps = RATIO_STEPS.map(|a_unit| a_unit / self.friction * of_smooth(units));
        let count = self.ratios.count();
        for (pace, step) in speed_steps.into_iter().enumerate() {
            self.speed[pace].set(&self.speeds, step, SPEED_ENDS);
            let starts = &mut self.starts[pace * SPEEDS..][..SPEEDS];
            self.speeds.put_shares(|s| below(s / step), starts);
            starts.iter_mut().for_each(|share| *share *= EACH);
        }
        for (pace, step) in ratio_steps.into_iter().enumerate() {
            self.ratio[pace].set(&self.ratios, step, RATIO_ENDS);
            let own = pace * count..(pace + 1) * count;
            let stops = &mut self.stops[own.clone()];
            self.ratios.put_shares(|q| ((q - 1.0) / (NEAR_STEPS * step)).exp(), stops);
            for (stop, disc) in stops.iter_mut().zip(&self.disc[own]) {
                *stop = NEAR * EACH * *stop + (1.0 - NEAR) * disc;
            }
        }
        let within = |a_unit: f64| (1.0 - (-rate_of(a_unit) * dt / UNIT).exp()).clamp(LEAST, 1.0 - LEAST);
        (self.jump, self.breaks, self.touch) = (within(JUMP), within(BREAK), within(TOUCH));
        (self.paced, self.leaves) = (within(PACED), within(LEAVES));
        self.dt = dt;
    }

    /// Deviation of the change of the ratio in so many steps.
    pub(super) fn walked(&self, times: usize) -> f64 {
        RATIO_STEPS[0] * of_smooth(self.dt / UNIT) * (times as f64).sqrt()
    }

    /// How many of these steps a time step is. Made anew where it is not one of them, or of two where `twice` allows: clocks jitter, and the walks are no
    /// better known than this.
    pub(super) fn follow(&mut self, dt: f64, twice: bool) -> usize {
        let times = (dt / self.dt).round();
        let most = if twice { 2.0 } else { 1.0 };
        if (1.0..=most).contains(&times) && (dt - times * self.dt).abs() <= SAME * dt {
            return times as usize;
        }
        self.set(dt);
        1
    }
}

/// Deviation of the change of a ratio over a time, s, at one of the paces.
pub(super) fn walked_ratio(pace: usize, dt: f64) -> f64 {
    RATIO_STEPS[pace] * of_smooth(dt / UNIT)
}

/// By how much more a ratio changes in so many units than in one: as a walk within one, at the same rate from there on, and as a walk of steps of
/// [`SMOOTH`] beyond that.
fn of_smooth(units: f64) -> f64 {
    let at_one_rate = units.clamp(1.0, SMOOTH);
    at_one_rate * (units / at_one_rate).sqrt()
}

/// An edge of the bins of the ratio that all frictions have, as far as they reach.
fn edge(k: usize) -> f64 {
    match k.checked_sub(FINE) {
        None => LOW * k as f64 / FINE as f64,
        Some(beyond) => LOW * WIDER.powi(beyond as i32),
    }
}

/// Bins of the ratio that all frictions up to this one have, as such and not over the friction.
pub(super) fn bins_of_all(highest: f64) -> Bins {
    let within: Vec<f64> = (0..).map(edge).take_while(|edge| *edge < highest).collect();
    Bins::between(if within.len() > 1 { &within } else { &[0.0, LOW] })
}

/// Edges of ratios over a known friction: close together near one.
fn relative(x: f64) -> f64 {
    1.0 - (1.0 - x).powf(1.7)
}

/// Bins of the speed of sliding.
pub(super) fn speeds() -> Bins {
    Bins::new(SPEEDS, |x| 1.2 * (0.006 * x + 0.994 * x.powi(3)))
}

/// Of events that happen with this probability in a unit of time.
fn rate_of(probability: f64) -> f64 {
    -(-probability).ln_1p()
}
