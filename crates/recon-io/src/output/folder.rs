use super::{OutputError, sibling};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The file by which a folder of recon's is known; only such a folder, or an empty one, is replaced.
const MARK: &str = "summary.json";

/// A folder that appears under its name only once everything in it is complete and on the disk.
///
/// Until [`commit`](Self::commit) the files stand in a hidden folder beside it, which is removed when this value is
/// dropped: after an error, an interruption or a full disk the target is as it was.
#[derive(Debug)]
pub struct OutputFolder {
    target: PathBuf,
    temporary: PathBuf,
}

impl OutputFolder {
    /// Begins a folder that is to stand at `target`.
    ///
    /// # Errors
    /// [`OutputError::Occupied`] when something stands there that recon did not write, and [`OutputError::Io`] when
    /// nothing can be created beside it.
    pub fn create(target: impl AsRef<Path>) -> Result<Self, OutputError> {
        let target = target.as_ref().to_owned();
        check_replaceable(&target)?;
        let temporary = sibling(&target, "partial")?;
        if let Some(parent) = target.parent().filter(|p| !p.as_os_str().is_empty()) {
            fs::create_dir_all(parent).map_err(OutputError::io("create", parent))?;
        }
        fs::create_dir(&temporary).map_err(OutputError::io("create", &target))?;
        Ok(Self { target, temporary })
    }

    /// Where the folder is to stand.
    #[must_use]
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Writes one file of the folder to the disk.
    ///
    /// # Errors
    /// [`OutputError::Io`] names the file as it would have been called.
    pub fn write(
        &self,
        name: &str,
        contents: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<(), OutputError> {
        let write = || -> io::Result<()> {
            let mut writer = BufWriter::new(File::create_new(self.temporary.join(name))?);
            contents(&mut writer)?;
            writer.flush()?;
            writer.get_ref().sync_all()
        };
        write().map_err(OutputError::io("write", &self.target.join(name)))
    }

    /// Puts the folder in place. A folder that stood there is moved aside first and removed last.
    ///
    /// # Errors
    /// [`OutputError::Io`]; the earlier folder is then put back.
    pub fn commit(self) -> Result<(), OutputError> {
        if !self.target.exists() {
            return fs::rename(&self.temporary, &self.target)
                .map_err(OutputError::io("put in place", &self.target));
        }
        let old = sibling(&self.target, "old")?;
        fs::rename(&self.target, &old).map_err(OutputError::io("replace", &self.target))?;
        if let Err(source) = fs::rename(&self.temporary, &self.target) {
            // Best effort: the error that matters is the one above.
            let _ = fs::rename(&old, &self.target);
            return Err(OutputError::Io { action: "put in place", path: self.target.clone(), source });
        }
        fs::remove_dir_all(&old).map_err(OutputError::io("remove", &old))
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // After a commit there is nothing under this name; otherwise there is no one left to tell of a failure.
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

fn check_replaceable(target: &Path) -> Result<(), OutputError> {
    let occupied = || OutputError::Occupied { path: target.to_owned() };
    match fs::read_dir(target) {
        Ok(mut entries) => {
            if entries.next().is_none() || target.join(MARK).is_file() {
                Ok(())
            } else {
                Err(occupied())
            }
        }
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(e) if e.kind() == io::ErrorKind::NotADirectory => Err(occupied()),
        Err(e) => Err(OutputError::io("read", target)(e)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::AtomicFile;
    use super::*;

    /// A folder of this test's own, removed at its end.
    struct Scratch(PathBuf);

    impl Scratch {
        fn new(name: &str) -> Self {
            let path = std::env::temp_dir().join(format!("recon-io-{name}-{}", std::process::id()));
            fs::create_dir_all(&path).unwrap();
            Self(path)
        }

        fn names(&self) -> Vec<String> {
            let mut names: Vec<_> = fs::read_dir(&self.0)
                .unwrap()
                .map(|e| e.unwrap().file_name().into_string().unwrap())
                .collect();
            names.sort();
            names
        }
    }

    impl Drop for Scratch {
        fn drop(&mut self) {
            let _ = fs::remove_dir_all(&self.0);
        }
    }

    fn write_and_commit(target: &Path, text: &str) -> Result<(), OutputError> {
        let folder = OutputFolder::create(target)?;
        folder.write(MARK, |w| w.write_all(text.as_bytes()))?;
        folder.commit()
    }

    #[test]
    fn folder_appears_whole_and_replaces_its_own_kind_only() {
        let scratch = Scratch::new("whole");
        let target = scratch.0.join("deep/out");
        write_and_commit(&target, "one").unwrap();
        write_and_commit(&target, "two").unwrap();
        assert_eq!(fs::read_to_string(target.join(MARK)).unwrap(), "two");
        assert_eq!(fs::read_dir(scratch.0.join("deep")).unwrap().count(), 1, "nothing is left beside it");
        fs::create_dir(scratch.0.join("theirs")).unwrap();
        fs::write(scratch.0.join("theirs/thesis.tex"), "years").unwrap();
        let refused = write_and_commit(&scratch.0.join("theirs"), "x");
        assert!(matches!(refused, Err(OutputError::Occupied { .. })));
        assert_eq!(fs::read_to_string(scratch.0.join("theirs/thesis.tex")).unwrap(), "years");
    }

    #[test]
    fn abandoned_results_leave_nothing() {
        let scratch = Scratch::new("abandoned");
        let folder = OutputFolder::create(scratch.0.join("out")).unwrap();
        folder.write("a.csv", |w| w.write_all(b"half")).unwrap();
        let full = folder.write("b.csv", |_| Err(io::ErrorKind::StorageFull.into()));
        assert!(
            matches!(full, Err(OutputError::Io { action: "write", ref path, .. }) if path.ends_with("out/b.csv"))
        );
        assert_eq!(scratch.names().len(), 1);
        drop(folder);
        let mut file = AtomicFile::create(scratch.0.join("log.csv")).unwrap();
        file.write_all(b"half").unwrap();
        drop(file);
        assert!(scratch.names().is_empty(), "{:?}", scratch.names());
    }

    #[test]
    fn file_replaces_the_old_one_only_when_complete() {
        let scratch = Scratch::new("file");
        let target = scratch.0.join("log.csv");
        fs::write(&target, "old").unwrap();
        let mut file = AtomicFile::create(&target).unwrap();
        file.write_all(b"new").unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "old");
        file.commit().unwrap();
        assert_eq!(fs::read_to_string(&target).unwrap(), "new");
        assert_eq!(scratch.names(), ["log.csv"]);
    }

    #[test]
    fn targets_that_cannot_be_are_named() {
        let scratch = Scratch::new("bad");
        fs::write(scratch.0.join("file"), "").unwrap();
        assert!(matches!(OutputFolder::create(scratch.0.join("file")), Err(OutputError::Occupied { .. })));
        assert!(OutputFolder::create(scratch.0.join("file/out")).is_err());
        assert!(matches!(
            OutputFolder::create("/"),
            Err(OutputError::Occupied { .. } | OutputError::NoName { .. })
        ));
        assert!(matches!(AtomicFile::create(&scratch.0), Err(OutputError::Occupied { .. })));
    }
}
