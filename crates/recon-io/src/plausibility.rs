//! Whether a log and a scene speak of the same units. Nothing here changes a number: it only warns.

use crate::Scene;
use crate::number::{brief, brief_to};
use glam::DVec3;
use recon::contact_kinematics::PalmFrame;
use recon::object_dynamics::{ContactLog, Sample, SensorLog};
use std::fmt;

/// Contacts further apart than this many radii of gyration, or nearer than its inverse, are no object's. A uniform rod
/// has sqrt(12) = 3.5, a ball with touching points a third of its girth apart 2.7; tips that nearly meet have less.
const LARGEST_SPREAD: f64 = 30.0;

/// A body whose radii of curvature are at most R fits into a ball of radius R, so its contacts are at most 2 R apart;
/// the rest is for noise.
const CURVATURE_SLACK: f64 = 1.1;

/// Mean vertical contact force over weight outside of one over this and this: the object would fly or fall.
const LARGEST_FORCE_RATIO: f64 = 5.0;

/// Natural speeds by which forces may change the velocity from the first sample to the last: a body that stays between its palms is as fast as that at neither.
const LARGEST_CHANGE: f64 = 5.0;
/// The same beyond which no motion is worth looking for.
const HOPELESS_CHANGE: f64 = 20.0;

/// Measured torque over force times lever outside of one over this and this.
const LARGEST_TORQUE_RATIO: f64 = 10.0;

/// Natural times between two samples at most: an object tips over within one.
const RAREST_SAMPLES: f64 = 2.0;

/// Something in a log that does not go with the scene, most likely a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Implausibility {
    /// Contact distances against radii of gyration.
    Spread {
        /// Median over the log of the largest distance between two contacts, in the log's unit.
        spread: f64,
        /// Largest radius of gyration of the scene, m.
        gyration: f64,
    },
    /// Contact distances against radii of curvature.
    Curvature {
        /// Median over the log of the largest distance between two contacts, in the log's unit.
        spread: f64,
        /// Largest radius of curvature of the scene, m.
        radius: f64,
    },
    /// Contact forces against weight.
    Weight {
        /// Mean vertical contact force, N.
        force: f64,
        /// Weight, N.
        weight: f64,
    },
    /// What forces and weight together do to the velocity.
    Drift {
        /// Change of the velocity over the whole log, m/s.
        change: f64,
        /// Natural speed `sqrt(r g)` of an object whose contacts are `2 r` apart, m/s.
        natural: f64,
    },
    /// Torques against forces and contact positions.
    Torque {
        /// Palm from 1.
        palm: usize,
        /// Median of torque over force times lever.
        ratio: f64,
    },
    /// Time between samples against the time in which an object of that size falls over.
    Interval {
        /// Median time between two samples, in the log's unit.
        interval: f64,
        /// Natural time `sqrt(r / g)` of an object whose contacts are `2 r` apart, s.
        natural: f64,
    },
}

impl Implausibility {
    /// Whether no motion is worth looking for.
    #[must_use]
    pub fn is_hopeless(&self) -> bool {
        matches!(self, Self::Drift { change, natural } if *change > HOPELESS_CHANGE * natural)
    }
}

impl fmt::Display for Implausibility {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::Spread { spread, gyration } => write!(
                f,
                "the contacts of the log are {spread:.3} apart, but the scene's largest radius of gyration is {gyration:.3} m, \
                 a factor of {:.0}{}",
                factor(spread / gyration),
                unit(spread / gyration / 2.0)
            ),
            Self::Curvature { spread, radius } => write!(
                f,
                "the contacts of the log are {spread:.3} apart, but an object with radii of curvature up to {radius:.3} m \
                 fits into a ball {:.3} m across, a factor of {:.0}{}",
                2.0 * radius,
                factor(spread / (2.0 * radius)),
                unit(spread / (2.0 * radius))
            ),
            Self::Weight { force, weight } => write!(
                f,
                "the palms carry {force:.3} N on average, but the scene's object weighs {weight:.3} N, a factor of {:.0}; \
                 check the units of force, mass and gravity",
                factor(force / weight)
            ),
            Self::Drift { change, natural } => write!(
                f,
                "the forces of the palms and the weight together would change the object's velocity by {} m/s over the log, {} times what it has where it stays between the palms; do \
                 all normals point into the palm's front, towards the object, and does each force stand in its own palm's column?",
                brief_to(2, change),
                brief_to(2, change / natural)
            ),
            Self::Torque { palm, ratio } => write!(
                f,
                "tau_{palm} is {ratio:.3} times f_{palm} s2_{palm}; check the units of torque and contact position"
            ),
            Self::Interval { interval, natural } => write!(
                f,
                "the samples of the log are {} s apart, and between two of them an object of its size falls over {:.0} times (natural time {} s){}",
                brief(interval),
                interval / natural,
                brief_to(2, natural),
                unit_of_time(interval, natural)
            ),
        }
    }
}

