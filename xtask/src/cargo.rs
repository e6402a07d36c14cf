//! Calls of cargo and of other programs, each shown before it runs.

use std::cell::RefCell;
use std::io;
use std::path::PathBuf;
use std::process::{Command, ExitCode, Stdio};

/// The folder of the workspace.
pub(crate) fn root() -> PathBuf {
    let xtask = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    xtask.parent().map(PathBuf::from).unwrap_or(xtask)
}

/// A program in the folder of the workspace.
pub(crate) fn program(name: &str) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root()).stdin(Stdio::null());
    command
}

/// The cargo that runs this task, with its arguments given as one line.
pub(crate) fn cargo(line: &str) -> Command {
    let name = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let mut command = program(&name);
    command.args(line.split_whitespace());
    command
}

thread_local! {
    /// What a thread that runs beside the others has to show.
    static HELD: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Holds what this thread would show while it does this.
pub(crate) fn holding<T>(work: impl FnOnce() -> T) -> (T, String) {
    HELD.set(Some(String::new()));
    let done = work();
    (done, HELD.take().unwrap_or_default())
}

/// Shows a line, or holds it.
pub(crate) fn say(line: &str) {
    HELD.with_borrow_mut(|held| match held {
        Some(held) => *held += &format!("{line}\n"),
        None => println!("{line}"),
    });
}

/// Runs a command with its output shown, or held; an error says which command failed.
pub(crate) fn run(command: &mut Command) -> Result<(), String> {
    let shown = show(command);
    say(&format!("$ {shown}"));
    let ended = if HELD.with_borrow(Option::is_some) {
        command.output().map(|answer| {
            [answer.stdout, answer.stderr]
                .iter()
                .for_each(|text| say(String::from_utf8_lossy(text).trim_end()));
            answer.status
        })
    } else {
        command.status()
    };
    match ended {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("`{shown}` ended with {status}")),
        Err(error) => Err(format!("`{shown}` cannot be run: {error}")),
    }
}

/// Where cargo builds.
pub(crate) fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// The command `recon`, built as the tests of the workspace have it: alone it would have other features, and all beneath it be built again.
pub(crate) fn recon() -> Result<PathBuf, String> {
    run(&mut cargo("build --workspace --tests --bin recon"))?;
    Ok(target().join("debug").join(format!("recon{}", std::env::consts::EXE_SUFFIX)))
}

/// Runs a command and takes its standard output.
pub(crate) fn output(command: &mut Command) -> Result<String, String> {
    let shown = show(command);
    let answer = command.output().map_err(|error| format!("`{shown}` cannot be run: {error}"))?;
    if !answer.status.success() {
        let complaint = String::from_utf8_lossy(&answer.stderr).trim().to_owned();
        return Err(format!("`{shown}` ended with {}: {complaint}", answer.status));
    }
    String::from_utf8(answer.stdout).map_err(|error| format!("`{shown}` wrote what is no text: {error}"))
}

/// Whether a cargo subcommand is installed.
pub(crate) fn has_subcommand(name: &str) -> bool {
    let asked = cargo(name).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    matches!(asked, io::Result::Ok(status) if status.success())
}

/// The command as it would be typed, with the variables set for it.
fn show(command: &Command) -> String {
    let variables =
        command.get_envs().filter_map(|(key, value)| Some(format!("{}={:?}", key.to_string_lossy(), value?)));
    let name = std::path::Path::new(command.get_program()).file_stem().unwrap_or(command.get_program());
    let words =
        std::iter::once(name).chain(command.get_args()).map(|word| word.to_string_lossy().into_owned());
    variables.chain(words).collect::<Vec<_>>().join(" ")
}

/// The exit code of what was done, whose complaint is told.
pub(crate) fn exit_code(done: Result<(), String>) -> ExitCode {
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}
