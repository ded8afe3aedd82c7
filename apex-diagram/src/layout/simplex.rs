//! Network simplex method: finds numbers that keep minimum distances and minimise a weighted sum of lengths (Gansner,
//! Koutsofios, North, Vo: A technique for drawing directed graphs, 1993).

/// Maximum number of arcs to visit. If it is reached, the result keeps all distances, but its sum may not be minimal. A
/// graph of 100 nodes stays below it.
const WORK: usize = 20_000_000;

/// Constraint: `to` is at least `min` larger than `from`. Each unit of distance costs `weight`.
#[derive(Debug, Clone, Copy)]
pub struct Arc {
    /// Index of the smaller number.
    pub from: usize,
    /// Index of the larger number.
    pub to: usize,
    /// Minimum distance.
    pub min: i64,
    /// Cost of a unit of distance.
    pub weight: i64,
}

/// Solves for `count` numbers. The arcs must not have a cycle.
pub fn solve(count: usize, arcs: &[Arc]) -> Vec<i64> {
    let mut arcs = arcs.to_vec();
    let mut has_source = vec![false; count];
    arcs.iter().for_each(|arc| has_source[arc.to] = true);
    // A root joins all parts.
    let free = (0..count).filter(|v| !has_source[*v]);
    let held: Vec<Arc> = free.map(|to| Arc { from: count, to, min: 0, weight: 0 }).collect();
    arcs.extend(held);
    let mut network = Network::new(count + 1, arcs);
    network.grow();
    for _ in 0..WORK / (network.arcs.len() + 1) {
        if !network.pivot() {
            break;
        }
    }
    let root = network.at[count];
    network.at.truncate(count);
    network.at.iter().map(|at| at - root).collect()
}

struct Network {
    arcs: Vec<Arc>,
    /// Arcs at each vertex.
    touching: Vec<Vec<usize>>,
    at: Vec<i64>,
    /// `true` for arcs in the spanning tree.
    in_tree: Vec<bool>,
}

/// The spanning tree, seen from the root.
struct Rooted {
    /// Vertices, parents first.
    order: Vec<usize>,
    /// Arc to the parent.
    up: Vec<Option<usize>>,
}

impl Network {
    fn new(count: usize, arcs: Vec<Arc>) -> Self {
        let mut touching = vec![vec![]; count];
        for (i, arc) in arcs.iter().enumerate() {
            touching[arc.from].push(i);
            touching[arc.to].push(i);
        }
        let at = longest_paths(count, &arcs, &touching);
        let in_tree = vec![false; arcs.len()];
        Self { arcs, touching, at, in_tree }
    }

    fn slack(&self, arc: usize) -> i64 {
        let Arc { from, to, min, .. } = self.arcs[arc];
        self.at[to] - self.at[from] - min
    }

    fn other(&self, arc: usize, end: usize) -> usize {
        let Arc { from, to, .. } = self.arcs[arc];
        if from == end { to } else { from }
    }

    /// Builds a spanning tree of arcs without slack.
    fn grow(&mut self) {
        let count = self.at.len();
        let mut inside = vec![false; count];
        let mut members = vec![count - 1];
        inside[count - 1] = true;
        let mut next = 0;
        while members.len() < count {
            while let Some(&v) = members.get(next) {
                next += 1;
                for i in 0..self.touching[v].len() {
                    let arc = self.touching[v][i];
                    let other = self.other(arc, v);
                    if !inside[other] && self.slack(arc) == 0 {
                        inside[other] = true;
                        self.in_tree[arc] = true;
                        members.push(other);
                    }
                }
            }
            let leaving = (0..self.arcs.len()).filter(|a| inside[self.arcs[*a].from] != inside[self.arcs[*a].to]);
            let Some(arc) = leaving.min_by_key(|a| self.slack(*a)) else { return };
            let slack = self.slack(arc);
            let shift = if inside[self.arcs[arc].from] { slack } else { -slack };
            members.iter().for_each(|v| self.at[*v] += shift);
            let Arc { from, to, .. } = self.arcs[arc];
            let new = if inside[from] { to } else { from };
            inside[new] = true;
            self.in_tree[arc] = true;
            members.push(new);
        }
    }

