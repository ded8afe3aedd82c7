use apex_nodes::scan::{Point2, Pose2};

/// Straight wall between two points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// First end, in m.
    pub a: Point2,
    /// Second end, in m.
    pub b: Point2,
}

/// Round post.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disc {
    /// Centre, in m.
    pub centre: Point2,
    /// Radius, in m.
    pub radius: f32,
}

/// World of a plane scanner: walls and discs.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct World {
    walls: Vec<Wall>,
    discs: Vec<Disc>,
}

impl World {
    /// Removes all objects and keeps the storage.
    pub fn clear(&mut self) {
        self.walls.clear();
        self.discs.clear();
    }

    /// Adds a wall from `a` to `b`.
    pub fn wall(&mut self, a: Point2, b: Point2) {
        self.walls.push(Wall { a, b });
    }

    /// Adds the sides of a polygon.
    pub fn polygon(&mut self, corners: &[Point2]) {
        let next = corners.iter().cycle().skip(1);
        corners.iter().zip(next).for_each(|(a, b)| self.wall(*a, *b));
    }

    /// Adds a disc.
    pub fn disc(&mut self, centre: Point2, radius: f32) {
        self.discs.push(Disc { centre, radius });
    }

    /// Discs for modification.
    pub fn discs_mut(&mut self) -> &mut [Disc] {
        &mut self.discs
    }

    /// Adds the four sides of a box with its centre at `pose`.
    pub fn block(&mut self, pose: &Pose2, length: f32, width: f32) {
        let corners = [(0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5)]
            .map(|(x, y)| pose.to_outer(Point2::new(x * length, y * width)));
        self.polygon(&corners);
    }

    /// All walls.
    pub fn walls(&self) -> &[Wall] {
        &self.walls
    }

    /// All discs.
    pub fn discs(&self) -> &[Disc] {
        &self.discs
    }

    /// Replaces the content by the objects of another world that are within `reach` m of a point. Keeps the storage.
    pub fn take_near(&mut self, other: &Self, point: Point2, reach: f32) {
        self.clear();
        self.walls.extend(other.walls.iter().filter(|wall| wall.distance(point) <= reach));
        self.discs.extend(other.discs.iter().filter(|disc| (disc.centre - point).norm() - disc.radius <= reach));
    }

    /// Distance from `origin` along the unit vector `direction` to the first object, or `None` if there is none.
    pub fn cast(&self, origin: Point2, direction: Point2) -> Option<f32> {
        let walls = self.walls.iter().filter_map(|wall| wall.hit(origin, direction));
        let discs = self.discs.iter().filter_map(|disc| disc.hit(origin, direction));
        walls.chain(discs).reduce(f32::min)
    }

    /// Distance from `point` to the nearest object: infinite in an empty world, 0 inside a disc.
    pub fn clearance(&self, point: Point2) -> f32 {
        let walls = self.walls.iter().map(|wall| wall.distance(point));
        let discs = self.discs.iter().map(|disc| ((point - disc.centre).norm() - disc.radius).max(0.0));
        walls.chain(discs).fold(f32::INFINITY, f32::min)
    }
}

impl Wall {
    /// Distance to a point, in m.
    pub fn distance(&self, point: Point2) -> f32 {
        let (along, from) = (self.b - self.a, point - self.a);
        let share = (from.dot(along) / along.norm_squared()).clamp(0.0, 1.0);
        // A wall without a length is a point.
        let share = if share.is_nan() { 0.0 } else { share };
        (from - along.scaled(share)).norm()
    }

    /// Distance from `origin` along the unit vector `direction` to the object, or `None` if it is not met.
    pub fn hit(&self, origin: Point2, direction: Point2) -> Option<f32> {
        let (along, from) = (self.b - self.a, self.a - origin);
        let normal = along.perpendicular();
        let slope = direction.dot(normal);
        if slope == 0.0 {
            return None;
        }
        let distance = from.dot(normal) / slope;
        let place = (direction.scaled(distance) - from).dot(along);
        (distance >= 0.0 && (0.0..=along.norm_squared()).contains(&place)).then_some(distance)
    }
}

