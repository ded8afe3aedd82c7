use crate::Objective;
use std::{
    sync::atomic::{AtomicU64, Ordering},
    time::{Duration, Instant},
};

/// Objective that measures the time of its runs.
pub struct Timed<'a> {
    objective: &'a dyn Objective,
    start: Instant,
    /// Time of all runs, in ns.
    busy: AtomicU64,
}

impl<'a> Timed<'a> {
    /// Begins to measure.
    pub fn new(objective: &'a dyn Objective) -> Self {
        Self { objective, start: Instant::now(), busy: AtomicU64::new(0) }
    }

    /// Time since the beginning, and the share of it that the threads of the current pool of rayon spent in runs, as a
    /// sentence.
    pub fn cost(&self) -> String {
        let busy = Duration::from_nanos(self.busy.load(Ordering::Relaxed));
        sentence(self.start.elapsed(), busy, rayon::current_num_threads())
    }
}

impl Objective for Timed<'_> {
    fn run(&self, values: &[f64], seed: u64) -> Result<Vec<f64>, String> {
        let start = Instant::now();
        let result = self.objective.run(values, seed);
        self.busy.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        result
    }
}

fn sentence(elapsed: Duration, busy: Duration, threads: usize) -> String {
    let share = 100.0 * busy.as_secs_f64() / (elapsed.as_secs_f64() * threads as f64).max(f64::MIN_POSITIVE);
    let of = if threads == 1 { "it".to_owned() } else { format!("the time of {threads} threads") };
    format!("{:.1} s; runs took {share:.2} % of {of}.", elapsed.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn threads_share_the_time() {
        let [elapsed, busy] = [Duration::from_secs(80), Duration::from_secs(76)];
        assert_eq!(sentence(elapsed, busy, 1), "80.0 s; runs took 95.00 % of it.");
        assert_eq!(sentence(elapsed, busy * 2, 2), "80.0 s; runs took 95.00 % of the time of 2 threads.");
    }

    #[test]
    fn runs_are_measured() {
        struct Sleep;
        impl Objective for Sleep {
            fn run(&self, _: &[f64], seed: u64) -> Result<Vec<f64>, String> {
                std::thread::sleep(Duration::from_millis(seed));
                Ok(vec![1.0])
            }
        }
        let timed = Timed::new(&Sleep);
        assert_eq!(timed.run(&[], 5), Ok(vec![1.0]));
        assert!(timed.busy.load(Ordering::Relaxed) >= 5_000_000);
    }
}