fn factor(ratio: f64) -> f64 {
    if ratio < 1.0 { 1.0 / ratio } else { ratio }
}

/// The unit that a ratio of lengths points to.
fn unit(ratio: f64) -> &'static str {
    match ratio.log10() {
        x if (1.5..2.5).contains(&x) => "; are its lengths in centimetres? (the format wants metres)",
        x if (2.5..3.7).contains(&x) => "; are its lengths in millimetres? (the format wants metres)",
        x if (-3.7..-2.5).contains(&x) => {
            "; are the scene's lengths in millimetres? (the format wants metres)"
        }
        _ => "; check the units of the log and of the scene",
    }
}

/// The unit of time that makes a usual rate of it, no more than two natural times between samples.
fn unit_of_time(interval: f64, natural: f64) -> String {
    let units = [(1e-3, "milliseconds"), (1e-6, "microseconds"), (1e-9, "nanoseconds")];
    let usual = |scale: f64| interval * scale < RAREST_SAMPLES * natural && interval * scale > 9e-5;
    units.into_iter().find(|(scale, _)| usual(*scale)).map_or_else(String::new, |(scale, name)| {
        let rate = brief_to(3, 1.0 / (interval * scale));
        format!("; is its time in {name}? Then it has {rate} samples a second (the format wants seconds)")
    })
}

/// What in `log` does not go with `scene`. Empty where they agree, or where the scene does not know enough to tell.
#[must_use]
pub fn implausibilities(log: &SensorLog, scene: &Scene) -> Vec<Implausibility> {
    let spread = median(log.samples().iter().filter_map(spread).collect());
    let times: Vec<f64> = log.samples().iter().map(|sample| sample.t).collect();
    let mut found: Vec<_> = [
        spread.and_then(|s| rare_samples(&times, s, scene)),
        spread.and_then(|s| against_gyration(s, scene)),
        spread.and_then(|s| against_curvature(s, scene)),
        against_weight(log, scene),
        spread.and_then(|s| against_drift(log, s, scene)),
    ]
    .into_iter()
    .flatten()
    .collect();
    found.extend((0..3).filter_map(|i| torque_against_force(log, i)));
    found
}

/// The same of contacts of any palms, as far as they tell it alike.
#[must_use]
pub fn implausible_contacts(log: &ContactLog, scene: &Scene) -> Vec<Implausibility> {
    let at = |k: usize| -> Vec<DVec3> {
        log.palms().iter().filter_map(|palm| Some(palm.touch(k)?.p_WC)).collect()
    };
    let spread = median((0..log.times().len()).filter_map(|k| apart(&at(k))).collect());
    spread.and_then(|s| rare_samples(log.times(), s, scene)).into_iter().collect()
}

fn rare_samples(times: &[f64], spread: f64, scene: &Scene) -> Option<Implausibility> {
    let natural = (spread / 2.0 / scene.gravity).sqrt();
    let interval = median(times.windows(2).map(|pair| pair[1] - pair[0]).collect())?;
    let rare = natural > 0.0 && interval > RAREST_SAMPLES * natural;
    rare.then_some(Implausibility::Interval { interval, natural })
}

/// Largest distance between two of the three contacts of a sample.
fn spread(sample: &Sample) -> Option<f64> {
    let mut contacts = [DVec3::ZERO; 3];
    for (contact, palm) in contacts.iter_mut().zip(&sample.palms) {
        *contact = PalmFrame::from_normal(palm.normal).ok()?.contact_from_sensor(palm.contact?);
    }
    apart(&contacts)
}

