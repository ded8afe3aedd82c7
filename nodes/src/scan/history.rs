use super::Pose2;
use apex_rt::Time;
use heapless::Deque;

/// The last `N` poses of something that moves, with their times.
#[derive(Debug, Clone, Default)]
pub(crate) struct PoseHistory<const N: usize> {
    poses: Deque<(Time, Pose2), N>,
}

impl<const N: usize> PoseHistory<N> {
    /// Adds a pose, unless it is not a number or too far away. Forgets the others if the clock was set back.
    pub fn keep(&mut self, now: Time, pose: &Pose2) {
        if self.poses.back().is_some_and(|(last, _)| *last > now) {
            self.poses.clear();
        }
        if !pose.is_usable() {
            return;
        }
        if self.poses.is_full() {
            self.poses.pop_front();
        }
        // Cannot fail: there is room.
        let _ = self.poses.push_back((now, *pose));
    }

    /// Newest pose, and its time.
    pub fn newest(&self) -> Option<&(Time, Pose2)> {
        self.poses.back()
    }

    /// Pose at a time, between those before and after it. `None` before all that is kept, and later than the newest.
    pub fn at(&self, time: Time) -> Option<Pose2> {
        let next = self.poses.iter().position(|(known, _)| *known >= time)?;
        let (after, pose) = self.poses.iter().nth(next)?;
        if *after == time {
            return Some(*pose);
        }
        let (before, last) = self.poses.iter().nth(next.checked_sub(1)?)?;
        let part = time.since(*before).as_secs_f32() / after.since(*before).as_secs_f32();
        Some(last.on_way_to(pose, part))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_lies_between_two_poses() {
        let mut history = PoseHistory::<3>::default();
        for ms in [0, 80, 160, 240] {
            history.keep(Time::from_millis(ms), &Pose2::new(0.0005 * ms as f32, 0.0, 0.0));
            history.keep(Time::from_millis(ms), &Pose2::new(f32::NAN, 0.0, 0.0));
        }
        let at = |ms: i64| history.at(Time::from_millis(ms)).map(|pose| pose.x);
        for (ms, expected) in [(80, 0.04), (100, 0.05), (160, 0.08), (240, 0.12)] {
            assert!((at(ms).expect("it is kept") - expected).abs() < 1e-6, "{ms}");
        }
        assert_eq!((at(79), at(241)), (None, None));
        history.keep(Time::from_millis(10), &Pose2::default());
        assert_eq!(history.at(Time::from_millis(160)), None, "the clock was set back");
    }
}
