//! Runs the built command in a folder of the test's own.

#![allow(dead_code, reason = "each test file uses its own part of this")]

pub(crate) mod schema;

use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::OnceLock;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Longest wait for something that comes within a fraction of it.
pub(crate) const PATIENCE: Duration = Duration::from_secs(60);

/// A folder of this test's own, removed at its end.
pub(crate) struct Scratch(PathBuf);

/// What a run left.
#[derive(Clone)]
pub(crate) struct Run {
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Scratch {
    pub(crate) fn new(test: &str) -> Self {
        let path = std::env::temp_dir().join(format!("recon-cli-{test}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    pub(crate) fn write(&self, name: &str, text: &str) -> &Self {
        fs::write(self.0.join(name), text).unwrap();
        self
    }

    pub(crate) fn read(&self, name: &str) -> String {
        fs::read_to_string(self.0.join(name)).unwrap()
    }

    /// Checks that a simulation was refused in these words and left nothing beside the scene.
    pub(crate) fn check_refused_scene(&self, run: &Run, words: &[&str]) {
        assert_eq!(run.code, Some(3), "{}{}", run.stdout, run.stderr);
        for word in words {
            assert!(run.stderr.contains(word), "`{word}` is not in\n{}", run.stderr);
        }
        assert_eq!(self.names(), ["scene.toml"]);
    }

    /// Names in the folder, sorted, hidden ones included.
    pub(crate) fn names(&self) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(&self.0).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    /// The summaries in the folder and below it.
    fn summaries(&self) -> BTreeMap<PathBuf, String> {
        let (mut found, mut folders) = (BTreeMap::new(), vec![self.0.clone()]);
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
                let kind = entry.file_type().unwrap();
                if kind.is_dir() {
                    folders.push(entry.path());
                } else if kind.is_file() && entry.file_name() == "summary.json" {
                    found.insert(entry.path(), fs::read_to_string(entry.path()).unwrap_or_default());
                }
            }
        }
        found
    }

    /// The command with arguments, in this folder.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_recon"));
        command.args(arguments).current_dir(&self.0).stdin(Stdio::null());
        command
    }

    /// Runs the command; a summary that it writes has the keys of the schema.
    pub(crate) fn run(&self, arguments: &[&str]) -> Run {
        let before = self.summaries();
        let Output { status, stdout, stderr } = self.command(arguments).output().unwrap();
        for (path, text) in self.summaries() {
            if before.get(&path) != Some(&text) {
                let wrong = schema::complaints(&serde_json::from_str(&text).unwrap());
                assert!(wrong.is_empty(), "{arguments:?}: {}: {wrong:#?}", path.display());
            }
        }
        let text = |bytes| String::from_utf8(bytes).unwrap();
        Run { code: status.code(), stdout: text(stdout), stderr: text(stderr) }
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// What a command prints with `--json`, with the code that it is to end with.
pub(crate) fn json(scratch: &Scratch, arguments: &[&str], code: i32) -> Value {
    let run = scratch.run(arguments);
    assert_eq!(run.code, Some(code), "{arguments:?} {}{}", run.stdout, run.stderr);
    serde_json::from_str(&run.stdout).unwrap()
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

/// Waits until `condition` holds; false when the child ended before.
pub(crate) fn wait_for(child: &mut Child, condition: impl Fn() -> bool) -> bool {
    let start = Instant::now();
    while start.elapsed() < PATIENCE {
        if condition() {
            return true;
        }
        if child.try_wait().unwrap().is_some() {
            return false;
        }
        sleep(Duration::from_millis(2));
    }
    panic!("nothing happened in {PATIENCE:?}");
}

/// The scene of the paper's Fig. 5, sampled at 100 Hz.
pub(crate) fn fig5() -> String {
    include_str!("../../../scenes/fig5.toml").replace("sample_rate = 1000.0", "sample_rate = 100.0")
}

/// Half of its time: contacts all round the body, so that it has bounds on both sides.
pub(crate) fn scene() -> String {
    fig5().replace("duration = 4.2", "duration = 2.1")
}

/// A folder with that scene and its log, which is made once for all tests.
pub(crate) fn scratch_with_log(test: &str) -> Scratch {
    static LOG: OnceLock<String> = OnceLock::new();
    let scratch = Scratch::new(test);
    let log = LOG.get_or_init(|| scratch_with_log_of("log-of-all", &scene()).read("log.csv"));
    scratch.write("scene.toml", &scene()).write("log.csv", log);
    scratch
}

/// Such a folder, and what a reconstruction of the log left in `out` and said, made once for all tests: with meshes and models in all formats
/// beside what is written anyway, or with an estimate of mass and inertia alone.
pub(crate) fn scratch_reconstructed(test: &str, identify: bool) -> (Scratch, Run) {
    static MADE: [OnceLock<Made>; 2] = [OnceLock::new(), OnceLock::new()];
    let made = MADE[usize::from(identify)].get_or_init(|| {
        let options =
            if identify { &["--identify"][..] } else { &["--mesh", "stl,glb", "--export", "mjcf,urdf"] };
        Made::with(options)
    });
    let scratch = scratch_with_log(test);
    fs::create_dir(scratch.path().join("out")).unwrap();
    made.files
        .iter()
        .for_each(|(name, bytes)| fs::write(scratch.path().join("out").join(name), bytes).unwrap());
    (scratch, made.run.clone())
}

/// A folder of results.
struct Made {
    files: Vec<(String, Vec<u8>)>,
    run: Run,
}

impl Made {
    fn with(options: &[&str]) -> Self {
        let scratch = scratch_with_log(&format!("made{}", options.concat()));
        let words = ["reconstruct", "log.csv", "--scene", "scene.toml", "-o", "out"];
        let run = scratch.run(&[&words, options].concat());
        assert_eq!(run.code, Some(0), "{}{}", run.stdout, run.stderr);
        let entries = fs::read_dir(scratch.path().join("out")).unwrap().map(Result::unwrap);
        let file =
            |entry: fs::DirEntry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap());
        Self { files: entries.map(file).collect(), run }
    }
}

/// A folder with a scene and its log, of three palms that are touched throughout.
pub(crate) fn scratch_with_log_of(test: &str, scene: &str) -> Scratch {
    let scratch = Scratch::new(test);
    scratch.write("scene.toml", scene);
    let run = scratch.run(&["simulate", "scene.toml", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    scratch
}

/// A CSV table that tests spoil cell by cell.
pub(crate) struct Table {
    pub(crate) header: Vec<String>,
    pub(crate) rows: Vec<Vec<String>>,
}

impl Table {
    pub(crate) fn parse(text: &str) -> Self {
        let mut lines = text.lines().map(|l| l.split(',').map(str::to_owned).collect::<Vec<_>>());
        Self { header: lines.next().unwrap(), rows: lines.collect() }
    }

    pub(crate) fn column(&self, name: &str) -> usize {
        self.header.iter().position(|h| h == name).unwrap()
    }

    pub(crate) fn set(&mut self, row: usize, column: &str, value: &str) {
        let place = self.column(column);
        self.rows[row][place] = value.to_owned();
    }

    /// Replaces every cell of the columns by a function of it.
    pub(crate) fn map(&mut self, columns: &[&str], f: impl Fn(f64) -> f64) {
        for name in columns {
            let place = self.column(name);
            for row in &mut self.rows {
                row[place] = f(row[place].parse().unwrap()).to_string();
            }
        }
    }

    pub(crate) fn text(&self) -> String {
        std::iter::once(&self.header).chain(&self.rows).map(|row| row.join(",") + "\n").collect()
    }
}
