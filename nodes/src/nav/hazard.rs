use super::{
    Twist,
    latest::{Latest, Measured},
    twist::Command,
};
use crate::{
    cloud::Hazard,
    map::{Grid, Occupancy},
};
use apex_rt::{Ctx, Time, node};

/// Stops a robot before the nearest hazard that `HazardMap` reports.
///
/// `map` and `hazard` are outputs of `HazardMap`. `map` may be ⊥, as clouds come less often than twists; `hazard` is ⊥
/// with a map if the area before the robot is free. The robot stops, too, if no map is younger than `max_age`, so that
/// a camera that does not work is not taken for free floor, and if the last twist is that old. Only driving forward is
/// limited by maps.
#[node]
#[derive(Debug, Clone)]
pub struct HazardStop {
    /// Distance of the robot's front from the origin of its frame.
    #[param(unit = "m", default = 0.25, range = 0.0..=10.0)]
    front: f32,
    /// Distance between the front and the hazard at a stop: at least the near side of the area that `HazardMap`
    /// observes, less `front`.
    #[param(unit = "m", default = 0.2, range = 0.0..=10.0)]
    margin: f32,
    /// Deceleration of the robot.
    #[param(unit = "m/s^2", default = 0.6, range = 0.01..=100.0)]
    deceleration: f32,
    /// Maximum age of a map and of a twist.
    #[param(unit = "s", default = 0.6, range = 0.01..=60.0, silence)]
    max_age: f32,
    last: Latest<Seen>,
    way: Way,
    command: Command,
}

/// Content of a map.
#[derive(Debug, Clone, Copy)]
struct Seen {
    hazard: Option<Hazard>,
    /// Distance that had been driven when it came, in m.
    driven: f64,
}

impl Measured for Seen {
    fn is_usable(&self) -> bool {
        self.hazard.is_none_or(|hazard| hazard.position.x.is_finite())
    }
}

/// Way of the robot, as far as it did what it was told.
#[derive(Debug, Clone, Copy, Default)]
struct Way {
    /// Time up to which it counts.
    until: Time,
    /// Present speed, in m/s.
    speed: f32,
    /// Distance, in m.
    driven: f64,
}

impl Way {
    fn advance(&mut self, now: Time) {
        self.driven += f64::from(self.speed) * now.since(self.until).as_secs_f64();
        self.until = now;
    }
}

#[node]
impl HazardStop {
    fn process(
        &mut self,
        ctx: &Ctx,
        twist: Option<&Twist>,
        map: Option<&Grid<Occupancy>>,
        hazard: Option<&Hazard>,
    ) -> Option<Twist> {
        self.way.advance(ctx.now());
        let hazard = hazard.copied();
        let seen = map.filter(|map| map.is_usable()).map(|_| Seen { hazard, driven: self.way.driven });
        self.last.update(ctx, seen.as_ref(), self.max_age);
        let twist = self.command.update(ctx, twist, self.max_age);
        let limited = match self.last.young(ctx, self.max_age) {
            _ if twist.x <= 0.0 => twist,
            Some(seen) => twist.stoppable(self.gap(seen), self.deceleration, 0.0),
            None => Twist::ZERO,
        };
        self.way.speed = limited.x.max(0.0);
        self.command.send(limited)
    }

    /// Distance that is left before the hazard, in m.
    fn gap(&self, seen: &Seen) -> f32 {
        let ahead = self.front + self.margin + (self.way.driven - seen.driven) as f32;
        seen.hazard.map_or(f32::INFINITY, |hazard| hazard.position.x - ahead)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{cloud::HazardKind, map::Raster, scan::Point2};
    use apex_rt::Construct;

    fn at(ms: i64) -> Ctx {
        Ctx::new(Time::from_millis(ms))
    }

    fn hazard(x: f32, kind: HazardKind) -> Hazard {
        Hazard { kind, position: Point2::new(x, 0.0) }
    }

    #[test]
    fn it_stops_before_hazards_and_without_a_camera() {
        let map = Grid::new(Raster { resolution: 0.1, width: 1, height: 1, ..Raster::default() }, Occupancy::Free);
        let (mut node, twist) = (HazardStop::construct((0.25, 0.1, 0.5, 0.6)), Twist::new(0.6, 0.0, 0.3));
        let map = map.expect("small");
        let mut fire = |ms: i64, twist: &Twist, map: Option<&Grid<Occupancy>>, hazard: Option<Hazard>| {
            node.process(&at(ms), Some(twist), map, hazard.as_ref()).expect("a command")
        };
        assert_eq!(fire(0, &twist, None, None), Twist::ZERO);
        assert_eq!(fire(50, &twist, Some(&Grid::default()), None), Twist::ZERO);
        assert_eq!(fire(50, &twist, Some(&map), Some(hazard(f32::NAN, HazardKind::Obstacle))), Twist::ZERO);
        assert_eq!(fire(100, &twist, Some(&map), None), twist);
        assert_eq!(fire(600, &twist, None, None), twist);
        assert_eq!(fire(700, &twist, None, None), Twist::ZERO);
        let slow = fire(900, &twist, Some(&map), Some(hazard(0.44, HazardKind::Obstacle)));
        assert!((slow.x - 0.3).abs() < 1e-3 && (slow.omega - 0.15).abs() < 1e-3, "{slow:?}");
        assert!(fire(1000, &twist, None, None).x < 0.25, "it has come nearer");
        assert_eq!(fire(1001, &twist, Some(&map), Some(hazard(0.3, HazardKind::NoFloor))), Twist::ZERO);
        let back = Twist::new(-0.3, 0.0, 0.0);
        assert_eq!(fire(1100, &back, None, None), back);
    }
}
