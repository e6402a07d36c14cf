//! From what stands in a file to a checked scene. Every error names the key.

use super::file::{KindName, ObjectTable, PalmTable, PlanarFile, PoseTable, ShapeTable, SimulationTable};
use super::{PlanarBody, PlanarKnown, PlanarScene};
use crate::scene::SceneErrorKind as Kind;
use crate::scene::build::{sample_times, sensors};
use crate::scene::palms::law;
use crate::scene::possible;
use glam::DVec2;
use recon::contact_kinematics::planar::{
    Circle, Ellipse, FourierBody, MotionPart, PalmSurface, RoundedPolygon, SurfaceMotion, SurfacePose,
};
use recon::object_dynamics::planar::{BodyState, ContactScene, PlanarMass, PlanarObject, ScenePalm};

pub(super) fn scene(file: PlanarFile) -> Result<PlanarScene, Kind> {
    let PlanarKnown { gravity, mass, sensors, .. } = known(&file)?;
    let table = file.simulation.as_ref().ok_or(Kind::Missing {
        what: "`[simulation]`",
        mend: "a simulation needs the shape of the object, its start, duration and sample_rate",
    })?;
    let missing =
        Kind::Missing { what: "`[object]`", mend: "a simulation needs the object's mass and inertia" };
    let object = PlanarObject { shape: body(&table.shape)?, mass: mass.ok_or(missing)?, gravity };
    let friction = palms_friction(&file)?;
    let palm = |(i, table): (usize, &PalmTable)| palm(i + 1, table, friction);
    let palms = file.palm.iter().enumerate().map(palm).collect::<Result<Vec<_>, _>>()?;
    let count = palms.len();
    let world = ContactScene::new(object, palms).map_err(Kind::PlanarContacts)?;
    let times = sample_times(table.duration, table.sample_rate, &sensors)?;
    Ok(PlanarScene {
        world,
        sensors,
        start: start(table)?,
        touches: touches(&table.touches, count)?,
        times,
        seed: table.seed,
    })
}

/// What an estimate may know.
pub(super) fn known(file: &PlanarFile) -> Result<PlanarKnown, Kind> {
    if !file.plane {
        return Err(Kind::Missing { what: "`plane = true`", mend: "give it in a scene of the plane" });
    }
    let (common, object) = (palms_friction(file)?, file.object.as_ref());
    let palm = |(i, table): (usize, &PalmTable)| {
        Ok((surface(i + 1, table)?, own_friction(i + 1, table)?.or(common)))
    };
    Ok(PlanarKnown {
        gravity: possible::gravity(file.gravity)?,
        mass: object.map(mass).transpose()?.flatten(),
        size: object
            .and_then(|table| table.size)
            .map(|size| Kind::positive("object.size", size))
            .transpose()?,
        palms: file.palm.iter().enumerate().map(palm).collect::<Result<_, Kind>>()?,
        sensors: sensors(&file.sensors)?,
    })
}

fn palms_friction(file: &PlanarFile) -> Result<Option<f64>, Kind> {
    file.palms.friction.map(|f| Kind::not_negative("palms.friction", f)).transpose()
}

fn own_friction(number: usize, table: &PalmTable) -> Result<Option<f64>, Kind> {
    let key = format!("palm[{number}].friction");
    table.friction.map(|f| Kind::not_negative(&key, f)).transpose()
}

/// Mass and moment of inertia; none where neither is stated.
fn mass(table: &ObjectTable) -> Result<Option<PlanarMass>, Kind> {
    let Some(mass) = table.mass.map(possible::mass).transpose()? else {
        let alone = table.inertia.or(table.radius_of_gyration).is_some();
        let missing = Kind::Missing { what: "`object.mass`", mend: "give it in kg, beside the inertia" };
        return if alone { Err(missing) } else { Ok(None) };
    };
    let inertia = match (table.inertia, table.radius_of_gyration) {
        (Some(inertia), None) => Kind::positive("object.inertia", inertia)?,
        (None, Some(radius)) => mass * Kind::positive("object.radius_of_gyration", radius)?.powi(2),
        (None, None) => {
            return Err(Kind::Missing {
                what: "`object.inertia`",
                mend: "give it in kg m^2, or `object.radius_of_gyration` in m",
            });
        }
        (Some(_), Some(_)) => {
            let keys = ["`object.inertia`", "`object.radius_of_gyration`"].map(str::to_owned).to_vec();
            return Err(Kind::Ambiguous { keys });
        }
    };
    Ok(Some(PlanarMass::new(mass, inertia)?))
}

