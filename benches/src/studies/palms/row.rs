//! What is kept of a run.

use recon_benches::palms::{End, LOOKS, PalmRun};

/// How many numbers a row has besides the looks.
const NUMBERS: usize = 10;

/// As cells: how it ended, what it brought, coverage and gap at each look.
pub(super) type RowCells = (String, [f64; NUMBERS], [[f64; 2]; LOOKS]);

/// What is kept of a run; what there is none of is NaN.
#[derive(Clone, Debug)]
pub(super) struct Row {
    /// `held`, `lost` or why it was refused.
    pub(super) end: String,
    /// When it was lost, s.
    pub(super) lost: f64,
    /// Mean number of palms touched.
    pub(super) touched: f64,
    /// Radians that the body turned through.
    pub(super) turned: f64,
    /// Gap with balls.
    pub(super) in_balls: f64,
    /// Deviations of motion, mass and inertia, and the condition number.
    pub(super) told: [f64; 4],
    /// Error of the mass in its deviations, and 1 where the estimate is relied on.
    pub(super) judged: [f64; 2],
    /// Coverage and gap at each look.
    pub(super) looks: [[f64; 2]; LOOKS],
}

impl Row {
    pub(super) fn of(run: &PalmRun) -> Self {
        let (end, lost) = match &run.end {
            End::Held => ("held", f64::NAN),
            End::Lost(t) => ("lost", *t),
            End::Refused(why) => (why.as_str(), f64::NAN),
        };
        let told = run.told.map_or([f64::NAN; 4], |t| [t.motion, t.mass, t.inertia, t.condition]);
        let judged = run.told.map_or([f64::NAN; 2], |t| [t.error, f64::from(u8::from(t.relied_on))]);
        let PalmRun { touched, turned, looks, .. } = *run;
        Self {
            end: end.to_owned(),
            lost,
            touched,
            turned,
            in_balls: run.in_balls.unwrap_or(f64::NAN),
            told,
            judged,
            looks,
        }
    }

    pub(super) fn cells(self) -> RowCells {
        let [motion, mass, inertia, condition] = self.told;
        let [error, relied] = self.judged;
        let Self { lost, touched, turned, in_balls, .. } = self;
        let numbers = [lost, touched, turned, in_balls, motion, mass, inertia, condition, error, relied];
        (self.end, numbers, self.looks)
    }

    pub(super) fn from_cells((end, numbers, looks): RowCells) -> Self {
        let [lost, touched, turned, in_balls, motion, mass, inertia, condition, error, relied] = numbers;
        let (told, judged) = ([motion, mass, inertia, condition], [error, relied]);
        Self { end, lost, touched, turned, in_balls, told, judged, looks }
    }

    /// Whether the body was held to the end.
    pub(super) fn held(&self) -> bool {
        self.end == "held"
    }

    /// Whether it was simulated to the end, held or lost.
    pub(super) fn simulated(&self) -> bool {
        self.held() || self.end == "lost"
    }
}
