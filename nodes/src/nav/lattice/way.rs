use super::{drive::CHECK, node::Node};
use crate::{
    nav::{
        BackPath, BackPiece, Path,
        payload::dubins::{Curve, advanced},
    },
    scan::Pose2,
};

/// Part of a way up to where the direction changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Section {
    /// The whole way, forward to the goal.
    ToGoal,
    /// Forward to a place where the vehicle then backs up, or that is as near to the goal as there is room.
    ToTurn,
    /// Backward.
    Back,
}

/// Way to a goal: steps, and a curve at the end.
#[derive(Debug, Clone, PartialEq)]
pub struct Way {
    /// States from the start on.
    pub(super) nodes: Vec<Node>,
    pub(super) end: Curve,
    pub(super) goal: Pose2,
    /// `true` if it leads to the goal, `false` if it ends before it.
    pub(super) is_whole: bool,
}

impl Way {
    /// Writes the first section: one forward into `path`, with points about 0.1 m apart, one backward into `back`. The
    /// other one is cleared.
    pub fn first_section(&self, path: &mut Path, back: &mut BackPath) -> Section {
        path.points.clear();
        back.pieces.clear();
        let is_back = self.nodes.get(1).is_some_and(|node| node.back.is_some());
        let is_same = |node: &&Node| node.back.is_some() == is_back;
        let count = 1 + self.nodes.iter().skip(1).take_while(is_same).count();
        let section = &self.nodes[..count];
        if is_back {
            let pieces = section.iter().filter_map(|node| Some(BackPiece { bend: node.back?, length: node.length }));
            pieces.for_each(|piece| back.add(piece));
            return Section::Back;
        }
        for pair in section.windows(2) {
            path.points
                .extend(places(pair[1].length).map(|s| advanced(&pair[0].pose, pair[1].curvature, s).position()));
        }
        let is_whole = count == self.nodes.len();
        let end = if is_whole { self.goal } else { section[count - 1].pose };
        if is_whole {
            path.points.extend(places(self.end.length()).map(|s| self.end.at(s).0.position()));
        }
        path.points.push(end.position());
        path.heading = end.theta;
        if is_whole && self.is_whole { Section::ToGoal } else { Section::ToTurn }
    }
}

/// Distances from 0 to before `length`, about a step of a check apart.
fn places(length: f32) -> impl Iterator<Item = f32> {
    let count = libm::ceilf(length / CHECK).max(1.0);
    (0..count as u32).map(move |i| length * i as f32 / count)
}
