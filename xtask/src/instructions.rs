//! Instructions of the inner loops, by a program that counts them where there is one: counts repeat, so that a change of a twentieth is one of the code.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use crate::cargo::{cargo, exit_code, output, program, root, run, say, target};
use crate::steps::Outcome;

/// Counts that are committed; docs/cost.md tells what they are, and the page of charts shows them.
const TABLE: &str = "docs/instructions.csv";
const HEAD: &str = "loop,instructions (release),instructions (tests),one repeat";
/// A change that is told.
const TOLD: f64 = 0.05;

/// What counts instructions.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Counter {
    Perf,
    Valgrind,
}

impl Counter {
    /// The first one that counts here: `perf` is there on machines whose processor, or host, does not let it count.
    fn found() -> Option<Self> {
        [Self::Perf, Self::Valgrind].into_iter().find(|of| of.count(&mut program("true")).is_ok())
    }

    /// Instructions of a process until it ends.
    fn count(self, of: &mut Command) -> Result<u64, String> {
        let mut command = match self {
            Self::Perf => program("perf"),
            Self::Valgrind => program("valgrind"),
        };
        match self {
            Self::Perf => command.args(["stat", "-x,", "-e", "instructions:u", "--"]),
            Self::Valgrind => {
                command.args(["--tool=cachegrind", "--cache-sim=no", "--cachegrind-out-file=/dev/null"])
            }
        };
        command.arg(of.get_program()).args(of.get_args());
        of.get_envs().for_each(|(key, value)| {
            value.map(|value| command.env(key, value));
        });
        let answer = command.output().map_err(|error| format!("{self:?}: {error}"))?;
        let told = String::from_utf8_lossy(&answer.stderr);
        if !answer.status.success() {
            return Err(format!("{command:?} ended with {}: {told}", answer.status));
        }
        self.read(&told).ok_or_else(|| format!("{command:?} tells no count: {told}"))
    }

    fn read(self, told: &str) -> Option<u64> {
        match self {
            Self::Perf => {
                told.lines().find(|line| line.contains("instructions"))?.split(',').next()?.parse().ok()
            }
            Self::Valgrind => {
                let (_, rest) = told
                    .lines()
                    .find(|line| line.contains("I ") && line.contains("refs:"))?
                    .split_once("refs:")?;
                rest.trim().replace(',', "").parse().ok()
            }
        }
    }
}

/// An inner loop as it is listed.
struct Loop {
    name: String,
    repeats: [u64; 2],
    about: String,
}

impl Loop {
    fn read(line: &str) -> Option<Self> {
        let mut words = line.split('\t');
        let name = words.next()?.to_owned();
        let [few, more] = [words.next()?.parse().ok()?, words.next()?.parse().ok()?];
        Some(Self { name, repeats: [few, more], about: words.next()?.to_owned() })
    }

    /// Instructions of one repeat: of more of them less those of few.
    fn count(&self, counter: Counter, command: impl Fn(&str) -> Command) -> Result<u64, String> {
        let [few, more] = self.repeats;
        let count = |count: u64| counter.count(&mut command(&format!("{}={count}", self.name)));
        Ok(count(more)?.saturating_sub(count(few)?) / (more - few))
    }
}

/// The test binary of `recon-benches`, which is built with the tests of the workspace, asked for a loop or the list of them.
fn in_tests(binary: &Path, asked: &str) -> Command {
    let mut command = program(&binary.to_string_lossy());
    command.args(["--exact", "instructions::tests::inner_loops_run", "--test-threads", "1", "--nocapture"]);
    command.env("RECON_INNER_LOOP", asked);
    command
}

fn in_release(asked: &str) -> Command {
    let mut command = program(&target().join("release/study").to_string_lossy());
    command.arg("inner_loop").args(asked.split('='));
    command
}

/// Where the test binary is, by cargo's own messages.
fn test_binary() -> Result<PathBuf, String> {
    let messages = output(&mut cargo("test --workspace --no-run --message-format=json --quiet"))?;
    let found = messages.lines().find_map(|line| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let is = message["target"]["name"] == "recon_benches" && message["profile"]["test"] == true;
        message["executable"].as_str().filter(|_| is).map(PathBuf::from)
    });
    found.ok_or_else(|| "cargo names no test binary of recon-benches".to_owned())
}

fn loops(binary: &Path) -> Result<Vec<Loop>, String> {
    let listed = output(&mut in_tests(binary, "list"))?;
    let all: Vec<Loop> = listed.lines().filter_map(Loop::read).collect();
    if all.is_empty() { Err("no inner loop is listed".to_owned()) } else { Ok(all) }
}

