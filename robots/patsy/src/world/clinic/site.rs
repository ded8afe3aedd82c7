use crate::{
    LENGTH, PLAN, WIDTH,
    world::{Cart, Thing},
};
use apex_nodes::{
    io::ReadError,
    scan::{Point2, Pose2},
};
use apex_sim::{Building, Footprint, Random, World, tof::Pit};
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
/// Part of the corridors with small things, and their distance from places for containers, in m.
const THINGS_IN: [f32; 2] = [6.0, 55.0];
const FREE: f32 = 2.3;
/// Distance between places, in m.
const APART: f32 = 5.0;
/// Ways without furniture: x and y from and to, in m. The corridors but for what stands at their walls, the crossings,
/// and the way from the dock through the hall.
const WAYS: [[[f32; 2]; 2]; 5] = [
    [[0.0, 60.0], [7.5, 9.4]],
    [[0.0, 60.0], [20.8, 22.7]],
    [[20.2, 22.0], [7.0, 23.0]],
    [[44.2, 46.4], [7.0, 23.0]],
    [[0.4, 3.4], [7.5, 20.6]],
];
/// Walls of the two corridors: y from and to, in m.
const CORRIDORS: [[f32; 2]; 2] = [[7.2, 9.6], [20.6, 23.0]];
/// Places where other ways meet the corridors, with room to turn: x from and to, in m.
const MOUTHS: [[f32; 2]; 3] = [[0.0, 8.5], [18.5, 23.7], [42.5, 48.1]];
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
        let mut building = Building::office(PLAN)?;
        furnish(&mut building, random);
        let places = places(&building.world, random);
        let carts = places.iter().take(CARTS).map(|place| cart(place, random)).collect();
        let things = things(&places, random);
        Ok(Self { building, places, carts, things })
    }
}

/// Tries to place furniture at the walls of the corridors, with free way beside it: not beside a place for containers,
/// a door, a crossing, or other furniture there.
pub(super) fn furnish_corridors(site: &mut Site, count: usize, random: &mut Random) {
    let mut placed: Vec<Point2> = vec![];
    for _ in 0..count {
        let piece = (0..100).map(|_| piece(random)).find(|piece| {
            let at = piece.pose.position();
            let is_far = |other: Point2| (other.x - at.x).abs() > FREE || (other.y - at.y).abs() > FREE;
            site.places.iter().all(|place| is_far(place.position()))
                && placed.iter().all(|other| is_far(*other))
                && MOUTHS.iter().all(|[from, to]| !(*from..*to).contains(&at.x))
                && has_wall_behind(&site.building.world, piece)
        });
        if let Some(Footprint { pose, length, width }) = piece {
            site.building.world.block(&pose, length, width);
            placed.push(pose.position());
        }
    }
}

/// Piece of furniture at a wall of a corridor, which is on its left.
fn piece(random: &mut Random) -> Footprint {
    let [y, side] = [random.bits() % 2, random.bits() % 2].map(|bit| bit as usize);
    let (length, width) = (random.uniform(0.4, 1.0), random.uniform(0.3, 0.5));
    let (x, gap) = (random.uniform(THINGS_IN[0], THINGS_IN[1]), random.uniform(0.02, 0.12));
    let theta = random.uniform(-0.08, 0.08);
    let inward = if side == 0 { 1.0 } else { -1.0 };
    let y = CORRIDORS[y][side] + inward * (gap + 0.5 * width);
    Footprint { pose: Pose2::new(x, y, theta + if side == 0 { PI } else { 0.0 }), length, width }
}

/// Returns `true` if there is no door behind a piece of furniture, which is left of it.
fn has_wall_behind(world: &World, piece: &Footprint) -> bool {
    [-0.5, 0.0, 0.5].into_iter().all(|part| {
        let back = piece.pose.to_outer(Point2::new(part * (piece.length + 0.4), 0.0));
        let left = Point2::polar(1.0, piece.pose.theta + 0.5 * PI);
        world.cast(back, left).is_some_and(|distance| distance < 0.5 * piece.width + 0.3)
    })
}

/// Container at a place, a little off, with castors at the angles at which it was left.
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

/// Small things on the floor of the corridors, away from the places, where they would be in the way of all.
fn things(places: &[Pose2], random: &mut Random) -> Vec<(Thing, Pose2)> {
    let kinds = [Thing::Glass, Thing::Hammer, Thing::Cable, Thing::Roll, Thing::Screwdriver, Thing::Wood];
    let mut at = |i: usize| {
        let (x, y) = (random.uniform(THINGS_IN[0], THINGS_IN[1]), MIDDLES[i % 2] + random.uniform(-0.7, 0.7));
        Pose2::new(x, y, random.uniform(-PI, PI))
    };
    let is_free = |at: &Pose2| places.iter().all(|place| (place.position() - at.position()).norm() > FREE);
    (0..THINGS)
        .filter_map(|i| {
            let place = (0..100).map(|_| at(i)).find(is_free)?;
            Some((kinds[i % kinds.len()], place))
        })
        .collect()
}

/// Tries to place furniture, none of it on the ways that have to be free: a bed has to get through.
fn furnish(building: &mut Building, random: &mut Random) {
    for _ in 0..FURNITURE {
        let mut more = building.clone();
        more.furnish(1, random);
        let (walls, discs) = (building.world.walls().len(), building.world.discs().len());
        let ends = more.world.walls()[walls..].iter().flat_map(|wall| [wall.a, wall.b, (wall.a + wall.b).scaled(0.5)]);
        let mut points = ends.chain(more.world.discs()[discs..].iter().map(|disc| disc.centre));
        if points.all(|point| WAYS.iter().all(|way| !is_on(way, point))) {
            *building = more;
        }
    }
}

fn is_on(way: &[[f32; 2]; 2], point: Point2) -> bool {
    let [x, y] = way;
    x[0] < point.x && point.x < x[1] && y[0] < point.y && point.y < y[1]
}

/// Area of the body of a container.
pub(super) fn area(cart: &Cart) -> Footprint {
    Footprint { pose: cart.pose(), length: LENGTH, width: WIDTH }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_sim::stream;

    #[test]
    fn furniture_in_corridors_leaves_a_way() {
        let mut count = 0;
        for seed in 1..=10 {
            let mut site = Site::new(&mut stream(seed, 0)).expect("a plan");
            let before = site.building.world.walls().len();
            furnish_corridors(&mut site, 12, &mut stream(seed, 4));
            let added = &site.building.world.walls()[before..];
            count += added.len() / 4;
            for wall in added {
                let [low, high] = if wall.a.y < 15.0 { CORRIDORS[0] } else { CORRIDORS[1] };
                assert!(wall.a.y - low < 0.8 || high - wall.a.y < 0.8, "{wall:?}");
                assert!(site.places.iter().all(|place| (place.position() - wall.a).norm() > 1.2), "{wall:?}");
            }
        }
        assert!(count >= 50, "{count} pieces");
    }
}
