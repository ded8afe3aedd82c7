use super::signs;
use apex_nodes::scan::{Point2, Pose2};
use apex_sim::{Look, Panel, Picture, Pillar, Random, Scene, World};
use std::f32::consts::{PI, TAU};

/// Height of all walls, in m.
pub const WALL_HEIGHT: f32 = 0.5;

/// Height of the middle of a target, below the ring, in m.
pub const TARGET_HEIGHT: f32 = 0.32;

/// Height of the middle of a number sign, in m.
pub const NUMBER_HEIGHT: f32 = 0.72;

/// Length of a side of the island, in m.
pub const ISLAND_SIDE: f32 = 1.2;

const RADIUS: f32 = 6.0;
const RING_HEIGHT: f32 = 0.5;
const RING_RADIUS: f32 = 0.15;

/// Arena of the competition (thesis 4.2): a border with four delivery stations around an octagonal island with four
/// filling stations. Its origin is the middle of the island.
#[derive(Debug, Clone)]
pub struct Arena {
    /// World of the laser scanners.
    pub world: World,
    /// Scene of the cameras.
    pub scene: Scene,
    /// Corners of the border, counter-clockwise, in m.
    pub border: Vec<Point2>,
    /// Filling stations, where cubes are handed out.
    pub filling: [Station; 4],
    /// Delivery stations, where cubes are taken; station 1 comes first.
    pub delivery: [Station; 4],
}

/// Filling or delivery station.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Station {
    /// Pose of the foot of the target on the wall; x points out of the wall.
    pub pose: Pose2,
    /// Number of the sign, 1 to 4, or `None` for a filling station, which has no sign.
    pub number: Option<u32>,
}

impl Arena {
    /// Creates the arena of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let border = border(&mut random);
        let island = island(random.uniform(0.0, TAU));
        let mut world = World::default();
        world.polygon(&border);
        world.polygon(&island);
        let mut scene = Scene::new(random.uniform(60.0, 110.0) as u8, random.uniform(50.0, 120.0) as u8);
        surroundings(&mut scene, &mut random);
        let wall = random.uniform(160.0, 210.0) as u8;
        [&border[..], &island].into_iter().for_each(|corners| walls(&mut scene, corners, wall));
        let filling = [0, 2, 4, 6].map(|side| Station { pose: on_side(&island, side, 0.5, 1.0), number: None });
        let delivery = delivery(&border, &mut random);
        filling.iter().chain(&delivery).for_each(|station| station.furnish(&mut scene));
        Self { world, scene, border, filling, delivery }
    }

    /// All stations, the filling stations first.
    pub fn stations(&self) -> impl Iterator<Item = &Station> {
        self.filling.iter().chain(&self.delivery)
    }

    /// Returns `true` if a robot of this radius fits at a place.
    pub fn is_free(&self, place: Point2, radius: f32) -> bool {
        let sides = self.border.iter().zip(self.border.iter().cycle().skip(1));
        let inside = sides.fold(true, |inside, (a, b)| inside && (*b - *a).perpendicular().dot(place - *a) > 0.0);
        let far = |wall: &apex_sim::Wall| distance(place, wall.a, wall.b) >= radius;
        let island = 0.5 * ISLAND_SIDE / (PI / 8.0).tan();
        inside && place.norm() > island && self.world.walls().iter().all(far)
    }

    /// Returns `true` if no wall is between two places.
    pub fn is_clear(&self, from: Point2, to: Point2) -> bool {
        let length = (to - from).norm();
        let hit = self.world.cast(from, (to - from).scaled(1.0 / length));
        hit.is_none_or(|hit| hit > length - 0.02)
    }
}

impl Station {
    /// Adds the equipment of the station: a target, a ring over it, and a sign if it has a number.
    fn furnish(&self, scene: &mut Scene) {
        let before = |x: f32, y: f32| self.pose.to_outer(Point2::new(x, y));
        let ahead = Pose2 { x: before(0.01, 0.0).x, y: before(0.01, 0.0).y, ..self.pose };
        scene.sign(&ahead, TARGET_HEIGHT, signs::TARGET_WIDTH, signs::TARGET.clone());
        if let Some(number) = self.number {
            let picture = signs::SIGNS[number as usize - 1].clone();
            scene.sign(&ahead, NUMBER_HEIGHT, signs::NUMBER_WIDTH, picture);
        }
        // From the side, a ring looks like a bar.
        let (a, b) = (before(RING_RADIUS, -RING_RADIUS), before(RING_RADIUS, RING_RADIUS));
        let (bottom, top) = (RING_HEIGHT - 0.01, RING_HEIGHT + 0.01);
        scene.panel(Panel { a, b, bottom, top, look: Look::Plain(130) });
    }
}

