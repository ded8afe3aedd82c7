use super::{Example, TreeNode, forest_bytes};
use crate::math::Random;

/// Trains forests of decision trees for the classes 0 and 1: random forests and boosted trees.
///
/// The trees are ours, as linfa-trees decides ties by the order of a hash map: the same seed would give another forest
/// in each run.
#[derive(Debug, Clone, PartialEq)]
pub struct ForestTrainer {
    /// Number of trees.
    pub trees: usize,
    /// Maximum number of splits from the root to a leaf.
    pub depth: usize,
    /// Minimum number of examples in a leaf.
    pub min_leaf: usize,
    /// Number of random features among which a split is chosen.
    pub features: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Examples of a tree with their weights, while it grows.
struct Growth<'a> {
    examples: &'a [Example],
    weights: &'a [f64],
    trainer: &'a ForestTrainer,
    inputs: usize,
    random: Random,
    tree: Vec<TreeNode>,
    /// Numbers of all features; the chosen ones of a split first.
    order: Vec<u16>,
    /// Value, weight and class of the examples at a node. Reused as storage.
    sorted: Vec<(f32, f64, bool)>,
}

impl ForestTrainer {
    /// Trains a random forest (Breiman 2001): each tree sees the examples of a bootstrap sample, and each split a
    /// random choice of features. Both classes have the same weight. Returns the bytes of a [`Forest`](super::Forest).
    ///
    /// Examples with another number of inputs than the first one, or with inputs that are not numbers, are skipped.
    pub fn random_forest(&self, examples: &[Example], provenance: &str) -> Vec<u8> {
        let (examples, inputs) = usable(examples);
        let share = class_weights(&examples);
        let mut random = Random::new(self.seed);
        let grow = |_| {
            let mut weights = vec![0.0; examples.len()];
            for _ in 0..examples.len() {
                let drawn = (random.bits() % examples.len() as u64) as usize;
                weights[drawn] += share[examples[drawn].class];
            }
            let mut tree = self.tree(&examples, &weights, inputs, &mut random);
            scale(&mut tree, |value| value / self.trees as f32);
            tree
        };
        let trees: Vec<Vec<TreeNode>> = (0..self.trees).map(grow).collect();
        forest_bytes(provenance, self.seed, inputs, &trees)
    }

    /// Trains boosted trees (AdaBoost; Freund and Schapire 1997): each tree is trained with more weight on the examples
    /// for which those before are wrong. Returns the bytes of a [`Forest`](super::Forest), which is above 0.5 for class
    /// 1. Examples are skipped as in [`random_forest`](Self::random_forest).
    pub fn boosted(&self, examples: &[Example], provenance: &str) -> Vec<u8> {
        let (examples, inputs) = usable(examples);
        let share = class_weights(&examples);
        let mut random = Random::new(self.seed);
        let mut weights: Vec<f64> = examples.iter().map(|example| share[example.class]).collect();
        let mut trees: Vec<(f64, Vec<TreeNode>)> = Vec::new();
        for _ in 0..self.trees {
            let tree = self.tree(&examples, &weights, inputs, &mut random);
            let wrong: Vec<bool> = examples.iter().map(|e| (leaf(&tree, &e.input) > 0.5) != (e.class == 1)).collect();
            let total: f64 = weights.iter().sum();
            if total <= 0.0 {
                break;
            }
            let error: f64 = weights.iter().zip(&wrong).filter(|(_, wrong)| **wrong).map(|(w, _)| w).sum();
            let error = (error / total).clamp(1e-6, 1.0);
            if error >= 0.5 {
                // A random choice of features may be useless.
                continue;
            }
            let importance = 0.5 * ((1.0 - error) / error).ln();
            let factors = wrong.iter().map(|wrong| if *wrong { importance.exp() } else { (-importance).exp() });
            weights.iter_mut().zip(factors).for_each(|(weight, factor)| *weight *= factor / total);
            trees.push((importance, tree));
        }
        let sum: f64 = trees.iter().map(|(importance, _)| importance).sum();
        let weighted = trees.into_iter().map(|(importance, mut tree)| {
            scale(&mut tree, |value| if value > 0.5 { (importance / sum) as f32 } else { 0.0 });
            tree
        });
        let trees: Vec<Vec<TreeNode>> = weighted.collect();
        forest_bytes(provenance, self.seed, inputs, &trees)
    }

