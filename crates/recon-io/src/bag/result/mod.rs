//! Results as a bag, which Foxglove and Rerun show as it is: motion, contacts, forces, bounds; Rerun, which has no markers, as frames and points all over.

mod definitions;
mod encode;

use crate::TriangleMesh;
use definitions::Definition;
use encode::{Header, Marker};
use glam::{DQuat, DVec3};
use mcap::records::MessageHeader;
use std::collections::BTreeMap;
use std::io::{self, Cursor};

/// The frame of the object in the bag.
const OBJECT: &str = "object";
/// Markers a second at most: screens show no more.
const MOST_MARKERS: f64 = 100.0;
/// Length of the largest force's arrow, as a share of the reach of the contacts.
const LONGEST_ARROW: f64 = 0.5;
/// Points by which an arrow is drawn for viewers without markers.
const ALONG_ARROW: u32 = 16;
/// Nanoseconds in a second.
const SECOND: i64 = 1_000_000_000;

/// What a bag of results holds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ResultBag<'a> {
    /// Time at which that of the samples is zero, ns since the epoch of the clock.
    pub epoch: i64,
    /// Times of the samples, s.
    pub times: &'a [f64],
    /// Motion at the samples.
    pub motion: Vec<ResultPose>,
    /// Contacts of each palm at the samples.
    pub contacts: Vec<Vec<Option<ResultContact>>>,
    /// Contact points in body axes, m.
    pub curves: Vec<DVec3>,
    /// Bounds of the shape in body axes, m.
    pub lower: Option<&'a TriangleMesh>,
    /// The upper one.
    pub upper: Option<&'a TriangleMesh>,
}

/// Where the body is at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResultPose {
    /// Centre of mass, m.
    pub p_WCm: DVec3,
    /// Orientation, body to world.
    pub R_WO: DQuat,
    /// Covariance of position (m) and turn (rad), world axes, where it is known; one of zeros says that it is not.
    pub covariance: Option<[[f64; 6]; 6]>,
}

/// Where a palm touches the object, and how it pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResultContact {
    /// Contact, m, world.
    pub p_WC: DVec3,
    /// Force on the object, N, world axes, where it is known.
    pub force: Option<DVec3>,
}

