//! The estimate from contacts of any palms ([`estimate_contacts`]) in the plane.

use crate::contacts::{
    Beginning, ContactEstimate, ContactEstimateError, ContactEvidence, ContactNoiseLevel, ContactOptions,
    EstimatedModes, estimate_contacts, estimate_contacts_from,
};
use crate::faults::{Explanation, Suspect};
use crate::reliability::Reliability;
use glam::{DMat3, DVec2, DVec3};
use object_dynamics::planar::{BodyState, ContactLog, PlanarMass, PlanarTruth, in_plane};
use object_dynamics::{ContactLogError, ContactMode, LoggedPalm, MOST_PALMS, MassError, MassProperties};
use std::f64::consts::{PI, TAU};
use thiserror::Error;

/// How [`estimate_plane`] works.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneOptions {
    /// Noise of the sensors; where it is not known, of [`plane_noise`].
    pub noise: ContactNoiseLevel,
    /// Gravity, m/s^2, along -y.
    pub gravity: f64,
    /// Coefficient of friction of each palm, where it is known; of those without one nothing is known. One of zero pushes along its normal.
    pub friction: Vec<Option<f64>>,
    /// Mass and moment of inertia of the body, where they are known; else they are estimated.
    pub body: Option<PlanarMass>,
    /// Mean radius of the body, m, where it is known; else from contacts on two palms or more.
    pub size: Option<f64>,
    /// Whether to test what is taken as known of the sensors.
    pub suspects: bool,
    /// Whether to tell how probable contact modes are.
    pub mode_odds: bool,
    /// Whether to tell covariances of the pose at all samples.
    pub pose_covariances: bool,
}

/// Why there is no estimate.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum PlaneEstimateError {
    /// The log.
    #[error(transparent)]
    Log(#[from] ContactLogError),
    /// The mass and inertia that are known.
    #[error(transparent)]
    Mass(#[from] MassError),
    /// The estimate.
    #[error(transparent)]
    Estimate(#[from] ContactEstimateError),
}

/// Standard deviations of what is known at one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlaneDeviations {
    /// Of the centre of mass, m.
    pub p_WCm: DVec2,
    /// Of the turn since the first sample, rad.
    pub phi0: f64,
    /// Of the velocity of the centre of mass, m/s.
    pub v_WCm: DVec2,
    /// Of the angular velocity, rad/s.
    pub omega0: f64,
}

/// A contact on the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneContact {
    /// From the centre of mass, body axes, m.
    pub p_OC: DVec2,
    /// Outward unit normal, body axes.
    pub normal: DVec2,
    /// Radius function there, `p_OC . normal`, m.
    pub radius: f64,
}

/// Motion and shape of a body in the plane, and its mass and moment of inertia.
#[derive(Clone, Debug)]
pub struct PlaneEstimate {
    /// Motion at all samples; the axes of the body are those of the world at the first one.
    pub states: Vec<BodyState>,
    /// Standard deviations there.
    pub deviations: Vec<PlaneDeviations>,
    /// Covariances of the pose there: centre of mass (m), turn since the first sample (rad). None unless asked for.
    pub pose_covariances: Vec<[[f64; 3]; 3]>,
    /// Whether a sample's motion is to be relied on: to within its deviations.
    pub relied_on: Vec<bool>,
    /// Contacts of each palm on the body, at all samples where there is one that was not misread: the shape, point by point.
    pub contacts: Vec<Vec<Option<PlaneContact>>>,
    /// Contact modes at all samples.
    pub modes: Vec<[ContactMode; MOST_PALMS]>,
    /// How probable the modes are, of palms with friction; none unless asked for.
    pub mode_odds: Option<EstimatedModes>,
    /// Mass (kg) and the standard deviation of its logarithm.
    pub mass: (f64, f64),
    /// Moment of inertia about the centre of mass and its standard deviation, kg m^2; none of a known body.
    pub inertia: (f64, f64),
    /// What the data say of constants of the sensors that were taken as known; none unless asked for.
    pub suspects: Vec<Suspect>,
    /// Where something contradicts what was taken as known: what that may be, the most probable first.
    pub explanations: Vec<Explanation>,
    /// Whether to believe it.
    pub reliability: Reliability,
    /// What it rests on.
    pub evidence: ContactEvidence,
}

/// Noise of the sensors of a log by the roughness of their readings, of palms of the given coefficients of friction where they are known;
/// `floor` (m/s) is what contact conditions are off by beside that.
///
/// # Errors
/// [`ContactLogError`] for a log that one of space does not take.
pub fn plane_noise(
    log: &ContactLog,
    friction: &[Option<f64>],
    floor: f64,
) -> Result<ContactNoiseLevel, ContactLogError> {
    Ok(ContactNoiseLevel::by_roughness(&log.in_space(friction)?, floor, true))
}

/// Motion, mass and moment of inertia of a body from contacts of any palms in the plane and their forces, from no guess: the estimate of
/// space, of a motion that is held in a plane.
///
/// # Errors
/// [`PlaneEstimateError`].
pub fn estimate_plane(log: &ContactLog, options: &PlaneOptions) -> Result<PlaneEstimate, PlaneEstimateError> {
    let in_space = log.in_space(&options.friction)?;
    let found = estimate_contacts(&in_space, None, &options.in_space()?)?;
    Ok(PlaneEstimate::of_space(found, &in_space))
}

