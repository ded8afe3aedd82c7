use super::{
    Order, Report,
    state::{Options, Snapshot, State},
};
use apex_nodes::{io::ReadError, nav::Twist};
use apex_rt::Time;
use apex_sim::Building;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Simulated clinic: a handle that all drivers of the vehicle share.
#[derive(Debug, Clone)]
pub struct Clinic {
    state: Arc<Mutex<State>>,
}

impl Clinic {
    /// Creates the clinic of a seed.
    ///
    /// # Errors
    /// If the plan of the building cannot be read.
    pub fn new(options: &Options) -> Result<Self, ReadError> {
        State::new(options).map(|state| Self { state: Arc::new(Mutex::new(state)) })
    }

    /// Events up to now.
    pub fn report(&self) -> Report {
        self.state().report().clone()
    }

    /// True state.
    pub fn snapshot(&self) -> Snapshot {
        self.state().snapshot()
    }

    /// True velocity of the tractor, in its frame.
    pub fn twist(&self) -> Twist {
        self.state().twist()
    }

    /// Building with its furniture.
    pub fn building(&self) -> Building {
        self.state().building().clone()
    }

    /// Advances the simulation to a time. Drivers call this before they read.
    pub fn advance(&self, now: Time) {
        self.state().advance(now);
    }

    /// Sets the twist of the motors at a time.
    pub fn drive(&self, now: Time, twist: Twist) {
        self.at(now).drive(twist);
    }

    /// Moves the lift up or down from a time on.
    pub fn lift(&self, now: Time, up: bool) {
        self.at(now).lift(up);
    }

    /// Next order.
    pub fn next_order(&self) -> Option<Order> {
        self.state().next_order()
    }

    /// Notes that the vehicle has done its order, as it says.
    pub fn confirm(&self) {
        self.state().confirm();
    }

    /// Notes that an order was given back.
    pub fn refuse(&self) {
        self.state().report_mut().refused += 1;
    }

    /// The clinic at a time.
    pub(super) fn at(&self, now: Time) -> MutexGuard<'_, State> {
        let mut state = self.state();
        state.advance(now);
        state
    }

    /// The clinic in its present state, even if another thread panicked while using it.
    pub(super) fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
