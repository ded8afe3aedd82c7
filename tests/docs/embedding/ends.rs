use apex_macros::graph;
use apex_rt::{drive, prelude::*};
use std::sync::atomic::{AtomicU32, Ordering};

/// Speed that the motor has been told, in mm/s.
static SPEED: AtomicU32 = AtomicU32::new(0);

/// Driver of a motor.
#[node]
#[derive(Default)]
pub struct CartDrive;

#[node]
impl CartDrive {
    fn process(&mut self) {
        SPEED.store(300, Ordering::Relaxed);
    }

    #[on_stop]
    fn halt(&mut self) {
        SPEED.store(0, Ordering::Relaxed);
    }
}

graph! {
    robot Cart {
        node motor = CartDrive() every 20ms;
    }
}

pub fn main() {
    drive(Cart::new(), SimClock::until(Time::from_secs(1)));
    assert_eq!(SPEED.load(Ordering::Relaxed), 0);
}