    fn rooted(&self) -> Rooted {
        let count = self.at.len();
        let mut up = vec![None; count];
        let mut order = vec![count - 1];
        let mut next = 0;
        while let Some(&v) = order.get(next) {
            next += 1;
            let own = up[v];
            for &arc in self.touching[v].iter().filter(|a| self.in_tree[**a] && own != Some(**a)) {
                let child = self.other(arc, v);
                up[child] = Some(arc);
                order.push(child);
            }
        }
        Rooted { order, up }
    }

    /// Exchanges an arc of the tree for another that reduces the sum. Returns `false` if there is none.
    fn pivot(&mut self) -> bool {
        let Rooted { order, up } = self.rooted();
        // Weight that leaves a subtree minus weight that enters it; arcs inside cancel out.
        let mut net = vec![0i64; self.at.len()];
        for arc in &self.arcs {
            net[arc.from] += arc.weight;
            net[arc.to] -= arc.weight;
        }
        let mut worst: Option<(i64, usize)> = None;
        for &v in order.iter().rev() {
            let Some(arc) = up[v] else { continue };
            let cut = if self.arcs[arc].from == v { net[v] } else { -net[v] };
            if cut < worst.map_or(0, |(least, _)| least) {
                worst = Some((cut, v));
            }
            let parent = self.other(arc, v);
            net[parent] += net[v];
        }
        let Some((_, top)) = worst else { return false };
        let Some(leaving) = up[top] else { return false };
        let mut below = vec![false; self.at.len()];
        below[top] = true;
        for &v in &order {
            if let Some(arc) = up[v] {
                below[v] |= below[self.other(arc, v)];
            }
        }
        let tail_below = self.arcs[leaving].from == top;
        let enters = |a: &usize| {
            let (from, to) = (below[self.arcs[*a].from], below[self.arcs[*a].to]);
            from != to && to == tail_below
        };
        let Some(entering) = (0..self.arcs.len()).filter(enters).min_by_key(|a| self.slack(*a)) else { return false };
        let slack = self.slack(entering);
        let shift = if tail_below { -slack } else { slack };
        (0..self.at.len()).filter(|v| below[*v]).for_each(|v| self.at[v] += shift);
        self.in_tree[leaving] = false;
        self.in_tree[entering] = true;
        true
    }
}

/// Smallest numbers that keep all distances.
fn longest_paths(count: usize, arcs: &[Arc], touching: &[Vec<usize>]) -> Vec<i64> {
    let mut at = vec![0; count];
    let mut open = vec![0; count];
    arcs.iter().for_each(|arc| open[arc.to] += 1);
    let mut ready: Vec<usize> = (0..count).filter(|v| open[*v] == 0).collect();
    let mut next = 0;
    while let Some(&v) = ready.get(next) {
        next += 1;
        for arc in touching[v].iter().map(|a| arcs[*a]).filter(|arc| arc.from == v) {
            at[arc.to] = at[arc.to].max(at[v] + arc.min);
            open[arc.to] -= 1;
            if open[arc.to] == 0 {
                ready.push(arc.to);
            }
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heavy_arc_is_kept_short() {
        let arc = |from, to, weight| Arc { from, to, min: 1, weight };
        // 0 → 1 → 2 → 3 and 0 → 4 → 3, where 4 is pulled towards 3.
        let at = solve(5, &[arc(0, 1, 1), arc(1, 2, 1), arc(2, 3, 1), arc(0, 4, 1), arc(4, 3, 5)]);
        assert_eq!(at, [0, 1, 2, 3, 2]);
    }

    #[test]
    fn parts_that_do_not_hang_together() {
        let at = solve(4, &[Arc { from: 0, to: 1, min: 3, weight: 1 }, Arc { from: 2, to: 3, min: 7, weight: 1 }]);
        assert_eq!((at[1] - at[0], at[3] - at[2]), (3, 7));
    }
}