    fn tree(&self, examples: &[Example], weights: &[f64], inputs: usize, random: &mut Random) -> Vec<TreeNode> {
        let mut chosen: Vec<usize> = (0..examples.len()).filter(|i| weights[*i] > 0.0).collect();
        let mut growth = Growth {
            examples,
            weights,
            trainer: self,
            inputs,
            random: Random::new(random.bits()),
            tree: Vec::new(),
            order: (0..inputs as u16).collect(),
            sorted: Vec::new(),
        };
        growth.branch(&mut chosen, self.depth);
        growth.tree
    }
}

/// Examples of two classes with as many numbers as the first one, and this number.
fn usable(examples: &[Example]) -> (Vec<Example>, usize) {
    // The last feature number marks a leaf.
    let inputs = examples.first().map_or(0, |example| example.input.len()).min(usize::from(u16::MAX) - 1);
    let sound = |e: &&Example| e.class < 2 && e.input.len() == inputs && e.input.iter().all(|x| x.is_finite());
    (examples.iter().filter(sound).cloned().collect(), inputs)
}

/// Weight of an example of each class, so that both classes together have the same.
fn class_weights(examples: &[Example]) -> [f64; 2] {
    let ones = examples.iter().filter(|example| example.class == 1).count();
    [examples.len() - ones, ones].map(|count| 1.0 / count.max(1) as f64)
}

fn scale(tree: &mut [TreeNode], change: impl Fn(f32) -> f32) {
    for node in tree {
        if let TreeNode::Leaf(value) = node {
            *value = change(*value);
        }
    }
}

/// Value of the leaf for an input.
fn leaf(tree: &[TreeNode], input: &[f32]) -> f32 {
    let mut at = 0;
    loop {
        match tree[at] {
            TreeNode::Leaf(value) => return value,
            TreeNode::Split { feature, threshold, right } => {
                at += if input[usize::from(feature)] <= threshold { 1 } else { usize::from(right) };
            }
        }
    }
}

