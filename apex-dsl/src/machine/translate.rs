//! A state machine as an activity flow graph (thesis 7.2.1), to be read by people: each state is a node, each
//! transition an event with an active connection to a slot.

use super::Machine;
use std::fmt::Write as _;

/// The translation as text.
pub fn translation(machine: &Machine) -> String {
    let mut text = format!("fsm {} as an activity flow graph (7.2.1):\n", machine.name);
    let _ = writeln!(text, "  start => {};", machine.states[0]);
    for slot in &machine.slots {
        let mut consumers: Vec<&str> = slot.arms.iter().map(|arm| machine.states[arm.state].as_str()).collect();
        consumers.dedup();
        let consumers: Vec<String> = consumers.iter().map(|state| format!("{state}.{}", slot.name)).collect();
        if !consumers.is_empty() {
            let _ = writeln!(text, "  {} -> [{}];", slot.name, consumers.join(", "));
        }
    }
    for slot in machine.all_slots() {
        for (number, arm) in slot.arms.iter().enumerate() {
            let state = &machine.states[arm.state];
            let guard = machine.condition(slot, arm).map(|condition| format!("   // if {condition}"));
            let event = format!("{state}.{}_{}", slot.name.replace(' ', "_"), number + 1);
            if let Some(target) = arm.target {
                let guard = guard.as_deref().unwrap_or_default();
                let _ = writeln!(text, "  {event} => {}.enter;{guard}", machine.states[target]);
            }
            for sending in &arm.sends {
                let _ = writeln!(text, "  {event} -> {};", machine.events[sending.event].0);
            }
        }
    }
    text
}
