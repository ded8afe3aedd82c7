//! States and transitions of managed nodes, as in `rcl_lifecycle`.

use apex_messages::lifecycle_msgs::{State as Message, Transition as Ids, TransitionDescription};
use apex_nodes::lifecycle::{Outcome, Transition};

/// A state by its number in messages.
pub type State = u8;

/// A transition between two states. While one is under way, the node is in a state of its own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Arrow {
    /// Number in messages.
    pub id: u8,
    /// Name in messages.
    pub label: &'static str,
    pub from: State,
    pub to: State,
}

/// All states: those in which a node stays, and those of transitions.
pub const STATES: [(State, &str); 11] = [
    (Message::PRIMARY_STATE_UNKNOWN, "unknown"),
    (UNCONFIGURED, "unconfigured"),
    (INACTIVE, "inactive"),
    (ACTIVE, "active"),
    (FINALIZED, "finalized"),
    (CONFIGURING, "configuring"),
    (CLEANING_UP, "cleaningup"),
    (SHUTTING_DOWN, "shuttingdown"),
    (ACTIVATING, "activating"),
    (DEACTIVATING, "deactivating"),
    (ERROR, "errorprocessing"),
];

const UNCONFIGURED: State = Message::PRIMARY_STATE_UNCONFIGURED;
const INACTIVE: State = Message::PRIMARY_STATE_INACTIVE;
pub const ACTIVE: State = Message::PRIMARY_STATE_ACTIVE;
const FINALIZED: State = Message::PRIMARY_STATE_FINALIZED;
const CONFIGURING: State = Message::TRANSITION_STATE_CONFIGURING;
const CLEANING_UP: State = Message::TRANSITION_STATE_CLEANINGUP;
pub const SHUTTING_DOWN: State = Message::TRANSITION_STATE_SHUTTINGDOWN;
pub const ACTIVATING: State = Message::TRANSITION_STATE_ACTIVATING;
const DEACTIVATING: State = Message::TRANSITION_STATE_DEACTIVATING;
const ERROR: State = Message::TRANSITION_STATE_ERRORPROCESSING;

const fn arrow(id: u8, label: &'static str, from: State, to: State) -> Arrow {
    Arrow { id, label, from, to }
}

/// Transitions that others ask for, with their orders.
const ASKED: [(Arrow, Transition); 7] = [
    (arrow(Ids::TRANSITION_CONFIGURE, "configure", UNCONFIGURED, CONFIGURING), Transition::Configure),
    (arrow(Ids::TRANSITION_CLEANUP, "cleanup", INACTIVE, CLEANING_UP), Transition::CleanUp),
    (arrow(Ids::TRANSITION_ACTIVATE, "activate", INACTIVE, ACTIVATING), Transition::Activate),
    (arrow(Ids::TRANSITION_DEACTIVATE, "deactivate", ACTIVE, DEACTIVATING), Transition::Deactivate),
    (arrow(Ids::TRANSITION_UNCONFIGURED_SHUTDOWN, "shutdown", UNCONFIGURED, SHUTTING_DOWN), Transition::ShutDown),
    (arrow(Ids::TRANSITION_INACTIVE_SHUTDOWN, "shutdown", INACTIVE, SHUTTING_DOWN), Transition::ShutDown),
    (arrow(Ids::TRANSITION_ACTIVE_SHUTDOWN, "shutdown", ACTIVE, SHUTTING_DOWN), Transition::ShutDown),
];

const SUCCESS: &str = "transition_success";
const FAILURE: &str = "transition_failure";
const FAULT: &str = "transition_error";

/// Ends of transitions: of success, failure and error.
const ENDS: [[Arrow; 3]; 6] = [
    ends(Ids::TRANSITION_ON_CONFIGURE_SUCCESS, CONFIGURING, INACTIVE, UNCONFIGURED, ERROR),
    ends(Ids::TRANSITION_ON_CLEANUP_SUCCESS, CLEANING_UP, UNCONFIGURED, INACTIVE, ERROR),
    ends(Ids::TRANSITION_ON_ACTIVATE_SUCCESS, ACTIVATING, ACTIVE, INACTIVE, ERROR),
    ends(Ids::TRANSITION_ON_DEACTIVATE_SUCCESS, DEACTIVATING, INACTIVE, ACTIVE, ERROR),
    ends(Ids::TRANSITION_ON_SHUTDOWN_SUCCESS, SHUTTING_DOWN, FINALIZED, FINALIZED, ERROR),
    ends(Ids::TRANSITION_ON_ERROR_SUCCESS, ERROR, UNCONFIGURED, FINALIZED, FINALIZED),
];

/// The numbers of failure and error follow that of success.
const fn ends(success: u8, from: State, good: State, bad: State, broken: State) -> [Arrow; 3] {
    [
        arrow(success, SUCCESS, from, good),
        arrow(success + 1, FAILURE, from, bad),
        arrow(success + 2, FAULT, from, broken),
    ]
}

/// Returns all transitions.
pub fn all() -> impl Iterator<Item = Arrow> {
    ASKED.into_iter().map(|(arrow, _)| arrow).chain(ENDS.into_iter().flatten())
}

/// Returns the message of a state.
pub fn state(id: State) -> Message {
    let label = STATES.iter().find(|(state, _)| *state == id).map_or("unknown", |(_, label)| label);
    Message { id, label: label.to_owned() }
}

impl Arrow {
    /// Returns the message of the transition.
    pub fn message(self) -> Ids {
        Ids { id: self.id, label: self.label.to_owned() }
    }

    /// Returns the message of the transition with its states.
    pub fn description(self) -> TransitionDescription {
        TransitionDescription { transition: self.message(), start_state: state(self.from), goal_state: state(self.to) }
    }
}

