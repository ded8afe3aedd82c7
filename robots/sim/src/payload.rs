use crate::{Wall, World};
use apex_nodes::{
    nav::Articulated,
    scan::{Point2, Pose2},
};

/// Area that a rigid part of a robot covers: a rectangle around a pose, in m.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Footprint {
    /// Middle and direction.
    pub pose: Pose2,
    /// Size along the direction.
    pub length: f32,
    /// Size across.
    pub width: f32,
}

/// Lift beneath a container. It moves at a constant speed between its lowest position, 0, and its highest one, 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lift {
    /// Time from the lowest to the highest position, in s.
    pub duration: f32,
    /// Position, from 0 to 1.
    pub position: f32,
    /// `true` if it moves up, or is up.
    pub is_raised: bool,
}

impl Footprint {
    /// Footprints of a tractor at `base` and of its trailer with this heading, in rad.
    pub fn of(vehicle: &Articulated, base: &Pose2, heading: f32) -> [Self; 2] {
        let part = |pose: &Pose2, from: f32, to: f32| {
            let middle = pose.to_outer(Point2::new(0.5 * (from + to), 0.0));
            let pose = Pose2::new(middle.x, middle.y, pose.theta);
            Self { pose, length: to - from, width: vehicle.width }
        };
        let trailer = vehicle.trailer(base, heading);
        [part(base, -vehicle.hitch, vehicle.front), part(&trailer, -vehicle.rear, 0.5 * vehicle.drawbar)]
    }

    /// Distance to the nearest object of the world, in m: 0 if it touches one, infinite in an empty world.
    pub fn clearance(&self, world: &World) -> f32 {
        let walls = world.walls().iter().map(|wall| self.distance_to_wall(wall));
        let discs = world.discs().iter().map(|disc| (self.distance(disc.centre) - disc.radius).max(0.0));
        walls.chain(discs).fold(f32::INFINITY, f32::min)
    }

    /// Point of the area that is nearest to a point: the point itself inside.
    pub fn nearest(&self, point: Point2) -> Point2 {
        let p = self.pose.to_inner(point);
        let within = |value: f32, size: f32| value.clamp(-0.5 * size.abs(), 0.5 * size.abs());
        self.pose.to_outer(Point2::new(within(p.x, self.length), within(p.y, self.width)))
    }

    /// Distance to a point, in m: 0 inside.
    pub fn distance(&self, point: Point2) -> f32 {
        let p = self.pose.to_inner(point);
        let outside = |value: f32, size: f32| (value.abs() - 0.5 * size).max(0.0);
        libm::hypotf(outside(p.x, self.length), outside(p.y, self.width))
    }

    fn distance_to_wall(&self, wall: &Wall) -> f32 {
        if self.is_crossed_by(wall) {
            return 0.0;
        }
        // Apart from each other, the nearest points include an end of the wall or a corner.
        let corners = [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)]
            .map(|(x, y)| wall.distance(self.pose.to_outer(Point2::new(x * self.length, y * self.width))));
        corners.into_iter().chain([wall.a, wall.b].map(|end| self.distance(end))).fold(f32::INFINITY, f32::min)
    }

    /// Returns `true` if a part of the wall is inside (clipping of Liang and Barsky 1984).
    fn is_crossed_by(&self, wall: &Wall) -> bool {
        let (a, b) = (self.pose.to_inner(wall.a), self.pose.to_inner(wall.b));
        let (mut from, mut to) = (0.0_f32, 1.0_f32);
        for (start, end, half) in [(a.x, b.x, 0.5 * self.length), (a.y, b.y, 0.5 * self.width)] {
            let way = end - start;
            if way == 0.0 {
                if start.abs() > half {
                    return false;
                }
                continue;
            }
            let (one, other) = ((-half - start) / way, (half - start) / way);
            from = from.max(one.min(other));
            to = to.min(one.max(other));
        }
        from <= to
    }
}

impl Lift {
    /// A lift at its lowest position.
    pub const fn lowered(duration: f32) -> Self {
        Self { duration, position: 0.0, is_raised: false }
    }

    /// Moves for `dt` s. Returns `true` when it arrives at an end.
    pub fn step(&mut self, dt: f32) -> bool {
        let (before, end) = (self.position, if self.is_raised { 1.0 } else { 0.0 });
        let step = if self.duration > 0.0 { dt / self.duration } else { 1.0 };
        self.position += (end - before).clamp(-step, step);
        self.position == end && before != end
    }

    /// Returns `true` if a container above it hangs on it.
    pub fn carries(&self) -> bool {
        self.position > 0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clearance_is_that_of_the_rectangle() {
        let mut world = World::default();
        let long = Footprint { pose: Pose2::new(0.0, 0.0, 0.0), length: 1.2, width: 0.4 };
        assert_eq!(long.clearance(&world), f32::INFINITY);
        world.wall(Point2::new(1.0, -3.0), Point2::new(1.0, 3.0));
        let near = |footprint: Footprint, distance: f32| {
            let clearance = footprint.clearance(&world);
            assert!((clearance - distance).abs() < 1e-5, "{clearance} instead of {distance}");
        };
        near(long, 0.4);
        near(Footprint { pose: Pose2::new(0.0, 0.0, core::f32::consts::FRAC_PI_2), ..long }, 0.8);
        near(Footprint { pose: Pose2::new(0.7, 0.0, 0.0), ..long }, 0.0);
        // A post beside the middle, and one inside.
        for (y, distance) in [(0.5, 0.2), (0.0, 0.0)] {
            let mut world = World::default();
            world.disc(Point2::new(0.1, y), 0.1);
            assert!((long.clearance(&world) - distance).abs() < 1e-5);
        }
    }

    #[test]
    fn tractor_and_trailer_cover_their_parts() {
        let [tractor, trailer] = Footprint::of(&Articulated::PATSY, &Pose2::default(), 0.0);
        assert!((tractor.pose.x - 0.075).abs() < 1e-6 && (tractor.length - 0.35).abs() < 1e-6);
        assert!((trailer.pose.x + 0.5875).abs() < 1e-6 && (trailer.length - 0.425).abs() < 1e-6);
    }

    #[test]
    fn a_lift_takes_its_time_and_arrives_once() {
        let mut lift = Lift::lowered(2.0);
        lift.is_raised = true;
        let arrivals: Vec<bool> = (0..6).map(|_| lift.step(0.5)).collect();
        assert_eq!(arrivals, [false, false, false, true, false, false]);
        assert!(lift.carries());
        lift.is_raised = false;
        assert!(!lift.step(1.0) && lift.carries() && lift.step(1.5) && !lift.carries());
    }
}
