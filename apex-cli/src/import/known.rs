//! Node types of CS::APEX that the library has too.

/// A node type there and here.
pub struct Known {
    /// Its type there.
    pub theirs: &'static str,
    /// Its module and name in `apex_nodes`.
    pub ours: (&'static str, &'static str),
    /// Its ports, there and here.
    pub ports: &'static [(&'static str, &'static str)],
}

/// Those that do the same.
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

/// What the library has for a type.
pub fn find(ty: &str) -> Option<&'static Known> {
    KNOWN.iter().find(|known| known.theirs == ty)
}
