//! Sample of the costs of runs, from which their usual range is known.

/// Maximum number of costs that are kept.
const SIZE: usize = 8192;

/// Every n-th of the finite costs of a goal. It depends only on their order.
#[derive(Debug, Clone)]
pub(crate) struct Sample {
    kept: Vec<f64>,
    /// Every cost with a number that this one divides is kept.
    step: u64,
    count: u64,
}

impl Default for Sample {
    fn default() -> Self {
        Self { kept: vec![], step: 1, count: 0 }
    }
}

impl Sample {
    pub fn add(&mut self, cost: f64) {
        if !cost.is_finite() {
            return;
        }
        if self.count.is_multiple_of(self.step) {
            if self.kept.len() == SIZE {
                let mut number = 0;
                self.kept.retain(|_| {
                    number += 1;
                    number % 2 == 1
                });
                self.step *= 2;
            }
            if self.count.is_multiple_of(self.step) {
                self.kept.push(cost);
            }
        }
        self.count += 1;
    }

    /// Costs that 5 % and 95 % of the runs do not exceed, if there are any.
    pub fn range(&self) -> Option<(f64, f64)> {
        let mut sorted = self.kept.clone();
        sorted.sort_by(f64::total_cmp);
        let at = |share: f64| sorted.get((share * sorted.len().saturating_sub(1) as f64).round() as usize).copied();
        at(0.05).zip(at(0.95))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_stays_small_and_has_the_range_of_all() {
        let mut sample = Sample::default();
        assert_eq!(sample.range(), None);
        for number in 0..100_000 {
            sample.add(f64::from(number % 1000));
            sample.add(f64::INFINITY);
        }
        let (low, high) = sample.range().unwrap();
        assert!(sample.kept.len() <= SIZE && (40.0..60.0).contains(&low) && (940.0..960.0).contains(&high));
    }
}
