use super::{
    Obstacle,
    body::{Bodies, Touch, room},
};
use crate::world::Arena;

/// Speed towards the other from which on a robot has caused the collision, in m/s.
const PUSH: f32 = 0.05;

/// Distance at which a contact has ended, in m.
const APART: f32 = 0.02;

/// Detects collisions. A contact counts once, regardless of its duration.
#[derive(Debug, Clone, Default)]
pub(super) struct Referee {
    touching: Vec<(usize, Obstacle)>,
}

/// Collision of a robot with an obstacle.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crash {
    pub touch: Touch,
    /// Causes of the collision: `true` if the robot caused it, and `true` if the obstacle did.
    pub caused: [bool; 2],
}

impl Referee {
    /// Collision that begins with a contact, or `None` if the contact continues.
    pub fn judge(&mut self, touch: &Touch) -> Option<Crash> {
        let pair = pair(touch.who, touch.against);
        if self.touching.contains(&pair) {
            return None;
        }
        self.touching.push(pair);
        let is_wall = !matches!(touch.against, Obstacle::Robot(_));
        let caused = [is_wall || touch.approach[0] > PUSH, touch.approach[1] > PUSH];
        Some(Crash { touch: *touch, caused })
    }

    /// Removes contacts that have ended.
    pub fn release(&mut self, arena: &Arena, bodies: &Bodies) {
        self.touching.retain(|(who, against)| room(*who, *against, arena, bodies) < APART);
    }
}

/// Key of a pair of robots, independent of their order.
fn pair(who: usize, against: Obstacle) -> (usize, Obstacle) {
    match against {
        Obstacle::Robot(other) if other < who => (other, Obstacle::Robot(who)),
        _ => (who, against),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::scan::Point2;

    fn touch(who: usize, against: Obstacle, approach: [f32; 2]) -> Touch {
        Touch { who, against, place: Point2::default(), approach }
    }

    #[test]
    fn whoever_is_fast_towards_the_other_has_caused_it() {
        let cases = [
            (Obstacle::Robot(2), [0.3, 0.0], [true, false]),
            (Obstacle::Robot(2), [0.04, 0.3], [false, true]),
            (Obstacle::Robot(2), [0.3, 0.06], [true, true]),
            (Obstacle::Robot(2), [0.04, -0.5], [false, false]),
            (Obstacle::Border, [0.01, 0.0], [true, false]),
        ];
        for (against, approach, caused) in cases {
            let crash = Referee::default().judge(&touch(1, against, approach)).expect("the first touch");
            assert_eq!(crash.caused, caused, "{against:?}, {approach:?}");
        }
    }

    #[test]
    fn a_touch_counts_once_for_both() {
        let mut referee = Referee::default();
        assert!(referee.judge(&touch(0, Obstacle::Robot(2), [1.0, 0.0])).is_some());
        assert!(referee.judge(&touch(0, Obstacle::Robot(2), [1.0, 0.0])).is_none());
        assert!(referee.judge(&touch(2, Obstacle::Robot(0), [1.0, 0.0])).is_none());
        assert!(referee.judge(&touch(0, Obstacle::Robot(1), [1.0, 0.0])).is_some());
        assert!(referee.judge(&touch(2, Obstacle::Border, [1.0, 0.0])).is_some());
    }
}
