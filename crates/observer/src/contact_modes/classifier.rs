//! The way of a sample.

use super::bins::Bins;
use super::contact::{Contact, Force, Modes, SlipRead};
use super::density::Slip;
use super::doubt::{ContactModesDoubt, Left, Told};
use super::error::ContactModesError;
use super::foretold::Foretold;
use super::friction::{ContactFriction, FrictionGrid, LearnedFriction, together};
use super::late::{Brought, Late};
use super::options::ContactModesOptions;
use super::reading::{ContactReading, ContactSeen, ContactSlip, turned};
use super::steps::speeds;
use super::twist::{Row, TwistError, left_out};
use crate::bank::ModeLabel;
use nalgebra::{Matrix2, Matrix6, Vector2};
use object_dynamics::ContactMode;

/// Longest time step, s.
pub(super) const LONGEST: f64 = 1000.0;
/// Time before the first sample for which modes are drawn, s: the start is no switch, and any will do.
pub(super) const FIRST: f64 = 1e-3;
/// Times that each contact's odds are set from what the others then say of the twist.
const SWEEPS: usize = 3;

/// Probabilities of the modes of a contact. They sum to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactOdds {
    /// That it does not touch.
    pub off: f64,
    /// That it slides.
    pub slide: f64,
    /// That it sticks.
    pub stick: f64,
}

/// Tells sample by sample whether contacts slide, stick or are off, and how sure that is. A sample allocates nothing.
///
/// Between near its friction cone and slow sliding little is to be seen: then probabilities stay between the two for as long
/// as it takes. Limits and figures: `docs/contact-modes.md` of the repository.
#[derive(Clone, Debug)]
pub struct ContactModes {
    pub(super) options: ContactModesOptions,
    /// Of the speed of sliding.
    speeds: Bins,
    grids: Vec<FrictionGrid>,
    /// The grid of each contact.
    grid_of: Vec<usize>,
    pub(super) contacts: Vec<Contact>,
    odds: Vec<Modes>,
    labels: Vec<ModeLabel>,
    told: Vec<ContactMode>,
    rows: Vec<Row>,
    /// Of the last sample.
    forces: Vec<Force>,
    /// What the ratios of each contact say of the next one.
    foretold: Vec<Foretold>,
    /// The same, in the world's axes and in natural units.
    slips: Vec<Option<(ContactSlip, Slip)>>,
    left: Vec<Left>,
    pub(super) samples: usize,
}

impl ContactModes {
    /// For contacts of these frictions, which all begin with every mode alike.
    ///
    /// # Errors
    /// Where there is no contact, a friction is not from 1e-3 to 10, or an option is not usable.
    pub fn new(
        frictions: &[ContactFriction],
        options: ContactModesOptions,
    ) -> Result<Self, ContactModesError> {
        Self::every(FIRST, frictions, options)
    }

    /// The same for samples that come every `dt`, s: walks for that are made at once, and not at the second sample.
    pub(crate) fn every(
        dt: f64,
        frictions: &[ContactFriction],
        options: ContactModesOptions,
    ) -> Result<Self, ContactModesError> {
        options.check()?;
        let label = ModeLabel::new(options.label_level)?;
        if frictions.is_empty() {
            return Err(ContactModesError::NoContact);
        }
        let (mut grids, mut grid_of): (Vec<FrictionGrid>, Vec<usize>) = (Vec::new(), Vec::new());
        for (contact, friction) in frictions.iter().enumerate() {
            let same = match *friction {
                ContactFriction::Known(value) if !(1e-3..=10.0).contains(&value) => {
                    return Err(ContactModesError::Friction { contact, value });
                }
                ContactFriction::Known(_) => None,
                of => grids.iter().position(|grid| grid.of == of),
            };
            grid_of.push(same.unwrap_or(grids.len()));
            if same.is_none() {
                grids.push(FrictionGrid::new(*friction, dt));
            }
        }
        let count = frictions.len();
        let late = |grid: &usize| {
            let grid = &grids[*grid];
            matches!(grid.of, ContactFriction::Known(_))
                .then(|| Late::new(&grid.steps[0], options.natural_speed))
        };
        let left = grid_of.iter().map(|grid| Left::new(late(grid))).collect();
        Ok(Self {
            options,
            contacts: grid_of.iter().map(|grid| Contact::new(&grids[*grid])).collect(),
            speeds: speeds(),
            grids,
            grid_of,
            odds: vec![[1.0 / 3.0; 3]; count],
            labels: vec![label; count],
            told: vec![ContactMode::Off; count],
            rows: vec![Row::NONE; count],
            forces: vec![Force::Silent; count],
            foretold: vec![Foretold::default(); count],
            slips: vec![None; count],
            left,
            samples: 0,
        })
    }

