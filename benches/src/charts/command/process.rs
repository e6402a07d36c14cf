//! What a process uses until it ends, as Linux tells it; elsewhere the wall time alone is known, and the rest is not a number.

use std::fs::read_to_string;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// What a process used.
#[derive(Clone, Copy, Debug)]
pub(super) struct Used {
    /// s.
    pub(super) wall: f64,
    /// Of all its threads, s.
    pub(super) processor: f64,
    /// The most that was resident at once.
    pub(super) megabytes: f64,
}

/// Ticks of processor times in a second: what Linux shows to programs on all machines.
const TICKS: f64 = 100.0;
/// Between looks at the memory: what is taken and given back within it may be missed.
const LOOK: Duration = Duration::from_millis(1);

/// Runs a command to its end; codes 0 and 4 (done with reservations) are good.
pub(super) fn used(command: &mut Command) -> Result<Used, String> {
    let shown = format!("{command:?}");
    let wrong = |error: std::io::Error| format!("{shown}: {error}");
    let before = of_children();
    let clock = Instant::now();
    let mut child =
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().map_err(wrong)?;
    let mut kilobytes = f64::NAN;
    let status = loop {
        kilobytes = most_resident(child.id()).map_or(kilobytes, |now| now.max(kilobytes));
        match child.try_wait().map_err(wrong)? {
            Some(status) => break status,
            None => std::thread::sleep(LOOK),
        }
    };
    let wall = clock.elapsed().as_secs_f64();
    if !matches!(status.code(), Some(0 | 4)) {
        return Err(format!("{shown} ended with {status}"));
    }
    let ticks = of_children().zip(before).map_or(f64::NAN, |(after, before)| after - before);
    Ok(Used { wall, processor: ticks / TICKS, megabytes: kilobytes / 1024.0 })
}

/// The most memory that a process had so far, kB.
fn most_resident(process: u32) -> Option<f64> {
    let status = read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    line.split_whitespace().nth(1)?.parse().ok()
}

/// Processor time of all processes that this one waited for, in ticks: their sum is counted finely, so that many short ones lose nothing.
fn of_children() -> Option<f64> {
    let stat = read_to_string("/proc/self/stat").ok()?;
    // The name, in brackets, may hold anything.
    let (_, rest) = stat.rsplit_once(')')?;
    let fields: Vec<&str> = rest.split_whitespace().collect();
    let [user, system] = [13, 14].map(|k| fields.get(k).and_then(|ticks| ticks.parse::<f64>().ok()));
    Some(user? + system?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_process_that_is_there_is_timed_and_one_that_fails_is_an_error() {
        let told = used(Command::new("rustc").arg("--version")).expect("it compiled this");
        // Not told is no number.
        let within = |value: f64, most: f64| value.is_nan() || (0.0..most).contains(&value);
        assert!(told.wall > 0.0 && within(told.processor, 10.0) && within(told.megabytes, 1e5), "{told:?}");
        assert!(used(Command::new("rustc").arg("--no-such-option")).is_err());
    }
}
