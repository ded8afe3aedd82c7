use super::{Terrain, Track};
use crate::Random;
use apex_nodes::scan::Point2;
use core::f32::consts::PI;
use libm::fabsf;

/// Time for which the runner stands at the beginning, in s.
const STANDS: f32 = 4.0;
/// Highest speed of the runner, in m/s, and greatest change of it, in m/s².
const RUNS: f32 = 2.5;
const SPURT: f32 = 1.0;
/// Distance from the middle line at which a passer-by begins to cross it, in m.
const ASIDE: f32 = 11.0;
/// Distance of a vehicle at which a passer-by waits for it, in m.
const WAITS: f32 = 1.6;
/// Time after which a passer-by who waits goes back, and for which the runner waits for others, in s. They could wait
/// for each other otherwise.
const PATIENCE: f32 = 4.0;

/// Person, with the velocity in the frame of the world.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Walker {
    /// Position, in m.
    pub position: Point2,
    /// Velocity, in m/s.
    pub velocity: Point2,
}

impl Walker {
    /// Radius of a person, in m.
    pub const RADIUS: f32 = 0.22;
    /// Height of a person, in m.
    pub const HEIGHT: f32 = 1.75;
}

/// Runner on a track: from standing to 2.5 m/s, slower in sharp corners, with some rests.
#[derive(Debug, Clone)]
pub struct Runner {
    /// Person.
    pub walker: Walker,
    /// Distance along the track, in m.
    s: f32,
    speed: f32,
    /// Distances from which on the runner has another speed, in m, and those speeds in m/s, the last one first.
    plan: Vec<(f32, f32)>,
    wanted: f32,
    rests: f32,
    /// Time for which others have been in the way, in s.
    waited: f32,
    end: f32,
}

impl Runner {
    /// Creates a runner who stands at the beginning of the track, and runs one round, or `distance` m if that is less.
    pub fn new(track: &Track, distance: f32, random: &mut Random) -> Self {
        let end = distance.min(track.length());
        let mut plan = vec![];
        let mut s = 0.0;
        while s < end {
            // Zero for a rest.
            let speed = if s > 100.0 && random.chance(0.08) { 0.0 } else { random.uniform(1.3, RUNS + 0.2).min(RUNS) };
            plan.push((s, speed));
            s += random.uniform(40.0, 140.0);
        }
        plan.reverse();
        let walker = Walker { position: track.way(0.0), velocity: Point2::default() };
        Self { walker, s: 0.0, speed: 0.0, plan, wanted: 0.0, rests: STANDS, waited: 0.0, end }
    }

    /// Distance along the track, in m.
    pub const fn distance(&self) -> f32 {
        self.s
    }

    /// Returns `true` at the end of the way.
    pub fn has_arrived(&self) -> bool {
        self.s >= self.end
    }

    /// Runs for `dt` s. The runner stops before others who are in the way, and squeezes past them after 4 s.
    pub fn step(&mut self, dt: f32, track: &Track, others: &[Walker]) {
        self.rests = (self.rests - dt).max(0.0);
        if self.rests == 0.0 {
            while let Some((_, speed)) = self.plan.pop_if(|(at, _)| *at <= self.s) {
                if speed == 0.0 {
                    self.rests = 7.0;
                } else {
                    self.wanted = speed;
                }
            }
        }
        let ahead = track.way(self.s + 1.3);
        let is_blocked = others.iter().any(|other| (other.position - ahead).norm() < 0.9);
        self.waited = if is_blocked { self.waited + dt } else { 0.0 };
        let bend = [1.0, 3.0, 5.0].map(|d| fabsf(track.bend(self.s + d))).into_iter().fold(0.0, f32::max);
        let most = if bend > 0.12 { 1.7 } else { RUNS };
        let waits = is_blocked && self.waited <= PATIENCE;
        let stands = self.rests > 0.0 || waits || self.has_arrived();
        let wanted = if stands { 0.0 } else { self.wanted.min(most) };
        let change = if wanted < self.speed { 2.0 * SPURT } else { SPURT };
        self.speed += (wanted - self.speed).clamp(-change * dt, change * dt);
        let before = self.walker.position;
        // The way of a bow is longer than the middle line.
        let stretch = (track.way(self.s + 0.5) - track.way(self.s - 0.5)).norm().max(0.5);
        self.s = (self.s + self.speed * dt / stretch).min(self.end);
        self.walker.position = track.way(self.s);
        self.walker.velocity = (self.walker.position - before).scaled(1.0 / dt);
    }
}

/// Someone who crosses the track, or stands beside it.
#[derive(Debug, Clone, Copy)]
struct PasserBy {
    walker: Walker,
    /// Direction of the walk.
    direction: Point2,
    speed: f32,
    /// Distance of the runner along the track at which the walk begins, in m.
    begins: f32,
    /// Length of the walk that is left, in m.
    left: f32,
    /// Time for which the person has waited, in s.
    waited: f32,
}

/// People who cross the track of a runner near a robot that follows, or stand beside it.
#[derive(Debug, Clone)]
pub struct Passersby {
    people: Vec<PasserBy>,
    walkers: Vec<Walker>,
}

