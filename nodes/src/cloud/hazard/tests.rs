use super::*;
use crate::cloud::columns::tests::columns;
use apex_rt::Construct;

fn node() -> HazardMap {
    HazardMap::construct((4.0, 0.1, 0.92, 0.6, 0.0, 0.0, 2.0, 0.0, 0.5, 0.4, 1.0, 0.4, PI, 1.0, 0.2))
}

/// Floor from 0.3 m to `until`, across 1.2 m, with an optional obstacle at this x.
fn see(node: &mut HazardMap, until: f32, obstacle: Option<f32>, pose: &Pose2) -> (Option<Hazard>, usize) {
    let mut points = vec![];
    for column in 0..25 {
        for row in 0..20 {
            let x = 0.3 + 0.1 * (19 - row) as f32;
            points.push([if x <= until { x } else { f32::NAN }, 0.6 - 0.05 * column as f32, 0.0, 1.0]);
        }
    }
    let (points, mut labels) = columns(20, &points);
    let is_there = |x: f32| obstacle.is_some_and(|at| (x - at).abs() < 0.01);
    for (label, x) in labels.labels.iter_mut().zip(&points.x).filter(|(label, _)| label.is_valid()) {
        *label = if is_there(*x) { Label::Obstacle } else { Label::Floor };
    }
    let (mut map, mut hazard) = (Out::new(), Out::new());
    node.process(&points, &labels, pose, None, None, None, &mut map, &mut hazard);
    let map = map.get().expect("a map");
    (hazard.get().copied(), map.cells().iter().filter(|c| **c == Occupancy::Occupied).count())
}

#[test]
fn an_obstacle_is_low_up_to_a_height() {
    let kind_of = |height: f32| {
        let (mut node, mut map) = (HazardMap { low: 0.06, ..node() }, Out::new());
        let points: Vec<[f32; 4]> = (0..100).map(|i| [1.0, 0.01 * (i % 10) as f32, height, 1.0]).collect();
        let (points, mut labels) = columns(10, &points);
        labels.labels.fill(Label::Obstacle);
        for _ in 0..8 {
            map = Out::new();
            let (pose, mut hazard) = (Pose2::default(), Out::new());
            node.process(&points, &labels, &pose, None, None, None, &mut map, &mut hazard);
        }
        *map.get().expect("a map").at(Point2::new(1.0, 0.05)).expect("inside")
    };
    assert_eq!([0.01, 0.05, 0.1].map(kind_of), [Occupancy::Low, Occupancy::Low, Occupancy::Occupied]);
}

#[test]
fn a_floor_without_hazards_is_free() {
    assert_eq!(see(&mut node(), 2.0, None, &Pose2::default()), (None, 0));
}

#[test]
fn an_obstacle_counts_when_it_is_seen_again_and_is_remembered() {
    let (mut node, pose) = (node(), Pose2::default());
    assert_eq!(see(&mut node, 2.0, Some(0.8), &pose).1, 0, "a single detection");
    for _ in 0..5 {
        see(&mut node, 2.0, Some(0.8), &pose);
    }
    let (hazard, occupied) = see(&mut node, 2.0, Some(0.8), &pose);
    let hazard = hazard.expect("an obstacle");
    assert!(hazard.kind == HazardKind::Obstacle && (hazard.position.x - 0.8).abs() < 0.11 && occupied > 5);
    // The robot drives on and is now before it, looking at a free floor beyond.
    let (hazard, still) = see(&mut node, 0.2, None, &Pose2::new(0.35, 0.0, 0.0));
    assert!(hazard.is_some_and(|h| h.position.x < 0.6) && still == occupied);
}

