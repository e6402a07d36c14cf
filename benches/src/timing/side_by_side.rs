//! Jobs timed in turns, so that a machine that slows down for a while slows all of them; by the processor time of this thread, so that others who
//! use the machine at the same time do not count.

use cpu_time::ThreadTime;
use std::hint::black_box;
use std::time::Duration;

/// How long to measure.
///
/// Batches are short beside the time slices of a system (a few milliseconds), so that what another process does to the caches spoils whole
/// batches, which the median passes over, rather than a part of each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// A job is repeated within a batch until it has taken this long, far above the resolution of the clock.
    pub batch: Duration,
    /// At least so many batches for each job.
    pub least_rounds: usize,
    /// At most so many batches for each job.
    pub most_rounds: usize,
    /// Between the two, so many that a job takes about this long in all.
    pub patience: Duration,
    /// Whether it is to be seen only that all of it runs.
    pub smoke: bool,
}

impl Budget {
    /// For charts that are kept: 7 to 51 batches of at least 1 ms, about 1 s for each job.
    #[must_use]
    pub fn thorough() -> Self {
        Self {
            batch: Duration::from_millis(1),
            least_rounds: 7,
            most_rounds: 51,
            patience: Duration::from_secs(1),
            smoke: false,
        }
    }

    /// For a look, and for tests of the harness: 3 to 15 batches of at least 0.2 ms, about 10 ms for each job.
    #[must_use]
    pub fn quick() -> Self {
        Self {
            batch: Duration::from_micros(200),
            least_rounds: 3,
            most_rounds: 15,
            patience: Duration::from_millis(10),
            smoke: false,
        }
    }

    /// To see that all of it runs: as [`Self::quick`], and what is repeated is repeated less.
    #[must_use]
    pub fn smoke() -> Self {
        Self { least_rounds: 1, most_rounds: 1, patience: Duration::ZERO, smoke: true, ..Self::quick() }
    }

    /// Of what there is to be of a chart that is kept, and of a smoke test.
    #[must_use]
    pub fn of<T>(&self, [kept, smoke]: [T; 2]) -> T {
        if self.smoke { smoke } else { kept }
    }

    fn rounds(&self, batch_took: Duration) -> usize {
        let fitting = self.patience.as_nanos() / batch_took.as_nanos().max(1);
        let fitting = usize::try_from(fitting).unwrap_or(usize::MAX);
        fitting.min(self.most_rounds).max(self.least_rounds).max(1)
    }
}

/// Time of one call of a job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Median over the batches.
    pub median: Duration,
    /// Least over the batches: the nearest to what the machine can do.
    pub minimum: Duration,
    /// Calls in each batch.
    pub calls: u32,
    /// Batches.
    pub rounds: usize,
}

impl Timing {
    /// Median in milliseconds per unit of work, e.g. per simulated second.
    #[must_use]
    pub fn ms_per(&self, work: f64) -> f64 {
        1e3 * self.median.as_secs_f64() / work
    }

    /// Minimum in milliseconds per unit of work.
    #[must_use]
    pub fn least_ms_per(&self, work: f64) -> f64 {
        1e3 * self.minimum.as_secs_f64() / work
    }
}

/// Jobs to be timed in one run.
#[derive(Default)]
pub struct SideBySide<'a> {
    jobs: Vec<Box<dyn FnMut() + 'a>>,
}

impl<'a> SideBySide<'a> {
    /// No jobs yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a job; what it returns is kept from the optimiser.
    pub fn job<T>(&mut self, mut job: impl FnMut() -> T + 'a) -> &mut Self {
        self.jobs.push(Box::new(move || {
            black_box(job());
        }));
        self
    }

