use crate::goal::{Fitness, Goal, Runs, costs};
use apex_optim::Selection;

/// Minimum number of runs of a round. It does not depend on the number of threads, so that the same runs are saved on
/// any number.
const ROUND: usize = 16;

/// Race of the candidates of one generation over the seeds.
pub(crate) struct Race<'a> {
    pub goals: &'a [Goal],
    pub fitness: &'a Fitness,
    pub selection: Selection<'a>,
    /// Numbers of the seeds, in the order in which they are run.
    pub order: &'a [usize],
}

impl Race<'_> {
    /// Runs the candidates until the fitness of each of them is known or does not matter. Returns the costs by
    /// candidate and by number of the seed. `run` takes pairs of a candidate and the number of a seed.
    pub fn run<E>(
        &self,
        candidates: usize,
        mut run: impl FnMut(&[(usize, usize)]) -> Result<Vec<Vec<f64>>, E>,
    ) -> Result<Vec<Runs>, E> {
        let mut costs: Vec<Runs> = vec![vec![None; self.order.len()]; candidates];
        let mut done = vec![0; candidates];
        loop {
            let live = self.live(&costs, &done);
            if live.is_empty() {
                return Ok(costs);
            }
            let block = ROUND.div_ceil(live.len());
            let next = |&c: &usize| self.order[done[c]..].iter().take(block).map(move |seed| (c, *seed));
            let work: Vec<(usize, usize)> = live.iter().flat_map(next).collect();
            for ((candidate, seed), cost) in work.iter().zip(run(&work)?) {
                costs[*candidate][*seed] = Some(cost);
                done[*candidate] += 1;
            }
        }
    }

    /// Candidates that run next.
    fn live(&self, runs: &[Runs], done: &[usize]) -> Vec<usize> {
        let bounds: Vec<f64> = runs.iter().map(|runs| self.fitness.of(&costs(self.goals, runs))).collect();
        let is_open = |c: &usize| done[*c] < self.order.len() && bounds[*c] < f64::INFINITY;
        let mut open: Vec<usize> = (0..runs.len()).filter(is_open).collect();
        match self.selection {
            Selection::All => {}
            Selection::AtMost(limits) => open.retain(|&c| bounds[c] <= limits[c]),
            Selection::Best(count) => {
                let complete = (0..runs.len()).filter(|&c| done[c] == self.order.len());
                let mut complete: Vec<f64> = complete.map(|c| bounds[c]).filter(|f| f.is_finite()).collect();
                complete.sort_by(f64::total_cmp);
                match complete.get(count.max(1) - 1) {
                    Some(limit) => open.retain(|&c| bounds[c] <= *limit),
                    None if open.iter().all(|&c| done[c] > 0) => {
                        open.sort_by(|a, b| bounds[*a].total_cmp(&bounds[*b]));
                        open.truncate(count.max(1) - complete.len());
                    }
                    None => open.retain(|&c| done[c] == 0),
                }
            }
        }
        open
    }
}
