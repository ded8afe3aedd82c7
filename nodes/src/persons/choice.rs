use super::{
    MAX_DETECTIONS, MAX_PERSONS,
    leaf::{Leaf, MAX_DEPTH, MAX_HYPOTHESES},
};
use core::ops::Range;
use heapless::Vec;

/// Maximum number of passes that improve a choice.
const PASSES: usize = 3;

/// No leaf, or no tree.
const NONE: u16 = u16::MAX;

/// Set of leaves, at most one of each tree, in which no detection is used twice: the best global hypothesis found.
///
/// The best set is a maximum weight independent set. It is searched for greedily, and then improved by exchanges: a
/// leaf is chosen instead of all those in conflict with it, and the trees without a leaf choose again.
#[derive(Debug, Clone, Default)]
pub(super) struct Choice {
    /// Tree of each leaf.
    tree_of: Vec<u16, MAX_HYPOTHESES>,
    /// Leaves of each tree.
    trees: Vec<Range<u16>, MAX_PERSONS>,
    /// Chosen leaf of each tree, or `NONE`.
    chosen: Vec<u16, MAX_PERSONS>,
    /// Leaves by score, best first.
    order: Vec<u16, MAX_HYPOTHESES>,
    users: Users,
}

/// Tree that uses each detection of the last measurements, or `NONE`.
#[derive(Debug, Clone)]
struct Users([[u16; MAX_DETECTIONS]; MAX_DEPTH]);

impl Default for Users {
    fn default() -> Self {
        Self([[NONE; MAX_DETECTIONS]; MAX_DEPTH])
    }
}

impl Users {
    fn set(&mut self, leaf: &Leaf, depth: usize, tree: u16) {
        for (users, number) in self.0.iter_mut().zip(&leaf.trail[..depth]) {
            if let Some(user) = usize::from(*number).checked_sub(1).and_then(|at| users.get_mut(at)) {
                *user = tree;
            }
        }
    }

    /// Other trees that use a detection of this leaf, with repetitions.
    fn rivals(&self, leaf: &Leaf, depth: usize, tree: u16) -> impl Iterator<Item = u16> + use<'_> {
        let trail = leaf.trail;
        let user = move |(users, number): (&[u16; MAX_DETECTIONS], u8)| {
            usize::from(number).checked_sub(1).and_then(|at| users.get(at)).copied()
        };
        self.0.iter().zip(trail).take(depth).filter_map(user).filter(move |user| *user != NONE && *user != tree)
    }
}

impl Choice {
    /// Removes all leaves from the set.
    pub fn clear(&mut self) {
        self.chosen.clear();
    }

    /// Leaves of the set, in the order of their trees. `leaves` are those that were chosen from.
    pub fn leaves<'a>(&'a self, leaves: &'a [Leaf]) -> impl Iterator<Item = &'a Leaf> {
        self.chosen.iter().filter_map(|leaf| leaves.get(usize::from(*leaf)))
    }

    /// Follows the removal of leaves that are not kept.
    pub fn renumber(&mut self, leaves: &[Leaf], keeps: impl Fn(&Leaf) -> bool) {
        let mut next = 0;
        // `order` is storage for the new numbers here.
        self.order.clear();
        self.order.extend(leaves.iter().map(|leaf| {
            let kept = keeps(leaf);
            next += u16::from(kept);
            if kept { next - 1 } else { NONE }
        }));
        let new = |leaf: &u16| self.order.get(usize::from(*leaf)).copied().unwrap_or(NONE);
        self.chosen.iter_mut().for_each(|leaf| *leaf = new(leaf));
    }