    /// Times all jobs in turns; the answers are in the order of the jobs.
    #[must_use]
    pub fn run(mut self, budget: Budget) -> Vec<Timing> {
        let plans: Vec<Plan> = self.jobs.iter_mut().map(|job| Plan::of(job, &budget)).collect();
        let most = plans.iter().map(|plan| plan.rounds).max().unwrap_or(0);
        let mut times = vec![Vec::new(); self.jobs.len()];
        for round in 0..most {
            for ((job, plan), times) in self.jobs.iter_mut().zip(&plans).zip(&mut times) {
                if plan.has_turn(round, most) {
                    times.push(time_of(job, plan.calls) / plan.calls);
                }
            }
        }
        times.into_iter().zip(plans).map(|(times, plan)| summary(times, plan.calls)).collect()
    }
}

/// Calls in a batch, and batches.
struct Plan {
    calls: u32,
    rounds: usize,
}

impl Plan {
    /// Doubles the number of calls until they take the least time twice in a row (once may be another process in
    /// the way); this warms caches and branch predictors as well.
    fn of(job: &mut dyn FnMut(), budget: &Budget) -> Self {
        const MOST_CALLS: u32 = 1 << 24;
        let mut calls = 1;
        loop {
            let took = time_of(job, calls);
            let again = if took < budget.batch { took } else { time_of(job, calls) };
            if again >= budget.batch || calls >= MOST_CALLS {
                return Self { calls, rounds: budget.rounds(took.min(again)) };
            }
            calls *= 2;
        }
    }

    /// Spreads the turns of a job with few rounds evenly over all rounds.
    fn has_turn(&self, round: usize, most: usize) -> bool {
        (round + 1) * self.rounds / most > round * self.rounds / most
    }
}

fn time_of(job: &mut dyn FnMut(), calls: u32) -> Duration {
    let start = ThreadTime::now();
    for _ in 0..calls {
        job();
    }
    start.elapsed()
}

fn summary(mut times: Vec<Duration>, calls: u32) -> Timing {
    times.sort_unstable();
    let rounds = times.len();
    let median = (times[(rounds - 1) / 2] + times[rounds / 2]) / 2;
    Timing { median, minimum: times[0], calls, rounds }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_is_the_mean_of_the_middle_two() {
        let times = [40, 10, 30, 20].map(Duration::from_nanos).to_vec();
        let timing = summary(times, 1);
        assert_eq!((timing.median, timing.minimum), (Duration::from_nanos(25), Duration::from_nanos(10)));
    }

    #[test]
    fn jobs_take_turns() {
        let order = std::cell::RefCell::new(Vec::new());
        let mut jobs = SideBySide::new();
        jobs.job(|| order.borrow_mut().push('a')).job(|| order.borrow_mut().push('b'));
        let budget = Budget {
            batch: Duration::ZERO,
            least_rounds: 3,
            most_rounds: 3,
            patience: Duration::ZERO,
            smoke: false,
        };
        assert_eq!(jobs.run(budget).len(), 2);
        // Two calls each to find the number of calls, then three rounds.
        assert_eq!(order.into_inner().iter().collect::<String>(), "aabbababab");
    }

    #[test]
    fn a_long_job_gets_fewer_rounds_spread_over_all() {
        let budget = Budget::thorough();
        assert_eq!(budget.rounds(Duration::from_millis(1)), 51);
        assert_eq!(budget.rounds(Duration::from_millis(100)), 10);
        assert_eq!(budget.rounds(Duration::from_secs(60)), 7);
        let plan = Plan { calls: 1, rounds: 7 };
        let turns: Vec<_> = (0..51).filter(|round| plan.has_turn(*round, 51)).collect();
        assert_eq!(turns, [7, 14, 21, 29, 36, 43, 50]);
    }

    #[test]
    fn a_short_job_is_repeated_until_it_can_be_timed() {
        let mut jobs = SideBySide::new();
        jobs.job(|| 1 + 1);
        let timing = jobs.run(Budget::quick())[0];
        assert!(timing.calls > 1000 && timing.minimum <= timing.median, "{timing:?}");
    }
}
