//! A reference log as its file has it, and the scene that it is of.

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, PalmSurface, PoseTable, SurfaceMotion, SurfacePose};
use recon::object_dynamics::{
    BodyState, ContactLog, ContactMode, ContactPoints, ContactScene, ForceChannel, MOST_PALMS,
    MassProperties, MeasuredMotion, PalmCoordinates, PalmDrive, PalmRecord, PalmSpring, RecordedMotion,
    ScenePalm,
};
use serde_json::Value;
use std::collections::HashMap;
use std::error::Error;
use std::path::Path;
use std::process::Command;

pub(crate) type Anything<T> = Result<T, Box<dyn Error>>;

/// Slip of a contact that sticks, m/s: what the log's contacts creep by. The log itself says so from 3e-4 on.
const STICKS: f64 = 2e-5;

/// A contact that takes a mode: 0 off, 1 slides, 2 sticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Change {
    pub(crate) t: f64,
    pub(crate) palm: usize,
    pub(crate) mode: u8,
}

/// The columns of one contact.
pub(super) struct Contact<'a> {
    pub(super) p: Vec<DVec3>,
    pub(super) f: Vec<DVec3>,
    pub(super) n: Vec<DVec3>,
    /// Velocity of the palm's material there.
    pub(super) v: Vec<DVec3>,
    pub(super) mode: &'a [f64],
    pub(super) slip: &'a [f64],
    pub(super) gap: &'a [f64],
    pub(super) friction: f64,
}

/// Columns by name, and the scene's description.
pub(crate) struct Log {
    columns: HashMap<String, Vec<f64>>,
    about: Value,
}

impl Log {
    /// Reads `NAME.csv.gz` and `NAME.json`.
    pub(crate) fn read(folder: &Path, name: &str) -> Anything<Self> {
        let packed = folder.join(format!("{name}.csv.gz"));
        let output = Command::new("gzip").arg("-dc").arg(&packed).output()?;
        if !output.status.success() {
            return Err(format!("{}: {}", packed.display(), String::from_utf8_lossy(&output.stderr)).into());
        }
        let text = String::from_utf8(output.stdout)?;
        let mut lines = text.lines();
        let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
        let mut values = vec![Vec::new(); names.len()];
        for line in lines {
            for (column, text) in values.iter_mut().zip(line.split(',')) {
                column.push(text.parse()?);
            }
        }
        let columns = names.into_iter().map(str::to_owned).zip(values).collect();
        let about = serde_json::from_str(&std::fs::read_to_string(folder.join(format!("{name}.json")))?)?;
        Ok(Self { columns, about })
    }

    /// The same log from sample `k` on, its time counted from there.
    pub(super) fn from(&self, k: usize) -> Self {
        let mut columns = self.columns.clone();
        for (name, column) in &mut columns {
            let start = if name == "t" { column[k] } else { 0.0 };
            *column = column[k..].iter().map(|x| x - start).collect();
        }
        Self { columns, about: self.about.clone() }
    }

    pub(crate) fn column(&self, name: &str) -> Anything<&[f64]> {
        self.columns.get(name).map(Vec::as_slice).ok_or_else(|| format!("no column {name}").into())
    }

    /// The vector `STEMx TAIL`, `STEMy TAIL`, `STEMz TAIL` at every sample.
    pub(crate) fn vectors(&self, stem: &str, tail: &str) -> Anything<Vec<DVec3>> {
        let part = |axis: &str| self.column(&format!("{stem}{axis}{tail}"));
        let (x, y, z) = (part("x")?, part("y")?, part("z")?);
        Ok((0..x.len()).map(|k| DVec3::new(x[k], y[k], z[k])).collect())
    }

    pub(crate) fn quaternions(&self, stem: &str, tail: &str) -> Anything<Vec<DQuat>> {
        let (v, w) = (self.vectors(stem, tail)?, self.column(&format!("{stem}w{tail}"))?);
        Ok(v.iter().zip(w).map(|(v, w)| DQuat::from_xyzw(v.x, v.y, v.z, *w)).collect())
    }

    /// Semi-axes of the body, m.
    pub(crate) fn semi_axes(&self) -> DVec3 {
        vector(&self.about["axes"])
    }

    /// Mass, kg, and inertia about the centre of mass in body axes.
    pub(crate) fn mass(&self) -> (f64, DMat3) {
        (number(&self.about["mass"]), matrix(&self.about["inertia"]))
    }

    pub(super) fn gravity(&self) -> f64 {
        number(&self.about["gravity"])
    }

