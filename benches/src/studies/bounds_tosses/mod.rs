//! Bodies tossed onto a table in MuJoCo and seen by a tracker with faults: the margins of bounds from poses are settled on
//! some of them and checked on others.
//!
//! Usage: `bounds_tosses [SETS] [FOLDER]`: at most SETS sets of each family and tracker (all by default), which are kept in
//! FOLDER (`target/tosses` by default) and simulated where they are not there. Needs Python with MuJoCo and SciPy. Prints
//! tables in Markdown, the last of a real body's tosses where they lie beside the repository; with 0 SETS that alone.

mod body;
mod calibration;
mod check;
mod real;
mod sets;

use calibration::{Form, Judged};
use check::Row;
use sets::Set;
use std::error::Error;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

pub(crate) fn main() -> Result<(), Box<dyn Error>> {
    let most: u32 = crate::words().next().map_or(Ok(u32::MAX), |a| a.parse())?;
    let folder = crate::words().nth(1).map_or_else(default_folder, PathBuf::from);
    if most == 0 {
        return real::print();
    }
    let sets = sets::sets(most);
    println!("# Bounds from poses of tossed bodies\n");
    println!(
        "Made by `cargo xtask study bounds_tosses`: MuJoCo tosses random bodies, {} times a set, onto a table; a tracker \
         with the faults that `benches/peers/tosses.py` tells sees them, or one with {} times as large faults. \
         Ellipsoids, capsules, cylinders and random polyhedra calibrate; boxes, tetrahedra and prisms check.\n",
        sets::TOSSES,
        sets::WORSE
    );
    let mut judged: Vec<Vec<Judged>> = Form::ALL.iter().map(|_| Vec::new()).collect();
    let mut rows = Vec::new();
    for of_set in in_parallel(&sets, |set| study(set, &folder)) {
        let (of_forms, row) = of_set?;
        judged.iter_mut().zip(of_forms).for_each(|(list, own)| list.push(own));
        rows.push(row);
    }
    calibration::print(&judged);
    check::print(&rows);
    real::print()
}

/// What a set says about each form and about the tight rule.
fn study(set: &Set, folder: &Path) -> Result<(Vec<Judged>, Row), String> {
    let all = || -> Result<_, Box<dyn Error>> {
        let tosses = set.load(folder)?;
        let judged = Form::ALL.iter().map(|form| form.judge(set, &tosses)).collect::<Result<_, _>>()?;
        Ok((judged, check::check(set, &tosses)?))
    };
    // Errors of any kind do not leave their thread; their words do.
    all().map_err(|error| error.to_string())
}

/// `work` on each item, in the order of the items, by as many threads as the machine has cores.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let threads = std::thread::available_parallelism().map_or(1, NonZeroUsize::get);
    std::thread::scope(|scope| {
        for _ in 0..threads {
            scope.spawn(|| {
                while let Some((k, item)) = Some(next.fetch_add(1, Ordering::Relaxed))
                    .and_then(|k| items.get(k).map(|item| (k, item)))
                {
                    let result = work(item);
                    done.lock().unwrap_or_else(PoisonError::into_inner).push((k, result));
                }
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    done.sort_by_key(|(k, _)| *k);
    done.into_iter().map(|(_, result)| result).collect()
}

fn default_folder() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../target/tosses"))
}
