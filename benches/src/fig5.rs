//! The paper's Fig. 5 with and without friction, and its poses at equal times.

use glam::{DQuat, DVec3};
use recon::contact_kinematics::{Ellipsoid, PalmSurface, SurfaceMotion, SurfacePose};
use recon::object_dynamics::integrate::Tolerance;
use recon::object_dynamics::{
    BodyState, ContactScene, ContactStart, InitialMotion, PalmDrive, SampleTimes, ScenePalm, ThreePalmScene,
};
use recon_tests::fig5;
use serde_json::{Value, json};

/// Position of the centre of mass and orientation.
pub type Pose = (DVec3, DQuat);
type Anything<T> = Result<T, Box<dyn std::error::Error>>;

/// An ellipsoid that slides over three flat palms at rest.
pub struct Fig5 {
    /// Coefficient of all palms.
    pub friction: f64,
    times: SampleTimes,
    minimal: ThreePalmScene<Ellipsoid>,
    spin: InitialMotion,
    general: ContactScene<Ellipsoid>,
    start: BodyState,
    normals: [DVec3; 3],
}

impl Fig5 {
    /// With a friction, over these times.
    ///
    /// # Errors
    /// Times or a friction that are not usable.
    pub fn new(friction: f64, times: SampleTimes) -> Anything<Self> {
        let (minimal, spin) = fig5(9.81);
        let now = minimal.instant(0.0, spin.R_WO, spin.w_WO)?;
        let palm = |i: usize| -> Anything<ScenePalm> {
            let pose = SurfacePose::new(DVec3::ZERO, DQuat::from_mat3(&now.palms[i].frame.rotation()))?;
            let drive = PalmDrive::Prescribed(SurfaceMotion::immobile(pose));
            Ok(ScenePalm { surface: PalmSurface::Plane, drive, friction })
        };
        let palms = vec![palm(0)?, palm(1)?, palm(2)?];
        let general = ContactScene::new(*minimal.body(), *minimal.mass(), palms, 9.81)?;
        let start =
            BodyState { p_WCm: now.touch.p_WCm, R_WO: spin.R_WO, v_WCm: now.rates.v_WCm, w_WO: spin.w_WO };
        let normals = [0, 1, 2].map(|i| now.palms[i].frame.n);
        Ok(Self { friction, times, minimal, spin, general, start, normals })
    }

    /// s.
    #[must_use]
    pub fn duration(&self) -> f64 {
        self.times.duration
    }

    /// Poses by simulation through contact modes.
    ///
    /// # Errors
    /// Those of the simulation, in words.
    pub fn general(&self, tolerance: f64) -> Result<Vec<Pose>, String> {
        let start = ContactStart::touching(self.start);
        let run = self.general.simulate(&start, self.times, tolerance).map_err(|e| e.to_string())?;
        Ok(run.instants.iter().map(|now| (now.state.body.p_WCm, now.state.body.R_WO)).collect())
    }

    /// Poses in minimal coordinates, which know no friction.
    ///
    /// # Errors
    /// Those of the simulation, in words.
    pub fn minimal(&self, tolerance: f64) -> Result<Vec<Pose>, String> {
        let tolerance = Tolerance::uniform(tolerance);
        let run = self.minimal.simulate(self.spin, self.times, tolerance).map_err(|e| e.to_string())?;
        Ok(run.instants.iter().map(|now| (now.touch.p_WCm, now.R_WO)).collect())
    }

    /// What the peer is told, with the poses that it is judged by.
    #[must_use]
    pub fn for_peer(&self, poses: &[Pose]) -> Value {
        let vector = |v: DVec3| v.to_array();
        let quaternion = |q: DQuat| [q.w, q.x, q.y, q.z];
        let (start, inertia) = (&self.start, self.general.mass().inertia());
        json!({
            "gravity": -self.general.gravity().z,
            "mass": self.general.mass().mass(),
            "moments": [inertia.x_axis.x, inertia.y_axis.y, inertia.z_axis.z],
            "semi_axes": vector(self.general.body().semi_axes()),
            "normals": self.normals.map(vector),
            "friction": self.friction,
            "position": vector(start.p_WCm),
            "orientation": quaternion(start.R_WO),
            "velocity": vector(start.v_WCm),
            "spin": vector(start.w_WO),
            "duration": self.times.duration,
            "poses": poses[1..].iter().map(|(p, q)| json!([vector(*p), quaternion(*q)])).collect::<Vec<_>>(),
        })
    }
}

/// Largest distance of the positions and angle between the orientations, whichever is larger; NaN where poses are missing.
#[must_use]
pub fn largest_error(poses: &[Pose], exact: &[Pose]) -> f64 {
    if poses.len() < exact.len() {
        return f64::NAN;
    }
    let one = |((p, q), (pe, qe)): (&Pose, &Pose)| {
        let turn = *q * qe.inverse();
        let angle = 2.0 * DVec3::new(turn.x, turn.y, turn.z).length().atan2(turn.w.abs());
        p.distance(*pe).max(angle)
    };
    poses.iter().zip(exact).map(one).fold(0.0, f64::max)
}