    /// What sensors read over the first `seconds`, and the modes.
    pub(crate) fn contact_log(&self, seconds: f64) -> Anything<(ContactLog, Vec<[ContactMode; MOST_PALMS]>)> {
        let times: Vec<f64> = self.column("t")?.iter().copied().filter(|t| *t <= seconds + 1e-9).collect();
        let mut modes = vec![[ContactMode::Off; MOST_PALMS]; times.len()];
        let mut records = Vec::new();
        for i in 1..=self.palm_count() {
            let tail = format!("_{i}");
            let vectors = |stem| self.vectors(stem, &tail);
            let (points, p, v, w) = (vectors("p")?, vectors("P")?, vectors("V")?, vectors("W")?);
            let channel =
                |stem| -> Anything<_> { Ok(ForceChannel::Three(vectors(stem)?[..times.len()].to_vec())) };
            let q = self.quaternions("Q", &tail)?;
            let states = (0..times.len())
                .map(|k| Ok(MeasuredMotion { pose: SurfacePose::new(p[k], q[k])?, v_WP: v[k], w_WP: w[k] }));
            let states: Anything<Vec<_>> = states.collect();
            let (mode, slip) = (self.column(&format!("mode_{i}"))?, self.column(&format!("slip_{i}"))?);
            for (k, modes) in modes.iter_mut().enumerate() {
                modes[i - 1] = match mode[k] as u8 {
                    0 => ContactMode::Off,
                    2 if slip[k] < STICKS => ContactMode::Stick,
                    _ => ContactMode::Slide,
                };
            }
            let touched = |k: usize| {
                (points[k].is_finite() && modes[k][i - 1] != ContactMode::Off).then_some(points[k])
            };
            records.push(PalmRecord {
                surface: self.palm(i)?.surface,
                friction: None,
                motion: RecordedMotion::Measured(states?),
                contacts: ContactPoints::World((0..times.len()).map(touched).collect()),
                force: channel("f")?,
                impulse: channel("J")?,
                torque: None,
                hinge: None,
                truth: None,
                largest_offset: f64::INFINITY,
            });
        }
        Ok((ContactLog::new(times, records, None)?, modes))
    }

    /// Slip below which the log says that a contact sticks, m/s.
    pub(crate) fn slip_tolerance(&self) -> f64 {
        number(&self.about["slip_tolerance"])
    }

    /// Changes of modes at the first `count` samples.
    pub(crate) fn changes(&self, count: usize) -> Anything<Vec<Change>> {
        let t = self.column("t")?;
        let mut found = Vec::new();
        let modes = (1..=self.palm_count())
            .map(|i| self.column(&format!("mode_{i}")))
            .collect::<Anything<Vec<_>>>()?;
        for k in 1..count {
            for (palm, mode) in modes.iter().enumerate() {
                if mode[k] != mode[k - 1] {
                    found.push(Change { t: t[k], palm, mode: mode[k] as u8 });
                }
            }
        }
        Ok(found)
    }

    /// Coefficient of friction of palm `i`, from 1.
    pub(crate) fn friction(&self, i: usize) -> f64 {
        number(&self.about["palms"][i - 1]["mu"])
    }

    pub(crate) fn palm_count(&self) -> usize {
        self.about["palms"].as_array().map_or(0, Vec::len)
    }

    /// The body's state at sample `k`.
    pub(crate) fn body(&self, k: usize) -> Anything<BodyState> {
        self.bodies(k + 1)?.pop().ok_or_else(|| "no sample".into())
    }

    /// The body's states at the first `count` samples.
    pub(crate) fn bodies(&self, count: usize) -> Anything<Vec<BodyState>> {
        let (p, q, v, w) = (
            self.vectors("cm", "")?,
            self.quaternions("q", "")?,
            self.vectors("v", "")?,
            self.vectors("w", "")?,
        );
        Ok((0..count).map(|k| BodyState { p_WCm: p[k], R_WO: q[k], v_WCm: v[k], w_WO: w[k] }).collect())
    }

