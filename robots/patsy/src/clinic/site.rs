use crate::{Cart, LENGTH, WIDTH, obstacles::Thing};
use apex_nodes::{
    io::ReadError,
    scan::{Point2, Pose2},
};
use apex_sim::{BUILDING, Building, Footprint, Random, World, tof::Pit};
use core::f32::consts::PI;

/// Place where the vehicle begins, on the plan.
pub const DOCK: Pose2 = Pose2::new(2.0, 18.6, -0.5 * PI);
/// Number of people.
pub const PEOPLE: usize = 8;
/// Stairwell in the hall, which is not on the plan and has no rail.
pub const STAIRWELL: Pit = Pit { x: [5.4, 6.9], y: [13.4, 16.4], depth: 1.4 };

/// Number of containers.
const CARTS: usize = 6;
/// Number of small things on the floor of the corridors.
const THINGS: usize = 6;
/// Number of pieces of furniture that are tried to be placed.
const FURNITURE: usize = 40;
/// Middle lines of the places for containers in the two corridors, along the right wall: y and direction of travel.
const LANES: [(f32, f32); 2] = [(7.95, 0.0), (22.25, PI)];
/// Middles of the corridors, and the ends of their parts with places, in m.
const MIDDLES: [f32; 2] = [8.4, 21.8];
const ENDS: [f32; 2] = [10.0, 41.0];
/// Distance between places, in m.
const APART: f32 = 5.0;
/// Radius of the area at the beginning without furniture, in m.
const CLEAR: f32 = 2.0;
/// Free strip that a place needs: before and behind it for the vehicle, in m.
const STRIP: [f32; 2] = [7.0, 0.9];

/// Building with all that stands and lies in it at the beginning.
#[derive(Debug, Clone)]
pub(super) struct Site {
    pub building: Building,
    /// Places for containers.
    pub places: Vec<Pose2>,
    pub carts: Vec<Cart>,
    /// Small things that lie on the floor.
    pub things: Vec<(Thing, Pose2)>,
}

impl Site {
    pub fn new(random: &mut Random) -> Result<Self, ReadError> {
        let mut building = Building::read(BUILDING)?;
        let walls = building.world.walls().len();
        building.furnish(FURNITURE, random);
        clear(&mut building.world, walls, &DOCK);
        let places = places(&building.world, random);
        let carts = places.iter().take(CARTS).map(|place| cart(place, random)).collect();
        let things = things(random);
        Ok(Self { building, places, carts, things })
    }
}

/// Container at a place, a little off, with castors as somebody has left them.
fn cart(place: &Pose2, random: &mut Random) -> Cart {
    let off = Pose2::new(random.uniform(-0.15, 0.15), random.uniform(-0.05, 0.05), random.uniform(-0.04, 0.04));
    let pose = place.compose(&off);
    let back = if random.chance(0.5) { 0.0 } else { PI };
    Cart::new(pose, [0; 4].map(|_| pose.theta + back + random.uniform(-0.4, 0.4)))
}

/// Places for containers in random order, with free space before and behind them.
fn places(world: &World, random: &mut Random) -> Vec<Pose2> {
    let candidates = LANES.iter().flat_map(|&(y, theta)| {
        let count = ((ENDS[1] - ENDS[0]) / 0.5) as usize;
        (0..=count).map(move |i| Pose2::new(ENDS[0] + 0.5 * i as f32, y, theta))
    });
    let mut left: Vec<Pose2> = candidates
        .filter(|pose| Footprint { pose: *pose, length: STRIP[0], width: STRIP[1] }.clearance(world) > 0.0)
        .collect();
    let mut places = vec![];
    while !left.is_empty() {
        let place = left.swap_remove((random.bits() % left.len() as u64) as usize);
        left.retain(|other| (other.position() - place.position()).norm() >= APART);
        places.push(place);
    }
    places
}

fn things(random: &mut Random) -> Vec<(Thing, Pose2)> {
    let kinds = [Thing::Glass, Thing::Hammer, Thing::Cable, Thing::Roll, Thing::Screwdriver, Thing::Wood];
    (0..THINGS)
        .map(|i| {
            let (x, y) = (random.uniform(ENDS[0], ENDS[1]), MIDDLES[i % 2] + random.uniform(-0.7, 0.7));
            (kinds[i % kinds.len()], Pose2::new(x, y, random.uniform(-PI, PI)))
        })
        .collect()
}

/// Removes the furniture near a pose and ahead of it: all but the first `walls` walls.
fn clear(world: &mut World, walls: usize, pose: &Pose2) {
    let middle = pose.to_outer(Point2::new(1.0, 0.0));
    let old = std::mem::take(world);
    let is_away = |distance: f32| distance > CLEAR;
    for (number, wall) in old.walls().iter().enumerate() {
        if number < walls || is_away(wall.distance(middle)) {
            world.wall(wall.a, wall.b);
        }
    }
    for disc in old.discs().iter().filter(|disc| is_away((disc.centre - middle).norm())) {
        world.disc(disc.centre, disc.radius);
    }
}

/// Area of the body of a container.
pub(super) fn area(cart: &Cart) -> Footprint {
    Footprint { pose: cart.pose(), length: LENGTH, width: WIDTH }
}
