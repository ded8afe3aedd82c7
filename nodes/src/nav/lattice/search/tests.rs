use super::*;
use crate::{
    map::{Cell, Grid, Occupancy, Raster},
    math::Random,
    nav::{
        Articulated, BackPath, Clearance, Path,
        lattice::{Floor, Section, drive::CHECK},
        outline::Axes,
        payload::Backing,
    },
};
use core::f32::consts::{FRAC_PI_2, PI, TAU};

const VEHICLE: CurveDrive = CurveDrive {
    radius: 0.8,
    shape: Articulated::PATSY,
    load: [0.0; 2],
    margin: 0.05,
    backing_gain: 0.0,
    straight: 0.0,
    comes_straight: false,
    short: 0.0,
};
const LOAD: [f32; 2] = [1.2, 0.7];

/// Room of 12 m × 8 m with a wall that ends at y = 5 m.
fn room() -> Grid<Occupancy> {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 120, height: 80 };
    let mut map = Grid::new(raster, Occupancy::Free).expect("small");
    for y in 0..50 {
        *map.get_mut(Cell::new(60, y)).expect("inside") = Occupancy::Occupied;
    }
    map
}

fn plan(map: &Grid<Occupancy>, start: Pose2, goal: Pose2) -> Result<Path, NoPath> {
    plan_to_any(map, start, &[goal])
}

fn plan_to_any(map: &Grid<Occupancy>, start: Pose2, goals: &[Pose2]) -> Result<Path, NoPath> {
    plan_at_costs(map, start, &goals.iter().copied().map(free).collect::<Vec<_>>())
}

fn free(pose: Pose2) -> Goal {
    Goal { pose, cost: 0.0 }
}

fn plan_at_costs(map: &Grid<Occupancy>, start: Pose2, goals: &[Goal]) -> Result<Path, NoPath> {
    let terrain = Terrain { map, costs: None, unknown_is_open: false };
    search(&terrain, &VEHICLE, &at(start, start.theta), goals).map(|(_, path, _)| path)
}

const fn at(pose: Pose2, trailer: f32) -> Start {
    Start { pose, trailer, is_back: false }
}

fn search(
    terrain: &Terrain<'_>,
    vehicle: &CurveDrive,
    start: &Start,
    goals: &[Goal],
) -> Result<(Section, Path, BackPath), NoPath> {
    let (mut path, mut back) = (Path::default(), BackPath::default());
    let ground = Ground { terrain: *terrain, floor: None };
    let way = CurveSearch::default().plan(&ground, vehicle, start, goals)?;
    let section = way.first_section(&mut path, &mut back);
    Ok((section, path, back))
}

#[test]
fn paths_are_smooth_and_free_and_end_with_the_heading() {
    let map = room();
    let start = Pose2::new(2.0, 2.0, PI);
    for goal in [Pose2::new(10.0, 2.0, 0.0), Pose2::new(9.0, 6.0, PI), Pose2::new(3.0, 6.0, -FRAC_PI_2)] {
        let path = plan(&map, start, goal).expect("a way");
        assert_eq!((path.points[0], path.goal()), (start.position(), Some(goal.position())));
        assert!(path.points.iter().all(|p| map.at(*p) == Some(&Occupancy::Free)));
        let headings: Vec<f32> = path.points.windows(2).map(|w| (w[1] - w[0]).angle()).collect();
        let turns = headings.windows(2).map(|w| libm::remainderf(w[1] - w[0], TAU).abs());
        let sharpest = turns.fold(0.0, f32::max);
        assert!(sharpest < 0.25, "{sharpest} rad from one point to the next to {goal:?}");
        let off = |a: f32, b: f32| libm::remainderf(a - b, TAU).abs();
        assert!(off(headings[0], PI) < 0.1 && off(headings[headings.len() - 1], goal.theta) < 0.1);
    }
}

