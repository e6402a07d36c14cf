//! Draws the charts of the project: `chart [--list] [--page] [--quick | --smoke] [--out FOLDER] [NAME..]`, and the page of all of them.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use recon_benches::Budget;
use recon_benches::charts::{ALL, Chart, write_page};

struct Options {
    out: PathBuf,
    budget: Budget,
    list: bool,
    page: bool,
    charts: Vec<&'static Chart>,
}

const USAGE: &str = "usage: chart [--list] [--page] [--quick | --smoke] [--out FOLDER] [NAME..]
  NAME          charts to draw (all of them without a name)
  --list        print the names and stop
  --page        draw none, only make the page index.html of those that are there
  --quick       short timings, for a look
  --smoke       that all of it runs: few repeats, few points; into a folder that is removed
  --out FOLDER  where the files go (docs/charts)";

pub(crate) fn main() -> ExitCode {
    let options = match options(std::env::args().skip(2)) {
        Ok(options) => options,
        Err(complaint) => {
            eprintln!("{complaint}\n{USAGE}");
            return ExitCode::from(2);
        }
    };
    if options.list {
        for chart in ALL {
            println!("{:<28} {}", chart.name, chart.about);
        }
        return ExitCode::SUCCESS;
    }
    let mut good = true;
    let drawn = if options.page { &[][..] } else { &options.charts[..] };
    for chart in drawn {
        let start = Instant::now();
        if let Err(error) = draw(chart, &options) {
            eprintln!("{}: {error}", chart.name);
            good = false;
        }
        println!("{:<28} {:.1} s", chart.name, start.elapsed().as_secs_f64());
    }
    match write_page(&options.out) {
        Ok(count) => println!("index.html with {count} diagrams"),
        Err(error) => {
            eprintln!("index.html: {error}");
            good = false;
        }
    }
    if options.budget.smoke {
        let _ = std::fs::remove_dir_all(&options.out);
    }
    if good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn draw(chart: &Chart, options: &Options) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
    for diagram in (chart.draw)(options.budget)? {
        println!("  {}", diagram.save(&options.out)?.svg.display());
    }
    Ok(())
}

fn options(mut words: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        out: PathBuf::from("docs/charts"),
        budget: Budget::thorough(),
        list: false,
        page: false,
        charts: Vec::new(),
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--list" => options.list = true,
            "--page" => options.page = true,
            "--quick" => options.budget = Budget::quick(),
            "--smoke" => {
                options.budget = Budget::smoke();
                options.out = std::env::temp_dir().join(format!("recon-charts-{}", std::process::id()));
            }
            "--out" => options.out = words.next().ok_or("--out needs a folder")?.into(),
            flag if flag.starts_with('-') => return Err(format!("unknown option {flag}")),
            name => {
                options.charts.push(ALL.iter().find(|chart| chart.name == name).ok_or_else(|| unknown(name))?)
            }
        }
    }
    if options.charts.is_empty() {
        options.charts = ALL.iter().collect();
    }
    Ok(options)
}

fn unknown(name: &str) -> String {
    let names: Vec<_> = ALL.iter().map(|chart| chart.name).collect();
    format!("no chart is called {name}; there are: {}", names.join(", "))
}
