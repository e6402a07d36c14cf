//! Tasks of the house: `cargo xtask verify` checks everything that a change must keep, `cargo xtask chart` draws the
//! charts. Continuous integration calls nothing else, so a green run here is a green run there.

mod cargo;
mod chart;
mod compile_times;
mod instructions;
mod landing;
mod metadata;
mod names;
mod package;
mod steps;
mod study;
mod verify;

use std::process::ExitCode;

const USAGE: &str = "usage:
  cargo xtask verify [--list] [--only STEP].. [--skip STEP].. [--with STEP]..
  cargo xtask chart  [--list] [--page] [--quick | --smoke] [--out FOLDER] [NAME..]
  cargo xtask atlas  [SEEDS [FIRST]] [--smoke | --shard K/N [--rows FOLDER] | --merge [FOLDER]]
  cargo xtask atlas  boundaries
  cargo xtask atlas  one NAME WAY STRENGTH SEED
  cargo xtask instructions
  cargo xtask compile-times
  cargo xtask package [--try [NAME..]]
  cargo xtask readme
  cargo xtask names
  cargo xtask study  NAME [ARGUMENT..] [--shard K/N [--rows FOLDER] | --merge [FOLDER]]

verify  runs the checks of the house; optional steps run only with --with or --only
chart   draws charts of cost against error into docs/charts, and the page of all of them
atlas   takes every method along every way of failing, and writes docs/atlas.md with its pictures
instructions counts those of the inner loops into docs/instructions.csv, where perf or valgrind can
compile-times builds the command anew, and writes what each crate of it takes into docs/crates.csv
package makes the packages of all crates; --try runs the example of each one's first page in a new project outside of this one
readme  writes README.md of each crate from the first page of its documentation
names   writes docs/names.txt, the public names of each crate, with which verify compares them
study   runs a long study and writes its table under docs; in N parts, on as many machines, merged to the same table";

fn main() -> ExitCode {
    if let Some(notes) = std::env::var_os(compile_times::NOTES) {
        return compile_times::compiler(notes.as_ref());
    }
    let mut words = std::env::args().skip(1);
    match words.next().as_deref() {
        Some("verify") => verify::main(words),
        Some("chart") => chart::main(words),
        Some("atlas") => study::atlas(words),
        Some("instructions") => instructions::main(),
        Some("compile-times") => compile_times::main(),
        Some("package") => package::main(words),
        Some("readme") => wrote(landing::write()),
        Some("names") => wrote(names::write()),
        Some("study") => study::main(words),
        Some("help" | "--help" | "-h") => {
            println!("{USAGE}");
            ExitCode::SUCCESS
        }
        other => {
            let complaint =
                other.map_or_else(|| "no task given".to_owned(), |task| format!("no task {task}"));
            eprintln!("{complaint}\n{USAGE}");
            ExitCode::from(2)
        }
    }
}

fn wrote(done: Result<Vec<String>, String>) -> ExitCode {
    match done {
        Ok(changed) => {
            changed.iter().for_each(|path| println!("wrote {path}"));
            ExitCode::SUCCESS
        }
        Err(complaint) => {
            eprintln!("{complaint}");
            ExitCode::FAILURE
        }
    }
}
