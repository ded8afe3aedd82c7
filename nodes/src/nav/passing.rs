use super::Path;
use crate::{
    map::Grid,
    persons::{Person, Persons},
    scan::{Point2, Pose2},
};
use apex_rt::{Event, Out, node};

/// Adds to the costs of a map those of places where persons stand who will go on, such as `Passersby` selects: the
/// robot may have to wait there.
///
/// A way through the place of such a person costs `wait` m more, so that a planner leads it around the person where
/// there is room, but not through half of the building. `persons` are in the frame of `odometry`, and `pose` is that of
/// the robot in the frame of `costs`; without these poses nothing is added.
#[node]
#[derive(Debug, Clone)]
pub struct PersonCosts {
    /// Length of the way that is worth the time for which the robot waits for a person.
    #[param(unit = "m", default = 5.0, range = 0.0..=1000.0)]
    wait: f32,
    /// Distance from a person up to which the robot has to wait, from a point on its axis.
    #[param(unit = "m", default = 0.5, range = 0.01..=10.0)]
    radius: f32,
    /// Velocity from which on a person walks, and is not waited for.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
}

#[node]
impl PersonCosts {
    fn process(
        &mut self,
        costs: &Grid<f32>,
        persons: Option<&Persons>,
        odometry: Option<&Pose2>,
        pose: Option<&Pose2>,
        with: &mut Out<Grid<f32>>,
    ) {
        let with = with.get_mut();
        with.clone_from(costs);
        let Some(persons) = persons else { return };
        for place in places(persons, self.walking, odometry, pose) {
            self.add(with, place);
        }
    }

    /// Adds the cost of a disc about a place, of which each metre costs the same.
    fn add(&self, costs: &mut Grid<f32>, place: Point2) {
        let (raster, cost) = (*costs.raster(), 0.5 * self.wait / self.radius);
        let count = (self.radius / raster.resolution) as i32 + 1;
        for (i, k) in (-count..=count).flat_map(|i| (-count..=count).map(move |k| (i, k))) {
            let point = place + Point2::new(i as f32, k as f32).scaled(raster.resolution);
            let cell = raster.cell(point).filter(|cell| (raster.centre(*cell) - place).norm() <= self.radius);
            if let Some(value) = cell.and_then(|cell| costs.get_mut(cell)) {
                *value += cost;
            }
        }
    }
}

/// Passes a path on, unless a person stands on its first `ahead` m, who will go on. Then the robot has to wait:
/// `occupied` comes instead.
///
/// `persons` are in the frame of `odometry`, such as those that `Passersby` selects, and `pose` is that of the robot in
/// the frame of the path. Without these poses the path is passed on.
#[node]
#[derive(Debug, Clone)]
pub struct AwaitPersons {
    /// Length of the path on which persons count.
    #[param(unit = "m", default = 2.5, range = 0.0..=100.0)]
    ahead: f32,
    /// Distance of a person from the path up to which the person stands on it.
    #[param(unit = "m", default = 0.4, range = 0.0..=10.0)]
    radius: f32,
    /// Velocity from which on a person walks, and is not waited for.
    #[param(unit = "m/s", default = 0.3, range = 0.0..=10.0)]
    walking: f32,
}

#[node]
impl AwaitPersons {
    fn process(
        &mut self,
        path: &Path,
        persons: Option<&Persons>,
        odometry: Option<&Pose2>,
        pose: Option<&Pose2>,
        free: &mut Out<Path>,
        #[failure] occupied: Event<()>,
    ) {
        let none = Persons::default();
        let is_near = |place: Point2| self.is_near(path, place);
        if places(persons.unwrap_or(&none), self.walking, odometry, pose).any(is_near) {
            occupied.emit(());
        } else {
            free.get_mut().clone_from(path);
        }
    }

