use glam::DVec3;
use recon::object_dynamics::{Rhythm, Track};

/// Readings that come at a steady rate, but for silences.
pub(in crate::bag) struct Steady {
    track: Track,
    /// What is interpolated over at most, s.
    longest: f64,
}

impl Steady {
    pub(super) fn new(track: Track) -> Self {
        Self { longest: Rhythm::of(track.times()).longest(), track }
    }

    pub(in crate::bag) fn times(&self) -> &[f64] {
        self.track.times()
    }

    pub(in crate::bag) fn values(&self) -> &[DVec3] {
        self.track.values()
    }

    pub(in crate::bag) fn at(&self, t: f64) -> Option<DVec3> {
        self.track.at(t, self.longest)
    }

    pub(in crate::bag) fn interpolation_error(&self) -> Option<f64> {
        self.track.interpolation_error(self.longest)
    }
}

/// Contacts of a palm over time, palm axes; none while it is not touched.
pub(in crate::bag) struct Touches {
    pub(in crate::bag) topic: String,
    pub(in crate::bag) times: Vec<f64>,
    pub(in crate::bag) points: Vec<Option<DVec3>>,
    pub(in crate::bag) longest: f64,
}

/// A contact at one time.
pub(in crate::bag) enum Touched {
    /// There are no readings.
    Unknown,
    No,
    At {
        point: DVec3,
        /// Whether it lies between two readings.
        between: bool,
    },
}

impl Touches {
    pub(super) fn new(topic: &str, readings: Vec<(f64, Option<DVec3>)>) -> Self {
        let (times, points): (Vec<f64>, Vec<Option<DVec3>>) = readings.into_iter().unzip();
        let longest = Rhythm::of(&times).longest();
        Self { topic: topic.to_owned(), times, points, longest }
    }

    pub(in crate::bag) fn at(&self, t: f64) -> Touched {
        let after = self.times.partition_point(|&time| time <= t);
        let Some(before) = after.checked_sub(1) else { return Touched::Unknown };
        if self.times[before] == t {
            return self.points[before].map_or(Touched::No, |point| Touched::At { point, between: false });
        }
        let Some(step) = self.times.get(after).map(|end| end - self.times[before]) else {
            return Touched::Unknown;
        };
        if step > self.longest {
            return Touched::Unknown;
        }
        match (self.points[before], self.points[after]) {
            (Some(a), Some(b)) => {
                Touched::At { point: a.lerp(b, (t - self.times[before]) / step), between: true }
            }
            // Somewhere between a contact and none it began or ended.
            _ => Touched::No,
        }
    }

    /// The contacts alone.
    pub(in crate::bag) fn track(&self) -> Option<Track> {
        let touched = self.times.iter().zip(&self.points).filter_map(|(t, point)| Some((*t, (*point)?)));
        let (times, points) = touched.unzip();
        Track::new(times, points).ok()
    }
}
