use super::Progress;
use crate::{in_order, say};
use std::num::NonZero;

/// Does all jobs on `threads` threads (`None`: all cores), and prints a line for each result, in the order of the jobs.
/// A terminal shows how many of them are done. `what` is their name there.
///
/// # Errors
/// The first error of a job; if a thread cannot be started, or the output cannot be written.
pub fn rows<J: Sync, R: Send>(
    what: &str,
    jobs: &[J],
    threads: Option<NonZero<usize>>,
    work: impl Fn(&J) -> Result<R, String> + Sync,
    line: impl Fn(&J, &R) -> Option<String>,
) -> Result<Vec<R>, String> {
    let (progress, mut done, mut said) = (Progress::default(), 0, Ok(()));
    let show = |result: &Result<R, String>| {
        progress.clear();
        let text = result.as_ref().ok().and_then(|result| line(&jobs[done], result));
        done += 1;
        if let (Ok(()), Some(text)) = (&said, text) {
            said = say(&format!("{text}\n"));
        }
        progress.step(what, done as u64, jobs.len() as u64);
    };
    let results = in_order(jobs, threads, work, show).map_err(|e| e.to_string())?;
    progress.clear();
    said?;
    results.into_iter().collect()
}

/// Minimum, median and maximum of some numbers; zeros if there are none.
pub fn spread(numbers: impl IntoIterator<Item = usize>) -> [usize; 3] {
    let mut sorted: Vec<usize> = numbers.into_iter().collect();
    sorted.sort_unstable();
    let last = sorted.len().saturating_sub(1);
    [0, last / 2, last].map(|index| sorted.get(index).copied().unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_error_is_that_of_all() {
        let work = |job: &u32| if job % 4 == 3 { Err(format!("job {job}")) } else { Ok(2 * job) };
        assert_eq!(rows("jobs", &[0, 1, 2], NonZero::new(2), work, |_, _| None), Ok(vec![0, 2, 4]));
        assert_eq!(rows("jobs", &[1, 7, 3], NonZero::new(2), work, |_, _| None), Err("job 7".to_owned()));
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(spread([9, 3, 14, 10]), [3, 9, 14]);
        assert_eq!(spread([]), [0; 3]);
    }
}
