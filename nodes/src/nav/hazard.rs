use super::{
    Twist,
    latest::{Latest, Measured},
    twist::Command,
};
use crate::{
    cloud::{Hazard, HazardKind},
    map::{Grid, Occupancy},
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Out, Time, node};
use std::collections::VecDeque;

/// Maximum number of remembered hazards.
const MOST: usize = 200;
/// Minimum distance between remembered hazards, in m.
const APART: f32 = 0.1;

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

/// Marks the hazards that were met in a map on which a path is planned, so that the next path avoids them.
///
/// `hazard` is that of `HazardMap` at `pose`, which is in the frame of the map. Each is remembered for some time, and
/// marked as occupied cells around it. Places where no floor was seen are remembered for longer, as stairs do not go
/// away, but only if they are reported repeatedly: they may just not have been in view.
#[node]
#[derive(Debug, Clone)]
pub struct MarkHazards {
    /// Time for which an obstacle is remembered.
    #[param(unit = "s", default = 20.0, range = 0.0..=86400.0)]
    memory: f32,
    /// Time for which a place without floor is remembered.
    #[param(unit = "s", default = 600.0, range = 0.0..=86400.0)]
    floor_memory: f32,
    /// Radius of the area that is marked around an obstacle.
    #[param(unit = "m", default = 0.1, range = 0.0..=10.0)]
    radius: f32,
    /// Radius of the area that is marked around a place without floor.
    #[param(unit = "m", default = 0.3, range = 0.0..=10.0)]
    floor_radius: f32,
    /// Number of reports of the same place without floor after which it is marked.
    #[param(default = 5, range = 1..=1000)]
    reports: u32,
    known: VecDeque<Known>,
}

/// Remembered hazard.
#[derive(Debug, Clone, Copy)]
struct Known {
    hazard: Hazard,
    /// Time of the last report.
    at: Time,
    /// Number of reports that are still missing.
    missing: u32,
}

#[node]
impl MarkHazards {
    fn process(
        &mut self,
        ctx: &Ctx,
        map: Option<&Grid<Occupancy>>,
        pose: Option<&Pose2>,
        hazard: Option<&Hazard>,
        marked: &mut Out<Grid<Occupancy>>,
    ) {
        if let Some((hazard, pose)) = hazard.zip(pose.filter(|pose| pose.is_usable())) {
            self.remember(Hazard { position: pose.to_outer(hazard.position), ..*hazard }, ctx.now());
        }
        let Some(map) = map else { return };
        let memory = [self.memory, self.floor_memory];
        self.known.retain(|known| ctx.now().since(known.at).as_secs_f32() <= of_kind(known.hazard.kind, memory));
        let marked = marked.get_mut();
        marked.clone_from(map);
        for known in self.known.iter().filter(|known| known.missing == 0) {
            let radius = of_kind(known.hazard.kind, [self.radius, self.floor_radius]);
            occupy(marked, known.hazard.position, radius);
        }
    }

    /// Forgets the obstacles, but not the places without floor.
    #[slot]
    fn forget(&mut self) {
        self.known.retain(|known| known.hazard.kind == HazardKind::NoFloor);
    }

    fn remember(&mut self, hazard: Hazard, now: Time) {
        let is_same = |known: &&mut Known| {
            known.hazard.kind == hazard.kind && (known.hazard.position - hazard.position).norm() < APART
        };
        if let Some(known) = self.known.iter_mut().find(is_same) {
            (known.at, known.missing) = (now, known.missing.saturating_sub(1));
            return;
        }
        if self.known.len() == MOST {
            self.known.pop_front();
        }
        let missing = if hazard.kind == HazardKind::Obstacle { 0 } else { self.reports.saturating_sub(1) };
        self.known.push_back(Known { hazard, at: now, missing });
    }
}

/// The first of two values for an obstacle, the second for a place without floor.
const fn of_kind(kind: HazardKind, [obstacle, floor]: [f32; 2]) -> f32 {
    match kind {
        HazardKind::Obstacle => obstacle,
        HazardKind::NoFloor => floor,
    }
}

/// Marks the cells within `radius` m of a point.
fn occupy(map: &mut Grid<Occupancy>, point: Point2, radius: f32) {
    let raster = *map.raster();
    let reach = libm::ceilf(radius / raster.resolution).clamp(0.0, 100.0) as i32;
    for (dx, dy) in (-reach..=reach).flat_map(|dx| (-reach..=reach).map(move |dy| (dx, dy))) {
        let off = Point2::new(dx as f32, dy as f32).scaled(raster.resolution);
        let cell = raster.cell(point + off).filter(|_| off.norm() <= radius);
        if let Some(cell) = cell.and_then(|cell| map.get_mut(cell)) {
            *cell = Occupancy::Occupied;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
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

    #[test]
    fn hazards_are_marked_for_a_while() {
        let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 40, height: 40 };
        let map = Grid::new(raster, Occupancy::Free).expect("small");
        let mut node = MarkHazards::construct((10.0, 100.0, 0.15, 0.2, 3));
        let pose = Pose2::new(1.0, 2.0, 0.0);
        let mut see = |ms: i64, x: f32, kind: HazardKind| {
            let mut out = Out::new();
            node.process(&at(ms), Some(&map), Some(&pose), Some(&hazard(x, kind)), &mut out);
            out.get().expect("a map").clone()
        };
        let occupied = |map: &Grid<Occupancy>, x: f32| map.at(Point2::new(x, 2.0)) == Some(&Occupancy::Occupied);
        let marked = see(0, 1.0, HazardKind::Obstacle);
        assert!(occupied(&marked, 2.0) && occupied(&marked, 2.1) && !occupied(&marked, 2.3));
        for (ms, is_marked) in [(1000, false), (2000, false), (3000, true)] {
            assert_eq!(occupied(&see(ms, 0.5, HazardKind::NoFloor), 1.5), is_marked);
        }
        node.forget();
        let mut see = |ms: i64, x: f32, kind: HazardKind| {
            let mut out = Out::new();
            node.process(&at(ms), Some(&map), Some(&pose), Some(&hazard(x, kind)), &mut out);
            out.get().expect("a map").clone()
        };
        assert!(!occupied(&see(3100, 0.5, HazardKind::NoFloor), 2.0));
        let later = see(12_000, 2.0, HazardKind::NoFloor);
        assert!(!occupied(&later, 2.05) && occupied(&later, 1.5) && occupied(&later, 1.65));
        let mut out = Out::new();
        node.process(&at(13_000), None, Some(&Pose2::new(f32::NAN, 0.0, 0.0)), None, &mut out);
        assert!(out.get().is_none());
    }
}
