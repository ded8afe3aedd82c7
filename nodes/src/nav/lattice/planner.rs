use super::{CurveDrive, CurveSearch, Floor, Goal, Ground, Section, Start};
use crate::{
    map::{Grid, Occupancy},
    nav::{Articulated, BackPath, Clearance, NoPath, Path, Terrain},
    scan::Pose2,
};
use apex_rt::{Event, Out, node};

/// Plans a path for a vehicle that drives in curves, such as a tractor with a trailer (see [`CurveSearch`]). The path
/// ends with the heading of the goal.
///
/// `start`, `goal` and the path are in the frame of the map. `other` is another goal, such as the other end of
/// something that the vehicle drives beneath: the path leads to the one that is reached at the least cost, where that
/// of `other` is increased by `other_cost`. The outline of tractor, trailer and load keeps the `margin` from all that
/// is not free on the map; on the first 0.8 m it may be as near to something as at the start. `costs` are those of
/// `CostMap`. `trailer` is the pose of the trailer's axis in the frame of the vehicle. If it is ⊥, the trailer is
/// assumed to be straight behind.
///
/// With a `backing_gain` a vehicle with a trailer also backs up where that is shorter. The output is then the first
/// section of the way: `turn` leads forward to a place where the direction changes, and `back` is for `BackFollower`.
/// At the end of such a section the rest of the way has to be planned. `floor` is a map such as that of `HazardMap` in
/// the frame of `odometry`: the vehicle keeps the `clearance` from its hazards as `SweepStop` does, which then lets it
/// drive, and backs up only over places that are free on it. Without it, floor is everywhere.
///
/// After `stay_forward` the next way leads only forward, and after `begin_back` it begins backward, if there is such a
/// way: for example because something that is not on the map holds the vehicle in the other direction. After
/// `come_straight` ways end with a straight line until the goal is another one, if there are such ways. If something
/// stands at the goals, `turn` leads to a place up to `short` before one of them, from where it can be seen if it is
/// still there. Without a way, the outputs are ⊥ and `no_path` gives the reason.
#[node]
#[derive(Debug, Clone)]
pub struct CurvePlanner {
    /// Smallest radius of a curve.
    #[param(unit = "m", default = 0.8, range = 0.1..=100.0)]
    radius: f32,
    /// Shape of the vehicle.
    #[param(default = Articulated::PATSY)]
    vehicle: Articulated,
    /// Length of the load, whose middle is above that of the straight vehicle.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_length: f32,
    /// Width of the load; 0 for none.
    #[param(unit = "m", default = 0.0, range = 0.0..=10.0)]
    load_width: f32,
    /// Distance of the outline from the middles of cells that are not free.
    #[param(unit = "m", default = 0.1, range = 0.0..=10.0)]
    margin: f32,
    /// Distances kept from hazards on the floor.
    #[param(default = Clearance::PATSY)]
    clearance: Clearance,
    /// Rate at which the angle between the vehicle and its trailer approaches the wanted one when it backs up; 0 if it
    /// only drives forward.
    #[param(unit = "1/m", default = 0.0, range = 0.0..=100.0)]
    backing_gain: f32,
    /// Additional cost of `other`.
    #[param(unit = "m", default = 0.0, range = 0.0..=1000.0)]
    other_cost: f32,
    /// Longest straight line before a goal, on which the trailer comes into line with the vehicle: within 1° of the
    /// goal's heading at the end. 0 if the trailer may be bent at the goal.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    straight: f32,
    /// Distance before a goal up to which a way may end if something stands at it: seen from there, it may be gone.
    #[param(unit = "m", default = 0.0, range = 0.0..=100.0)]
    short: f32,
    /// Limit of the next way.
    next: Limit,
    /// The last goal.
    goal: Pose2,
    /// `true` if ways to it end with a straight line.
    comes_straight: bool,
    search: CurveSearch,
}

/// Limit of a way.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Limit {
    #[default]
    None,
    StaysForward,
    BeginsBack,
}

impl Limit {
    /// Vehicles and starts with which ways are preferred, in sequence: within the limit, then without it, but straight
    /// at the end if the vehicle comes so.
    fn preferred(self, vehicle: CurveDrive, start: Start) -> impl Iterator<Item = (CurveDrive, Start)> {
        let limited = match self {
            Self::None => None,
            Self::StaysForward => Some((CurveDrive { backing_gain: 0.0, ..vehicle }, start)),
            Self::BeginsBack => Some((vehicle, Start { is_back: true, ..start })),
        };
        limited.into_iter().chain(vehicle.comes_straight.then_some((vehicle, start)))
    }
}

