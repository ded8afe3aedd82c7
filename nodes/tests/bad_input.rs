//! `bad_input.afg`: clouds without points, of one column, of NaN or of absurd numbers, points with labels of another
//! size, and detections that are late or not numbers give ⊥, a hazard or no person, and no panic.

use apex_macros::graph;
use apex_nodes::{
    cloud::{CloudPoint, Clusters, Columns, HazardKind, Label, Labels, Member, PointCloud},
    persons::{Detections, View},
    scan::{Container, Point2, Pose2},
};
use apex_rt::prelude::*;

graph!("bad_input.afg");

/// Numbers that no camera should send.
const ODD: [f32; 7] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, -1e30, 1e-30, 0.0];

fn cloud(size: (usize, usize), point: impl Fn(usize, usize) -> CloudPoint) -> PointCloud {
    let mut cloud = PointCloud::default();
    cloud.reset(Time::ZERO, size);
    cloud.points_mut().iter_mut().enumerate().for_each(|(i, p)| *p = point(i % size.0, i / size.0));
    cloud
}

/// Point on the floor that a camera 10 cm above it, pitched by 15°, sees in a pixel of 160 × 120.
fn floor(column: usize, row: usize) -> CloudPoint {
    let (y, z) = ((80.0 - column as f32) / 80.0, (60.0 - row as f32) / 200.0);
    let (sin, cos) = 0.261_799_4_f32.sin_cos();
    let x = 0.1 / (sin - z * cos);
    if x > 0.0 && x < 5.0 { CloudPoint { x, y: x * y, z: x * z, intensity: 500.0 } } else { CloudPoint::MISSING }
}

/// Clouds, and if the floor before the robot is seen in them. Where it is not said, either is right.
fn clouds() -> Vec<(String, PointCloud, Option<bool>)> {
    let all = |value: f32| move |_, _| CloudPoint { x: value, y: value, z: value, intensity: value };
    let mut clouds = vec![
        ("a floor".to_owned(), cloud((160, 120), floor), Some(true)),
        ("no point".to_owned(), PointCloud::default(), Some(false)),
        ("no row".to_owned(), cloud((160, 0), floor), Some(false)),
        ("one point".to_owned(), cloud((1, 1), floor), Some(false)),
        ("one column".to_owned(), cloud((1, 120), |_, row| floor(80, row)), Some(false)),
        ("one row".to_owned(), cloud((160, 1), |column, _| floor(column, 60)), Some(false)),
        ("two columns".to_owned(), cloud((2, 120), |column, row| floor(79 + column, row)), Some(false)),
    ];
    for value in ODD {
        clouds.push((format!("all {value}"), cloud((16, 12), all(value)), Some(false)));
        let mixed = |column, row| if (column + row) % 3 == 0 { all(value)(column, row) } else { floor(column, row) };
        clouds.push((format!("floor and {value}"), cloud((160, 120), mixed), None));
        let dark = |column, row| CloudPoint { intensity: value, ..floor(column, row) };
        clouds.push((format!("intensity {value}"), cloud((160, 120), dark), None));
        let across = |column, row| CloudPoint { y: value, ..floor(column, row) };
        clouds.push((format!("y {value}"), cloud((160, 120), across), Some(false)));
        let up = |column, row| CloudPoint { z: value, ..floor(column, row) };
        // With z = 0 it is a ramp.
        let ramp = (value.abs() > 1.0 || value.is_nan()).then_some(false);
        clouds.push((format!("z {value}"), cloud((160, 120), up), ramp));
    }
    clouds
}

fn container(pose: Pose2) -> Container {
    Container { pose, error: 0.0, inliers: 0, outliers: 0, wheels: 2, model: 0 }
}

fn look(look: &mut Look, cloud: &PointCloud, pose: Pose2, expected: Pose2) {
    let inputs = look.inputs();
    inputs.cloud.put(cloud.clone()).expect("room");
    inputs.pose.put(pose).expect("room");
    inputs.expected.put(container(expected)).expect("room");
    look.react(Time::ZERO);
}

#[test]
fn odd_clouds_are_no_floor() {
    let mut kept = Look::new();
    for (name, cloud, is_floor) in clouds() {
        let mut fresh = Look::new();
        look(&mut fresh, &cloud, Pose2::default(), Pose2::new(1.0, 0.0, 0.0));
        let outputs = fresh.outputs();
        let hazard = outputs.hazard.as_ref().map(|hazard| hazard.kind);
        assert!(outputs.container.is_none(), "{name}: a container");
        assert_eq!(outputs.labels.as_ref().map(|l| l.labels.len()), Some(cloud.points().len()), "{name}");
        assert!(is_floor.is_none_or(|is_floor| is_floor == hazard.is_none()), "{name}: {hazard:?}");
        assert!(outputs.hazard.as_ref().is_none_or(|hazard| hazard.position.norm().is_finite()), "{name}");
        // The same instance takes clouds of all sizes in turn.
        look(&mut kept, &cloud, Pose2::default(), Pose2::new(1.0, 0.0, 0.0));
        assert!(kept.outputs().map.is_some(), "{name}");
    }
    let (_, floor, _) = &clouds()[0];
    look(&mut kept, floor, Pose2::default(), Pose2::default());
    assert_ne!(kept.outputs().hazard.as_ref().map(|h| h.kind), Some(HazardKind::NoFloor), "the floor is seen again");
}

