//! One page with all diagrams that lie in a folder: self-contained, each with its command, machine, commit and table.

use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;

/// Stems of diagrams that studies draw, with the study; the others are drawn by `cargo xtask chart` under the name that [`of_chart`] tells.
const OF_STUDIES: &[(&str, &str)] = &[
    ("contact-cost", "contact_cost"),
    ("approximations", "approximations"),
    ("least-model", "least_model"),
    ("mode-switches", "mode_switches"),
    ("nonsmooth", "nonsmooth"),
    ("palms-", "palms"),
    ("planar-observability", "planar_observability"),
    ("pushes", "pushes"),
];

/// Titles of diagrams that have none in the picture.
const TITLES: &[(&str, &str)] = &[
    ("approximations", "Approximations of shapes: error by number of contacts"),
    ("mode-switches", "Contact modes told as they switch"),
    ("nonsmooth", "Corners, edges and faces told from contacts"),
    ("planar-observability", "Observability in the plane, along S1 to S4"),
    ("pushes", "Friction and outlines from pushes"),
];

/// Charts of several diagrams, by the stems of these.
const OF_CHARTS: &[(&str, &str)] = &[
    ("reaching-", "reaching"),
    ("rolling-", "rolling"),
    ("bounds-", "bounds"),
    ("command-", "command"),
    ("planar-reconstruction-", "planar-reconstruction"),
    ("streaming-", "streaming"),
];

/// Tables beside the folder of diagrams that the page ends with: file, title, command.
const TABLES: &[(&str, &str, &str)] = &[
    ("instructions.csv", "Instructions of the inner loops", "cargo xtask instructions"),
    ("crates.csv", "Compile time and dependencies of each crate", "cargo xtask compile-times"),
];

