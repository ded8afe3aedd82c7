//! The examples that have tests, compiled so that their tests run.

mod answers {
    apex_macros::graph!("texts/answers.afg");
}
mod duty {
    apex_macros::graph!("texts/duty.afg");
}
mod filled {
    apex_macros::graph!("texts/filled.afg");
}
mod gate {
    apex_macros::graph!("texts/gate.afg");
}
mod help {
    apex_macros::graph!("texts/help.afg");
}
mod hours {
    apex_macros::graph!("texts/hours.afg");
}
mod join {
    apex_macros::graph!("texts/join.afg");
}
mod lamp {
    apex_macros::graph!("texts/lamp.afg");
}
mod mission {
    apex_macros::graph!("texts/mission.afg");
}
mod stop {
    apex_macros::graph!("texts/stop.afg");
}
mod times {
    apex_macros::graph!("texts/times.afg");
}
mod waiting {
    apex_macros::graph!("texts/waiting.afg");
}

/// Contents of the examples.
pub const TEXTS: [&str; 12] = [
    include_str!("texts/answers.afg"),
    include_str!("texts/duty.afg"),
    include_str!("texts/filled.afg"),
    include_str!("texts/gate.afg"),
    include_str!("texts/help.afg"),
    include_str!("texts/hours.afg"),
    include_str!("texts/join.afg"),
    include_str!("texts/lamp.afg"),
    include_str!("texts/mission.afg"),
    include_str!("texts/stop.afg"),
    include_str!("texts/times.afg"),
    include_str!("texts/waiting.afg"),
];
