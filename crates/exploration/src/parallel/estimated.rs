//! Palms that sense, with an observer that tells where the body is.

use super::hold::{Hold, Stop};
use super::palms::{FeltBetween, ParallelPalms, ParallelPalmsError, SensedPalms};
use observer::rolling::{RolledPose, RollingNoise, RollingObserver, RollingReading};
use shape_bounds::ContactSample;
use shape_bounds::noise::{ContactNoise, PoseNoise};

/// What `palms` sense, in axes of the body: those of the world at first, from the middle of the lower palm. Nothing but what is sensed is known.
pub struct EstimatedPalms<P> {
    palms: P,
    observer: RollingObserver,
    last: RollingReading,
}

impl<P: SensedPalms> EstimatedPalms<P> {
    /// With sensors of this noise.
    ///
    /// # Errors
    /// [`ParallelPalmsError`] of the first reading.
    pub fn new(mut palms: P, noise: RollingNoise) -> Result<Self, ParallelPalmsError> {
        let last = palms.sense()?;
        Ok(Self { observer: RollingObserver::new(&last, noise)?, palms, last })
    }

    /// Where the body is.
    #[must_use]
    pub fn pose(&self) -> RolledPose {
        self.observer.pose()
    }

    fn felt(&self, way: f64, stop: Option<Stop>) -> Result<FeltBetween, ParallelPalmsError> {
        let pose = self.observer.pose();
        let hold = Hold { R_WO: pose.R_WO, pads: self.last.contacts };
        let normals = hold.normals();
        let contacts = [0, 1].map(|i| ContactSample { point: pose.contacts[i], normal: normals[i] });
        let of_pose = PoseNoise { rotation: pose.rotation, translation: pose.translation, cross: pose.cross };
        // Palms are flat: a normal is off by the turn of the pose alone.
        let noise = pose.of_contacts.map(|point| ContactNoise { point, normal: 0.0, pose: of_pose });
        Ok(FeltBetween { hold, contacts, noise: Some(noise), way, stop })
    }
}

impl<P: SensedPalms> ParallelPalms for EstimatedPalms<P> {
    fn feel(&mut self) -> Result<FeltBetween, ParallelPalmsError> {
        self.felt(0.0, None)
    }

    fn roll(&mut self, heading: f64, turn: f64) -> Result<FeltBetween, ParallelPalmsError> {
        let (sensed, stop) = self.palms.stroke(heading, turn)?;
        let from = self.last.upper;
        for reading in sensed {
            self.observer.push(&reading)?;
            self.last = reading;
        }
        self.felt((self.last.upper - from).truncate().length(), stop)
    }
}