/// 16 to 24 corners, almost on a circle.
fn border(random: &mut Random) -> Vec<Point2> {
    let count = 16 + random.bits() % 9;
    let turn = random.uniform(0.0, TAU);
    let corner = |i| Point2::polar(RADIUS + random.uniform(-0.1, 0.1), turn + TAU * i as f32 / count as f32);
    (0..count).map(corner).collect()
}

fn island(turn: f32) -> [Point2; 8] {
    let radius = 0.5 * ISLAND_SIDE / (PI / 8.0).sin();
    std::array::from_fn(|i| Point2::polar(radius, turn + TAU * i as f32 / 8.0))
}

/// One station in each quarter of the border, numbered in random order.
fn delivery(border: &[Point2], random: &mut Random) -> [Station; 4] {
    let start = random.bits() as usize;
    let mut stations: [Pose2; 4] = std::array::from_fn(|quarter| {
        let side = start % border.len() + quarter * border.len() / 4 + random.bits() as usize % 3;
        on_side(border, side, random.uniform(0.35, 0.65), -1.0)
    });
    for i in (1..stations.len()).rev() {
        stations.swap(i, random.bits() as usize % (i + 1));
    }
    std::array::from_fn(|i| Station { pose: stations[i], number: Some(i as u32 + 1) })
}

/// Pose on a side of a polygon, at the fraction `part` of its length from its first corner. It faces away from the
/// origin (`sense` 1) or towards it (-1).
fn on_side(corners: &[Point2], side: usize, part: f32, sense: f32) -> Pose2 {
    let (a, b) = (corners[side % corners.len()], corners[(side + 1) % corners.len()]);
    let place = a + (b - a).scaled(part);
    let normal = (b - a).perpendicular().scaled(-sense);
    Pose2::new(place.x, place.y, normal.angle())
}

fn walls(scene: &mut Scene, corners: &[Point2], brightness: u8) {
    for (a, b) in corners.iter().zip(corners.iter().cycle().skip(1)) {
        scene.panel(Panel { a: *a, b: *b, bottom: 0.0, top: WALL_HEIGHT, look: Look::Plain(brightness) });
    }
}

/// Adds the surroundings of the arena: people and posts, boards, and posters with stripes.
fn surroundings(scene: &mut Scene, random: &mut Random) {
    for _ in 0..20 {
        let place = Point2::polar(random.uniform(7.0, 10.0), random.uniform(0.0, TAU));
        let look = Look::Plain(random.uniform(20.0, 230.0) as u8);
        if random.chance(0.6) {
            let (radius, top) = (random.uniform(0.04, 0.3), random.uniform(0.9, 2.0));
            scene.pillar(Pillar { centre: place, radius, top, look });
            continue;
        }
        let pose = Pose2::new(place.x, place.y, place.angle() + PI + random.normal(0.3));
        let look = if random.chance(0.5) { Look::Picture(poster(random)) } else { look };
        let [a, b] = [-0.5, 0.5].map(|y| pose.to_outer(Point2::new(0.0, y)));
        scene.panel(Panel { a, b, bottom: random.uniform(0.3, 0.7), top: random.uniform(0.9, 1.8), look });
    }
}

/// A poster with horizontal and vertical bars.
fn poster(random: &mut Random) -> Picture {
    let mut bars =
        || -> Vec<[f32; 2]> { (0..3).map(|_| [random.uniform(0.0, 90.0), random.uniform(3.0, 20.0)]).collect() };
    let (across, down) = (bars(), bars());
    let on = |bars: &[[f32; 2]], x: u32| bars.iter().any(|[at, width]| (*at..at + width).contains(&(x as f32)));
    let shade = |x, y| image::Luma([if on(&across, x) || on(&down, y) { 40 } else { 210 }]);
    Picture::new(image::ImageBuffer::from_fn(100, 100, shade).into())
}

/// Distance of a place from the wall between two points, in m.
fn distance(place: Point2, a: Point2, b: Point2) -> f32 {
    (place - nearest(place, a, b)).norm()
}

/// Point of the wall between two points that is nearest to a place.
pub(crate) fn nearest(place: Point2, a: Point2, b: Point2) -> Point2 {
    let along = b - a;
    let part = ((place - a).dot(along) / along.norm_squared()).clamp(0.0, 1.0);
    a + along.scaled(part)
}
