//! Observability of the paper's planar system by Lie derivatives, along the reference scenes, beside what the estimator finds.
//!
//! `cargo xtask study planar_observability` writes docs/planar-observability.md and docs/charts/planar-observability.svg.

use recon::contact_kinematics::planar::{Ellipse, PairContact, PalmPair};
use recon::object_dynamics::planar::*;
use recon::observer::contacts::ContactNoiseLevel;
use recon::observer::planar::*;
use recon_io::{FigureCurve, FigurePanel, write_figures};
use recon_tests::planar_scenes::scene;
use std::error::Error;
use std::fmt::Write as _;

type Failure = Box<dyn Error>;

const SCENES: [(&str, &str); 4] = [
    ("S1", "S1_tumble_immobile"),
    ("S2", "S2_rotating_pair"),
    ("S3", "S3_rocking_immobile"),
    ("S4", "S4_ellipse_both_palms_move"),
];
/// Size of the objects of these scenes, m.
const SIZE: f64 = 0.04;
const RATE: f64 = 100.0;
/// Longest log, s.
const LASTS: f64 = 1.0;
/// Lengths of chains: of free torques, and of torques that are held.
const DEPTHS: [usize; 2] = [2, 4];
const SEED: u64 = 3;

/// One sample.
struct Told {
    t: f64,
    free: Observability,
    held: Observability,
    /// Smallest of `|z_i|`, natural units.
    z: f64,
    /// The largest deviation of place, velocity and spin, natural units.
    deviation: f64,
}

pub(crate) fn main() -> Result<(), Failure> {
    let mut text = String::from(
        "# Observability in the plane by Lie derivatives\n\nMade by `cargo xtask study planar_observability`.\n\n",
    );
    writeln!(
        text,
        "The gradients of the readings `h` and of their Lie derivatives, by the state `(r_1, r_2, omega0, s_1, s_2, phi_1, phi_2)`, in natural units \
         (length {SIZE} m, time `sqrt(length / g)`, torque weight times length; longer gradients count as of length one). Free: chains of up to {} of `f`, `g_1`, `g_2`. Held: of up to {} of \
         `f + tau_1 g_1 + tau_2 g_2` with the torques of the sample. Every scene at {RATE} Hz for {LASTS} s. Deviation: the largest of those of place, velocity \
         and spin that the estimator states (known body, contacts 0.1 mm, forces 1 % of the weight).\n",
        DEPTHS[0], DEPTHS[1]
    )?;
    text += "| scene | samples | rank, free | smallest singular value, free: least, median | condition, median | rank, held | smallest, held: least, median | condition, median | deviation: first, middle, last sample |\n\
             |---|---|---|---|---|---|---|---|---|\n";
    let mut panels = Vec::new();
    for (short, name) in SCENES {
        let all = along(name)?;
        text += &line(short, &all);
        panels.push(panel(short, &all));
    }
    text += &lost()?;
    print!("{text}");
    std::fs::write("docs/planar-observability.md", &text)?;
    let mut svg = Vec::new();
    write_figures(&panels, &mut svg)?;
    std::fs::write("docs/charts/planar-observability.svg", svg)?;
    Ok(())
}

fn units(mass: PlanarMass, gravity: f64) -> NaturalUnits {
    let time = (SIZE / gravity).sqrt();
    NaturalUnits { length: SIZE, time, torque: mass.mass() * gravity * SIZE }
}

/// `f`, `g_1` and `g_2` with their units.
fn free(units: NaturalUnits) -> [(LieField, f64); 3] {
    let input = units.time * units.torque;
    [([1.0, 0.0, 0.0], units.time), ([0.0, 1.0, 0.0], input), ([0.0, 0.0, 1.0], input)]
}

fn held([first, second]: [f64; 2], units: NaturalUnits) -> [(LieField, f64); 1] {
    [([1.0, first, second], units.time)]
}

fn along(name: &str) -> Result<Vec<Told>, Failure> {
    let (object, motion, start) = scene(name);
    let units = units(object.mass, object.gravity);
    let count = (LASTS * RATE) as u32;
    let times: Vec<f64> = (0..=count).map(|k| f64::from(k) / RATE).collect();
    let run = simulate_prescribed(&object, &motion, start, &times, 1e-13)?;
    let weight = object.mass.mass() * object.gravity;
    let noise = PlanarNoise { contact: 1e-4, force: 0.01 * weight, torque: 0.0 };
    let log = noise.add_to(&run.log()?, SEED).contact_log([0.0; 2]).ok_or("no forces")?;
    let floor = 3e-5 * (object.gravity * SIZE).sqrt();
    let level = ContactNoiseLevel {
        contact: 1e-4,
        force_fixed: 0.01 * weight,
        force_share: 0.0,
        impulse: None,
        floor,
    };
    let options = PlaneOptions {
        body: Some(object.mass),
        suspects: true,
        ..PlaneOptions::new(level, object.gravity, vec![Some(0.0); 2])
    };
    let estimate = estimate_plane(&log, &options)?;
    let mut all = Vec::new();
    for (sample, deviations) in run.samples.iter().zip(&estimate.deviations) {
        let palms = motion.at(sample.sample.t)?;
        let fields =
            AuthorsFields { mass: object.mass, gravity: object.gravity, palm_rates: palms.motion.rates };
        let contact = PairContact::new(&object.shape, &palms.pair, sample.truth.phi0);
        let q = AuthorsFields::state_of(&contact, &palms.pair, sample.truth.omega0);
        let torques = sample.sample.torques.ok_or("no torques")?;
        let speed = units.length / units.time;
        let of = [
            deviations.p_WCm.max_element() / units.length,
            deviations.v_WCm.max_element() / speed,
            deviations.omega0 * units.time,
        ];
        all.push(Told {
            t: sample.sample.t,
            free: fields.observability(&q, &free(units), DEPTHS[0], units)?,
            held: fields.observability(&q, &held(torques, units), DEPTHS[1], units)?,
            z: fields.palm_rates.iter().map(|w| (q[2] - w).abs()).fold(f64::INFINITY, f64::min) * units.time,
            deviation: of.into_iter().fold(0.0, f64::max),
        });
    }
    Ok(all)
}

