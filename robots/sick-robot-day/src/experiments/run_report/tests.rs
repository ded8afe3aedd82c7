use super::*;
use crate::world::contest::{Collision, Delivery, Obstacle, Rivalry};
use apex_nodes::{
    image::Region,
    map::{Raster, Sign},
};
use std::fs;

/// An invented run of two minutes.
pub fn run_report() -> RunReport {
    let arena = Arena::new(3);
    let start = Pose2::new(3.0, -2.0, 2.0);
    let inner = |pose: &Pose2| pose.relative_to(&start);
    let way = |i: i64| {
        let angle = 0.02 * i as f32;
        let place = Point2::polar(3.6 + 0.8 * (3.1 * angle).sin(), angle - 0.588);
        (Time::from_millis(100 * i), Pose2::new(place.x, place.y, angle + 1.0))
    };
    let stations = arena.filling.iter().zip([true, false, true, true]);
    let stations = stations.map(|(station, free)| Station { pose: inner(&station.pose), free }).collect();
    RunReport {
        seed: 3,
        start,
        map: Some(seen(&arena, &start)),
        octagon: Some(island(&arena, &start)),
        stations,
        signs: signs(&arena, &start),
        phases: phases(),
        report: report((0..=1200).map(way).collect()),
        frames: vec![frame("a sign"), frame("nothing")],
        arena,
    }
}

/// One of two cubes came to the right station; the robot caused one of three collisions.
fn report(trajectory: Vec<(Time, Pose2)>) -> Report {
    let delivery = |s, station, cube| Delivery { at: Time::from_secs(s), station, cube };
    let collision = |s, caused| Collision {
        at: Time::from_secs(s),
        place: Point2::default(),
        against: Obstacle::Robot(1),
        caused,
        suffered: !caused,
    };
    Report {
        deliveries: vec![delivery(48, 2, 2), delivery(105, 4, 1)],
        collisions: vec![collision(20, false), collision(50, true), collision(99, false)],
        distance: 34.56,
        rivals: [9, 4, 0].map(|points| Rivalry { points, collisions: 0 }),
        trajectory,
        ..Report::default()
    }
}

/// A map in the frame of the robot: a cell near a wall is occupied, one within the border is free.
fn seen(arena: &Arena, start: &Pose2) -> Grid<Occupancy> {
    let border = arena.border.iter().map(|corner| start.to_inner(*corner));
    let raster = Raster::around(border, 0.5, 0.05);
    let mut map = Grid::new(raster, Occupancy::Unknown).expect("small");
    let cells: Vec<_> = map.iter().map(|(cell, _)| start.to_outer(raster.centre(cell))).collect();
    for (cell, place) in map.cells_mut().iter_mut().zip(cells) {
        if arena.is_free(place, 0.05) {
            *cell = Occupancy::Free;
        } else if arena.world.walls().iter().any(|wall| {
            let (along, from) = (wall.b - wall.a, place - wall.a);
            let part = (from.dot(along) / along.norm_squared()).clamp(0.0, 1.0);
            (from - along.scaled(part)).norm() < 0.05
        }) {
            *cell = Occupancy::Occupied;
        }
    }
    map
}

/// The island, with a small error.
fn island(arena: &Arena, start: &Pose2) -> Octagon {
    let centre = start.to_inner(Point2::new(0.06, 0.04));
    let theta = arena.filling[0].pose.theta - start.theta;
    Octagon { centre, apothem: 1.45, theta }
}

/// The four signs with many sightings, after one with few.
fn signs(arena: &Arena, start: &Pose2) -> Signs {
    let mut signs = Signs::new();
    for (station, number) in arena.delivery.iter().zip(1..) {
        let pose = station.pose.relative_to(start);
        let mut sign = Sign::new(number, &pose);
        for i in 0..20_u8 {
            let (sin, cos) = (0.7 * f32::from(i)).sin_cos();
            let noise = Pose2::new(0.05 * sin, 0.15 * cos + 0.05 * sin, 0.0);
            sign.add(&pose.compose(&noise));
        }
        signs.push(sign).expect("room for four");
        if number == 1 {
            signs.push(Sign::new(3, &Pose2::new(-1.0, 4.0, 1.0))).expect("room for five");
        }
    }
    signs
}

fn phases() -> Vec<Phase> {
    let phase = |name: &str, from, until| Phase {
        name: name.to_owned(),
        from: Time::from_secs(from),
        until: Time::from_secs(until),
    };
    vec![
        phase("fetch", 20, 50),
        phase("explore", 0, 20),
        phase("fetch / position", 30, 42),
        phase("fetch", 60, 110),
        phase("fetch / position", 90, 100),
        phase("deliver", 44, 60),
    ]
}

fn frame(name: &str) -> Frame {
    let image = image::ImageBuffer::from_fn(320, 240, |x, y| image::Luma([(x / 4 + y / 3) as u8])).into();
    let region = Region { left: 100, top: 90, width: 40, height: 60, area: 1 };
    Frame { name: name.to_owned(), image, marks: vec![Mark::Box(region, "4".to_owned()), Mark::Cross([200.0, 50.0])] }
}

#[test]
fn the_table_tells_how_it_ended() {
    let expected = "\
Run of seed 3: 2:00 min
points                     1
penalties                  1
deliveries                 2
collisions caused          1
collisions suffered        2
points of rivals     9, 4, 0
distance driven         34.6 m

phase                                                s    share   count
explore                                           20.0     17 %       1
fetch                                             80.0     67 %       2
fetch / position                                  22.0     18 %       2
deliver                                           16.0     13 %       1";
    assert_eq!(run_report().table(), expected);
}

#[test]
fn tables_fit_and_need_nothing() {
    let mut run_report = run_report();
    run_report.phases.push(Phase { name: "so / ".repeat(40), from: Time::ZERO, until: Time::from_secs(99_999) });
    assert!(run_report.table().lines().all(|line| line.chars().count() <= 80), "{}", run_report.table());
    (run_report.phases, run_report.report) = (vec![], Report::default());
    assert!(run_report.table().contains("Run of seed 3: 0:00 min"), "{}", run_report.table());
}

#[test]
fn robots_deliver_where_they_are() {
    let run_report = run_report();
    let expected = |i: usize| Some(run_report.report.trajectory[i].1.position());
    assert_eq!(run_report.place(Time::from_millis(4_800)), expected(48));
    assert_eq!(run_report.place(Time::from_secs(9999)), expected(1200));
}

#[test]
fn pictures_are_written_and_nothing_is_overwritten() {
    let folder = std::env::temp_dir().join(format!("apex-story-{}", std::process::id()));
    let image_writer = ImageWriter::new(&folder).expect("a new folder");
    let run_report = run_report();
    run_report.write(&image_writer).expect("room for it");
    let again = run_report.write(&image_writer).expect_err("all is there");
    let mut names: Vec<_> = fs::read_dir(&folder).expect("a folder").flatten().map(|file| file.file_name()).collect();
    names.sort();
    let size = image::image_dimensions(folder.join("map.png"));
    fs::remove_dir_all(&folder).expect("it is ours");
    assert_eq!(names, ["activity.png", "frame-01.png", "frame-02.png", "map.png"]);
    assert_eq!(size.ok(), Some((1200, 1200)));
    assert!(again.contains("map.png"), "{again}");
}
