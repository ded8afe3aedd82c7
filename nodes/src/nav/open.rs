use core::cmp::Ordering;

/// State that a search may expand, in a queue of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Open {
    /// Estimated cost of the whole way through the state.
    pub estimate: f32,
    pub node: u32,
}

impl Eq for Open {}

/// The greatest entry is expanded next: the one with the least estimate, then the latest.
impl Ord for Open {
    fn cmp(&self, other: &Self) -> Ordering {
        other.estimate.total_cmp(&self.estimate).then_with(|| self.node.cmp(&other.node))
    }
}

impl PartialOrd for Open {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
