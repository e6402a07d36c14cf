use super::checksum::Summed;
use super::left::Held;
use super::manifest::{Contents, Entry, MANIFEST, Manifest, STAGE};
use super::place::{input_in, resolved};
use super::{OutputError, left, sibling};
use crate::check::{CheckError, certify};
use recon::contact_kinematics::at_once;
use std::ffi::OsString;
use std::fs::{self, File};
use std::io::{self, BufWriter, IntoInnerError, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Where a folder is to be written, found to be possible before anything is computed.
#[derive(Clone, Debug)]
pub struct FolderTarget {
    /// As the user named it.
    named: PathBuf,
    /// Links followed.
    place: PathBuf,
    /// What stands there and is not recon's.
    foreign: Vec<OsString>,
}

impl FolderTarget {
    /// A folder of results named `path`, made from `inputs` (`-` for standard input). What stands there must be recon's
    /// own and unchanged, as the manifest in the folder tells; with `force` other files may stand beside the results,
    /// and stay.
    ///
    /// # Errors
    /// [`OutputError`] when an input lies in the folder, something foreign stands there, or it is no folder.
    pub fn new(path: impl AsRef<Path>, inputs: &[PathBuf], force: bool) -> Result<Self, OutputError> {
        let named = path.as_ref().to_owned();
        if named.as_os_str().is_empty() {
            return Err(OutputError::NoName { path: named });
        }
        let place = resolved(&named).map_err(OutputError::io("find", &named))?;
        let foreign = match Contents::of(&place) {
            Err(e) if e.kind() == io::ErrorKind::NotADirectory && place.exists() => {
                return Err(OutputError::NotAFolder { path: named });
            }
            contents => contents.map_err(OutputError::io("read", &named))?.foreign,
        };
        if let Some(input) = input_in(&place, inputs) {
            return Err(OutputError::InputWithin { path: named, input: input.to_owned() });
        }
        if foreign.is_empty() || force {
            let foreign = foreign.into_iter().map(|(name, _)| name).collect();
            return Ok(Self { named, place, foreign });
        }
        let words =
            foreign.iter().take(NAMED).map(|(name, what)| format!("{}{what}", name.to_string_lossy()));
        let more = foreign.len().saturating_sub(NAMED);
        let more = (more > 0).then(|| format!("and {more} more"));
        let names = words.chain(more).collect::<Vec<_>>().join(", ");
        Err(OutputError::Foreign { path: named, names })
    }

    /// Begins the folder.
    ///
    /// # Errors
    /// [`OutputError::Io`] when nothing can be created there.
    pub fn begin(self) -> Result<OutputFolder, OutputError> {
        let temporary = if self.place.is_dir() {
            // Within the folder: it may be a file system of its own, and what stands beside results stays untouched.
            left::clear(&self.place, |name| name.starts_with(STAGE));
            self.place.join(format!("{STAGE}-{}", std::process::id()))
        } else {
            let parent = self.place.parent().unwrap_or(Path::new("/"));
            fs::create_dir_all(parent).map_err(OutputError::io("create", parent))?;
            left::clear_beside(&self.place);
            sibling(&self.place)?
        };
        let made = fs::create_dir(&temporary).and_then(|()| Held::new(&temporary));
        let held = made.map_err(OutputError::io("create", &self.named))?;
        Ok(OutputFolder { target: self, temporary, held, files: Mutex::default() })
    }

    /// What stands there now, apart from the hidden folder of new files.
    fn contents_beside(&self, temporary: &Path) -> Result<Contents, OutputError> {
        let mut contents = Contents::of(&self.place).map_err(OutputError::io("read", &self.named))?;
        contents.foreign.retain(|(name, _)| Some(name.as_os_str()) != temporary.file_name());
        Ok(contents)
    }
}

/// Foreign files that are named one by one.
const NAMED: usize = 5;

/// A folder whose files appear under their names only once all of them are complete and on the disk.
///
/// Until [`commit`](Self::commit) they stand in a hidden folder, which is removed when this value is dropped: after an
/// error, an interruption or a full disk the target is as it was.
#[derive(Debug)]
pub struct OutputFolder {
    target: FolderTarget,
    temporary: PathBuf,
    held: Held,
    /// Written, but not yet seen to be on the disk.
    files: Mutex<Vec<(Entry, File)>>,
}

impl OutputFolder {
    /// Writes one file of the folder; several threads may do so at once. That all are on the disk is seen to when they are put in place.
    ///
    /// # Errors
    /// [`OutputError::Io`] names the file as it would have been called; [`OutputError::Collision`] when a file of that
    /// name stands there that is not recon's to replace.
    pub fn write(
        &self,
        name: &str,
        contents: impl FnOnce(&mut Summed<BufWriter<File>>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        if self.target.foreign.iter().any(|foreign| foreign == name) {
            return Err(OutputError::Collision { path: self.target.named.join(name) });
        }
        let write = || {
            let mut writer = Summed::new(BufWriter::new(File::create_new(self.temporary.join(name))?));
            contents(&mut writer)?;
            writer.flush()?;
            let (writer, sum) = writer.finish();
            Ok((writer.into_inner().map_err(IntoInnerError::into_error)?, sum))
        };
        let (file, sum) = write().map_err(OutputError::io("write", &self.target.named.join(name)))?;
        self.files().push((Entry::new(name, &sum), file));
        Ok(())
    }

    /// Those so far: a list is whole at any time, also where a thread that wrote ended in a panic.
    fn files(&self) -> MutexGuard<'_, Vec<(Entry, File)>> {
        self.files.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Sees that all files so far are on the disk; gives their entries by name.
    fn synced(&self) -> Result<Vec<Entry>, OutputError> {
        let mut entries = Vec::new();
        for (entry, file) in self.files().drain(..) {
            file.sync_all().map_err(OutputError::io("write", &self.target.named.join(&entry.name)))?;
            entries.push(entry);
        }
        // Whichever was complete first.
        entries.sort_by(|a, b| a.name.cmp(&b.name));
        Ok(entries)
    }

    /// Checks what the files hold ([`crate::check`]) and puts them in place, those of an earlier run away; everything else
    /// stays as it is.
    ///
    /// # Errors
    /// [`OutputError`], in particular [`OutputError::Certificate`]; what stood there before stands there again.
    pub fn commit(self) -> Result<(), OutputError> {
        let names: Vec<String> = self.files().iter().map(|(file, _)| file.name.clone()).collect();
        let fails = |faults| OutputError::Certificate {
            path: self.target.named.clone(),
            source: CheckError::Faults { faults },
        };
        // The disk is waited for meanwhile.
        let (files, checked) = at_once(|| self.synced(), || certify(&self.temporary, &names));
        let files = files?;
        checked.map_err(fails)?;
        self.placed(files)
    }

    /// [`commit`](Self::commit) of files that hold anything.
    #[cfg(test)]
    pub(crate) fn place(self) -> Result<(), OutputError> {
        let files = self.synced()?;
        self.placed(files)
    }

    fn placed(mut self, files: Vec<Entry>) -> Result<(), OutputError> {
        let manifest = Manifest { recon: env!("CARGO_PKG_VERSION").to_owned(), files };
        self.write(MANIFEST, |to| {
            serde_json::to_writer_pretty(&mut *to, &manifest)?;
            writeln!(to)
        })?;
        self.synced()?;
        let FolderTarget { named, place, .. } = &self.target;
        if !self.temporary.starts_with(place) {
            self.held.release().map_err(OutputError::io("put in place", named))?;
            return fs::rename(&self.temporary, place).map_err(OutputError::io("put in place", named));
        }
        // Whatever has appeared or changed since the start is not recon's either.
        let stands = self.target.contents_beside(&self.temporary)?;
        // The manifest goes first and comes last: without it no half of anything passes for a result.
        let mut new: Vec<&str> = manifest.files.iter().map(|file| file.name.as_str()).collect();
        new.push(MANIFEST);
        if let Some(name) = new.iter().find(|name| stands.foreign.iter().any(|(other, _)| other == **name)) {
            return Err(OutputError::Collision { path: named.join(name) });
        }
        let mut old = stands.own;
        old.sort_by_key(|name| name != MANIFEST);
        exchange(&self.temporary, place, &old, &new).map_err(OutputError::io("put results into", named))?;
        fs::remove_dir_all(&self.temporary).map_err(OutputError::io("remove", &self.temporary))
    }
}

/// Where files of an earlier run wait until those of the new one are in place.
const EARLIER: &str = "earlier";

/// Moves the files `old` of `place` into a folder of `stage`, then the files `new` of `stage` into `place`; after an
/// error all the way back.
fn exchange(stage: &Path, place: &Path, old: &[String], new: &[&str]) -> io::Result<()> {
    let aside = stage.join(EARLIER);
    fs::create_dir(&aside)?;
    let away = old.iter().map(|name| (place.join(name), aside.join(name)));
    let moves: Vec<_> = away.chain(new.iter().map(|name| (stage.join(name), place.join(name)))).collect();
    for (done, (from, to)) in moves.iter().enumerate() {
        if let Err(error) = fs::rename(from, to) {
            for (from, to) in moves[..done].iter().rev() {
                fs::rename(to, from)?;
            }
            return Err(error);
        }
    }
    Ok(())
}

/// Whether files of an earlier run wait in a hidden folder.
pub(super) fn is_stranded(stage: &Path) -> bool {
    fs::read_dir(stage.join(EARLIER)).is_ok_and(|mut files| files.next().is_some())
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // After a commit there is nothing under this name; otherwise there is no one left to tell of a failure. What
        // could not be moved back to its place is not removed.
        if !is_stranded(&self.temporary) {
            let _ = self.held.release();
            let _ = fs::remove_dir_all(&self.temporary);
        }
    }
}
