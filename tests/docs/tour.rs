//! The tour shows the robot in `robots/rover`, which is the one that `apex new` makes, and what the compiler really
//! says. That its commands do what it says is tested in `apex-cli/tests/tools/tour.rs`, which follows it from the
//! beginning.

use crate::{Package, TOUR, blocks, page};
use apex_dsl::explain::explain;

const TEXT: &str = include_str!("../../robots/rover/robot.afg");

/// The tour's package is a project of its own, which does not lie in a repository.
pub const FOLDER: &str = "robots/rover/";

/// A block is a part of a file, with lines as they stand there.
fn assert_part(block: &str, file: &str) {
    assert!(file.contains(block), "no longer in the robot:\n{block}");
}

#[test]
fn the_tour_shows_the_robot_of_the_repository() {
    let page = page(TOUR);
    assert_eq!(blocks(&page, "afg").last().map(String::as_str), Some(TEXT));
    let nodes = include_str!("../../robots/rover/src/lib.rs");
    let rust = blocks(&page, "rust");
    assert!(rust.len() >= 3, "{rust:?}");
    rust.iter().for_each(|block| assert_part(block, nodes));
    let excerpts = blocks(&page, "rust,ignore");
    assert!(!excerpts.is_empty());
    excerpts.iter().for_each(|block| assert_part(block, TEXT));
    assert!(page.contains(include_str!("../../robots/rover/world.txt")), "the world is another one");
}

/// The page with what `explain` says of its robot at first: as many lines as it shows.
pub fn with_explained(page: &str, package: &mut Package) -> String {
    let checked = package.check(TEXT);
    let robot = checked.programs.iter().find(|program| program.graph.robot).expect("there is a robot");
    let (before, rest) = page.split_once("```text\nrobot Robot\n").expect("it is shown");
    let (shown, after) = rest.split_once("```").expect("it ends");
    let explained = explain(robot, &checked.machines, &package.catalog);
    let lines: String = explained.lines().take(shown.lines().count() + 1).map(|line| format!("{line}\n")).collect();
    format!("{before}```text\n{lines}```{after}")
}
