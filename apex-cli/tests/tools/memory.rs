use crate::{
    TARGET, builds,
    common::{Folder, answer, apex, package, stderr},
};
use std::{path::Path, process::Output};

const NODES: &str = r"//! Nodes.
use apex_rt::prelude::*;

/// Counts.
#[node]
#[derive(Default)]
pub struct Numbers {
    next: u32,
}

#[node]
impl Numbers {
    fn process(&mut self) -> u32 {
        self.next += 1;
        self.next
    }
}

/// 256 bytes.
#[derive(Clone, Default)]
pub struct Cells(pub [u64; 32]);

/// Has a large state.
#[node]
pub struct Store {
    kept: Cells,
}

#[node]
impl Store {
    fn process(&mut self, value: &u32, copy: &mut Out<Cells>) {
        self.kept.0[*value as usize % 32] = 1;
        copy.set(self.kept.clone());
    }
}
";

const TEXT: &str = "\
use crate::{Cells, Numbers, Store};

graph Inner {
    in  value: u32;
    out last: Cells;

    node store = Store();
    value -> store -> last;
}

robot Keeper {
    node numbers = Numbers() every 10ms;
    node inner   = Inner();
    numbers -> inner;
}

test counts: Inner {
    feed value = 1;
    wait 1s;
}
";

fn explain(file: &Path, arguments: &[&str]) -> Output {
    let _guard = builds();
    let mut command = apex();
    command.args(["explain", "--memory"]).args(arguments).arg(file);
    command.env("CARGO_TARGET_DIR", TARGET).env("CARGO_NET_OFFLINE", "true").output().unwrap()
}

#[test]
fn sizes_are_those_of_rustc_and_add_up() {
    let folder = Folder::new("memory");
    package(&folder, NODES);
    let output = explain(&folder.file("keeper.afg", TEXT), &["--format", "json"]);
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    let answer = answer(&output, "explain");
    let programs = answer["result"]["programs"].as_array().unwrap();
    let names: Vec<&str> = programs.iter().map(|program| program["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["Keeper"], "the program of the test does not count");
    let keeper = &programs[0];
    let bytes = |what: &str, of: &str| {
        let mut pieces = keeper["pieces"].as_array().unwrap().iter();
        let piece = pieces.find(|piece| piece["what"] == what && piece["of"] == of);
        piece.unwrap_or_else(|| panic!("{what} of {of}: {keeper:#}"))["bytes"].as_u64().unwrap()
    };
    assert_eq!((bytes("nodes", "numbers"), bytes("nodes", "inner.store")), (4, 256));
    assert!((256..300).contains(&bytes("tokens", "inner.store.copy")), "the buffer of an output: {keeper:#}");
    assert_eq!(bytes("timers", "numbers"), 16);
    let all: u64 = keeper["pieces"].as_array().unwrap().iter().map(|piece| piece["bytes"].as_u64().unwrap()).sum();
    assert_eq!(all + keeper["padding"].as_u64().unwrap(), keeper["bytes"].as_u64().unwrap());
    assert!(keeper["padding"].as_u64().unwrap() < 16, "nothing is left out: {keeper:#}");
}

#[test]
fn what_cannot_be_built_has_no_sizes() {
    let folder = Folder::new("memory-wrong");
    let file = folder.file("alone.afg", "graph Alone { }\n");
    let output = explain(&file, &[]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
    assert!(stderr(&output).contains("is not in a cargo package"), "{}", stderr(&output));

    package(&folder, NODES);
    let text = "use crate::Numbers;\ngraph Wrong {\n    node a = Numbers();\n    node a = Numbers();\n}\n";
    let output = explain(&folder.file("wrong.afg", text), &[]);
    assert_eq!((output.status.code(), output.stdout.len()), (Some(1), 0));
    assert!(stderr(&output).starts_with("error["), "{}", stderr(&output));

    let open = folder.file(
        "open.afg",
        "use crate::Numbers;\ngraph Open(n: u32) { // allow(not-used): it has no value\n    node a = Numbers();\n}\n",
    );
    let output = explain(&open, &[]);
    let said = String::from_utf8(output.stdout.clone()).unwrap();
    assert_eq!((output.status.code(), stderr(&output)), (Some(0), String::new()));
    assert!(said.ends_with("has no graph whose parameters all have values\n"), "{said}");
}
