use super::Motion;
use apex_rt::Time;

/// Maximum number of hypotheses over all persons.
pub const MAX_HYPOTHESES: usize = 1024;

/// Maximum number of measurements after which an assignment is final.
pub const MAX_DEPTH: usize = 8;

/// Hypothesis about one person: a leaf of its tree, in which each level assigns one measurement.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaf {
    /// Number of the person, and thus of the tree.
    pub person: u32,
    pub motion: Motion,
    /// Logarithm of the likelihood ratio of this person to false detections.
    pub score: f32,
    /// Probability that the person is still there.
    pub presence: f32,
    /// Time of the last detection.
    pub seen: Time,
    /// Number of the assigned detection, from 1, in each of the last measurements, newest first; 0 for none.
    pub trail: [u8; MAX_DEPTH],
}

impl Leaf {
    /// Hypothesis with the assignment of the next measurement.
    pub fn child(&self, detection: u8) -> Self {
        let mut child = *self;
        child.trail.copy_within(..MAX_DEPTH - 1, 1);
        child.trail[0] = detection;
        child
    }

    /// Hypothesis that the person was not detected.
    pub fn missed(&self, rate: f32) -> Self {
        let unseen = 1.0 - self.presence * rate;
        let mut child = self.child(0);
        child.score += libm::logf(unseen.max(f32::MIN_POSITIVE));
        child.presence = self.presence * (1.0 - rate) / unseen.max(f32::MIN_POSITIVE);
        child
    }
}
