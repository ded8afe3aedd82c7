use apex_nodes::scan::{Point2, Pose2};
use apex_sim::{Random, World};
use core::f32::consts::PI;

/// Minimum distance of objects from the path of the cart's centre, in m: half the diagonal of the cart, and the size of
/// the objects.
const CLEAR_OF_CART: f32 = 1.4;
/// Minimum distance of objects from the scanner, in m.
const CLEAR_OF_SCANNER: f32 = 0.9;

/// Function that adds an object at a pose.
type Add = fn(&mut World, Pose2, &mut Random);

/// Adds a room with furniture and people to the world. The path `way` of the cart stays free.
pub(crate) fn furnish(world: &mut World, way: &[Point2], random: &mut Random) {
    let centre = Pose2::new(random.uniform(1.5, 2.5), random.uniform(-0.5, 0.5), random.uniform(-0.2, 0.2));
    world.block(&centre, random.uniform(9.0, 11.0), random.uniform(7.0, 9.0));
    let things: [(u64, Add); 4] = [(2, table), (3, chair), (3, person), (4, chest)];
    for (most, add) in things {
        for _ in 0..random.bits() % (most + 1) {
            if let Some(place) = free_place(way, random) {
                add(world, place, random);
            }
        }
    }
}

/// A free pose in the room, or `None` if several tries did not find one.
fn free_place(way: &[Point2], random: &mut Random) -> Option<Pose2> {
    (0..20).find_map(|_| {
        let place = Pose2::new(random.uniform(-1.5, 6.0), random.uniform(-3.2, 3.2), random.uniform(-PI, PI));
        let free = way.iter().all(|p| (*p - place.position()).norm() > CLEAR_OF_CART);
        (free && place.position().norm() > CLEAR_OF_SCANNER).then_some(place)
    })
}

/// Table: four round legs, 1.6 m × 0.8 m apart.
fn table(world: &mut World, place: Pose2, random: &mut Random) {
    let radius = random.uniform(0.015, 0.03);
    legs(world, place, Point2::new(0.8, 0.4), radius);
}

/// Chair: four round legs, 42 cm apart.
fn chair(world: &mut World, place: Pose2, _random: &mut Random) {
    legs(world, place, Point2::new(0.21, 0.21), 0.0125);
}

fn legs(world: &mut World, place: Pose2, half: Point2, radius: f32) {
    for (x, y) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
        world.disc(place.to_outer(Point2::new(x * half.x, y * half.y)), radius);
    }
}

/// Person: two ankles, a step apart.
fn person(world: &mut World, place: Pose2, random: &mut Random) {
    let step = random.uniform(-0.2, 0.2);
    for side in [-1.0, 1.0] {
        world.disc(
            place.to_outer(Point2::new(side * step, side * random.uniform(0.08, 0.14))),
            random.uniform(0.04, 0.06),
        );
    }
}

/// Box with a size between a bin and a cupboard.
fn chest(world: &mut World, place: Pose2, random: &mut Random) {
    world.block(&place, random.uniform(0.15, 1.0), random.uniform(0.15, 0.6));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_of_the_cart_stays_free() {
        let way = [Point2::new(1.5, 0.0), Point2::new(4.0, 0.5)];
        let mut random = Random::new(3);
        for _ in 0..50 {
            let mut world = World::default();
            furnish(&mut world, &way, &mut random);
            for disc in world.discs() {
                assert!(way.iter().all(|p| (*p - disc.centre).norm() > 0.45), "{disc:?}");
            }
            assert!(world.walls().len() >= 4);
        }
    }
}
