use apex_nodes::{
    map::{Octagon, Station},
    math::normalize_angle,
    nav::stand_before,
    scan::{Point2, Pose2},
};
use apex_rt::{Ctx, Event, node};
use core::f32::consts::{FRAC_PI_2, FRAC_PI_4};

/// Start pose of the robot: the origin of its map.
#[node]
pub fn origin() -> Pose2 {
    Pose2::default()
}

/// Triggers `yes` if the word is the expected one (thesis figure 8.1a, *streq*).
#[node]
pub fn is_word(word: &String, #[param] expected: &'static str, yes: Event<()>) {
    if word == expected {
        yes.emit(());
    }
}

/// Chooses the nearest free filling station while it is active, and sends the pose in front of it; ⊥ while no free
/// station is known.
#[node]
#[derive(Debug)]
pub struct ChooseStation {
    /// Distance between the robot's pose and the wall.
    #[param(unit = "m", default = 0.9, range = 0.0..=10.0)]
    distance: f32,
    chosen: Option<usize>,
    /// Index of the station that was given up last.
    avoided: Option<usize>,
}

#[node]
impl ChooseStation {
    fn process(&mut self, ctx: &Ctx, stations: &heapless::Vec<Station, 4>, robot: &Pose2) -> Option<Pose2> {
        if !ctx.active() {
            return None;
        }
        let free = stations.iter().enumerate().filter(|(_, station)| station.free);
        let way = |station: &Station| (stand_before(&station.pose, self.distance).position() - robot.position()).norm();
        let other = free.clone().filter(|(i, _)| Some(*i) != self.avoided);
        let nearest = other.min_by(|(_, a), (_, b)| way(a).total_cmp(&way(b))).or(free.clone().next());
        let (chosen, station) = nearest?;
        self.chosen = Some(chosen);
        Some(stand_before(&station.pose, self.distance))
    }

    /// Avoids the chosen station next time, if there is another free one.
    #[slot]
    fn give_up(&mut self) {
        self.avoided = self.chosen;
    }
}

/// Next place of a tour around the island, counter-clockwise, from which the robot faces along the border (thesis
/// 4.3.4). Sent once per activation. Places that the robot did not reach are skipped.
#[node]
#[derive(Debug)]
pub struct BorderTour {
    /// Distance of the tour from the middle of the island.
    #[param(unit = "m", default = 3.8, range = 0.0..=100.0)]
    radius: f32,
    /// Angle between two places, seen from the middle.
    #[param(unit = "rad", default = FRAC_PI_4, range = 0.01..=3.2)]
    step: f32,
    /// Angle of the last place, in rad.
    last: Option<f32>,
}

#[node]
impl BorderTour {
    fn process(&mut self, ctx: &Ctx, robot: &Pose2, island: &Octagon) -> Option<Pose2> {
        if !ctx.active() {
            return None;
        }
        let robot = (robot.position() - island.centre).angle();
        let ahead = self.last.map(|last| normalize_angle(&(last - robot))).filter(|ahead| *ahead > 0.0);
        let angle = robot + ahead.unwrap_or_default() + self.step;
        self.last = Some(angle);
        let place = island.centre + Point2::polar(self.radius, angle);
        Some(Pose2::new(place.x, place.y, normalize_angle(&(angle + FRAC_PI_2))))
    }

    /// Receives activity with a token, without any other effect.
    #[slot]
    fn begin(&mut self) {}
}

#[cfg(test)]
mod tests {
    use super::*;
    use apex_rt::{Construct, Time};
    use core::f32::consts::PI;

    fn active() -> Ctx {
        Ctx::new(Time::ZERO).of_node(true)
    }

    fn stations(free: [bool; 4]) -> heapless::Vec<Station, 4> {
        let at = |i: usize| Pose2::new(0.0, 0.0, i as f32 * FRAC_PI_2).compose(&Pose2::new(1.5, 0.0, 0.0));
        free.iter().enumerate().map(|(i, free)| Station { pose: at(i), free: *free }).collect()
    }

    #[test]
    fn the_nearest_free_station_is_chosen() {
        let mut node = ChooseStation::construct((0.9,));
        let robot = Pose2::new(3.0, 0.5, 0.0);
        assert_eq!(node.process(&Ctx::new(Time::ZERO), &stations([true; 4]), &robot), None);
        let mut choose = |free| node.process(&active(), &stations(free), &robot).map(|place| place.position());
        let near = |place: Option<Point2>, x: f32, y: f32| place.is_some_and(|p| (p - Point2::new(x, y)).norm() < 1e-5);
        assert!(near(choose([true; 4]), 2.4, 0.0));
        assert!(near(choose([false, true, true, true]), 0.0, 2.4));
        assert_eq!(choose([false; 4]), None);
    }

    #[test]
    fn a_station_that_was_given_up_is_avoided_if_there_is_another_one() {
        let mut node = ChooseStation::construct((0.9,));
        let robot = Pose2::new(3.0, 0.0, 0.0);
        let first = node.process(&active(), &stations([true; 4]), &robot);
        node.give_up();
        assert_ne!(node.process(&active(), &stations([true; 4]), &robot), first);
        assert_eq!(node.process(&active(), &stations([true, false, false, false]), &robot), first);
    }

    #[test]
    fn the_tour_goes_round_counter_clockwise() {
        let mut node = BorderTour::construct((4.0, FRAC_PI_2));
        let island = Octagon { centre: Point2::new(1.0, 0.0), apothem: 1.4, theta: 0.0 };
        let place = node.process(&active(), &Pose2::new(4.0, 0.0, 0.0), &island).expect("it is active");
        assert!((place.position() - Point2::new(1.0, 4.0)).norm() < 1e-5 && (place.theta.abs() - PI).abs() < 1e-5);
        assert_eq!(node.process(&Ctx::new(Time::ZERO), &place, &island), None);
    }

    #[test]
    fn a_place_that_was_not_reached_is_left_out() {
        let mut node = BorderTour::construct((4.0, FRAC_PI_2));
        let island = Octagon { centre: Point2::default(), apothem: 1.4, theta: 0.0 };
        let mut next = |x, y| {
            let place = node.process(&active(), &Pose2::new(x, y, 0.0), &island).expect("it is active");
            (place.position() - Point2::default()).angle()
        };
        assert!((next(4.0, 0.0) - FRAC_PI_2).abs() < 1e-5);
        assert!((next(4.0, 0.1).abs() - PI).abs() < 1e-1);
        assert!((next(0.0, 4.0) + FRAC_PI_2).abs() < 1e-1, "the one half round is still ahead");
        assert!((next(1.0, -4.0) - 0.245).abs() < 1e-2, "it has got past the last one");
    }
}