    /// Takes a sample, `dt` seconds after the one before (before the first, any time above zero), with slips whose errors are
    /// independent of each other. Returns the logarithm of its density given all before: forces in N, ratios as such, slips in
    /// natural speeds, raised to a power where their errors last ([`ContactModesOptions::slip_errors_last`]). What was not read has no density; a contact that is known
    /// to be off, or does not press, has that of its being off.
    ///
    /// # Errors
    /// Where time does not go on, or a reading is missing, not a number, has no noise or is beyond reason; then everything stays
    /// as it was before.
    pub fn push(&mut self, dt: f64, seen: &[ContactSeen]) -> Result<f64, ContactModesError> {
        self.check(dt, seen)?;
        self.advance(dt, seen);
        self.weigh(dt, seen, None);
        Ok(self.settle(dt, seen))
    }

    /// The same, where all slips come from one twist: the covariance of each is that of its own error alone, and what the twist's
    /// error adds is learned from the other contacts, as far as they stick. The density that is returned takes slips one
    /// by one, each given the others; it is not that of all of them.
    ///
    /// # Errors
    /// As [`Self::push`], and where the twist's covariance is not positive definite, or there is not a slope for each contact.
    pub fn push_with_twist(
        &mut self,
        dt: f64,
        seen: &[ContactSeen],
        twist: &TwistError<'_>,
    ) -> Result<f64, ContactModesError> {
        self.check(dt, seen)?;
        let information = self.check_twist(twist)?;
        self.advance(dt, seen);
        self.weigh(dt, seen, Some((twist, &information)));
        Ok(self.settle(dt, seen))
    }

    /// Of a contact after the last sample; none of one that there is not.
    #[must_use]
    pub fn odds(&self, contact: usize) -> Option<ContactOdds> {
        self.odds.get(contact).map(|&[off, slide, stick]| ContactOdds { off, slide, stick })
    }

    /// The mode to act on: it changes only where another is more likely than [`ContactModesOptions::label_level`]. None of a
    /// contact that there is not, and before the first sample.
    #[must_use]
    pub fn label(&self, contact: usize) -> Option<ContactMode> {
        if self.samples == 0 { None } else { self.told.get(contact).copied() }
    }

    /// The friction of a contact that was not known: none before one of its material has slid, with slips read, for 10 ms with a
    /// probability of 0.99, for what sticks has only a lower bound; none where it was stated.
    #[must_use]
    pub fn friction(&self, contact: usize) -> Option<LearnedFriction> {
        let grid = self.grids.get(*self.grid_of.get(contact)?)?;
        grid.learned(self.contacts.get(contact)?)
    }

    /// The same, or what was stated.
    pub(crate) fn friction_told(&self, contact: usize) -> Option<f64> {
        let grid = self.grids.get(*self.grid_of.get(contact)?)?;
        grid.told(self.contacts.get(contact)?)
    }

