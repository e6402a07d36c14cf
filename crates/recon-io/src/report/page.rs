use super::data::{ReportData, ReportError};
use super::encode::encode;
use std::io::{self, Write};

const HEAD: &str = include_str!("assets/head.html");
const PAGE: &str = include_str!("assets/page.html");
const STYLE: &str = include_str!("assets/style.css");

/// The page's script, in the order in which its parts build on each other.
const SCRIPT: [&str; 8] = [
    include_str!("assets/math.js"),
    include_str!("assets/geometry.js"),
    include_str!("assets/webgl.js"),
    include_str!("assets/painter.js"),
    include_str!("assets/stage.js"),
    include_str!("assets/chart.js"),
    include_str!("assets/figures.js"),
    include_str!("assets/main.js"),
];

/// Writes the report as one HTML page that needs nothing else: no network, no other file.
///
/// # Errors
/// [`ReportError`] (as [`io::ErrorKind::InvalidInput`]) when the tracks do not fit together, and those of `to`.
pub fn write_report(data: &ReportData, to: impl Write) -> io::Result<()> {
    data.check().map_err(|e: ReportError| io::Error::new(io::ErrorKind::InvalidInput, e))?;
    let json = serde_json::to_string(&encode(data))?;
    let parts = [
        ("head", head(&data.title, "")?),
        ("title", escape_text(&data.title)),
        ("data", escape_script(&json)),
        ("script", SCRIPT.concat()),
    ];
    fill(PAGE, &parts, to)
}

/// The head that all pages share, with what a page adds to their style.
pub(super) fn head(title: &str, style: &str) -> io::Result<String> {
    let mut head = Vec::new();
    fill(HEAD, &[("title", escape_text(title)), ("style", STYLE.to_owned() + style)], &mut head)?;
    Ok(String::from_utf8_lossy(&head).into_owned())
}

/// Writes a page with each `{{name}}` in it replaced by the part of that name.
pub(super) fn fill(page: &str, parts: &[(&str, String)], mut to: impl Write) -> io::Result<()> {
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("{{") {
        to.write_all(before.as_bytes())?;
        let (name, after) = after.split_once("}}").unwrap_or((after, ""));
        if let Some((_, text)) = parts.iter().find(|(key, _)| *key == name) {
            to.write_all(text.as_bytes())?;
        }
        rest = after;
    }
    to.write_all(rest.as_bytes())?;
    to.flush()
}

pub(super) fn escape_text(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Keeps text in JSON strings from ending the element that holds it.
fn escape_script(json: &str) -> String {
    json.replace('<', "\\u003c")
}