impl Passersby {
    /// Creates people at places where nothing is in their way, about one for each 70 m.
    pub fn new(track: &Track, terrain: &Terrain, random: &mut Random) -> Self {
        let mut people = vec![];
        let mut s = 50.0;
        while s < track.length() - 20.0 {
            let (at, heading) = (track.at(s), track.heading(s));
            let left = Point2::polar(1.0, heading + 0.5 * PI);
            let side = if random.chance(0.5) { 1.0 } else { -1.0 };
            let speed = random.uniform(0.9, 1.5);
            let (lead, stands) = (random.uniform(-3.0, 9.0), random.chance(0.3));
            let from = at + left.scaled(side * if stands { random.uniform(1.6, 3.0) } else { ASIDE });
            let is_free = |place: Point2| {
                let thing = terrain.near(place, 3.0).any(|t| (t.at - place).norm() < t.radius_at_ground() + 0.6);
                !thing && terrain.depth(place) == 0.0
            };
            let length = if stands { 0.0 } else { 2.0 * ASIDE };
            let direction = left.scaled(-side);
            let is_way_free = (0..=(length / 0.5) as usize).all(|i| is_free(from + direction.scaled(0.5 * i as f32)));
            if is_way_free && (stands || random.chance(0.7)) {
                // In the middle of the track when the runner has come to `lead` m beyond it, at 2 m/s.
                let begins = s + lead - 2.0 * ASIDE / speed;
                let walker = Walker { position: from, velocity: Point2::default() };
                people.push(PasserBy { walker, direction, speed, begins, left: length, waited: 0.0 });
                s += random.uniform(35.0, 90.0);
            } else {
                s += 3.0;
            }
        }
        let walkers = people.iter().map(|p| p.walker).collect();
        Self { people, walkers }
    }

    /// All of them.
    pub fn walkers(&self) -> &[Walker] {
        &self.walkers
    }

    /// Walks for `dt` s. `runner` is the distance of the runner along the track, in m. Who has the robot at `robot`
    /// close ahead waits, and after 4 s goes back.
    pub fn step(&mut self, dt: f32, runner: f32, robot: Point2) {
        for (person, walker) in self.people.iter_mut().zip(&mut self.walkers) {
            let to = robot - person.walker.position;
            let waits = to.norm() < WAITS && to.dot(person.direction) > -0.3;
            let is_on_way = runner >= person.begins && person.left > 0.0;
            person.waited = if is_on_way && waits { person.waited + dt } else { 0.0 };
            if person.waited > PATIENCE {
                person.direction = person.direction.scaled(-1.0);
                person.left = 2.0 * ASIDE - person.left;
                person.waited = 0.0;
            }
            let walks = is_on_way && !waits;
            person.walker.velocity = if walks { person.direction.scaled(person.speed) } else { Point2::default() };
            person.walker.position = person.walker.position + person.walker.velocity.scaled(dt);
            person.left -= if walks { person.speed * dt } else { 0.0 };
            *walker = person.walker;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn country(seed: u64) -> (Track, Terrain, Runner, Passersby) {
        let mut random = Random::new(seed);
        let track = Track::new(&mut random, 600.0);
        let terrain = Terrain::around(&track, &mut random);
        let runner = Runner::new(&track, 600.0, &mut random);
        let people = Passersby::new(&track, &terrain, &mut random);
        (track, terrain, runner, people)
    }

    #[test]
    fn the_runner_runs_a_round_and_others_cross() {
        let (track, terrain, mut runner, mut people) = country(5);
        let (mut fastest, mut steps, mut near) = (0.0_f32, 0, f32::INFINITY);
        while !runner.has_arrived() && steps < 100_000 {
            runner.step(0.01, &track, people.walkers());
            people.step(0.01, runner.distance(), Point2::new(1e6, 0.0));
            fastest = fastest.max(runner.walker.velocity.norm());
            near = people.walkers().iter().map(|w| (w.position - runner.walker.position).norm()).fold(near, f32::min);
            assert_eq!(terrain.depth(runner.walker.position), 0.0);
            steps += 1;
        }
        assert!(runner.has_arrived() && (20_000..60_000).contains(&steps), "{steps}");
        assert!(fastest > 2.0 && fastest < 3.2, "{fastest} m/s");
        assert!(near < 6.0 && near > 0.3, "{near} m");
    }

    #[test]
    fn the_runner_squeezes_past_who_stands_in_the_way() {
        let (track, _, mut runner, _) = country(5);
        let other = Walker { position: track.way(20.0), velocity: Point2::default() };
        let mut standing = 0;
        for _ in 0..3000 {
            runner.step(0.01, &track, &[other]);
            standing += usize::from(runner.walker.velocity == Point2::default());
        }
        assert!(runner.distance() > 25.0, "{} m", runner.distance());
        assert!((600..1000).contains(&standing), "{standing}");
    }

    #[test]
    fn a_passer_by_waits_for_a_robot_ahead() {
        let (_, _, _, mut people) = country(6);
        let index = people.people.iter().position(|p| p.left > 0.0).expect("someone crosses");
        let person = people.people[index];
        let robot = person.walker.position + person.direction.scaled(1.0);
        people.step(0.1, person.begins + 1.0, robot);
        assert_eq!(people.walkers()[index].velocity, Point2::default());
        people.step(0.1, person.begins + 1.0, Point2::new(1e6, 0.0));
        assert!(people.walkers()[index].velocity.norm() > 0.8);
        (0..30).for_each(|_| people.step(0.1, person.begins + 1.0, Point2::new(1e6, 0.0)));
        // The robot stays where it is.
        let robot = people.walkers()[index].position + person.direction.scaled(1.0);
        (0..45).for_each(|_| people.step(0.1, person.begins + 1.0, robot));
        assert!(people.walkers()[index].velocity.dot(person.direction) < -0.8, "he goes back");
    }
}
