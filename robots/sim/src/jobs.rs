use std::{
    io,
    num::NonZero,
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

/// Size of the stack of a thread, in bytes. Robots are large, and may be on the stack for a while.
const STACK: usize = 64 << 20;

/// Runs all jobs on `threads` threads (`None`: as many as the machine has cores), and shows each result. The results
/// are in the order of the jobs, and do not depend on the number of threads.
///
/// # Errors
/// If a thread cannot be started.
pub fn in_order<J: Sync, R: Send>(
    jobs: &[J],
    threads: Option<NonZero<usize>>,
    work: impl Fn(&J) -> R + Sync,
    mut show: impl FnMut(&R),
) -> io::Result<Vec<R>> {
    let threads = threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZero::get).min(jobs.len());
    let (next, (sender, results)) = (AtomicUsize::new(0), mpsc::channel());
    let mut done: Vec<Option<R>> = jobs.iter().map(|_| None).collect();
    let mut shown = 0;
    thread::scope(|scope| {
        for _ in 0..threads {
            let (sender, next, work) = (sender.clone(), &next, &work);
            thread::Builder::new().stack_size(STACK).spawn_scoped(scope, move || {
                while let Some((index, job)) = {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    jobs.get(index).map(|job| (index, job))
                } {
                    // The receiver is gone only if its thread panicked.
                    let _ = sender.send((index, work(job)));
                }
            })?;
        }
        drop(sender);
        for (index, result) in results {
            done[index] = Some(result);
            while let Some(Some(result)) = done.get(shown) {
                show(result);
                shown += 1;
            }
        }
        Ok(())
    })
    .map(|()| done.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn results_come_in_the_order_of_the_jobs() {
        let jobs: Vec<u64> = (0..40).collect();
        let work = |job: &u64| {
            thread::sleep(Duration::from_millis(job * 7 % 5));
            job * job
        };
        for threads in [None, NonZero::new(1), NonZero::new(3), NonZero::new(100)] {
            let mut shown = vec![];
            let results = in_order(&jobs, threads, work, |result| shown.push(*result)).expect("threads");
            assert_eq!(results, jobs.iter().map(|job| job * job).collect::<Vec<_>>());
            assert_eq!(shown, results);
        }
        assert!(in_order(&[] as &[u64], None, work, |_| {}).expect("no threads").is_empty());
    }
}
