use std::path::PathBuf;
use thiserror::Error;

/// A mapping file that cannot be used: which file, and what is wrong with it where.
#[derive(Debug, Error)]
#[error("{}: {kind}", path.display())]
pub struct MappingError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong.
    pub kind: MappingErrorKind,
}

/// What is wrong with a mapping.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum MappingErrorKind {
    /// The file cannot be read.
    #[error("cannot be read: {0}")]
    Read(#[from] std::io::Error),
    /// Not TOML, or a key that is unknown, missing or of the wrong type; the message shows the place.
    #[error("is not a mapping of topics\n{}", crate::scene::in_words(.0))]
    Toml(#[from] toml::de::Error),
    /// A number outside of what the quantity can be.
    #[error("`{key}` is {value}; it must be {must}")]
    Value {
        /// Full path of the key.
        key: String,
        /// As given.
        value: f64,
        /// What is accepted.
        must: &'static str,
    },
    /// No palm.
    #[error(
        "has no [[palm]]; give one for each, in the order of the scene. `recon inspect` drafts a mapping"
    )]
    NoPalms,
    /// What two palms cannot share.
    #[error("`palm[{}].{key}` and `palm[{}].{key}` are both `{name}`; each palm has its own", palms[0], palms[1])]
    Shared {
        /// `frame`, `wrench` or `contact`.
        key: &'static str,
        /// The palms, from 1.
        palms: [usize; 2],
        /// What both are.
        name: String,
    },
    /// Nothing tells where a palm is touched.
    #[error(
        "`palm[{palm}]` has none of `contact`, `taxels` and `wrench`; one of them tells where it is touched"
    )]
    NoContact {
        /// Palm from 1.
        palm: usize,
    },
    /// A kind that is none.
    #[error("`palm[{palm}].kind` is `{found}`; it must be flat, sphere, cup or cylinder")]
    Shape {
        /// Palm from 1.
        palm: usize,
        /// As given.
        found: String,
    },
    /// A curved palm without a radius.
    #[error("`palm[{palm}].radius` is not given; all but flat palms need it, in m")]
    NoRadius {
        /// Palm from 1.
        palm: usize,
    },
}
