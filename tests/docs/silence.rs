use apex_macros::graph;
use apex_rt::prelude::*;

/// Passes a command on, and stops if none comes.
#[node]
pub struct Wheels {
    /// Time without a command after which it stops.
    #[param(unit = "s", default = 0.5, silence)]
    max_age: f64,
}

#[node]
impl Wheels {
    fn process(&mut self, command: Option<&f64>) -> f64 {
        command.copied().unwrap_or(0.0)
    }
}

graph! {
    graph Drive {
        in  command: f64;
        out velocity: f64;

        command -> Wheels() -> velocity;
    }
}

pub fn main() {
    let mut drive = Drive::new();
    assert_eq!(drive.inputs().command.put(0.3), Ok(()));
    assert_eq!(drive.react(Time::ZERO), Next::At(Time::from_millis(500)));
    assert_eq!(drive.outputs().velocity, Some(0.3));
    // Nothing comes.
    drive.react(Time::from_millis(500));
    assert_eq!(drive.outputs().velocity, Some(0.0));
}