    fn is_near(&self, path: &Path, place: Point2) -> bool {
        let mut left = self.ahead;
        path.points.windows(2).any(|ends| {
            let is_near = left > 0.0 && (super::path::nearest_on(ends[0], ends[1], place) - place).norm() < self.radius;
            left -= (ends[1] - ends[0]).norm();
            is_near
        })
    }
}

/// Places of persons who stand, in the frame of `pose`.
fn places<'a>(
    persons: &'a Persons,
    walking: f32,
    odometry: Option<&Pose2>,
    pose: Option<&Pose2>,
) -> impl Iterator<Item = Point2> + 'a {
    let poses = odometry.zip(pose).filter(|(odometry, pose)| odometry.is_usable() && pose.is_usable());
    let poses = poses.map(|(odometry, pose)| (*odometry, *pose));
    let stands = move |person: &&Person| person.velocity.norm() < walking;
    let place = move |person: &Person| poses.map(|(odometry, pose)| pose.to_outer(odometry.to_inner(person.position)));
    persons.iter().filter(stands).filter_map(place)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::Raster;
    use apex_rt::{Construct, event};

    const POSE: Pose2 = Pose2::new(1.0, 1.0, 0.0);
    const ODOMETRY: Pose2 = Pose2::new(-5.0, 2.0, core::f32::consts::FRAC_PI_2);

    /// Person at a place of the map.
    fn person(x: f32, y: f32, velocity: f32) -> Persons {
        let position = ODOMETRY.to_outer(POSE.to_inner(Point2::new(x, y)));
        core::iter::once(Person { position, velocity: Point2::new(velocity, 0.0), ..Person::default() }).collect()
    }

    #[test]
    fn a_way_through_a_person_who_stands_costs_the_time_of_waiting() {
        let raster = Raster { resolution: 0.1, width: 60, height: 30, ..Raster::default() };
        let costs = Grid::new(raster, 1.0).expect("small");
        let sum = |persons: &Persons, pose: Option<&Pose2>| {
            let mut out = Out::new();
            PersonCosts::construct((8.0, 0.5, 0.3)).process(&costs, Some(persons), Some(&ODOMETRY), pose, &mut out);
            let with = out.get().expect("costs");
            // Along the middle line.
            (0..60).map(|i| with.at(Point2::new(0.05 + 0.1 * i as f32, 1.05)).expect("inside") - 1.0).sum::<f32>() * 0.1
        };
        assert!((sum(&person(3.05, 1.05, 0.0), Some(&POSE)) - 8.0).abs() < 1.0);
        assert_eq!(sum(&person(3.05, 1.65, 0.0), Some(&POSE)), 0.0);
        assert_eq!(sum(&person(3.05, 1.05, 0.5), Some(&POSE)), 0.0);
        assert_eq!(sum(&person(3.05, 1.05, 0.0), None), 0.0);
    }

    #[test]
    fn it_waits_for_who_stands_on_the_way() {
        let points = (0..50).map(|i| Point2::new(1.0 + 0.1 * i as f32, 1.0)).collect();
        let path = Path { points, heading: 0.0 };
        let passes = |persons: Option<&Persons>, pose: Option<&Pose2>| {
            let (mut out, mut occupied) = (Out::new(), None);
            let mut node = AwaitPersons::construct((2.5, 0.4, 0.3));
            node.process(&path, persons, Some(&ODOMETRY), pose, &mut out, event(&mut occupied));
            let passes = out.get() == Some(&path);
            assert_ne!(passes, occupied.is_some());
            passes
        };
        let at = |x: f32, y: f32, velocity: f32| passes(Some(&person(x, y, velocity)), Some(&POSE));
        assert_eq!([at(3.0, 1.3, 0.0), at(3.0, 1.3, 0.8), at(3.0, 1.5, 0.0)], [false, true, true]);
        assert_eq!([at(3.3, 1.0, 0.0), at(4.5, 1.0, 0.0)], [false, true]);
        assert!(passes(None, Some(&POSE)) && passes(Some(&person(3.0, 1.0, 0.0)), None));
    }
}
