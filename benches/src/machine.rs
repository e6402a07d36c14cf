//! What a measured time was measured on, in one line.

use std::process::Command;
use std::thread::available_parallelism;

/// Processor, cores, system, compiler and build profile of this run, for the foot of a chart.
///
/// What cannot be found out is left out; nothing here fails.
#[must_use]
pub fn machine_line() -> String {
    let mut parts = Vec::new();
    parts.extend(std::fs::read_to_string("/proc/cpuinfo").ok().as_deref().and_then(model_name));
    parts.extend(available_parallelism().ok().map(|n| format!("{n} cores")));
    parts.push(format!("{} {}", std::env::consts::OS, std::env::consts::ARCH));
    parts.extend(compiler());
    if cfg!(debug_assertions) {
        parts.push("debug build: times mean nothing".to_owned());
    }
    parts.join(", ")
}

/// Programs that ran or waited for a core over the last minute, in words for a diagram of wall times; empty where that is not told.
#[must_use]
pub fn load() -> String {
    let told = std::fs::read_to_string("/proc/loadavg").unwrap_or_default();
    let mean = told.split_whitespace().next().and_then(|mean| mean.parse::<f64>().ok());
    let cores = available_parallelism().map_or(1, usize::from);
    mean.map_or_else(String::new, |mean| format!("; load of the machine then {mean:.0} on {cores} cores"))
}

fn model_name(cpuinfo: &str) -> Option<String> {
    let line = cpuinfo.lines().find(|line| line.starts_with("model name"))?;
    let (_, name) = line.split_once(':')?;
    Some(name.split_whitespace().collect::<Vec<_>>().join(" "))
}

fn compiler() -> Option<String> {
    let answer = Command::new("rustc").arg("--version").output().ok()?;
    let line = String::from_utf8(answer.stdout).ok()?;
    let mut words = line.split_whitespace();
    Some(format!("{} {}", words.next()?, words.next()?))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_name_is_taken_from_cpuinfo() {
        let cpuinfo = "processor\t: 0\nmodel name\t: Some  Processor @ 2 GHz\nflags\t: a b\n";
        assert_eq!(model_name(cpuinfo).as_deref(), Some("Some Processor @ 2 GHz"));
        assert_eq!(model_name("processor\t: 0\n"), None);
    }

    #[test]
    fn a_test_build_says_that_its_times_mean_nothing() {
        assert_eq!(machine_line().contains("debug build"), cfg!(debug_assertions));
    }
}
