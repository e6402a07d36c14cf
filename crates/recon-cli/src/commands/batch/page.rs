//! Many logs on one page: a small picture of each.

use super::TABLE;
use super::one::{Row, State};
use recon_io::brief_to;
use std::fmt::Write;
use std::path::Path;

/// Size of a picture.
const WIDTH: f64 = 220.0;
const HEIGHT: f64 = 110.0;

const STYLE: &str = "\
:root { color-scheme: light dark; --good: #1b7f4b; --doubt: #b7791f; --broken: #b42318; }
body { font: 15px/1.45 system-ui, sans-serif; margin: 2rem auto; max-width: 76rem; padding: 0 1rem; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(240px, 1fr)); gap: 1rem; }
article { border: 1px solid color-mix(in srgb, currentColor 20%, transparent); border-radius: 8px; padding: .7rem; }
article h2 { font-size: 1rem; margin: 0 0 .3rem; overflow-wrap: anywhere; }
article p { margin: .2rem 0; font-size: .85rem; overflow-wrap: anywhere; }
svg { width: 100%; height: auto; } polyline { fill: none; stroke-width: 1.5; vector-effect: non-scaling-stroke; }
.good { color: var(--good); } .doubt { color: var(--doubt); } .broken { color: var(--broken); }
.x { stroke: #c2410c; } .y { stroke: #15803d; } .z { stroke: #1d4ed8; } .key span { margin-right: 1rem; }";

/// The page; it loads nothing.
pub(super) fn page(folder: &Path, rows: &[Row]) -> String {
    let name = folder.file_name().unwrap_or(folder.as_os_str()).to_string_lossy();
    let title = escaped(&format!("{name}: {} logs", rows.len()));
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" content=\"width=device-width\">\n\
         <title>{title}</title>\n<style>\n{STYLE}\n</style>\n<h1>{title}</h1>\n\
         <p class=\"key\">Centre of mass from where it was first, over time: <svg viewBox=\"0 0 120 12\" style=\"width:120px\" \
         role=\"img\" aria-label=\"x red, y green, z blue\"><text x=\"0\" y=\"10\" font-size=\"11\" fill=\"#c2410c\">x</text><text x=\"20\" \
         y=\"10\" font-size=\"11\" fill=\"#15803d\">y</text><text x=\"40\" y=\"10\" font-size=\"11\" fill=\"#1d4ed8\">z</text></svg>\n\
         All numbers are in <a href=\"{TABLE}\">{TABLE}</a>.</p>\n<main>\n"
    );
    for row in rows {
        card(row, &mut page);
    }
    page + "</main>\n</html>\n"
}

fn card(row: &Row, page: &mut String) {
    let class = match row.state {
        State::ReliedOn => "good",
        State::Doubtful => "doubt",
        State::Broken => "broken",
    };
    let name = escaped(&row.log);
    let _ = match row.state {
        State::Broken => writeln!(page, "<article><h2>{name}</h2>"),
        _ => {
            let place = encoded(&row.folder);
            writeln!(page, "<article><h2><a href=\"{place}/report.html\">{name}</a></h2>")
        }
    };
    let _ = writeln!(page, "<p class=\"{class}\">{}</p>", row.state.word());
    picture(row, page);
    if let Some(mass) = row.mass() {
        let deviation = row.std_mass().map_or(String::new(), |std| format!(" &plusmn; {}", brief_to(2, std)));
        let _ = writeln!(page, "<p>mass {}{deviation} kg</p>", brief_to(4, mass));
    }
    if row.state != State::ReliedOn {
        let _ = writeln!(page, "<p>{}</p>", escaped(&row.why));
    }
    *page += "</article>\n";
}

/// Where the centre of mass went.
fn picture(row: &Row, page: &mut String) {
    let (Some(first), Some(last)) = (row.path.first(), row.path.last()) else { return };
    let moved = |point: &[f64; 4], axis: usize| point[axis] - first[axis];
    let all = row.path.iter().flat_map(|point| (1..4).map(move |axis| moved(point, axis)));
    let (low, high) = all.fold((0.0, 0.0), |(low, high): (f64, f64), d| (low.min(d), high.max(d)));
    let (span, over) = ((high - low).max(f64::MIN_POSITIVE), (last[0] - first[0]).max(f64::MIN_POSITIVE));
    let _ = write!(
        page,
        "<svg viewBox=\"0 0 {WIDTH} {HEIGHT}\" role=\"img\" aria-label=\"from {} to {} m over {} s\">",
        brief_to(2, low),
        brief_to(2, high),
        brief_to(3, over)
    );
    for (axis, class) in [(1, "x"), (2, "y"), (3, "z")] {
        let point = |point: &[f64; 4]| {
            let (x, y) = ((point[0] - first[0]) / over, (moved(point, axis) - low) / span);
            format!("{:.1},{:.1}", x * WIDTH, (1.0 - y) * (HEIGHT - 4.0) + 2.0)
        };
        let points: Vec<String> = row.path.iter().map(point).collect();
        let _ = write!(page, "<polyline class=\"{class}\" points=\"{}\"/>", points.join(" "));
    }
    *page += "</svg>\n";
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A name as a part of an address.
fn encoded(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.~".contains(&byte);
    let one = |byte: u8| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    name.bytes().map(one).collect()
}
