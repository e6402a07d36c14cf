//! Scenes that the cross-crate tests share.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a helper of tests may panic, as a test may")]

pub mod belt;
pub mod contact_modes;
pub mod planar_scenes;

use glam::{DMat3, DQuat, DVec3};
use recon::contact_kinematics::{
    Ellipsoid, MinkowskiSum, Monomial, MotionLaw, Palm, PolynomialSupport, SupportFunction,
};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    InitialMotion, MassProperties, SampleTimes, SensorLog, Simulation, ThreePalmScene,
};
use std::process::Command;
use std::sync::LazyLock;

/// How much of a test is run: a decisive part of it, all of it where the environment says `RECON_TESTS=all`, as
/// `cargo xtask verify --only all-tests` does.
#[must_use]
pub fn few_or_all<T>(few: T, all: T) -> T {
    if std::env::var_os("RECON_TESTS").is_some_and(|asked| asked == "all") { all } else { few }
}

/// Whether a Python with MuJoCo is installed, asked once; says so where it is not. A folder of that name is a module of Python too, but
/// without models.
#[must_use]
pub fn mujoco_is_there() -> bool {
    static THERE: LazyLock<bool> = LazyLock::new(|| {
        let found = Command::new("python3").args(["-c", "import mujoco, numpy; mujoco.MjModel"]).output();
        found.is_ok_and(|run| run.status.success())
    });
    if !*THERE {
        println!("skipped: python3 with the modules mujoco and numpy is not installed");
    }
    *THERE
}

/// A general body: an ellipsoid plus a polynomial.
pub type GeneralBody = MinkowskiSum<Ellipsoid, PolynomialSupport>;

/// `h = sqrt(n' diag(axes^2) n) + offset . n + dent n_x n_y n_z`.
///
/// # Panics
/// When the numbers make no body.
#[must_use]
pub fn general_body(axes: DVec3, offset: DVec3, dent: f64) -> GeneralBody {
    let mut terms = vec![Monomial { powers: [1, 1, 1], coefficient: dent }];
    for axis in 0..3 {
        let mut powers = [0; 3];
        powers[axis] = 1;
        terms.push(Monomial { powers, coefficient: offset[axis] });
    }
    MinkowskiSum(Ellipsoid::new(axes).unwrap(), PolynomialSupport::new(terms).unwrap())
}

/// The immobile scene `F5` of the oracle: semi-axes 1, 2, 2.5, azimuths 60, 180, 300 degrees, slope 60 degrees.
///
/// # Panics
/// Never.
#[must_use]
pub fn f5() -> (ThreePalmScene<Ellipsoid>, InitialMotion) {
    let axes = DVec3::new(1.0, 2.0, 2.5);
    immobile(axes, [60.0, 180.0, 300.0], 9.81, DQuat::IDENTITY, DVec3::new(0.0, 0.3, 0.3))
}

/// The moving scene `G2` of the oracle: offset centre of mass, full inertia tensor, palms that swing.
///
/// # Panics
/// Never.
#[must_use]
pub fn g2() -> (ThreePalmScene<GeneralBody>, InitialMotion) {
    let body = general_body(DVec3::new(2.5, 2.0, 1.5), DVec3::new(0.2, -0.1, 0.15), 0.08);
    let inertia = DMat3::from_cols_array(&[1.4, 0.08, -0.05, 0.08, 1.9, 0.06, -0.05, 0.06, 2.3]);
    let palm = |azimuth, slope, amplitude, frequency, phase| {
        Palm::new(azimuth, MotionLaw::Sinusoid { mean: slope, amplitude, frequency, phase }).unwrap()
    };
    let palms =
        [palm(0.1, 0.9, 0.08, 1.7, 0.3), palm(2.0, 1.05, 0.1, 2.1, 1.0), palm(4.3, 1.0, 0.06, 1.3, 2.0)];
    let scene = ThreePalmScene::new(body, MassProperties::new(1.3, inertia).unwrap(), palms, 9.81).unwrap();
    (scene, InitialMotion { R_WO: DQuat::IDENTITY, w_WO: DVec3::new(0.2, 0.3, -0.4) })
}

/// The scene of the logs `A_fig5` (gravity 9.81) and `B_gentle` (gravity 1): semi-axes 2.5, 2, 1.
#[must_use]
pub fn fig5(gravity: f64) -> (ThreePalmScene<Ellipsoid>, InitialMotion) {
    let axes = DVec3::new(2.5, 2.0, 1.0);
    immobile(axes, LOG_PALMS, gravity, DQuat::IDENTITY, DVec3::new(0.0, 0.3, 0.3))
}

/// The scene of the log `D_tilted`.
#[must_use]
pub fn tilted() -> (ThreePalmScene<Ellipsoid>, InitialMotion) {
    let q = DQuat::from_xyzw(0.499376169438922, -0.299625701663353, 0.549313786382815, 0.599251403326707);
    immobile(DVec3::new(1.8, 1.3, 0.9), LOG_PALMS, 9.81, q, DVec3::new(0.8, -0.5, 0.4))
}

/// Directions in which the palms of the logs rise, degrees: their normals' azimuths are the opposite ones.
const LOG_PALMS: [f64; 3] = [270.0, 30.0, 150.0];

fn immobile(
    axes: DVec3,
    azimuths: [f64; 3],
    gravity: f64,
    R_WO: DQuat,
    w_WO: DVec3,
) -> (ThreePalmScene<Ellipsoid>, InitialMotion) {
    let palms = azimuths.map(|degrees: f64| Palm::fixed(degrees.to_radians(), 60f64.to_radians()).unwrap());
    let mass = MassProperties::uniform_ellipsoid(1.0, axes).unwrap();
    let scene = ThreePalmScene::new(Ellipsoid::new(axes).unwrap(), mass, palms, gravity).unwrap();
    (scene, InitialMotion { R_WO, w_WO })
}

/// Largest absolute difference of two orientations as matrices, whatever the sign of the quaternions.
#[must_use]
pub fn orientation_difference(a: DQuat, b: DQuat) -> f64 {
    let difference = DMat3::from_quat(a) - DMat3::from_quat(b);
    difference.to_cols_array().iter().fold(0.0, |m: f64, v| m.max(v.abs()))
}

/// Energy of an instant relative to another.
#[must_use]
pub fn relative_energy_drift<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    instants: &[recon::object_dynamics::Instant],
) -> f64 {
    let start = instants[0].energy(scene);
    instants.iter().fold(0.0, |m: f64, now| m.max(((now.energy(scene) - start) / start).abs()))
}

/// A simulation close to rounding and its log without truth: what a perfect robot would have.
///
/// # Panics
/// When the scene cannot be simulated.
#[must_use]
pub fn exact_log<S: SupportFunction>(
    scene: &ThreePalmScene<S>,
    start: InitialMotion,
    duration: f64,
    rate: f64,
) -> (Simulation, SensorLog) {
    let times = SampleTimes { duration, rate };
    let simulation = scene.simulate(start, times, Tolerance::uniform(1e-14)).unwrap();
    let log = simulation.sensor_log(scene).unwrap().split_truth().0;
    (simulation, log)
}

/// A splitmix generator: scenes that do not change with a library's version.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// A generator with a sequence of its own for each seed.
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// A number between `low` and `high`.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        low + (high - low) * ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A vector with each component between `low` and `high`.
    pub fn vector(&mut self, low: f64, high: f64) -> DVec3 {
        DVec3::new(self.within(low, high), self.within(low, high), self.within(low, high))
    }
}