#[test]
fn near_obstacles_are_kept() {
    let left = |kept, place| {
        let (mut node, pose) = (HazardMap { kept, threshold: 0.5, ..node() }, Pose2::default());
        for obstacle in [Some(place); 5].into_iter().chain([None; 5]) {
            see(&mut node, 2.0, obstacle, &pose);
        }
        see(&mut node, 2.0, None, &pose).1
    };
    assert!(left(1.0, 0.8) > 5);
    assert_eq!([left(0.5, 0.8), left(1.0, 1.5)], [0, 0]);
}

#[test]
fn near_floor_before_nothing_is_missing() {
    let occupied = |sure, until| {
        let (mut node, pose) = (HazardMap { sure, ..node() }, Pose2::default());
        [0; 3].map(|_| see(&mut node, until, None, &pose).1)
    };
    let [first, second, third] = occupied(1.2, 0.7);
    assert!(first == 0 && second > 10 && third >= second, "{first} {second} {third}");
    assert_eq!([occupied(0.0, 0.7), occupied(1.2, 1.5)], [[0; 3]; 2]);
}

#[test]
fn obstacles_are_forgotten_on_demand() {
    let (mut node, pose) = (node(), Pose2::default());
    see(&mut node, 2.0, None, &pose);
    for _ in 0..5 {
        see(&mut node, 2.0, Some(0.8), &pose);
    }
    assert!(see(&mut node, 0.2, None, &pose).1 > 0);
    node.forget();
    assert_eq!(see(&mut node, 0.2, None, &pose), (None, 0));
}

#[test]
fn a_missing_floor_is_a_hazard() {
    let (hazard, _) = see(&mut node(), 0.7, None, &Pose2::default());
    let hazard = hazard.expect("no floor");
    assert!(hazard.kind == HazardKind::NoFloor && hazard.position.x > 0.7 && hazard.position.x < 0.9);
}

#[test]
fn what_the_scanner_sees_does_not_count() {
    let mut scan = Scan { angle_min: -0.2, angle_increment: 0.1, range_max: 10.0, ..Scan::default() };
    scan.ranges.extend([5.0, 5.0, 1.1, 5.0, 5.0]);
    let seen = |x, y| is_scanned(&scan, Point2::new(x, y));
    assert!(seen(1.0, 0.0) && seen(1.3, 0.05) && seen(5.1, 1.0));
    assert!(!seen(0.7, 0.0) && !seen(2.0, 0.0) && !seen(1.0, 0.4) && !seen(-1.1, 0.0));
    assert!(!is_scanned(&Scan::default(), Point2::new(1.0, 0.0)));
}

#[test]
fn a_brink_is_occupied() {
    // One column with floor up to 0.7 m, and far below it beyond.
    let cloud: Vec<[f32; 4]> = (0..20).map(|row| [0.3 + 0.1 * (19 - row) as f32, 0.0, 0.0, 1.0]).collect();
    let (points, mut labels) = columns(20, &cloud);
    for (label, x) in labels.labels.iter_mut().zip(&points.x) {
        *label = if *x < 0.75 { Label::Floor } else { Label::Below };
    }
    let (mut map, mut hazard) = (Out::new(), Out::new());
    let mut node = node();
    let mut look = || {
        node.process(&points, &labels, &Pose2::default(), None, None, None, &mut map, &mut hazard);
        let map = map.get().expect("a map");
        let occupied = map.iter().filter(|(_, cell)| **cell == Occupancy::Occupied);
        occupied.map(|(cell, _)| map.raster().centre(cell).x).collect::<Vec<f32>>()
    };
    assert!(look().is_empty(), "one cloud may be wrong");
    let ahead = look();
    let map = map.get().expect("a map");
    assert!(!ahead.is_empty() && ahead.iter().all(|x| (0.7..0.9).contains(x)), "{ahead:?}");
    assert_eq!(map.at(Point2::new(0.55, 0.0)), Some(&Occupancy::Free));
}

