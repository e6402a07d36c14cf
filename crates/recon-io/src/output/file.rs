use super::place::{input_at, is_block_device, is_open_file, last_link, resolved};
use super::{OutputError, left, sibling};
use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, BufWriter, LineWriter, Write};
use std::path::{Path, PathBuf};

/// Where a file is to be written, found to be possible before anything is computed.
#[derive(Debug)]
pub struct FileTarget {
    /// As the user named it.
    named: PathBuf,
    kind: Kind,
}

#[derive(Debug)]
enum Kind {
    /// A regular file at this place, links followed, there or to be made.
    Regular { place: PathBuf, permissions: Option<Permissions> },
    /// A pipe or device, or a file that is open already: there is nothing to be replaced.
    Open(File),
}

impl FileTarget {
    /// Where a file named `path` goes, made from `inputs` (`-` for standard input). Links are followed; a pipe or a
    /// character device is opened, for a pipe once someone reads it.
    ///
    /// # Errors
    /// [`OutputError`] when the target is one of the inputs, a folder, a block device, or cannot be opened.
    pub fn new(path: impl AsRef<Path>, inputs: &[PathBuf]) -> Result<Self, OutputError> {
        let named = path.as_ref().to_owned();
        let place = resolved(&named).map_err(OutputError::io("find", &named))?;
        if let Some(input) = input_at(&place, inputs) {
            return Err(OutputError::Input { path: named, input: input.to_owned() });
        }
        let open = |options: &mut OpenOptions| options.open(&named).map_err(OutputError::io("open", &named));
        let kind = match fs::metadata(&named) {
            Ok(is) if is.is_dir() => return Err(OutputError::IsFolder { path: named }),
            Ok(is) if is_block_device(&is) => return Err(OutputError::BlockDevice { path: named }),
            Ok(is) if !is.is_file() => Kind::Open(open(OpenOptions::new().write(true))?),
            Ok(_) if is_open_file(&last_link(&named)) => Kind::Open(open(OpenOptions::new().append(true))?),
            Ok(is) => Kind::Regular { place, permissions: Some(is.permissions()) },
            // What stands in the way will be named when the file is made.
            Err(_) => Kind::Regular { place, permissions: None },
        };
        Ok(Self { named, kind })
    }

    /// Begins the file.
    ///
    /// # Errors
    /// [`OutputError`] when nothing can be created beside the target.
    pub fn begin(self) -> Result<AtomicFile, OutputError> {
        let Self { named, kind } = self;
        let (target, permissions) = match kind {
            // Whoever reads it gets each line when it is written.
            Kind::Open(file) => {
                let writer = Some(Writer::Open(LineWriter::new(file)));
                return Ok(AtomicFile { named, writer, place: None });
            }
            Kind::Regular { place, permissions } => (place, permissions),
        };
        left::clear_beside(&target);
        let temporary = sibling(&target)?;
        let file = File::create(&temporary).map_err(OutputError::io("create", &named))?;
        let _ = file.try_lock();
        let writer = Some(Writer::Partial(BufWriter::new(file)));
        // Dropped, this removes the file: from here on nothing is left by an error.
        let made = AtomicFile { named, writer, place: Some(Place { target, temporary: temporary.clone() }) };
        if let Some(permissions) = permissions {
            fs::set_permissions(&temporary, permissions).map_err(OutputError::io("create", &made.named))?;
        }
        Ok(made)
    }
}

/// A file that appears under its name only once it is complete and on the disk; dropped before, it leaves nothing. What
/// goes to a pipe or a device cannot be taken back and is gone as soon as it is written.
#[derive(Debug)]
pub struct AtomicFile {
    named: PathBuf,
    writer: Option<Writer>,
    place: Option<Place>,
}

#[derive(Debug)]
struct Place {
    target: PathBuf,
    temporary: PathBuf,
}

#[derive(Debug)]
enum Writer {
    Partial(BufWriter<File>),
    Open(LineWriter<File>),
}

impl AtomicFile {
    /// Puts the file in place.
    ///
    /// # Errors
    /// [`OutputError`] when the last bytes do not fit on the disk or the name cannot be taken; nothing is left then.
    pub fn commit(mut self) -> Result<(), OutputError> {
        let done = match self.writer.take() {
            Some(Writer::Partial(writer)) => {
                let file = writer.into_inner().map_err(io::IntoInnerError::into_error);
                file.and_then(|f| f.sync_all())
            }
            // Not every device can be told to hold on to what it got.
            Some(Writer::Open(mut writer)) => writer.flush(),
            None => Ok(()),
        };
        done.map_err(OutputError::io("write", &self.named))?;
        let Some(place) = &self.place else { return Ok(()) };
        fs::rename(&place.temporary, &place.target).map_err(OutputError::io("put in place", &self.named))
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.writer {
            Some(Writer::Partial(writer)) => writer.write(bytes),
            Some(Writer::Open(writer)) => writer.write(bytes),
            None => Err(io::ErrorKind::NotConnected.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match &mut self.writer {
            Some(Writer::Partial(writer)) => writer.flush(),
            Some(Writer::Open(writer)) => writer.flush(),
            None => Ok(()),
        }
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        self.writer = None;
        // After a commit there is nothing under this name; otherwise there is no one left to tell of a failure.
        if let Some(place) = &self.place {
            let _ = fs::remove_file(&place.temporary);
        }
    }
}
