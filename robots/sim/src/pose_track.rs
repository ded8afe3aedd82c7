use apex_nodes::scan::Pose2;
use std::collections::VecDeque;

/// Poses of a body in the last steps of a simulation.
#[derive(Debug, Clone, PartialEq)]
pub struct PoseTrack {
    /// Time between two poses, in s.
    step: f32,
    length: usize,
    /// The newest pose is the first one.
    poses: VecDeque<Pose2>,
}

impl PoseTrack {
    /// Creates the track of a body at `pose`, which has stood there. It is `length` s long, with steps of `step` s.
    pub fn new(pose: Pose2, length: f32, step: f32) -> Self {
        let count = if step > 0.0 { libm::ceilf(length / step) as usize } else { 0 };
        Self { step, length: count + 1, poses: VecDeque::from([pose]) }
    }

    /// Adds the pose after the next step.
    pub fn push(&mut self, pose: Pose2) {
        self.poses.truncate(self.length - 1);
        self.poses.push_front(pose);
    }

    /// Pose at `age` s before the newest one, or the oldest one that is known.
    pub fn before(&self, age: f32) -> Pose2 {
        let place = (age / self.step).clamp(0.0, (self.poses.len() - 1) as f32);
        let later = place as usize;
        let (b, a) = (self.poses[later], self.poses[(later + 1).min(self.poses.len() - 1)]);
        let part = place - later as f32;
        // Without rounding where no other pose takes part.
        if part > 0.0 { b.on_way_to(&a, part) } else { b }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track() -> PoseTrack {
        let mut track = PoseTrack::new(Pose2::default(), 0.1, 0.02);
        (1..=20).for_each(|step| track.push(Pose2::new(step as f32, 0.0, 3.0 + 0.02 * step as f32)));
        track
    }

    #[test]
    fn poses_lie_between_those_of_the_steps() {
        let track = track();
        assert_eq!(track.before(0.0), Pose2::new(20.0, 0.0, 3.4));
        let pose = track.before(0.03);
        assert!((pose.x - 18.5).abs() < 1e-4, "{pose:?}");
    }

    #[test]
    fn a_turn_takes_the_shorter_way_around() {
        let mut track = PoseTrack::new(Pose2::new(0.0, 0.0, 3.1), 0.1, 0.02);
        track.push(Pose2::new(0.0, 0.0, -3.1));
        let middle = track.before(0.01).theta;
        assert!(apex_nodes::scan::wrap_angle(middle - core::f32::consts::PI).abs() < 1e-3, "{middle}");
    }

    #[test]
    fn the_oldest_pose_is_that_of_its_length_ago() {
        assert_eq!(track().before(9.0).x, 15.0);
        assert_eq!(PoseTrack::new(Pose2::new(1.0, 2.0, 3.0), 0.1, 0.02).before(0.05), Pose2::new(1.0, 2.0, 3.0));
    }
}
