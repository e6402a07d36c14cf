use super::file::{ObjectTable, PalmTable, PalmsTable, SceneFile, SensorsTable, ShapeTable, SimulationTable};
use super::palms::palms as any_palms;
use super::possible;
use super::{KnownInertia, KnownPalm, Scene, SceneErrorKind as Kind, Sensors, Shape, Simulation};
use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{CurvatureRadii, MotionLaw, Palm, PalmTriple};
use recon::object_dynamics::SampleTimes;
use std::path::Path;

/// Largest departure of the initial quaternion's length from 1.
const UNIT_TOLERANCE: f64 = 1e-6;

/// Most samples that a simulation may be asked for: a quarter of an hour at 1 kHz. Each takes about 2 kB of memory
/// while it is simulated, so this is the most that a small machine holds.
const MOST_SAMPLES: f64 = 1e6;

/// Checks every number and says each thing in one way. Files that a scene in `folder` names are beside it.
pub(super) fn scene(file: SceneFile, folder: &Path) -> Result<Scene, Kind> {
    let gravity = possible::gravity(file.gravity)?;
    let (mass, inertia) = mass_and_inertia(&file.object)?;
    let sensors = sensors(&file.sensors)?;
    let friction = file.palms.friction.map(|f| Kind::not_negative("palms.friction", f)).transpose()?;
    let palms = any_palms(file.palm, friction, folder)?;
    let simulation = file.simulation.map(|s| simulation(s, &sensors, palms.is_some())).transpose()?;
    let scene = Scene {
        gravity,
        mass,
        inertia,
        curvature: curvature(&file.object)?,
        size: file.object.size.map(|size| Kind::positive("object.size", size)).transpose()?,
        sensors,
        palm_inertia: palm_inertia(&file.palms)?.or_else(|| motor_inertia(palms.as_deref()?)),
        friction,
        palms,
        simulation,
    };
    possible::inertia_within_shape(&scene)?;
    Ok(scene)
}

fn mass_and_inertia(table: &ObjectTable) -> Result<(Option<f64>, Option<KnownInertia>), Kind> {
    // The tensor is given row by row, and is symmetric.
    let tensor = table.inertia.map(|rows| KnownInertia::Tensor(DMat3::from_cols_array_2d(&rows).transpose()));
    let moments = table.principal_moments.map(|m| KnownInertia::PrincipalMoments(m.into()));
    let radii = table.radii_of_gyration.map(|r| KnownInertia::RadiiOfGyration(r.into()));
    let given = [
        ("`object.inertia`", tensor),
        ("`object.principal_moments`", moments),
        ("`object.radii_of_gyration`", radii),
    ];
    let mut known = given.iter().filter(|(_, inertia)| inertia.is_some());
    let inertia = known.next().and_then(|(_, inertia)| *inertia);
    if known.next().is_some() {
        let keys = given.iter().filter(|(_, i)| i.is_some()).map(|(key, _)| (*key).to_owned()).collect();
        return Err(Kind::Ambiguous { keys });
    }
    let mass = table.mass.map(possible::mass).transpose()?;
    if let Some(inertia) = inertia {
        inertia.with_mass(mass.unwrap_or(1.0))?;
    }
    Ok((mass, inertia))
}

fn curvature(table: &ObjectTable) -> Result<Option<CurvatureRadii>, Kind> {
    let Some([min, max]) = table.curvature_radii else { return Ok(None) };
    let min = Kind::not_negative("object.curvature_radii[0]", min)?;
    let max = Kind::check("object.curvature_radii[1]", max, "at least object.curvature_radii[0]", |v| {
        v >= min && v > 0.0
    })?;
    Ok(Some(CurvatureRadii { min, max }))
}

pub(super) fn sensors(table: &SensorsTable) -> Result<Sensors, Kind> {
    let not_negative =
        |key, value: Option<f64>| value.map(|v| Kind::not_negative(&format!("sensors.{key}"), v)).transpose();
    Ok(Sensors {
        contact_std: not_negative("contact_std", table.contact_std)?,
        force_std: not_negative("force_std", table.force_std)?,
        force_share: not_negative("force_share", table.force_share)?,
        impulse_std: not_negative("impulse_std", table.impulse_std)?,
        impulse_share: not_negative("impulse_share", table.impulse_share)?,
        torque_std: not_negative("torque_std", table.torque_std)?,
        contact_off_palm: not_negative("contact_off_palm", table.contact_off_palm)?,
        contact_speed_std: table
            .contact_speed_std
            .map(|v| Kind::positive("sensors.contact_speed_std", v))
            .transpose()?,
        sample_rate: table.sample_rate.map(|v| Kind::positive("sensors.sample_rate", v)).transpose()?,
    })
}

