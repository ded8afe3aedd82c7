use serde::{Deserialize, Serialize};
use std::fmt;

/// Value of a goal from the costs of all runs of a candidate.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub enum Summary {
    /// Mean.
    Mean,
    /// Quantile, from 0 to 1: the smallest cost that this share of the runs does not exceed.
    Quantile(f64),
}

impl fmt::Display for Summary {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mean => f.write_str("mean"),
            Self::Quantile(share) => write!(f, "at {} %", (1e6 * share).round() / 1e4),
        }
    }
}

impl Summary {
    /// Value for these costs. Runs without a cost have the least possible one, so that the result is then a lower
    /// bound. It is infinite if a run has failed.
    pub fn of(self, costs: impl Iterator<Item = Option<f64>>, least: f64) -> f64 {
        let mut known: Vec<f64> = costs.map(|cost| cost.unwrap_or(least)).collect();
        if known.contains(&f64::INFINITY) {
            return f64::INFINITY;
        }
        match self {
            // Sums of the same terms in the same order: a term that becomes greater never makes a rounded sum smaller.
            Self::Mean => known.iter().sum::<f64>() / known.len().max(1) as f64,
            Self::Quantile(share) => {
                known.sort_by(f64::total_cmp);
                // A share of 0.9 of 10 runs is 9 of them, although 0.9 is rounded.
                let rank = (share.clamp(0.0, 1.0) * known.len() as f64 - 1e-9).ceil() as usize;
                known.get(rank.max(1) - 1).copied().unwrap_or(least)
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
        let value = |summary: Summary, costs: &[Option<f64>], least| summary.of(costs.iter().copied(), least);
        for summary in [Summary::Mean, Summary::Quantile(0.5), Summary::Quantile(1.0), Summary::Quantile(0.0)] {
            for (known, least) in (0..16_u32).flat_map(|known| [(known, 0.0), (known, f64::NEG_INFINITY)]) {
                let part: Vec<_> = all.iter().enumerate().map(|(i, c)| c.filter(|_| known >> i & 1 == 1)).collect();
                assert!(value(summary, &part, least) <= value(summary, &all, least));
            }
        }
        assert_eq!(value(Summary::Quantile(0.5), &all, 0.0), 1.0);
        assert_eq!(value(Summary::Mean, &[Some(1.0), None, Some(f64::INFINITY)], 0.0), f64::INFINITY);
        let ten: Vec<_> = (1..=10).map(|i| Some(f64::from(i))).collect();
        assert_eq!(value(Summary::Quantile(0.9), &ten, 0.0), 9.0);
    }
}