fn line(name: &str, all: &[Told]) -> String {
    let sorted = |of: &dyn Fn(&Told) -> f64| {
        let mut values: Vec<f64> = all.iter().map(of).collect();
        values.sort_by(f64::total_cmp);
        values
    };
    let part = |of: &dyn Fn(&Told) -> &Observability| {
        let smallest = sorted(&|told| of(told).singular_values[6]);
        let condition = sorted(&|told| of(told).condition());
        let ranks = all.iter().map(|told| of(told).rank);
        let ranks = (ranks.clone().min().unwrap_or(0), ranks.max().unwrap_or(0));
        let ranks =
            if ranks.0 == ranks.1 { ranks.0.to_string() } else { format!("{} to {}", ranks.0, ranks.1) };
        let middle = all.len() / 2;
        format!("{ranks} | {:.1e}, {:.1e} | {:.0e}", smallest[0], smallest[middle], condition[middle])
    };
    let [first, middle, last] = [0, all.len() / 2, all.len() - 1].map(|k| all[k].deviation);
    format!(
        "| {name} | {} | {} | {} | {first:.1e}, {middle:.1e}, {last:.1e} |\n",
        all.len(),
        part(&|told| &told.free),
        part(&|told| &told.held)
    )
}

fn panel(name: &str, all: &[Told]) -> FigurePanel {
    let curve = |name: &str, of: &dyn Fn(&Told) -> f64| FigureCurve {
        name: name.to_owned(),
        points: all.iter().map(|told| [told.t, of(told).log10()]).collect(),
        ..FigureCurve::default()
    };
    FigurePanel {
        title: name.to_owned(),
        axes: ["t in s".to_owned(), "log10, natural units".to_owned()],
        curves: vec![
            curve("free", &|told| told.free.singular_values[6]),
            curve("held", &|told| told.held.singular_values[6]),
            curve("deviation", &|told| told.deviation),
            curve("|z|", &|told| told.z),
        ],
        ..FigurePanel::default()
    }
}

/// States at which the readings hide a direction, and ones nearby.
fn lost() -> Result<String, Failure> {
    let mut text = String::from(
        "\nWhere rank is lost (fields of S1's body):\n\n| state | chains | rank | smallest singular value | condition | worst direction: r_1, r_2, omega0 |\n|---|---|---|---|---|---|\n",
    );
    let (object, _, _) = scene("S1_tumble_immobile");
    let own = |gravity: f64| AuthorsFields { mass: object.mass, gravity, palm_rates: [0.0; 2] };
    let units = units(object.mass, object.gravity);
    let mut row = |name: &str, chains: &str, found: &Observability| {
        let [r1, r2, omega, ..] = found.worst;
        writeln!(
            text,
            "| {name} | {chains} | {} | {:.1e} | {:.0e} | {r1:.2}, {r2:.2}, {omega:.2} |",
            found.rank,
            found.singular_values[6],
            found.condition()
        )
    };
    let pair = PalmPair::new(45_f64.to_radians(), 135_f64.to_radians())?;
    let weight = object.mass.mass() * object.gravity;
    for (name, axes, omega) in [
        ("centred disc, at rest but for its spin", [SIZE, SIZE], 4.0),
        ("ellipse, axes 1 % apart", [1.005 * SIZE, 0.995 * SIZE], 4.0),
        ("ellipse, axes 20 % apart", [1.1 * SIZE, 0.9 * SIZE], 4.0),
        ("the same, turning slowly", [1.1 * SIZE, 0.9 * SIZE], 0.04),
    ] {
        let shape = Ellipse::new(axes[0], axes[1], glam::DVec2::ZERO)?;
        let contact = PairContact::new(&shape, &pair, 0.3);
        let q = AuthorsFields::state_of(&contact, &pair, omega);
        // Forces that carry the weight.
        let ([p1, p2], sin) = (pair.angles(), pair.sin());
        let torques = [weight * p2.sin() / sin * contact.s[0], -weight * p1.sin() / sin * contact.s[1]];
        let fields = own(object.gravity);
        for depth in 1..=2 {
            let found = fields.observability(&q, &free(units), depth, units)?;
            row(name, &format!("free, {depth}"), &found)?;
        }
        for depth in [2, 4] {
            let found = fields.observability(&q, &held(torques, units), depth, units)?;
            row(name, &format!("held, {depth}"), &found)?;
        }
        if axes[0] > 1.01 * SIZE && omega > 1.0 {
            let found = own(0.0).observability(&q, &held([0.0; 2], units), 4, units)?;
            row("the same without gravity and torques", "held, 4", &found)?;
        }
    }
    Ok(text)
}
