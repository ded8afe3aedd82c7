//! `filters.afg`: one value that is NaN or infinite does not spoil a filter for the values after it. A filter that is
//! not in the file is reported.

use apex_dsl::catalog::Catalog;
use apex_host::{Disk, Seen, Workspace};
use apex_macros::graph;
use apex_rt::prelude::*;
use std::{fs, path::Path};

graph!("filters.afg");

/// Numbers that sensors send when something is wrong.
const ODD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Outputs after 100 values up and down, `odd` instead of one of them, and 200 more.
fn after(odd: Option<f64>) -> [f64; 5] {
    let mut filters = Filters::new();
    for step in 0..300 {
        let x = if step % 10 < 5 { 0.25 } else { 0.75 };
        let x = odd.filter(|_| step == 100).unwrap_or(x);
        assert_eq!(filters.inputs().x.put(x), Ok(()));
        filters.react(Time::from_millis(20 * step));
    }
    let outputs = filters.outputs();
    let number = |value: Option<f64>| value.expect("a filter sends a value for each one");
    [
        outputs.hysteresis.map_or(-1.0, |on| f64::from(u8::from(on))),
        number(outputs.low_pass),
        number(outputs.moving_average),
        number(outputs.rate_limit),
        number(outputs.pid),
    ]
}

#[test]
fn a_filter_is_well_again_after_one_odd_value() {
    let undisturbed = after(None);
    for odd in ODD {
        let outputs = after(Some(odd));
        for (i, (a, b)) in outputs.into_iter().zip(undisturbed).enumerate() {
            assert!((a - b).abs() < 1e-6, "filter {i} of `filters.afg` after {odd}: {a} instead of {b}");
        }
    }
}

#[test]
fn every_filter_of_the_library_is_tried() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = Workspace::load(folder).expect("cargo knows the package");
    let catalog = Catalog::load(workspace.crates(&Seen::Crate("filters", false)), &mut Disk::new(None));
    let text = fs::read_to_string(folder.join("tests/filters.afg")).expect("the file is there");
    let filters = catalog.signatures.iter().filter(|s| s.stateful && s.path.get(1..3).is_some_and(is_math));
    let names: Vec<&str> = filters.map(|s| s.name.as_str()).collect();
    assert!(names.len() >= 5, "{names:?}");
    for name in names {
        assert!(text.contains(&format!("-> {name}")), "`{name}` is not in `tests/filters.afg`");
    }
}

fn is_math(path: &[String]) -> bool {
    path[0] == "apex_nodes" && path[1] == "math"
}
