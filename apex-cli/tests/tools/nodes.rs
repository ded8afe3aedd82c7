//! `apex nodes`, and the index of all nodes in the documentation, which it writes.

use crate::common::{Folder, apex, package, stderr};
use std::{env, fs, path::Path};

const NODES: &str = "\
use apex_rt::prelude::*;
/// Doubles a [`Thing`]. Slowly.
///
/// More about it.
#[node]
pub fn double(x: &f64, #[param(default = 2.0, range = 1.0..=9.0, unit = \"m\")] times: f64) -> f64 { x * times }
/// Counts doubles.
#[node]
pub struct Tally {
    /// The first number.
    #[param(default = 3)]
    first: u64,
}
#[node]
impl Tally {
    fn process(&mut self, x: Option<&[u8; 2]>, full: Event<u64>) {}
    /// Starts at zero.
    #[slot]
    fn clear(&mut self) {}
}
";

const LIST: &str = "\
nodes
  double  Doubles a Thing.
  Tally   Counts doubles.
";

const DOUBLE: &str = "\
nodes::double
  Doubles a Thing. Slowly.

  More about it.
  input   x      f64
  output  out    f64
  param   times  f64[m] = 2 in 1..=9
";

const TALLY: &str = "\
nodes::Tally
  Counts doubles.
  input  x      [u8; 2] (optional)
  slot   clear                      Starts at zero.
  event  full   u64
  param  first  u64 = 3             The first number.
";

fn nodes(folder: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let output = apex().arg("nodes").args(arguments).current_dir(folder).output().unwrap();
    (output.status.code(), String::from_utf8(output.stdout.clone()).unwrap(), stderr(&output))
}

#[test]
fn nodes_are_listed_and_described() {
    let folder = Folder::new("nodes");
    package(&folder, NODES);
    for (words, expected) in [
        (&[][..], LIST),
        (&["DOUBLE", "x"], LIST),
        (&["doubles"], LIST),
        (&["double"], DOUBLE),
        (&["nodes::Double"], DOUBLE),
        (&["times"], DOUBLE),
        (&["tally"], TALLY),
        (&["u8", "clear"], TALLY),
    ] {
        assert_eq!(nodes(&folder.0, words), (Some(0), expected.to_owned(), String::new()), "{words:?}");
    }
    let (code, page, _) = nodes(&folder.0, &["--markdown"]);
    assert_eq!(code, Some(0));
    assert!(
        page.starts_with("## nodes\n\n| node | |\n|---|---|\n| [`double`](#double) | Doubles a `Thing`. |\n"),
        "{page}"
    );
    assert!(page.contains("| param | `first` | `u64 = 3` | The first number. |\n"), "{page}");
}

#[test]
fn what_is_not_found_is_said_with_what_may_be_meant() {
    let folder = Folder::new("nodes-none");
    package(&folder, NODES);
    for (words, message) in [
        (&["dubble"][..], "no node matches `dubble`; did you mean `double`?"),
        (&["laser"], "no node matches `laser`; `apex nodes` lists them all"),
        (&["double", "laser"], "no node matches all of `double`, `laser`; give fewer words"),
    ] {
        assert_eq!(nodes(&folder.0, words), (Some(2), String::new(), format!("error: {message}\n")));
    }
}

#[test]
fn outside_of_a_package_there_is_the_library() {
    let folder = Folder::new("nodes-library");
    let (code, list, errors) = nodes(&folder.0, &[]);
    assert_eq!((code, errors.as_str()), (Some(0), ""));
    assert!(list.starts_with("apex_nodes::action\n") && list.contains("\napex_sim\n"), "{list}");
}

const HEAD: &str = "\
# All nodes

Every node of the [library](library.md) and of the simulator, with its ports, parameters, units, defaults and ranges.
`apex nodes` shows the same on the command line, also of the nodes of your own package; `cargo doc -p apex-nodes --open`
says more about each. Written by the test `nodes` of `apex-cli`.

";

/// A robot that uses all features of both crates.
const PACKAGE: &str = "robots/sick-robot-day";

/// `APEX_UPDATE_EXPECTATIONS=1` writes the index again.
#[test]
fn the_index_of_the_library_is_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut text = HEAD.to_owned();
    for name in ["apex_nodes::", "apex_sim::"] {
        let (code, page, errors) = nodes(&root, &["--package", PACKAGE, "--markdown", name]);
        assert_eq!(code, Some(0), "{errors}");
        text += &page;
        text.push('\n');
    }
    let text = text.trim_end().to_owned() + "\n";
    let file = root.join("docs/nodes-index.md");
    if env::var_os("APEX_UPDATE_EXPECTATIONS").is_some() {
        fs::write(&file, &text).unwrap();
    }
    assert!(text.matches("\n### ").count() > 90, "{text}");
    let command = "APEX_UPDATE_EXPECTATIONS=1 cargo test -p apex-cli --test tools index_of_the_library";
    assert!(
        fs::read_to_string(&file).unwrap_or_default() == text,
        "docs/nodes-index.md is out of date: `{command}` renews it"
    );
}
