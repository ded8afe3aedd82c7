//! The examples that have tests, compiled so that their tests run.

/// A module for each file, and the contents of all.
macro_rules! texts {
    ($($name:ident $file:tt)*) => {
        $(mod $name {
            apex_macros::graph!($file);
        })*

        /// Contents of the examples.
        pub const TEXTS: &[&str] = &[$(include_str!($file)),*];
    };
}

texts! {
    answers "texts/answers.afg"
    arbitration "texts/arbitration.afg"
    call "texts/call.afg"
    calm "texts/calm.afg"
    charged "texts/charged.afg"
    degraded "texts/degraded.afg"
    duty "texts/duty.afg"
    exclusive "texts/exclusive.afg"
    filled "texts/filled.afg"
    forward "texts/forward.afg"
    fresh "texts/fresh.afg"
    fusion "texts/fusion.afg"
    both "texts/both.afg"
    gate "texts/gate.afg"
    goals "texts/goals.afg"
    guarded "texts/guarded.afg"
    help "texts/help.afg"
    hours "texts/hours.afg"
    jobs "texts/jobs.afg"
    join "texts/join.afg"
    lamp "texts/lamp.afg"
    merging "texts/merging.afg"
    mission "texts/mission.afg"
    race "texts/race.afg"
    retry "texts/retry.afg"
    stop "texts/stop.afg"
    structs "texts/structs.afg"
    times "texts/times.afg"
    units "texts/units.afg"
    waiting "texts/waiting.afg"
    watchdog "texts/watchdog.afg"
}
