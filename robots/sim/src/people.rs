use crate::{Disc, Footprint, Random};
use apex_nodes::{
    map::{Cell, Grid, Occupancy},
    math::normalize_angle,
    nav::{Path, Planner, Smoothing, Terrain},
    scan::{Point2, Pose2},
};
use core::f32::consts::PI;

/// Radius of a leg, in m.
const LEG: f32 = 0.065;
/// Distance of a leg from the middle of its person, across, in m.
const HIP: f32 = 0.11;
/// Distance that a leg swings to the front and to the back, in m, and length of a full step of both legs, in m.
const SWING: f32 = 0.22;
const STRIDE: f32 = 1.4;
/// Time in which a person comes to the wanted velocity, in s.
const RELAXATION: f32 = 0.5;
/// Strength (m/s²), range (m) and distance (m) of the force between persons, and of that from others.
const AMONG: [f32; 3] = [2.5, 0.25, 0.5];
const FROM_OTHERS: [f32; 3] = [4.0, 0.3, 0.3];
/// Part of a force that comes from behind.
const BEHIND: f32 = 0.3;
/// Distance of the point on the path that a person walks to, in m.
const AHEAD: f32 = 0.6;
/// Time without progress after which a person walks elsewhere, in s.
const STUCK: f32 = 3.0;
/// Distance up to which a person sees vehicles in its way, and distance that its path keeps from them, in m.
const SIGHT: f32 = 6.0;
const APART: f32 = 0.3;
/// Greatest angular velocity of a person who walks, and of one with a trolley, in rad/s.
const TURN: f32 = 5.0;
const TROLLEY_TURN: f32 = 1.5;
/// Distance of the middle of a trolley before the person who pushes it, and its length and width, in m.
const TROLLEY: [f32; 3] = [0.75, 0.8, 0.5];
/// Distance of the wheels of a trolley from its ends and sides, and their radius, in m.
const CASTOR: [f32; 2] = [0.06, 0.05];
/// Additional distance that the path of a person with a trolley keeps from vehicles, in m.
const TROLLEY_APART: f32 = 0.3;
/// Probability that a person goes to another one who stands.
const JOINS: f32 = 0.35;
/// Probability that a person stops on the way, per s.
const HESITATES: f32 = 0.02;
const SMOOTHING: Smoothing = Smoothing { spacing: 0.2, rounds: 10 };

/// Person who walks or stands.
#[derive(Debug, Clone)]
pub struct Pedestrian {
    /// Position of the middle, and direction of the body.
    pub pose: Pose2,
    /// Velocity, in m/s.
    pub velocity: Point2,
    /// Speed on a free way, in m/s.
    speed: f32,
    /// Phase of the steps, in rad.
    phase: f32,
    path: Path,
    /// Next point of the path.
    next: usize,
    /// Time that is left to stand, in s.
    rest: f32,
    /// Time since the last progress, in s.
    stuck: f32,
    has_trolley: bool,
}

/// People in a building, who walk to random places, stop on their way, turn, and stand together in groups.
///
/// They keep away from each other and from vehicles by the social force model (Helbing and Molnár 1995), which leads
/// them along planned paths. They do not walk through walls, and evade a vehicle, but do not always give way to it.
#[derive(Debug, Clone)]
pub struct Crowd {
    people: Vec<Pedestrian>,
    free: Grid<Occupancy>,
    /// Map for a path, with the vehicles that a person sees.
    seen: Grid<Occupancy>,
    places: Vec<Cell>,
    planner: Planner,
    random: Random,
}

impl Crowd {
    /// Places `count` people at random free cells of a map, such as that of [`Building::free_map`](crate::Building).
    /// A map without free cells has no people.
    pub fn new(free: Grid<Occupancy>, count: usize, seed: u64) -> Self {
        let places: Vec<Cell> =
            free.iter().filter(|(_, cell)| **cell == Occupancy::Free).map(|(cell, _)| cell).collect();
        let (seen, planner, random) = (Grid::default(), Planner::default(), Random::new(seed));
        let mut crowd = Self { people: vec![], free, seen, places, planner, random };
        if !crowd.places.is_empty() {
            crowd.people = (0..count).map(|_| crowd.appear()).collect();
        }
        crowd
    }

