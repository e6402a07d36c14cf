use thiserror::Error;

/// Mass and moment of inertia of a planar object about its centre of mass, both positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlanarMass {
    mass: f64,
    inertia: f64,
}

/// A mass property that no object has.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
#[error("{what} is {value}; it must be positive and finite")]
pub struct PlanarMassError {
    /// Which property.
    pub what: &'static str,
    /// As given, SI.
    pub value: f64,
}

impl PlanarMass {
    /// From the mass (kg) and the moment of inertia about the centre of mass (kg m^2).
    ///
    /// # Errors
    /// [`PlanarMassError`] names the number that is not positive and finite.
    pub fn new(mass: f64, inertia: f64) -> Result<Self, PlanarMassError> {
        for (what, value) in [("mass", mass), ("moment of inertia", inertia)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(PlanarMassError { what, value });
            }
        }
        Ok(Self { mass, inertia })
    }

    /// From the mass (kg) and the squared radius of gyration (m^2).
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn from_gyration(mass: f64, gyration_squared: f64) -> Result<Self, PlanarMassError> {
        if !(gyration_squared > 0.0 && gyration_squared.is_finite()) {
            return Err(PlanarMassError { what: "squared radius of gyration", value: gyration_squared });
        }
        Self::new(mass, mass * gyration_squared)
    }

    /// Mass in kg.
    #[must_use]
    pub fn mass(&self) -> f64 {
        self.mass
    }

    /// Moment of inertia about the centre of mass in kg m^2.
    #[must_use]
    pub fn inertia(&self) -> f64 {
        self.inertia
    }

    /// Squared radius of gyration `I0 / m` in m^2.
    #[must_use]
    pub fn gyration_squared(&self) -> f64 {
        self.inertia / self.mass
    }
}
