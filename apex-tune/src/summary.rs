/// Fitness of a candidate from the costs of its runs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Summary {
    /// Mean.
    Mean,
    /// Quantile, from 0 to 1: the smallest cost that this share of the runs does not exceed.
    Quantile(f64),
}

impl Summary {
    /// Fitness of a candidate whose runs have these costs. Runs without a cost count as 0: because costs are never
    /// negative, the result is then a lower bound of the fitness. It is infinite if a run has failed.
    pub fn fitness(self, costs: &[Option<f64>]) -> f64 {
        // Sums of the same terms in the same order: a term that becomes greater never makes a rounded sum smaller.
        let known = || costs.iter().map(|cost| cost.unwrap_or(0.0));
        if known().any(f64::is_infinite) {
            return f64::INFINITY;
        }
        match self {
            Self::Mean => known().sum::<f64>() / costs.len().max(1) as f64,
            Self::Quantile(share) => {
                let mut sorted: Vec<f64> = known().collect();
                sorted.sort_by(f64::total_cmp);
                let rank = (share.clamp(0.0, 1.0) * sorted.len() as f64).ceil() as usize;
                sorted.get(rank.max(1) - 1).copied().unwrap_or(0.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_are_missing_give_a_lower_bound() {
        let all = [Some(4.0), Some(1.0), Some(0.25), Some(8.0)];
        for summary in [Summary::Mean, Summary::Quantile(0.5), Summary::Quantile(1.0), Summary::Quantile(0.0)] {
            for known in 0..16_u32 {
                let part: Vec<_> = all.iter().enumerate().map(|(i, c)| c.filter(|_| known >> i & 1 == 1)).collect();
                assert!(summary.fitness(&part) <= summary.fitness(&all));
            }
        }
        assert_eq!(Summary::Quantile(0.5).fitness(&all), 1.0);
        assert_eq!(Summary::Mean.fitness(&[Some(1.0), None, Some(f64::INFINITY)]), f64::INFINITY);
    }
}