#[test]
fn a_load_needs_more_room_in_a_curve() {
    // A passage of 2 m around a corner: the tractor gets through, a long load behind it does not.
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 80, height: 80 };
    let mut map = Grid::new(raster, Occupancy::Occupied).expect("small");
    for i in 0..80 {
        (40..60).for_each(|j| *map.get_mut(Cell::new(i, j)).expect("inside") = Occupancy::Free);
        (40..60).for_each(|j| *map.get_mut(Cell::new(j, i)).expect("inside") = Occupancy::Free);
    }
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let (start, goals) = (Pose2::new(2.5, 5.0, 0.0), [free(Pose2::new(5.0, 2.0, -FRAC_PI_2))]);
    let is_way = |load| search(&terrain, &CurveDrive { load, ..VEHICLE }, &at(start, 0.0), &goals).is_ok();
    assert_eq!([[0.0; 2], LOAD, [4.2, 0.7]].map(is_way), [true, true, false]);
}

#[test]
fn a_trailer_is_in_line_at_a_goal_that_asks_for_it() {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 120, height: 80 };
    let map = Grid::new(raster, Occupancy::Free).expect("small");
    let ground = Ground { terrain: Terrain { map: &map, costs: None, unknown_is_open: false }, floor: None };
    let bend_at_end = |straight: f32, start: Pose2, heading: f32| {
        let vehicle = CurveDrive { load: LOAD, straight, backing_gain: 2.5, ..VEHICLE };
        let goals = [free(Pose2::new(6.0, 4.0, 0.0))];
        let way = CurveSearch::default().plan(&ground, &vehicle, &at(start, heading), &goals).expect("a way");
        let last = way.nodes[way.nodes.len() - 1];
        let mut room = Room::default();
        room.measure(&ground.terrain, &vehicle, &at(start, heading));
        let drive = Drive { ground: &ground, vehicle: &vehicle, room: &room, footing: None };
        assert!(drive.is_free(&way.end, last.trailer));
        bend(&goals[0].pose, drive.trailer_at_end(&way.end, last.trailer))
    };
    let from_the_side = Pose2::new(5.0, 2.5, FRAC_PI_2);
    assert!(bend_at_end(0.0, from_the_side, FRAC_PI_2) > 0.3);
    for (start, heading) in [(from_the_side, FRAC_PI_2), (Pose2::new(5.7, 4.0, 0.0), 0.6)] {
        let bend = bend_at_end(1.5, start, heading);
        assert!(bend <= IN_LINE, "{bend} rad from {start:?}");
    }
}

#[test]
fn a_way_may_have_to_end_with_a_straight_line() {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 120, height: 80 };
    let map = Grid::new(raster, Occupancy::Free).expect("small");
    let ground = Ground { terrain: Terrain { map: &map, costs: None, unknown_is_open: false }, floor: None };
    let goal = Pose2::new(6.0, 4.0, 0.0);
    let bend_before_end = |start: &Start, comes_straight: bool| {
        let vehicle = CurveDrive { load: LOAD, straight: 2.4, comes_straight, ..VEHICLE };
        let way = CurveSearch::default().plan(&ground, &vehicle, start, &[free(goal)]).expect("a way");
        bend(&way.end.at(way.end.length() - 0.7).0, goal.theta)
    };
    let starts = (1..8).map(|k| at(Pose2::new(3.0 + 0.3 * k as f32, 1.5, FRAC_PI_2), FRAC_PI_2));
    let bends: Vec<_> = starts.map(|start| [false, true].map(|is| bend_before_end(&start, is))).collect();
    assert!(bends.iter().any(|bend| bend[0] > 0.1), "a curve brings the trailer into line: {bends:?}");
    assert!(bends.iter().all(|bend| bend[1] < 0.01), "{bends:?}");
}