impl Growth<'_> {
    /// Appends the branch for these examples.
    fn branch(&mut self, chosen: &mut [usize], depth: usize) {
        let weight = |i: &usize| self.weights[*i];
        let total: f64 = chosen.iter().map(weight).sum();
        let ones: f64 = chosen.iter().filter(|i| self.examples[**i].class == 1).map(weight).sum();
        let share = if total > 0.0 { ones / total } else { 0.5 };
        let is_pure = !(1e-9..=1.0 - 1e-9).contains(&share);
        let split = if depth == 0 || is_pure { None } else { self.best_split(chosen, total, ones) };
        let Some((feature, threshold)) = split else {
            self.tree.push(TreeNode::Leaf(share as f32));
            return;
        };
        let is_left = |i: &usize| self.examples[*i].input[usize::from(feature)] <= threshold;
        chosen.sort_by_key(|i| !is_left(i));
        let middle = chosen.iter().take_while(|i| is_left(i)).count();
        let at = self.tree.len();
        self.tree.push(TreeNode::Leaf(share as f32));
        let (left, right) = chosen.split_at_mut(middle);
        self.branch(left, depth - 1);
        // A branch too large for the format stays a leaf.
        let Ok(offset) = u16::try_from(self.tree.len() - at) else {
            self.tree.truncate(at + 1);
            return;
        };
        self.tree[at] = TreeNode::Split { feature, threshold, right: offset };
        self.branch(right, depth - 1);
    }

    /// Feature and threshold of the smallest Gini impurity.
    fn best_split(&mut self, chosen: &[usize], total: f64, ones: f64) -> Option<(u16, f32)> {
        let mut best: Option<(f64, u16, f32)> = None;
        for at in 0..self.trainer.features.clamp(1, self.inputs.max(1)).min(self.inputs) {
            let other = at + (self.random.bits() % (self.inputs - at) as u64) as usize;
            self.order.swap(at, other);
            let feature = self.order[at];
            self.sorted.clear();
            self.sorted.extend(chosen.iter().map(|i| {
                let example = &self.examples[*i];
                (example.input[usize::from(feature)], self.weights[*i], example.class == 1)
            }));
            self.sorted.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
            let (mut left, mut left_ones) = (0.0, 0.0);
            for (count, pair) in self.sorted.windows(2).enumerate() {
                let (value, weight, is_one) = pair[0];
                left += weight;
                left_ones += if is_one { weight } else { 0.0 };
                let (count, next) = (count + 1, pair[1].0);
                let enough = count >= self.trainer.min_leaf && chosen.len() - count >= self.trainer.min_leaf;
                if !enough || next <= value {
                    continue;
                }
                let impurity = |sum: f64, ones: f64| if sum > 0.0 { ones * (sum - ones) / sum } else { 0.0 };
                let sum = impurity(left, left_ones) + impurity(total - left, ones - left_ones);
                if best.is_none_or(|(least, ..)| sum < least - 1e-15) {
                    let middle = value + 0.5 * (next - value);
                    // Rounding may give the larger one, which belongs to the right.
                    best = Some((sum, feature, if middle < next { middle } else { value }));
                }
            }
        }
        best.map(|(_, feature, threshold)| (feature, threshold))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::learn::Forest;

    /// Points in a disc and in the ring around it, with useless further features.
    fn rings(count: usize, seed: u64) -> Vec<Example> {
        let mut random = Random::new(seed);
        let mut point = || {
            let (x, y) = (random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0));
            Example { input: vec![x, y, random.uniform(0.0, 9.0), 1.0], class: usize::from(x.hypot(y) > 0.7) }
        };
        (0..count).map(|_| point()).collect()
    }

    const TRAINER: ForestTrainer = ForestTrainer { trees: 40, depth: 8, min_leaf: 2, features: 2, seed: 1 };

    fn right(bytes: &[u8], examples: &[Example]) -> usize {
        let forest = Forest::from_bytes(bytes).expect("sound");
        let says = |e: &&Example| (forest.probability(&e.input) > Some(0.5)) == (e.class == 1);
        examples.iter().filter(says).count()
    }

    #[test]
    fn both_forests_learn_what_no_line_separates() {
        let unseen = rings(500, 2);
        let forest = right(&TRAINER.random_forest(&rings(800, 1), "a test"), &unseen);
        let shallow = ForestTrainer { depth: 2, features: 4, trees: 80, ..TRAINER };
        let boosted = right(&shallow.boosted(&rings(800, 1), "a test"), &unseen);
        assert!(forest > 465 && boosted > 465, "{forest} and {boosted} of 500");
    }

    #[test]
    fn the_same_seed_gives_the_same_bytes() {
        let examples = rings(200, 3);
        assert_eq!(TRAINER.random_forest(&examples, ""), TRAINER.random_forest(&examples, ""));
        let other = ForestTrainer { seed: 2, ..TRAINER };
        assert_ne!(TRAINER.random_forest(&examples, ""), other.random_forest(&examples, ""));
    }

    #[test]
    fn odd_examples_do_no_harm() {
        let odd = |input: Vec<f32>, class: usize| Example { input, class };
        let lists = [
            vec![],
            vec![odd(vec![], 0), odd(vec![], 1)],
            vec![odd(vec![1.0], 0), odd(vec![f32::NAN], 1), odd(vec![1.0, 2.0], 1), odd(vec![1.0], 5)],
            vec![odd(vec![1.0], 0), odd(vec![1.0], 1)],
        ];
        for list in lists {
            for bytes in [TRAINER.random_forest(&list, ""), TRAINER.boosted(&list, "")] {
                assert!(Forest::from_bytes(&bytes).is_ok(), "{list:?}");
            }
        }
    }
}