    /// Chooses among leaves, which are ordered by tree.
    pub fn choose(&mut self, leaves: &[Leaf], depth: usize) {
        self.collect_trees(leaves);
        self.order.clear();
        self.order.extend((0..self.tree_of.len() as u16).filter(|leaf| leaves[usize::from(*leaf)].score > 0.0));
        let score = |leaf: u16| leaves[usize::from(leaf)].score;
        self.order.sort_unstable_by(|a, b| score(*b).total_cmp(&score(*a)).then(a.cmp(b)));
        self.users = Users::default();
        for at in 0..self.order.len() {
            let leaf = self.order[at];
            let tree = self.tree_of[usize::from(leaf)];
            if self.chosen[usize::from(tree)] == NONE && self.is_free(leaves, leaf, depth) {
                self.put(leaves, tree, leaf, depth);
            }
        }
        for _ in 0..PASSES {
            let mut improved = false;
            for at in 0..self.order.len() {
                improved |= self.exchange(leaves, self.order[at], depth);
            }
            if !improved {
                break;
            }
        }
    }

    fn collect_trees(&mut self, leaves: &[Leaf]) {
        self.trees.clear();
        self.tree_of.clear();
        self.chosen.clear();
        for (at, leaf) in leaves.iter().enumerate() {
            let at = at as u16;
            let continues = at > 0 && leaves[usize::from(at) - 1].person == leaf.person;
            if continues {
                self.trees.last_mut().into_iter().for_each(|tree| tree.end = at + 1);
            } else if self.trees.push(at..at + 1).is_err() {
                // Trees beyond the capacity are not chosen from.
                break;
            }
            // Cannot fail: as many as leaves, and as many as trees.
            let _ = self.tree_of.push(self.trees.len() as u16 - 1);
        }
        self.chosen.extend(self.trees.iter().map(|_| NONE));
    }

    fn is_free(&self, leaves: &[Leaf], leaf: u16, depth: usize) -> bool {
        let tree = self.tree_of[usize::from(leaf)];
        self.users.rivals(&leaves[usize::from(leaf)], depth, tree).next().is_none()
    }

    /// Chooses a leaf, or none, for a tree.
    fn put(&mut self, leaves: &[Leaf], tree: u16, leaf: u16, depth: usize) {
        let before = core::mem::replace(&mut self.chosen[usize::from(tree)], leaf);
        if let Some(before) = leaves.get(usize::from(before)) {
            self.users.set(before, depth, NONE);
        }
        if let Some(leaf) = leaves.get(usize::from(leaf)) {
            self.users.set(leaf, depth, tree);
        }
    }

    /// Best free leaf of a tree, or `NONE`.
    fn best_free(&self, leaves: &[Leaf], tree: u16, depth: usize) -> u16 {
        let score = |leaf: &u16| leaves[usize::from(*leaf)].score;
        let free = self.trees[usize::from(tree)].clone().filter(|l| score(l) > 0.0 && self.is_free(leaves, *l, depth));
        free.max_by(|a, b| score(a).total_cmp(&score(b)).then(b.cmp(a))).unwrap_or(NONE)
    }

