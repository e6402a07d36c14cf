//! A chart on disk: CSV, SVG and PNG, each complete or not there at all.

use std::io;
use std::path::{Path, PathBuf};

use super::ChartError;

/// The three files of a chart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrittenChart {
    /// The figures.
    pub csv: PathBuf,
    /// The vector image.
    pub svg: PathBuf,
    /// The raster image.
    pub png: PathBuf,
}

/// File stems are lower case with digits and hyphens, so that they are the same on every system and in every link.
pub(super) fn check_name(name: &str) -> Result<(), ChartError> {
    let allowed = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if name.is_empty() || !name.chars().all(allowed) {
        return Err(ChartError::BadName { name: name.to_owned() });
    }
    Ok(())
}

pub(super) fn write(
    folder: &Path,
    name: &str,
    csv: &str,
    svg: &str,
    png: &[u8],
) -> Result<WrittenChart, ChartError> {
    std::fs::create_dir_all(folder).map_err(|source| unwritable(folder, source))?;
    let put = |ending: &str, bytes: &[u8]| {
        let path = folder.join(format!("{name}.{ending}"));
        write_whole(&path, bytes).map_err(|source| unwritable(&path, source))?;
        Ok(path)
    };
    Ok(WrittenChart {
        csv: put("csv", csv.as_bytes())?,
        svg: put("svg", svg.as_bytes())?,
        png: put("png", png)?,
    })
}

/// Writes beside the target and renames, which replaces a file in one step on one file system.
fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut beside = path.as_os_str().to_owned();
    beside.push(format!(".{}.part", std::process::id()));
    let beside = PathBuf::from(beside);
    let outcome = std::fs::write(&beside, bytes).and_then(|()| std::fs::rename(&beside, path));
    if outcome.is_err() {
        // The first error is the one to report; a part that cannot be removed either changes nothing about it.
        let _ = std::fs::remove_file(&beside);
    }
    outcome
}

fn unwritable(path: &Path, source: io::Error) -> ChartError {
    ChartError::Unwritable { path: path.to_owned(), source }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_file_stems() {
        assert!(check_name("fig5-simulation-2").is_ok());
        for name in ["", "Fig5", "a/b", "..", "a b", "é"] {
            assert!(check_name(name).is_err(), "{name}");
        }
    }

    #[test]
    fn a_write_that_fails_leaves_nothing_behind() {
        let folder = std::env::temp_dir().join(format!("recon-chart-files-{}", std::process::id()));
        // The target is a folder, so the rename fails after the part has been written.
        std::fs::create_dir_all(folder.join("taken.csv/inside")).expect("a folder for temporary files");
        let outcome = write(&folder, "taken", "a\n", "<svg/>", b"");
        let left: Vec<_> = std::fs::read_dir(&folder).expect("it was made above").collect();
        let _ = std::fs::remove_dir_all(&folder);
        assert!(matches!(outcome, Err(ChartError::Unwritable { path, .. }) if path.ends_with("taken.csv")));
        assert_eq!(left.len(), 1, "{left:?}");
    }
}
