use std::{fmt, time::Duration};

/// The value below which the share `part` of all values is, or `None` without values.
pub fn percentile(values: &[f32], part: f32) -> Option<f32> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f32::total_cmp);
    // A cast of a negative number gives 0.
    let index = ((sorted.len() as f32 * part) as usize).min(sorted.len().checked_sub(1)?);
    Some(sorted[index])
}

/// Computing times of a graph per frame, in ms.
#[derive(Debug, Clone, Default)]
pub struct Times(Vec<f32>);

impl Times {
    /// Adds the time of a frame.
    pub fn push(&mut self, time: Duration) {
        self.0.push(1e3 * time.as_secs_f32());
    }
}

impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match percentile(&self.0, 0.5) {
            Some(median) => write!(f, "{median:.2} ms (median of {} frames)", self.0.len()),
            None => write!(f, "no frames"),
        }
    }
}

/// Confusion matrix of a classifier.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Confusion<const N: usize> {
    names: [&'static str; N],
    counts: [[u32; N]; N],
}

impl<const N: usize> Confusion<N> {
    /// Creates a matrix of zeros.
    pub const fn new(names: [&'static str; N]) -> Self {
        Self { names, counts: [[0; N]; N] }
    }

    /// Counts an example of the class `actual` that was classified as `predicted`.
    pub fn count(&mut self, actual: usize, predicted: usize) {
        self.counts[actual][predicted] += 1;
    }

    /// Number of examples of the class `actual` that were classified as `predicted`.
    pub fn get(&self, actual: usize, predicted: usize) -> u32 {
        self.counts[actual][predicted]
    }
}

impl<const N: usize> fmt::Display for Confusion<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<16}", "actual | found")?;
        self.names.iter().try_for_each(|name| write!(f, "{name:>8}"))?;
        for (name, row) in self.names.iter().zip(&self.counts) {
            write!(f, "\n{name:<16}")?;
            row.iter().try_for_each(|count| write!(f, "{count:>8}"))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_values_of_the_list() {
        let values = [5.0, 1.0, 2.0, 4.0, 3.0, 10.0, 6.0, 7.0, 8.0, 9.0];
        assert_eq!([0.0, 0.5, 0.9, 1.0].map(|p| percentile(&values, p)), [1.0, 6.0, 10.0, 10.0].map(Some));
        assert_eq!(percentile(&[], 0.5), None);
    }

    #[test]
    fn rows_are_what_was_there() {
        let mut table = Confusion::new(["empty", "full"]);
        table.count(0, 1);
        assert_eq!((table.get(0, 1), table.get(1, 0)), (1, 0));
        let lines: Vec<String> = table.to_string().lines().map(str::to_owned).collect();
        assert_eq!(lines[1], "empty                  0       1");
    }
}
