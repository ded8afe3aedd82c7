use std::{
    io,
    num::NonZero,
    sync::{
        atomic::{AtomicUsize, Ordering},
        mpsc,
    },
    thread,
};

/// Runs all jobs on `threads` threads (`None`: as many as the machine has cores), and returns the results in the order
/// of the jobs.
///
/// # Errors
/// If a thread cannot be started.
pub fn in_order<J: Sync, R: Send>(
    jobs: &[J],
    threads: Option<NonZero<usize>>,
    work: impl Fn(&J) -> R + Sync,
    mut done: impl FnMut(usize),
) -> io::Result<Vec<R>> {
    let threads = threads.or_else(|| thread::available_parallelism().ok()).map_or(1, NonZero::get).min(jobs.len());
    let (next, (sender, received)) = (AtomicUsize::new(0), mpsc::channel());
    let mut results: Vec<Option<R>> = jobs.iter().map(|_| None).collect();
    thread::scope(|scope| {
        for _ in 0..threads {
            let (sender, next, work) = (sender.clone(), &next, &work);
            thread::Builder::new().spawn_scoped(scope, move || {
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
        for (count, (index, result)) in received.into_iter().enumerate() {
            results[index] = Some(result);
            done(count + 1);
        }
        Ok(())
    })
    .map(|()| results.into_iter().flatten().collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_do_not_depend_on_the_number_of_threads() {
        let jobs: Vec<u64> = (0..50).collect();
        for threads in [1, 3, 80] {
            let mut counted = 0;
            let results = in_order(&jobs, NonZero::new(threads), |job| job * job, |count| counted = count);
            assert_eq!(results.expect("threads"), jobs.iter().map(|job| job * job).collect::<Vec<_>>());
            assert_eq!(counted, 50);
        }
        assert!(in_order(&[] as &[u64], None, |job| *job, |_| {}).expect("no threads").is_empty());
    }
}
