//! The motion sample by sample.

use crate::arrays::{Numbers, wxyz};
use crate::errors::{input, raised};
use crate::scene::Scene;
use pyo3::prelude::*;
use recon_cli::Follower as Made;
use recon_io::{StreamRow, probabilities};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Of one palm: its decided mode, how probable it is that it slides and that it sticks, and what is doubted.
type Mode = (u8, f64, f64, Option<&'static str>);

/// A row of the table of `recon follow`: 24 entries, of which two are a word and a mark, and the modes of all palms where they are told.
type Row = (f64, [f64; 13], [f64; 4], &'static str, bool, f64, Option<[f64; 2]>, Option<Vec<Mode>>);

/// Follows a motion row by row.
#[pyclass(frozen, module = "recon._recon")]
pub(crate) struct Follower {
    // One push at a time, whichever thread it comes from.
    made: Mutex<Made>,
    width: usize,
}

impl Follower {
    fn locked(&self) -> MutexGuard<'_, Made> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn told(&self, rows: &[StreamRow]) -> Vec<Row> {
        let palms = self.locked().palms_with_modes();
        rows.iter().map(|row| told(row, palms)).collect()
    }

    fn check(&self, found: usize) -> PyResult<()> {
        let expected = self.width;
        let wrong = || input(format!("the row has {found} values where there are {expected} columns"));
        if found == expected { Ok(()) } else { Err(wrong()) }
    }
}

#[pymethods]
impl Follower {
    #[new]
    fn new(names: Vec<String>, scene: &Scene, words: Vec<String>) -> PyResult<Self> {
        let made = Made::new(&names, scene.scene.clone(), &words).map_err(raised)?;
        Ok(Self { made: Mutex::new(made), width: names.len() })
    }

    /// The estimates that a row makes known.
    fn push(&self, py: Python<'_>, row: Vec<f64>) -> PyResult<Vec<Row>> {
        self.check(row.len())?;
        let made = py.detach(|| self.locked().push(&row)).map_err(raised)?;
        Ok(self.told(&made))
    }

    /// The same of a row that is an array.
    fn push_array(&self, py: Python<'_>, row: Numbers) -> PyResult<Vec<Row>> {
        self.push(py, row.0)
    }

    /// The same of many rows, (n, columns).
    fn push_all(&self, py: Python<'_>, rows: Numbers, width: usize) -> PyResult<Vec<Row>> {
        self.check(width)?;
        let rows: Vec<&[f64]> = rows.0.chunks_exact(width.max(1)).collect();
        let mut all = Vec::with_capacity(rows.len());
        // Ctrl-C is looked at every so often: a push takes microseconds.
        for some in rows.chunks(500) {
            let made = py.detach(|| {
                let mut follower = self.locked();
                some.iter().map(|row| follower.push(row)).collect::<Result<Vec<_>, _>>()
            });
            all.extend(self.told(&made.map_err(raised)?.concat()));
            py.check_signals()?;
        }
        Ok(all)
    }

    /// The estimates that were held back.
    fn finish(&self, py: Python<'_>) -> PyResult<Vec<Row>> {
        let made = py.detach(|| self.locked().finish()).map_err(raised)?;
        Ok(self.told(&made))
    }

    /// Samples that could not be used, and what was wrong with the first of them.
    fn left_out(&self) -> (usize, Option<String>) {
        let follower = self.locked();
        let (count, why) = follower.left_out();
        (count, why.map(str::to_owned))
    }
}

fn told(row: &StreamRow, palms: usize) -> Row {
    let motion = row.motion.map_or([f64::NAN; 13], |motion| {
        let (p, [qw, qx, qy, qz]) = (motion.p_WCm, wxyz(motion.R_WO));
        let (v, w) = (motion.v_WCm, motion.w_WO);
        [p.x, p.y, p.z, qw, qx, qy, qz, v.x, v.y, v.z, w.x, w.y, w.z]
    });
    let modes = row.modes.as_ref().map(|modes| {
        let one = |palm: usize| {
            let [slide, stick] = probabilities(&modes.odds[palm]);
            (modes.decided[palm].number(), slide, stick, row.doubt(palm))
        };
        (0..palms).map(one).collect()
    });
    (row.t, motion, row.deviations, row.stage, row.relied_on, row.misfit, row.mass, modes)
}
