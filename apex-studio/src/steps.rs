//! The last steps of a robot, up to a limit.

use std::{
    collections::VecDeque,
    ops::{Index, Range},
};

/// Number of steps that are kept.
const MAX_STEPS: usize = 1 << 20;

/// The last steps of a robot.
#[derive(Default)]
pub struct Steps {
    steps: VecDeque<Step>,
    forgotten: bool,
}

/// A step of a reaction.
#[derive(Debug, Clone, Copy)]
pub struct Step {
    /// Time of the reaction in ns.
    pub now: i64,
    /// Number of the reaction, from 1; 0 before the first one.
    pub reaction: u32,
    pub what: What,
}

/// Kind of a step. Numbers are those of the robot's description.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum What {
    /// The reaction begins.
    Begins,
    /// A node fires.
    Fires(u32),
    /// The slot at the end of a connection takes its token.
    Takes(u32),
    /// A token is sent over a channel.
    Sends(u32),
    /// A node becomes active.
    Starts(u32),
    /// A node becomes inactive.
    Stops(u32),
}

impl Steps {
    pub fn push(&mut self, step: Step) {
        if self.steps.len() == MAX_STEPS {
            self.steps.pop_front();
            self.forgotten = true;
        }
        self.steps.push_back(step);
    }

    /// Forgets the steps after this number of reactions.
    pub fn take_back(&mut self, reactions: u64) {
        self.steps.truncate(self.steps.partition_point(|step| u64::from(step.reaction) <= reactions));
    }

    /// `true` if there is no room for the first steps of the run any more.
    pub fn begin_is_forgotten(&self) -> bool {
        self.forgotten
    }

    /// Number of the steps up to a time in ns.
    pub fn until(&self, time: i64) -> usize {
        self.steps.partition_point(|step| step.now <= time)
    }

    /// The last of the first `end` steps that is one of these.
    pub fn last(&self, end: usize, is: impl Fn(What) -> bool) -> Option<usize> {
        self.steps.range(..end).rposition(|step| is(step.what))
    }

    /// The steps of the reaction that a step belongs to.
    pub fn reaction(&self, of: usize) -> Range<usize> {
        let number = self.steps[of].reaction;
        self.steps.partition_point(|step| step.reaction < number)
            ..self.steps.partition_point(|step| step.reaction <= number)
    }
}

impl Index<usize> for Steps {
    type Output = Step;

    fn index(&self, at: usize) -> &Step {
        &self.steps[at]
    }
}