    /// The contact with palm `i`, from 1.
    pub(super) fn contact(&self, i: usize) -> Anything<Contact<'_>> {
        let tail = format!("_{i}");
        let (p, origin) = (self.vectors("p", &tail)?, self.vectors("P", &tail)?);
        let (v, w) = (self.vectors("V", &tail)?, self.vectors("W", &tail)?);
        let v = (0..p.len()).map(|k| v[k] + w[k].cross(p[k] - origin[k])).collect();
        Ok(Contact {
            v,
            p,
            n: self.vectors("n", &tail)?,
            friction: self.friction(i),
            f: self.vectors("f", &tail)?,
            mode: self.column(&format!("mode{tail}"))?,
            slip: self.column(&format!("slip{tail}"))?,
            gap: self.column(&format!("gap{tail}"))?,
        })
    }

    /// The scene whose palms move as the log's did, every pose being a node of their paths.
    pub(crate) fn scene(&self) -> Anything<ContactScene<Ellipsoid>> {
        let body = Ellipsoid::new(vector(&self.about["axes"]))?;
        let (mass, inertia) = self.mass();
        let mass = MassProperties::new(mass, inertia)?;
        let palms = (1..=self.palm_count()).map(|i| self.palm(i)).collect::<Anything<Vec<_>>>()?;
        Ok(ContactScene::new(body, mass, palms, number(&self.about["gravity"]))?)
    }

    fn palm(&self, i: usize) -> Anything<ScenePalm> {
        let about = &self.about["palms"][i - 1];
        let radius = number(&about["radius"]);
        let surface = match about["kind"].as_str().unwrap_or_default() {
            "flat" => PalmSurface::Plane,
            "sphere" => PalmSurface::Sphere { radius },
            "cup" => PalmSurface::Cup { radius },
            other => return Err(format!("palm of kind {other}").into()),
        };
        let mut positions = self.vectors("P", &format!("_{i}"))?;
        let spring = &about["spring"];
        let drive = if spring.is_null() {
            PalmDrive::Prescribed(self.path(i, &positions)?)
        } else {
            let (stiffness, damping) = (matrix(&spring["K"]), matrix(&spring["C"]));
            let mass = number(&spring["mass"]);
            self.command(i, &mut positions, (stiffness, damping, mass))?;
            let command = self.path(i, &positions)?;
            PalmDrive::Spring(PalmSpring { command, stiffness, damping, mass })
        };
        Ok(ScenePalm { surface, drive, friction: number(&about["mu"]) })
    }

    fn path(&self, i: usize, positions: &[DVec3]) -> Anything<SurfaceMotion> {
        let (t, turns) = (self.column("t")?, self.quaternions("Q", &format!("_{i}"))?);
        let still = positions.iter().zip(&turns).all(|(p, q)| *p == positions[0] && *q == turns[0]);
        let pose = |k: usize| SurfacePose::new(positions[k], turns[k]);
        if still {
            return Ok(SurfaceMotion::immobile(pose(0)?));
        }
        let rows: Result<Vec<_>, _> = (0..t.len()).map(|k| pose(k).map(|p| (t[k], p))).collect();
        Ok(SurfaceMotion::Table(PoseTable::new(&rows?)?))
    }

    /// Where the palm was commanded to be, from where it was: with `z = p_c - p`, `C z' + K z = m p'' + f`.
    fn command(&self, i: usize, positions: &mut [DVec3], (K, C, m): (DMat3, DMat3, f64)) -> Anything<()> {
        let (t, v, f) =
            (self.column("t")?, self.vectors("V", &format!("_{i}"))?, self.vectors("f", &format!("_{i}"))?);
        let n = t.len();
        let load = |k: usize| {
            let (a, b) = (k.saturating_sub(1), (k + 1).min(n - 1));
            m * (v[b] - v[a]) / (t[b] - t[a]) + f[k]
        };
        let mut z = K.inverse() * load(0);
        positions[0] += z;
        for k in 1..n {
            // Trapezoidal rule: the ratio C / K is at least two steps long.
            let h = t[k] - t[k - 1];
            let right = (C / h - K * 0.5) * z + 0.5 * (load(k - 1) + load(k));
            z = (C / h + K * 0.5).inverse() * right;
            positions[k] += z;
        }
        Ok(())
    }

    /// Coordinates of the palms on springs at sample `k`.
    pub(crate) fn palm_coordinates(&self, k: usize) -> Anything<[PalmCoordinates; 5]> {
        let mut all = [PalmCoordinates::default(); 5];
        for i in 1..=self.palm_count() {
            let tail = format!("_{i}");
            let (position, velocity) = (self.vectors("P", &tail)?[k], self.vectors("V", &tail)?[k]);
            all[i - 1] = PalmCoordinates { position, velocity };
        }
        Ok(all)
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}

fn vector(value: &Value) -> DVec3 {
    DVec3::new(number(&value[0]), number(&value[1]), number(&value[2]))
}

fn matrix(value: &Value) -> DMat3 {
    DMat3::from_cols(vector(&value[0]), vector(&value[1]), vector(&value[2])).transpose()
}
