//! Words, unit and strengths of each way.

use super::Way;

/// What is known of a way.
pub(super) struct Entry {
    pub(super) words: &'static str,
    pub(super) word: &'static str,
    pub(super) unit: &'static str,
    pub(super) strengths: &'static [f64],
}

const SHARES: &[f64] = &[1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0];
const DEPARTURES: &[f64] = &[0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 1e-3, 0.0];
const LOST: &[f64] = &[0.004, 0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5];
const SLOPES: &[f64] = &[45.0, 30.0, 20.0, 10.0, 5.0, 2.0, 1.0, 0.2];

macro_rules! entry {
    ($word:literal, $words:literal, $unit:literal, $strengths:expr) => {
        Entry { words: $words, word: $word, unit: $unit, strengths: $strengths }
    };
}

impl Way {
    pub(super) fn entry(self) -> Entry {
        match self {
            Self::Parallel => entry!(
                "parallel",
                "palms towards parallel: angle between two",
                "degrees",
                &[120.0, 60.0, 30.0, 15.0, 8.0, 4.0, 1.0, 0.1]
            ),
            Self::Flat => entry!("flat", "palms towards flat: slope", "degrees", SLOPES),
            Self::Steep => entry!(
                "steep",
                "palms towards steep: slope",
                "degrees",
                &[60.0, 70.0, 75.0, 80.0, 85.0, 88.0, 89.0, 89.9]
            ),
            Self::Sphere => {
                entry!("sphere", "body towards a ball or disc: axes 1, 1 + d, 1 + 2 d", "d", DEPARTURES)
            }
            Self::Revolution => {
                entry!("revolution", "body towards one of revolution: axes 1, 1 + d, 2", "d", DEPARTURES)
            }
            Self::Pole => entry!(
                "pole",
                "a normal towards theta_2 = pi/2",
                "rad",
                &[0.3, 0.1, 0.03, 0.01, 1e-3, 1e-6, 1e-9, 0.0]
            ),
            Self::Relative => entry!(
                "relative",
                "a palm's rate over the body's: rotation through zero",
                "1",
                &[0.0, 0.2, 0.5, 0.8, 1.0, 1.5, 3.0, 6.0]
            ),
            Self::Force => entry!(
                "force",
                "spin, to where forces vanish and contact ends",
                "natural",
                &[0.1, 0.3, 0.5, 0.8, 1.1, 1.5, 2.0, 3.0]
            ),
            Self::Drop => entry!(
                "drop",
                "contact lost and back: height of fall",
                "sizes",
                &[1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3]
            ),
            Self::Loss => entry!("loss", "contact lost, log goes on for", "s", LOST),
            Self::Held => entry!("held", "contact lost and not marked, log goes on for", "s", LOST),
            Self::Hinge => entry!("hinge", "forces from torques, s_i2 towards 0: slope", "degrees", SLOPES),
            Self::Slow => entry!(
                "slow",
                "towards rest: spin where it lies lowest",
                "natural",
                &[0.3, 0.1, 0.03, 0.01, 1e-3, 1e-4, 1e-6, 0.0]
            ),
            Self::Window => {
                entry!("window", "short window", "natural times", &[12.0, 8.0, 6.0, 5.0, 4.0, 3.0, 1.5, 0.3])
            }
            Self::Start => {
                entry!("start", "wrong start", "natural", &[1e-9, 1e-7, 1e-5, 1e-4, 1e-3, 0.01, 0.1, 1.0])
            }
            Self::Noise => entry!(
                "noise",
                "noise of contacts and forces",
                "sizes, weights",
                &[0.0, 1e-5, 1e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1]
            ),
            Self::Unstated => entry!(
                "unstated",
                "noise over what is stated of it",
                "1",
                &[1.0, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0, 30.0]
            ),
            Self::Bias => {
                entry!("bias", "bias of a force", "weights", &[3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3, 1.0])
            }
            Self::Gain => entry!("gain", "gain of a force off by", "1", SHARES),
            Self::Delay => entry!(
                "delay",
                "forces late by",
                "natural times",
                &[3e-3, 0.01, 0.03, 0.07, 0.15, 0.3, 0.6, 1.2]
            ),
            Self::Correlation => entry!(
                "correlation",
                "noise alike from sample to sample",
                "1",
                &[0.0, 0.3, 0.5, 0.7, 0.9, 0.95, 0.99, 0.999]
            ),
            Self::Taxels => entry!(
                "taxels",
                "contacts quantised",
                "sizes",
                &[1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3]
            ),
            Self::Outliers => entry!(
                "outliers",
                "share of contacts a fifth of the size off",
                "1",
                &[1e-3, 3e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5]
            ),
            Self::Gap => entry!(
                "gap",
                "gap in the samples",
                "natural times",
                &[0.1, 0.3, 0.5, 1.0, 2.0, 3.0, 5.0, 8.0]
            ),
            Self::Dropped => entry!(
                "dropped",
                "share of the samples missing",
                "1",
                &[0.05, 0.1, 0.2, 0.4, 0.6, 0.8, 0.9, 0.95]
            ),
            Self::Rate => entry!(
                "rate",
                "samples in a natural time",
                "1",
                &[50.0, 30.0, 20.0, 14.0, 10.0, 5.0, 2.0, 1.0]
            ),
            Self::Mass => entry!("mass", "mass stated too large by", "1", SHARES),
            Self::Inertia => entry!("inertia", "inertia stated too large by", "1", SHARES),
            Self::Palm => entry!(
                "palm",
                "a palm's pose off by",
                "degrees",
                &[0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0, 30.0]
            ),
            Self::Friction => entry!(
                "friction",
                "friction where none is stated",
                "1",
                &[1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3]
            ),
            Self::Shaking => entry!(
                "shaking",
                "palms that shake: rate",
                "natural",
                &[1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0]
            ),
            Self::Long => entry!(
                "long",
                "long runs",
                "natural times",
                &[12.0, 20.0, 30.0, 40.0, 60.0, 80.0, 120.0, 160.0]
            ),
            Self::Switches => entry!(
                "switches",
                "contact modes switch: rate of palms that rub",
                "natural",
                &[0.1, 0.2, 0.4, 0.7, 1.0, 1.5, 2.0, 3.0]
            ),
            Self::Size => entry!("size", "size", "m", &[0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0]),
            Self::Contacts => {
                entry!("contacts", "few contacts", "1", &[300.0, 100.0, 60.0, 30.0, 15.0, 8.0, 4.0, 1.0])
            }
            Self::Cone => entry!(
                "cone",
                "normals within a cone of half angle",
                "degrees",
                &[180.0, 120.0, 90.0, 60.0, 30.0, 10.0, 3.0, 0.1]
            ),
            Self::Tolerance => entry!(
                "tolerance",
                "tolerance of the integrator",
                "1",
                &[1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-7, 1e-5, 1e-3]
            ),
            Self::Limit => entry!("limit", "limits of the curvature too narrow by", "1", SHARES),
            Self::Family => entry!(
                "family",
                "body not of the family: bulge",
                "sizes",
                &[0.0, 1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1]
            ),
            Self::Coefficient => entry!("coefficient", "friction stated too large by", "1", SHARES),
        }
    }
}
