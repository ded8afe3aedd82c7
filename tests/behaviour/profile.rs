//! Profiles: their contents, not the times.

use apex_macros::graph;
use apex_rt::{drive_with, prelude::*, profile::Profile};
use std::{env, fs, sync::Mutex};

graph! {
    use apex_tests::nodes::{Count, Echo, Snk, Take, Watch, mul, pass};

    /// A source, a node in a list, a slot, and activity that moves on.
    graph Measured {
        node s = Count(end = 3) every 1ms;
        node m = mul(k = 2);
        node e = Echo();
        node t = Take();
        node w = Watch();
        start => s;
        s   -> m -> e.x;
        e.e -> t.s;
        s   => w;
    }
}

#[test]
fn a_profile_counts_every_firing_and_every_slot() {
    let path = env::temp_dir().join(format!("apex-profile-{}.json", std::process::id()));
    let profile = Profile::to_file(const { &Measured::INFO }, &path).expect("a folder for temporary files");
    let profile = Mutex::new(profile);
    drive_with(Measured::new(), SimClock::until(Time::from_millis(3)), Profile::of_group(&profile, 0));
    let mut profile = profile.into_inner().expect("nobody panics");
    profile.finish().expect("room for the file");

    let table = profile.table();
    let count = |node: &str| {
        let line = table.lines().find(|l| l.split_whitespace().next() == Some(node));
        line.and_then(|l| l.split_whitespace().nth(1)).and_then(|count| count.parse::<u64>().ok())
    };
    assert_eq!(["s", "m", "e", "t", "w"].map(count), [Some(3); 5], "{table}");

    let text = fs::read_to_string(&path).expect("the trace");
    fs::remove_file(&path).expect("it is ours");
    let trace: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let events: Vec<_> = trace.as_array().expect("a list").iter().filter(|e| e["ph"] == "X").collect();
    assert_eq!(events.len(), 15);
    let active = |name: &str| -> Vec<bool> {
        events.iter().filter(|e| e["name"] == name).filter_map(|e| e["args"]["active"].as_bool()).collect()
    };
    assert_eq!((active("s"), active("w")), (vec![true, false, false], vec![true; 3]), "activity goes to `w` at once");
    assert!(events.iter().all(|e| e["dur"].as_f64().is_some_and(|dur| dur >= 0.0)));
}

/// Takes longer than the period of its source.
#[node]
pub fn slow_pass(x: &i64) -> i64 {
    std::thread::sleep(std::time::Duration::from_millis(3));
    *x
}

graph! {
    use crate::profile::slow_pass;
    use apex_tests::nodes::{Count, Snk};

    graph TooSlow {
        node often  = Count(end = 3) every 1ms;
        node seldom = Count(end = 3) every 1h;
        often  -> Snk();
        seldom -> slow_pass() -> Snk();
    }
}

#[test]
fn a_reaction_that_is_longer_than_a_period_is_a_warning() {
    let path = env::temp_dir().join(format!("apex-profile-slow-{}.json", std::process::id()));
    let profile = Mutex::new(Profile::to_file(const { &TooSlow::INFO }, &path).expect("a folder for temporary files"));
    drive_with(TooSlow::new(), SimClock::until(Time::from_millis(3)), Profile::of_group(&profile, 0));
    fs::remove_file(&path).expect("it is ours");
    let warnings = profile.into_inner().expect("nobody panics").warnings();
    let [warning] = warnings.as_slice() else { panic!("{warnings:?}") };
    assert!(warning.contains("of it in `slow_pass_2`, but `often` fires every 1ms"), "{warning}");
}
