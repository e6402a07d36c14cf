//! How right odds of sliding and sticking are.

use recon::object_dynamics::ContactMode;
use recon::observer::contact_modes::ContactOdds;

/// Probability above which a mode counts as told with confidence.
const CONFIDENT: f64 = 0.99;

/// One contact at one sample.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// Which contact.
    pub contact: usize,
    /// What is true.
    pub slides: bool,
    /// How probable it was held that it slides, given that it touches.
    pub odds: f64,
    /// Whether the likeliest mode and the label are true.
    pub right: [bool; 2],
}

/// All that was told.
#[derive(Clone, Debug, Default)]
pub struct Score {
    /// In order of time.
    pub told: Vec<Told>,
}

impl Score {
    pub(crate) fn take(
        &mut self,
        contact: usize,
        slides: bool,
        odds: Option<ContactOdds>,
        label: Option<ContactMode>,
    ) {
        let Some(ContactOdds { off, slide, stick }) = odds else { return };
        let right = if slides { slide > stick.max(off) } else { stick > slide.max(off) };
        let labelled = label == Some(if slides { ContactMode::Slide } else { ContactMode::Stick });
        self.told.push(Told { contact, slides, odds: slide / (slide + stick), right: [right, labelled] });
    }

    fn share(&self, of: impl Fn(&Told) -> f64) -> f64 {
        self.told.iter().map(of).sum::<f64>() / self.told.len() as f64
    }

    /// Share of samples at which the likeliest mode is true.
    #[must_use]
    pub fn right(&self) -> f64 {
        self.share(|told| f64::from(u8::from(told.right[0])))
    }

    /// The same of the label.
    #[must_use]
    pub fn labelled_right(&self) -> f64 {
        self.share(|told| f64::from(u8::from(told.right[1])))
    }

    /// Share of all samples that are told with more than 0.99 and wrong.
    #[must_use]
    pub fn confident_and_wrong(&self) -> f64 {
        self.share(|told| {
            let wrong = if told.slides { 1.0 - told.odds } else { told.odds };
            f64::from(u8::from(wrong > CONFIDENT))
        })
    }

    /// Mean squared distance of the probability of sliding from the truth.
    #[must_use]
    pub fn brier(&self) -> f64 {
        self.share(|told| (told.odds - f64::from(u8::from(told.slides))).powi(2))
    }
}
