use super::{OutputError, sibling};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A file that appears under its name only once it is complete and on the disk; dropped before, it leaves nothing.
#[derive(Debug)]
pub struct AtomicFile {
    target: PathBuf,
    temporary: PathBuf,
    writer: Option<BufWriter<File>>,
}

impl AtomicFile {
    /// Begins a file that is to stand at `target`, replacing what is there when it is complete.
    ///
    /// # Errors
    /// [`OutputError`] when nothing can be created beside the target, or the target is a folder.
    pub fn create(target: impl AsRef<Path>) -> Result<Self, OutputError> {
        let target = target.as_ref().to_owned();
        if target.is_dir() {
            return Err(OutputError::Occupied { path: target });
        }
        let temporary = sibling(&target, "partial")?;
        let file = File::create(&temporary).map_err(OutputError::io("create", &target))?;
        Ok(Self { target, temporary, writer: Some(BufWriter::new(file)) })
    }

    /// Puts the file in place.
    ///
    /// # Errors
    /// [`OutputError`] when the last bytes do not fit on the disk or the name cannot be taken; nothing is left then.
    pub fn commit(mut self) -> Result<(), OutputError> {
        if let Some(writer) = self.writer.take() {
            let file = writer.into_inner().map_err(io::IntoInnerError::into_error);
            file.and_then(|f| f.sync_all()).map_err(OutputError::io("write", &self.target))?;
        }
        fs::rename(&self.temporary, &self.target).map_err(OutputError::io("put in place", &self.target))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.writer {
            Some(writer) => writer.write(bytes),
            None => Err(io::ErrorKind::NotConnected.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer.as_mut().map_or(Ok(()), Write::flush)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        // After a commit there is nothing under this name; otherwise there is no one left to tell of a failure.
        let _ = fs::remove_file(&self.temporary);
    }
}
