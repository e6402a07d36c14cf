use super::PalmHinge;
use super::record::{
    ContactPoints, ForceChannel, MeasuredMotion, PalmRecord, RecordedMotion, SensedAxes, TrueContact,
    TwistSource,
};
use contact_kinematics::{Direction, PalmSurface, SurfacePose, SurfaceState};
use glam::DVec3;

/// Rounding of a point that was turned into palm axes and back, in units of rounding of its coordinates: a point that is as
/// near as this to the surface stands on it, and is left alone. So what was once put there stays where it is.
const TURNED: f64 = 16.0 * f64::EPSILON;

/// A palm of a log and its readings. Samples are counted from 0 as in [`super::ContactLog::times`].
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedPalm {
    pub(super) surface: PalmSurface,
    pub(super) friction: Option<f64>,
    pub(super) motion: LoggedMotion,
    pub(super) touches: Vec<Option<Touch>>,
    pub(super) force: ForceChannel,
    pub(super) impulse: ForceChannel,
    pub(super) torque: Option<Vec<Option<f64>>>,
    pub(super) hinge: Option<PalmHinge>,
    pub(super) truth: Option<Vec<TrueContact>>,
    /// How far the farthest contact was off the surface, m.
    pub(super) offset: f64,
}

/// Where the object touches a palm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// Contact point on the palm's surface, world, m.
    pub p_WC: DVec3,
    /// The palm's normal there, into the object, world axes.
    pub n: Direction,
}

/// What is known of a force of a palm on the object, or of its impulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SensedForce {
    /// The vector, world axes, N or N s: its part along the normal alone where no more was measured.
    pub vector: DVec3,
    /// How much of it was measured.
    pub axes: SensedAxes,
}

/// Motion of a palm as it stands in memory: a palm that does not move takes no memory per sample.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum LoggedMotion {
    Fixed(SurfacePose),
    Moving { states: Vec<MeasuredMotion>, twists: TwistSource },
}

impl Touch {
    /// The point of a palm's surface nearest to the world point `p_W` (m), and how far off it that was, m. None where the surface has no
    /// normal, as at the centre of a sphere.
    #[must_use]
    pub fn on(surface: PalmSurface, frame: &SurfaceState, p_W: DVec3) -> Option<(Self, f64)> {
        let p_P = frame.to_palm(p_W);
        let near = surface.nearest(p_P)?;
        let rounding = TURNED * (p_W.length() + frame.p_WP.length() + p_P.length());
        let on_it = near.distance.abs() <= rounding;
        let p_WC = if on_it { p_W } else { frame.to_world(near.p_P) };
        // From the point as it stands in the log, so that it is the same whenever the log is read again.
        let n_P = surface.nearest(frame.to_palm(p_WC))?.n_P;
        let n = Direction::new(frame.R_WP * n_P.get()).ok()?;
        Some((Self { p_WC, n }, if on_it { 0.0 } else { near.distance }))
    }
}

impl LoggedPalm {
    pub(super) fn shift(&mut self, by: DVec3) {
        match &mut self.motion {
            LoggedMotion::Fixed(pose) => pose.p_WP += by,
            LoggedMotion::Moving { states, .. } => states.iter_mut().for_each(|state| state.pose.p_WP += by),
        }
        self.touches.iter_mut().flatten().for_each(|touch| touch.p_WC += by);
        self.hinge.iter_mut().for_each(|hinge| hinge.pivot += by);
    }

    /// Its shape.
    #[must_use]
    pub fn surface(&self) -> PalmSurface {
        self.surface
    }

    /// Coefficient of friction between it and the object, where it is known.
    #[must_use]
    pub fn friction(&self) -> Option<f64> {
        self.friction
    }

    /// Where its twist comes from.
    #[must_use]
    pub fn twist_source(&self) -> TwistSource {
        match self.motion {
            LoggedMotion::Fixed(_) => TwistSource::Immobile,
            LoggedMotion::Moving { twists, .. } => twists,
        }
    }

    /// Pose and twist at sample `k`.
    #[must_use]
    pub fn motion(&self, k: usize) -> MeasuredMotion {
        match &self.motion {
            LoggedMotion::Fixed(pose) => MeasuredMotion::at_rest(*pose),
            LoggedMotion::Moving { states, .. } => states[k],
        }
    }

    /// The contact at sample `k`; none while the object does not touch the palm.
    #[must_use]
    pub fn touch(&self, k: usize) -> Option<Touch> {
        self.touches[k]
    }