#[test]
fn odd_poses_give_nothing_wrong() {
    let (_, floor, _) = &clouds()[0];
    for value in ODD {
        for pose in [Pose2::new(value, 0.0, 0.0), Pose2::new(0.0, value, 0.0), Pose2::new(0.0, 0.0, value)] {
            let mut fresh = Look::new();
            look(&mut fresh, floor, pose, pose);
            let outputs = fresh.outputs();
            assert!(pose.is_usable() || outputs.map.is_none() && outputs.hazard.is_none(), "{pose:?}");
            assert!(outputs.container.is_none(), "{pose:?}");
        }
    }
}

/// Points of a number of columns and rows.
fn columns(width: usize, height: usize) -> Columns {
    let list = |scale: f32| (0..width * height).map(|i| scale * i as f32).collect();
    Columns { height, origin: [0.0; 3], x: list(0.02), y: list(0.001), z: list(0.0), intensity: list(1.0) }
}

fn labels(label: Label, width: usize, height: usize) -> Labels {
    Labels { height, labels: vec![label; width * height] }
}

/// Points, labels and clusters that do not belong together.
fn pairs() -> Vec<(&'static str, Columns, Labels)> {
    let points = columns(6, 5);
    let cut = |cut: fn(&mut Columns)| {
        let mut points = columns(6, 5);
        cut(&mut points);
        points
    };
    let floor = labels(Label::Floor, 6, 5);
    vec![
        ("no label", points.clone(), Labels::default()),
        ("no point", Columns::default(), floor.clone()),
        ("fewer labels", points.clone(), labels(Label::Floor, 5, 5)),
        ("more labels", points.clone(), labels(Label::Obstacle, 7, 5)),
        ("other height", points, labels(Label::Floor, 5, 6)),
        ("no height", Columns { height: 0, ..columns(6, 5) }, Labels { height: 0, ..floor.clone() }),
        ("broken column", Columns { height: 7, ..columns(6, 5) }, Labels { height: 7, ..floor.clone() }),
        (
            "absurd height",
            Columns { height: usize::MAX, ..columns(6, 5) },
            Labels { height: usize::MAX, ..floor.clone() },
        ),
        ("fewer y", cut(|p| p.y.truncate(7)), floor.clone()),
        ("fewer z", cut(|p| p.z.clear()), floor.clone()),
        ("fewer x", cut(|p| p.x.truncate(29)), floor.clone()),
        ("more intensities", cut(|p| p.intensity.push(1.0)), floor),
    ]
}

#[test]
fn points_and_labels_of_different_sizes_give_nothing() {
    for (name, points, labels) in pairs() {
        for count in [points.len(), 30, 0] {
            let mut apart = Apart::new();
            let inputs = apart.inputs();
            inputs.points.put(points.clone()).expect("room");
            inputs.labels.put(labels.clone()).expect("room");
            // Members that the columns do not have.
            let members = vec![Member { point: u32::MAX, cluster: 0 }; count];
            inputs.groups.put(Clusters { clusters: vec![], members, points: count }).expect("room");
            inputs.pose.put(Pose2::default()).expect("room");
            inputs.expected.put(container(Pose2::new(0.3, 0.0, 0.0))).expect("room");
            apart.react(Time::ZERO);
            let outputs = apart.outputs();
            assert!(outputs.edges.is_none() && outputs.dark.is_none(), "{name}: filters");
            assert!(outputs.smoothed.is_none() && outputs.classified.is_none(), "{name}: heights");
            assert!(outputs.floor.is_none() && outputs.hazard.is_none(), "{name}: surface");
            assert!(outputs.clusters.is_none() && outputs.container.is_none(), "{name}: clusters");
        }
    }
}

#[test]
fn odd_and_late_detections_are_no_persons() {
    for value in ODD {
        for (position, view) in [(value, 0.0), (1.0, value)] {
            let mut track = Track::new();
            for step in 0..20 {
                let now = Time::from_millis(100 * step);
                // Every fourth one is late.
                let stamp = if step % 4 == 3 { Time::from_millis(-5000) } else { now };
                let view = View { pose: Pose2::new(view, 0.0, view), angle: view, nearest: view, range: view };
                let positions = [Point2::new(position, 0.5), Point2::new(0.5, position)].into_iter().collect();
                let detections = Detections { stamp, view, positions };
                track.inputs().camera.put(detections.clone()).expect("room");
                track.inputs().legs.put(detections).expect("room");
                track.react(now);
                let persons = track.outputs().persons.clone().expect("a list");
                assert!(
                    persons.iter().all(|p| p.position.x.is_finite() && p.position.y.is_finite()),
                    "{value}: {persons:?}"
                );
            }
        }
    }
}
