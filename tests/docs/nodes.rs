use apex_rt::prelude::*;

/// Passes values on while they change by less than `step`.
#[node]
#[derive(Default)]
pub struct Steady {
    /// Largest change.
    #[param(unit = "m", default = 0.1, range = 0.0..=1.0)]
    step: f32,
    last: Option<f32>,
}

#[node]
impl Steady {
    fn process(&mut self, x: &f32) -> Option<f32> {
        let steady = self.last.is_none_or(|last| (x - last).abs() <= self.step);
        self.last = Some(*x);
        steady.then_some(*x)
    }
}

/// Larger of two values.
#[node]
pub fn larger<T: PartialOrd + Copy>(a: &T, b: &T) -> T {
    if a < b { *b } else { *a }
}

/// Largest of any number of values: `[a, b, c] -> largest() -> y`.
#[node]
pub fn largest<T: PartialOrd + Copy, const N: usize>(values: [&T; N]) -> T {
    values.into_iter().fold(*values[0], |most, value| if most < *value { *value } else { most })
}

/// Counts down while it is active, by one per firing, and triggers `done` at zero.
#[node]
pub struct Countdown {
    /// First number after the activation.
    #[param(default = 3)]
    from: u32,
    left: u32,
}

#[node]
impl Countdown {
    fn process(&mut self, ctx: &Ctx, done: Event<Time>) {
        if !ctx.active() || self.left == 0 {
            return;
        }
        self.left -= 1;
        if self.left == 0 {
            done.emit(ctx.now());
        }
    }
    /// Continues with another number.
    #[slot]
    fn set(&mut self, left: &u32) {
        self.left = *left;
    }
    #[on_activate]
    fn begin(&mut self) {
        self.left = self.from;
    }
}
