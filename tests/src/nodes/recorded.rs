//! Sources of unpredictable tokens, and nodes that process them.

use apex_nodes::{
    map::{Grid, Occupancy, Raster},
    nav::{Path, Twist},
    scan::{Point2, Pose2, Scan},
};
use apex_rt::{Ctx, Event, Out, Outputs, node};
use serde::{Deserialize, Serialize};
use std::time::SystemTime;

/// A number that differs between calls and between runs.
fn chance() -> u64 {
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default();
    let mixed = (now.as_nanos() as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    mixed ^ (mixed >> 29)
}

/// An unpredictable number in 0..1.
#[node]
pub fn noise() -> f64 {
    chance() as f64 / u64::MAX as f64
}

/// Ranges, some of which are NaN with bits of their own.
#[node]
pub fn ranges() -> Vec<f32> {
    let odd = f32::from_bits(0x7fc0_0000 | (chance() as u32 & 0xffff));
    vec![chance() as f32, odd, f32::INFINITY, -0.0]
}

/// A reading of a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Reading {
    /// No value.
    Empty,
    /// A value.
    Value { number: u64, text: String },
}

/// Several outputs, one of which may be absent.
#[derive(Outputs)]
pub struct Readings {
    /// Always sent.
    pub reading: Reading,
    /// Sent for odd numbers.
    pub odd: Option<u64>,
}

/// A device with several outputs.
#[node]
pub fn device() -> Readings {
    let number = chance();
    let reading =
        if number.is_multiple_of(3) { Reading::Empty } else { Reading::Value { number, text: number.to_string() } };
    Readings { reading, odd: (!number.is_multiple_of(2)).then_some(number) }
}

/// A device that writes its output in place, has an event, fails occasionally, and counts requests.
#[node]
#[derive(Default)]
pub struct Moody {
    /// Number of calls; a replay calls nothing.
    pub calls: u32,
    asked: u64,
}

#[node]
impl Moody {
    fn process(&mut self, level: &mut Out<u64>, alarm: Event<u64>) -> Result<(), String> {
        self.calls += 1;
        let number = chance();
        level.set(number);
        if number.is_multiple_of(5) {
            alarm.emit(number);
        }
        if number.is_multiple_of(7) { Err(format!("no more than {number}")) } else { Ok(()) }
    }

    /// Answers with an unpredictable number.
    #[slot]
    fn ask(&mut self, question: &u64, answer: Event<u64>) {
        self.calls += 1;
        self.asked += question & 1;
        answer.emit(chance());
    }
}

/// Mean of all values, plus an offset.
#[node]
#[derive(Default)]
pub struct Mean {
    /// Number to add.
    #[param(default = 0.0)]
    offset: f64,
    sum: f64,
    count: f64,
}

#[node]
impl Mean {
    fn process(&mut self, value: &f64) -> f64 {
        self.sum += value;
        self.count += 1.0;
        self.sum / self.count + self.offset
    }
}

/// Checksum of all ranges as bits, including NaN, infinity and −0.
#[node]
pub fn bits(ranges: &Vec<f32>) -> u64 {
    ranges.iter().fold(0, |sum: u64, range| sum.rotate_left(7) ^ u64::from(range.to_bits()))
}

/// Passes values on.
#[node]
pub fn same<T: Clone>(value: &T) -> T {
    value.clone()
}

/// Records tokens in order.
#[node]
#[derive(Default)]
pub struct Diary {
    /// The entries.
    pub entries: Vec<String>,
}

#[node]
impl Diary {
    #[slot]
    fn number(&mut self, number: &u64, ctx: &Ctx, told: Event<String>) {
        self.entries.push(format!("{}: {number}", ctx.now()));
        told.emit(format!("{number}"));
    }

    #[slot]
    fn reading(&mut self, reading: &Reading) {
        self.entries.push(format!("{reading:?}"));
    }

    #[slot]
    fn failure(&mut self, failure: &apex_rt::Failure) {
        self.entries.push(failure.text().to_owned());
    }

    #[slot]
    fn late(&mut self, told: Event<String>) {
        self.entries.push("late".to_owned());
        told.emit("late".to_owned());
    }

    #[slot]
    fn text(&mut self, text: &String) {
        self.entries.push(text.clone());
    }
}

/// Takes any token.
#[node]
pub fn swallow<T>(value: &T) {
    let _ = value;
}

/// The time in milliseconds, and a half.
#[node]
pub fn count(ctx: &Ctx) -> f64 {
    ctx.now().as_secs_f64() * 1e3 + 0.5
}

/// A scan with odd ranges.
#[node]
pub fn eyes(ctx: &Ctx) -> Scan {
    let mut scan = Scan { stamp: ctx.now(), angle_increment: 0.1, ..Scan::default() };
    scan.ranges.extend([1.0, f32::NAN, f32::INFINITY]);
    scan
}

/// A pose.
#[node]
pub fn pose() -> Pose2 {
    Pose2::new(1.5, -2.0, 0.5)
}

/// A word.
#[node]
pub fn word() -> String {
    "zwölf".to_owned()
}

/// Raster of all maps.
const RASTER: Raster = Raster { corner: Point2::new(-1.5, 0.25), resolution: 0.5, width: 3, height: 2 };

/// A map.
#[node]
pub fn chart(map: &mut Out<Grid<Occupancy>>) {
    use Occupancy::{Free, Occupied, Unknown};
    let map = map.get_mut();
    if map.reset(RASTER, Free).is_ok() {
        map.cells_mut().copy_from_slice(&[Free, Occupied, Unknown, Free, Free, Occupied]);
    }
}

/// A map of numbers.
#[node]
pub fn heights(ctx: &Ctx, map: &mut Out<Grid<f32>>) {
    let map = map.get_mut();
    if map.reset(RASTER, ctx.now().as_secs_f64() as f32).is_ok() {
        map.cells_mut()[1..4].copy_from_slice(&[f32::NAN, f32::INFINITY, -0.0]);
    }
}

/// A path around a corner.
#[node]
pub fn way(path: &mut Out<Path>) {
    let path = path.get_mut();
    path.points.clear();
    path.points.extend([Point2::new(0.0, 0.5), Point2::new(2.0, 0.5), Point2::new(2.0, 1.5)]);
    path.heading = -0.25;
}

/// A movement.
#[node]
pub fn twist() -> Twist {
    Twist::new(0.5, -0.25, 1.5)
}

/// Twelve unpredictable numbers.
#[node]
pub fn dozen() -> [u64; 12] {
    core::array::from_fn(|i| chance() ^ i as u64)
}

/// Combines two numbers into one.
#[node]
pub fn pairs(numbers: &[u64; 2]) -> u64 {
    numbers[0] ^ numbers[1].rotate_left(1)
}