fn palm_inertia(table: &PalmsTable) -> Result<Option<[f64; 3]>, Kind> {
    let Some(inertia) = table.inertia else { return Ok(None) };
    for (i, value) in inertia.iter().enumerate() {
        Kind::not_negative(&format!("palms.inertia[{i}]"), *value)?;
    }
    Ok(Some(inertia))
}

/// How long a simulation lasts and when it is sampled: at its own rate, that of the sensors, or 1 kHz.
pub(super) fn sample_times(duration: f64, rate: Option<f64>, sensors: &Sensors) -> Result<SampleTimes, Kind> {
    let duration = Kind::positive("simulation.duration", duration)?;
    let rate = match rate {
        Some(rate) => Kind::positive("simulation.sample_rate", rate)?,
        None => sensors.sample_rate.unwrap_or(1000.0),
    };
    Kind::check("simulation.duration", duration, "at least one sample and at most 1e6 samples long", |d| {
        (1.0..=MOST_SAMPLES).contains(&(d * rate))
    })?;
    Ok(SampleTimes { duration, rate })
}

/// Of three palms that motors turn.
fn motor_inertia(palms: &[KnownPalm]) -> Option<[f64; 3]> {
    let inertia = |palm: &KnownPalm| Some(palm.hinge()?.inertia);
    let [a, b, c] = palms else { return None };
    Some([inertia(a)?, inertia(b)?, inertia(c)?])
}

fn simulation(table: SimulationTable, sensors: &Sensors, any_palms: bool) -> Result<Simulation, Kind> {
    let palms = three_palms(&table, any_palms)?;
    let SampleTimes { duration, rate: sample_rate } =
        sample_times(table.duration, table.sample_rate, sensors)?;
    let [w, x, y, z] = table.orientation;
    let orientation = DQuat::from_xyzw(x, y, z, w);
    let must = "the length 1 of a unit quaternion, w first";
    Kind::check("simulation.orientation (its length)", orientation.length(), must, |l| {
        (l - 1.0).abs() <= UNIT_TOLERANCE
    })?;
    let (shape, offset) = shape(table.shape)?;
    let simulation = Simulation {
        shape,
        offset,
        palms,
        p_WCm: table.position.map(|p| vector("simulation.position", p, Kind::finite)).transpose()?,
        R_WO: orientation.normalize(),
        v_WCm: vector("simulation.velocity", table.velocity.unwrap_or_default(), Kind::finite)?,
        w_WO: vector("simulation.angular_velocity", table.angular_velocity, Kind::finite)?,
        in_flight: table.in_flight.unwrap_or_default(),
        duration,
        sample_rate,
        seed: table.seed,
    };
    possible::start(&simulation)?;
    Ok(simulation)
}

fn vector(key: &str, values: [f64; 3], check: fn(&str, f64) -> Result<f64, Kind>) -> Result<DVec3, Kind> {
    for (i, value) in values.iter().enumerate() {
        check(&format!("{key}[{i}]"), *value)?;
    }
    Ok(values.into())
}

fn shape(table: ShapeTable) -> Result<(Shape, DVec3), Kind> {
    let axes = |values| vector("simulation.shape.semi_axes", values, Kind::positive);
    let (shape, offset) = match table {
        ShapeTable::Sphere { radius, offset } => {
            (Shape::Sphere { radius: Kind::positive("simulation.shape.radius", radius)? }, offset)
        }
        ShapeTable::Ellipsoid { semi_axes, offset } => {
            (Shape::Ellipsoid { semi_axes: axes(semi_axes)? }, offset)
        }
        ShapeTable::EllipsoidPlusBall { semi_axes, radius, offset } => {
            let radius = Kind::not_negative("simulation.shape.radius", radius)?;
            (Shape::EllipsoidPlusBall { semi_axes: axes(semi_axes)?, radius }, offset)
        }
        ShapeTable::Polytope { corners, radius, sharpness, offset } => {
            let corner = |(i, at): (usize, [f64; 3])| {
                vector(&format!("simulation.shape.corners[{i}]"), at, Kind::finite)
            };
            let corners = corners.into_iter().enumerate().map(corner).collect::<Result<_, _>>()?;
            let radius = Kind::positive("simulation.shape.radius", radius)?;
            let sharpness = Kind::positive("simulation.shape.sharpness", sharpness)?;
            (Shape::Polytope { corners, radius, sharpness }, offset)
        }
        ShapeTable::Polynomial { terms, offset } => {
            for (i, term) in terms.iter().enumerate() {
                Kind::finite(&format!("simulation.shape.terms[{i}].coefficient"), term.coefficient)?;
            }
            (Shape::Polynomial { terms: terms.iter().map(|t| (t.coefficient, t.powers)).collect() }, offset)
        }
    };
    Ok((shape, vector("simulation.shape.offset", offset, Kind::finite)?))
}