#[test]
fn a_vehicle_in_a_dead_end_backs_out() {
    // A corridor to the right with a dead end, and a crossing that leads up.
    let raster = Raster { corner: Point2::new(0.0, -2.0), resolution: 0.1, width: 100, height: 100 };
    let mut map = Grid::new(raster, Occupancy::Occupied).expect("small");
    for (x, y) in (0..100).flat_map(|x| (0..100).map(move |y| (x, y))) {
        if (12..29).contains(&y) || (27..53).contains(&x) && y > 12 {
            *map.get_mut(Cell::new(x, y)).expect("inside") = Occupancy::Free;
        }
    }
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let goals = [free(Pose2::new(4.0, 6.0, FRAC_PI_2))];
    let (mut base, mut heading) = (Pose2::new(8.0, 0.1, 0.1), 0.0);
    let loaded = CurveDrive { load: LOAD, ..VEHICLE };
    assert_eq!(search(&terrain, &loaded, &at(base, heading), &goals), Err(NoPath::Unreachable));
    let loaded = CurveDrive { backing_gain: 2.5, ..loaded };
    let plan = |base: Pose2, heading: f32| search(&terrain, &loaded, &at(base, heading), &goals).expect("a way");
    let (section, path, mut back) = plan(base, heading);
    assert_eq!((section, path.points.len()), (Section::Back, 0));
    let length = back.length();
    assert!((3.0..6.0).contains(&length), "{back:?}");
    // It is where the planner expects it when it has followed the path, and there the rest is a way forward. But
    // if a little more backward makes that shorter, it may do so first.
    let path = loop {
        let mut driver = Backing::new(&back);
        while !driver.step(&mut base, &mut heading) {
            let trailer = Articulated::PATSY.trailer(&base, heading);
            assert!([base, trailer].iter().all(|at| map.at(at.position()) == Some(&Occupancy::Free)), "{base:?}");
        }
        let (section, path, rest) = plan(base, heading);
        if section == Section::ToGoal {
            break path;
        }
        assert!(rest.length() < 0.2 * back.length(), "from {base:?}: {rest:?}");
        back = rest;
    };
    assert_eq!(path.goal(), Some(goals[0].pose.position()));
}

/// Across in a corridor of 2 m.
#[test]
fn a_vehicle_turns_in_a_narrow_place_in_short_steps() {
    let raster = Raster { corner: Point2::new(0.0, -1.1), resolution: 0.1, width: 160, height: 22 };
    let mut map = Grid::new(raster, Occupancy::Occupied).expect("small");
    for (x, y) in (0..160).flat_map(|x| (1..21).map(move |y| (x, y))) {
        *map.get_mut(Cell::new(x, y)).expect("inside") = Occupancy::Free;
    }
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let goals = [free(Pose2::new(2.0, 0.0, PI)), free(Pose2::new(14.0, 0.0, 0.0))];
    let vehicle = CurveDrive { load: LOAD, backing_gain: 2.5, ..VEHICLE };
    for turn in [0.7, 1.1] {
        let heading = FRAC_PI_2 * turn;
        let start = Pose2::new(8.0, 0.1, heading);
        let way = search(&terrain, &vehicle, &at(start, heading), &goals);
        assert!(way.is_ok(), "{turn}");
    }
}

#[test]
fn a_way_may_have_to_begin_backward() {
    let (map, vehicle) = (room(), CurveDrive { backing_gain: 2.5, ..VEHICLE });
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let goals = [free(Pose2::new(5.0, 3.0, 0.0))];
    let start = at(Pose2::new(2.0, 3.0, 0.0), 0.0);
    let section = |vehicle: &CurveDrive, is_back| {
        search(&terrain, vehicle, &Start { is_back, ..start }, &goals).map(|(section, ..)| section)
    };
    assert_eq!([false, true].map(|back| section(&vehicle, back)), [Ok(Section::ToGoal), Ok(Section::Back)]);
    // Backward only over floor that is known, which is all of it in the frame of the floor, or none.
    let known = Grid::new(*map.raster(), Occupancy::Free).expect("small");
    let unknown = Grid::new(*map.raster(), Occupancy::Unknown).expect("small");
    let over = |floor: &Grid<Occupancy>| {
        let start_poses = [start.pose, Pose2::new(6.0, 4.0, 2.0)];
        let floor = Some(Floor { map: floor, start: start_poses, clearance: Clearance::PATSY });
        let ground = Ground { terrain, floor };
        CurveSearch::default().plan(&ground, &vehicle, &Start { is_back: true, ..start }, &goals).is_ok()
    };
    assert_eq!([&known, &unknown].map(over), [true, false]);
    let forward = CurveDrive { backing_gain: 0.0, ..vehicle };
    assert_eq!(section(&forward, true), Err(NoPath::Unreachable));
}

#[test]
fn a_load_that_stands_beside_an_obstacle_gets_away() {
    let mut map = room();
    // Something in the grown map where the trailer is.
    for y in 18..22 {
        *map.get_mut(Cell::new(13, y)).expect("inside") = Occupancy::Occupied;
    }
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let vehicle = VEHICLE;
    let is_way = |start: Pose2| {
        let goals = [free(Pose2::new(5.0, 2.0, 0.0))];
        search(&terrain, &vehicle, &at(start, 0.0), &goals).is_ok()
    };
    // No way leads through the obstacle.
    assert_eq!([2.0, 0.8].map(|x| is_way(Pose2::new(x, 2.0, 0.0))), [true, false]);
}

