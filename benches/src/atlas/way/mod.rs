//! The ways of failing, each with its strengths from harmless to hopeless.

mod entries;

/// A way of failing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// Two palms turn towards one vertical plane.
    Parallel,
    /// Palms towards the horizontal.
    Flat,
    /// Palms towards the vertical.
    Steep,
    /// Body towards a ball, or a disc.
    Sphere,
    /// Body towards one of revolution.
    Revolution,
    /// A contact's normal towards the pole of the paper's chart of the sphere, `theta_2 = pi/2`.
    Pole,
    /// A palm turns as fast as the body does, and faster: their relative rotation goes through zero.
    Relative,
    /// Spin, until contact forces reach zero and contact is lost.
    Force,
    /// Dropped: contacts begin one after the other, with blows.
    Drop,
    /// A log that goes on after contact is lost, which is marked.
    Loss,
    /// The same with sensors that hold the last contact.
    Held,
    /// Forces from torques of motors, contacts towards the hinge: `s_i2` to zero.
    Hinge,
    /// Let go where it lies lowest, with less and less spin.
    Slow,
    /// Length of the log.
    Window,
    /// Error of a start that must be given.
    Start,
    /// Noise as it is stated.
    Noise,
    /// Noise beyond what is stated.
    Unstated,
    /// A force sensor's bias.
    Bias,
    /// A force sensor's gain.
    Gain,
    /// Late forces.
    Delay,
    /// Noise that is alike from one sample to the next.
    Correlation,
    /// Contacts at taxels.
    Taxels,
    /// Contacts that are far off.
    Outliers,
    /// A gap in the samples.
    Gap,
    /// Samples that are missing here and there.
    Dropped,
    /// Samples for each natural time.
    Rate,
    /// Mass stated too large.
    Mass,
    /// Inertia stated too large.
    Inertia,
    /// A palm's orientation stated wrongly.
    Palm,
    /// Friction where none is stated.
    Friction,
    /// Palms that shake: small and faster and faster.
    Shaking,
    /// Long runs.
    Long,
    /// Palms that rub and swing faster and faster: contact modes switch.
    Switches,
    /// Size of the body.
    Size,
    /// Contacts that there are.
    Contacts,
    /// Normals of all contacts within a cone.
    Cone,
    /// Tolerance that is asked of an integrator.
    Tolerance,
    /// A limit on the curvature that is wrong.
    Limit,
    /// A body that is not of the family that is fitted.
    Family,
    /// A stated friction that is wrong.
    Coefficient,
}

impl Way {
    /// All of them.
    pub const ALL: &[Self] = &[
        Self::Parallel,
        Self::Flat,
        Self::Steep,
        Self::Sphere,
        Self::Revolution,
        Self::Pole,
        Self::Relative,
        Self::Force,
        Self::Drop,
        Self::Loss,
        Self::Held,
        Self::Hinge,
        Self::Slow,
        Self::Window,
        Self::Start,
        Self::Noise,
        Self::Unstated,
        Self::Bias,
        Self::Gain,
        Self::Delay,
        Self::Correlation,
        Self::Taxels,
        Self::Outliers,
        Self::Gap,
        Self::Dropped,
        Self::Rate,
        Self::Mass,
        Self::Inertia,
        Self::Palm,
        Self::Friction,
        Self::Shaking,
        Self::Long,
        Self::Switches,
        Self::Size,
        Self::Contacts,
        Self::Cone,
        Self::Tolerance,
        Self::Limit,
        Self::Family,
        Self::Coefficient,
    ];

    /// In words.
    #[must_use]
    pub fn words(self) -> &'static str {
        self.entry().words
    }

    /// One word for the command line and tables.
    #[must_use]
    pub fn word(self) -> &'static str {
        self.entry().word
    }

    /// Unit of its strengths.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.entry().unit
    }

    /// From harmless to hopeless.
    #[must_use]
    pub fn strengths(self) -> &'static [f64] {
        self.entry().strengths
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_has_its_own_word_and_strengths_that_go_one_way() {
        for (k, way) in Way::ALL.iter().enumerate() {
            assert!(Way::ALL[..k].iter().all(|other| other.word() != way.word()), "{way:?}");
            let strengths = way.strengths();
            assert_eq!(strengths.len(), 8, "{way:?}");
            let up = strengths[1] > strengths[0];
            assert!(strengths.windows(2).all(|pair| (pair[1] > pair[0]) == up), "{way:?}");
        }
    }
}
