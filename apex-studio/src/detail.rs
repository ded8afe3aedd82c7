//! Lanes of a short time in full detail, from the steps of a run.

use crate::{
    lane::Lane,
    steps::{Part, Steps, What},
};
use apex_rt::studio::message::About;

/// Maximum number of steps that are looked at.
const MAX_STEPS: usize = 1_500_000;

/// Lanes of all nodes between two times in ns, with buckets of this width in ns; without problems. Returns `None` if
/// the time is too long, or the steps are forgotten.
pub fn lanes(steps: &Steps, about: &About, from: i64, to: i64, bucket: i64) -> Option<Vec<Lane>> {
    let part = steps.between(from, to, MAX_STEPS)?;
    let is_known = !part.is_forgotten || part.before.now <= from;
    is_known.then(|| of_part(&part, about, to, bucket))
}

fn of_part(part: &Part<'_>, about: &About, to: i64, bucket: i64) -> Vec<Lane> {
    let mut lanes: Vec<Lane> = about.nodes.iter().map(|_| Lane::fine(bucket)).collect();
    let mut at = |node: u32, act: &dyn Fn(&mut Lane)| lanes.get_mut(node as usize).map_or((), act);
    for node in &part.before.active {
        at(*node, &|lane| lane.activity(part.before.now, true));
    }
    for step in (0..part.until(to)).map(|at| part[at]) {
        match step.what {
            What::Fires(node) => at(node, &|lane| lane.fire(step.now)),
            What::Takes(connection) => {
                let to = about.connections.get(connection as usize).map_or(u32::MAX, |connection| connection.to);
                at(to, &|lane| lane.fire(step.now));
            }
            What::Starts(node) => at(node, &|lane| lane.activity(step.now, true)),
            What::Stops(node) => at(node, &|lane| lane.activity(step.now, false)),
            What::Begins | What::Sends(_) => {}
        }
    }
    lanes
}
