//! Managed nodes: a manager configures, activates and deactivates the program.

mod event;
mod machine;

use crate::{Error, Ros, voice::Voice};
use apex_messages::lifecycle_msgs::{
    ChangeState, ChangeStateResponse, GetAvailableStates, GetAvailableStatesResponse, GetAvailableTransitions,
    GetAvailableTransitionsResponse, GetState, GetStateResponse, Transition as Wanted,
};
use apex_nodes::lifecycle::{Outcome, Transition};
use apex_rt::{PortReceiver, PortSender};
use event::Events;
use machine::{ACTIVATING, ACTIVE, Arrow, Machine, SHUTTING_DOWN, STATES, all, state};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

/// A managed node before its manager can see it.
#[must_use = "it is managed with `through` or `by`"]
pub struct Managing<'a> {
    ros: &'a Ros,
    starts: bool,
}

impl Ros {
    /// Begins to make the node a managed one. It is not configured at first, and publishes the events of its program
    /// while it is active.
    pub fn manage(&self) -> Managing<'_> {
        Managing { ros: self, starts: false }
    }
}

impl Managing<'_> {
    /// Configures and activates the node when its program begins, without a manager.
    pub fn starting(self) -> Self {
        Self { starts: true, ..self }
    }

    /// Lets the program carry transitions out: the ports of a [`Managed`](apex_nodes::lifecycle::Managed).
    ///
    /// # Errors
    /// The services cannot be declared.
    pub fn through(self, orders: PortSender<Transition>, outcomes: PortReceiver<Outcome>) -> Result<(), Error> {
        let ros = self.ros;
        let life = self.open(Box::new(move |life, order| {
            if orders.send(order).is_err() {
                life.close();
            }
        }))?;
        ros.endpoints.spawn("lifecycle", move || {
            while let Some(outcome) = outcomes.receive() {
                life.end(outcome);
            }
            life.close();
        })
    }

    /// Lets a function carry transitions out. The program knows nothing of them: while the node is not active, the
    /// events of the program are not published.
    ///
    /// # Errors
    /// The services cannot be declared.
    pub fn by(self, mut act: impl FnMut(Transition) -> Outcome + Send + 'static) -> Result<(), Error> {
        self.open(Box::new(move |life, order| life.end(act(order)))).map(drop)
    }

    fn open(self, act: Act) -> Result<Arc<Life>, Error> {
        let Self { ros, starts } = self;
        let (events, voice) = (Events::open(ros)?, Arc::clone(&ros.endpoints.voice));
        voice.set_silent(true);
        let (state_, act) = (State { machine: Machine::new(), last: None, is_closed: false }, Mutex::new(act));
        let life = Arc::new(Life { state: Mutex::new(state_), changed: Condvar::new(), act, events, voice });
        let here = Arc::clone(&life);
        ros.serve::<ChangeState>("~/change_state")
            .by(move |request| ChangeStateResponse { success: here.change(&request.transition) })?;
        let here = Arc::clone(&life);
        ros.serve::<GetState>("~/get_state")
            .by(move |_| GetStateResponse { current_state: state(here.state().machine.state()) })?;
        ros.serve::<GetAvailableStates>("~/get_available_states").by(|_| GetAvailableStatesResponse {
            available_states: STATES.iter().map(|(id, _)| state(*id)).collect(),
        })?;
        let list = |arrows: &mut dyn Iterator<Item = Arrow>| GetAvailableTransitionsResponse {
            available_transitions: arrows.map(Arrow::description).collect(),
        };
        let here = Arc::clone(&life);
        ros.serve::<GetAvailableTransitions>("~/get_available_transitions").by(move |_| {
            let present = here.state().machine.state();
            list(&mut all().filter(|arrow| arrow.from == present))
        })?;
        ros.serve::<GetAvailableTransitions>("~/get_transition_graph").by(move |_| list(&mut all()))?;
        if starts {
            let here = Arc::clone(&life);
            ros.endpoints.spawn("lifecycle", move || {
                let wanted = |label: &str| Wanted { id: 0, label: label.to_owned() };
                let _ = here.change(&wanted("configure")) && here.change(&wanted("activate"));
            })?;
        }
        Ok(life)
    }
}

/// Function that begins a transition, whose end is told to the life.
type Act = Box<dyn FnMut(&Life, Transition) + Send>;

/// The life of a managed node.
struct Life {
    state: Mutex<State>,
    changed: Condvar,
    /// Locked during a transition: there is one at a time.
    act: Mutex<Act>,
    events: Events,
    voice: Arc<Voice>,
}

struct State {
    machine: Machine,
    /// Outcome of the last transition.
    last: Option<Outcome>,
    /// `true` if the program has ended.
    is_closed: bool,
}

impl Life {
    /// Goes through a transition. Returns `true` if it succeeds.
    fn change(&self, wanted: &Wanted) -> bool {
        let mut act = self.act.lock().unwrap_or_else(PoisonError::into_inner);
        let mut state = self.state();
        let Some((arrow, order)) = state.machine.begin(wanted).filter(|_| !state.is_closed) else { return false };
        state.last = None;
        drop(state);
        self.events.send(arrow);
        // What it says when it begins to act counts.
        if arrow.to == ACTIVATING {
            self.voice.set_silent(false);
        }
        act(self, order);
        let is_under_way = |state: &mut State| state.last.is_none() && !state.is_closed;
        let state = self.changed.wait_while(self.state(), is_under_way).unwrap_or_else(PoisonError::into_inner);
        state.last == Some(Outcome::Success)
    }

    /// Ends the transition that is under way.
    fn end(&self, outcome: Outcome) {
        let mut state = self.state();
        let happened = state.machine.end(outcome);
        self.voice.set_silent(state.machine.state() != ACTIVE);
        happened.into_iter().for_each(|arrow| self.events.send(arrow));
        state.last = Some(outcome);
        drop(state);
        self.changed.notify_all();
    }

    /// Ends all waits: the program has ended. If it was to be shut down, it is.
    fn close(&self) {
        self.state().is_closed = true;
        let is_shut_down = self.state().machine.state() == SHUTTING_DOWN;
        if is_shut_down {
            self.end(Outcome::Success);
        }
        self.changed.notify_all();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
