/// Scores of points whose class is known.
#[derive(Debug, Clone, Default)]
pub struct Scores {
    /// Scores of obstacles.
    pub positive: Vec<f32>,
    /// Scores of all others.
    pub negative: Vec<f32>,
}

impl Scores {
    /// Adds a score.
    pub fn push(&mut self, is_obstacle: bool, score: f32) {
        if is_obstacle { &mut self.positive } else { &mut self.negative }.push(score);
    }

    /// Adds the scores of another set.
    pub fn extend(&mut self, other: &Self) {
        self.positive.extend(&other.positive);
        self.negative.extend(&other.negative);
    }

    /// Area under the curve of true over false positives: the probability that an obstacle has a higher score than
    /// another point; equal scores count half. `None` if one of the classes is empty.
    pub fn auc(&self) -> Option<f64> {
        let sorted = |scores: &[f32]| {
            let mut sorted = scores.to_vec();
            sorted.sort_unstable_by(f32::total_cmp);
            sorted
        };
        let (positive, negative) = (sorted(&self.positive), sorted(&self.negative));
        let (mut below, mut up_to, mut sum) = (0, 0, 0.0);
        for score in &positive {
            below += negative[below..].iter().take_while(|other| *other < score).count();
            up_to = up_to.max(below);
            up_to += negative[up_to..].iter().take_while(|other| *other <= score).count();
            sum += 0.5 * (below + up_to) as f64;
        }
        let pairs = positive.len() as f64 * negative.len() as f64;
        (pairs > 0.0).then(|| sum / pairs)
    }

    /// Rates of true and of false positives if all scores from `threshold` on are called obstacles, 0 to 1.
    pub fn rates(&self, threshold: f32) -> [f64; 2] {
        [&self.positive, &self.negative].map(|scores| {
            let above = scores.iter().filter(|score| **score >= threshold).count();
            above as f64 / scores.len().max(1) as f64
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn auc(positive: &[f32], negative: &[f32]) -> Option<f64> {
        Scores { positive: positive.to_vec(), negative: negative.to_vec() }.auc()
    }

    #[test]
    fn the_area_is_the_share_of_pairs_in_order() {
        assert_eq!(auc(&[0.9, 0.8], &[0.1, 0.2, 0.3]), Some(1.0));
        assert_eq!(auc(&[0.1], &[0.2, 0.3]), Some(0.0));
        assert_eq!(auc(&[0.5; 4], &[0.5; 7]), Some(0.5));
        assert_eq!(auc(&[0.4, 0.1], &[0.2, 0.4]), Some((1.5 + 0.0) / 4.0));
        assert_eq!(auc(&[], &[0.2]), None);
        let scores = Scores { positive: vec![0.9, 0.4], negative: vec![0.5, 0.1, 0.2, 0.3] };
        assert_eq!(scores.rates(0.45), [0.5, 0.25]);
    }
}
