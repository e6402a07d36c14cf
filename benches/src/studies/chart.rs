//! Draws the charts of the project: `chart [--list] [--quick] [--out FOLDER] [NAME..]`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

use recon_benches::charts::{ALL, Chart};
use recon_benches::{Budget, Diagram};

struct Options {
    out: PathBuf,
    budget: Budget,
    list: bool,
    charts: Vec<&'static Chart>,
}

const USAGE: &str = "usage: chart [--list] [--quick] [--out FOLDER] [NAME..]
  NAME          charts to draw (all of them without a name)
  --list        print the names and stop
  --quick       short timings, for a look
  --out FOLDER  where the files go (docs/charts)";

pub(crate) fn main() -> ExitCode {
    let options = match options(crate::words()) {
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
    for chart in &options.charts {
        let start = Instant::now();
        match draw(chart, &options) {
            Ok(silent) => good &= silent == 0,
            Err(error) => {
                eprintln!("{}: {error}", chart.name);
                good = false;
            }
        }
        println!("{:<28} {:.1} s", chart.name, start.elapsed().as_secs_f64());
    }
    if good { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Draws and writes; the answer is the number of points that were wrong without a warning.
fn draw(chart: &Chart, options: &Options) -> Result<usize, Box<dyn std::error::Error + Send + Sync>> {
    let mut silent = 0;
    for diagram in (chart.draw)(options.budget)? {
        let files = diagram.save(&options.out)?;
        println!("  {}", files.svg.display());
        if let Diagram::Sweep(sweep) = &diagram {
            for (subject, run) in sweep.wrong_without_warning() {
                eprintln!("  WRONG WITHOUT A WARNING: {subject} at {}, error {:?}", run.parameter, run.error);
                silent += 1;
            }
        }
    }
    Ok(silent)
}

fn options(mut words: impl Iterator<Item = String>) -> Result<Options, String> {
    let mut options = Options {
        out: PathBuf::from("docs/charts"),
        budget: Budget::thorough(),
        list: false,
        charts: Vec::new(),
    };
    while let Some(word) = words.next() {
        match word.as_str() {
            "--list" => options.list = true,
            "--quick" => options.budget = Budget::quick(),
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