    /// Gives a trolley to the first `count` people, who then push it before them. Walls do not hold trolleys.
    #[must_use]
    pub fn with_trolleys(mut self, count: usize) -> Self {
        self.people.iter_mut().take(count).for_each(|person| person.has_trolley = true);
        self
    }

    /// All people.
    pub fn people(&self) -> &[Pedestrian] {
        &self.people
    }

    /// Moves all people for `dt` s. They keep away from `vehicles`.
    pub fn step(&mut self, dt: f32, vehicles: &[Footprint]) {
        for i in 0..self.people.len() {
            let wanted = self.wanted(i, dt, vehicles);
            let person = &self.people[i];
            let push = self.push(i, vehicles);
            let change = (wanted - person.velocity).scaled(1.0 / RELAXATION) + push;
            let velocity = limited(person.velocity + change.scaled(dt), 1.3 * person.speed);
            let position = self.reachable(person.pose.position(), velocity.scaled(dt));
            let person = &mut self.people[i];
            let way = position - person.pose.position();
            person.velocity = way.scaled(1.0 / dt);
            person.walk(position, way.norm(), dt);
            let slow = way.norm() < 0.2 * person.speed * dt && person.rest <= 0.0;
            person.stuck = if slow { person.stuck + dt } else { 0.0 };
        }
    }

    /// Moves a person out of the way of something that pushes it: by `way`, as far as walls allow.
    pub fn shove(&mut self, person: usize, way: Point2) {
        let Some(at) = self.people.get(person).map(|person| person.pose.position()) else { return };
        let to = self.reachable(at, way);
        (self.people[person].pose.x, self.people[person].pose.y) = (to.x, to.y);
    }

    fn appear(&mut self) -> Pedestrian {
        let at = self.place();
        let random = &mut self.random;
        Pedestrian {
            pose: Pose2::new(at.x, at.y, random.uniform(-PI, PI)),
            velocity: Point2::default(),
            speed: random.uniform(0.8, 1.5),
            phase: random.uniform(-PI, PI),
            path: Path::default(),
            next: 0,
            rest: random.uniform(0.0, 5.0),
            stuck: 0.0,
            has_trolley: false,
        }
    }

    /// Middle of a random free cell.
    fn place(&mut self) -> Point2 {
        let at = self.random.bits() % self.places.len() as u64;
        self.free.raster().centre(self.places[at as usize])
    }

    /// Velocity that a person would like to have. Decides where the person goes, and when it stands.
    fn wanted(&mut self, i: usize, dt: f32, vehicles: &[Footprint]) -> Point2 {
        let hesitates = self.random.chance(HESITATES * dt);
        let person = &mut self.people[i];
        if person.rest > 0.0 {
            person.rest -= dt;
            return Point2::default();
        }
        let here = person.pose.position();
        while person.path.points.get(person.next).is_some_and(|point| (*point - here).norm() < AHEAD) {
            person.next += 1;
        }
        let target = person.path.points.get(person.next).copied().filter(|_| person.stuck < STUCK);
        let Some(target) = target else {
            let arrived = person.next > 0 && person.stuck < STUCK;
            person.stuck = 0.0;
            if arrived {
                self.stop(i);
            } else {
                self.plan(i, vehicles);
            }
            return Point2::default();
        };
        if hesitates {
            self.stop(i);
        }
        let way = target - here;
        way.scaled(self.people[i].speed / way.norm().max(1e-3))
    }

    /// Stands for a while, and turns to a person nearby or elsewhere.
    fn stop(&mut self, i: usize) {
        let here = self.people[i].pose.position();
        let others = self.people.iter().enumerate().filter(|(k, _)| *k != i).map(|(_, p)| p.pose.position());
        let near = others
            .filter(|p| (*p - here).norm() < 1.5)
            .min_by(|a, b| (*a - here).norm().total_cmp(&(*b - here).norm()));
        let heading = near.map_or_else(|| self.random.uniform(-PI, PI), |p| (p - here).angle());
        let rest = self.random.uniform(2.0, 15.0);
        let person = &mut self.people[i];
        // A trolley does not turn on the spot.
        if !person.has_trolley {
            person.pose.theta = heading;
        }
        person.rest = rest;
        // At the end of its path, it gets a new one afterwards.
        if person.next >= person.path.points.len() {
            person.path.points.clear();
            person.next = 0;
        }
    }

