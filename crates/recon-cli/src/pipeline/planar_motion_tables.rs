//! Tables of a motion that was estimated in the plane.

use super::folder::Extra;
use super::planar_motion::PlanarMotion;
use crate::error::CliError;
use recon::object_dynamics::planar::BodyState;
use recon_io::{POSE_IN_PLANE, mode_columns, push_modes, write_covariances};
use std::io::{self, Write};

impl PlanarMotion {
    /// The motion, a row a sample.
    pub(crate) fn write_motion(&self, to: &mut dyn Write) -> io::Result<()> {
        let palms = self.estimate.contacts.len();
        write!(to, "t,x,y,phi0,vx,vy,omega0,std_x,std_y,std_phi0,std_vx,std_vy,std_omega0")?;
        let odds = self.estimate.mode_odds.as_ref().map(|found| &found.odds);
        writeln!(to, "{},relied_on", mode_columns(palms, odds.is_some()))?;
        let mut modes = String::new();
        for (k, sample) in self.log.samples().iter().enumerate() {
            let BodyState { p_WCm: p, phi0, v_WCm: v, omega0 } = self.estimate.states[k];
            let of = self.estimate.deviations[k];
            write!(to, "{:?},{:?},{:?},{phi0:?},{:?},{:?},{omega0:?}", sample.t, p.x, p.y, v.x, v.y)?;
            write!(to, ",{:?},{:?},{:?}", of.p_WCm.x, of.p_WCm.y, of.phi0)?;
            write!(to, ",{:?},{:?},{:?}", of.v_WCm.x, of.v_WCm.y, of.omega0)?;
            modes.clear();
            push_modes(&mut modes, &self.estimate.modes[k][..palms], odds.map(|odds| &odds[k][..palms]));
            writeln!(to, "{modes},{}", u8::from(self.estimate.relied_on[k]))?;
        }
        Ok(())
    }

    /// The table of the covariances of all poses, as a file.
    pub(crate) fn covariances(&self) -> Result<Extra, CliError> {
        let times: Vec<f64> = self.log.samples().iter().map(|sample| sample.t).collect();
        let mut table = Vec::new();
        write_covariances(POSE_IN_PLANE, &times, &self.estimate.pose_covariances, &mut table)
            .map_err(CliError::Page)?;
        Ok(("covariance.csv".to_owned(), table))
    }

    /// The radius function at the contact of each palm, m: `nan` where it is not touched.
    pub(crate) fn write_radii(&self, to: &mut dyn Write) -> io::Result<()> {
        write!(to, "t")?;
        (1..=self.estimate.contacts.len()).try_for_each(|i| write!(to, ",r_{i}"))?;
        writeln!(to)?;
        for (k, sample) in self.log.samples().iter().enumerate() {
            write!(to, "{:?}", sample.t)?;
            for contacts in &self.estimate.contacts {
                write!(to, ",{}", contacts[k].map_or("nan".to_owned(), |c| format!("{:?}", c.radius)))?;
            }
            writeln!(to)?;
        }
        Ok(())
    }

    /// The shape, point by point, at samples that are relied on.
    pub(crate) fn write_points(&self, to: &mut dyn Write) -> io::Result<()> {
        writeln!(to, "palm,t,x,y,nx,ny")?;
        for (i, contacts) in self.estimate.contacts.iter().enumerate() {
            let rows = self.log.samples().iter().zip(contacts).zip(&self.estimate.relied_on);
            for ((sample, contact), relied_on) in rows {
                if let Some(c) = contact.filter(|_| *relied_on) {
                    let (p, n) = (c.p_OC, c.normal);
                    writeln!(to, "{},{:?},{:?},{:?},{:?},{:?}", i + 1, sample.t, p.x, p.y, n.x, n.y)?;
                }
            }
        }
        Ok(())
    }
}
