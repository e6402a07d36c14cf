use super::checksum::Checksum;
use super::left::is_left;
use serde::{Deserialize, Serialize};
use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Name of the file in which an output folder lists what recon wrote into it.
pub(crate) const MANIFEST: &str = "manifest.json";

/// What recon wrote into a folder: these files are its own as long as nobody has changed them.
#[derive(Clone, Debug, Default, Deserialize, Eq, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Manifest {
    /// Version of recon.
    pub(crate) recon: String,
    /// The files, without this one.
    pub(crate) files: Vec<Entry>,
}

/// A file of a manifest.
#[derive(Clone, Debug, Deserialize, Eq, PartialEq, Serialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Entry {
    /// Without folder.
    pub(crate) name: String,
    pub(crate) bytes: u64,
    /// As [`Checksum::hex`] gives it.
    pub(crate) crc32: String,
}

/// How a file stands to its entry.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(crate) enum State {
    AsWritten,
    Changed,
    Missing,
}

impl Entry {
    pub(crate) fn new(name: &str, sum: &Checksum) -> Self {
        Self { name: name.to_owned(), bytes: sum.bytes(), crc32: sum.hex() }
    }

    /// How the file of this entry stands in `folder`.
    pub(crate) fn state(&self, folder: &Path) -> io::Result<State> {
        let path = folder.join(&self.name);
        match fs::symlink_metadata(&path) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(State::Missing),
            Err(e) => Err(e),
            // A link is not what recon wrote, whatever it leads to.
            Ok(is) if !is.is_file() || is.len() != self.bytes => Ok(State::Changed),
            Ok(_) => {
                let same = Checksum::of(File::open(&path)?)?.hex() == self.crc32;
                Ok(if same { State::AsWritten } else { State::Changed })
            }
        }
    }

    /// Whether the name stays in its folder.
    fn is_plain(&self) -> bool {
        Path::new(&self.name).file_name().is_some_and(|name| name == self.name.as_str())
    }
}

impl Manifest {
    /// The manifest of a folder; `None` where there is none or another program's file of that name.
    pub(crate) fn of(folder: &Path) -> io::Result<Option<Self>> {
        match fs::read(folder.join(MANIFEST)) {
            Ok(text) => Ok(Self::parse(&text)),
            Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
            Err(e) => Err(e),
        }
    }

    /// A manifest from its text; `None` where the text is none.
    pub(crate) fn parse(text: &[u8]) -> Option<Self> {
        let manifest: Self = serde_json::from_slice(text).ok()?;
        manifest.files.iter().all(Entry::is_plain).then_some(manifest)
    }
}

/// What stands in a folder, told apart by who wrote it.
#[derive(Debug, Default)]
pub(super) struct Contents {
    /// Files that recon wrote and nobody changed, the manifest among them.
    pub(super) own: Vec<String>,
    /// Everything else, with a remark for those of which recon knows more.
    pub(super) foreign: Vec<(OsString, &'static str)>,
}

impl Contents {
    /// Looks through a folder; nothing stands in one that does not exist.
    pub(super) fn of(folder: &Path) -> io::Result<Self> {
        let mut contents = Self::default();
        let entries = match fs::read_dir(folder) {
            Err(e) if e.kind() == io::ErrorKind::NotFound => return Ok(contents),
            entries => entries?,
        };
        let manifest = Manifest::of(folder)?;
        for entry in entries {
            let name = entry?.file_name();
            let listed =
                |files: &Manifest| files.files.iter().find(|file| name == file.name.as_str()).cloned();
            match (&manifest, manifest.as_ref().and_then(listed)) {
                (Some(_), None) if name == MANIFEST => contents.own.push(MANIFEST.to_owned()),
                (_, Some(file)) => match file.state(folder)? {
                    State::AsWritten => contents.own.push(file.name),
                    State::Changed => contents.foreign.push((name, " (changed since it was written)")),
                    State::Missing => {}
                },
                (None, _) if name == "summary.json" => {
                    contents.foreign.push((name, " (without the manifest.json that recon writes beside it)"));
                }
                _ if name.to_string_lossy().starts_with(STAGE) => {
                    // What nobody uses any more goes when the next run begins.
                    if !is_left(&folder.join(&name)) {
                        contents
                            .foreign
                            .push((name, " (of a run of recon that still goes on or was cut off)"));
                    }
                }
                _ => contents.foreign.push((name, "")),
            }
        }
        contents.foreign.sort();
        Ok(contents)
    }
}

/// How the hidden folder begins in which new files wait within an output folder.
pub(super) const STAGE: &str = ".recon-partial";