/// A managed node.
pub struct Machine {
    state: State,
}

impl Machine {
    /// Returns a node that is not configured.
    pub const fn new() -> Self {
        Self { state: UNCONFIGURED }
    }

    /// Returns the present state.
    pub const fn state(&self) -> State {
        self.state
    }

    /// Returns `true` while a transition is under way.
    pub fn is_between(&self) -> bool {
        ENDS.iter().any(|[end, ..]| end.from == self.state)
    }

    /// Begins the transition with a label, or with a number if the label is empty. Returns it with the order for the
    /// program; `None` if it does not begin in the present state.
    pub fn begin(&mut self, wanted: &Ids) -> Option<(Arrow, Transition)> {
        let is_wanted = |(arrow, _): &&(Arrow, Transition)| match wanted.label.as_str() {
            "" => arrow.id == wanted.id,
            label => arrow.label == label,
        };
        let found = *ASKED.iter().filter(is_wanted).find(|(arrow, _)| arrow.from == self.state)?;
        self.state = found.0.to;
        Some(found)
    }

    /// Ends the transition that is under way. Returns what happens: after an error, the node is not configured any
    /// more. An error without a transition stops an active node first, and does nothing to a node that was never
    /// configured.
    pub fn end(&mut self, outcome: Outcome) -> Vec<Arrow> {
        let mut happened = vec![];
        if !self.is_between() {
            let way = match (outcome, self.state) {
                (Outcome::Error, ACTIVE) => Transition::Deactivate,
                (Outcome::Error, INACTIVE) => Transition::CleanUp,
                _ => return happened,
            };
            let begin = ASKED.iter().find(|(arrow, order)| arrow.from == self.state && *order == way);
            happened.extend(begin.map(|(arrow, _)| self.go(*arrow)));
        }
        let which = match outcome {
            Outcome::Success => 0,
            Outcome::Failure => 1,
            Outcome::Error => 2,
        };
        happened.extend(self.ends().map(|ends| self.go(ends[which])));
        if self.state == ERROR {
            happened.extend(self.ends().map(|[success, ..]| self.go(success)));
        }
        happened
    }

    fn ends(&self) -> Option<[Arrow; 3]> {
        ENDS.into_iter().find(|[end, ..]| end.from == self.state)
    }

    fn go(&mut self, arrow: Arrow) -> Arrow {
        self.state = arrow.to;
        arrow
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn named(label: &str) -> Ids {
        Ids { id: 0, label: label.to_owned() }
    }

    /// Begins a transition and ends it. Returns the state.
    fn pass(machine: &mut Machine, label: &str, outcome: Outcome) -> Option<State> {
        machine.begin(&named(label))?;
        machine.end(outcome);
        Some(machine.state())
    }

    #[test]
    fn a_node_goes_through_its_life() {
        let mut machine = Machine::new();
        for (label, state) in [
            ("configure", INACTIVE),
            ("activate", ACTIVE),
            ("deactivate", INACTIVE),
            ("cleanup", UNCONFIGURED),
            ("shutdown", FINALIZED),
        ] {
            assert_eq!(pass(&mut machine, label, Outcome::Success), Some(state), "{label}");
        }
        assert_eq!(pass(&mut machine, "configure", Outcome::Success), None);
    }

    #[test]
    fn transitions_begin_in_their_state_only() {
        let mut machine = Machine::new();
        for label in ["activate", "deactivate", "cleanup", "transition_success", "frob"] {
            assert!(machine.begin(&named(label)).is_none(), "{label}");
        }
        let by_number = Ids { id: Ids::TRANSITION_CONFIGURE, label: String::new() };
        assert_eq!(
            machine.begin(&by_number).map(|(arrow, order)| (arrow.to, order)),
            Some((10, Transition::Configure))
        );
        assert!(machine.is_between() && machine.begin(&by_number).is_none(), "one at a time");
        let ended = machine.end(Outcome::Failure);
        assert_eq!((ended[0].id, machine.state()), (11, UNCONFIGURED));
        assert!(machine.end(Outcome::Success).is_empty(), "nothing is under way");
    }

    #[test]
    fn an_error_at_any_time_asks_for_a_new_configuration() {
        let ids = |arrows: Vec<Arrow>| arrows.iter().map(|arrow| arrow.id).collect::<Vec<_>>();
        let mut machine = Machine::new();
        assert!(machine.end(Outcome::Error).is_empty());
        pass(&mut machine, "configure", Outcome::Success);
        pass(&mut machine, "activate", Outcome::Success);
        assert_eq!((ids(machine.end(Outcome::Error)), machine.state()), (vec![4, 42, 60], UNCONFIGURED));
        pass(&mut machine, "configure", Outcome::Success);
        assert_eq!((ids(machine.end(Outcome::Error)), machine.state()), (vec![2, 22, 60], UNCONFIGURED));
        machine.begin(&named("configure"));
        assert_eq!((ids(machine.end(Outcome::Error)), machine.state()), (vec![12, 60], UNCONFIGURED));
    }

    #[test]
    fn all_transitions_are_those_of_ros() {
        let all: Vec<_> = all().collect();
        assert_eq!(all.len(), 25);
        let is_state = |id| STATES.iter().any(|(state, _)| *state == id);
        assert!(all.iter().all(|arrow| is_state(arrow.from) && is_state(arrow.to)));
        let mut ids: Vec<_> = all.iter().map(|arrow| arrow.id).collect();
        ids.sort_unstable();
        ids.dedup();
        assert_eq!(ids.len(), 25);
        assert_eq!(state(12).label, "shuttingdown");
        let description = all[0].description();
        assert_eq!(
            (description.transition.label.as_str(), description.goal_state.label.as_str()),
            ("configure", "configuring")
        );
    }
}