    /// What contradicts that readings are as stated, of each contact the clearest: odds of a contact that is doubted can be sure and wrong.
    /// Figures, and what is not seen (forces that are late): `docs/contact-modes.md` of the repository.
    pub fn doubts(&self) -> impl Iterator<Item = ContactModesDoubt> + '_ {
        let slips_last = self.options.slip_errors_last > 0.0;
        self.left.iter().enumerate().filter_map(move |(contact, left)| left.doubt(contact, slips_last))
    }

    /// Samples taken.
    #[must_use]
    pub fn samples(&self) -> usize {
        self.samples
    }

    /// A time step on, and what forces say.
    fn advance(&mut self, dt: f64, seen: &[ContactSeen]) {
        if self.samples > 0 {
            self.grids.iter_mut().for_each(|grid| grid.follow(dt));
        }
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let grid = &self.grids[self.grid_of[i]];
            contact.predict(grid);
            self.forces[i] = seen[i].force(&self.options);
            self.foretold[i].tell(dt, &mut self.forces[i]);
        }
    }

    /// Forces and slips.
    fn weigh(&mut self, dt: f64, seen: &[ContactSeen], twist: Option<(&TwistError<'_>, &Matrix6<f64>)>) {
        let weight = self.options.slip_weight(dt);
        if let Some((twist, information)) = twist {
            for i in 0..self.contacts.len() {
                let grid = &self.grids[self.grid_of[i]];
                self.contacts[i].weigh(&self.forces[i], None, grid, &self.speeds);
                self.odds[i] = self.contacts[i].average();
                self.set_row(i, &seen[i], twist);
            }
            for _ in 0..SWEEPS {
                for i in 0..self.contacts.len() {
                    let Some((reading, error)) = self.shared(i, &seen[i], Some((twist, information))) else {
                        continue;
                    };
                    let (_, slip, turn) = self.slip(reading, error);
                    let read = SlipRead { slip, turn, weight };
                    self.odds[i] = self.contacts[i].try_slip(&read, &self.speeds);
                    self.set_row(i, &seen[i], twist);
                }
            }
        }
        for i in 0..self.contacts.len() {
            let read = self.shared(i, &seen[i], twist).map(|(reading, error)| self.slip(reading, error));
            self.slips[i] = read.map(|(own, slip, _)| (own, slip));
            let read = read.map(|(_, slip, turn)| SlipRead { slip, turn, weight });
            // With a twist forces have counted before.
            let force = if twist.is_some() { &Force::Silent } else { &self.forces[i] };
            self.contacts[i].weigh(force, read.as_ref(), &self.grids[self.grid_of[i]], &self.speeds);
        }
    }

    /// The reading of a contact with a slip, and what the others say of the slip's error.
    #[expect(clippy::type_complexity, reason = "mean and covariance, of two numbers")]
    fn shared<'a>(
        &self,
        i: usize,
        seen: &'a ContactSeen,
        twist: Option<(&TwistError<'_>, &Matrix6<f64>)>,
    ) -> Option<(&'a ContactReading, Option<(Vector2<f64>, Matrix2<f64>)>)> {
        let ContactSeen::Read(reading) = seen else { return None };
        reading.slip?;
        let error = twist.map(|(twist, information)| {
            let slope = &twist.slopes[i];
            // Were rounding to spoil it, there is still what the twist alone says.
            let alone = || (Vector2::zeros(), slope * twist.covariance * slope.transpose());
            left_out(&self.rows, i, information, slope).unwrap_or_else(alone)
        });
        Some((reading, error))
    }

    /// The slip without what the twist is off by, the same against and across the friction, and the deviation of that direction, rad.
    fn slip(
        &self,
        reading: &ContactReading,
        error: Option<(Vector2<f64>, Matrix2<f64>)>,
    ) -> (ContactSlip, Slip, f64) {
        let (u, turn) = reading.direction();
        let (mut velocity, mut covariance) = reading
            .slip
            .map_or((Vector2::zeros(), Matrix2::identity()), |slip| (slip.velocity, slip.covariance));
        if let Some((mean, spread)) = error {
            velocity -= mean;
            covariance += spread;
        }
        let slip = turned(&velocity, &covariance, &u, self.options.natural_speed);
        (ContactSlip { velocity, covariance }, slip, turn)
    }

    fn set_row(&mut self, i: usize, seen: &ContactSeen, twist: &TwistError<'_>) {
        self.rows[i] = match seen {
            ContactSeen::Read(ContactReading { slip: Some(slip), .. }) => Row::new(
                &twist.slopes[i],
                &slip.velocity,
                &slip.covariance,
                self.odds[i],
                self.options.natural_speed,
            ),
            _ => Row::NONE,
        };
    }

    /// Frictions, odds and labels after a sample; the logarithm of its density.
    fn settle(&mut self, dt: f64, seen: &[ContactSeen]) -> f64 {
        let mut log_density = 0.0;
        let of = &self.grid_of;
        for (g, grid) in self.grids.iter_mut().enumerate() {
            log_density += grid.gather(&mut self.contacts, |i| of[i] == g);
        }
        for (i, contact) in self.contacts.iter_mut().enumerate() {
            let ratio = seen[i].reading().and_then(ContactReading::ratio);
            ratio.iter().for_each(|ratio| contact.learn(ratio));
            self.odds[i] = contact.average();
            contact.guess.moments = contact.friction();
            // Forces alone take any plateau of the ratio for sliding: what is learned of friction needs a slip that was read.
            if self.slips[i].is_some() {
                let slides = self.odds[i][1];
                contact.guess.count(slides, dt);
                self.grids[of[i]].together.count(slides, dt);
            }
        }
        for (g, grid) in self.grids.iter_mut().enumerate() {
            let own = self.contacts.iter().zip(of).filter(|(_, own)| **own == g);
            grid.together.moments = together(own.map(|(contact, _)| contact.guess.moments));
        }
        (0..seen.len()).for_each(|i| self.tell(i, dt, &seen[i]));
        self.samples += 1;
        log_density
    }

    /// The label of a contact after a sample, and what that leaves.
    fn tell(&mut self, i: usize, dt: f64, seen: &ContactSeen) {
        let grid = &self.grids[self.grid_of[i]];
        let [off, slide, stick] = self.odds[i];
        let slip = self.slips[i].map(|(slip, _)| (slip, self.options.slip_weight(dt)));
        let told = Told {
            odds: ContactOdds { off, slide, stick },
            friction: grid.told(&self.contacts[i]),
            slip: self.slips[i].map(|(_, slip)| slip),
            brought: Brought { dt, times: grid.times, force: &self.forces[i], reading: seen.reading(), slip },
        };
        self.left[i].take(&told, grid.steps.first());
        self.told[i] = match self.labels[i].follow(self.odds[i]) {
            0 => ContactMode::Off,
            1 => ContactMode::Slide,
            _ => ContactMode::Stick,
        };
    }
}
