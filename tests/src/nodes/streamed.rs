//! Nodes of programs that are looked at while they run.

use apex_messages::{
    geometry_msgs::{Point, Pose, Vector3},
    std_msgs::ColorRGBA,
    visualization_msgs::{Marker, MarkerArray},
};
use apex_nodes::{
    cloud::{CloudPoint, RingCloud},
    scan::{Pose2, Scan},
};
use apex_rt::prelude::*;

/// Counts from one.
#[node]
#[derive(Default)]
pub struct CountUp {
    number: i64,
}

#[node]
impl CountUp {
    fn process(&mut self) -> i64 {
        self.number += 1;
        self.number
    }
}

/// Multiplies numbers, except three. <img src=x onerror=alert(1)>
#[node]
#[derive(Default)]
pub struct TimesFactor {
    /// Factor.
    #[param(range = 0..=9)]
    factor: i64,
}

#[node]
impl TimesFactor {
    fn process(&mut self, number: &i64) -> Result<i64, &'static str> {
        if *number == 3 { Err("three <b>") } else { Ok(number * self.factor) }
    }
}

/// Goes round in a circle of 1 m.
#[node]
pub fn pose_on_circle(number: &i64) -> Pose2 {
    let angle = *number as f32 / 100.0;
    Pose2::new(angle.cos(), angle.sin(), angle)
}

/// Measures two points ahead, from a pose.
#[node]
pub fn scan_ahead(_pose: &Pose2) -> Scan {
    let mut scan = Scan { angle_min: -0.1, angle_increment: 0.2, range_max: 10.0, ..Scan::default() };
    scan.ranges.extend([1.0, 2.0]);
    scan
}

/// Draws a number as a bar: a view of its own. The script in it must not run.
#[node]
pub fn drawn_count(number: &i64) -> String {
    let width = number % 100;
    format!(
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 10'><script>alert(1)</script><rect width='{width}' height='10' fill='teal'/></svg>"
    )
}

/// Sees a wall 3 m ahead, 4 m wide and 2 m high, with 16 rings.
#[node]
pub fn wall_ahead(_pose: &Pose2) -> RingCloud {
    let mut cloud = RingCloud::default();
    cloud.reset(Time::ZERO, 16, 200);
    for (at, point) in cloud.points_mut().iter_mut().enumerate() {
        let (column, ring) = (at / 16, at % 16);
        *point = CloudPoint { x: 3.0, y: 2.0 - column as f32 / 50.0, z: 2.0 - ring as f32 / 8.0, intensity: 0.0 };
    }
    cloud
}

/// Markers of a box 1 m ahead, of a line to it, and of another box, which is removed.
#[node]
pub fn box_ahead(_pose: &Pose2) -> MarkerArray {
    let ahead = Pose { position: Point { x: 1.0, y: 0.0, z: 0.5 }, ..Pose::default() };
    let size = Vector3 { x: 0.4, y: 0.6, z: 1.0 };
    let color = ColorRGBA { r: 1.0, g: 0.0, b: 1.0, a: 1.0 };
    let corner = Marker { r#type: Marker::CUBE, pose: ahead, scale: size, color, ..Marker::default() };
    let line = Marker {
        r#type: Marker::LINE_STRIP,
        points: vec![Point::default(), Point { x: 1.0, y: 0.0, z: 0.0 }],
        ..corner.clone()
    };
    let gone = Marker { action: Marker::DELETE, ..corner.clone() };
    MarkerArray { markers: vec![corner, line, gone] }
}
