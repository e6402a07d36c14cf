use glam::DVec3;
use thiserror::Error;

/// Why an object cannot be exported.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum ExportError {
    /// A name that does not do for files and elements.
    #[error("`{name}` cannot name a model; use letters, digits, `_` and `-`")]
    Name {
        /// As given.
        name: String,
    },
    /// A semi-axis is no length.
    #[error("a semi-axis of the ellipsoid is {value} m; it must be positive and finite")]
    SemiAxis {
        /// As given, m.
        value: f64,
    },
    /// The ellipsoid is nowhere.
    #[error("the ellipsoid's centre ({}, {}, {}) or orientation is not finite", centre.x, centre.y, centre.z)]
    Place {
        /// As given, m.
        centre: DVec3,
    },
    /// A surface that simulators refuse.
    #[error("the {name} surface is not closed: {open} of its edges belong to one triangle only")]
    Open {
        /// Which surface.
        name: String,
        /// Edges without a neighbour.
        open: usize,
    },
    /// A surface without vertices or triangles.
    #[error("the {name} surface is empty")]
    Empty {
        /// Which surface.
        name: String,
    },
    /// Dampers of MuJoCo's slides act along them alone.
    #[error(
        "damping of palm {palm}'s spring couples the principal axes of its stiffness, by {coupling:.1e} N s/m; MuJoCo's dampers \
         do not: give both matrices the same axes"
    )]
    Damping {
        /// Palm from 1.
        palm: usize,
        /// Largest entry beside the diagonal, N s/m.
        coupling: f64,
    },
    /// There is no bound of the kind that was asked for.
    #[error("there is no {name} bound to export: {reason}")]
    NoBound {
        /// Which bound.
        name: &'static str,
        /// Why.
        reason: &'static str,
    },
}