/// Largest distance between two of some points; None where there are no two.
fn apart(points: &[DVec3]) -> Option<f64> {
    let pairs = points.iter().enumerate().flat_map(|(i, a)| points[..i].iter().map(|b| a.distance(*b)));
    pairs.reduce(f64::max)
}

fn against_gyration(spread: f64, scene: &Scene) -> Option<Implausibility> {
    // Radii of gyration need no mass; moments do.
    let mass = scene
        .mass
        .or_else(|| matches!(scene.inertia, Some(crate::KnownInertia::RadiiOfGyration(_))).then_some(1.0))?;
    let properties = scene.inertia?.with_mass(mass).ok()?;
    let gyration = (properties.principal().moments.z / mass).sqrt();
    let ratio = spread / gyration;
    (!(1.0 / LARGEST_SPREAD..=LARGEST_SPREAD).contains(&ratio))
        .then_some(Implausibility::Spread { spread, gyration })
}

fn against_curvature(spread: f64, scene: &Scene) -> Option<Implausibility> {
    let radius = scene.curvature?.max;
    (spread > 2.0 * radius * CURVATURE_SLACK).then_some(Implausibility::Curvature { spread, radius })
}

fn against_weight(log: &SensorLog, scene: &Scene) -> Option<Implausibility> {
    let weight = scene.mass? * scene.gravity;
    let vertical =
        |s: &Sample| -> Option<f64> { s.palms.iter().map(|p| p.force.map(|f| f * p.normal.get().z)).sum() };
    let carried: Vec<f64> = log.samples().iter().filter_map(vertical).collect();
    if carried.is_empty() || weight <= 0.0 {
        return None;
    }
    let force = carried.iter().sum::<f64>() / carried.len() as f64;
    let ratio = force / weight;
    (!(1.0 / LARGEST_FORCE_RATIO..=LARGEST_FORCE_RATIO).contains(&ratio))
        .then_some(Implausibility::Weight { force, weight })
}

/// Of palms without friction, all forces of which are sensed. Nothing is told of a body that is not known and that they do not hold up.
fn against_drift(log: &SensorLog, spread: f64, scene: &Scene) -> Option<Implausibility> {
    if scene.friction.is_some_and(|friction| friction > 0.0) {
        return None;
    }
    let all = |s: &Sample| -> Option<DVec3> { s.palms.iter().map(|p| Some(p.normal.get() * p.force?)).sum() };
    let forces: Vec<DVec3> = log.samples().iter().map(all).collect::<Option<_>>()?;
    let mean = forces.iter().sum::<DVec3>() / forces.len() as f64;
    let [first, .., last] = log.samples() else { return None };
    let mass = scene.mass.unwrap_or(mean.z / scene.gravity);
    let left = mean - DVec3::Z * (mass * scene.gravity);
    let (change, natural) =
        ((left * (last.t - first.t) / mass).length(), (0.5 * spread * scene.gravity).sqrt());
    let odd = mass > 0.0 && natural > 0.0 && change > LARGEST_CHANGE * natural;
    odd.then_some(Implausibility::Drift { change, natural })
}

