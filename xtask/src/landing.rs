//! The landing page of a crate: its documentation's first page, which is its README.md as well, and the example on it.

use std::path::{Path, PathBuf};

use crate::metadata::{Edge, Kind, Metadata, Package};

/// What stands at the end of each README.md.
const FOOTER: &str = "\n## Licence\n\nMIT or Apache-2.0, at your choice.\n";

/// The folder of a member.
pub(crate) fn folder(package: &Package) -> PathBuf {
    Path::new(&package.manifest).parent().map(Path::to_owned).unwrap_or_default()
}

/// The lines of a crate's first page.
pub(crate) fn page(package: &Package) -> Result<Vec<String>, String> {
    let path = folder(package).join("src/lib.rs");
    let source = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let lines = source.lines().map_while(|line| line.strip_prefix("//!"));
    let lines: Vec<String> = lines.map(|line| line.strip_prefix(' ').unwrap_or(line).to_owned()).collect();
    if lines.is_empty() { Err(format!("{}: has no first page", path.display())) } else { Ok(lines) }
}

/// README.md from the first page: hidden lines of examples left out, links to items, which only rustdoc resolves, as plain code.
pub(crate) fn readme(metadata: &Metadata, package: &Package, page: &[String]) -> String {
    let mut text = format!("# {}\n\n", package.name);
    if package.library != package.name.replace('-', "_") {
        text += &format!("The library of this package is called `{}`.\n\n", package.library);
    }
    let mut in_code = false;
    for line in page {
        if line.starts_with("```") {
            in_code = !in_code;
            text += if in_code && line == "```" { "```rust" } else { line };
        } else if in_code {
            if line == "#" || line.starts_with("# ") {
                continue;
            }
            text += line;
        } else if line.starts_with('#') {
            text += &format!("#{line}");
        } else {
            text += &without_item_links(line);
        }
        text.push('\n');
    }
    text += &spoken(metadata, package);
    text + FOOTER
}

/// Which versions of the libraries of vectors and matrices a package speaks: another version is another type.
fn spoken(metadata: &Metadata, package: &Package) -> String {
    let named = |edge: &&Edge| edge.kinds.contains(&Kind::Normal);
    let versions = package.edges.iter().filter(named).map(|edge| &metadata.packages[edge.to]);
    let versions = versions.filter(|other| ["glam", "nalgebra"].contains(&other.name.as_str()));
    let mut versions: Vec<String> = versions
        .map(|other| {
            let numbers: Vec<&str> = other.version.split('.').take(2).collect();
            format!("{} {}", other.name, numbers.join("."))
        })
        .collect();
    versions.sort_unstable();
    if versions.is_empty() {
        return String::new();
    }
    format!(
        "\nVectors and matrices are those of {}: another version would be other types.\n",
        versions.join(" and ")
    )
}

/// The first example of a page as a program.
pub(crate) fn example(page: &[String]) -> Option<String> {
    let code =
        page.iter().skip_while(|line| *line != "```").skip(1).take_while(|line| !line.starts_with("```"));
    let shown = |line: &String| match line.strip_prefix("# ") {
        Some(hidden) => hidden.to_owned(),
        None => line.trim_start_matches('#').to_owned(),
    };
    let code: Vec<String> =
        code.map(|line| if line.starts_with("#[") { line.clone() } else { shown(line) }).collect();
    let code = code.join("\n");
    if code.is_empty() {
        return None;
    }
    Some(if code.contains("fn main()") { code } else { format!("fn main() {{\n{code}\n}}") })
}

/// A line whose links to items are plain code: [`Hull`] and [`Hull`](crate::Hull) become `Hull`.
fn without_item_links(line: &str) -> String {
    let mut text = String::new();
    let mut rest = line;
    while let Some(at) = rest.find("[`") {
        text += &rest[..at];
        let Some(end) = rest[at..].find("`]") else { break };
        text += &rest[at + 1..at + end + 1];
        rest = &rest[at + end + 2..];
        if let Some(target) = rest.strip_prefix('(')
            && let Some(close) = target.find(')')
        {
            rest = &target[close + 1..];
        }
    }
    text + rest
}

/// Writes README.md of all crates that are published; says which have changed.
pub(crate) fn write() -> Result<Vec<String>, String> {
    let mut changed = Vec::new();
    let metadata = Metadata::load()?;
    for package in metadata.published() {
        let path = folder(package).join("README.md");
        let text = readme(&metadata, package, &page(package)?);
        if std::fs::read_to_string(&path).is_ok_and(|old| old == text) {
            continue;
        }
        std::fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))?;
        changed.push(path.display().to_string());
    }
    Ok(changed)
}

/// One line for each README.md that is not the first page.
pub(crate) fn complaints(metadata: &Metadata) -> Vec<String> {
    let one = |package: &Package| {
        let page = match page(package) {
            Ok(page) => page,
            Err(complaint) => return Some(complaint),
        };
        let text = std::fs::read_to_string(folder(package).join("README.md")).unwrap_or_default();
        let name = &package.name;
        if example(&page).is_none() {
            return Some(format!("{name}: its first page has no example"));
        }
        (text != readme(metadata, package, &page)).then(|| {
            format!("{name}: README.md is not the first page of src/lib.rs: run `cargo xtask readme`")
        })
    };
    metadata.published().filter_map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(text: &str) -> Vec<String> {
        text.lines().map(str::to_owned).collect()
    }

    #[test]
    fn links_to_items_are_plain_code_and_others_stay() {
        let line =
            "Take [`Hull`] or [`of`](crate::Hull::of), see [the paper](https://example.org) and `[x]`.";
        let expected = "Take `Hull` or `of`, see [the paper](https://example.org) and `[x]`.";
        assert_eq!(without_item_links(line), expected);
    }

    #[test]
    fn an_example_is_a_program_with_its_hidden_lines_and_the_readme_is_without_them() {
        let page = lines(
            "Text.\n# Start here\n\n```\nuse a::b;\n# fn main() {\n#[allow(unused)]\nlet x = b();\n# }\n```\nMore.",
        );
        let program = example(&page).expect("there is one");
        assert_eq!(program, "use a::b;\nfn main() {\n#[allow(unused)]\nlet x = b();\n}");
        let mut metadata = crate::metadata::made_up::workspace(&["a-b: glam@0.33.1", "|glam@0.33.1:"]);
        metadata.packages[0].library = "b".to_owned();
        let text = readme(&metadata, &metadata.packages[0], &page);
        assert!(
            text.starts_with("# a-b\n\nThe library of this package is called `b`.\n\nText.\n## Start here\n"),
            "{text}"
        );
        assert!(text.contains("```rust\nuse a::b;\n#[allow(unused)]\nlet x = b();\n```\nMore.\n\nVectors and matrices are those of glam 0.33: another"), "{text}");
    }
}
