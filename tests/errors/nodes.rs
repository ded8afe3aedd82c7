//! The nodes of the source files, with one example for each kind of port and parameter.
use apex_rt::prelude::*;
use core::time::Duration;

pub struct Scan;
pub struct Image;

pub const LIMIT: u64 = 3;

/// A struct that is not a node.
pub struct Plain;

/// A source.
#[node]
#[derive(Default)]
pub struct Ramp {
    next: u64,
}

#[node]
impl Ramp {
    fn process(&mut self) -> u64 {
        self.next += 1;
        self.next
    }
}

/// A source of another type.
#[node]
pub fn camera() -> Image {
    Image
}

/// A source of two outputs of different types.
#[node]
pub fn lidar(scan: &mut Out<Scan>, count: &mut Out<u64>) {
    scan.set(Scan);
    count.set(0);
}

/// A source of two outputs of the same type.
#[node]
pub fn pair(low: &mut Out<u64>, high: &mut Out<u64>) {
    low.set(0);
    high.set(1);
}

/// A source of lists.
#[node]
pub fn list() -> Vec<u64> {
    vec![1, 2]
}

#[node]
pub fn double(x: &u64) -> u64 {
    x * 2
}

/// Sum of any number of values.
#[node]
pub fn total<const N: usize>(values: [&u64; N]) -> u64 {
    values.into_iter().sum()
}

#[node]
pub fn sum(a: &u64, b: &u64) -> u64 {
    a + b
}

#[node]
pub fn maybe_sum(a: &u64, b: Option<&u64>) -> u64 {
    a + b.unwrap_or(&0)
}

/// Takes two tokens of different types.
#[node]
pub fn label(image: &Image, scan: &Scan) -> Image {
    let _ = (image, scan);
    Image
}

#[node]
pub fn show_all(list: &Vec<u64>) {
    let _ = list;
}

#[node]
pub fn show(x: &u64) {
    let _ = x;
}

#[node]
pub fn show_image(image: &Image) {
    let _ = image;
}

#[node]
pub fn mul(x: &u64, #[param] k: u64) -> u64 {
    x * k
}

/// Parameters of all kinds.
#[allow(clippy::too_many_arguments, reason = "one of each kind")]
#[node]
pub fn tune(
    x: &u64,
    #[param(unit = "m", default = 0.15, range = 0.0..=2.0)] gap: f32,
    #[param(default = 1.0, range = 0.0..1.0)] ratio: f64,
    #[param(default = 3)] count: u8,
    #[param(default = 1.0)] wait: Duration,
    #[param(default = true)] fast: bool,
    #[param(default = "")] frame: &'static str,
    #[param(default = [0.0, 0.0])] offset: [f32; 2],
) -> u64 {
    let _ = (gap, ratio, count, wait, fast, frame, offset);
    *x
}

/// Takes two tokens per firing.
#[node]
pub fn halve(x: &[u64; 2]) -> u64 {
    x[0] + x[1]
}

/// Sends two tokens per firing.
#[node]
pub fn twice(x: &u64) -> [u64; 2] {
    [*x, *x]
}

/// Takes so many tokens that no iteration is possible.
#[node]
pub fn thin(x: &[u64; 100000]) -> u64 {
    x[0]
}

#[node]
#[derive(Default)]
pub struct Base {
    #[param(unit = "m/s", default = 1.0, range = 0.0..=2.5)]
    speed: f32,
}

#[node]
impl Base {
    fn process(&mut self, goal: &u64, arrived: Event<u64>) {
        let _ = self.speed;
        arrived.emit(*goal);
    }

    #[slot]
    fn stop(&mut self) {}
}

/// A struct without `process` and without slots.
#[node]
#[derive(Default)]
pub struct Idle {
    _state: u64,
}

/// The type of its tokens follows from its connections.
#[node]
pub struct Latch<T> {
    last: Option<T>,
}

#[node]
impl<T: Clone> Latch<T> {
    fn process(&mut self, x: Option<&T>) -> Option<T> {
        self.last = x.cloned().or(self.last.take());
        self.last.clone()
    }
}

/// Looks for something that may not be there.
#[node]
#[derive(Default)]
pub struct Search;

#[node]
impl Search {
    #[slot]
    fn begin(&mut self, found: Event<u64>, #[failure] not_found: Event<()>) {
        found.emit(1);
        not_found.emit(());
    }
    #[on_activate]
    fn look_around(&mut self) {}
}