impl Disc {
    /// Distance from `origin` along the unit vector `direction` to the object, or `None` if it is not met.
    pub fn hit(&self, origin: Point2, direction: Point2) -> Option<f32> {
        let to_centre = self.centre - origin;
        let along = to_centre.dot(direction);
        let across = direction.perpendicular().dot(to_centre);
        let half_chord_squared = self.radius * self.radius - across * across;
        if half_chord_squared < 0.0 {
            return None;
        }
        let distance = along - libm::sqrtf(half_chord_squared);
        (distance >= 0.0).then_some(distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const X: Point2 = Point2::new(1.0, 0.0);
    const ORIGIN: Point2 = Point2::new(0.0, 0.0);

    #[test]
    fn the_nearest_thing_is_hit() {
        let mut world = World::default();
        assert_eq!(world.cast(ORIGIN, X), None);
        world.wall(Point2::new(5.0, -1.0), Point2::new(5.0, 1.0));
        assert_eq!(world.cast(ORIGIN, X), Some(5.0));
        world.disc(Point2::new(3.0, 0.0), 0.5);
        assert_eq!(world.cast(ORIGIN, X), Some(2.5));
        world.clear();
        assert_eq!(world.cast(ORIGIN, X), None);
    }

    #[test]
    fn nothing_behind_or_beside_is_hit() {
        let mut world = World::default();
        world.wall(Point2::new(-5.0, -1.0), Point2::new(-5.0, 1.0));
        world.wall(Point2::new(5.0, 0.1), Point2::new(5.0, 1.0));
        world.wall(Point2::new(1.0, 0.5), Point2::new(2.0, 0.5));
        world.disc(Point2::new(-3.0, 0.0), 0.5);
        world.disc(Point2::new(3.0, 0.6), 0.5);
        assert_eq!(world.cast(ORIGIN, X), None);
    }

    #[test]
    fn clearance_is_the_distance_to_the_nearest_thing() {
        let mut world = World::default();
        assert_eq!(world.clearance(ORIGIN), f32::INFINITY);
        world.wall(Point2::new(1.0, 2.0), Point2::new(4.0, 2.0));
        assert_eq!(world.clearance(Point2::new(2.0, 0.0)), 2.0);
        assert_eq!(world.clearance(Point2::new(7.0, -2.0)), 5.0);
        world.wall(Point2::new(0.0, 1.0), Point2::new(0.0, 1.0));
        world.disc(Point2::new(3.0, 0.0), 0.5);
        assert_eq!([ORIGIN, Point2::new(2.0, 0.0), Point2::new(3.1, 0.0)].map(|p| world.clearance(p)), [1.0, 0.5, 0.0]);
    }

    #[test]
    fn near_objects_are_taken() {
        let mut world = World::default();
        world.wall(Point2::new(2.0, -9.0), Point2::new(2.0, 9.0));
        world.wall(Point2::new(9.0, -9.0), Point2::new(9.0, 9.0));
        world.disc(Point2::new(0.0, 3.5), 0.6);
        world.disc(Point2::new(0.0, -3.7), 0.6);
        let mut near = World::default();
        near.take_near(&world, ORIGIN, 3.0);
        assert_eq!((near.walls(), near.discs()), (&world.walls()[..1], &world.discs()[..1]));
    }

    #[test]
    fn a_block_is_hit_from_all_sides() {
        let mut world = World::default();
        let pose = Pose2::new(4.0, 0.0, 0.0);
        world.block(&pose, 2.0, 1.0);
        assert_eq!((world.walls().len(), world.discs().len()), (4, 0));
        for (from, direction, distance) in [
            (ORIGIN, X, 3.0),
            (Point2::new(10.0, 0.0), Point2::new(-1.0, 0.0), 5.0),
            (Point2::new(4.0, 3.0), Point2::new(0.0, -1.0), 2.5),
        ] {
            let hit = world.cast(from, direction).expect("a side");
            assert!((hit - distance).abs() < 1e-5, "{hit} for {distance}");
        }
    }
}
