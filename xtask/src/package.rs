//! Packages as a registry would hold them, and new projects that depend on them.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use crate::cargo::{cargo, exit_code, program, root, run, target};
use crate::landing;
use crate::metadata::{Metadata, Package};
use crate::names;
use crate::steps::Outcome;

/// What each package holds beside its code.
const HELD: [&str; 4] = ["README.md", "CHANGELOG.md", "LICENSE-MIT", "LICENSE-APACHE"];

/// Makes all packages, without building them: a second.
pub(crate) fn made(metadata: &Metadata) -> Result<(), String> {
    let names: Vec<String> =
        metadata.published().map(|package| format!("--package {}", package.name)).collect();
    run(&mut cargo(&format!("package --offline --allow-dirty --no-verify --quiet {}", names.join(" "))))
}

/// The step of `verify`.
pub(crate) fn check() -> Result<Outcome, String> {
    let metadata = Metadata::load()?;
    let mut complaints = landing::complaints(&metadata);
    complaints.extend(names::complaints(&metadata)?);
    for package in metadata.published() {
        let folder = landing::folder(package);
        complaints.extend(lacking(package, &folder));
        complaints.extend(from_outside(&folder)?);
    }
    if !complaints.is_empty() {
        return Err(complaints.join("\n"));
    }
    made(&metadata)?;
    Ok(Outcome::Passed)
}

/// The optional step of `verify`: the example of each first page, from the packages, alone.
pub(crate) fn examples() -> Result<Outcome, String> {
    let metadata = Metadata::load()?;
    made(&metadata)?;
    tried(&metadata, &[]).map(|()| Outcome::Passed)
}

fn lacking(package: &Package, folder: &Path) -> Vec<String> {
    let name = &package.name;
    let files = HELD.into_iter().filter(|file| !folder.join(file).is_file());
    let files = files.map(|file| format!("{name}: no {file}"));
    let fields = package.lacking.iter().map(|field| format!("{name}: its manifest has no {field}"));
    files.chain(fields).collect()
}

/// One line for each file that code which is packaged includes from outside of its crate's folder.
fn from_outside(folder: &Path) -> Result<Vec<String>, String> {
    let mut complaints = Vec::new();
    for path in sources(&folder.join("src"))? {
        let text = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
        let depth = path.strip_prefix(folder).map_or(0, |inside| inside.components().count() - 1);
        for included in includes(&text) {
            if included.split('/').take_while(|part| *part == "..").count() > depth {
                complaints.push(format!("{}: includes {included}, outside of its crate", path.display()));
            }
        }
    }
    Ok(complaints)
}

/// The paths that a source includes when it is compiled.
fn includes(text: &str) -> impl Iterator<Item = &str> {
    ["include_str!(\"", "include_bytes!(\"", "include!(\""].into_iter().flat_map(move |call| {
        text.match_indices(call).filter_map(move |(at, _)| text[at + call.len()..].split('"').next())
    })
}

/// All Rust sources below a folder.
fn sources(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(folder) = folders.pop() {
        let entries = std::fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for path in entries.filter_map(Result::ok).map(|entry| entry.path()) {
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "rs") {
                found.push(path);
            }
        }
    }
    Ok(found)
}

/// `cargo xtask package`: all packages; with `--try`, a new project for each, outside of the workspace, that builds and runs the example
/// of its first page (of those that are named, if any are).
pub(crate) fn main(words: impl Iterator<Item = String>) -> ExitCode {
    let words: Vec<String> = words.collect();
    let (options, names): (Vec<_>, Vec<_>) = words.into_iter().partition(|word| word.starts_with("--"));
    if options.iter().any(|option| option != "--try") {
        eprintln!("unknown option {}: there is --try", options.join(" "));
        return ExitCode::from(2);
    }
    let done = Metadata::load().and_then(|metadata| {
        made(&metadata)?;
        if options.is_empty() { Ok(()) } else { tried(&metadata, &names) }
    });
    exit_code(done)
}

