//! The tour ends with the robot in `robots/rover`, and shows what the compiler really says.

use crate::{Package, TOUR, blocks, page};
use apex_dsl::report::explain;

const TEXT: &str = include_str!("../../robots/rover/rover.afg");

#[test]
fn the_tour_ends_with_the_robot_of_the_repository() {
    let page = page(TOUR);
    assert_eq!(blocks(&page, "afg").last().map(String::as_str), Some(TEXT));
    assert_eq!(blocks(&page, "rust").join("\n"), include_str!("../../robots/rover/src/lib.rs"));
}

/// The page with what `explain` says of its robot.
pub fn with_explained(page: &str, package: &mut Package) -> String {
    let checked = package.check(TEXT);
    let robot = checked.programs.iter().find(|program| program.graph.robot).expect("there is a robot");
    let (before, rest) = page.split_once("```text\nrobot Rover\n").expect("it is shown");
    let (_, after) = rest.split_once("```").expect("it ends");
    format!("{before}```text\n{}```{after}", explain(robot, &package.catalog))
}
