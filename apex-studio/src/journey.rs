//! A way back in time: the robot is started again and does the same up to a point, because programs are deterministic.

use crate::live::Live;
use apex_rt::studio::message::{Command, Report};
use std::collections::{BTreeMap, VecDeque};

/// A repetition of a run up to a reaction.
pub struct Journey {
    /// Parameters to be set, with the numbers of reactions before.
    sets: VecDeque<(u64, String, String)>,
    goal: u64,
    /// Values of the parameters at the beginning of the run.
    initial: BTreeMap<String, String>,
    /// Number of parameters whose values are not known yet.
    unknown: usize,
}

impl Journey {
    /// A journey to the state after `goal` reactions of a run.
    pub fn of(live: &Live, goal: u64) -> Self {
        let sets = live.sets.iter().filter(|(at, ..)| *at <= goal).cloned().collect();
        let settable = live.params.iter().filter(|(_, param)| !param.fixed);
        let initial = settable.map(|(name, param)| (name.clone(), param.initial.clone())).collect();
        Self { sets, goal, initial, unknown: 0 }
    }

    /// Begins with a robot that has told its values of `params` parameters, or will.
    pub fn begin(&mut self, params: usize) -> Option<Command> {
        self.unknown = params;
        (params == 0).then(|| self.forth())
    }

    /// The command after a message of the robot. Returns `None` while it works on the last one.
    pub fn after(&mut self, report: &Report) -> Option<Command> {
        match report {
            // The values that the program starts with; those of the run may have been others.
            Report::Param { name, value, reactions: None } => {
                let other = self.initial.remove(name).filter(|initial| value.as_ref().is_ok_and(|v| v != initial));
                self.sets.extend(other.map(|value| (0, name.clone(), value)));
                self.unknown = self.unknown.saturating_sub(1);
                if self.unknown > 0 {
                    return None;
                }
                self.sets.make_contiguous().sort_by_key(|(at, ..)| *at);
                Some(self.forth())
            }
            Report::Pace { paused: true, reactions, .. } if self.unknown == 0 => {
                if self.sets.front().is_none_or(|(at, ..)| at > reactions) {
                    return None;
                }
                let (_, name, value) = self.sets.pop_front()?;
                Some(Command::Set { name, value })
            }
            Report::Param { .. } => Some(self.forth()),
            _ => None,
        }
    }

    /// `true` if a message says that it is at its end.
    pub fn ends(&self, report: &Report) -> bool {
        let is_there = matches!(report, Report::Pace { paused: true, reactions, .. } if *reactions >= self.goal);
        is_there && self.unknown == 0 && self.sets.is_empty()
    }

    /// The way to the next parameter, or to the end.
    fn forth(&self) -> Command {
        Command::RunTo { reactions: self.sets.front().map_or(self.goal, |(at, ..)| *at).min(self.goal) }
    }
}