impl ResultBag<'_> {
    /// Points by which a bound is drawn for viewers without markers, about: they stand a few pixels apart on a screen.
    pub const OVER_BOUND: usize = 10_000;

    /// The bag, whole: profile `ros2`, messages in CDR, chunks packed by zstd.
    ///
    /// Topics: `/tf` (`object` in `world`), `/recon/pose` with covariance, `/recon/palm_i/contact` (`recon_msgs/msg/Contact`), `/recon/markers`
    /// (contacts and forces, at most 100 a second), `/recon/contacts` and `/recon/forces` (their points and
    /// points along the arrows, as often, for viewers without markers), `/recon/bounds` (meshes), `/recon/lower_bound` and
    /// `/recon/upper_bound` (corners and points all over them, for the same viewers), `/recon/contact_curves`.
    ///
    /// # Errors
    /// Those of packing, which a whole memory has none of.
    pub fn bytes(&self) -> io::Result<Vec<u8>> {
        let mut to = Cursor::new(Vec::new());
        let options =
            mcap::WriteOptions::new().profile("ros2").library(concat!("recon/", env!("CARGO_PKG_VERSION")));
        let mut bag =
            Writer { to: options.create(&mut to).map_err(io::Error::other)?, channels: BTreeMap::new() };
        self.still(&mut bag)?;
        let stride = self.marker_stride();
        let scale = self.arrow_scale();
        for (k, &t) in self.times.iter().enumerate() {
            let time = self.time(t);
            self.pose(&mut bag, k, time)?;
            self.contacts(&mut bag, k, time)?;
            if k % stride == 0 {
                let markers = self.markers(k, time, scale);
                bag.write("/recon/markers", Definition::MarkerArray, time, &encode::markers(&markers))?;
                let clouds = [("contacts", self.touched(k)), ("forces", self.along_arrows(k, scale))];
                for (name, points) in clouds {
                    let cloud = encode::cloud(Header { time, frame: "world" }, &points);
                    bag.write(&format!("/recon/{name}"), Definition::PointCloud2, time, &cloud)?;
                }
            }
        }
        bag.to.finish().map_err(io::Error::other)?;
        drop(bag);
        Ok(to.into_inner())
    }

    /// What does not change, in the axes of the body.
    fn still(&self, bag: &mut Writer<'_>) -> io::Result<()> {
        let time = self.time(self.times.first().copied().unwrap_or(0.0));
        let header = Header { time, frame: OBJECT };
        let mut meshes = Vec::new();
        let bounds =
            [("lower", self.lower, [0.2, 0.6, 0.2, 1.0]), ("upper", self.upper, [0.3, 0.5, 0.9, 0.25])];
        for (id, (name, mesh, color)) in bounds.into_iter().enumerate() {
            let Some(mesh) = mesh else { continue };
            let corner = |index: &u32| mesh.vertices.get(*index as usize).copied();
            let points: Vec<DVec3> = mesh.triangles.iter().flatten().filter_map(corner).collect();
            let topic = format!("/recon/{name}_bound");
            bag.write(
                &topic,
                Definition::PointCloud2,
                time,
                &encode::cloud(header, &mesh.spread(Self::OVER_BOUND)),
            )?;
            meshes.push(Marker::triangles(header, name, id, points).with_frame(color));
        }
        bag.write("/recon/bounds", Definition::MarkerArray, time, &encode::markers(&meshes))?;
        bag.write(
            "/recon/contact_curves",
            Definition::PointCloud2,
            time,
            &encode::cloud(header, &self.curves),
        )
    }

    fn pose(&self, bag: &mut Writer<'_>, k: usize, time: i64) -> io::Result<()> {
        let Some(pose) = self.motion.get(k) else { return Ok(()) };
        let header = Header { time, frame: "world" };
        let place = (pose.p_WCm, pose.R_WO);
        bag.write("/tf", Definition::TFMessage, time, &encode::transform(header, OBJECT, place))?;
        let message = encode::pose_with_covariance(header, place, pose.covariance);
        bag.write("/recon/pose", Definition::PoseWithCovarianceStamped, time, &message)
    }

    fn contacts(&self, bag: &mut Writer<'_>, k: usize, time: i64) -> io::Result<()> {
        let header = Header { time, frame: "world" };
        for (i, palm) in self.contacts.iter().enumerate() {
            let contact = palm.get(k).copied().flatten();
            let contact = contact.map(|c| (c.p_WC, c.force.unwrap_or_default()));
            let topic = format!("/recon/palm_{}/contact", i + 1);
            bag.write(&topic, Definition::Contact, time, &encode::contact(header, contact))?;
        }
        Ok(())
    }

    /// Where palms touch the object.
    fn touched(&self, k: usize) -> Vec<DVec3> {
        let contacts = self.contacts.iter().filter_map(|palm| palm.get(k).copied().flatten());
        contacts.map(|contact| contact.p_WC).collect()
    }

    /// Points from the tail of each force's arrow to where it pushes.
    fn along_arrows(&self, k: usize, scale: f64) -> Vec<DVec3> {
        let contacts = self.contacts.iter().filter_map(|palm| palm.get(k).copied().flatten());
        let arrow = |contact: ResultContact| {
            let force = contact.force.filter(|force| *force != DVec3::ZERO)?;
            let at = move |j: u32| (f64::from(j) / f64::from(ALONG_ARROW) - 1.0) * scale * force;
            Some((0..=ALONG_ARROW).map(move |j| contact.p_WC + at(j)))
        };
        contacts.filter_map(arrow).flatten().collect()
    }

    /// A ball at each contact and an arrow for its force; where there is none, what was there is taken away.
    fn markers(&self, k: usize, time: i64, scale: f64) -> Vec<Marker<'static>> {
        let header = Header { time, frame: "world" };
        let size = 0.03 * self.reach();
        let mut markers = Vec::new();
        for (i, palm) in self.contacts.iter().enumerate() {
            let contact = palm.get(k).copied().flatten();
            match contact {
                None => {
                    markers.extend([Marker::gone(header, "contacts", i), Marker::gone(header, "forces", i)])
                }
                Some(ResultContact { p_WC: at, force }) => {
                    markers.push(Marker::ball(header, "contacts", i, at, size));
                    let force = force.filter(|force| *force != DVec3::ZERO && scale > 0.0);
                    // The arrow ends where it pushes.
                    markers.push(force.map_or_else(
                        || Marker::gone(header, "forces", i),
                        |force| Marker::arrow(header, "forces", i, [at - scale * force, at], 0.5 * size),
                    ));
                }
            }
        }
        markers
    }

    /// Root mean square of the distance of contact points from the centre of mass, m.
    fn reach(&self) -> f64 {
        let squares: f64 = self.curves.iter().map(|point| point.length_squared()).sum();
        if self.curves.is_empty() { 1.0 } else { (squares / self.curves.len() as f64).sqrt() }
    }

    /// Metres of an arrow for a newton.
    fn arrow_scale(&self) -> f64 {
        let forces = self.contacts.iter().flatten().flatten().filter_map(|contact| contact.force);
        let largest = forces.map(DVec3::length).fold(0.0, f64::max);
        if largest > 0.0 { LONGEST_ARROW * self.reach() / largest } else { 0.0 }
    }

    fn marker_stride(&self) -> usize {
        let duration = self.times.last().zip(self.times.first()).map_or(0.0, |(last, first)| last - first);
        let most = (duration * MOST_MARKERS).max(1.0);
        // A cast from f64 saturates.
        ((self.times.len().saturating_sub(1) as f64 / most).ceil() as usize).max(1)
    }

    fn time(&self, t: f64) -> i64 {
        self.epoch.saturating_add((t * SECOND as f64).round() as i64)
    }
}

struct Writer<'a> {
    to: mcap::Writer<&'a mut Cursor<Vec<u8>>>,
    /// Number and messages so far of each topic.
    channels: BTreeMap<String, (u16, u32)>,
}

impl Writer<'_> {
    fn write(&mut self, topic: &str, definition: Definition, time: i64, message: &[u8]) -> io::Result<()> {
        if !self.channels.contains_key(topic) {
            let schema = self.to.add_schema(definition.name(), "ros2msg", definition.text().as_bytes());
            let schema = schema.map_err(io::Error::other)?;
            let channel =
                self.to.add_channel(schema, topic, "cdr", &BTreeMap::new()).map_err(io::Error::other)?;
            self.channels.insert(topic.to_owned(), (channel, 0));
        }
        let Some((channel_id, count)) = self.channels.get_mut(topic) else { return Ok(()) };
        let (log_time, sequence) = (u64::try_from(time).unwrap_or(0), *count);
        *count = count.wrapping_add(1);
        let header = MessageHeader { channel_id: *channel_id, sequence, log_time, publish_time: log_time };
        self.to.write_to_known_channel(&header, message).map_err(io::Error::other)
    }
}

#[cfg(test)]
mod tests;