/// What a repeat of each loop took with the tests' build, by the table.
fn read(table: &str) -> Option<BTreeMap<&str, u64>> {
    table.lines().skip(1).map(row).collect()
}

fn row(line: &str) -> Option<(&str, u64)> {
    let mut cells = line.split(',');
    Some((cells.next()?, cells.nth(1)?.parse().ok()?))
}

/// Counts anew what the tests' build takes, and tells what changed against the committed table.
pub(crate) fn check() -> Result<Outcome, String> {
    let Some(counter) = Counter::found() else {
        return Ok(Outcome::Skipped("neither perf nor valgrind counts instructions here".to_owned()));
    };
    let text = fs::read_to_string(root().join(TABLE)).map_err(|error| format!("{TABLE}: {error}"))?;
    let table = read(&text).ok_or_else(|| format!("{TABLE} is no such table: cargo xtask instructions"))?;
    let binary = test_binary()?;
    let mut changed = Vec::new();
    for of in loops(&binary)? {
        let now = of.count(counter, |asked| in_tests(&binary, asked))?;
        say(&format!("{:<20} {now:>12} instructions", of.name));
        changed.extend(told(&of.name, table.get(of.name.as_str()).copied(), now));
    }
    Ok(if changed.is_empty() { Outcome::Passed } else { Outcome::Warned(changed.join("\n")) })
}

/// What is said of a loop whose count is another one than in the table.
fn told(name: &str, before: Option<u64>, now: u64) -> Option<String> {
    let Some(before) = before else { return Some(format!("{name}: {now} instructions, not in {TABLE}")) };
    let share = now as f64 / before.max(1) as f64 - 1.0;
    (share.abs() > TOLD).then(|| {
        format!("{name}: {now} instructions, {before} in {TABLE} ({:+.1} %); cargo xtask instructions takes them over", 100.0 * share)
    })
}

/// Counts all anew, of both builds, and writes the table.
pub(crate) fn main() -> ExitCode {
    exit_code(write())
}

fn write() -> Result<(), String> {
    let counter = Counter::found().ok_or("neither perf nor valgrind counts instructions here")?;
    run(&mut cargo("build --release --package recon-benches --package recon-touch-cli"))?;
    let binary = test_binary()?;
    let mut table = format!("{HEAD}\n");
    for of in loops(&binary)? {
        let [release, tests] =
            [of.count(counter, in_release)?, of.count(counter, |asked| in_tests(&binary, asked))?];
        say(&format!("{:<20} {release:>12} {tests:>12}", of.name));
        table += &format!("{},{release},{tests},\"{}\"\n", of.name, of.about);
    }
    fs::write(root().join(TABLE), table).map_err(|error| format!("{TABLE}: {error}"))?;
    println!("wrote {TABLE}");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_read_from_what_the_programs_tell() {
        let perf = "123456,,instructions:u,1000,100.00,,\n";
        assert_eq!(Counter::Perf.read(perf), Some(123_456));
        assert_eq!(Counter::Perf.read("<not supported>,,instructions:u,0,100.00,,\n"), None);
        let valgrind = "==1== Cachegrind\n==1== \n==1== I   refs:      28,808,583\n";
        assert_eq!(Counter::Valgrind.read(valgrind), Some(28_808_583));
        assert_eq!(Counter::Valgrind.read("==1== I refs:        678,046\n"), Some(678_046));
    }

    #[test]
    fn a_change_of_more_than_a_twentieth_is_told_with_both_numbers() {
        assert_eq!(told("a", Some(1000), 1049), None);
        assert_eq!(told("a", Some(1000), 951), None);
        let words = told("a", Some(1000), 1100).expect("a tenth");
        assert!(words.contains("1100") && words.contains("1000") && words.contains("+10.0 %"), "{words}");
        assert!(told("b", None, 5).is_some_and(|words| words.contains("not in")));
    }

    #[test]
    fn the_table_and_the_list_are_read() {
        let table = read("loop,a,b,c\nhull,10,20,\"of points, many\"\n").expect("a table");
        assert_eq!(table.get("hull"), Some(&20));
        assert!(read("loop,a,b,c\nhull,x,y,z\n").is_none());
        let of = Loop::read("hull\t1\t3\tof points").expect("a line");
        assert_eq!((of.name.as_str(), of.repeats, of.about.as_str()), ("hull", [1, 3], "of points"));
        assert!(Loop::read("running 1 test").is_none());
    }
}