#[node]
impl CurvePlanner {
    #[allow(clippy::too_many_arguments, reason = "they are the ports")]
    fn process(
        &mut self,
        start: &Pose2,
        goal: &Pose2,
        other: Option<&Pose2>,
        map: &Grid<Occupancy>,
        costs: Option<&Grid<f32>>,
        trailer: Option<&Pose2>,
        floor: Option<&Grid<Occupancy>>,
        odometry: Option<&Pose2>,
        path: &mut Out<Path>,
        turn: &mut Out<Path>,
        back: &mut Out<BackPath>,
        #[failure] no_path: Event<NoPath>,
    ) {
        let terrain = Terrain { map, costs, unknown_is_open: false };
        let clearance = self.clearance;
        let floor = floor.zip(odometry).map(|(map, odometry)| Floor { map, start: [*start, *odometry], clearance });
        let Self { radius, vehicle: shape, margin, straight, short, .. } = *self;
        self.comes_straight &= self.goal == *goal;
        self.goal = *goal;
        let load = [self.load_length, self.load_width];
        let (backing_gain, comes_straight) = (self.backing_gain, self.comes_straight);
        let vehicle = CurveDrive { radius, shape, load, margin, backing_gain, straight, comes_straight, short };
        let trailer = start.theta + trailer.filter(|pose| pose.is_finite()).map_or(0.0, |pose| pose.theta);
        let start = Start { pose: *start, trailer, is_back: false };
        let other_goal = Goal { pose: *other.unwrap_or(goal), cost: self.other_cost };
        let both = [Goal { pose: *goal, cost: 0.0 }, other_goal];
        let goals = &both[..1 + usize::from(other.is_some())];
        let ground = Ground { terrain, floor };
        let mut plan = |(vehicle, start)| self.search.plan(&ground, &vehicle, &start, goals);
        let mut preferred = core::mem::take(&mut self.next).preferred(vehicle, start);
        let way = preferred.find_map(|preferred| plan(preferred).ok());
        match way.map_or_else(|| plan((CurveDrive { comes_straight: false, ..vehicle }, start)), Ok) {
            Ok(way) => match way.first_section(path.get_mut(), back.get_mut()) {
                Section::ToGoal => back.clear(),
                Section::ToTurn => {
                    core::mem::swap(path.get_mut(), turn.get_mut());
                    path.clear();
                    back.clear();
                }
                Section::Back => path.clear(),
            },
            Err(why) => no_path.emit(why),
        }
    }

    /// Plans the next way without a section backward.
    #[slot]
    fn stay_forward(&mut self) {
        self.next = Limit::StaysForward;
    }

    /// Plans the next way with a section backward at its beginning.
    #[slot]
    fn begin_back(&mut self) {
        self.next = Limit::BeginsBack;
    }

    /// Plans ways to this goal with a straight line at their ends, for example because the trailer was bent after a
    /// curve.
    #[slot]
    fn come_straight(&mut self) {
        self.comes_straight = true;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::map::{Cell, Raster};
    use crate::scan::Point2;
    use apex_rt::{Construct, event};

    /// Returns whether there is a way forward, one backward, and none, on floor that is known or not behind.
    fn plan(node: &mut CurvePlanner, behind: Occupancy) -> (bool, bool, bool) {
        let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 100, height: 60 };
        let map = Grid::new(raster, Occupancy::Free).expect("small");
        let mut floor = Grid::new(raster, Occupancy::Free).expect("small");
        for number in 0..60 * 100 {
            let cell = Cell::new(number % 100, number / 100);
            *floor.get_mut(cell).expect("inside") = if cell.x < 30 { behind } else { Occupancy::Free };
        }
        let (start, goal) = (Pose2::new(3.0, 3.0, 0.0), Pose2::new(7.0, 3.0, 0.0));
        let (mut path, mut turn, mut back, mut none) = (Out::new(), Out::new(), Out::new(), None);
        let (floor, here) = (Some(&floor), Some(&start));
        node.process(
            &start,
            &goal,
            None,
            &map,
            None,
            None,
            floor,
            here,
            &mut path,
            &mut turn,
            &mut back,
            event(&mut none),
        );
        let is_back = back.get().is_some_and(|back| back.length() > 0.0);
        (path.get().is_some_and(|path| path.points.len() > 9), is_back, none.is_some())
    }

    fn planner() -> CurvePlanner {
        CurvePlanner::construct((0.7, Articulated::PATSY, 0.0, 0.0, 0.1, Clearance::PATSY, 2.5, 0.0, 2.4, 0.0))
    }

    #[test]
    fn ways_are_straight_at_the_end_until_the_goal_is_another_one() {
        let mut node = planner();
        node.come_straight();
        assert_eq!((plan(&mut node, Occupancy::Free), node.comes_straight), ((true, false, false), false));
        node.come_straight();
        let again = [plan(&mut node, Occupancy::Free), plan(&mut node, Occupancy::Free)];
        assert_eq!((again, node.comes_straight), ([(true, false, false); 2], true));
    }

    #[test]
    fn a_limit_that_leaves_no_way_is_dropped() {
        let mut node = planner();
        assert_eq!(plan(&mut node, Occupancy::Free), (true, false, false));
        node.begin_back();
        assert_eq!(plan(&mut node, Occupancy::Free), (false, true, false));
        // Nothing is known about the floor behind: the way still leads forward.
        node.begin_back();
        assert_eq!(plan(&mut node, Occupancy::Unknown), (true, false, false));
    }
}