    /// How far the contact farthest from the surface was off it before it was put there, m.
    #[must_use]
    pub fn largest_offset(&self) -> f64 {
        self.offset
    }

    /// Contact force on the object at sample `k`, N, where the palm measures it.
    #[must_use]
    pub fn force(&self, k: usize) -> Option<SensedForce> {
        let n = self.touches[k].map(|touch| touch.n.get());
        Some(SensedForce { vector: self.force.at(k, n)?, axes: self.force.axes()? })
    }

    /// Impulse on the object over the interval that ends at sample `k`, N s, where the palm measures it; none at the first
    /// sample, before which nothing is known.
    ///
    /// Of a palm that measures along its normal alone, it points along the normal at sample `k`, or at the sample before
    /// where the contact ended in the interval.
    #[must_use]
    pub fn impulse(&self, k: usize) -> Option<SensedForce> {
        let (before, axes) = (k.checked_sub(1)?, self.impulse.axes()?);
        let vector = match &self.impulse {
            ForceChannel::Missing => return None,
            ForceChannel::Three(sums) => sums[k] - sums[before],
            ForceChannel::Normal(sums) => {
                let touch = self.touches[k].or(self.touches[before]);
                touch.map_or(DVec3::ZERO, |touch| (sums[k] - sums[before]) * touch.n.get())
            }
        };
        Some(SensedForce { vector, axes })
    }

    /// How much of the force the palm measures.
    #[must_use]
    pub fn force_axes(&self) -> Option<SensedAxes> {
        self.force.axes()
    }

    /// How much of the impulse the palm measures.
    #[must_use]
    pub fn impulse_axes(&self) -> Option<SensedAxes> {
        self.impulse.axes()
    }

    /// The whole channel of the force, as it was recorded.
    #[must_use]
    pub fn force_channel(&self) -> &ForceChannel {
        &self.force
    }

    /// The whole channel of the impulse, as it was recorded: an integral, of which [`Self::impulse`] takes differences.
    #[must_use]
    pub fn impulse_channel(&self) -> &ForceChannel {
        &self.impulse
    }

    /// What its motor turns it about, where that is known.
    #[must_use]
    pub fn hinge(&self) -> Option<&PalmHinge> {
        self.hinge.as_ref()
    }

    /// Torque of its motor about the hinge, or about its x axis where that is not known, at sample `k`, N m, where it was
    /// measured.
    #[must_use]
    pub fn torque(&self, k: usize) -> Option<f64> {
        self.torque.as_ref().and_then(|torque| torque[k])
    }

    /// Whether the torque of its motor was measured at any sample.
    #[must_use]
    pub fn has_torque(&self) -> bool {
        self.torque.is_some()
    }

    /// What a simulator knows of the contact at sample `k`.
    #[must_use]
    pub fn truth(&self, k: usize) -> Option<TrueContact> {
        self.truth.as_ref().map(|truth| truth[k])
    }

    pub(super) fn forget_truth(&mut self) {
        self.truth = None;
    }

    pub(super) fn record(&self) -> PalmRecord {
        PalmRecord {
            surface: self.surface,
            friction: self.friction,
            motion: match &self.motion {
                LoggedMotion::Fixed(pose) => RecordedMotion::Fixed(*pose),
                LoggedMotion::Moving { states, twists: TwistSource::FromPoses } => {
                    RecordedMotion::Poses(states.iter().map(|state| state.pose).collect())
                }
                LoggedMotion::Moving { states, .. } => RecordedMotion::Measured(states.clone()),
            },
            contacts: ContactPoints::World(self.touches.iter().map(|t| t.map(|t| t.p_WC)).collect()),
            force: self.force.clone(),
            impulse: self.impulse.clone(),
            torque: self.torque.clone(),
            hinge: self.hinge,
            truth: self.truth.clone(),
            largest_offset: f64::INFINITY,
        }
    }

    pub(super) fn bytes_per_sample(&self) -> usize {
        let moving = match self.motion {
            LoggedMotion::Fixed(_) => 0,
            LoggedMotion::Moving { .. } => size_of::<MeasuredMotion>(),
        };
        let torque = self.torque.as_ref().map_or(0, |_| size_of::<Option<f64>>());
        let truth = self.truth.as_ref().map_or(0, |_| size_of::<TrueContact>());
        size_of::<Option<Touch>>() + moving + self.force.bytes() + self.impulse.bytes() + torque + truth
    }
}
