use crate::FloorPlan;
use apex_nodes::scan::{Point2, Pose2};
use apex_rt::Time;

/// Distance between points of the trail, in m.
const TRAIL_STEP: f32 = 0.08;
/// Maximum number of points of the trail. Beyond it, every second point is removed.
const TRAIL_LENGTH: usize = 2000;

/// Content of the view.
#[derive(Debug, Clone)]
pub(super) struct Picture {
    pub plan: FloorPlan,
    /// Pose of the robot in the world.
    pub pose: Pose2,
    /// Points of the last scan, in the world.
    pub hits: Vec<Point2>,
    /// Previous positions of the robot.
    pub trail: Vec<Point2>,
    /// Time of the view.
    pub now: Time,
    /// Last note.
    pub note: String,
}

impl Picture {
    pub fn new(plan: FloorPlan) -> Self {
        let pose = plan.start;
        Self { plan, pose, hits: vec![], trail: vec![], now: Time::ZERO, note: String::new() }
    }

    /// Moves the robot to a pose.
    pub fn come_to(&mut self, pose: &Pose2) {
        self.pose = *pose;
        let far = |last: &Point2| (*last - pose.position()).norm() >= TRAIL_STEP;
        if self.trail.last().is_none_or(far) {
            if self.trail.len() >= TRAIL_LENGTH {
                let mut keep = false;
                self.trail.retain(|_| {
                    keep = !keep;
                    keep
                });
            }
            self.trail.push(pose.position());
        }
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub const ROOM: &str = "\
##########
#        #
# >    o #
##########";

    /// The room with a robot that has driven half a metre and sees the wall ahead.
    pub fn picture() -> Picture {
        let mut picture = Picture::new(FloorPlan::parse(ROOM).expect("a room"));
        for step in 0..=5 {
            picture.come_to(&Pose2::new(0.625 + 0.1 * step as f32, 0.75, 0.0));
        }
        picture.hits = vec![Point2::new(2.25, 1.0), Point2::new(1.8, 0.75)];
        picture.now = Time::from_millis(1250);
        picture.note = "drives <on>".to_owned();
        picture
    }

    #[test]
    fn the_trail_stays_short() {
        let mut picture = picture();
        for step in 0..20_000 {
            picture.come_to(&Pose2::new(0.1 * step as f32, 0.0, 0.0));
        }
        assert!((TRAIL_LENGTH / 2..=TRAIL_LENGTH).contains(&picture.trail.len()), "{}", picture.trail.len());
        assert!((picture.trail.last().expect("a place").x - 1999.9).abs() < 0.1);
    }
}