    /// Plans a path to a person who stands, or to a random place, around the vehicles.
    fn plan(&mut self, i: usize, vehicles: &[Footprint]) {
        self.look(i, vehicles);
        let start = self.people[i].pose;
        let others: Vec<Point2> = self
            .people
            .iter()
            .enumerate()
            .filter(|(k, other)| *k != i && other.rest > 3.0)
            .map(|(_, other)| other.pose.position())
            .collect();
        let joins = self.random.chance(JOINS) && !others.is_empty();
        let goal = if joins {
            let other = others[(self.random.bits() % others.len() as u64) as usize];
            other + Point2::polar(0.9, self.random.uniform(-PI, PI))
        } else {
            self.place()
        };
        let terrain = Terrain { map: &self.seen, costs: None, unknown_is_open: false };
        let person = &mut self.people[i];
        person.next = 0;
        let goal = Pose2::new(goal.x, goal.y, 0.0);
        if self.planner.plan(&terrain, &start, &goal, SMOOTHING, &mut person.path).is_err() {
            person.rest = 1.0;
        }
    }

    /// Marks the vehicles that a person sees, but not the place where it is.
    fn look(&mut self, i: usize, vehicles: &[Footprint]) {
        let here = self.people[i].pose.position();
        let apart = if self.people[i].has_trolley { APART + TROLLEY_APART } else { APART };
        self.seen.clone_from(&self.free);
        for vehicle in vehicles.iter().filter(|vehicle| vehicle.distance(here) <= SIGHT) {
            let (middle, raster) = (vehicle.pose.position(), *self.seen.raster());
            let reach = 0.5 * libm::hypotf(vehicle.length, vehicle.width) + apart;
            let count = (reach / raster.resolution) as i32 + 1;
            for (x, y) in (-count..=count).flat_map(|x| (-count..=count).map(move |y| (x, y))) {
                let place = middle + Point2::new(x as f32, y as f32).scaled(raster.resolution);
                if vehicle.distance(place) < apart && (place - here).norm() > APART {
                    let cell = raster.cell(place).and_then(|cell| self.seen.get_mut(cell));
                    cell.into_iter().for_each(|cell| *cell = Occupancy::Occupied);
                }
            }
        }
    }

    /// Sum of the social forces on a person, in m/s².
    fn push(&self, i: usize, vehicles: &[Footprint]) -> Point2 {
        let person = &self.people[i];
        let here = person.pose.position();
        let others = self
            .people
            .iter()
            .enumerate()
            .filter(|(k, _)| *k != i)
            .map(|(_, other)| force(person, here - other.pose.position(), AMONG));
        let vehicles = vehicles.iter().map(|vehicle| {
            let from = here - vehicle.nearest(here);
            force(person, person.trolley().map_or(from, |trolley| limited(from, gap(&trolley, vehicle))), FROM_OTHERS)
        });
        others.chain(vehicles).fold(Point2::default(), |sum, one| sum + one)
    }

    /// Position after a step, which ends at walls but slides along them.
    fn reachable(&self, from: Point2, way: Point2) -> Point2 {
        let is_free = |point: Point2| self.free.at(point) == Some(&Occupancy::Free);
        let steps = [way, Point2::new(way.x, 0.0), Point2::new(0.0, way.y)];
        steps.into_iter().map(|step| from + step).find(|point| is_free(*point)).unwrap_or(from)
    }
}

impl Pedestrian {
    /// Cross-sections of the two legs at the height of a scanner.
    pub fn legs(&self) -> [Disc; 2] {
        let swing = SWING * libm::sinf(self.phase) * (self.velocity.norm() / 0.5).min(1.0);
        [(HIP, swing), (-HIP, -swing)].map(|(y, x)| Disc { centre: self.pose.to_outer(Point2::new(x, y)), radius: LEG })
    }