/// The column that names the machine.
const ORIGIN: &str = "origin";
/// Rows of a table that are shown.
const MOST_ROWS: usize = 200;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;margin:0 auto;max-width:1080px;padding:16px;color:#1f2933;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin:2.2rem 0 .4rem}p{margin:.3rem 0}a{color:#0b69a3}\
.figure{overflow-x:auto;border:1px solid #d9dee3;border-radius:6px;background:#fcfcfd}.figure img{display:block;width:100%;min-width:620px;height:auto}\
.of{color:#52606d;font-size:.85rem;overflow-wrap:anywhere}code{font:.85em ui-monospace,monospace;background:#eef1f4;padding:1px 4px;border-radius:3px}\
details{margin:.4rem 0}.table{overflow-x:auto;max-height:420px}table{border-collapse:collapse;font-size:.8rem}td,th{border-bottom:1px solid #e4e7eb;padding:2px 8px;text-align:left;white-space:nowrap}\
nav a{display:inline-block;margin:0 .9rem .2rem 0}\
@media(prefers-color-scheme:dark){body{background:#15181c;color:#e4e7eb}a{color:#6cb6e6}.of{color:#9aa5b1}code{background:#252b31}.figure{border-color:#333b43}td,th{border-color:#2b3239}}";

/// Writes `index.html` into a folder of diagrams; tells how many there are.
///
/// # Errors
/// A folder or file that cannot be read or written.
pub fn write_page(folder: &Path) -> std::io::Result<usize> {
    let mut stems: Vec<String> = fs::read_dir(folder)?
        .filter_map(|entry| {
            entry.ok()?.file_name().into_string().ok()?.strip_suffix(".svg").map(str::to_owned)
        })
        .collect();
    stems.sort();
    let mut page = format!(
        "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\
         <title>recon: charts</title><style>{STYLE}</style></head><body><h1>Charts</h1>\
         <p>Cost against error, and what is known after how much: each diagram with the command that draws it anew, the machine and the commit that it is of, and its figures. \
         A method has the same colour wherever it is shown. Where methods fail is in the <a href=\"../atlas.md\">atlas of failures</a>.</p><nav>"
    );
    let mut bodies = String::new();
    for stem in &stems {
        let svg = fs::read_to_string(folder.join(format!("{stem}.svg")))?;
        let csv = fs::read_to_string(folder.join(format!("{stem}.csv"))).unwrap_or_default();
        let known = TITLES.iter().find(|(of, _)| of == stem).map(|(_, title)| (*title).to_owned());
        let title = known.or_else(|| title(&svg)).unwrap_or_else(|| stem.replace('-', " "));
        let _ = write!(page, "<a href=\"#{stem}\">{}</a>", escaped(&title));
        bodies += &section(stem, &title, &svg, &csv, &commit(folder, &format!("{stem}.svg")));
    }
    for (file, title, command) in TABLES {
        let Ok(csv) = fs::read_to_string(folder.join("..").join(file)) else { continue };
        let stem = file.trim_end_matches(".csv");
        let _ = write!(page, "<a href=\"#{stem}\">{}</a>", escaped(title));
        let _ = write!(
            bodies,
            "<h2 id=\"{stem}\">{}</h2><p class=\"of\"><code>{command}</code>{}; what it is: <a href=\"../cost.md\">cost</a></p>{}",
            escaped(title),
            commit(&folder.join(".."), file),
            table(&csv)
        );
    }
    let _ = writeln!(page, "</nav>{bodies}</body></html>");
    fs::write(folder.join("index.html"), page)?;
    Ok(stems.len())
}

fn section(stem: &str, title: &str, svg: &str, csv: &str, commit: &str) -> String {
    let rows: Vec<Vec<String>> = csv.lines().map(cells).collect();
    let origin = rows.first().and_then(|head| head.iter().position(|name| name == ORIGIN));
    let mut machines: Vec<&str> =
        rows.iter().skip(1).filter_map(|row| row.get(origin?).map(String::as_str)).collect();
    machines.sort_unstable();
    machines.dedup();
    let command = command(stem);
    let mut text = format!(
        "<h2 id=\"{stem}\">{}</h2><div class=\"figure\"><img alt=\"{}\" src=\"data:image/svg+xml,{}\"></div><p class=\"of\"><code>{command}</code>{commit}",
        escaped(title),
        escaped(title),
        encoded(svg)
    );
    if !machines.is_empty() {
        let _ = write!(text, " &middot; {}", escaped(&machines.join("; ")));
    }
    text += "</p>";
    if rows.len() > 1 {
        let _ = write!(text, "<details><summary>{} rows</summary>{}</details>", rows.len() - 1, table(csv));
    }
    text
}

/// As rows and columns, without columns that are empty and that of the machine.
fn table(csv: &str) -> String {
    let rows: Vec<Vec<String>> = csv.lines().map(cells).collect();
    let Some((head, rows)) = rows.split_first() else { return String::new() };
    let kept: Vec<usize> = (0..head.len())
        .filter(|k| head[*k] != ORIGIN && rows.iter().any(|row| row.get(*k).is_some_and(|c| !c.is_empty())))
        .collect();
    let row = |cells: &[String], tag: &str| {
        let cells: String = kept
            .iter()
            .map(|k| format!("<{tag}>{}</{tag}>", escaped(cells.get(*k).map_or("", |cell| cell))))
            .collect();
        format!("<tr>{cells}</tr>")
    };
    let body: String = rows.iter().take(MOST_ROWS).map(|cells| row(cells, "td")).collect();
    format!("<div class=\"table\"><table>{}{body}</table></div>", row(head, "th"))
}

/// What draws it.
fn command(stem: &str) -> String {
    let of = |list: &[(&str, &'static str)]| {
        list.iter().find(|(start, _)| stem.starts_with(start)).map(|(_, name)| *name)
    };
    match of(OF_STUDIES) {
        Some(study) => format!("cargo xtask study {study}"),
        None => format!("cargo xtask chart {}", of(OF_CHARTS).unwrap_or(stem)),
    }
}

/// The commit in which the diagram was drawn last, where there is a repository.
fn commit(folder: &Path, file: &str) -> String {
    let asked =
        Command::new("git").args(["log", "-1", "--format=%h, %as", "--", file]).current_dir(folder).output();
    let told = asked.ok().and_then(|output| String::from_utf8(output.stdout).ok()).unwrap_or_default();
    let told = told.trim();
    if told.is_empty() { String::new() } else { format!(" &middot; commit {told}") }
}

/// The first words of a drawing that are as large as a title.
fn title(svg: &str) -> Option<String> {
    let large = |text: &&str| {
        let size = text.split("font-size=\"").nth(1).and_then(|rest| rest.split('"').next());
        size.and_then(|size| size.trim_end_matches("px").parse::<f64>().ok()).is_some_and(|size| size >= 14.0)
    };
    let text = svg.split("<text").skip(1).find(large)?;
    let words = text.split_once('>')?.1.split("</text>").next()?;
    let plain: String =
        words.split('<').map(|part| part.split_once('>').map_or(part, |(_, rest)| rest)).collect();
    let plain = plain.trim().replace("&apos;", "'").replace("&#39;", "'").replace("&amp;", "&");
    (!plain.is_empty()).then_some(plain)
}

/// Cells of a row of CSV.
fn cells(line: &str) -> Vec<String> {
    let (mut all, mut quoted) = (vec![String::new()], false);
    let mut chars = line.chars().peekable();
    while let Some(c) = chars.next() {
        match c {
            '"' if quoted && chars.peek() == Some(&'"') => {
                chars.next();
                all.last_mut().into_iter().for_each(|cell| cell.push('"'));
            }
            '"' => quoted = !quoted,
            ',' if !quoted => all.push(String::new()),
            _ => all.last_mut().into_iter().for_each(|cell| cell.push(c)),
        }
    }
    all
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// As part of an address.
fn encoded(svg: &str) -> String {
    let mut text = String::with_capacity(svg.len() * 5 / 4);
    for c in svg.chars() {
        match c {
            '%' => text += "%25",
            '#' => text += "%23",
            '"' => text += "%22",
            '<' => text += "%3C",
            '>' => text += "%3E",
            '&' => text += "%26",
            '\n' => text.push(' '),
            c => text.push(c),
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_of_csv_reads_as_it_was_written() {
        assert_eq!(cells("a,\"b,c\",\"say \"\"d\"\"\","), ["a", "b,c", "say \"d\"", ""]);
    }

    #[test]
    fn a_section_has_command_machine_table_and_a_picture_without_a_quote_in_its_address() {
        let svg = "<svg><text font-size=\"11\">10</text><text x=\"1\" font-size=\"18\"><tspan>Errors &amp; cost</tspan></text></svg>";
        let csv = "method,setting,failure,origin\nm,\"1, 2\",,some machine\n";
        let title = title(svg).unwrap();
        assert_eq!(title, "Errors & cost");
        let html = section("reaching-plane", &title, svg, csv, "");
        assert!(html.contains("cargo xtask chart reaching<") && html.contains("some machine"), "{html}");
        assert!(html.contains("<td>1, 2</td>") && !html.contains("<th>failure"), "{html}");
        let address = html.split("src=\"").nth(1).and_then(|rest| rest.split('"').next()).unwrap();
        assert!(!address.contains(['<', '#', '\n']), "{address}");
    }
}