#[test]
fn of_two_goals_the_nearer_one_that_is_free_is_reached() {
    let (map, start) = (room(), Pose2::new(2.0, 2.0, 0.0));
    let (near, far, blocked) = (Pose2::new(4.0, 2.0, 0.0), Pose2::new(3.0, 2.0, PI), Pose2::new(6.05, 2.0, 0.0));
    let end = |goals: &[Pose2]| plan_to_any(&map, start, goals).map(|path| (path.goal(), path.heading));
    let at = |goal: Pose2| Ok((Some(goal.position()), goal.theta));
    assert_eq!([end(&[near, far]), end(&[far, near])], [at(near), at(near)]);
    assert_eq!(end(&[blocked, far]), at(far));
    let dear = |cost| plan_at_costs(&map, start, &[Goal { pose: near, cost }, free(far)]).map(|path| path.heading);
    assert_eq!([dear(1.0), dear(9.0)], [Ok(near.theta), Ok(far.theta)]);
    assert_eq!(end(&[blocked]), Err(NoPath::GoalBlocked));
}

#[test]
fn a_way_ends_before_what_stands_at_its_goal() {
    let mut map = room();
    *map.get_mut(Cell::new(46, 20)).expect("inside") = Occupancy::Occupied;
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let goals = [free(Pose2::new(4.6, 2.05, 0.0))];
    let from = |start: Pose2, short: f32| {
        let vehicle = CurveDrive { short, margin: 0.15, ..VEHICLE };
        search(&terrain, &vehicle, &at(start, start.theta), &goals).map(|(section, path, _)| (section, path.goal()))
    };
    let start = Pose2::new(1.0, 2.5, 0.0);
    assert_eq!(from(start, 0.0), Err(NoPath::GoalBlocked));
    let (section, end) = from(start, 2.0).expect("a way to a place before it");
    let end = end.expect("a path");
    assert_eq!(section, Section::ToTurn);
    assert!((3.9..4.4).contains(&end.x) && (end.y - 2.05).abs() < 1e-3, "{end:?}");
    // There it still stands.
    assert_eq!(from(Pose2::new(end.x, end.y, 0.0), 2.0), Err(NoPath::GoalBlocked));
}

/// The stop and the planner had other ideas of the floor behind a corner of the trailer, and the vehicle stood
/// there.
#[test]
fn what_the_planner_plans_backward_the_stop_lets_drive() {
    let map = room();
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let vehicle = CurveDrive { backing_gain: 2.5, ..VEHICLE };
    let start = Start { is_back: true, ..at(Pose2::new(3.0, 3.0, 0.0), 0.0) };
    let goals = [free(Pose2::new(5.0, 3.5, 0.0))];
    let mut floor = Grid::new(*map.raster(), Occupancy::Free).expect("small");
    let way = |floor: &Grid<Occupancy>| {
        let floor = Floor { map: floor, start: [start.pose; 2], clearance: Clearance::PATSY };
        CurveSearch::default().plan(&Ground { terrain, floor: Some(floor) }, &vehicle, &start, &goals).is_ok()
    };
    assert!(way(&floor));
    // Between the corners of the trailer and behind it.
    *floor.get_mut(floor.raster().cell(Point2::new(2.05, 3.05)).expect("inside")).expect("inside") = Occupancy::Unknown;
    assert!(!way(&floor));
}

/// A cable in a corridor that the vehicle gets past, but not its load beside it.
#[test]
fn a_load_may_be_above_what_is_low() {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 100, height: 12 };
    let way = |thing: Occupancy, start: Pose2| {
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        (0..5).for_each(|y| *map.get_mut(Cell::new(50, y)).expect("inside") = thing);
        let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
        let vehicle = CurveDrive { load: LOAD, ..VEHICLE };
        let (_, path, _) = search(&terrain, &vehicle, &at(start, 0.0), &[free(Pose2::new(8.0, 0.75, 0.0))])?;
        Ok(path.points.iter().map(|point| (*point - Point2::new(5.05, 0.45)).norm()).fold(9.0, f32::min))
    };
    let start = Pose2::new(2.0, 0.6, 0.0);
    assert_eq!(way(Occupancy::Occupied, start), Err(NoPath::Unreachable));
    let nearest = way(Occupancy::Low, start).expect("a way");
    assert!(nearest > 0.2, "the vehicle drives over it: {nearest} m");
}