fn tried(metadata: &Metadata, names: &[String]) -> Result<(), String> {
    let place = std::env::temp_dir().join(format!("recon-packages-{}", std::process::id()));
    let unpacked = place.join("packages");
    std::fs::create_dir_all(&unpacked).map_err(|error| format!("{}: {error}", unpacked.display()))?;
    for package in metadata.published() {
        let file = target().join("package").join(format!("{}-{}.crate", package.name, package.version));
        run(program("tar").arg("-xzf").arg(root().join(file)).arg("-C").arg(&unpacked))?;
    }
    let mut complaints = Vec::new();
    for package in metadata.published().filter(|package| names.is_empty() || names.contains(&package.name)) {
        match tried_alone(metadata, package, &place) {
            Ok(()) => println!("{}: its example runs", package.name),
            Err(complaint) => complaints.push(complaint),
        }
    }
    std::fs::remove_dir_all(&place).map_err(|error| format!("{}: {error}", place.display()))?;
    if complaints.is_empty() { Ok(()) } else { Err(complaints.join("\n")) }
}

/// Builds and runs a program that is the example of a package's first page, with nothing of the workspace.
fn tried_alone(metadata: &Metadata, package: &Package, place: &Path) -> Result<(), String> {
    let program = landing::example(&landing::page(package)?).ok_or("no example")?;
    let project = place.join("projects").join(&package.name);
    let write = |name: &str, text: &str| {
        let path = project.join(name);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(path, text)
    };
    let manifest = manifest(metadata, &program, &place.join("packages"));
    write("Cargo.toml", &manifest)
        .and_then(|()| write("src/main.rs", &program))
        .map_err(|error| format!("{}: {error}", project.display()))?;
    let mut command = cargo("run --offline --quiet");
    run(command.current_dir(&project).env("CARGO_TARGET_DIR", place.join("target")))
        .map_err(|complaint| format!("{}: {complaint}", package.name))
}

/// The manifest of a project whose only dependencies are the crates that its program names. What is not on the registry yet comes from
/// the unpacked packages.
fn manifest(metadata: &Metadata, program: &str, unpacked: &Path) -> String {
    let mut text = "[package]\nname = \"tried\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[dependencies]\n".to_owned();
    let named = |library: &str| program.contains(&format!("{library}::"));
    for package in metadata.published().filter(|package| named(&package.library)) {
        text += &format!(
            "{} = {{ package = \"{}\", version = \"{}\" }}\n",
            package.library, package.name, package.version
        );
    }
    for library in ["glam", "nalgebra"].into_iter().filter(|library| named(library)) {
        let version = version_of(metadata, library).unwrap_or("*");
        // The least of it, as the members have it: the rest may never have been downloaded here.
        text += &format!(
            "{library} = {{ version = \"{version}\", default-features = false, features = [\"std\"] }}\n"
        );
    }
    text += "\n[patch.crates-io]\n";
    for package in metadata.published() {
        let folder = unpacked.join(format!("{}-{}", package.name, package.version));
        text += &format!("{} = {{ path = {:?} }}\n", package.name, folder);
    }
    text
}

/// The version of a library that the members build on; others may be in the tree beside it.
fn version_of<'a>(metadata: &'a Metadata, library: &str) -> Option<&'a str> {
    let edges = metadata.published().flat_map(|member| &member.edges);
    let found = edges.map(|edge| &metadata.packages[edge.to]).find(|package| package.name == library);
    found.map(|package| package.version.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metadata::made_up::workspace;

    #[test]
    fn what_is_included_is_found() {
        let text = concat!("x(include_str!", "(\"../a\")); include_bytes!", "(\"b/c\")");
        assert_eq!(includes(text).collect::<Vec<_>>(), ["../a", "b/c"]);
    }

    #[test]
    fn a_project_depends_on_what_its_program_names() {
        let mut metadata = workspace(&["ab-c: glam@1.0.0", "d:", "|glam@0.9.0:", "|glam@1.0.0:"]);
        metadata.packages[0].library = "c".to_owned();
        let text = manifest(&metadata, "use c::X; use glam::DVec3;", Path::new("p"));
        assert!(
            text.contains("\nc = { package = \"ab-c\", version = \"1.0.0\" }\nglam = { version = \"1.0.0\", default-features = false"),
            "{text}"
        );
        assert!(text.contains("[patch.crates-io]\nab-c = { path = \"p/ab-c-1.0.0\" }\nd = {"), "{text}");
    }

    #[test]
    fn this_workspace_can_be_published() {
        let metadata = Metadata::load().expect("cargo describes this workspace");
        assert!(metadata.published().count() > 8);
        let unpublished = |name: &str| metadata.published().all(|package| package.name != name);
        assert!(unpublished("xtask") && unpublished("recon-tests"));
    }
}
