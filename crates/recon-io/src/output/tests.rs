use super::manifest::MANIFEST;
use super::*;
use std::fs;
use std::io::{self, Write};

mod killed;

/// A folder of this test's own, removed at its end.
struct Scratch(PathBuf);

impl Scratch {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("recon-io-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    fn read(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    fn names(&self, folder: &str) -> Vec<String> {
        let entries = fs::read_dir(self.path(folder)).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Writes files that hold `text`.
fn write_folder(target: &Path, names: &[&str], text: &str, force: bool) -> Result<(), OutputError> {
    let folder = FolderTarget::new(target, &[], force)?.begin()?;
    for name in names {
        folder.write(name, |to| to.write_all(text.as_bytes()))?;
    }
    folder.place()
}

fn write_file(target: &Path, inputs: &[PathBuf], text: &str) -> Result<(), OutputError> {
    let mut file = FileTarget::new(target, inputs)?.begin()?;
    file.write_all(text.as_bytes()).map_err(OutputError::io("write", target))?;
    file.commit()
}

fn words<T: std::fmt::Debug>(refused: Result<T, OutputError>) -> String {
    refused.unwrap_err().to_string()
}

#[test]
fn a_folder_appears_whole_and_a_later_one_takes_the_place_of_its_files() {
    let scratch = Scratch::new("whole");
    let target = scratch.path("deep/out");
    write_folder(&target, &["a.csv", "b.csv"], "one", false).unwrap();
    write_folder(&target, &["b.csv", "c.csv"], "two", false).unwrap();
    assert_eq!(scratch.names("deep/out"), ["b.csv", "c.csv", MANIFEST]);
    assert_eq!(scratch.read("deep/out/b.csv"), "two");
    assert_eq!(scratch.names("deep"), ["out"], "nothing is left beside it");
    // An empty folder is as good as none.
    fs::create_dir(scratch.path("empty")).unwrap();
    write_folder(&scratch.path("empty"), &["a.csv"], "one", false).unwrap();
    assert_eq!(scratch.names("empty"), ["a.csv", MANIFEST]);
}

#[test]
fn what_recon_did_not_write_or_others_changed_is_named_and_stays() {
    let scratch = Scratch::new("foreign");
    let target = scratch.path("out");
    write_folder(&target, &["summary.json", "motion.csv"], "one", false).unwrap();
    fs::write(target.join("notes.txt"), "years").unwrap();
    fs::write(target.join("motion.csv"), "two").unwrap();
    let text = words(write_folder(&target, &["summary.json"], "two", false));
    assert!(
        text.contains("motion.csv (changed") && text.contains("notes.txt") && text.contains("--force"),
        "{text}"
    );
    // Force goes past what stands beside the results, and over nothing.
    let text = words(write_folder(&target, &["summary.json", "motion.csv"], "three", true));
    assert!(text.contains("out/motion.csv was not written by recon"), "{text}");
    assert_eq!(scratch.names("out"), [MANIFEST, "motion.csv", "notes.txt", "summary.json"]);
    assert_eq!(
        (scratch.read("out/summary.json").as_str(), scratch.read("out/motion.csv").as_str()),
        ("one", "two")
    );
    fs::create_dir(target.join("folder")).unwrap();
    write_folder(&target, &["curves.csv"], "four", true).unwrap();
    assert_eq!(scratch.names("out"), ["curves.csv", "folder", MANIFEST, "motion.csv", "notes.txt"]);
    assert_eq!(
        (scratch.read("out/notes.txt").as_str(), scratch.read("out/motion.csv").as_str()),
        ("years", "two")
    );
}

#[test]
fn folders_without_a_manifest_of_recon_are_foreign() {
    let scratch = Scratch::new("theirs");
    let refuse = |name: &str, expected: &str| {
        let before = scratch.names(name);
        let text = words(write_folder(&scratch.path(name), &["summary.json"], "x", false));
        assert!(text.contains(expected), "{text}");
        assert_eq!(scratch.names(name), before);
    };
    for name in ["thesis", "earlier", "other", "sly"] {
        fs::create_dir(scratch.path(name)).unwrap();
    }
    fs::write(scratch.path("thesis/years.tex"), "of work").unwrap();
    refuse("thesis", "years.tex");
    fs::write(scratch.path("earlier/summary.json"), "{}").unwrap();
    refuse("earlier", "summary.json (without the manifest.json");
    fs::write(scratch.path("other/manifest.json"), r#"{"name": "an extension of a browser"}"#).unwrap();
    refuse("other", "manifest.json");
    let sly =
        r#"{"recon": "0", "files": [{"name": "../thesis/years.tex", "bytes": 7, "crc32": "00000000"}]}"#;
    fs::write(scratch.path("sly/manifest.json"), sly).unwrap();
    refuse("sly", "manifest.json");
    assert_eq!(scratch.read("thesis/years.tex"), "of work");
}

#[test]
fn abandoned_results_leave_nothing() {
    let scratch = Scratch::new("abandoned");
    let folder = FolderTarget::new(scratch.path("out"), &[], false).unwrap().begin().unwrap();
    folder.write("a.csv", |w| w.write_all(b"half")).unwrap();
    let full = folder.write("b.csv", |_| Err(io::ErrorKind::StorageFull.into()));
    assert!(
        matches!(full, Err(OutputError::Io { action: "write", ref path, .. }) if path.ends_with("out/b.csv"))
    );
    assert_eq!(scratch.names("").len(), 1);
    drop(folder);
    let mut file = FileTarget::new(scratch.path("log.csv"), &[]).unwrap().begin().unwrap();
    file.write_all(b"half").unwrap();
    drop(file);
    assert!(scratch.names("").is_empty(), "{:?}", scratch.names(""));
    // The same over an earlier result, which stays whole.
    write_folder(&scratch.path("out"), &["a.csv"], "one", false).unwrap();
    let folder = FolderTarget::new(scratch.path("out"), &[], false).unwrap().begin().unwrap();
    folder.write("a.csv", |w| w.write_all(b"half")).unwrap();
    drop(folder);
    assert_eq!((scratch.read("out/a.csv").as_str(), scratch.names("out").len()), ("one", 2));
}

#[test]
fn what_appears_while_recon_computes_is_not_overwritten() {
    let scratch = Scratch::new("meanwhile");
    write_folder(&scratch.path("out"), &["a.csv", "b.csv"], "one", false).unwrap();
    let begun = || {
        let folder = FolderTarget::new(scratch.path("out"), &[], false).unwrap().begin().unwrap();
        folder.write("a.csv", |w| w.write_all(b"new")).unwrap();
        folder
    };
    let folder = begun();
    fs::write(scratch.path("out/b.csv"), "edited").unwrap();
    fs::write(scratch.path("out/notes.txt"), "new").unwrap();
    folder.place().unwrap();
    assert_eq!(scratch.names("out"), ["a.csv", "b.csv", MANIFEST, "notes.txt"]);
    assert_eq!(scratch.read("out/b.csv"), "edited");
    fs::remove_file(scratch.path("out/b.csv")).unwrap();
    fs::remove_file(scratch.path("out/notes.txt")).unwrap();
    let folder = begun();
    fs::write(scratch.path("out/a.csv"), "edited").unwrap();
    assert!(words(folder.place()).contains("a.csv was not written by recon, or was changed"));
    assert_eq!((scratch.read("out/a.csv").as_str(), scratch.names("out").len()), ("edited", 2));
}

#[test]
fn a_file_replaces_the_old_one_only_when_complete() {
    let scratch = Scratch::new("file");
    let target = scratch.path("log.csv");
    fs::write(&target, "old").unwrap();
    let mut file = FileTarget::new(&target, &[]).unwrap().begin().unwrap();
    file.write_all(b"new").unwrap();
    assert_eq!(scratch.read("log.csv"), "old");
    file.commit().unwrap();
    assert_eq!(
        (scratch.read("log.csv").as_str(), scratch.names("").as_slice()),
        ("new", &["log.csv".to_owned()][..])
    );
}

#[test]
fn targets_that_cannot_be_are_named() {
    let scratch = Scratch::new("bad");
    fs::write(scratch.path("file"), "").unwrap();
    let folder = |path: &Path| FolderTarget::new(path, &[], false);
    assert!(matches!(folder(&scratch.path("file")), Err(OutputError::NotAFolder { .. })));
    assert!(
        folder(&scratch.path("file/out")).is_err()
            || folder(&scratch.path("file/out")).unwrap().begin().is_err()
    );
    assert!(matches!(folder(Path::new("/")), Err(OutputError::Foreign { .. })));
    assert!(matches!(folder(Path::new("")), Err(OutputError::NoName { .. })));
    assert!(matches!(FileTarget::new(&scratch.0, &[]), Err(OutputError::IsFolder { .. })));
}

#[test]
fn inputs_are_never_targets() {
    let scratch = Scratch::new("inputs");
    let log = scratch.path("d/log.csv");
    write_folder(&scratch.path("d"), &["summary.json"], "one", false).unwrap();
    fs::write(&log, "log").unwrap();
    let inputs = [scratch.path("none"), log.clone()];
    let refused = |target: &Path| {
        assert!(
            matches!(FolderTarget::new(target, &inputs, true), Err(OutputError::InputWithin { .. })),
            "{target:?}"
        );
    };
    refused(&scratch.path("d"));
    refused(&scratch.path("d/../d"));
    refused(&scratch.0);
    assert!(matches!(write_file(&log, &inputs, "x"), Err(OutputError::Input { .. })));
    assert!(matches!(
        write_file(&scratch.path("d/../d/log.csv"), &inputs, "x"),
        Err(OutputError::Input { .. })
    ));
    assert_eq!(scratch.read("d/log.csv"), "log");
}

#[cfg(unix)]
mod unix {
    use super::*;
    use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
    use std::process::Command;

    #[test]
    fn links_to_inputs_are_inputs() {
        let scratch = Scratch::new("links");
        fs::write(scratch.path("raw.csv"), "raw").unwrap();
        symlink("raw.csv", scratch.path("soft.csv")).unwrap();
        fs::hard_link(scratch.path("raw.csv"), scratch.path("hard.csv")).unwrap();
        fs::create_dir(scratch.path("d")).unwrap();
        fs::hard_link(scratch.path("raw.csv"), scratch.path("d/other.csv")).unwrap();
        symlink("d", scratch.path("e")).unwrap();
        for (input, target) in [("raw", "soft"), ("soft", "raw"), ("raw", "hard"), ("hard", "soft")] {
            let inputs = [scratch.path(&format!("{input}.csv"))];
            let refused = write_file(&scratch.path(&format!("{target}.csv")), &inputs, "x");
            assert!(matches!(refused, Err(OutputError::Input { .. })), "{input} {target}");
        }
        for target in ["d", "e"] {
            let refused = FolderTarget::new(scratch.path(target), &[scratch.path("raw.csv")], true);
            assert!(matches!(refused, Err(OutputError::InputWithin { .. })));
        }
        assert_eq!(scratch.read("raw.csv"), "raw");
    }

    #[test]
    fn links_are_followed_and_stay() {
        let scratch = Scratch::new("symlinks");
        fs::write(scratch.path("there.csv"), "old").unwrap();
        fs::set_permissions(scratch.path("there.csv"), fs::Permissions::from_mode(0o600)).unwrap();
        symlink("there.csv", scratch.path("link.csv")).unwrap();
        symlink("new.csv", scratch.path("dangling.csv")).unwrap();
        write_file(&scratch.path("link.csv"), &[], "one").unwrap();
        write_file(&scratch.path("dangling.csv"), &[], "two").unwrap();
        assert_eq!((scratch.read("there.csv").as_str(), scratch.read("new.csv").as_str()), ("one", "two"));
        assert_eq!(fs::metadata(scratch.path("there.csv")).unwrap().permissions().mode() & 0o777, 0o600);
        fs::create_dir(scratch.path("folder")).unwrap();
        symlink("folder", scratch.path("out")).unwrap();
        symlink("made", scratch.path("later")).unwrap();
        write_folder(&scratch.path("out"), &["a.csv"], "three", false).unwrap();
        write_folder(&scratch.path("later"), &["a.csv"], "four", false).unwrap();
        assert_eq!(
            (scratch.read("folder/a.csv").as_str(), scratch.read("made/a.csv").as_str()),
            ("three", "four")
        );
        for link in ["link.csv", "dangling.csv", "out", "later"] {
            assert!(fs::symlink_metadata(scratch.path(link)).unwrap().is_symlink(), "{link}");
        }
        // Within a folder a link in the place of a file is not what recon wrote.
        fs::remove_file(scratch.path("folder/a.csv")).unwrap();
        fs::write(scratch.path("a.csv"), "three").unwrap();
        symlink("../a.csv", scratch.path("folder/a.csv")).unwrap();
        assert!(matches!(
            write_folder(&scratch.path("out"), &["a.csv"], "x", true),
            Err(OutputError::Collision { .. })
        ));
        assert_eq!(scratch.read("a.csv"), "three");
    }

    #[test]
    fn pipes_and_devices_are_written_to() {
        let scratch = Scratch::new("pipes");
        let pipe = scratch.path("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let reader = {
            let pipe = pipe.clone();
            std::thread::spawn(move || fs::read_to_string(pipe).unwrap())
        };
        write_file(&pipe, &[], "through").unwrap();
        assert_eq!(reader.join().unwrap(), "through");
        assert!(fs::symlink_metadata(&pipe).unwrap().file_type().is_fifo());
        // A link to the device: were it replaced, only the link would be.
        symlink("/dev/null", scratch.path("null")).unwrap();
        write_file(&scratch.path("null"), &[], "nowhere").unwrap();
        assert!(fs::symlink_metadata(scratch.path("null")).unwrap().is_symlink());
        assert_eq!(scratch.names(""), ["null", "pipe"]);
        assert!(FolderTarget::new(&pipe, &[], true).is_err());
    }

    #[test]
    fn names_of_standard_output_are_known() {
        let scratch = Scratch::new("stdout");
        symlink("/dev/stdout", scratch.path("link")).unwrap();
        for path in ["-", "/dev/stdout", "/proc/self/fd/1"] {
            assert!(is_standard_output(Path::new(path)), "{path}");
        }
        assert!(is_standard_output(&scratch.path("link")));
        assert!(!is_standard_output(&scratch.path("file")) && !is_standard_output(Path::new("/dev/null")));
    }
}