    /// Area of the trolley that the person pushes.
    pub fn trolley(&self) -> Option<Footprint> {
        let [ahead, length, width] = TROLLEY;
        let pose = self.pose.compose(&Pose2::new(ahead, 0.0, 0.0));
        self.has_trolley.then_some(Footprint { pose, length, width })
    }

    /// Cross-sections of the wheels of the trolley at the height of a scanner.
    pub fn trolley_wheels(&self) -> impl Iterator<Item = Disc> {
        let [inset, radius] = CASTOR;
        self.trolley().into_iter().flat_map(move |Footprint { pose, length, width }| {
            let (x, y) = (0.5 * length - inset, 0.5 * width - inset);
            let places = [(x, y), (x, -y), (-x, y), (-x, -y)];
            places.map(|(x, y)| Disc { centre: pose.to_outer(Point2::new(x, y)), radius })
        })
    }

    fn walk(&mut self, to: Point2, way: f32, dt: f32) {
        if self.velocity.norm() > 0.15 {
            let turn = normalize_angle(&(self.velocity.angle() - self.pose.theta));
            let most = dt * if self.has_trolley { TROLLEY_TURN } else { TURN };
            self.pose.theta = normalize_angle(&(self.pose.theta + turn.clamp(-most, most)));
        }
        (self.pose.x, self.pose.y) = (to.x, to.y);
        self.phase = normalize_angle(&(self.phase + 2.0 * PI * way / STRIDE));
    }
}

/// Social force on a person from something that is away by the negative of `from`.
fn force(person: &Pedestrian, from: Point2, [strength, range, near]: [f32; 3]) -> Point2 {
    let distance = from.norm();
    if !(1e-4..=3.0).contains(&distance) {
        return Point2::default();
    }
    let away = from.scaled(1.0 / distance);
    let speed = person.velocity.norm();
    // What is behind counts less.
    let ahead = if speed > 0.05 { -away.dot(person.velocity) / speed } else { 1.0 };
    let weight = BEHIND + (1.0 - BEHIND) * 0.5 * (1.0 + ahead);
    let push = strength * weight * libm::expf((near - distance) / range).min(4.0);
    // A little to the right, so that two who meet do not stop before each other.
    (away + away.perpendicular().scaled(0.3)).scaled(push)
}

/// Distance from a vehicle to a trolley, but never 0, in m.
fn gap(trolley: &Footprint, vehicle: &Footprint) -> f32 {
    let end = trolley.nearest(vehicle.nearest(trolley.pose.position()));
    vehicle.distance(end).max(0.01)
}

