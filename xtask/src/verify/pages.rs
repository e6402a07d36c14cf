//! Each command's page in a browser, where there is one: drawn without an error of its script, and not wider than the window.

use crate::cargo::{output, program, recon, say, target};
use crate::steps::Outcome;
use std::path::Path;

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Widths of the page, px: a telephone's, and a wide one.
const WIDTHS: [u32; 2] = [400, 1400];

/// Inputs that no command writes.
const FILES: [(&str, &str); 3] = [
    ("waves.toml", "[outline]\nwaves = { size = 0.05, depth = 0.25, count = 3 }\n[finger]\nradius = 0.012\n"),
    ("pushes.csv", include_str!("../../../tests/data/pushes/pushes.csv")),
    ("poses.csv", include_str!("../../../tests/data/pushes/poses.csv")),
];

/// Commands in their order, each with the page that it makes.
const PAGES: [(&str, Option<&str>); 14] = [
    ("init start", None),
    ("reconstruct start/log.csv --scene start/scene.toml -o planes", Some("planes/report.html")),
    (
        "reconstruct start/log.csv --scene start/scene.toml --without-forces -o touch",
        Some("touch/report.html"),
    ),
    ("bounds start/contacts.csv --fit auto -o bounds", Some("bounds/report.html")),
    ("bounds start/contacts.csv --concave -o concave", Some("concave/report.html")),
    ("explore start/scene.toml --until gap=0.5 -o explored", Some("explored/report.html")),
    ("explore start/scene.toml --rolling --until gap=0.5 -o rolled", Some("rolled/report.html")),
    ("batch start --scene start/scene.toml -o many", Some("many/index.html")),
    ("explore waves.toml --contour -o contour", Some("contour/report.html")),
    ("pushes pushes.csv --poses poses.csv --radius 0.002 -o pushed", Some("pushed/report.html")),
    ("planar -o plane", Some("plane/report.html")),
    ("bounds plane/contact_points.csv -o outline", Some("outline/report.html")),
    ("demo --scene pick-up -o simulated", Some("simulated/report.html")),
    (
        "reconstruct simulated/log.csv --scene simulated/scene.toml -o estimated",
        Some("estimated/report.html"),
    ),
];

/// Stands in front of everything else in a page, and tells what became of it to the one that frames it.
const PROBE: &str = "<script>
addEventListener('error', (e) => parent.postMessage({ failed: e.message }, '*'));
addEventListener('load', () => {
  const root = document.documentElement;
  parent.postMessage({
    overflow: root.scrollWidth - root.clientWidth,
    drawn: document.querySelectorAll('svg').length,
  }, '*');
});
</script>";

/// A page that frames another at all widths, since no window without a screen is narrower than 500 px, and keeps what each tells as attributes of
/// its frame. One start of the browser takes longer than all that it draws.
fn frames(page: &str) -> String {
    let frame = |width: &u32| {
        format!("<iframe src=\"{page}\" style=\"width: {width}px; height: 900px; border: 0\"></iframe>")
    };
    let frames: String = WIDTHS.iter().map(frame).collect();
    format!(
        "<html><script>addEventListener('message', (e) => {{\
           for (const frame of document.querySelectorAll('iframe'))\
             if (frame.contentWindow === e.source) Object.assign(frame.dataset, e.data);\
         }});</script>{frames}</html>"
    )
}

pub(crate) fn check() -> Result<Outcome, String> {
    let Some(browser) = BROWSERS.into_iter().find(|name| output(program(name).arg("--version")).is_ok())
    else {
        return Ok(Outcome::Skipped(format!("no browser: none of {}", BROWSERS.join(", "))));
    };
    let (command, folder) = (recon()?, target().join("pages"));
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for (name, text) in FILES {
        std::fs::write(folder.join(name), text).map_err(|error| format!("{name}: {error}"))?;
    }
    let mut wrong = Vec::new();
    for (line, page) in PAGES {
        say(&format!("$ recon {line}"));
        let made =
            program(&command.to_string_lossy()).args(line.split(' ')).arg("-q").current_dir(&folder).output();
        let made = made.map_err(|error| format!("recon {line}: {error}"))?;
        // Results with reservations have their page too.
        if !matches!(made.status.code(), Some(0 | 4)) {
            return Err(format!("recon {line}: {}", String::from_utf8_lossy(&made.stderr)));
        }
        if let Some(page) = page {
            wrong.extend(complaints(browser, &folder.join(page))?);
        }
    }
    if wrong.is_empty() { Ok(Outcome::Passed) } else { Err(wrong.join("\n")) }
}

/// What is wrong with a page, and at which width.
fn complaints(browser: &str, page: &Path) -> Result<Vec<String>, String> {
    let text = std::fs::read_to_string(page).map_err(|error| format!("{}: {error}", page.display()))?;
    let put = |path: &Path, text: String| {
        std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
    };
    let (probed, framed) = (page.with_extension("probed.html"), page.with_extension("framed.html"));
    put(&probed, text.replacen("<head>", &format!("<head>{PROBE}"), 1))?;
    let name = probed.file_name().unwrap_or_default().to_string_lossy();
    let mut wrong = Vec::new();
    if !text.split("<script>").next().unwrap_or_default().contains("<svg") {
        wrong.push(format!("{}: there is no picture without its script", page.display()));
    }
    put(&framed, frames(&name))?;
    let dom = output(
        program(browser)
            .args([
                "--headless",
                "--no-sandbox",
                "--disable-gpu",
                "--virtual-time-budget=4000",
                "--window-size=1500,2000",
                "--dump-dom",
            ])
            .arg(&framed),
    )?;
    let mut told_by = dom.split("<iframe").skip(1).map(told);
    for width in WIDTHS {
        let told = told_by.next().unwrap_or_else(|| vec!["it was not framed".to_owned()]);
        wrong.extend(told.into_iter().map(|what| format!("{} at {width} px: {what}", page.display())));
    }
    Ok(wrong)
}

/// What the probe told to one frame.
fn told(frame: &str) -> Vec<String> {
    let attribute = |name: &str| {
        let (_, rest) = frame.split_once(&format!(" data-{name}=\""))?;
        rest.split('"').next().map(str::to_owned)
    };
    let mut wrong = Vec::new();
    wrong.extend(attribute("failed").map(|error| format!("its script failed: {error}")));
    match attribute("overflow").as_deref() {
        Some("0") => {}
        Some(by) => wrong.push(format!("it is wider than the window, by {by} px")),
        None => wrong.push("it was not drawn".to_owned()),
    }
    if attribute("drawn").as_deref() == Some("0") {
        wrong.push("there is no picture".to_owned());
    }
    wrong
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_probe_told_is_read() {
        assert_eq!(told(" data-overflow=\"0\" data-drawn=\"3\">"), Vec::<String>::new());
        let wrong = told(" data-failed=\"no f\" data-overflow=\"12\" data-drawn=\"0\">");
        assert_eq!(wrong.len(), 3, "{wrong:?}");
        assert_eq!(told(" src=\"page.html\">"), ["it was not drawn"]);
    }
}
