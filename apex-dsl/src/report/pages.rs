//! One page per code: its meaning, an example with the error, and one without.

/// The codes with their pages in `docs/errors/`.
macro_rules! pages {
    ($($code:literal)*) => {
        /// All codes with their pages, in order.
        pub const PAGES: &[(&str, &str)] =
            &[$(($code, include_str!(concat!("../../../docs/errors/", $code, ".md")))),*];
    };
}

pages! {
    "ambiguous-node"
    "ambiguous-port"
    "bad-number"
    "cannot-vary"
    "claim-fails"
    "claim-undecided"
    "connected-twice"
    "cycle"
    "duplicate-argument"
    "duplicate-name"
    "each-asynchronous"
    "each-port"
    "each-stateful"
    "essential-without-hook"
    "every-on-driven"
    "fsm-port"
    "given-to-input"
    "ignored-failure"
    "internal-error"
    "missing-argument"
    "missing-modifier"
    "missing-unit"
    "never-activated"
    "never-entered"
    "never-fires"
    "never-leaves"
    "never-taken"
    "no-graph"
    "no-process"
    "no-state"
    "not-replaced"
    "not-used"
    "nothing-matched"
    "open-input"
    "open-output"
    "out-of-range"
    "own-event"
    "rates"
    "recursion"
    "robot-port"
    "stuck"
    "syntax"
    "target"
    "threads"
    "throttled"
    "too-deep"
    "too-large"
    "twice"
    "type-arguments"
    "type-mismatch"
    "unclosed"
    "unknown-argument"
    "unknown-character"
    "unknown-claim"
    "unknown-graph"
    "unknown-import"
    "unknown-name"
    "unknown-node"
    "unknown-port"
    "unknown-state"
    "unknown-type"
    "unknown-unit"
    "unnamed-argument"
    "unreadable"
    "unused-node"
    "waits-forever"
    "wrong-claim"
    "wrong-direction"
    "wrong-field"
    "wrong-goal"
    "wrong-modifier"
    "wrong-record"
    "wrong-study"
    "wrong-unit"
    "wrong-value"
    "wrong-wildcard"
}

/// The page about a code.
pub fn page(code: &str) -> Option<&'static str> {
    PAGES.iter().find(|(known, _)| *known == code).map(|(_, page)| *page)
}
