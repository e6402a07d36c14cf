//! Each command's page in a browser, where there is one: drawn without an error of its script, and not wider than the window.

use crate::cargo::{cargo, output, program, root, run};
use crate::steps::Outcome;
use std::path::{Path, PathBuf};

const BROWSERS: [&str; 4] = ["chromium", "chromium-browser", "google-chrome", "chrome"];

/// Widths of the window, px: what a browser takes at the least without a screen, and a wide one.
const WIDTHS: [u32; 2] = [500, 1400];

/// Commands in their order, each with the page that it makes.
const PAGES: [(&str, Option<&str>); 10] = [
    ("init start", None),
    ("reconstruct start/log.csv --scene start/scene.toml -o planes", Some("planes/report.html")),
    (
        "reconstruct start/log.csv --scene start/scene.toml --without-forces -o touch",
        Some("touch/report.html"),
    ),
    ("bounds start/contacts.csv --fit auto -o bounds", Some("bounds/report.html")),
    ("bounds start/contacts.csv --concave -o concave", Some("concave/report.html")),
    ("explore start/scene.toml --until gap=0.5 -o explored", Some("explored/report.html")),
    ("batch start --scene start/scene.toml -o many", Some("many/index.html")),
    ("planar -o plane", Some("plane/report.html")),
    ("demo --scene pick-up -o simulated", Some("simulated/report.html")),
    (
        "reconstruct simulated/log.csv --scene simulated/scene.toml -o estimated",
        Some("estimated/report.html"),
    ),
];

/// Stands in front of everything else, and tells what went wrong as attributes of the page.
const PROBE: &str = "<script>
addEventListener('error', (e) => { document.documentElement.dataset.failed = e.message; });
addEventListener('load', () => {
  const root = document.documentElement;
  root.dataset.overflow = root.scrollWidth - root.clientWidth;
  root.dataset.drawn = document.querySelectorAll('svg, canvas').length;
});
</script>";

pub(crate) fn check() -> Result<Outcome, String> {
    let Some(browser) = BROWSERS.into_iter().find(|name| output(program(name).arg("--version")).is_ok())
    else {
        return Ok(Outcome::Skipped(format!("no browser: none of {}", BROWSERS.join(", "))));
    };
    run(&mut cargo("build -p recon-cli"))?;
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from);
    let (command, folder) =
        (target.join(format!("debug/recon{}", std::env::consts::EXE_SUFFIX)), target.join("pages"));
    if folder.exists() {
        std::fs::remove_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    }
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut wrong = Vec::new();
    for (line, page) in PAGES {
        println!("$ recon {line}");
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

/// What is wrong with a page at some width.
fn complaints(browser: &str, page: &Path) -> Result<Vec<String>, String> {
    let text = std::fs::read_to_string(page).map_err(|error| format!("{}: {error}", page.display()))?;
    let probed = page.with_extension("probed.html");
    std::fs::write(&probed, text.replacen("<head>", &format!("<head>{PROBE}"), 1))
        .map_err(|error| format!("{}: {error}", probed.display()))?;
    let mut wrong = Vec::new();
    for width in WIDTHS {
        let size = format!("--window-size={width},900");
        let dom = output(
            program(browser)
                .args([
                    "--headless",
                    "--no-sandbox",
                    "--disable-gpu",
                    "--virtual-time-budget=4000",
                    &size,
                    "--dump-dom",
                ])
                .arg(&probed),
        )?;
        wrong.extend(told(&dom).into_iter().map(|what| format!("{} at {width} px: {what}", page.display())));
    }
    Ok(wrong)
}

/// What the probe told.
fn told(dom: &str) -> Vec<String> {
    let attribute = |name: &str| {
        let (_, rest) = dom.split_once(&format!(" data-{name}=\""))?;
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
        assert_eq!(told("<html data-overflow=\"0\" data-drawn=\"3\">"), Vec::<String>::new());
        let wrong = told("<html data-failed=\"no f\" data-overflow=\"12\" data-drawn=\"0\">");
        assert_eq!(wrong.len(), 3, "{wrong:?}");
        assert_eq!(told("<html>"), ["it was not drawn"]);
    }
}