#[test]
fn persons_are_no_obstacles_and_the_robot_stands_on_floor() {
    let mut node = node();
    let (points, mut labels) = columns(4, &[[0.8, 0.0, 0.1, 1.0]; 4]);
    labels.labels.fill(Label::Obstacle);
    let mut at = |persons: Option<&Persons>| {
        let (mut map, mut hazard) = (Out::new(), Out::new());
        for _ in 0..9 {
            node.process(&points, &labels, &Pose2::default(), None, persons, None, &mut map, &mut hazard);
        }
        let map = map.get().expect("a map");
        [(0.8, 0.0), (0.1, 0.1), (0.3, 0.3)].map(|(x, y)| map.at(Point2::new(x, y)).copied().expect("inside"))
    };
    let person = crate::persons::Person { position: Point2::new(1.0, 0.2), ..Default::default() };
    let [unknown, free] = [Occupancy::Unknown, Occupancy::Free];
    // Who stands there stands on floor.
    assert_eq!(at(Some(&core::iter::once(person).collect())), [free, free, unknown]);
    assert_eq!(at(None), [Occupancy::Occupied, free, unknown]);
}

#[test]
fn there_is_floor_where_the_vehicle_is_switched_on_and_where_it_drives() {
    let (points, labels) = columns(1, &[[f32::NAN; 4]]);
    let mut node = node();
    let mut at = |x: f32, places: [f32; 4]| {
        let (mut map, mut hazard) = (Out::new(), Out::new());
        let [pose, trailer] = [x, x - 0.7].map(|x| Pose2::new(x, 0.0, 0.0));
        node.process(&points, &labels, &pose, None, None, Some(&trailer), &mut map, &mut hazard);
        let map = map.get().expect("a map");
        places.map(|x| map.at(Point2::new(x, 0.0)) == Some(&Occupancy::Free))
    };
    assert_eq!(at(0.05, [-1.0, -0.3, 0.35, 0.55]), [true, true, true, false]);
    assert_eq!(at(0.55, [-1.0, 0.35, 0.65, 0.85]), [true, true, true, false]);
}

/// One cloud that was wrong held the vehicle where it stood.
#[test]
fn where_the_vehicle_stands_one_cloud_is_not_believed() {
    let mut node = node();
    node.floor.follow(Point2::default(), node.size, node.resolution);
    let mut at_feet = |ground: Ground| {
        let place = Point2::new(0.1, 0.1);
        let index = node.floor.index(place).expect("inside");
        *node.floor.get_mut(index) = ground;
        node.stand(Point2::default(), 0.25);
        node.floor.get(index)
    };
    assert_eq!(at_feet(Ground::Doubtful(1)), Ground::Floor);
    assert_eq!(at_feet(Ground::Missing), Ground::Missing);
}

#[test]
fn floor_beside_the_view_is_not_missing() {
    // The near corners of the area are 27° from straight ahead, and the floor is seen up to 0.45 m.
    let kind = |view_angle: f32| {
        let mut node = HazardMap { far: 0.5, view_angle, ..node() };
        see(&mut node, 0.45, None, &Pose2::default()).0.map(|hazard| hazard.position.y)
    };
    assert!(kind(PI).is_some_and(|y| y < -0.19));
    assert!(kind(0.6).is_some_and(|y| y > -0.19));
}

#[test]
fn bad_inputs_give_nothing() {
    let (mut map, mut hazard) = (Out::new(), Out::new());
    let (points, labels) = columns(2, &[[1.0; 4]; 4]);
    let mut node = node();
    node.process(&points, &Labels::default(), &Pose2::default(), None, None, None, &mut map, &mut hazard);
    node.process(&points, &labels, &Pose2::new(f32::NAN, 0.0, 0.0), None, None, None, &mut map, &mut hazard);
    assert!(map.get().is_none() && hazard.get().is_none());
    node.process(&Columns::default(), &Labels::default(), &Pose2::default(), None, None, None, &mut map, &mut hazard);
    assert_eq!(hazard.get().map(|h| h.kind), Some(HazardKind::NoFloor));
}
