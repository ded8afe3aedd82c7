/// Results of a graph.
pub struct Row {
    /// Name of the graph.
    pub graph: &'static str,
    /// Nanoseconds per tick by hand, median.
    pub hand_ns: f64,
    /// Results of all other participants, the fastest first.
    pub others: Vec<Other>,
}

/// Result of a participant.
pub struct Other {
    /// Name of the participant.
    pub name: String,
    /// Ratio to the time of the hand-written program, median of the rounds.
    pub ratio: f64,
    /// `true` if its checksum always equals that of the hand-written program.
    pub equal: bool,
}

impl Other {
    /// `true` for the plain compiled program of Apex.
    pub fn is_apex(&self) -> bool {
        self.name == "apex"
    }
}
