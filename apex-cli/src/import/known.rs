//! Node types of CS::APEX that the library also has.

/// A node type of CS::APEX and its equivalent in the library.
pub struct Known {
    /// Type in CS::APEX.
    pub theirs: &'static str,
    /// Module and name in `apex_nodes`.
    pub ours: (&'static str, &'static str),
    /// Names of each port in CS::APEX and in the library.
    pub ports: &'static [(&'static str, &'static str)],
}

/// Types with the same behaviour.
const KNOWN: [Known; 3] = [
    Known {
        theirs: "csapex::CountMessages",
        ours: ("flow", "Count"),
        ports: &[("in_0", "value"), ("out_0", "out"), ("slot_2", "reset")],
    },
    Known {
        theirs: "csapex::Latch",
        ours: ("flow", "Latch"),
        ports: &[("out_0", "out"), ("slot_2", "set"), ("slot_3", "reset")],
    },
    Known {
        theirs: "csapex::MessageEvent",
        ours: ("flow", "emit"),
        ports: &[("in_0", "value"), ("event_3", "signal")],
    },
];

/// Equivalent in the library for a type.
pub fn find(ty: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|known| known.theirs == ty)
}

/// Type of ports whose type the graph file does not specify.
pub const MESSAGE: &str = "Message";

/// Type of the notes on the canvas, which do nothing.
pub const NOTE: &str = "csapex::Note";
