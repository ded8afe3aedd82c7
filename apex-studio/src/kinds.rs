//! Kinds of nodes that are not in a source: ports of the program, states, and nodes that the compiler has inserted.

/// `true` for a node that the compiler has inserted into a connection, and that pictures do not show.
pub fn is_inserted(kind: &str) -> bool {
    matches!(kind, "relay" | "probe")
}

/// `true` for a state of a state machine: its name begins with that of the machine.
pub fn is_state(kind: &str) -> bool {
    kind == "state"
}

/// `true` for a node that only hands tokens on, and for a port of the program: it is never said to fire.
pub fn is_silent(kind: &str) -> bool {
    is_inserted(kind) || matches!(kind, "delay" | "cell" | "input" | "output" | "slot" | "event" | "start")
}
