use apex_macros::graph;
use apex_rt::prelude::*;

/// Passes values on while they change by no more than `step`.
#[node]
#[derive(Default)]
pub struct SmallSteps {
    /// Largest change.
    #[param(default = 0.1, range = 0.0..=1.0)]
    step: f64,
    last: f64,
}

#[node]
impl SmallSteps {
    fn process(&mut self, x: &f64) -> Option<f64> {
        let small = (x - self.last).abs() <= self.step;
        self.last = *x;
        small.then_some(*x)
    }
}

graph! {
    graph Calm {
        in  x: f64;
        out y: f64;

        x -> SmallSteps(step = 0.5) -> y;
    }
}

pub fn main() {
    let mut calm = Calm::new();
    for (x, y) in [(0.3, Some(0.3)), (2.0, None), (2.1, Some(2.1))] {
        assert_eq!(calm.inputs().x.put(x), Ok(()));
        calm.react(Time::ZERO);
        assert_eq!(calm.outputs().y, y);
    }
}
