//! Checks that the tour shows the robot in `robots/rover`, from which `apex new` makes projects, and the real output of
//! the compiler. Its commands are tested in `apex-cli/tests/tools/tour.rs`, which follows the tour from the beginning.

use crate::{Package, TOUR, blocks, page};
use apex_ide::explain::explain;

const TEXT: &str = include_str!("../../robots/rover/robot.afg");

/// Path to remove from messages: the tour's package is a project of its own.
pub const FOLDER: &str = "robots/rover/";

/// Checks that a block is part of a file, with the same lines.
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

/// The page with the first lines of the explanation of its robot, as many as it shows.
pub fn with_explained(page: &str, package: &mut Package) -> String {
    let checked = package.check(TEXT);
    let robot = checked.programs.iter().find(|program| program.graph.robot).expect("there is a robot");
    let (before, rest) = page.split_once("```text\nrobot Robot\n").expect("it is shown");
    let (shown, after) = rest.split_once("```").expect("it ends");
    let explained = explain(robot, &checked.machines, &package.catalog);
    let lines: String = explained.lines().take(shown.lines().count() + 1).map(|line| format!("{line}\n")).collect();
    format!("{before}```text\n{lines}```{after}")
}