fn limited(vector: Point2, most: f32) -> Point2 {
    let length = vector.norm();
    if length > most { vector.scaled(most / length) } else { vector }
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_nodes::map::Raster;

    fn room() -> Grid<Occupancy> {
        let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 120, height: 60 };
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        for (i, cell) in map.cells_mut().iter_mut().enumerate() {
            if i % 120 == 0 || i % 120 == 119 || i / 120 == 0 || i / 120 == 59 || (i % 120 == 60 && i / 120 < 40) {
                *cell = Occupancy::Occupied;
            }
        }
        map
    }

    fn play(seed: u64, vehicles: &[Footprint]) -> Crowd {
        let mut crowd = Crowd::new(room(), 6, seed);
        for _ in 0..3000 {
            crowd.step(0.02, vehicles);
            for person in crowd.people() {
                assert_eq!(crowd.free.at(person.pose.position()), Some(&Occupancy::Free));
            }
        }
        crowd
    }

    #[test]
    fn people_walk_and_rest_and_stay_inside() {
        let (crowd, again, other) = (play(1, &[]), play(1, &[]), play(2, &[]));
        let poses = |crowd: &Crowd| crowd.people.iter().map(|p| p.pose).collect::<Vec<_>>();
        assert_eq!(poses(&crowd), poses(&again));
        assert_ne!(poses(&crowd), poses(&other));
    }

    #[test]
    fn people_keep_away_from_each_other_and_from_a_vehicle() {
        let vehicle = Footprint { pose: Pose2::new(3.0, 3.0, 0.0), length: 1.0, width: 0.5 };
        let mut crowd = Crowd::new(room(), 6, 3);
        let (mut moved, mut contacts) = (0.0_f32, 0);
        for step in 0..6000 {
            crowd.step(0.02, &[vehicle]);
            moved = crowd.people().iter().map(|p| p.velocity.norm()).fold(moved, f32::max);
            for (i, a) in crowd.people().iter().enumerate() {
                let near =
                    crowd.people()[i + 1..].iter().any(|b| (a.pose.position() - b.pose.position()).norm() < 0.25);
                let at_vehicle = (a.pose.position() - vehicle.nearest(a.pose.position())).norm() < 0.05;
                contacts += usize::from(step > 500 && (near || at_vehicle));
            }
        }
        assert!(moved > 0.7 && contacts < 100, "{moved} m/s, {contacts}");
    }

    /// A vehicle stands in the gap between both halves of the room, which is as wide as it and 0.9 m more.
    #[test]
    fn people_walk_around_a_vehicle_that_stands_in_their_way() {
        let vehicle = Footprint { pose: Pose2::new(6.0, 4.55, 0.0), length: 1.2, width: 0.9 };
        let mut crowd = Crowd::new(room(), 6, 3);
        let (mut passages, mut sides) = (0, [false; 6]);
        for _ in 0..9000 {
            crowd.step(0.02, &[vehicle]);
            for (side, person) in sides.iter_mut().zip(crowd.people()) {
                let is_right = person.pose.x > 6.0;
                passages += usize::from(*side != is_right);
                *side = is_right;
            }
        }
        assert!(passages > 20, "{passages}");
    }

    #[test]
    fn a_trolley_is_before_the_person_who_pushes_it() {
        let mut crowd = Crowd::new(room(), 6, 3).with_trolleys(2);
        for _ in 0..1500 {
            crowd.step(0.02, &[]);
        }
        let trolleys: Vec<_> = crowd.people().iter().filter_map(|person| Some((person, person.trolley()?))).collect();
        assert_eq!(trolleys.len(), 2);
        for (person, trolley) in trolleys {
            let middle = person.pose.to_inner(trolley.pose.position());
            assert!((middle.x - TROLLEY[0]).abs() < 1e-4 && middle.y.abs() < 1e-4, "{middle:?}");
            let wheels: Vec<Disc> = person.trolley_wheels().collect();
            assert_eq!(wheels.len(), 4);
            assert!(wheels.iter().all(|wheel| trolley.distance(wheel.centre) <= 0.0));
        }
        assert_eq!(crowd.people()[5].trolley_wheels().count(), 0);
    }

    /// The people who push a trolley differ from others in their ways only.
    #[test]
    fn trolleys_change_nothing_at_the_beginning() {
        let poses = |crowd: Crowd| crowd.people().iter().map(|person| person.pose).collect::<Vec<_>>();
        assert_eq!(poses(Crowd::new(room(), 6, 3)), poses(Crowd::new(room(), 6, 3).with_trolleys(9)));
    }

    /// The vehicle stands in the gap, as above: the trolleys rarely touch it.
    #[test]
    fn a_trolley_keeps_away_from_a_vehicle() {
        let vehicle = Footprint { pose: Pose2::new(6.0, 4.55, 0.0), length: 1.2, width: 0.5 };
        let mut crowd = Crowd::new(room(), 6, 3).with_trolleys(6);
        let mut touches = 0;
        for _ in 0..9000 {
            crowd.step(0.02, &[vehicle]);
            let wheels = crowd.people().iter().flat_map(Pedestrian::trolley_wheels);
            touches += wheels.filter(|wheel| vehicle.distance(wheel.centre) <= wheel.radius).count();
        }
        assert!(touches < 9000 / 50, "{touches}");
    }

    #[test]
    fn legs_are_apart_and_swing() {
        let mut crowd = Crowd::new(room(), 1, 4);
        let mut widest = 0.0_f32;
        for _ in 0..1500 {
            crowd.step(0.02, &[]);
            let [a, b] = crowd.people()[0].legs();
            widest = widest.max((a.centre - b.centre).norm());
            assert!((a.centre - b.centre).norm() >= 2.0 * HIP - 1e-4);
        }
        assert!(widest > 0.4, "{widest}");
        assert!(Crowd::new(Grid::default(), 5, 1).people().is_empty());
    }
}