/// The three palms through the origin, which are the palms where there is no `[[palm]]`.
fn three_palms(table: &SimulationTable, any_palms: bool) -> Result<Option<[Palm; 3]>, Kind> {
    if any_palms {
        return match table.palms {
            Some(_) => {
                Err(Kind::Ambiguous { keys: vec!["[[palm]]".to_owned(), "`simulation.palms`".to_owned()] })
            }
            None => Ok(None),
        };
    }
    let general = [
        ("simulation.position", table.position.is_some()),
        ("simulation.velocity", table.velocity.is_some()),
        ("simulation.in_flight", table.in_flight.is_some()),
    ];
    if let Some((key, _)) = general.into_iter().find(|(_, given)| *given) {
        return Err(Kind::OtherPalms { key, only: "[[palm]]; palms through the origin determine it" });
    }
    let tables = table.palms.as_ref().ok_or(Kind::Missing {
        what: "any palm",
        mend: "give three in `simulation.palms`, or a [[palm]] for each",
    })?;
    palms(tables).map(Some)
}

fn palms(tables: &[PalmTable]) -> Result<[Palm; 3], Kind> {
    let [a, b, c] = tables else { return Err(Kind::PalmCount { found: tables.len() }) };
    let palms = [palm(1, a)?, palm(2, b)?, palm(3, c)?];
    PalmTriple::new(palms.map(|p| p.at(0.0).frame.n)).map_err(Kind::Palms)?;
    Ok(palms)
}

fn palm(number: usize, table: &PalmTable) -> Result<Palm, Kind> {
    let azimuth = angle(number, ["azimuth", "azimuth_deg"], [table.azimuth, table.azimuth_deg])?;
    let slope = angle(number, ["slope", "slope_deg"], [table.slope, table.slope_deg])?;
    let motion = match (table.rate, &table.sinusoid) {
        (None, None) => MotionLaw::Constant { value: slope },
        (Some(rate), None) => MotionLaw::Steady { start: slope, rate },
        (None, Some(s)) => MotionLaw::Sinusoid {
            mean: slope,
            amplitude: s.amplitude,
            frequency: s.frequency,
            phase: s.phase,
        },
        (Some(_), Some(_)) => {
            let keys = ["rate", "sinusoid"].map(|k| format!("`simulation.palms.{k}`")).to_vec();
            return Err(Kind::Ambiguous { keys });
        }
    };
    let palm = Palm::new(azimuth, motion).map_err(|source| Kind::Palm { palm: number, source })?;
    let n = recon::contact_kinematics::Direction::new(palm.at(0.0).frame.n)
        .map_err(|e| Kind::Palm { palm: number, source: e.into() })?;
    recon::contact_kinematics::PalmFrame::from_normal(n)
        .map_err(|source| Kind::Palm { palm: number, source })?;
    Ok(palm)
}

/// An angle given in rad or in degrees, in rad.
fn angle(palm: usize, keys: [&'static str; 2], values: [Option<f64>; 2]) -> Result<f64, Kind> {
    match values {
        [Some(radians), None] => Kind::finite(&format!("simulation.palms[{palm}].{}", keys[0]), radians),
        [None, Some(degrees)] => {
            Kind::finite(&format!("simulation.palms[{palm}].{}", keys[1]), degrees).map(f64::to_radians)
        }
        [Some(_), Some(_)] => {
            Err(Kind::Ambiguous { keys: keys.map(|k| format!("`simulation.palms.{k}`")).to_vec() })
        }
        [None, None] => Err(Kind::Missing {
            what: if keys[0] == "azimuth" { "azimuth of a palm" } else { "slope of a palm" },
            mend: "every entry of `simulation.palms` needs `azimuth` and `slope` in rad, or `azimuth_deg` and `slope_deg`",
        }),
    }
}