fn body(table: &ShapeTable) -> Result<PlanarBody, Kind> {
    Ok(match table {
        ShapeTable::Circle { radius, centre } => {
            PlanarBody::Circle(Circle::new(*radius, (*centre).into()).map_err(Kind::Outline)?)
        }
        ShapeTable::Ellipse { semi_axes: [a, b], centre } => {
            PlanarBody::Ellipse(Ellipse::new(*a, *b, (*centre).into()).map_err(Kind::Outline)?)
        }
        ShapeTable::Fourier { cosines, sines } => {
            PlanarBody::Fourier(FourierBody::new(cosines, sines).map_err(Kind::Outline)?)
        }
        ShapeTable::Polygon { corners, corner_radius, edge_half_angle } => {
            let corners: Vec<DVec2> = corners.iter().map(|corner| (*corner).into()).collect();
            let body = RoundedPolygon::new(&corners, *corner_radius, *edge_half_angle);
            PlanarBody::Polygon(body.map_err(Kind::Outline)?)
        }
    })
}

fn palm(number: usize, table: &PalmTable, friction: Option<f64>) -> Result<ScenePalm, Kind> {
    let key = |name: &str| format!("palm[{number}].{name}");
    let missing = |key| Kind::MissingOfPalm { palm: number, key };
    let placed = table.pose.as_ref().ok_or(missing("pose"))?;
    let motion = SurfaceMotion { pose: pose(&key("pose"), placed)?, parts: parts(number, table)? };
    let friction = own_friction(number, table)?.or(friction).ok_or(missing("friction"))?;
    Ok(ScenePalm { surface: surface(number, table)?, motion, friction })
}

fn surface(number: usize, table: &PalmTable) -> Result<PalmSurface, Kind> {
    let key = format!("palm[{number}].radius");
    let radius = || {
        let radius = table.radius.ok_or(Kind::MissingOfPalm { palm: number, key: "radius" })?;
        Kind::positive(&key, radius)
    };
    Ok(match (table.kind, table.radius) {
        (KindName::Line, None) => PalmSurface::Line,
        (KindName::Line, Some(value)) => {
            return Err(Kind::Value { key, value, must: "left out: a line has none" });
        }
        (KindName::Arc, _) => PalmSurface::Arc { radius: radius()? },
        (KindName::Cup, _) => PalmSurface::Cup { radius: radius()? },
    })
}

fn pose(key: &str, table: &PoseTable) -> Result<SurfacePose, Kind> {
    let p_WP = vector(&format!("{key}.position"), table.position)?;
    Ok(SurfacePose { p_WP, angle: angle(key, table.angle, table.angle_deg)? })
}

fn parts(number: usize, table: &PalmTable) -> Result<Vec<MotionPart>, Kind> {
    let part = |(i, part): (usize, &super::file::PartTable)| {
        let key = |name: &str| format!("palm[{number}].motion[{}].{name}", i + 1);
        let law = law(&part.law);
        match (part.shift, part.pivot) {
            (Some(shift), None) => {
                let shift = vector(&key("shift"), shift)?;
                Kind::positive(&key("shift (its length)"), shift.length())?;
                Ok(MotionPart::Shift { direction: shift.to_angle(), law })
            }
            (None, Some(pivot)) => Ok(MotionPart::Turn { pivot: vector(&key("pivot"), pivot)?, law }),
            (Some(_), Some(_)) => {
                let keys = ["shift", "pivot"].map(|name| format!("`{}`", key(name))).to_vec();
                Err(Kind::Ambiguous { keys })
            }
            (None, None) => {
                Err(Kind::MissingOfPalm { palm: number, key: "motion with `shift` or `pivot` in each part" })
            }
        }
    };
    table.motion.iter().enumerate().map(part).collect()
}

fn start(table: &SimulationTable) -> Result<BodyState, Kind> {
    Ok(BodyState {
        p_WCm: vector("simulation.position", table.position)?,
        phi0: angle("simulation", table.angle, table.angle_deg)?,
        v_WCm: vector("simulation.velocity", table.velocity)?,
        omega0: Kind::finite("simulation.angular_velocity", table.angular_velocity)?,
    })
}

/// Palms from 0.
fn touches(numbers: &[usize], count: usize) -> Result<Vec<usize>, Kind> {
    let index = |(i, &number): (usize, &usize)| match (1..=count).contains(&number) {
        true if !numbers[..i].contains(&number) => Ok(number - 1),
        _ => Err(Kind::Value {
            key: format!("simulation.touches[{i}]"),
            value: number as f64,
            must: "the number of a [[palm]], from 1, each once",
        }),
    };
    numbers.iter().enumerate().map(index).collect()
}

/// In rad; zero where neither is given.
fn angle(key: &str, radians: Option<f64>, degrees: Option<f64>) -> Result<f64, Kind> {
    match (radians, degrees) {
        (None, None) => Ok(0.0),
        (Some(radians), None) => Kind::finite(&format!("{key}.angle"), radians),
        (None, Some(degrees)) => Kind::finite(&format!("{key}.angle_deg"), degrees).map(f64::to_radians),
        (Some(_), Some(_)) => {
            let keys = ["angle", "angle_deg"].map(|name| format!("`{key}.{name}`")).to_vec();
            Err(Kind::Ambiguous { keys })
        }
    }
}

fn vector(key: &str, [x, y]: [f64; 2]) -> Result<DVec2, Kind> {
    Ok(DVec2::new(Kind::finite(&format!("{key}[0]"), x)?, Kind::finite(&format!("{key}[1]"), y)?))
}