fn torque_against_force(log: &SensorLog, i: usize) -> Option<Implausibility> {
    let ratio = |s: &Sample| -> Option<f64> {
        let palm = &s.palms[i];
        let expected = palm.force? * palm.contact?[1];
        (expected != 0.0).then_some((palm.torque? / expected).abs())
    };
    let ratio = median(log.samples().iter().filter_map(ratio).collect())?;
    (!(1.0 / LARGEST_TORQUE_RATIO..=LARGEST_TORQUE_RATIO).contains(&ratio))
        .then_some(Implausibility::Torque { palm: i + 1, ratio })
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let (_, median, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    Some(*median)
}

#[cfg(test)]
mod tests {
    use super::*;
    use recon::contact_kinematics::Direction;
    use recon::object_dynamics::PalmReading;

    /// A body of 1 kg at rest on three palms with slope 60 degrees, contacts 2 m up each palm, lengths times `unit`.
    fn at_rest(unit: f64, force_unit: f64) -> SensorLog {
        let slope = 60.0_f64.to_radians();
        let palm = |i: u32| {
            let n = PalmFrame::from_azimuth_slope(f64::from(i) * std::f64::consts::TAU / 3.0, slope).n;
            let force = 9.81 / 3.0 / slope.cos() * force_unit;
            PalmReading {
                normal: Direction::new(n).unwrap(),
                contact: Some([0.0, 2.0 * unit]),
                force: Some(force),
                torque: Some(force * 2.0),
                rate: None,
            }
        };
        let sample = |t| Sample { t, palms: [palm(0), palm(1), palm(2)] };
        SensorLog::new(vec![sample(0.0), sample(0.1)], None).unwrap()
    }

    fn scene(text: &str) -> Scene {
        Scene::parse(&format!("gravity = 9.81\n[object]\n{text}")).unwrap()
    }

    #[test]
    fn a_log_in_metres_is_plausible() {
        let known = scene("mass = 1.0\nprincipal_moments = [0.3, 0.4, 0.5]\ncurvature_radii = [0.2, 3.0]");
        assert_eq!(implausibilities(&at_rest(1.0, 1.0), &known), []);
        assert_eq!(implausibilities(&at_rest(1.0, 1.0), &scene("")), []);
    }

    #[test]
    fn millimetres_are_named() {
        let log = at_rest(1000.0, 1.0);
        for known in
            ["mass = 1.0\nprincipal_moments = [0.3, 0.4, 0.5]", "radii_of_gyration = [0.5, 0.6, 0.7]"]
        {
            let found = implausibilities(&log, &scene(known));
            assert!(matches!(found[0], Implausibility::Spread { .. }), "{found:?}");
            assert!(found[0].to_string().contains("millimetres"), "{}", found[0]);
            // Torques in N m with contacts in mm.
            assert_eq!(found.iter().filter(|w| matches!(w, Implausibility::Torque { .. })).count(), 3);
        }
        let found = implausibilities(&log, &scene("curvature_radii = [0.2, 1.0]"));
        assert!(
            found[0].to_string().contains("factor of 866; are its lengths in millimetres"),
            "{}",
            found[0]
        );
    }

    #[test]
    fn a_palm_whose_normal_points_the_other_way_is_told() {
        let known = scene("mass = 1.0");
        let log = |flipped: bool| {
            let mut one = at_rest(0.02, 1.0).samples()[0];
            let n = one.palms[1].normal;
            one.palms[1].normal = if flipped { -n } else { n };
            let sample = |k: u32| Sample { t: f64::from(k) * 0.01, ..one };
            SensorLog::new((0..200).map(sample).collect(), None).unwrap()
        };
        let drift = |log: &SensorLog| {
            implausibilities(log, &known).into_iter().find(|odd| matches!(odd, Implausibility::Drift { .. }))
        };
        assert_eq!(drift(&log(false)), None);
        let told = drift(&log(true)).unwrap();
        assert!(told.is_hopeless() && told.to_string().contains("normals"), "{told}");
    }

    #[test]
    fn forces_in_another_unit_are_named() {
        let found = implausibilities(&at_rest(1.0, 0.001), &scene("mass = 1.0"));
        assert!(matches!(found[..], [Implausibility::Weight { .. }]), "{found:?}");
    }

    /// The samples of a log of a body of 5 cm in another unit of time; usual rates are as they should be.
    #[test]
    fn a_time_in_milliseconds_is_told() {
        let known = scene("mass = 1.0");
        let log = |interval: f64| {
            let mut at_rest = at_rest(0.02, 1.0).samples()[0];
            at_rest.palms.iter_mut().for_each(|palm| palm.torque = None);
            let sample = |k: u32| Sample { t: f64::from(k) * interval, ..at_rest };
            SensorLog::new((0..50).map(sample).collect(), None).unwrap()
        };
        for rate in [60.0, 100.0, 1000.0] {
            assert_eq!(implausibilities(&log(1.0 / rate), &known), []);
            for (scale, name) in [(1e3, "milliseconds"), (1e6, "microseconds")] {
                let odd = implausibilities(&log(scale / rate), &known);
                let said = odd[0].to_string();
                assert!(odd.len() == 1 && said.contains(name), "{rate} {said}");
                assert!(said.contains(&format!("{rate} samples a second")), "{rate} {said}");
            }
        }
        let odd = implausibilities(&log(0.5), &known);
        assert!(odd.len() == 1 && odd[0].to_string().contains("0.5 s apart"), "{odd:?}");
    }
}