/// [`estimate_plane`] of a log of whose first samples the motion is known: it is carried on to the others ([`estimate_contacts_from`]).
///
/// # Errors
/// [`PlaneEstimateError`].
pub fn estimate_plane_from(
    beginning: &Beginning,
    log: &ContactLog,
    options: &PlaneOptions,
) -> Result<PlaneEstimate, PlaneEstimateError> {
    let in_space = log.in_space(&options.friction)?;
    let found = estimate_contacts_from(beginning, &in_space, &options.in_space()?)?;
    Ok(PlaneEstimate::of_space(found, &in_space))
}

impl PlaneOptions {
    /// Of a body of which nothing is known, with nothing asked beside its motion. `gravity` in m/s^2; coefficients of friction as [`Self::friction`].
    #[must_use]
    pub fn new(noise: ContactNoiseLevel, gravity: f64, friction: Vec<Option<f64>>) -> Self {
        Self {
            noise,
            gravity,
            friction,
            body: None,
            size: None,
            suspects: false,
            mode_odds: false,
            pose_covariances: false,
        }
    }

    /// The same for the log in space; the coefficients of friction stand in that log itself.
    ///
    /// # Errors
    /// [`MassError`] for a body that none in space is like.
    pub fn in_space(&self) -> Result<ContactOptions, MassError> {
        // Of a known body all three moments are the one that shows.
        let ball =
            |known: &PlanarMass| MassProperties::from_principal(known.mass(), DVec3::splat(known.inertia()));
        Ok(ContactOptions {
            body: self.body.as_ref().map(ball).transpose()?,
            size: self.size,
            suspects: self.suspects,
            mode_odds: self.mode_odds,
            pose_covariances: self.pose_covariances,
            planar: true,
            guessed_floor: false,
            ..ContactOptions::new(self.noise, self.gravity)
        })
    }
}

impl PlaneEstimate {
    /// What it tells of a log that goes on after its last sample; none where it is not to be relied on.
    #[must_use]
    pub fn beginning(&self) -> Option<Beginning> {
        let inertia = DMat3::from_diagonal(DVec3::splat(self.inertia.0));
        let states = || self.states.iter().map(|state| PlanarTruth::from(*state).in_space()).collect();
        self.reliability.is_reliable().then(|| Beginning::new(states(), self.mass.0, inertia))
    }

    /// In the plane, of what was estimated from a log in space ([`ContactLog::in_space`]) of a motion that is held in a plane.
    #[must_use]
    pub fn of_space(of: ContactEstimate, log: &object_dynamics::ContactLog) -> Self {
        let mut phi0 = 0.0;
        let states = of.states.iter().enumerate().map(|(k, state)| {
            let turned = of.states[0].R_WO.conjugate() * state.R_WO;
            let angle = 2.0 * f64::atan2(-turned.y, turned.w);
            // Of all angles that are as good the nearest to the one before.
            phi0 = if k == 0 { 0.0 } else { phi0 + (angle - phi0 + PI).rem_euclid(TAU) - PI };
            let (p_WCm, v_WCm) = (in_plane(state.p_WCm), in_plane(state.v_WCm));
            BodyState { p_WCm, phi0, v_WCm, omega0: -state.w_WO.y }
        });
        let states: Vec<BodyState> = states.collect();
        let deviations = of.deviations.iter().map(|[p, v, w, turn]| PlaneDeviations {
            p_WCm: in_plane(*p),
            phi0: turn.y,
            v_WCm: in_plane(*v),
            omega0: w.y,
        });
        let contact = |i: usize, palm: &LoggedPalm, k: usize| {
            let touch = palm.touch(k).filter(|_| of.misread.binary_search(&(k, i)).is_err())?;
            let (normal, back) = (in_plane(-touch.n.get()), DVec2::from_angle(-states[k].phi0));
            let p_OC = back.rotate(in_plane(touch.p_WC) - states[k].p_WCm);
            let normal = back.rotate(normal);
            Some(PlaneContact { p_OC, normal, radius: p_OC.dot(normal) })
        };
        let of_palm = |(i, palm)| (0..states.len()).map(|k| contact(i, palm, k)).collect();
        Self {
            contacts: log.palms().iter().enumerate().map(of_palm).collect(),
            deviations: deviations.collect(),
            pose_covariances: of.pose_covariances.iter().map(pose_in_plane).collect(),
            states,
            mass: (of.mass, of.mass_deviation),
            inertia: (of.inertia.y_axis.y, of.moment_deviation(DVec3::Y)),
            relied_on: of.relied_on,
            modes: of.modes,
            mode_odds: of.mode_odds,
            suspects: of.suspects,
            explanations: of.explanations,
            reliability: of.reliability,
            evidence: of.evidence,
        }
    }
}

/// Of the covariance of a pose in space that of the pose in the plane, where turns count about -y.
fn pose_in_plane(of: &[[f64; 6]; 6]) -> [[f64; 3]; 3] {
    const POSE: [(usize, f64); 3] = [(0, 1.0), (2, 1.0), (4, -1.0)];
    POSE.map(|(i, sign)| POSE.map(|(k, other)| sign * other * of[i][k]))
}
