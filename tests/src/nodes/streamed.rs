//! Nodes of programs that are looked at while they run.

use apex_nodes::scan::{Pose2, Scan};
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
