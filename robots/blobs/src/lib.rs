//! Nodes of this example: a simulated camera above a belt, and the number of blobs.

use apex_nodes::{
    image::{Blobs, ColorImage},
    math::Random,
};
use apex_rt::{
    SimClock, drive_with,
    prelude::*,
    record::{Recorder, Tap, WhenFull},
};
use image::Rgb;
use std::{io, path::Path};

/// Width and height of the images, in pixels.
const SIZE: (u32, u32) = (320, 240);
/// Distance between parts along the belt, in pixels.
const SPACING: f64 = 70.0;
/// Velocity of the belt, in pixels per second.
const VELOCITY: f64 = 40.0;
/// Difference between a part and the belt, of 255.
const CONTRAST: f64 = 45.0;
/// Standard deviation of the noise of a pixel, of 255.
const NOISE: f64 = 5.0;

/// Round part on the belt, in pixels of the image.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Column of its centre.
    pub u: f64,
    /// Row of its centre.
    pub v: f64,
    /// Radius.
    pub radius: f64,
}

/// Returns the parts that the camera sees completely or in part at a time.
pub fn parts(time: Time) -> impl Iterator<Item = Part> {
    let way = VELOCITY * time.as_secs_f64();
    let first = ((way - f64::from(SIZE.0)) / SPACING).floor() as i64 - 1;
    (first..first + 8).map(move |number| {
        let mut random = Random::new(number as u64);
        let (v, radius) = (30.0 + 180.0 * random.unit(), 8.0 + 6.0 * random.unit());
        Part { u: way - SPACING * number as f64, v, radius }
    })
}

/// Simulated camera above a belt with dark parts. The light is much brighter on the right, so that no threshold fits
/// the whole image. Triggers `ended` after `length`.
#[node]
#[derive(Debug)]
pub struct Belt {
    /// Time after which it ends.
    #[param(unit = "s", default = 10.0, range = 0.1..=3600.0)]
    length: f64,
    random: Option<Random>,
}

#[node]
impl Belt {
    fn process(&mut self, ctx: &Ctx, image: &mut Out<ColorImage>, ended: Event<()>) {
        let random = self.random.get_or_insert_with(|| Random::new(1));
        let image = image.get_mut();
        image.reset(ctx.now(), SIZE);
        for (x, y, pixel) in image.pixels.enumerate_pixels_mut() {
            let (x, y) = (f64::from(x), f64::from(y));
            let covers = |part: Part| (part.radius + 0.5 - (x - part.u).hypot(y - part.v)).clamp(0.0, 1.0);
            let part = parts(ctx.now()).map(covers).fold(0.0, f64::max);
            let light = 90.0 + 140.0 * x / f64::from(SIZE.0) - CONTRAST * part;
            let value = (light + NOISE * random.standard_normal()).clamp(0.0, 255.0) as u8;
            // The belt is green.
            *pixel = Rgb([value, value.saturating_add(15), value.saturating_sub(10)]);
        }
        if ctx.now().as_secs_f64() >= self.length {
            ended.emit(());
        }
    }
}

/// Number of blobs.
#[node]
pub fn count(blobs: &Blobs) -> f64 {
    blobs.len() as f64
}

apex_macros::graph!("../blobs.afg");

/// Makes the recording, in simulated time: a film of `length` s. An existing file is kept: the new one gets a number.
///
/// # Errors
/// The file cannot be written.
pub fn film(path: &Path, length: f64) -> io::Result<()> {
    let mut robot = Film::new();
    robot.set_param("belt.length", length).map_err(|error| io::Error::other(error.to_string()))?;
    let mut tap = Tap::Record(Recorder::to_file::<Film>(path, WhenFull::Wait)?);
    drive_with(robot, SimClock::until(Time::MAX), &mut tap);
    if let Tap::Record(recorder) = tap {
        recorder.finish()?;
    }
    Ok(())
}