    /// Exchanges the chosen leaf of a tree if the sum of all scores increases.
    fn exchange(&mut self, leaves: &[Leaf], leaf: u16, depth: usize) -> bool {
        let tree = self.tree_of[usize::from(leaf)];
        if self.chosen[usize::from(tree)] == leaf {
            return false;
        }
        let value = |leaf: u16| leaves.get(usize::from(leaf)).map_or(0.0, |leaf| leaf.score);
        // The tree and its rivals, with the leaves that they chose before.
        let mut before: Vec<(u16, u16), { MAX_DEPTH + 1 }> = Vec::new();
        let rivals = self.users.rivals(&leaves[usize::from(leaf)], depth, tree);
        for involved in core::iter::once(tree).chain(rivals) {
            if before.iter().all(|(other, _)| *other != involved) {
                // Cannot fail: each measurement adds at most one rival.
                let _ = before.push((involved, self.chosen[usize::from(involved)]));
            }
        }
        let old: f32 = before.iter().map(|(_, leaf)| value(*leaf)).sum();
        for (involved, _) in &before {
            self.put(leaves, *involved, NONE, depth);
        }
        self.put(leaves, tree, leaf, depth);
        let mut new = value(leaf);
        // Rivals choose again, and then the trees that had no leaf, for which another one may have made room.
        let mut filled: Vec<u16, MAX_PERSONS> = before[1..].iter().map(|(rival, _)| *rival).collect();
        let is_empty = |tree: &u16| self.chosen[usize::from(*tree)] == NONE && !filled.contains(tree);
        let empty: Vec<u16, MAX_PERSONS> = (0..self.trees.len() as u16).filter(is_empty).collect();
        filled.extend(empty);
        for tree in &filled {
            let best = self.best_free(leaves, *tree, depth);
            self.put(leaves, *tree, best, depth);
            new += value(best);
        }
        // More than rounding, so that exchanges come to an end.
        let improved = new > old + 1e-3;
        if !improved {
            filled.iter().chain(&[tree]).for_each(|involved| self.put(leaves, *involved, NONE, depth));
            before.iter().for_each(|(involved, leaf)| self.put(leaves, *involved, *leaf, depth));
        }
        improved
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{math::Random, persons::Motion};
    use apex_rt::Time;
    use std::vec::Vec;

    fn leaf(person: u32, score: f32, trail: &[u8]) -> Leaf {
        let mut leaf =
            Leaf { person, motion: Motion::default(), score, presence: 1.0, seen: Time::ZERO, trail: [0; MAX_DEPTH] };
        leaf.trail[..trail.len()].copy_from_slice(trail);
        leaf
    }

    fn total(leaves: &[Leaf], depth: usize) -> f32 {
        let mut choice = Choice::default();
        choice.choose(leaves, depth);
        let chosen: Vec<&Leaf> = choice.leaves(leaves).collect();
        for (i, a) in chosen.iter().enumerate() {
            for b in &chosen[i + 1..] {
                let shares = a.trail[..depth].iter().zip(&b.trail).any(|(a, b)| *a > 0 && a == b);
                assert!(a.person != b.person && !shares, "{a:?} {b:?}");
            }
        }
        chosen.iter().map(|leaf| leaf.score).sum()
    }

    #[test]
    fn the_greedy_choice_is_improved() {
        let leaves = [leaf(1, 10.0, &[1]), leaf(1, 9.0, &[2]), leaf(2, 9.0, &[1]), leaf(2, 1.0, &[])];
        assert_eq!(total(&leaves, 1), 18.0);
        assert_eq!(total(&[leaf(1, -1.0, &[1])], 1), 0.0);
        assert_eq!(total(&[], 1), 0.0);
    }

    /// Largest sum by trying all sets.
    fn best(leaves: &[Leaf], depth: usize, chosen: &mut Vec<Leaf>) -> f32 {
        let Some((first, rest)) = leaves.split_first() else { return 0.0 };
        let without = best(rest, depth, chosen);
        let shares = |other: &Leaf| (0..depth).any(|d| first.trail[d] > 0 && first.trail[d] == other.trail[d]);
        if chosen.iter().any(|other| other.person == first.person || shares(other)) {
            return without;
        }
        chosen.push(*first);
        let with = first.score + best(rest, depth, chosen);
        chosen.pop();
        without.max(with)
    }

    #[test]
    fn it_is_nearly_always_the_best() {
        let mut random = Random::new(5);
        let mut right = 0;
        for _ in 0..200 {
            let leaves: Vec<Leaf> = (0..15)
                .map(|i| {
                    let trail = [0; 3].map(|_: i32| (random.bits() % 5) as u8);
                    leaf(i / 3, random.uniform(-1.0, 10.0), &trail)
                })
                .collect();
            let (found, best) = (total(&leaves, 3), best(&leaves, 3, &mut Vec::new()));
            assert!(found <= best + 1e-3 && found > 0.75 * best, "{found} {best}");
            right += usize::from(found > best - 1e-3);
        }
        assert!(right > 170, "{right} of 200");
    }
}