#[test]
fn it_does_not_drive_over_a_hazard_that_is_only_on_the_floor() {
    let map = room();
    let terrain = Terrain { map: &map, costs: None, unknown_is_open: false };
    let (start, goals) = (at(Pose2::new(2.0, 3.0, 0.0), 0.0), [free(Pose2::new(5.0, 3.0, 0.0))]);
    let mut floor = Grid::new(*map.raster(), Occupancy::Free).expect("small");
    let thing = Point2::new(3.15, 3.15);
    *floor.get_mut(floor.raster().cell(thing).expect("inside")).expect("inside") = Occupancy::Occupied;
    let floor = Floor { map: &floor, start: [start.pose; 2], clearance: Clearance::PATSY };
    let ground = Ground { terrain, floor: Some(floor) };
    let way = CurveSearch::default().plan(&ground, &VEHICLE, &start, &goals).expect("a way around it");
    let (mut path, mut back) = (Path::default(), BackPath::default());
    way.first_section(&mut path, &mut back);
    let nearest = path.points.iter().map(|point| (*point - thing).norm()).fold(9.0, f32::min);
    assert!(nearest > 0.3, "{nearest} m");
}

#[test]
fn a_search_that_was_too_long_is_shorter_when_it_is_tried_again() {
    // A large hall, and a goal in a room with an entrance that is too narrow for the load, but not for the tractor.
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 300, height: 300 };
    let mut map = Grid::new(raster, Occupancy::Free).expect("small");
    for i in (0..60).filter(|i| !(20..28).contains(i)) {
        *map.get_mut(Cell::new(i, 60)).expect("inside") = Occupancy::Occupied;
    }
    (0..61).for_each(|j| *map.get_mut(Cell::new(60, j)).expect("inside") = Occupancy::Occupied);
    let ground = Ground { terrain: Terrain { map: &map, costs: None, unknown_is_open: false }, floor: None };
    let vehicle = CurveDrive { load: LOAD, margin: 0.15, ..VEHICLE };
    let goals = [free(Pose2::new(2.4, 2.0, -FRAC_PI_2))];
    let mut search = CurveSearch::default();
    let mut expanded = |x: f32| {
        let way = search.plan(&ground, &vehicle, &at(Pose2::new(x, 20.0, 0.0), 0.0), &goals);
        assert_eq!(way, Err(NoPath::Unreachable));
        search.nodes.len()
    };
    let [first, again, elsewhere] = [20.0, 20.1, 22.0].map(&mut expanded);
    assert!(again < first / 2 && elsewhere > again, "{first}, {again}, {elsewhere}");
}

/// Each cell that is not free is compared with the outline, apart from how the search looks at them.
#[test]
fn ways_between_random_boxes_touch_nothing() {
    let raster = Raster { corner: Point2::default(), resolution: 0.1, width: 100, height: 100 };
    let vehicle = CurveDrive { load: LOAD, backing_gain: 2.5, ..VEHICLE };
    let mut random = Random::new(3);
    let mut found = 0;
    for _ in 0..12 {
        let mut map = Grid::new(raster, Occupancy::Free).expect("small");
        for _ in 0..6 {
            let corner = [0; 2].map(|_| random.uniform(20.0, 76.0) as usize);
            for (x, y) in (0..7).flat_map(|x| (0..7).map(move |y| (x, y))) {
                *map.get_mut(Cell::new(corner[0] + x, corner[1] + y)).expect("inside") = Occupancy::Occupied;
            }
        }
        let (start, goal) = (Pose2::new(1.2, 1.2, 0.8), Pose2::new(8.8, 8.8, random.uniform(-PI, PI)));
        let ground = Ground { terrain: Terrain { map: &map, costs: None, unknown_is_open: false }, floor: None };
        let Ok(way) = CurveSearch::default().plan(&ground, &vehicle, &at(start, start.theta), &[free(goal)]) else {
            continue;
        };
        found += 1;
        let boxes = map.iter().filter(|(_, cell)| **cell != Occupancy::Free).map(|(cell, _)| raster.centre(cell));
        let boxes: Vec<Point2> = boxes.collect();
        let distance = |axes: Axes| {
            let stance = vehicle.outline().at(&axes);
            boxes.iter().map(|place| stance.distance(*place)).fold(f32::INFINITY, f32::min)
        };
        let nearest = places_on(&way, &ground, &vehicle).into_iter().map(distance).fold(f32::INFINITY, f32::min);
        // The points of the outline and the cells that they are in are up to 7 cm from what they stand for.
        assert!(nearest > vehicle.margin - 0.07, "{nearest} m from a box on the way to {goal:?}");
    }
    assert!(found >= 9, "{found} ways");
}

