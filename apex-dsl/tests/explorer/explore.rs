//! Search of all states of activity of a graph, breadth first.

use crate::net::{Net, State, Step};
use std::collections::BTreeMap;

/// Largest number of visited states.
const MAX_STATES: usize = 3_000;

/// All states of a graph that can be reached.
pub struct Explored {
    /// The states in the order in which they were found; the first one is that after `start`.
    pub states: Vec<State>,
    /// The state before each one, and the step from there.
    before: Vec<Option<(usize, Step)>>,
    /// The states after each one.
    next: Vec<Vec<(usize, Step)>>,
}

impl Explored {
    /// Searches all states; `None` if there are too many.
    pub fn new(net: &Net<'_>) -> Option<Self> {
        let start = net.start();
        let mut numbers = BTreeMap::from([(start, 0)]);
        let mut found = Self { states: vec![start], before: vec![None], next: vec![] };
        while found.next.len() < found.states.len() {
            let number = found.next.len();
            let mut next = vec![];
            for (step, state) in net.steps(found.states[number]) {
                let to = *numbers.entry(state).or_insert_with(|| {
                    found.states.push(state);
                    found.before.push(Some((number, step)));
                    found.states.len() - 1
                });
                next.push((to, step));
            }
            found.next.push(next);
            if found.states.len() > MAX_STATES {
                return None;
            }
        }
        Some(found)
    }

    /// The first state that `is_meant` accepts.
    pub fn first(&self, is_meant: impl Fn(usize) -> bool) -> Option<usize> {
        (0..self.states.len()).find(|number| is_meant(*number))
    }

    /// States from which a state that `is_goal` accepts can be reached over steps that `counts` accepts.
    pub fn can_reach(&self, is_goal: impl Fn(State) -> bool, counts: impl Fn(Step) -> bool) -> Vec<bool> {
        let mut back = vec![vec![]; self.states.len()];
        for (from, next) in self.next.iter().enumerate() {
            for (to, _) in next.iter().filter(|(_, step)| counts(*step)) {
                back[*to].push(from);
            }
        }
        let mut can: Vec<bool> = self.states.iter().map(|state| is_goal(*state)).collect();
        let mut open: Vec<usize> = (0..can.len()).filter(|number| can[*number]).collect();
        while let Some(number) = open.pop() {
            for from in &back[number] {
                if !can[*from] {
                    can[*from] = true;
                    open.push(*from);
                }
            }
        }
        can
    }

    /// A shortest run to a state.
    pub fn run(&self, mut number: usize) -> Vec<(Step, State)> {
        let mut run = vec![];
        while let Some((before, step)) = self.before[number] {
            run.push((step, self.states[number]));
            number = before;
        }
        run.reverse();
        run
    }
}