/// A filter.
#[node]
pub fn maybe(x: &u64) -> Option<u64> {
    (*x > 1).then_some(*x)
}

/// Two nodes with the same name.
pub mod left {
    use super::*;

    #[node]
    pub fn twin() -> u64 {
        0
    }
}

pub mod right {
    use super::*;

    #[node]
    pub fn twin() -> u64 {
        1
    }
}

/// Passes tokens on.
#[node]
#[derive(Default)]
pub struct Pass;

#[node]
impl Pass {
    #[slot]
    fn put(&mut self, value: &u64, sent: Event<u64>) {
        sent.emit(*value);
    }
}

/// Passes the tokens of its slot on by one of two events.
#[node]
#[derive(Default)]
pub struct Turn;

#[node]
impl Turn {
    #[slot]
    fn s(&mut self, x: &u64, l: Event<u64>, r: Event<u64>) {
        if *x > 1 { l.emit(*x) } else { r.emit(*x) }
    }
}

/// Removes activity.
#[node]
#[deactivates]
#[derive(Default)]
pub struct Calm;

#[node]
impl Calm {
    #[slot]
    fn s(&mut self, x: &u64, e: Event<u64>) {
        e.emit(*x);
    }
}

/// Has only a parameter.
#[node]
pub struct Gain {
    #[param(default = 2)]
    k: u64,
}

#[node]
impl Gain {
    fn process(&mut self, x: &u64) -> u64 {
        x * self.k
    }
}

/// Is notified of absent tokens.
#[node]
pub struct Patient {
    #[param(default = 2)]
    k: u64,
}

#[node]
impl Patient {
    fn process(&mut self, x: &u64) -> u64 {
        x * self.k
    }
    #[no_message]
    fn missing(&mut self) {}
}

/// Sums numbers and reports the sums.
#[node]
#[derive(Default)]
pub struct Tell {}

#[node]
impl Tell {
    fn process(&mut self, x: &u64, y: &u64, done: Event<u64>) -> u64 {
        done.emit(x + y);
        x + y
    }
}

/// Passes tokens of any type on.
#[node]
pub struct Repeat<T> {
    _last: Option<T>,
}

#[node]
impl<T: Clone> Repeat<T> {
    #[slot]
    fn put(&mut self, value: &T, sent: Event<T>) {
        sent.emit(value.clone());
    }
}

/// Sends a static string.
#[node]
pub fn word(x: &u64) -> Option<&'static str> {
    (*x > 1).then_some("word")
}

/// Takes a static string.
#[node]
pub fn read(word: &&'static str) {
    let _ = word;
}

#[derive(Debug, Clone, Copy, PartialEq, Default, Units)]
pub struct Place {
    #[unit("m")]
    pub x: f32,
    #[unit("m")]
    pub y: f32,
}

#[node]
pub fn keep(#[param] place: Place) -> Place {
    place
}

#[node]
pub fn show_place(place: &Place) {
    let _ = place;
}

/// A struct node with parameters, one of which is a seed.
#[node]
pub struct Smooth {
    #[param(default = 0.5, range = 0.0..=1.0)]
    weight: f32,
    #[param(unit = "m", default = 0.1)]
    gap: f32,
    #[param(default = 5, range = 1..50)]
    window: u32,
    #[param(default = 1.0)]
    hold: Duration,
    #[param(default = true)]
    fast: bool,
    #[param(default = 1)]
    seed: u64,
}

#[node]
impl Smooth {
    fn process(&mut self, x: &u64) -> f64 {
        *x as f64
    }
}

/// A place in some frame.
#[derive(Debug, Clone, Default)]
pub struct Spot;

/// Passes tokens on as they are.
#[node]
pub fn kept<T: Clone + Send>(token: &T) -> T {
    token.clone()
}

/// Something that can be turned.
pub trait Turned {
    /// Turns it.
    fn turn(&self) -> Self;
}

impl Turned for Spot {
    fn turn(&self) -> Self {
        Self
    }
}

/// May turn tokens.
#[node]
pub fn turned<T: Turned>(token: &T) -> T {
    token.turn()
}

/// Finds the place beside another one, as seen from the same place.
#[node]
#[keeps_frame]
pub fn beside(spot: &Spot) -> Spot {
    spot.clone()
}

/// Takes the first of some.
#[node]
pub fn first_of<T: Clone, const N: usize>(tokens: [Option<&T>; N]) -> Option<T> {
    tokens.into_iter().flatten().next().cloned()
}
