use apex_rt::Time;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Simulation of a robot in its world. The same seed and the same commands give the same result, bit for bit.
pub trait Simulation {
    /// Advances the simulation to a time.
    fn advance(&mut self, now: Time);
}

/// Handle of a simulation, which all drivers of the robot share.
#[derive(Debug)]
pub struct Shared<S>(Arc<Mutex<S>>);

impl<S> Clone for Shared<S> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }
}

impl<S: Simulation> Shared<S> {
    /// Creates the handle of a simulation.
    pub fn new(simulation: S) -> Self {
        Self(Arc::new(Mutex::new(simulation)))
    }

    /// The simulation at a time.
    pub fn at(&self, now: Time) -> MutexGuard<'_, S> {
        let mut simulation = self.present();
        simulation.advance(now);
        simulation
    }

    /// The simulation in its present state, even if another thread panicked while using it.
    pub fn present(&self) -> MutexGuard<'_, S> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Watch(Time);

    impl Simulation for Watch {
        fn advance(&mut self, now: Time) {
            self.0 = now;
        }
    }

    #[test]
    fn all_handles_are_of_one_simulation() {
        let watch = Shared::new(Watch(Time::ZERO));
        let other = watch.clone();
        assert_eq!(watch.at(Time::from_secs(3)).0, Time::from_secs(3));
        assert_eq!(other.present().0, Time::from_secs(3));
    }
}
