use apex_nodes::scan::{Point2, Pose2};
use apex_sim::{ColorScene, Disc, Paint, Post, Random, World};
use std::f32::consts::{PI, TAU};

/// Half of the length and of the width of a field, in m: the least and the most.
const HALF: [[f32; 2]; 2] = [[9.0, 12.0], [8.0, 10.0]];
/// Number of rocks and ridges.
const ROCKS: usize = 22;
const RIDGES: usize = 4;
/// Radius of a rock, in m: the least and the most.
const ROCK: [f32; 2] = [0.15, 0.7];
/// Gap between things, in m, through which the robot fits, and that around the station.
const GAP: f32 = 1.1;
const YARD: f32 = 1.8;
/// Distance of the station's wall behind the robot that stands there, in m.
const BEHIND: f32 = 0.5;
/// Number of cups, of batteries, and of flat stones in the colours of both.
const OBJECTS: usize = 2;
const STONES: usize = 2;
/// Radius of a flat stone, in m.
const STONE: f32 = 0.14;
/// Look of rocks and walls.
const ROCKY: Paint = Paint { color: [112, 92, 82], height: 0.7 };
const GROUND: [u8; 3] = [176, 128, 96];
const SKY: [u8; 3] = [214, 178, 150];
/// Number of places that are tried for a thing.
const TRIES: usize = 40;

/// Kind of an object that is to be found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Blue cup.
    Cup,
    /// Yellow battery.
    Battery,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Self; 2] = [Self::Cup, Self::Battery];

    /// Radius, in m.
    const fn radius(self) -> f32 {
        match self {
            Self::Cup => 0.07,
            Self::Battery => 0.06,
        }
    }

    const fn paint(self) -> Paint {
        match self {
            Self::Cup => Paint { color: [30, 90, 210], height: 0.16 },
            Self::Battery => Paint { color: [225, 200, 30], height: 0.25 },
        }
    }
}

/// Object that is to be found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Object {
    /// Kind.
    pub kind: Kind,
    /// Place.
    pub place: Point2,
}

/// Walled field with rocks, ridges, a base station and objects.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Everything that stands on it.
    pub world: World,
    /// Everything as a camera sees it.
    pub scene: ColorScene,
    /// Objects that are to be found.
    pub objects: Vec<Object>,
    /// Pose of a robot at the base station.
    pub station: Pose2,
    /// Half of the length along x and of the width along y, in m. The origin is in the middle.
    pub half: Point2,
}

impl Field {
    /// Makes a field.
    pub fn new(random: &mut Random) -> Self {
        let [x, y] = HALF.map(|[least, most]| random.uniform(least, most));
        let half = Point2::new(x, y);
        let mut world = World::default();
        world.block(&Pose2::default(), 2.0 * x, 2.0 * y);
        let place = Point2::new(random.uniform(-0.7 * x, 0.7 * x), random.uniform(-0.7 * y, 0.7 * y));
        let station = Pose2::new(place.x, place.y, random.uniform(-PI, PI));
        let behind = station.compose(&Pose2::new(-BEHIND, 0.0, 0.0));
        world.block(&behind, 0.1, 0.8);
        let scene = ColorScene { ground: GROUND, sky: SKY, ..ColorScene::default() };
        let mut field = Self { world, scene, objects: vec![], station, half };
        (0..RIDGES).for_each(|_| field.add_ridge(random));
        (0..ROCKS).for_each(|_| field.add_rock(random));
        field.scene.walls = field.world.walls().iter().map(|wall| (*wall, ROCKY)).collect();
        for kind in Kind::ALL {
            (0..OBJECTS).for_each(|_| field.add_object(kind, random));
            let stone = Paint { height: 0.07, ..kind.paint() };
            for _ in 0..STONES {
                field.add_post(STONE, stone, random);
            }
        }
        field
    }

    fn add_object(&mut self, kind: Kind, random: &mut Random) {
        if let Some(place) = self.add_post(kind.radius(), kind.paint(), random) {
            self.objects.push(Object { kind, place });
        }
    }

    /// Adds something round where there is room, and returns its place.
    fn add_post(&mut self, radius: f32, paint: Paint, random: &mut Random) -> Option<Point2> {
        let place = (0..TRIES).map(|_| self.place(random)).find(|place| self.has_room(*place, radius))?;
        self.world.disc(place, radius);
        self.scene.posts.push(Post { disc: Disc { centre: place, radius }, paint });
        Some(place)
    }

    /// Low and high corner.
    pub fn bounds(&self) -> [Point2; 2] {
        [self.half.scaled(-1.0), self.half]
    }

    fn place(&self, random: &mut Random) -> Point2 {
        Point2::new(random.uniform(-self.half.x, self.half.x), random.uniform(-self.half.y, self.half.y))
    }

    /// Returns `true` if a disc here leaves gaps through which the robot fits.
    fn has_room(&self, place: Point2, radius: f32) -> bool {
        let far = (place - self.station.position()).norm() - radius >= YARD;
        far && self.world.clearance(place) - radius >= GAP
    }

    fn add_rock(&mut self, random: &mut Random) {
        let paint = Paint { height: random.uniform(0.3, 1.0), ..ROCKY };
        self.add_post(random.uniform(ROCK[0], ROCK[1]), paint, random);
    }

    fn add_ridge(&mut self, random: &mut Random) {
        let length = random.uniform(2.0, 4.5);
        for _ in 0..TRIES {
            let (place, heading) = (self.place(random), random.uniform(0.0, TAU));
            let along = Point2::polar(0.5 * length, heading);
            let has_room = [-1.0, -0.5, 0.0, 0.5, 1.0].iter().all(|at| self.has_room(place + along.scaled(*at), 0.2));
            if has_room {
                return self.world.block(&Pose2::new(place.x, place.y, heading), length, 0.3);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_robot_has_room_at_the_station_and_between_rocks() {
        for seed in 0..50 {
            let field = Field::new(&mut Random::new(seed));
            assert!(field.world.clearance(field.station.position()) >= 0.4, "seed {seed}");
            let rocks = field.world.discs();
            assert!(rocks.len() > ROCKS / 2, "seed {seed}: {}", rocks.len());
            assert_eq!(field.objects.len(), OBJECTS * Kind::ALL.len(), "seed {seed}");
            for (i, a) in rocks.iter().enumerate() {
                let gaps = rocks[..i].iter().map(|b| (a.centre - b.centre).norm() - a.radius - b.radius);
                assert!(gaps.fold(f32::MAX, f32::min) >= GAP - 1e-3, "seed {seed}");
            }
        }
    }
}