/// Axes of a vehicle at the ends of steps on a way.
fn places_on(way: &Way, ground: &Ground<'_>, vehicle: &CurveDrive) -> Vec<Axes> {
    let room = Room::default();
    let drive = Drive { ground, vehicle, room: &room, footing: None };
    let mut places: Vec<Axes> = way.nodes.iter().map(|node| vehicle.axes(&node.pose, node.trailer)).collect();
    let last = way.nodes[way.nodes.len() - 1];
    let (mut pose, mut trailer) = (last.pose, last.trailer);
    for (curvature, length) in way.end.parts.into_iter().filter(|(_, length)| *length > 0.0) {
        let count = libm::ceilf(length / CHECK);
        for _ in 0..count as u16 {
            let step = drive.arc(&pose, trailer, curvature, length / count, Look::Glance);
            trailer = step.expect("the trailer is not bent too far").1;
            pose = advanced(&pose, curvature, length / count);
            places.push(vehicle.axes(&pose, trailer));
        }
    }
    places
}

#[test]
fn a_gap_that_is_too_narrow_for_a_load_leads_nowhere() {
    // Two halls, and between them a wall of 1 m with a gap of 55 cm: enough for the vehicle alone.
    let raster = Raster { corner: Point2::default(), resolution: 0.05, width: 320, height: 160 };
    let mut map = Grid::new(raster, Occupancy::Free).expect("small");
    for (x, y) in (150..170).flat_map(|x| (0..160).map(move |y| (x, y))).filter(|(_, y)| !(80..91).contains(y)) {
        *map.get_mut(Cell::new(x, y)).expect("inside") = Occupancy::Occupied;
    }
    let ground = Ground { terrain: Terrain { map: &map, costs: None, unknown_is_open: false }, floor: None };
    let start = at(Pose2::new(4.0, 4.275, 0.0), 0.0);
    let mut search = CurveSearch::default();
    let mut plan = |load| {
        let vehicle = CurveDrive { load, backing_gain: 2.5, ..VEHICLE };
        let is_way = search.plan(&ground, &vehicle, &start, &[free(Pose2::new(12.0, 4.275, 0.0))]).is_ok();
        (is_way, search.nodes.len() < 1000)
    };
    assert_eq!([plan([0.0; 2]), plan(LOAD)], [(true, true), (false, true)]);
}

#[test]
fn what_cannot_be_reached_has_a_reason() {
    let mut map = room();
    let start = Pose2::new(2.0, 2.0, 0.0);
    assert_eq!(plan(&map, start, Pose2::new(20.0, 2.0, 0.0)), Err(NoPath::GoalOutside));
    assert_eq!(plan(&map, start, Pose2::new(6.05, 2.0, 0.0)), Err(NoPath::GoalBlocked));
    assert_eq!(plan(&map, Pose2::new(f32::NAN, 2.0, 0.0), start), Err(NoPath::StartOutside));
    assert_eq!(plan(&map, Pose2::new(2.0, 2.0, f32::NAN), start), Err(NoPath::StartBlocked));
    for y in 50..80 {
        *map.get_mut(Cell::new(60, y)).expect("inside") = Occupancy::Occupied;
    }
    assert_eq!(plan(&map, start, Pose2::new(9.0, 2.0, 0.0)), Err(NoPath::Unreachable));
    assert_eq!(plan(&Grid::default(), start, start), Err(NoPath::StartOutside));
}
