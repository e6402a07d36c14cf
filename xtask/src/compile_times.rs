//! What it costs to build each crate: processor time of the compiler, and how many packages are built into it.
//!
//! This program stands in front of the compiler while cargo builds into a folder of its own, and notes what each call of it took.

use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::Path;
use std::process::{Command, ExitCode};

use crate::cargo::{cargo, exit_code, output, root, run, target};
use crate::metadata::Metadata;

/// Names the file into which a call of the compiler is noted; where it is set, this program stands for the compiler.
pub(crate) const NOTES: &str = "RECON_COMPILE_TIMES";
const TABLE: &str = "docs/crates.csv";
const HEAD: &str = "crate,packages built in,compile time [s],with all that is built in [s]";
/// In a second: what Linux counts processor times in, for programs.
const TICKS: f64 = 100.0;

/// Runs the compiler with the words that cargo gives, and notes the package and the processor time.
pub(crate) fn compiler(notes: &Path) -> ExitCode {
    let mut words = std::env::args_os().skip(1);
    let Some(rustc) = words.next() else { return ExitCode::FAILURE };
    let status = Command::new(rustc).args(words).status();
    if let (Ok(name), Some(ticks)) = (std::env::var("CARGO_PKG_NAME"), of_children()) {
        let line = format!("{name},{}\n", ticks / TICKS);
        let noted = OpenOptions::new().create(true).append(true).open(notes);
        if let Err(error) = noted.and_then(|mut file| file.write_all(line.as_bytes())) {
            eprintln!("{}: {error}", notes.display());
        }
    }
    if status.is_ok_and(|status| status.success()) { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Processor time of the processes that this one waited for, in ticks.
fn of_children() -> Option<f64> {
    let stat = fs::read_to_string("/proc/self/stat").ok()?;
    let (_, rest) = stat.rsplit_once(')')?;
    let fields: Vec<&str> = rest.split_whitespace().collect();
    let [user, system] = [13, 14].map(|k| fields.get(k).and_then(|ticks| ticks.parse::<f64>().ok()));
    Some(user? + system?)
}

/// Builds all that the command is made of, optimised, and writes the table.
pub(crate) fn main() -> ExitCode {
    exit_code(write())
}

fn write() -> Result<(), String> {
    let folder = target().join("compile-times");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let notes = folder.join("notes.csv");
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut build = cargo("build --release --package recon-touch-cli");
    run(build.env("RUSTC_WRAPPER", own).env(NOTES, &notes).env("CARGO_TARGET_DIR", &folder))?;
    let text = fs::read_to_string(&notes).map_err(|error| format!("{}: {error}", notes.display()))?;
    let times = sums(&text);
    let metadata = Metadata::load()?;
    let mut table = format!("{HEAD}\n");
    for package in metadata.published() {
        let name = package.name.as_str();
        let built_in = built_in(name)?;
        let own = times.get(name).copied().unwrap_or(f64::NAN);
        let all: f64 = own + built_in.iter().filter_map(|of| times.get(of.as_str())).sum::<f64>();
        table += &format!("{name},{},{own:.1},{all:.1}\n", built_in.len());
    }
    fs::write(root().join(TABLE), table).map_err(|error| format!("{TABLE}: {error}"))?;
    let _ = fs::remove_dir_all(&folder);
    println!("wrote {TABLE}");
    Ok(())
}

/// Of each package, over all calls: its library and its build script are two.
fn sums(notes: &str) -> BTreeMap<&str, f64> {
    let mut all = BTreeMap::new();
    for (name, seconds) in notes.lines().filter_map(|line| line.split_once(',')) {
        *all.entry(name).or_insert(0.0) += seconds.parse().unwrap_or(0.0);
    }
    all
}

/// Names of the packages that are built into one with its default features, each once.
fn built_in(name: &str) -> Result<Vec<String>, String> {
    let tree = output(&mut cargo(&format!(
        "tree --package {name} --edges normal,build --prefix none --format {{p}}"
    )))?;
    Ok(named(&tree, name))
}

fn named(tree: &str, without: &str) -> Vec<String> {
    let first = |line: &str| line.split_whitespace().next().map(str::to_owned);
    let mut names: Vec<String> = tree.lines().filter_map(first).filter(|name| name != without).collect();
    names.sort();
    names.dedup();
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_of_one_package_are_summed() {
        let all = sums("a,1.5\nb,2\na,0.25\n");
        assert_eq!((all.get("a"), all.get("b")), (Some(&1.75), Some(&2.0)));
    }

    #[test]
    fn a_package_is_named_once_and_not_itself() {
        let tree = "own v0.1.0 (somewhere)\nglam v0.33.2\nlibm v0.2.1\nglam v0.33.2 (*)\n";
        assert_eq!(named(tree, "own"), ["glam", "libm"]);
    }
}
